//! What readers of text share: lines that can be given back, columns, and numbers.

use crate::{
    error::{ErrorKind, Fault, Place, quote},
    input::Input,
};

/// The lines of a text; the one that was read last can be read again.
pub(crate) struct Lines<'i, 'a> {
    input: &'i mut Input<'a>,
    line: Vec<u8>,
    /// Whether the line that was read last is to come again.
    held: bool,
}

impl<'i, 'a> Lines<'i, 'a> {
    pub(crate) fn new(input: &'i mut Input<'a>) -> Self {
        Self { input, line: Vec::new(), held: false }
    }

    /// Goes to the next line; false at the end of the text.
    pub(crate) fn advance(&mut self) -> Result<bool, Fault> {
        if self.held {
            self.held = false;
            return Ok(true);
        }
        let found = self.input.line(&mut self.line)?;
        if self.place() == Place::Line(1) && self.line.starts_with(b"\xef\xbb\xbf") {
            self.line.drain(..3);
        }
        Ok(found)
    }

    /// Goes to the next line that is not blank; false at the end of the text.
    pub(crate) fn advance_to_text(&mut self) -> Result<bool, Fault> {
        while self.advance()? {
            if !self.line.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Goes to the next line; it is an error if there is none. `what` names what it should hold.
    pub(crate) fn expect(&mut self, what: &str) -> Result<(), Fault> {
        if self.advance()? {
            return Ok(());
        }
        let kind = ErrorKind::Truncated { what: what.to_owned(), needed: 1, left: 0 };
        Err(Fault { place: Some(self.place()), kind })
    }

    /// Lets the line that was read last be the next one again.
    pub(crate) fn hold(&mut self) {
        self.held = true;
    }

    /// The line that was read last.
    pub(crate) fn text(&self) -> &[u8] {
        &self.line
    }

    /// Where the line that was read last is.
    pub(crate) fn place(&self) -> Place {
        self.input.at_line()
    }

    /// Whether the length of the text is known, and the rest can hold `rows` rows of `columns`
    /// columns: each column takes at least a character and one that separates it from the next.
    ///
    /// Only then may room for so many rows be made at once.
    pub(crate) fn can_hold(&self, rows: u64, columns: usize) -> bool {
        let needed = rows.checked_mul(2).and_then(|bytes| bytes.checked_mul(columns as u64));
        // A line may be held, and the last one may lack its end.
        let margin = self.line.len() as u64 + 3;
        match (needed, self.input.remaining()) {
            (Some(needed), Some(left)) => needed <= left.saturating_add(margin),
            _ => false,
        }
    }
}

/// The columns of a line.
pub(crate) fn columns(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|column| !column.is_empty())
}

/// A number; Fortran's exponents (`1.5D+03`) are numbers too.
pub(crate) fn number(text: &[u8]) -> Option<f64> {
    fast_float2::parse(text).ok().or_else(|| fortran(text).and_then(fast_float2_f64))
}

/// A number, rounded once to `f32`: what was written as `f32` comes back as it was.
pub(crate) fn number_f32(text: &[u8]) -> Option<f32> {
    let parsed: Result<f32, _> = fast_float2::parse(text);
    parsed.ok().or_else(|| {
        let (buffer, length) = fortran(text)?;
        fast_float2::parse(buffer.get(..length)?).ok()
    })
}

/// A whole number.
pub(crate) fn whole(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// A count that a line holds and nothing else. `what` names it.
pub(crate) fn count(line: &[u8], place: Place, what: &str) -> Result<u64, Fault> {
    let text = line.trim_ascii();
    let wrong = || Fault::invalid(place, format!("{what} must be a whole number"), quote(text));
    whole(text).ok_or_else(wrong)
}

/// The error that a frame has less rows than it says.
pub(crate) fn too_few(place: Place, expected: u64, found: u64) -> Fault {
    Fault::invalid(place, format!("the frame must have {expected} atoms, as it says"), found)
}

/// The longest number with an exponent of Fortran that is understood.
const FORTRAN_MAX: usize = 40;

/// The text with the `D` of an exponent replaced.
fn fortran(text: &[u8]) -> Option<([u8; FORTRAN_MAX], usize)> {
    let mut buffer = [0; FORTRAN_MAX];
    buffer.get_mut(..text.len())?.copy_from_slice(text);
    let exponent = buffer.iter_mut().find(|byte| matches!(byte, b'D' | b'd'))?;
    *exponent = b'e';
    Some((buffer, text.len()))
}

fn fast_float2_f64((buffer, length): ([u8; FORTRAN_MAX], usize)) -> Option<f64> {
    fast_float2::parse(buffer.get(..length)?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_programs_write_them() {
        for (text, value) in [
            ("1", 1.0),
            ("+1.5", 1.5),
            ("-.5", -0.5),
            ("1.", 1.0),
            ("1e3", 1000.0),
            ("1.5D+03", 1500.0),
            ("-2d-1", -0.2),
            ("1e999", f64::INFINITY),
        ] {
            assert_eq!(number(text.as_bytes()), Some(value), "{text}");
        }
        assert!(number(b"-nan").is_some_and(f64::is_nan));
        for text in
            ["", "x", "1x", "1.2.3", "1,5", "d", "1d", "--1", &"1".repeat(50).replace("11", "1d")]
        {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn a_number_of_single_precision_is_rounded_once() {
        // Half way between two f32, and a little more than f64 can tell: the larger one is nearest.
        let text = b"1.000000059604644775390625000000001";
        assert_eq!(number_f32(text), Some(1.000_000_1));
        assert_eq!(number_f32(b"1.5d0"), Some(1.5));
    }

    #[test]
    fn whole_numbers_have_digits_only() {
        assert_eq!(whole(b"18446744073709551615"), Some(u64::MAX));
        for text in ["18446744073709551616", "-1", "1.0", "", "1 2", "\u{661}"] {
            assert_eq!(whole(text.as_bytes()), None, "{text}");
        }
    }
}
