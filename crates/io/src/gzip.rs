/*!
Files compressed with gzip.

Two things can be wrong with them that nobody would notice. A small file may unpack to far more than
memory holds: so what it unpacks to is bounded by a multiple of its size that no data of points
reach. And the checksum stands at the end, where a reader that has what it wants does not go: so the
rest is unpacked as well, unless it is long.
*/

use crate::error::{ErrorKind, Fault};
use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, BufReader, Read};

/// What a file may unpack to: this, and so many times its own size. Text of points shrinks to
/// a third or a tenth, and to less than a hundredth only if it says the same thing over and over.
const FREE_BYTES: u64 = 1 << 26;
const RATIO_MAX: u64 = 256;

/// How much of what follows the frame that was read is unpacked to check it.
const REST_MAX: u64 = 1 << 26;

/// A stream of what a file unpacks to.
pub(crate) struct Gzip<R> {
    decoder: BufReader<Bounded<MultiGzDecoder<R>>>,
}

impl<R: BufRead> Gzip<R> {
    /// Unpacks a file of `length` bytes.
    pub(crate) fn new(file: R, length: u64) -> Self {
        let most = length.saturating_mul(RATIO_MAX).saturating_add(FREE_BYTES);
        let bounded = Bounded { stream: MultiGzDecoder::new(file), left: most, most };
        Self { decoder: BufReader::with_capacity(1 << 18, bounded) }
    }

    /// Checks what nobody read.
    pub(crate) fn check_rest(mut self) -> Result<(), Fault> {
        io::copy(&mut self.decoder.by_ref().take(REST_MAX), &mut io::sink())?;
        Ok(())
    }
}

impl<R: BufRead> Read for Gzip<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.decoder.read(buffer)
    }
}

impl<R: BufRead> BufRead for Gzip<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.decoder.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.decoder.consume(count);
    }
}

/// A stream that must come to its end before it has given too much.
struct Bounded<S> {
    stream: S,
    left: u64,
    most: u64,
}

impl<S: Read> Read for Bounded<S> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let told = |error: io::Error| io::Error::new(error.kind(), format!("gzip data: {error}"));
        let read = self.stream.read(buffer).map_err(told)?;
        self.left = self.left.checked_sub(read as u64).ok_or_else(|| {
            let text = format!("gzip data: they unpack to more than {} bytes", self.most);
            io::Error::new(io::ErrorKind::InvalidData, text)
        })?;
        Ok(read)
    }
}

/// All that a file unpacks to, for formats that need to go back and forth.
pub(crate) fn unpack(file: impl BufRead, length: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    Gzip::new(file, length).read_to_end(&mut bytes).map_err(ErrorKind::Io)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use crate::ReadOptions;
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write;

    fn packed(text: &[u8], level: u32) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::new(level));
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    fn read(bytes: &[u8]) -> Result<usize, String> {
        let loaded = ReadOptions::default().read_bytes("a.xyz.gz", bytes);
        loaded.map(|loaded| loaded.scene.records.len()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_wrong_checksum_is_an_error_even_after_the_frame_that_was_read() {
        let good = packed(b"1\n\nC 0 0 0\n1\n\nC 1 2 3\n", 0);
        assert_eq!(read(&good), Ok(1));
        let mut bad = good.clone();
        let two = bad.windows(5).position(|window| window == b"1 2 3").unwrap();
        bad[two] = b'7';
        let error = read(&bad).unwrap_err();
        assert!(error.starts_with("a.xyz.gz") && error.contains("gzip data"), "{error}");
        let error = read(&good[..good.len() - 3]).unwrap_err();
        assert!(error.contains("gzip data"), "{error}");
    }

    #[test]
    fn what_unpacks_to_too_much_is_refused() {
        let zeros = packed(&vec![0; 100_000_000], 9);
        let error = super::unpack(zeros.as_slice(), zeros.len() as u64).unwrap_err();
        let error = error.in_file("a.las.gz").to_string();
        assert!(error.contains("unpack to more than"), "{error}");
    }
}
