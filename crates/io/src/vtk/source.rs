/*!
The words and values of a VTK file.

Keywords and numbers are words in both kinds of files. Values are words in a text file; in a binary
file they are big-endian, and start behind the end of the line that announces them.
*/

use crate::{
    error::{Fault, Place, quote},
    input::Input,
};

/// About how many values are decoded at a time; a multiple of 8, for bits.
const BLOCK: usize = 8192;

/// The type of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Bit,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    Text,
}

impl Kind {
    /// The type of this name.
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "bit" => Self::Bit,
            "char" | "signed_char" => Self::I8,
            "unsigned_char" => Self::U8,
            "short" => Self::I16,
            "unsigned_short" => Self::U16,
            // Ids of the library's own type are written as this type, whatever their size.
            "int" | "vtkidtype" => Self::I32,
            "unsigned_int" => Self::U32,
            "long" | "long_long" | "__int64" | "vtktypeint64" => Self::I64,
            "unsigned_long" | "unsigned_long_long" | "unsigned___int64" | "vtktypeuint64" => {
                Self::U64
            }
            "float" => Self::F32,
            "double" => Self::F64,
            "string" | "utf8_string" => Self::Text,
            _ => return None,
        })
    }

    /// The bytes of `count` values, unless they are texts.
    fn bytes(self, count: u64) -> u64 {
        let size = match self {
            Self::Bit => return count.div_ceil(8),
            Self::I8 | Self::U8 | Self::Text => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        };
        count.saturating_mul(size)
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// The words and values of a file.
pub(super) struct Source<'i, 'a> {
    input: &'i mut Input<'a>,
    is_text: bool,
    word: Vec<u8>,
    /// Whether the word is to be read again.
    is_held: bool,
    bytes: Vec<u8>,
    values: Vec<f64>,
}

impl<'i, 'a> Source<'i, 'a> {
    /// The words of the file from here on; its kind is not known yet.
    pub(super) fn new(input: &'i mut Input<'a>) -> Self {
        let (word, bytes, values) = (Vec::new(), Vec::new(), Vec::new());
        Self { input, is_text: true, word, is_held: false, bytes, values }
    }

    /// Tells that values are binary from here on.
    pub(super) fn set_binary(&mut self) {
        self.is_text = false;
    }

    pub(super) fn is_text(&self) -> bool {
        self.is_text
    }

    /// The place of the last word.
    pub(super) fn place(&self) -> Place {
        if self.is_text {
            self.input.at_line()
        } else {
            Place::Byte(self.input.byte().saturating_sub(self.word.len() as u64))
        }
    }

    /// A fault about the last word.
    pub(super) fn invalid(&self, what: impl Into<String>) -> Fault {
        Fault::invalid(self.place(), what, quote(&self.word))
    }

    /// The next word in capitals, as keywords are written; `None` at the end of the file.
    pub(super) fn keyword(&mut self) -> Result<Option<String>, Fault> {
        if !self.advance()? {
            return Ok(None);
        }
        Ok(Some(String::from_utf8_lossy(&self.word).to_ascii_uppercase()))
    }

    /// Makes the last word the next one again.
    pub(super) fn hold(&mut self) {
        self.is_held = true;
    }

    /// The next word.
    pub(super) fn expect(&mut self, what: &str) -> Result<&[u8], Fault> {
        if self.advance()? {
            return Ok(&self.word);
        }
        Err(Fault::missing(self.place(), what))
    }

    /// The next word, which is one of the values of `what`.
    pub(super) fn value(&mut self, what: &str) -> Result<&[u8], Fault> {
        if self.advance()? {
            return Ok(&self.word);
        }
        Err(Fault::missing(self.place(), last_of(what)))
    }

    /// Goes to the next word; false at the end of the file.
    fn advance(&mut self) -> Result<bool, Fault> {
        Ok(std::mem::take(&mut self.is_held) || self.input.word(&mut self.word)?)
    }

    /// The next word, with characters that were written as `%` and two hexadecimal digits.
    pub(super) fn name(&mut self) -> Result<String, Fault> {
        let mut rest = self.expect("the name of an array")?;
        let mut name = Vec::with_capacity(rest.len());
        while let Some((&first, tail)) = rest.split_first() {
            let code = tail.get(..2).filter(|_| first == b'%');
            let code = code.and_then(|code| std::str::from_utf8(code).ok());
            match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
                Some(byte) => {
                    name.push(byte);
                    rest = tail.get(2..).unwrap_or_default();
                }
                None => {
                    name.push(first);
                    rest = tail;
                }
            }
        }
        Ok(String::from_utf8_lossy(&name).into_owned())
    }

    /// The next word, which must be a whole number.
    pub(super) fn count(&mut self, what: &str) -> Result<u64, Fault> {
        let word = self.expect(what)?;
        match std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
            Some(count) => Ok(count),
            None => Err(self.invalid(format!("{what} must be a whole number"))),
        }
    }

    /// The next word, which must be a type of values.
    pub(super) fn kind(&mut self) -> Result<Kind, Fault> {
        let name = String::from_utf8_lossy(self.expect("a type of values")?).to_ascii_lowercase();
        Kind::from_name(&name).ok_or_else(|| self.invalid("the type of values must be a known one"))
    }

    /// What is left of the line.
    pub(super) fn rest_of_line(&mut self) -> Result<&[u8], Fault> {
        self.input.line(&mut self.word)?;
        self.word.drain(..self.word.len() - self.word.trim_ascii_start().len());
        Ok(self.word.trim_ascii_end())
    }

    /// Passes over lines up to an empty one.
    pub(super) fn skip_paragraph(&mut self) -> Result<(), Fault> {
        self.rest_of_line()?;
        while self.input.line(&mut self.word)? && !self.word.trim_ascii().is_empty() {}
        Ok(())
    }

    /// Whether the length of the file is known, so that [`Self::start`] confirms counts.
    pub(super) fn has_length(&self) -> bool {
        self.input.remaining().is_some()
    }

    /// Gets to the values that the words so far have announced, and checks that the file has bytes
    /// enough for them, where its length is known.
    pub(super) fn start(&mut self, kind: Kind, count: u64, what: &str) -> Result<(), Fault> {
        self.end_header()?;
        // In a text, each value has a digit, and white space before it; one may be read already.
        let text_bytes = count.saturating_sub(1).saturating_mul(2);
        let bytes = if self.is_text { text_bytes } else { kind.bytes(count) };
        let place = self.place();
        self.input.require(bytes, what).map_err(|fault| match place {
            Place::Line(_) => Fault { place: Some(place), ..fault },
            Place::Byte(_) => fault,
        })
    }

    /// Gets behind the end of the line if values are binary.
    fn end_header(&mut self) -> Result<(), Fault> {
        if !self.is_text {
            self.rest_of_line()?;
        }
        Ok(())
    }

    /// Calls `each` with `count` tuples of `width` values and their places, after [`Self::start`].
    pub(super) fn tuples(
        &mut self,
        (kind, width): (Kind, usize),
        count: u64,
        what: &str,
        mut each: impl FnMut(&[f64], Place) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut values = std::mem::take(&mut self.values);
        values.resize(width, 0.0);
        if self.is_text {
            for _ in 0..count {
                for value in &mut values {
                    *value = self.number(what)?;
                }
                each(&values, self.input.at_line())?;
            }
        } else {
            let per_block = (BLOCK / width.max(1) / 8 * 8).max(8) as u64;
            let mut left = count;
            while left > 0 {
                let start = self.input.byte();
                let tuples = left.min(per_block);
                values.clear();
                self.block(kind, tuples * width as u64, &mut values, what)?;
                let mut place = start;
                for tuple in values.chunks_exact(width) {
                    each(tuple, Place::Byte(place))?;
                    place += kind.bytes(width as u64);
                }
                left -= tuples;
            }
        }
        self.values = values;
        Ok(())
    }

    /// Passes over `count` values.
    pub(super) fn skip(&mut self, kind: Kind, count: u64, what: &str) -> Result<(), Fault> {
        self.end_header()?;
        match (kind, self.is_text) {
            (Kind::Text, true) => {
                self.rest_of_line()?;
                let what = last_of(what);
                (0..count).try_for_each(|_| self.input.expect_line(&mut self.word, &what))
            }
            (Kind::Text, false) => (0..count).try_for_each(|_| self.skip_text(what)),
            (_, true) => (0..count).try_for_each(|_| self.value(what).map(|_| ())),
            (_, false) => self.input.skip(kind.bytes(count), what),
        }
    }

    /// A value in a text.
    fn number(&mut self, what: &str) -> Result<f64, Fault> {
        let word = self.value(what)?;
        if let Ok(number) = fast_float2::parse(word) {
            return Ok(number);
        }
        // Some libraries write `nan(ind)` or `1.#QNAN`.
        let unsigned = word.strip_prefix(b"-").unwrap_or(word);
        let is_nan = unsigned.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"nan"));
        if is_nan || unsigned.starts_with(b"1.#") {
            return Ok(f64::NAN);
        }
        Err(self.invalid(format!("the values of {what} must be numbers")))
    }

    /// Reads and decodes binary values.
    fn block(
        &mut self,
        kind: Kind,
        count: u64,
        values: &mut Vec<f64>,
        what: &str,
    ) -> Result<(), Fault> {
        self.bytes.resize(usize::try_from(kind.bytes(count)).unwrap_or(usize::MAX), 0);
        self.input.bytes(&mut self.bytes, what)?;
        let bytes = &self.bytes;
        match kind {
            Kind::Bit => {
                let bits = bytes.iter().flat_map(|&byte| (0..8).rev().map(move |i| byte >> i & 1));
                values.extend(bits.take(usize::try_from(count).unwrap_or(0)).map(f64::from));
            }
            Kind::I8 => decode(bytes, values, |b| f64::from(i8::from_be_bytes(b))),
            Kind::U8 | Kind::Text => decode(bytes, values, |b| f64::from(u8::from_be_bytes(b))),
            Kind::I16 => decode(bytes, values, |b| f64::from(i16::from_be_bytes(b))),
            Kind::U16 => decode(bytes, values, |b| f64::from(u16::from_be_bytes(b))),
            Kind::I32 => decode(bytes, values, |b| f64::from(i32::from_be_bytes(b))),
            Kind::U32 => decode(bytes, values, |b| f64::from(u32::from_be_bytes(b))),
            Kind::I64 => decode(bytes, values, |b| i64::from_be_bytes(b) as f64),
            Kind::U64 => decode(bytes, values, |b| u64::from_be_bytes(b) as f64),
            Kind::F32 => decode(bytes, values, |b| f64::from(f32::from_be_bytes(b))),
            Kind::F64 => decode(bytes, values, f64::from_be_bytes),
        }
        Ok(())
    }

    /// Passes over a binary text. The two high bits of its first byte tell how many more bytes its
    /// length has: none, 1, 3 or 7 for 3, 2, 1 or 0.
    fn skip_text(&mut self, what: &str) -> Result<(), Fault> {
        let [first] = self.input.array(what)?;
        let more = (1_usize << (3 - (first >> 6))) - 1;
        let mut bytes = [0; 8];
        let (head, tail) = bytes.split_at_mut(8 - more);
        if let Some(last) = head.last_mut() {
            *last = first & 0x3f;
        }
        self.input.bytes(tail, what)?;
        self.input.skip(u64::from_be_bytes(bytes), what)
    }
}

/// The name of what is missing where the values of `what` are too few.
fn last_of(what: &str) -> String {
    format!("the last values of {what}")
}

/// Appends the values of `N` bytes each.
fn decode<const N: usize>(bytes: &[u8], values: &mut Vec<f64>, value: impl Fn([u8; N]) -> f64) {
    values.extend(bytes.chunks_exact(N).filter_map(|b| b.first_chunk()).map(|b| value(*b)));
}
