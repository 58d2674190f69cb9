//! Mutated MMPLD and PLY files: whatever is in them, reading ends, without a panic, with memory in
//! proportion to the file; and a compressed file gives the scene that the plain one gives.

#![expect(clippy::cast_possible_truncation, reason = "the numbers of tests are small")]
#![expect(clippy::unwrap_used, reason = "a test may fail")]

#[path = "common/chunks.rs"]
mod chunks;
mod common;

use common::with_peak;
use flate2::{Compression, write::GzEncoder};
use proptest::{collection::vec, prelude::*, sample::Index};
use puncta_io::{Format, ReadOptions};
use std::io::Write;

/// How many bytes a reader may have at once for its buffers and those of its decoder.
const BUFFERS: usize = 2 << 20;

/// How many bytes it may have for each byte of a file, all columns and growing vectors included.
const BYTES_PER_BYTE: usize = 64;

/// A change of a file.
#[derive(Clone, Debug)]
enum Mutation {
    Flip(Index, u8),
    Insert(Index, Vec<u8>),
    Delete(Index, Index),
    Truncate(Index),
    Repeat(Index, Index),
    /// Puts an extreme number over the bytes here.
    Number(Index, Vec<u8>),
    /// Puts it in the place of a word.
    Word(Index, &'static str),
    /// Puts it in the place of a whole number.
    Count(Index, &'static str),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let index = any::<Index>;
    let numbers: Vec<Vec<u8>> = vec![
        vec![255; 8],
        vec![255; 4],
        vec![255; 2],
        vec![0; 8],
        vec![0; 4],
        (1_u64 << 40).to_le_bytes().to_vec(),
        (1_u64 << 63).to_le_bytes().to_vec(),
        (1_u32 << 31).to_le_bytes().to_vec(),
        (1_u32 << 20).to_le_bytes().to_vec(),
        f32::NAN.to_le_bytes().to_vec(),
        f64::INFINITY.to_le_bytes().to_vec(),
        f64::MAX.to_le_bytes().to_vec(),
    ];
    let words = vec![
        "nan",
        "-inf",
        "-1",
        "0",
        "1e400",
        "1e38",
        "18446744073709551615",
        "4294967296",
        "1000000",
        "99999999999999999999999",
        "x",
        "",
        "uchar",
        "double",
        "list",
        "binary_big_endian",
        "\n",
        "vertex",
        "element",
        "end_header",
        "2147483647",
        "-2147483648",
    ];
    let counts = vec!["0", "4", "1000000", "100000000", "4294967294", "18446744073709551615"];
    let count = proptest::sample::select(counts);
    let number = proptest::sample::select(numbers);
    let word = proptest::sample::select(words);
    prop_oneof![
        (index(), any::<u8>()).prop_map(|(at, bits)| Mutation::Flip(at, bits)),
        (index(), vec(any::<u8>(), 1..9)).prop_map(|(at, bytes)| Mutation::Insert(at, bytes)),
        (index(), index()).prop_map(|(from, to)| Mutation::Delete(from, to)),
        index().prop_map(Mutation::Truncate),
        (index(), index()).prop_map(|(from, to)| Mutation::Repeat(from, to)),
        (index(), number).prop_map(|(at, number)| Mutation::Number(at, number)),
        (index(), word).prop_map(|(at, word)| Mutation::Word(at, word)),
        (index(), count).prop_map(|(at, word)| Mutation::Count(at, word)),
    ]
}

fn mutate(file: &mut Vec<u8>, mutation: &Mutation) {
    if file.is_empty() {
        return;
    }
    let length = file.len();
    let range = |from: &Index, to: &Index| {
        let (from, to) = (from.index(length), to.index(length));
        from.min(to)..from.max(to).min(from.min(to) + 64)
    };
    match mutation {
        Mutation::Flip(at, bits) => file[at.index(length)] ^= bits,
        Mutation::Insert(at, bytes) => {
            let at = at.index(length);
            file.splice(at..at, bytes.iter().copied());
        }
        Mutation::Delete(from, to) => drop(file.drain(range(from, to))),
        Mutation::Truncate(at) => file.truncate(at.index(length)),
        Mutation::Repeat(from, to) => {
            let part = file[range(from, to)].to_vec();
            let at = from.index(length);
            file.splice(at..at, part);
        }
        Mutation::Number(at, number) => {
            let at = at.index(length);
            let end = (at + number.len()).min(length);
            file.splice(at..end, number.iter().copied());
        }
        Mutation::Word(at, word) => replace_word(file, at, word, |_| true),
        Mutation::Count(at, word) => {
            replace_word(file, at, word, |word| word.iter().all(u8::is_ascii_digit));
        }
    }
}

/// Puts `word` in the place of one of the words that are wanted.
fn replace_word(file: &mut Vec<u8>, at: &Index, word: &str, is_wanted: impl Fn(&[u8]) -> bool) {
    let end = |start: usize| {
        let length = file[start..].iter().position(u8::is_ascii_whitespace);
        length.map_or(file.len(), |length| start + length)
    };
    let is_start = |i: usize| i == 0 || file[i - 1].is_ascii_whitespace();
    let words = (0..file.len()).filter(|&i| is_start(i)).map(|start| start..end(start));
    let wanted: Vec<_> =
        words.filter(|range| !range.is_empty() && is_wanted(&file[range.clone()])).collect();
    if !wanted.is_empty() {
        file.splice(at.get(&wanted).clone(), word.bytes());
    }
}

/// An MMPLD file of two frames of lists of these types, with `particles` in each.
fn mmpld(version: u16, types: &[(u8, u8)], particles: u64) -> Vec<u8> {
    let mut frame = Vec::new();
    if version >= 102 {
        frame.extend(0.5_f32.to_le_bytes());
    }
    frame.extend((types.len() as u32).to_le_bytes());
    for &(vertex, color) in types {
        let count = if vertex == 0 { 0 } else { particles };
        frame.extend([vertex, color]);
        if matches!(vertex, 1 | 3 | 4) {
            frame.extend(0.5_f32.to_le_bytes());
        }
        let head = [4, 0, 0, 8, 0, 0, 0, 8][usize::from(color)];
        frame.extend([1, 2, 3, 4, 5, 6, 7, 8].iter().take(head));
        frame.extend(count.to_le_bytes());
        if version >= 103 {
            frame.extend([0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0].map(f32::to_le_bytes).concat());
        }
        let vertex_bytes = [0, 12, 16, 6, 24][usize::from(vertex)];
        let bytes = vertex_bytes + [0, 3, 4, 4, 12, 16, 8, 8][usize::from(color)];
        for byte in 0..count * bytes {
            // Upper bytes of numbers that are neither tiny nor huge.
            frame.push(if byte % bytes % 4 == 3 { 0x3f } else { byte as u8 });
        }
        if version == 101 {
            frame.extend([7, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 9, 9]);
        }
    }
    let mut file = b"MMPLD\0".to_vec();
    file.extend(version.to_le_bytes());
    file.extend(2_u32.to_le_bytes());
    let bounds = [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0].map(f32::to_le_bytes).concat();
    file.extend(bounds.repeat(2));
    for frames in 0..=2 {
        file.extend((84 + frames * frame.len() as u64).to_le_bytes());
    }
    file.extend(frame.repeat(2));
    file
}

/// A PLY file of all kinds of elements and properties.
fn ply(format: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {format} 1.0\ncomment c\nelement face 2\nproperty list uchar int v\n\
         property float w\nelement vertex 3\nproperty float x\nproperty double y\n\
         property int z\nproperty list ushort short l\nproperty float radius\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\nproperty uchar element\nproperty float s\n\
         element edge 1\nproperty int a\nend_header\n"
    )
    .into_bytes();
    if format == "ascii" {
        file.extend(b"2 1 2 0.5\n0 1.5\n0 1 2 1 7 0.5 1 2 3 6 1\n");
        file.extend(b"1 1e0 3 0 .25 1 2 3 7 2\n2 1 4 2 7 8 1 9 9 9 8 nan\n5\n");
        return file;
    }
    let big = format == "binary_big_endian";
    let mut add = |bytes: &[u8]| match big {
        true => file.extend(bytes.iter().rev()),
        false => file.extend(bytes),
    };
    for items in [2_u8, 0] {
        add(&[items]);
        (0..items).for_each(|_| add(&7_i32.to_le_bytes()));
        add(&0.5_f32.to_le_bytes());
    }
    for items in [0_u16, 1, 2] {
        add(&1.5_f32.to_le_bytes());
        add(&f64::from(items).to_le_bytes());
        add(&3_i32.to_le_bytes());
        add(&items.to_le_bytes());
        (0..items).for_each(|_| add(&[1, 2]));
        add(&0.5_f32.to_le_bytes());
        [1, 2, 3, 6].iter().for_each(|&byte| add(&[byte]));
        add(&9.5_f32.to_le_bytes());
    }
    add(&[0; 4]);
    file
}

/// A PLY file without lists, whose vertices are read in chunks.
fn points(format: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
         property float z\nproperty float r\nproperty float g\nproperty float b\nend_header\n"
    )
    .into_bytes();
    match format {
        "ascii" => file.extend(b"0 0.25 1 0 0 1\n".repeat(4)),
        _ => file.extend([0.25_f32.to_le_bytes(), 0.25_f32.to_be_bytes()].concat().repeat(12)),
    }
    file
}

fn seed() -> impl Strategy<Value = (Format, Vec<u8>)> {
    let types = vec((0..=4_u8, 0..=7_u8), 1..5);
    // Long frames are held in memory in another way than short ones.
    let particles = prop_oneof![9 => Just(3), 1 => Just(3000)];
    let mmpld = (100..=103_u16, types, particles)
        .prop_map(|(version, types, particles)| mmpld(version, &types, particles));
    let formats =
        || proptest::sample::select(&["ascii", "binary_little_endian", "binary_big_endian"]);
    let ply = prop_oneof![formats().prop_map(ply), formats().prop_map(points)];
    prop_oneof![
        mmpld.prop_map(|file| (Format::Mmpld, file)),
        ply.prop_map(|file| (Format::Ply, file)),
    ]
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Reads a file that has `length` bytes, and checks how much memory that took.
fn read(options: &ReadOptions, bytes: &[u8], length: usize) -> Option<String> {
    let (loaded, taken) = with_peak(|| options.read_bytes(chunks::NAME, bytes));
    assert!(taken <= BUFFERS + BYTES_PER_BYTE * length, "{taken} bytes for {length}");
    chunks::check(options, bytes, &loaded);
    match loaded {
        Ok(loaded) => {
            assert!(loaded.scene.validate().is_ok());
            assert!(!loaded.scene.records.is_empty());
            for record in &loaded.scene.records {
                assert!(record.center.iter().all(|x| x.is_finite()) && record.radius > 0.0);
            }
            Some(format!("{:?}", loaded.scene))
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            None
        }
    }
}

#[test]
fn seeds_are_valid() {
    let options = |format| ReadOptions::default().strict(true).format(format);
    for version in 100..=103 {
        let types: Vec<_> = (0..5).flat_map(|v| (0..8).map(move |c| (v, c))).collect();
        let options = options(Format::Mmpld).frame(1);
        let loaded = options.read_bytes("a", &mmpld(version, &types, 3)).unwrap();
        assert_eq!(loaded.scene.records.len(), 4 * 8 * 3, "{version}");
    }
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let options = options(Format::Ply);
        assert_eq!(options.read_bytes("a", &ply(format)).unwrap().scene.records.len(), 3);
        assert_eq!(options.read_bytes("a", &points(format)).unwrap().scene.records.len(), 4);
    }
}

proptest! {
    #[test]
    fn mutated_files_are_read_or_refused(
        (format, mut file) in seed(),
        mutations in vec(mutation(), 0..6),
        zipped_mutations in vec(mutation(), 0..3),
        (frame, strict) in (0..2_u64, any::<bool>()),
    ) {
        for mutation in &mutations {
            mutate(&mut file, mutation);
        }
        let options = ReadOptions::default().frame(frame).strict(strict).format(format);
        let mut zipped = gzip(&file);
        let plain = read(&options, &file, file.len());
        let unzipped = read(&options, &zipped, file.len());
        // A plain file may be refused for what a compressed one cannot know, not the other way.
        if plain.is_some() && !file.starts_with(&[0x1f, 0x8b]) {
            prop_assert_eq!(plain, unzipped);
        }
        for mutation in &zipped_mutations {
            mutate(&mut zipped, mutation);
        }
        read(&options, &zipped, 16 * file.len() + (1 << 18));
    }
}
