/*!
PDB: atoms of molecules, in fixed columns.

Source: the description of version 3.3 of the format, <https://www.wwpdb.org/documentation>. Records
`ATOM` and `HETATM` are atoms; all others but those that part frames are passed over. What is
accepted:

* **Frames** are models. A frame begins at `MODEL`, or at an atom where no frame is open, and ends
  at `ENDMDL`, `END`, the next `MODEL` or the end of the file. So a file without models is one
  frame, and a file whose frames are parted by `END` alone, as VMD writes them, has these.
* **Coordinates** are the columns 31 to 54, in three fields of eight. A number that is too long for
  its field shifts all that follow, and the digits at the joints could be read as others. So where a
  number touches its neighbor it must have its point where the format puts it; else the atom is
  skipped and counted, as are atoms with fields that are no numbers.
* **Elements** are in the columns 77 and 78, or, where there is none, come from the name of the
  atom.
* Alternate locations are all kept. Serial numbers may be anything. Lines may be cut short behind
  the coordinates, end as on Windows, and be in small letters.

`occupancy`, `b_factor` and `residue`, the number of the residue, are scalars, NaN where the field
is blank or no number (more than 9999 residues, say, in base 36).
*/

mod element;
mod read;

pub(crate) use read::read;
