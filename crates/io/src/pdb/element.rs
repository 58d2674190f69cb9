//! The element of an atom, by its own field or by its name.

use crate::elements;

/// The element of an atom, or 0.
///
/// `name` is the field of four columns with the name, and `field` the one of two with the element.
pub(super) fn find(name: &[u8], field: &[u8]) -> u8 {
    elements::find(field.trim_ascii()).or_else(|| by_name(name)).unwrap_or(0)
}

/// The element of an atom of this name.
///
/// Symbols are set right in the first two columns: ` CA ` is a carbon and `CA  ` is calcium. Names
/// of four characters leave no choice: they begin in the first column, and those of hydrogens,
/// which are the common ones (`HG11`), would be mercury. The digit of old names stands first
/// (`1HB `).
fn by_name(name: &[u8]) -> Option<u8> {
    let &[first, second, ..] = name else {
        return elements::find(name.trim_ascii());
    };
    let is_full = name.len() == 4 && !name.iter().any(u8::is_ascii_whitespace);
    if first.is_ascii_alphabetic() && !(is_full && matches!(first, b'H' | b'h' | b'D' | b'd')) {
        return elements::find(&[first, second]).or_else(|| elements::find(&[first]));
    }
    let mut rest = name.iter().skip_while(|byte| byte.is_ascii_digit() || **byte == b' ');
    elements::find(&[*rest.next()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_set_right() {
        for (name, element) in [
            (" CA ", 6),
            ("CA  ", 20),
            (" N  ", 7),
            (" OXT", 8),
            (" HW1", 1),
            ("HG11", 1),
            ("HG  ", 80),
            ("HO5'", 1),
            ("1HB ", 1),
            ("2HG1", 1),
            (" 1H ", 1),
            ("FE  ", 26),
            ("ZN", 30),
            ("CL1 ", 17),
            ("CL- ", 17),
            ("C316", 6),
            ("CB  ", 6),
            ("DH11", 1),
            (" D  ", 1),
            ("ca  ", 20),
            (" ca ", 6),
            ("hg11", 1),
            (" Q  ", 0),
            ("Q   ", 0),
            ("    ", 0),
            ("123 ", 0),
            ("C", 6),
            ("", 0),
            ("\u{e9}  ", 0),
        ] {
            assert_eq!(find(name.as_bytes(), b"  "), element, "{name}");
        }
    }

    #[test]
    fn the_field_comes_first() {
        assert_eq!(find(b"CA  ", b" C"), 6);
        assert_eq!(find(b" CA ", b"CA"), 20);
        assert_eq!(find(b" CA ", b"ca"), 20);
        assert_eq!(find(b" CA ", b"C "), 6);
        assert_eq!(find(b" CA ", b"12"), 6);
        assert_eq!(find(b" CA ", b""), 6);
        assert_eq!(find(b" X  ", b"Xx"), 0);
    }
}
