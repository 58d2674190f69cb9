//! Readers of text, on files that were damaged in all ways: no panic, and no more memory than the
//! file justifies.

#![expect(clippy::unwrap_used, reason = "this is a test")]

#[path = "common/chunks.rs"]
mod chunks;
mod common;

use common::with_peak;
use flate2::{Compression, write::GzEncoder};
use proptest::prelude::*;
use puncta_io::{Format, ReadOptions, elements::Radii};
use std::io::Write;

/// The bytes a reader may take whatever the file: buffers, and those of the decompression.
const FIXED: usize = 3 << 20;

/// Small valid files of each variant.
const FILES: [(Format, &str); 14] = [
    (Format::Xyz, "2\nwater\nO 0 0 0.1\nH 0 0.8 -0.5\n2\nagain\nO 0 0 1e-3\nHe 0 1.5D+00 -0.5\n"),
    (Format::Xyz, "2\nO 0 0 0.1\nH 0 0.8 -0.5\n3\n1 0 0\n2 0 0\n3 0 0\n"),
    (Format::Xyz, "3\n9 9 9\n0 0 0\n0 0 1\n0.5 2 0\n"),
    (
        Format::Xyz,
        "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1 \
         pbc=\"T T F\"\nFe 1 2 3 .1 .2 .3 0.5\nQ 4 5 6 .4 .5 .6 0.25\n",
    ),
    (
        Format::Xyz,
        "2\nProperties='Z:I:1:pos:R:3:color:R:3:fixed:L:1:many:I:7'\n\
         8 0 0 0 1 0.5 0 T 1 2 3 4 5 6 7\n1 1 0 0 0 1 0 F 7 6 5 4 3 2 1\n",
    ),
    (Format::Xyz, "# x y z\n0.5 0 0 1 2 3\n\n1 2 3 4 5 6\n"),
    (
        Format::Lammps,
        "ITEM: UNITS\nlj\nITEM: TIME\n0.1\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\n\
         ITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id type xs ys zs vx\n\
         3 1 0.5 0.5 0.5 1\n1 1 0.1 0.2 0.3 2\n2 2 0.9 0.8 0.7 3\n",
    ),
    (
        Format::Lammps,
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp ff\n\
         -3 17 -4\n-3 22 6\n3 33 -5\nITEM: ATOMS element xsu ysu zsu id diameter\n\
         Fe 0.5 0.5 0.5 2 0.1\nO 0.1 0.2 0.3 1 0.2\nITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\n\
         ITEM: ATOMS x yu z\n1 2 3\n",
    ),
    (
        Format::Lammps,
        "ITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS abc origin pp pp pp\n9 0 0 1\n0 9 0 2\n\
         0 0 9 3\nITEM: WEATHER\nfine\nITEM: ATOMS id xs ys zs radius\n2 0 0 1 0.5\n2 1 0 0 0.5\n",
    ),
    (Format::Lammps, "ITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS x y q\n2 0 0\n2 1 0\n"),
    (
        Format::Pdb,
        "HEADER    EXAMPLE\n\
         ATOM     32  N  AARG A  -3      11.281  86.699  94.383  0.50 35.88           N  \n\
         HETATM 1357 MG    MG   168       4.669  34.118  19.123  1.00  3.16          MG2+\nEND\n",
    ),
    (
        Format::Pdb,
        "MODEL        1\nATOM  ***** HG11 ARG A  -3    -123.456-234.567-345.678\nENDMDL\n\
         MODEL        2\nATOM  A0000  CA  ARG AA000      11.281  86.699  94.383 ****** 35.88\n\
         TER\nENDMDL\n",
    ),
    (Format::Pdb, "atom      1  ca  ala a   1       0.000   0.000   0.000\r\nend\r\n"),
    (Format::Pdb, "REMARK\nATOM\nATOM      1  CA  ALA A   1       0.000   0.000   0.000"),
];

/// Texts that are likely to do harm where a number or a word stands.
const EXTREMES: [&str; 24] = [
    "18446744073709551615",
    "18446744073709551616",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "1000000000",
    "-1",
    "0",
    "nan",
    "-inf",
    "1e308",
    "1e-320",
    "3.5e38",
    "-0",
    "",
    "\n",
    "\u{feff}",
    "\"",
    ":",
    "4096",
    "ITEM:",
    "Properties=pos:R:3:s:R:4093",
    "ITEM: ATOMS id id id x y z",
    "ENDMDL\n",
];

/// A change of a file; places are taken modulo its length.
#[derive(Clone, Debug)]
enum Damage {
    Flip(usize, u8),
    Insert(usize, u8),
    Delete(usize, usize),
    Repeat(usize, usize),
    Truncate(usize),
    /// Puts an extreme in the place of a word.
    Swap(usize, usize),
}

impl Damage {
    fn apply(&self, file: &mut Vec<u8>) {
        let length = file.len();
        if length == 0 {
            return;
        }
        let run = |start: usize, count: usize| start % length..(start % length + count).min(length);
        match *self {
            Self::Flip(place, bits) => file[place % length] ^= bits,
            Self::Insert(place, byte) => file.insert(place % length, byte),
            Self::Delete(place, count) => drop(file.drain(run(place, count))),
            Self::Repeat(place, count) => {
                let copy = file[run(place, count)].to_vec();
                let at = place % length;
                file.splice(at..at, copy);
            }
            Self::Truncate(place) => file.truncate(place % length),
            Self::Swap(word, extreme) => {
                let starts: Vec<usize> = (0..length)
                    .filter(|&i| !is_gap(file[i]) && (i == 0 || is_gap(file[i - 1])))
                    .collect();
                if let Some(&start) = starts.get(word % starts.len().max(1)) {
                    let count = file[start..].iter().take_while(|byte| !is_gap(**byte)).count();
                    let text = EXTREMES[extreme % EXTREMES.len()];
                    file.splice(start..start + count, text.bytes());
                }
            }
        }
    }
}

fn is_gap(byte: u8) -> bool {
    byte.is_ascii_whitespace() || matches!(byte, b':' | b'=' | b'"')
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = || 0..1_usize << 12;
    prop_oneof![
        (place(), any::<u8>()).prop_map(|(place, bits)| Damage::Flip(place, bits)),
        (place(), any::<u8>()).prop_map(|(place, byte)| Damage::Insert(place, byte)),
        (place(), 1..60_usize).prop_map(|(place, count)| Damage::Delete(place, count)),
        (place(), 1..60_usize).prop_map(|(place, count)| Damage::Repeat(place, count)),
        place().prop_map(Damage::Truncate),
        (place(), place()).prop_map(|(word, extreme)| Damage::Swap(word, extreme)),
        (place(), place()).prop_map(|(word, extreme)| Damage::Swap(word, extreme)),
    ]
}

fn gzip(file: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(file).unwrap();
    encoder.finish().unwrap()
}

/// Reads a file; checks what comes of it, and how much memory that took.
fn read(options: &ReadOptions, bytes: &[u8], length: usize) {
    let (result, taken) = with_peak(|| options.read_bytes(chunks::NAME, bytes));
    assert!(taken <= FIXED + 256 * length, "{taken} bytes for a file of {length}");
    chunks::check(options, bytes, &result);
    if let Ok(loaded) = result {
        loaded.scene.validate().unwrap();
        let records = &loaded.scene.records;
        let mut ids: Vec<u32> = (0..).zip(records).map(|(k, _)| loaded.scene.id(k)).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), records.len(), "ids repeat");
        for (index, record) in records.iter().enumerate() {
            assert!(record.radius > 0.0 && record.radius.is_finite());
            assert!(loaded.scene.position(index).is_finite());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_do_no_harm(
        file in 0..FILES.len(),
        damages in prop::collection::vec(damage(), 1..6),
        frame in prop_oneof![Just(0_u64), Just(1), Just(u64::MAX)],
        flags in any::<[bool; 4]>(),
    ) {
        let (format, text) = FILES[file];
        let mut bytes = text.as_bytes().to_vec();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        let [is_strict, is_found, is_gzip, is_covalent] = flags;
        let mut options = ReadOptions::default().frame(frame).strict(is_strict);
        if !is_found {
            options = options.format(format);
        }
        if is_covalent {
            options = options.radii(Radii::Covalent);
        }
        let length = bytes.len();
        read(&options, &if is_gzip { gzip(&bytes) } else { bytes }, length);
    }
}

#[test]
fn files_that_are_whole_are_read() {
    for (format, text) in FILES {
        let options = ReadOptions::default().format(format);
        let loaded = options.read_bytes("file", text.as_bytes());
        assert!(loaded.is_ok(), "{text}: {loaded:?}");
        read(&options, &gzip(text.as_bytes()), text.len());
    }
}
