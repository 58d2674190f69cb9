/*!
Streams that can come back to bytes they gave before.

A file can seek. Bytes that are being decompressed cannot: the stretch that is to be read twice must
be held in memory, no more of it than the stream really has. Readers that need it ask for as little
as they can.
*/

use std::io::{self, BufRead, Read, Seek};

/// A stream that can seek.
pub(crate) trait Seekable: BufRead + Seek {}

impl<S: BufRead + Seek> Seekable for S {}

/// A stream, whether it can seek or not.
pub(crate) enum Stream<'a> {
    Seekable(Box<dyn Seekable + 'a>),
    Forward(Forward<'a>),
}

/// A stream that cannot seek, and the bytes of it that are held.
pub(crate) struct Forward<'a> {
    rest: Box<dyn BufRead + 'a>,
    held: Vec<u8>,
    /// How many of the held bytes were read.
    read: usize,
}

impl<'a> Forward<'a> {
    pub(crate) fn new(rest: Box<dyn BufRead + 'a>) -> Self {
        Self { rest, held: Vec::new(), read: 0 }
    }

    /// Holds the next `count` bytes, or as many as there are; returns how many.
    fn hold(&mut self, count: u64) -> io::Result<u64> {
        self.held.drain(..self.read);
        self.read = 0;
        let missing = count.saturating_sub(self.held.len() as u64);
        self.rest.by_ref().take(missing).read_to_end(&mut self.held)?;
        Ok(count.min(self.held.len() as u64))
    }

    /// Goes back or forth.
    fn move_by(&mut self, delta: i64) -> io::Result<()> {
        let far = || io::Error::other("a compressed file cannot be read backwards");
        if let Ok(count) = u64::try_from(delta) {
            let skipped = io::copy(&mut self.take(count), &mut io::sink())?;
            return if skipped == count {
                Ok(())
            } else {
                Err(io::ErrorKind::UnexpectedEof.into())
            };
        }
        let back = usize::try_from(delta.unsigned_abs()).map_err(|_| far())?;
        self.read = self.read.checked_sub(back).ok_or_else(far)?;
        Ok(())
    }

    fn unread(&self) -> &[u8] {
        self.held.get(self.read..).unwrap_or_default()
    }
}

impl Stream<'_> {
    /// Makes the next `count` bytes ones that can be read twice, as long as nothing after them is
    /// read; returns how many there are, which is fewer only at the end of a stream.
    pub(crate) fn hold(&mut self, count: u64) -> io::Result<u64> {
        match self {
            Self::Seekable(_) => Ok(count),
            Self::Forward(forward) => forward.hold(count),
        }
    }

    /// Goes back or forth by `delta` bytes; back only over bytes that are held.
    pub(crate) fn move_by(&mut self, delta: i64) -> io::Result<()> {
        match self {
            Self::Seekable(stream) => stream.seek_relative(delta),
            Self::Forward(forward) => forward.move_by(delta),
        }
    }
}

impl Read for Forward<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.unread().is_empty() {
            return self.rest.read(buffer);
        }
        let read = self.unread().read(buffer)?;
        self.read += read;
        Ok(read)
    }
}

impl BufRead for Forward<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.read < self.held.len() { Ok(self.unread()) } else { self.rest.fill_buf() }
    }

    fn consume(&mut self, count: usize) {
        if self.read < self.held.len() {
            self.read = self.held.len().min(self.read + count);
        } else {
            self.rest.consume(count);
        }
    }
}

impl Read for Stream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Seekable(stream) => stream.read(buffer),
            Self::Forward(forward) => forward.read(buffer),
        }
    }
}

impl BufRead for Stream<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        match self {
            Self::Seekable(stream) => stream.fill_buf(),
            Self::Forward(forward) => forward.fill_buf(),
        }
    }

    fn consume(&mut self, count: usize) {
        match self {
            Self::Seekable(stream) => stream.consume(count),
            Self::Forward(forward) => forward.consume(count),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn next(stream: &mut Stream<'_>) -> u8 {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        byte[0]
    }

    fn streams(bytes: &[u8]) -> [Stream<'_>; 2] {
        let forward = Stream::Forward(Forward::new(Box::new(bytes)));
        [Stream::Seekable(Box::new(Cursor::new(bytes))), forward]
    }

    #[test]
    fn held_bytes_can_be_read_twice() {
        for mut stream in streams(&[0, 1, 2, 3, 4, 5, 6, 7]) {
            assert_eq!(next(&mut stream), 0);
            assert_eq!(stream.hold(3).unwrap(), 3);
            assert_eq!([next(&mut stream), next(&mut stream), next(&mut stream)], [1, 2, 3]);
            stream.move_by(-3).unwrap();
            assert_eq!(next(&mut stream), 1);
            // Holding more keeps what is held and not read.
            assert_eq!(stream.hold(4).unwrap(), 4);
            stream.move_by(3).unwrap();
            assert_eq!(next(&mut stream), 5);
            stream.move_by(-4).unwrap();
            let mut rest = Vec::new();
            stream.read_to_end(&mut rest).unwrap();
            assert_eq!(rest, [2, 3, 4, 5, 6, 7]);
        }
    }

    #[test]
    fn a_stream_that_cannot_seek_says_so() {
        let [_, mut stream] = streams(&[0, 1, 2]);
        assert_eq!(stream.hold(9).unwrap(), 3);
        assert!(stream.move_by(4).is_err());
        let [_, mut stream] = streams(&[0, 1, 2]);
        next(&mut stream);
        let error = stream.move_by(-1).unwrap_err();
        assert_eq!(error.to_string(), "a compressed file cannot be read backwards");
    }
}
