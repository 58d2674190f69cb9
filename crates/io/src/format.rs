//! Formats, and how a file tells which one it is.

use std::{fmt, path::Path};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// XYZ and extended XYZ: atoms by name, as text.
    Xyz,
    /// The text dump of LAMMPS.
    Lammps,
    /// PDB: atoms of molecules, in fixed columns.
    Pdb,
    /// MMPLD: the particle lists of MegaMol.
    Mmpld,
    /// PLY: vertices of scans and meshes.
    Ply,
    /// LAS and its compressed form LAZ: points of laser scans.
    Las,
    /// The legacy format of VTK.
    Vtk,
}

impl Format {
    /// The format of a file with this name.
    #[must_use]
    pub fn from_name(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        Some(match name.rsplit_once('.')?.1 {
            "xyz" | "extxyz" | "exyz" => Self::Xyz,
            "lammpstrj" | "lammpsdump" | "dump" => Self::Lammps,
            "pdb" | "ent" => Self::Pdb,
            "mmpld" => Self::Mmpld,
            "ply" => Self::Ply,
            "las" | "laz" => Self::Las,
            "vtk" => Self::Vtk,
            _ => return None,
        })
    }

    /// The format of a file that starts with these bytes, if they leave no doubt.
    #[must_use]
    pub fn from_content(head: &[u8]) -> Option<Self> {
        let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        match text {
            _ if head.starts_with(b"MMPLD\0") => Some(Self::Mmpld),
            _ if head.starts_with(b"LASF") => Some(Self::Las),
            _ if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") => Some(Self::Ply),
            _ if text.starts_with(b"# vtk DataFile") => Some(Self::Vtk),
            _ if text.trim_ascii_start().starts_with(b"ITEM:") => Some(Self::Lammps),
            _ if looks_like_pdb(text) => Some(Self::Pdb),
            _ if looks_like_xyz(text) => Some(Self::Xyz),
            _ => None,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Xyz => "XYZ",
            Self::Lammps => "LAMMPS dump",
            Self::Pdb => "PDB",
            Self::Mmpld => "MMPLD",
            Self::Ply => "PLY",
            Self::Las => "LAS",
            Self::Vtk => "VTK",
        })
    }
}

/// Whether the first lines start with record names of PDB.
fn looks_like_pdb(text: &[u8]) -> bool {
    const NAMES: [&[u8]; 12] = [
        b"HEADER", b"TITLE ", b"COMPND", b"CRYST1", b"REMARK", b"ATOM  ", b"HETATM", b"MODEL ",
        b"AUTHOR", b"EXPDTA", b"SEQRES", b"USER  ",
    ];
    let first = text.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty());
    first.is_some_and(|line| NAMES.iter().any(|name| line.starts_with(name)))
}

/// Whether the first line is a number of atoms, and the second or third a name with coordinates.
fn looks_like_xyz(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n');
    let count = lines.next().unwrap_or_default().trim_ascii();
    let is_count = !count.is_empty() && count.iter().all(u8::is_ascii_digit);
    is_count
        && lines.take(2).any(|line| {
            let columns = line.split(u8::is_ascii_whitespace).filter(|column| !column.is_empty());
            columns.filter(|column| fast_float2::parse::<f64, _>(column).is_ok()).count() >= 3
        })
}
