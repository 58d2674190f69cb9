//! Input: a stream that knows its place, for readers that tell where a file is wrong.

use crate::{
    error::{ErrorKind, Fault, Place},
    stream::{Forward, Seekable, Stream},
};
use std::io::{self, BufRead, Read};

/// The longest line that is read; a longer one is no text.
const LINE_MAX: usize = 1 << 20;

/// A stream of bytes or lines.
pub(crate) struct Input<'a> {
    stream: Stream<'a>,
    byte: u64,
    line: u64,
    /// Whether the line counted last has not been read to its end.
    within_line: bool,
    /// The number of bytes from start to end, unless the stream is being decompressed.
    length: Option<u64>,
}

impl<'a> Input<'a> {
    pub(crate) fn new(stream: Box<dyn BufRead + 'a>, length: Option<u64>) -> Self {
        Self {
            stream: Stream::Forward(Forward::new(stream)),
            byte: 0,
            line: 0,
            within_line: false,
            length,
        }
    }

    /// An input that can [`jump`](Self::jump) anywhere.
    pub(crate) fn seekable(stream: Box<dyn Seekable + 'a>, length: u64) -> Self {
        Self {
            stream: Stream::Seekable(stream),
            byte: 0,
            line: 0,
            within_line: false,
            length: Some(length),
        }
    }

    /// Makes the next `count` bytes ones that [`jump`](Self::jump) can come back to as long as
    /// nothing after them is read; returns how many there are.
    ///
    /// A stream that cannot seek is read into memory, so ask for no more than is needed.
    pub(crate) fn hold(&mut self, count: u64) -> Result<u64, Fault> {
        let held = self.stream.hold(count);
        held.map_err(|error| Fault { place: Some(self.at_byte()), kind: error.into() })
    }

    /// Whether bytes must be held to be read twice.
    pub(crate) fn must_hold(&self) -> bool {
        matches!(self.stream, Stream::Forward(_))
    }

    /// Goes to a byte: forwards, or back to one that can be read again. `what` names what is there.
    pub(crate) fn jump(&mut self, byte: u64, what: &str) -> Result<(), Fault> {
        if self.must_hold() && byte >= self.byte {
            return self.skip(byte - self.byte, what);
        }
        let far = || Fault::invalid(Place::Byte(byte), format!("{what} must be in the file"), byte);
        let [from, to] = [self.byte, byte].map(i64::try_from);
        let (Ok(from), Ok(to)) = (from, to) else { return Err(far()) };
        self.stream
            .move_by(to - from)
            .map_err(|error| Fault { place: Some(Place::Byte(byte)), kind: error.into() })?;
        self.byte = byte;
        Ok(())
    }

    /// The offset of the next byte.
    pub(crate) fn byte(&self) -> u64 {
        self.byte
    }

    /// The place of the next byte.
    pub(crate) fn at_byte(&self) -> Place {
        Place::Byte(self.byte)
    }

    /// The place of the line that was read last, wholly or in part.
    pub(crate) fn at_line(&self) -> Place {
        Place::Line(self.line)
    }

    /// How many bytes are left, if that is known.
    pub(crate) fn remaining(&self) -> Option<u64> {
        self.length.map(|length| length.saturating_sub(self.byte))
    }

    /// Reads the next line, or what is left of a line whose words were read, into `line`, without
    /// its end; false at the end of the file.
    pub(crate) fn line(&mut self, line: &mut Vec<u8>) -> Result<bool, Fault> {
        line.clear();
        let limit = LINE_MAX as u64 + 1;
        let read = self.stream.by_ref().take(limit).read_until(b'\n', line);
        self.line += u64::from(!self.within_line);
        self.within_line = false;
        let read =
            read.map_err(|error| Fault { place: Some(self.at_line()), kind: error.into() })?;
        self.byte += read as u64;
        if line.len() > LINE_MAX {
            let what = format!("a line must be shorter than {LINE_MAX} bytes");
            return Err(Fault::invalid(self.at_line(), what, "longer"));
        }
        while line.last().is_some_and(|&last| last == b'\n' || last == b'\r') {
            line.pop();
        }
        Ok(read > 0)
    }

    /// Reads the next line; it is an error if there is none. `what` names what it should hold.
    pub(crate) fn expect_line(&mut self, line: &mut Vec<u8>, what: &str) -> Result<(), Fault> {
        if self.line(line)? {
            return Ok(());
        }
        Err(Fault::missing(self.at_line(), what))
    }

    /// Reads the next word into `word`; false at the end of the file.
    ///
    /// White space ends a word and parts words, over lines and without a limit on their length.
    pub(crate) fn word(&mut self, word: &mut Vec<u8>) -> Result<bool, Fault> {
        word.clear();
        loop {
            let buffer = match self.stream.fill_buf() {
                Ok(buffer) => buffer,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => {
                    return Err(Fault { place: Some(self.at_line()), kind: error.into() });
                }
            };
            let mut used = 0;
            for &byte in buffer {
                if byte.is_ascii_whitespace() && !word.is_empty() {
                    break;
                }
                self.line += u64::from(!self.within_line);
                self.within_line = byte != b'\n';
                if !byte.is_ascii_whitespace() {
                    word.push(byte);
                }
                used += 1;
            }
            let is_end = used < buffer.len() || buffer.is_empty();
            self.stream.consume(used);
            self.byte += used as u64;
            if word.len() > LINE_MAX {
                let what = format!("a word must be shorter than {LINE_MAX} bytes");
                return Err(Fault::invalid(self.at_line(), what, "longer"));
            }
            if is_end {
                return Ok(!word.is_empty());
            }
        }
    }

    /// Fills `buffer`; it is an error if the file ends first. `what` names what it should hold.
    pub(crate) fn bytes(&mut self, buffer: &mut [u8], what: &str) -> Result<(), Fault> {
        let (start, mut filled) = (self.at_byte(), 0);
        while filled < buffer.len() {
            match self.stream.read(&mut buffer[filled..]) {
                Ok(0) => {
                    let (needed, left) = (buffer.len() as u64, filled as u64);
                    let kind = ErrorKind::Truncated { what: what.to_owned(), needed, left };
                    return Err(Fault { place: Some(start), kind });
                }
                Ok(read) => filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(Fault { place: Some(start), kind: error.into() }),
            }
        }
        self.byte += filled as u64;
        Ok(())
    }

    /// Reads `N` bytes.
    pub(crate) fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Fault> {
        let mut bytes = [0; N];
        self.bytes(&mut bytes, what)?;
        Ok(bytes)
    }

    /// Checks, where the length is known, that `needed` more bytes are there.
    ///
    /// Call it before an allocation that a number in the file asks for.
    pub(crate) fn require(&self, needed: u64, what: &str) -> Result<(), Fault> {
        match self.remaining() {
            Some(left) if left < needed => {
                let kind = ErrorKind::Truncated { what: what.to_owned(), needed, left };
                Err(Fault { place: Some(self.at_byte()), kind })
            }
            _ => Ok(()),
        }
    }

    /// Passes over `count` bytes; it is an error if the file ends first.
    pub(crate) fn skip(&mut self, count: u64, what: &str) -> Result<(), Fault> {
        let start = self.at_byte();
        let skipped = io::copy(&mut self.stream.by_ref().take(count), &mut io::sink())
            .map_err(|error| Fault { place: Some(start), kind: error.into() })?;
        self.byte += skipped;
        if skipped == count {
            return Ok(());
        }
        let kind = ErrorKind::Truncated { what: what.to_owned(), needed: count, left: skipped };
        Err(Fault { place: Some(start), kind })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn words_and_lines_share_the_count_of_lines() {
        let text = b"one  two\n\n three\tfour \r\nfive\nsix";
        for capacity in [1, 2, 3, 100] {
            let stream = BufReader::with_capacity(capacity, &text[..]);
            let mut input = Input::new(Box::new(stream), None);
            let mut found = Vec::new();
            let mut next = |words: bool| {
                let more = if words { input.word(&mut found) } else { input.line(&mut found) };
                let text = String::from_utf8(found.clone()).unwrap();
                more.unwrap().then_some((text, input.line, input.byte))
            };
            let some = |text: &str, line, byte| Some((text.to_owned(), line, byte));
            assert_eq!(next(true), some("one", 1, 3));
            assert_eq!(next(true), some("two", 1, 8));
            assert_eq!(next(false), some("", 1, 9));
            assert_eq!(next(true), some("three", 3, 16));
            assert_eq!(next(false), some("\tfour ", 3, 24));
            assert_eq!(next(false), some("five", 4, 29));
            assert_eq!(next(true), some("six", 5, 32));
            assert_eq!(next(true), None);
        }
    }
}
