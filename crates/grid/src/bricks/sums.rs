/*!
Checksums: a CRC-32 of each run of 4 MiB of a section.

A CRC finds every change of a single byte, indeed of up to 32 bits in a row, for certain; what is
more it finds but for one case in 2³². It is faster than any disk.
*/

use crc32fast::Hasher;

/// How many bytes have a sum together.
pub(crate) const RUN: u64 = 1 << 22;

/// The sums of a section that is written from its start to its end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    done: Vec<u32>,
    hasher: Hasher,
    /// How many bytes the hasher has seen.
    filled: u64,
}

impl Sums {
    /// Adds the next bytes of the section.
    pub(crate) fn add(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let room = usize::try_from(RUN - self.filled).unwrap_or(usize::MAX);
            let (now, rest) = bytes.split_at(room.min(bytes.len()));
            self.hasher.update(now);
            self.filled += now.len() as u64;
            if self.filled == RUN {
                self.done.push(std::mem::take(&mut self.hasher).finalize());
                self.filled = 0;
            }
            bytes = rest;
        }
    }

    /// The sums of all runs, the last of which may be short.
    pub(crate) fn finish(mut self) -> Vec<u32> {
        if self.filled > 0 {
            self.done.push(self.hasher.finalize());
        }
        self.done
    }
}

/// The sum of some bytes.
pub(crate) fn sum(bytes: &[u8]) -> u32 {
    crc32fast::hash(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_do_not_depend_on_how_bytes_come() {
        let bytes: Vec<u8> = (0..RUN + 12_345).map(|i| ((i * i) >> 7).to_le_bytes()[0]).collect();
        let mut sums = Sums::default();
        for (i, run) in bytes.chunks(70_001).enumerate() {
            let (a, b) = run.split_at(i * 7919 % run.len());
            sums.add(a);
            sums.add(b);
        }
        let (first, second) = bytes.split_at(1 << 22);
        assert_eq!(sums.finish(), [sum(first), sum(second)]);
        assert!(Sums::default().finish().is_empty());
    }
}
