/*!
TrackVis files: paths that an instrument or a program followed through a volume.

A header of 1000 bytes, then for each track the number of its points, for each point three coordinates
and some scalars, and some properties of the track. Nothing that the file says is believed before the
bytes are there.
*/

use super::{glyphs::progress::Bar, path::Path};
use anyhow::{Context, Result, bail, ensure};
use std::{
    fs::File,
    io::{BufReader, ErrorKind, Read},
};

const HEADER_BYTES: usize = 1000;

/// How many points are read at once.
const PIECE: usize = 4096;

/// What a file holds.
#[derive(Debug)]
pub(crate) struct Tracks {
    pub(crate) paths: Vec<Path>,
    /// What was left out, in words.
    pub(crate) notes: Vec<String>,
}

/// Reads a file.
pub(crate) fn read(name: &std::path::Path) -> Result<Tracks> {
    let file = File::open(name).with_context(|| name.display().to_string())?;
    let total = file.metadata().map_or(0, |about| about.len());
    let bar = Bar::bytes("reading");
    let mut reader = Reader { input: BufReader::new(file), at: 0, is_big: false };
    let told = |at: u64| bar.set_of(at, total.max(at));
    let tracks = reader.tracks(told).with_context(|| name.display().to_string());
    bar.finish();
    tracks
}

/// What the header says.
struct Header {
    /// Numbers of a point besides its coordinates.
    scalars: usize,
    /// Numbers of a track.
    properties: usize,
    /// How many tracks there are; `None` if it does not say.
    tracks: Option<u64>,
}

struct Reader<R> {
    input: R,
    /// How many bytes were read.
    at: u64,
    /// Whether the highest byte comes first.
    is_big: bool,
}

impl<R: Read> Reader<R> {
    fn tracks(&mut self, mut told: impl FnMut(u64)) -> Result<Tracks> {
        let header = self.header()?;
        let (mut paths, mut found) = (Vec::new(), 0_u64);
        let (mut empty, mut strange) = (0_u64, 0_u64);
        while header.tracks.is_none_or(|tracks| found < tracks) {
            let place = self.at;
            let Some(count) = self.count()? else {
                if let Some(tracks) = header.tracks {
                    bail!(
                        "byte 988: {tracks} tracks are promised, but the file ends after {found}"
                    );
                }
                break;
            };
            let mut path = Path::default();
            strange += self
                .points(&mut path, count, header.scalars)
                .and_then(|strange| self.skip(header.properties).map(|()| strange))
                .with_context(|| format!("track {found} at byte {place}, of {count} points"))?;
            found += 1;
            told(self.at);
            empty += u64::from(path.points.is_empty());
            // Also one without points, so that the others keep their numbers.
            paths.push(path);
        }
        let more = std::io::copy(&mut self.input, &mut std::io::sink())?;
        let mut notes = Vec::new();
        let mut note = |count: u64, what: &str| {
            if count > 0 {
                notes.push(format!("{count} {what}"));
            }
        };
        note(empty, "tracks have no points");
        note(strange, "points left out: a coordinate is not finite");
        note(more, "bytes after the last track left out");
        Ok(Tracks { paths, notes })
    }

    fn header(&mut self) -> Result<Header> {
        let mut bytes = [0; HEADER_BYTES];
        let read = self.fill(&mut bytes)?;
        ensure!(
            read == HEADER_BYTES,
            "byte {read}: the file ends within its header of {HEADER_BYTES} bytes"
        );
        ensure!(
            bytes.starts_with(b"TRACK"),
            "byte 0: this is no TrackVis file, it begins with {:?}",
            String::from_utf8_lossy(&bytes[..6])
        );
        let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        let size = word(996);
        self.is_big = i32::from_be_bytes(size) == 1000;
        ensure!(
            self.is_big || i32::from_le_bytes(size) == 1000,
            "byte 996: the size of the header is {}, not 1000",
            i32::from_le_bytes(size)
        );
        let short = |at: usize, what: &str| -> Result<usize> {
            let pair = [bytes[at], bytes[at + 1]];
            let number =
                if self.is_big { i16::from_be_bytes(pair) } else { i16::from_le_bytes(pair) };
            usize::try_from(number).with_context(|| format!("byte {at}: {number} {what}"))
        };
        let count = self.integer(word(988));
        let tracks = u64::try_from(count).with_context(|| format!("byte 988: {count} tracks"))?;
        Ok(Header {
            scalars: short(36, "scalars of a point")?,
            properties: short(238, "properties of a track")?,
            tracks: (tracks > 0).then_some(tracks),
        })
    }

    /// The number of points of the next track; `None` at the end of the file.
    fn count(&mut self) -> Result<Option<u64>> {
        let (place, mut bytes) = (self.at, [0; 4]);
        match self.fill(&mut bytes)? {
            0 => Ok(None),
            4 => {
                let count = self.integer(bytes);
                let points = u64::try_from(count);
                Ok(Some(
                    points.with_context(|| format!("byte {place}: a track of {count} points"))?,
                ))
            }
            read => bail!("byte {place}: the file ends after {read} of 4 bytes of a track"),
        }
    }

    /// Appends points to a path; returns how many were left out.
    fn points(&mut self, path: &mut Path, count: u64, scalars: usize) -> Result<u64> {
        let stride = (3 + scalars) * 4;
        // No more than what is there may ever be asked for.
        let mut buffer = vec![0; stride * PIECE];
        // There are no times in the file: a step is a unit of it.
        let (mut left, mut strange, mut time) = (count, 0, 0.0);
        while left > 0 {
            let piece = usize::try_from(left).map_or(PIECE, |left| left.min(PIECE));
            let bytes = &mut buffer[..piece * stride];
            let read = self.fill(bytes)?;
            if read < bytes.len() {
                bail!("byte {}: the file ends {left} points too early, or nearly so", self.at);
            }
            for point in buffer[..piece * stride].chunks_exact(stride) {
                let real = |k: usize| {
                    let bytes =
                        [point[4 * k], point[4 * k + 1], point[4 * k + 2], point[4 * k + 3]];
                    if self.is_big { f32::from_be_bytes(bytes) } else { f32::from_le_bytes(bytes) }
                };
                let place = [real(0), real(1), real(2)];
                time += 1.0;
                if place.iter().all(|x| x.is_finite()) {
                    path.points.push(place);
                    path.times.push(time);
                } else {
                    strange += 1;
                }
            }
            left -= piece as u64;
        }
        Ok(strange)
    }

    fn skip(&mut self, numbers: usize) -> Result<()> {
        let mut bytes = vec![0; numbers * 4];
        let read = self.fill(&mut bytes)?;
        ensure!(read == bytes.len(), "byte {}: the file ends within its properties", self.at);
        Ok(())
    }

    fn integer(&self, bytes: [u8; 4]) -> i32 {
        if self.is_big { i32::from_be_bytes(bytes) } else { i32::from_le_bytes(bytes) }
    }

    /// Reads until the buffer is full or the file ends; how many bytes that were.
    fn fill(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.input.read(&mut buffer[filled..]) {
                Ok(0) => break,
                Ok(read) => filled += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => bail!("byte {}: {error}", self.at + filled as u64),
            }
        }
        self.at += filled as u64;
        Ok(filled)
    }
}
