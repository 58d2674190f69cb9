/*!
The text dump of LAMMPS: atoms of a simulation, with columns of any kind.

Lines that start with `ITEM:` say what the following lines are; `ITEM: ATOMS id type x y z ...` ends
the head of a frame and names the columns. Source: the pages `dump` and `Howto_triclinic` of the
manual, <https://docs.lammps.org/dump.html>. What is accepted:

* Items in any order before the atoms of a frame; those that are not known are passed over.
* **Positions** from the first full set of `x y z`, `xu yu zu`, `xs ys zs` and `xsu ysu zsu`, else
  each axis from the first of these that it has. The scaled ones (`s`) are fractions of the box. The
  bounds of a tilted box are those of a straight box around it, as LAMMPS writes them; a box of
  any orientation has its three vectors and its origin (`abc origin`). A frame without a z
  lies at z = 0, with a warning.
* `element`, `radius` and `diameter` are what they say. All other columns are scalars, `id` and
  `type` among them, if they hold numbers in the first row. Scalars are `f32`, so the scalar `id`
  is exact up to 2^24 only. Without `radius` and `element` the radius is estimated.

LAMMPS writes atoms in whatever order its processes have them. Records are ordered by the column
`id`, so that record k is the same atom in each frame that has the same atoms, and the id of a
record is the rank of its atom. The order is found with 12 bytes an atom beside the records (16
where rows were skipped), which are then moved in place. Atoms of the same id keep their order, with
a warning. Records in chunks keep the order of the file: see the module `ids`.

Rows with a wrong number of columns, or without a number where one must be, are skipped and counted.
Fewer rows than atoms are an error.
*/

mod cell;
mod ids;
mod layout;
mod order;
mod read;
#[cfg(test)]
mod tests;

pub(crate) use read::read;
