//! What readers of text share: lines that can be given back, columns, and numbers.

use crate::{
    error::{Fault, Place, quote},
    input::Input,
};
use std::collections::VecDeque;

/// About how many bytes are read to look ahead.
const AHEAD_BYTES: usize = 1 << 16;

/// The lines of a text; the one that was read last can be read again.
pub(crate) struct Lines<'i, 'a> {
    input: &'i mut Input<'a>,
    line: Vec<u8>,
    /// Where it is.
    place: Place,
    /// Whether the line that was read last is to come again.
    held: bool,
    /// The lines that follow and were read already.
    ahead: VecDeque<(Vec<u8>, Place)>,
    /// Where the text ends, once that is known.
    end: Option<Place>,
}

impl<'i, 'a> Lines<'i, 'a> {
    pub(crate) fn new(input: &'i mut Input<'a>) -> Self {
        let (line, place) = (Vec::new(), input.at_line());
        Self { input, line, place, held: false, ahead: VecDeque::new(), end: None }
    }

    /// Goes to the next line; false at the end of the text.
    pub(crate) fn advance(&mut self) -> Result<bool, Fault> {
        if self.held {
            self.held = false;
            return Ok(true);
        }
        if let Some((line, place)) = self.ahead.pop_front() {
            (self.line, self.place) = (line, place);
            return Ok(true);
        }
        if let Some(end) = self.end {
            self.line.clear();
            self.place = end;
            return Ok(false);
        }
        let found = self.input.line(&mut self.line)?;
        self.place = self.input.at_line();
        self.end = (!found).then_some(self.place);
        if self.place == Place::Line(1) && self.line.starts_with(b"\xef\xbb\xbf") {
            self.line.drain(..3);
        }
        Ok(found)
    }

    /// The lines after the one that was read last, which come all the same: at most `count`, and
    /// not many more bytes than [`AHEAD_BYTES`].
    pub(crate) fn look_ahead(&mut self, count: u64) -> Result<impl Iterator<Item = &[u8]>, Fault> {
        let mut bytes: usize = self.ahead.iter().map(|(line, _)| line.len() + 1).sum();
        while self.end.is_none() && (self.ahead.len() as u64) < count && bytes < AHEAD_BYTES {
            let mut line = Vec::new();
            if self.input.line(&mut line)? {
                bytes += line.len() + 1;
                self.ahead.push_back((line, self.input.at_line()));
            } else {
                self.end = Some(self.input.at_line());
            }
        }
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        Ok(self.ahead.iter().take(count).map(|(line, _)| line.as_slice()))
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
        Err(Fault::missing(self.place(), what))
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
        self.place
    }

    /// Whether the length of the text is known, and the rest can hold `rows` rows of `columns`
    /// columns: each column takes at least a character and one that separates it from the next.
    ///
    /// Only then may room for so many rows be made at once.
    pub(crate) fn can_hold(&self, rows: u64, columns: usize) -> bool {
        let needed = rows.checked_mul(2).and_then(|bytes| bytes.checked_mul(columns as u64));
        // Some lines are read already, each with an end of up to two bytes; the last may lack one.
        let ahead: u64 = self.ahead.iter().map(|(line, _)| line.len() as u64 + 2).sum();
        let margin = self.line.len() as u64 + 3 + ahead;
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
    fn lines_seen_ahead_come_all_the_same() {
        let text = b"a\nb\n\nc";
        for count in 0..6 {
            let mut input = Input::new(Box::new(&text[..]), None);
            let mut lines = Lines::new(&mut input);
            lines.advance().unwrap();
            let seen: Vec<_> = lines.look_ahead(count).unwrap().map(<[u8]>::to_vec).collect();
            let all = [b"b".to_vec(), Vec::new(), b"c".to_vec()];
            let count = usize::try_from(count).unwrap();
            assert_eq!(seen, all[..count.min(3)]);
            lines.hold();
            let mut next = || {
                let found = lines.advance().unwrap();
                (found.then(|| lines.text().to_vec()), lines.place())
            };
            for (index, line) in [b"a".to_vec()].into_iter().chain(all).enumerate() {
                assert_eq!(next(), (Some(line), Place::Line(index as u64 + 1)));
            }
            assert_eq!([next(), next()], [(None, Place::Line(5)), (None, Place::Line(5))]);
        }
    }

    #[test]
    fn looking_ahead_has_an_end() {
        let text = "1 2 3\n".repeat(100_000);
        let mut input = Input::new(Box::new(text.as_bytes()), None);
        let mut lines = Lines::new(&mut input);
        lines.advance().unwrap();
        assert_eq!(lines.look_ahead(u64::MAX).unwrap().count(), AHEAD_BYTES.div_ceil(6));
    }

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
