//! Readers of LAS, LAZ and VTK, on files that were damaged in all ways: no panic, and no more
//! memory than the file justifies.

#![expect(clippy::unwrap_used, reason = "this is a test")]

#[path = "common/chunks.rs"]
mod chunks;
mod common;

use common::with_peak;
use flate2::{Compression, write::GzEncoder};
use laz::{LasZipCompressor, LazItemRecordBuilder, LazVlr, LazVlrBuilder};
use proptest::prelude::*;
use puncta_io::{Format, ReadOptions, Scalars};
use std::{
    io::{Cursor, Seek, SeekFrom, Write},
    panic,
    sync::OnceLock,
};

/// The bytes a reader may take whatever the file: buffers, and the models of the decoder.
const FIXED: usize = 12 << 20;

/// A LAS file of some points.
fn las(format: u8, version: u8, extra_bytes: u16) -> Vec<u8> {
    let mut builder = las::Builder::from((1, version));
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.extra_bytes = extra_bytes;
    if extra_bytes > 0 {
        builder.vlrs.push(las::Vlr { data: vec![7; 20], ..las::Vlr::default() });
    }
    let header = builder.into_header().unwrap();
    let format = *header.point_format();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for i in 0..POINTS {
        let x = f64::from(i);
        let point = las::Point {
            x,
            y: -x,
            z: x * 0.5,
            intensity: i * 100,
            scan_angle: f32::from(i) - 10.0,
            gps_time: format.has_gps_time.then_some(x * 1e5),
            color: format.has_color.then(|| las::Color::new(i, i * 1000, 7)),
            waveform: format.has_waveform.then(Default::default),
            nir: format.has_nir.then_some(i),
            extra_bytes: vec![7; usize::from(extra_bytes)],
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

const POINTS: u16 = 30;

/// Compresses a LAS file with chunks of a size, or of different sizes.
fn compress(file: &[u8], chunk_size: Option<u32>, extra_bytes: u16) -> Vec<u8> {
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
    let record_bytes = usize::from(u16::from_le_bytes([file[105], file[106]]));
    let items = LazItemRecordBuilder::default_for_point_format_id(file[104], extra_bytes).unwrap();
    let builder = LazVlrBuilder::new(items);
    let vlr = match chunk_size {
        Some(size) => builder.with_fixed_chunk_size(size).build(),
        None => builder.with_variable_chunk_size().build(),
    };
    let mut data = Vec::new();
    vlr.write_to(&mut data).unwrap();
    let mut record = vec![0; 54];
    record[2..16].copy_from_slice(LazVlr::USER_ID.as_bytes());
    record[18..20].copy_from_slice(&LazVlr::RECORD_ID.to_le_bytes());
    record[20..22].copy_from_slice(&u16::try_from(data.len()).unwrap().to_le_bytes());
    record.extend(data);
    let mut laz = file[..start].to_vec();
    laz.extend(&record);
    laz[96..100].copy_from_slice(&u32::try_from(start + record.len()).unwrap().to_le_bytes());
    laz[100] += 1;
    laz[104] |= 0x80;
    let mut stream = Cursor::new(laz);
    stream.seek(SeekFrom::End(0)).unwrap();
    let mut compressor = LasZipCompressor::new(stream, vlr).unwrap();
    let points = &file[start..start + usize::from(POINTS) * record_bytes];
    let (first, rest) = points.split_at(11 * record_bytes);
    compressor.compress_many(first).unwrap();
    if chunk_size.is_none() {
        compressor.finish_current_chunk().unwrap();
    }
    compressor.compress_many(rest).unwrap();
    compressor.done().unwrap();
    compressor.into_inner().into_inner()
}

const HEAD: &str = "# vtk DataFile Version 5.1\ntitle\n";

const TEXTS: [&str; 3] = [
    "ASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 1 1 2 2 2\nVERTICES 3 6\n1 0 1 1 1 2\n\
     METADATA\nINFORMATION 0\n\nCELL_DATA 3\nSCALARS c int\nLOOKUP_TABLE own\n1 2 3\n\
     LOOKUP_TABLE own 1\n0 0 1 1\nPOINT_DATA 3\nSCALARS a float 2\nLOOKUP_TABLE default\n\
     1 2 3 4 5 6\nVECTORS v double\n1 2 3 4 5 6 7 8 9\nTENSORS t float\n1 2 3 4 5 6 7 8 9 1 2 3 \
     4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\nCOLOR_SCALARS paint 3\n0 0.5 1 0 0.5 1 0 0.5 1\n\
     FIELD f 2\nradius 1 3 float\n1 2 3\nnames 1 3 string\na\nb\nc\n",
    "ASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 double\n0 0 0 1 1 1\nCELLS 2 1\n\
     OFFSETS vtktypeint64\n0 1\nCONNECTIVITY vtktypeint64\n1\nCELL_TYPES 1\n1\nPOINT_DATA 2\n\
     GLOBAL_IDS ids vtkIdType\n1 2\nNORMALS n float\n0 0 1 0 0 1\n",
    "ASCII\nDATASET STRUCTURED_GRID\nFIELD meta 1\nTIME 1 1 double\n0.5\nDIMENSIONS 1 1 2\n\
     POINTS 2 int\n0 0 0 1 1 1\nPOINT_DATA 2\nTEXTURE_COORDINATES uv 2 float\n0 1 1 0\n\
     EDGE_FLAGS e bit\n1 0\n",
];

/// A binary file with data of all kinds.
fn binary() -> Vec<u8> {
    let mut file =
        format!("{HEAD}BINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n").into_bytes();
    file.extend((0..12_u8).flat_map(|i| f32::from(i).to_be_bytes()));
    file.extend(b"\nCELLS 3 2\nOFFSETS vtktypeint64\n");
    file.extend([0; 24]);
    file.extend(b"\nCONNECTIVITY vtktypeint64\n");
    file.extend([0; 16]);
    file.extend(b"\nCELL_TYPES 2\n");
    file.extend([0; 8]);
    file.extend(b"\nCELL_DATA 2\nNORMALS n float\n");
    file.extend([0; 24]);
    file.extend(b"\nPOINT_DATA 4\nSCALARS a short 1\nLOOKUP_TABLE own\n");
    file.extend([1; 8]);
    file.extend(b"LOOKUP_TABLE own 2\n");
    file.extend([1; 8]);
    file.extend(b"\nVECTORS v double\n");
    file.extend((0..12_u8).flat_map(|i| f64::from(i).to_be_bytes()));
    file.extend(b"\nFIELD f 4\nRGB 3 4 unsigned_char\n");
    file.extend([200; 12]);
    file.extend(b"\nMETADATA\nINFORMATION 0\n\nnames 1 4 string\n");
    file.extend([0xc0 | 2, b'a', b'b', 0x80, 1, b'c', 0xc0, 0xc0]);
    file.extend(b"\nbits 1 4 bit\n\x0f\nradius 1 4 float\n");
    file.extend((1..5_u8).flat_map(|i| f32::from(i).to_be_bytes()));
    file.push(b'\n');
    file
}

/// Small valid files of each variant.
fn files() -> &'static [(Format, Vec<u8>)] {
    static FILES: OnceLock<Vec<(Format, Vec<u8>)>> = OnceLock::new();
    FILES.get_or_init(|| {
        let mut files: Vec<_> =
            TEXTS.iter().map(|text| (Format::Vtk, format!("{HEAD}{text}").into_bytes())).collect();
        files.push((Format::Vtk, binary()));
        let variants = [
            (0, 1, 0),
            (1, 1, 0),
            (2, 2, 3),
            (3, 4, 0),
            (4, 3, 0),
            (6, 4, 0),
            (7, 4, 3),
            (10, 4, 2),
        ];
        for (format, version, extra_bytes) in variants {
            let plain = las(format, version, extra_bytes);
            files.push((Format::Las, compress(&plain, Some(50_000), extra_bytes)));
            files.push((Format::Las, compress(&plain, Some(7), extra_bytes)));
            files.push((Format::Las, compress(&plain, None, extra_bytes)));
            files.push((Format::Las, plain));
        }
        files
    })
}

/// Texts that are likely to do harm where a number or a word stands.
const WORDS: [&str; 22] = [
    "18446744073709551615",
    "18446744073709551616",
    "6148914691236517206",
    "4294967296",
    "9223372036854775807",
    "1000000000",
    "10000",
    "-1",
    "0",
    "1",
    "nan",
    "-inf",
    "1e308",
    "3.5e38",
    "string",
    "bit",
    "unsigned_char",
    "METADATA",
    "FIELD",
    "LOOKUP_TABLE",
    "BINARY",
    "ASCII",
];

/// Numbers that are likely to do harm in a header.
const NUMBERS: [[u8; 8]; 10] = [
    [255; 8],
    [0; 8],
    [255, 255, 255, 127, 0, 0, 0, 0],
    [0, 0, 0, 128, 0, 0, 0, 0],
    [255, 255, 255, 255, 255, 255, 255, 127],
    [0, 0, 16, 0, 0, 0, 0, 0],
    [0, 0, 0, 0, 0, 0, 0xf8, 127],
    [0, 0, 0, 0, 0, 0, 0xf0, 127],
    [0, 0, 0, 0, 0, 0, 0xe0, 127],
    [1, 0, 0, 0, 0, 0, 0, 0],
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
    Word(usize, usize),
    /// Puts the first bytes of an extreme over others.
    Number(usize, usize, u32),
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
            Self::Word(word, extreme) => {
                let is_gap = |byte: u8| byte.is_ascii_whitespace();
                let starts: Vec<usize> = (0..length)
                    .filter(|&i| !is_gap(file[i]) && (i == 0 || is_gap(file[i - 1])))
                    .collect();
                if let Some(&start) = starts.get(word % starts.len().max(1)) {
                    let count = file[start..].iter().take_while(|byte| !is_gap(**byte)).count();
                    let text = WORDS[extreme % WORDS.len()];
                    file.splice(start..start + count, text.bytes());
                }
            }
            Self::Number(place, extreme, size) => {
                let run = run(place, 1 << size);
                let number = NUMBERS[extreme % NUMBERS.len()];
                let number =
                    if size == 3 { number } else { number.map(|byte| byte.max(number[0])) };
                let bytes = &number[..run.len()];
                file[run].copy_from_slice(bytes);
            }
        }
    }
}

fn damage() -> impl Strategy<Value = Damage> {
    // Numbers of headers are at the start of files.
    let place = || prop_oneof![3 => 0..1_usize << 12, 1 => 90..380_usize, 2 => 0..700_usize];
    prop_oneof![
        (place(), any::<u8>()).prop_map(|(place, bits)| Damage::Flip(place, bits)),
        (place(), any::<u8>()).prop_map(|(place, byte)| Damage::Insert(place, byte)),
        (place(), 1..60_usize).prop_map(|(place, count)| Damage::Delete(place, count)),
        (place(), 1..60_usize).prop_map(|(place, count)| Damage::Repeat(place, count)),
        place().prop_map(Damage::Truncate),
        (place(), place()).prop_map(|(word, extreme)| Damage::Word(word, extreme)),
        (place(), place(), 0..4_u32)
            .prop_map(|(at, extreme, size)| Damage::Number(at, extreme, size)),
        (place(), place(), 0..4_u32)
            .prop_map(|(at, extreme, size)| Damage::Number(at, extreme, size)),
        // The fields of LAS that count or place something.
        (
            prop::sample::select(vec![94_usize, 96, 100, 104, 105, 107, 131, 155, 247]),
            place(),
            0..4_u32
        )
            .prop_map(|(at, extreme, size)| Damage::Number(at, extreme, size)),
    ]
}

fn gzip(file: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(file).unwrap();
    encoder.finish().unwrap()
}

/// Keeps quiet about panics of the decoder of LAZ, which are caught.
fn quiet() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        let hook = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !info.location().is_some_and(|location| location.file().contains("laz-")) {
                hook(info);
            }
        }));
    });
}

/// Reads a file; checks what comes of it, and how much memory that took.
fn read(options: &ReadOptions, bytes: &[u8], length: usize) {
    quiet();
    let (result, taken) = with_peak(|| options.read_bytes(chunks::NAME, bytes));
    assert!(taken <= FIXED + 256 * length, "{taken} bytes for a file of {length}");
    chunks::check(options, bytes, &result);
    if let Ok(loaded) = result {
        loaded.scene.validate().unwrap();
        for (index, record) in loaded.scene.records.iter().enumerate() {
            assert!(record.radius > 0.0 && record.radius.is_finite());
            assert!(loaded.scene.position(index).is_finite());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_do_no_harm(
        file in prop_oneof![0..4_usize, 4..files().len()],
        damages in prop::collection::vec(damage(), 1..4),
        flags in any::<[bool; 5]>(),
    ) {
        let (format, bytes) = &files()[file];
        let mut bytes = bytes.clone();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        let [is_strict, is_found, is_gzip, has_radius, is_bare] = flags;
        let mut options = ReadOptions::default().strict(is_strict);
        if !is_found {
            options = options.format(*format);
        }
        if has_radius {
            options = options.radius(0.5);
        }
        if is_bare {
            options = options.scalars(Scalars::Named(vec!["intensity".into()]));
        }
        let length = bytes.len();
        read(&options, &if is_gzip { gzip(&bytes) } else { bytes }, length);
    }
}

#[test]
fn files_that_are_whole_are_read() {
    for (index, (format, bytes)) in files().iter().enumerate() {
        let options = ReadOptions::default().format(*format);
        for bytes in [bytes, &gzip(bytes)] {
            let loaded = options.read_bytes("file", bytes);
            assert!(loaded.is_ok(), "{index}: {}", loaded.unwrap_err());
        }
        read(&options, bytes, bytes.len());
        read(&options, &gzip(bytes), bytes.len());
    }
}
