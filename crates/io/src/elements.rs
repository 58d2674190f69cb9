//! Elements: symbols, radii and colors.

/// Which radius to take for an atom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Radii {
    /// Half the distance of bonded atoms.
    Covalent,
    /// Half the distance of atoms that do not bond.
    #[default]
    VanDerWaals,
}
