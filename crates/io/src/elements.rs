/*!
Elements: symbols, radii and colors.

Radii are in angstrom.

* **Covalent** radii are those of Cordero et al., *Covalent radii revisited*, Dalton Trans. 2008,
  2832: hydrogen to curium; carbon as in single bonds (sp3), manganese, iron and cobalt of low spin.
  The elements after curium, which that work leaves out, take the radius of curium.
* **Van der Waals** radii of the main group are those of Bondi, J. Phys. Chem. 1964, 68, 441, and
  where he has none those of Mantina et al., J. Phys. Chem. A 2009, 113, 5806. All others are those
  of Alvarez, *A cartography of the van der Waals territories*, Dalton Trans. 2013, 42, 8617.
  Promethium and the elements after einsteinium, which have none, take the radius of einsteinium.
* An **unknown** element, number 0, takes the radius of carbon.

Colors are those of Jmol, a program that shows molecules; they extend the colors of the models of
Corey, Pauling and Koltun. Jmol paints what it does not know in a pink that no element has, and the
elements after meitnerium have the color of meitnerium.
*/

/// Which radius to take for an atom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Radii {
    /// Half the distance of bonded atoms.
    Covalent,
    /// Half the distance of atoms that do not bond.
    #[default]
    VanDerWaals,
}

impl Radii {
    /// The radius of the element of this atomic number, in angstrom.
    ///
    /// # Examples
    ///
    /// ```
    /// use puncta_io::elements::Radii;
    ///
    /// assert_eq!(Radii::Covalent.of(8), 0.66);
    /// assert_eq!(Radii::VanDerWaals.of(8), 1.52);
    /// ```
    #[must_use]
    pub fn of(self, number: u8) -> f64 {
        let (table, fallback): (&[u16], u16) = match self {
            Self::Covalent => (&COVALENT, COVALENT[96]),
            Self::VanDerWaals => (&VAN_DER_WAALS, VAN_DER_WAALS[99]),
        };
        let radius = match number {
            0 => table.get(6),
            _ => table.get(usize::from(number)).filter(|radius| **radius > 0),
        };
        f64::from(radius.copied().unwrap_or(fallback)) / 100.0
    }
}

/// The atomic number of the element with this symbol, in capital or small letters. `D` and `T`,
/// deuterium and tritium, are hydrogen.
#[must_use]
pub fn atomic_number(symbol: &str) -> Option<u8> {
    find(symbol.as_bytes())
}

/// The symbol of the element of this atomic number, from 1 to 118.
#[must_use]
pub fn symbol(number: u8) -> Option<&'static str> {
    SYMBOLS.get(usize::from(number)).copied().filter(|_| number > 0)
}

/// The atomic number of the element with this symbol.
pub(crate) fn find(symbol: &[u8]) -> Option<u8> {
    let (first, second) = match *symbol {
        [first] => (first, None),
        [first, second] => (first, Some(second)),
        _ => return None,
    };
    let letter = |byte: u8| byte.is_ascii_alphabetic().then_some(usize::from(byte & 31));
    let row = BY_LETTERS.get(letter(first)?)?;
    let column = second.map_or(Some(0), letter)?;
    row.get(column).copied().filter(|number| *number > 0)
}

/// The atomic number that a label of an atom stands for, or 0: a symbol (`Fe`), a symbol with
/// something behind it that is no letter (`C12`, `Fe3+`, `O_w`) or the mass before it (`13C`), or
/// an atomic number (`26`).
pub(crate) fn from_label(label: &[u8]) -> u8 {
    if let Some(number) = find(label) {
        return number;
    }
    let digits = label.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (mass, rest) = label.split_at(digits);
    if rest.is_empty() {
        let number = mass.iter().try_fold(0_u8, |number, digit| {
            number.checked_mul(10)?.checked_add(digit - b'0').filter(|n| usize::from(*n) <= LAST)
        });
        return number.unwrap_or(0);
    }
    let letters = rest.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    rest.get(..letters).and_then(find).unwrap_or(0)
}

/// The atomic number of the last element.
const LAST: usize = 118;

/// The color of each element by atomic number; index 0 is that of an unknown element.
pub const CPK: [[u8; 3]; 119] = {
    let mut colors = [[0; 3]; LAST + 1];
    let mut number = 0;
    while number <= LAST {
        let [_, red, green, blue] = COLORS[number].to_be_bytes();
        colors[number] = [red, green, blue];
        number += 1;
    }
    colors
};

/// Atomic numbers by the place of the first and the second letter in the alphabet, counted from 1.
const BY_LETTERS: [[u8; 27]; 27] = {
    let mut numbers = [[0; 27]; 27];
    let mut number: u8 = 1;
    while (number as usize) < SYMBOLS.len() {
        let symbol = SYMBOLS[number as usize].as_bytes();
        let second = if symbol.len() > 1 { symbol[1] & 31 } else { 0 };
        numbers[(symbol[0] & 31) as usize][second as usize] = number;
        number += 1;
    }
    numbers[(b'D' & 31) as usize][0] = 1;
    numbers[(b'T' & 31) as usize][0] = 1;
    numbers
};

#[rustfmt::skip]
const SYMBOLS: [&str; LAST + 1] = [
    "X", "H", "He", "Li", "Be", "B", "C", "N", "O", "F", "Ne", "Na", "Mg", "Al",
    "Si", "P", "S", "Cl", "Ar", "K", "Ca", "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co",
    "Ni", "Cu", "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr", "Rb", "Sr", "Y", "Zr", "Nb",
    "Mo", "Tc", "Ru", "Rh", "Pd", "Ag", "Cd", "In", "Sn", "Sb", "Te", "I", "Xe", "Cs",
    "Ba", "La", "Ce", "Pr", "Nd", "Pm", "Sm", "Eu", "Gd", "Tb", "Dy", "Ho", "Er", "Tm",
    "Yb", "Lu", "Hf", "Ta", "W", "Re", "Os", "Ir", "Pt", "Au", "Hg", "Tl", "Pb", "Bi",
    "Po", "At", "Rn", "Fr", "Ra", "Ac", "Th", "Pa", "U", "Np", "Pu", "Am", "Cm", "Bk",
    "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf", "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg",
    "Cn", "Nh", "Fl", "Mc", "Lv", "Ts", "Og",
];

/// Covalent radii in hundredths of an angstrom.
#[rustfmt::skip]
const COVALENT: [u16; 97] = [
    0, 31, 28, 128, 96, 84, 76, 71, 66, 57, 58, 166, 141, 121, 111, 107,
    105, 102, 106, 203, 176, 170, 160, 153, 139, 139, 132, 126, 124, 132, 122, 122,
    120, 119, 120, 120, 116, 220, 195, 190, 175, 164, 154, 147, 146, 142, 139, 145,
    144, 142, 139, 139, 138, 139, 140, 244, 215, 207, 204, 203, 201, 199, 198, 198,
    196, 194, 192, 192, 189, 190, 187, 187, 175, 170, 162, 151, 144, 141, 136, 136,
    132, 145, 146, 148, 140, 150, 150, 260, 221, 215, 206, 200, 196, 190, 187, 180,
    169,
];

/// Van der Waals radii in hundredths of an angstrom; 0 where there is none.
#[rustfmt::skip]
const VAN_DER_WAALS: [u16; 100] = [
    0, 120, 140, 182, 153, 192, 170, 155, 152, 147, 154, 227, 173, 184, 210, 180,
    180, 175, 188, 275, 231, 258, 246, 242, 245, 245, 244, 240, 240, 238, 239, 187,
    211, 185, 190, 185, 202, 303, 249, 275, 252, 256, 245, 244, 246, 244, 215, 253,
    249, 193, 217, 206, 206, 198, 216, 343, 268, 298, 288, 292, 295, 0, 290, 287,
    283, 279, 287, 281, 283, 279, 280, 274, 263, 253, 257, 249, 248, 241, 229, 232,
    245, 196, 202, 207, 197, 202, 220, 348, 283, 280, 293, 288, 271, 282, 281, 283,
    305, 340, 305, 270,
];

/// Red, green and blue, from the second byte to the last.
#[rustfmt::skip]
const COLORS: [u32; LAST + 1] = [
    0xff1493, 0xffffff, 0xd9ffff, 0xcc80ff, 0xc2ff00, 0xffb5b5, 0x909090, 0x3050f8, 0xff0d0d,
    0x90e050, 0xb3e3f5, 0xab5cf2, 0x8aff00, 0xbfa6a6, 0xf0c8a0, 0xff8000, 0xffff30, 0x1ff01f,
    0x80d1e3, 0x8f40d4, 0x3dff00, 0xe6e6e6, 0xbfc2c7, 0xa6a6ab, 0x8a99c7, 0x9c7ac7, 0xe06633,
    0xf090a0, 0x50d050, 0xc88033, 0x7d80b0, 0xc28f8f, 0x668f8f, 0xbd80e3, 0xffa100, 0xa62929,
    0x5cb8d1, 0x702eb0, 0x00ff00, 0x94ffff, 0x94e0e0, 0x73c2c9, 0x54b5b5, 0x3b9e9e, 0x248f8f,
    0x0a7d8c, 0x006985, 0xc0c0c0, 0xffd98f, 0xa67573, 0x668080, 0x9e63b5, 0xd47a00, 0x940094,
    0x429eb0, 0x57178f, 0x00c900, 0x70d4ff, 0xffffc7, 0xd9ffc7, 0xc7ffc7, 0xa3ffc7, 0x8fffc7,
    0x61ffc7, 0x45ffc7, 0x30ffc7, 0x1fffc7, 0x00ff9c, 0x00e675, 0x00d452, 0x00bf38, 0x00ab24,
    0x4dc2ff, 0x4da6ff, 0x2194d6, 0x267dab, 0x266696, 0x175487, 0xd0d0e0, 0xffd123, 0xb8b8d0,
    0xa6544d, 0x575961, 0x9e4fb5, 0xab5c00, 0x754f45, 0x428296, 0x420066, 0x007d00, 0x70abfa,
    0x00baff, 0x00a1ff, 0x008fff, 0x0080ff, 0x006bff, 0x545cf2, 0x785ce3, 0x8a4fe3, 0xa136d4,
    0xb31fd4, 0xb31fba, 0xb30da6, 0xbd0d87, 0xc70066, 0xcc0059, 0xd1004f, 0xd90045, 0xe00038,
    0xe6002e, 0xeb0026, 0xeb0026, 0xeb0026, 0xeb0026, 0xeb0026, 0xeb0026, 0xeb0026, 0xeb0026,
    0xeb0026, 0xeb0026,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_and_numbers_are_inverse() {
        for number in 1..=118 {
            let symbol = symbol(number).unwrap();
            assert_eq!(atomic_number(symbol), Some(number), "{symbol}");
            assert_eq!(atomic_number(&symbol.to_lowercase()), Some(number), "{symbol}");
            assert_eq!(atomic_number(&symbol.to_uppercase()), Some(number), "{symbol}");
        }
        assert_eq!((symbol(0), symbol(119)), (None, None));
    }

    #[test]
    fn well_known_numbers_are_right() {
        let known = "H 1 He 2 C 6 N 7 O 8 Na 11 Si 14 S 16 Cl 17 Ca 20 Fe 26 Cu 29 Zn 30 Ge 32 \
                     Ag 47 I 53 W 74 Pt 78 Au 79 Hg 80 Pb 82 U 92 Cm 96 Rf 104 Og 118 D 1 t 1";
        let words: Vec<&str> = known.split(' ').collect();
        for pair in words.chunks(2) {
            assert_eq!(atomic_number(pair[0]), pair[1].parse().ok(), "{}", pair[0]);
        }
        for symbol in ["", "X", "Q", "Hx", "Fee", "C1", "1", "\u{b5}"] {
            assert_eq!(atomic_number(symbol), None, "{symbol}");
        }
    }

    #[test]
    fn labels_stand_for_elements() {
        for (label, number) in [
            ("C1", 6),
            ("CA", 20),
            ("Fe3+", 26),
            ("O_w", 8),
            ("13C", 6),
            ("26", 26),
            ("118", 118),
            ("119", 0),
            ("0", 0),
            ("99999999", 0),
            ("", 0),
            ("HW", 0),
            ("Q1", 0),
            ("+1", 0),
            ("-", 0),
        ] {
            assert_eq!(from_label(label.as_bytes()), number, "{label}");
        }
    }

    #[test]
    #[rustfmt::skip]
    fn radii_are_those_of_the_tables() {
        let covalent = [
            (1, 0.31), (2, 0.28), (3, 1.28), (6, 0.76), (7, 0.71), (8, 0.66), (9, 0.57), (11, 1.66),
            (14, 1.11), (16, 1.05), (17, 1.02), (19, 2.03), (25, 1.39), (26, 1.32), (27, 1.26),
            (29, 1.32), (53, 1.39), (55, 2.44), (79, 1.36), (92, 1.96), (96, 1.69), (118, 1.69),
        ];
        for (number, radius) in covalent {
            assert_eq!(Radii::Covalent.of(number), radius, "{number}");
        }
        let van_der_waals = [
            (1, 1.2), (2, 1.4), (3, 1.82), (4, 1.53), (5, 1.92), (6, 1.7), (7, 1.55), (8, 1.52),
            (9, 1.47), (11, 2.27), (14, 2.1), (15, 1.8), (16, 1.8), (17, 1.75), (20, 2.31),
            (26, 2.44), (29, 2.38), (30, 2.39), (35, 1.85), (53, 1.98), (61, 2.7), (78, 2.29),
            (79, 2.32), (88, 2.83), (92, 2.71), (99, 2.7), (100, 2.7), (255, 2.7),
        ];
        for (number, radius) in van_der_waals {
            assert_eq!(Radii::VanDerWaals.of(number), radius, "{number}");
        }
        assert_eq!(Radii::Covalent.of(0), 0.76);
        assert_eq!(Radii::VanDerWaals.of(0), 1.7);
    }

    #[test]
    fn every_radius_can_be_drawn() {
        for number in 0..=255 {
            for radii in [Radii::Covalent, Radii::VanDerWaals] {
                assert!((0.28..3.5).contains(&radii.of(number)), "{number} {radii:?}");
            }
        }
    }

    #[test]
    fn colors_are_those_of_jmol() {
        let colors = [(1, [255; 3]), (6, [144; 3]), (7, [48, 80, 248]), (8, [255, 13, 13])];
        for (number, color) in colors {
            assert_eq!(CPK[number], color, "{number}");
        }
        assert_eq!(CPK[16], [255, 255, 48]);
        assert_eq!(CPK[26], [224, 102, 51]);
        assert_eq!(CPK[79], [255, 209, 35]);
        assert!(!CPK[1..].contains(&CPK[0]), "the color of the unknown is that of an element");
        assert_eq!(CPK[118], CPK[109]);
    }
}
