//! Columns that lie in files: rows are read and written at their places, by many threads at once.

use super::{error::Trouble, shape};
use puncta_core::Scene;
use rayon::prelude::*;
use std::{
    fs::File,
    io,
    ops::Range,
    sync::{
        Arc, Mutex,
        atomic::{AtomicU64, Ordering},
    },
};

/// How many bytes are read or written at once.
const PIECE: usize = 1 << 23;

/// A column in a file.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    pub(crate) file: Arc<File>,
    /// The byte of its first value.
    pub(crate) start: u64,
    /// How many bytes a value has.
    pub(crate) width: usize,
}

impl Field {
    /// The place of a row in the file.
    fn at(&self, row: u64) -> u64 {
        self.start + row * self.width as u64
    }

    /// Writes values from this row on.
    pub(crate) fn write(&self, row: u64, bytes: &[u8]) -> io::Result<()> {
        write_at(&self.file, bytes, self.at(row))
    }

    /// Lets go of the values of some rows, if the system can do that: the disk, or the memory that
    /// waits to be written there, has room for others then.
    #[cfg(target_os = "linux")]
    pub(crate) fn forget(&self, rows: &Range<u64>) {
        use rustix::fs::{FallocateFlags, fallocate};
        let how = FallocateFlags::PUNCH_HOLE | FallocateFlags::KEEP_SIZE;
        let bytes = (rows.end - rows.start) * self.width as u64;
        // It is only a favor.
        fallocate(&*self.file, how, self.at(rows.start), bytes).ok();
    }

    #[cfg(not(target_os = "linux"))]
    pub(crate) fn forget(&self, _rows: &Range<u64>) {}

    /// Reads values from this row on.
    pub(crate) fn read(&self, row: u64, bytes: &mut [u8]) -> io::Result<()> {
        read_at(&self.file, bytes, self.at(row))
    }
}

/// Reads rows to the start of a block, with all threads.
pub(crate) fn read_rows(
    fields: &[Field],
    rows: &Range<u64>,
    block: &mut Scene,
) -> Result<(), Trouble> {
    read_columns(fields, rows, shape::bytes_mut(block))
}

/// Reads rows to the start of columns, with all threads.
pub(crate) fn read_columns(
    fields: &[Field],
    rows: &Range<u64>,
    columns: Vec<&mut [u8]>,
) -> Result<(), Trouble> {
    let count = length(rows);
    let columns = fields.iter().zip(columns);
    let pieces = columns.flat_map(|(field, bytes)| {
        let pieces = bytes[..count * field.width].chunks_mut(PIECE);
        let start = field.at(rows.start);
        pieces.enumerate().map(move |(i, piece)| (field, start + (i * PIECE) as u64, piece))
    });
    let pieces: Vec<_> = pieces.collect();
    let read =
        pieces.into_par_iter().try_for_each(|(field, at, piece)| read_at(&field.file, piece, at));
    read.map_err(Trouble::reading)
}

/// Writes the first rows of a block to their places, with all threads.
pub(crate) fn write_rows(
    fields: &[Field],
    rows: &Range<u64>,
    block: &Scene,
) -> Result<(), Trouble> {
    let count = length(rows);
    let columns = fields.iter().zip(shape::bytes(block));
    let pieces = columns.flat_map(|(field, bytes)| {
        let pieces = bytes[..count * field.width].chunks(PIECE);
        let start = field.at(rows.start);
        pieces.enumerate().map(move |(i, piece)| (field, start + (i * PIECE) as u64, piece))
    });
    let pieces: Vec<_> = pieces.collect();
    let written =
        pieces.into_par_iter().try_for_each(|(field, at, piece)| write_at(&field.file, piece, at));
    written.map_err(Trouble::writing)
}

/// How many rows these are; they fit into a buffer.
pub(crate) fn length(rows: &Range<u64>) -> usize {
    usize::try_from(rows.end - rows.start).unwrap_or(usize::MAX)
}

/// Does something with all rows, `step` of them at a time, with all threads: each has a state of
/// its own, all of which are returned. The first error ends it.
pub(crate) fn in_steps<T: Send>(
    (rows, step): (u64, usize),
    start: impl Fn() -> T + Sync,
    work: impl Fn(&mut T, Range<u64>) -> Result<(), Trouble> + Sync,
) -> Result<Vec<T>, Trouble> {
    let (next, step) = (AtomicU64::new(0), step as u64);
    let (states, error) = (Mutex::new(Vec::new()), Mutex::new(None));
    let threads = (rayon::current_num_threads() as u64).min(rows.div_ceil(step));
    rayon::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|_| {
                let mut state = start();
                loop {
                    let first = next.fetch_add(step, Ordering::Relaxed);
                    if first >= rows {
                        break;
                    }
                    if let Err(trouble) = work(&mut state, first..rows.min(first + step)) {
                        next.store(rows, Ordering::Relaxed);
                        if let Ok(mut error) = error.lock() {
                            error.get_or_insert(trouble);
                        }
                    }
                }
                states.lock().map(|mut states| states.push(state)).ok();
            });
        }
    });
    match error.into_inner().ok().flatten() {
        Some(trouble) => Err(trouble),
        None => Ok(states.into_inner().unwrap_or_default()),
    }
}

#[cfg(unix)]
pub(crate) fn read_at(file: &File, bytes: &mut [u8], at: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, at)
}

#[cfg(unix)]
pub(crate) fn write_at(file: &File, bytes: &[u8], at: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::write_all_at(file, bytes, at)
}

#[cfg(windows)]
pub(crate) fn read_at(file: &File, mut bytes: &mut [u8], mut at: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match std::os::windows::fs::FileExt::seek_read(file, bytes, at)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            read => (bytes, at) = (&mut bytes[read..], at + read as u64),
        }
    }
    Ok(())
}

#[cfg(windows)]
pub(crate) fn write_at(file: &File, mut bytes: &[u8], mut at: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match std::os::windows::fs::FileExt::seek_write(file, bytes, at)? {
            0 => return Err(io::ErrorKind::WriteZero.into()),
            written => (bytes, at) = (&bytes[written..], at + written as u64),
        }
    }
    Ok(())
}
