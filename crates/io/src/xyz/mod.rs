/*!
XYZ and extended XYZ: atoms by name, as text.

A frame is a line with the number of atoms, a line of comment, and a line for each atom; frames
follow each other. There is no standard, but one description that most programs follow:
<https://github.com/libAtoms/extxyz>. What is accepted:

* **Plain XYZ**: a name, x, y and z in each line, in angstrom. The first row tells how many columns
  there are, and further ones that hold numbers become the scalars `column_5`, `column_6`, ...
  The name is a symbol, a label (`C12`, but `CA` is calcium), an atomic number or anything else.
  Rows have no name and begin with x if the first column of any of the first rows (those within
  64 KiB) has a fraction, an exponent or a sign; a later row where a number other than a whole one
  stands for the name is skipped and counted.
* **Extended XYZ**: the comment has `Properties=species:S:1:pos:R:3:...`, which names the columns.
  `species` (also `element`, `Z`, ...), `pos`, `radius` and `color` (`R`: 0 to 1, `I`: 0 to 255) are
  what they say. Other numbers become scalars: `name` for one column, `name_x`, `name_y`, `name_z`
  for three, `name_0`, `name_1`, ... else. `Lattice` must have nine numbers; it is not kept.
* **No comment**: some programs leave the second line out. If it looks like an atom, has as many
  columns as the next line, and the line where the last atom should be is the end of the file or
  starts another frame, then it is an atom.
* **No number of atoms**: plain rows of points. Each begins with x, y and z, or, if its first column
  is no number, with a name. Further columns are scalars: nothing tells a color from a normal. Lines
  that start with `#` or `//` are comments.

Lines with a wrong number of columns, or without a number where one must be, are skipped and
counted. Radii are those of the elements: see the module `atoms`. Fewer lines than atoms are an
error.
*/

mod properties;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use self::{read::read, write::write};
