//! Files of all point formats, written by the `las` and `laz` crates, and damaged ones.

use crate::{Error, Format, ReadOptions, Scalars, options::Loaded};
use laz::{LasZipCompressor, LazItemRecordBuilder, LazVlr, LazVlrBuilder};
use std::io::{Cursor, Seek, SeekFrom};

/// Points of a wavy surface far from the origin.
fn points(format: las::point::Format, count: u16, color_scale: u16) -> Vec<las::Point> {
    let point = |i: u16| las::Point {
        x: 637_000.0 + f64::from(i) * 0.25,
        y: 851_000.0 - f64::from(i % 17),
        z: 450.0 + f64::from(i % 5) * 0.01,
        intensity: i * 3,
        return_number: 1 + u8::try_from(i % 3).unwrap(),
        number_of_returns: 3,
        classification: las::point::Classification::new(u8::try_from(2 + i % 4).unwrap()).unwrap(),
        scan_angle: f32::from(i % 60) - 30.0,
        point_source_id: 7 + i % 2,
        gps_time: format.has_gps_time.then(|| f64::from(i) * 0.001),
        color: format.has_color.then(|| {
            las::Color::new(i % 256 * color_scale, 10 * color_scale, (255 - i % 256) * color_scale)
        }),
        waveform: format.has_waveform.then(Default::default),
        nir: format.has_nir.then_some(i),
        extra_bytes: vec![u8::try_from(i % 251).unwrap(); usize::from(format.extra_bytes)],
        ..las::Point::default()
    };
    (0..count).map(point).collect()
}

fn transform(offset: f64) -> las::Transform {
    las::Transform { scale: 0.01, offset }
}

/// A file that the `las` crate writes.
pub(super) fn write(format: u8, version: (u8, u8), extra_bytes: u16, color_scale: u16) -> Vec<u8> {
    let mut builder = las::Builder::from(version);
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.extra_bytes = extra_bytes;
    builder.transforms =
        las::Vector { x: transform(637_000.0), y: transform(851_000.0), z: transform(0.0) };
    builder.vlrs.push(las::Vlr {
        user_id: "somebody".into(),
        record_id: 1,
        description: "a record to be passed over".into(),
        data: vec![1; 99],
    });
    let header = builder.into_header().unwrap();
    let points = points(*header.point_format(), 1000, color_scale);
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for point in points {
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

/// The chunks of a file that is to be compressed.
#[derive(Clone, Copy)]
pub(super) enum Chunking {
    Fixed(u32),
    Variable,
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// Compresses a LAS file with the `laz` crate.
pub(super) fn compress(file: &[u8], chunking: Chunking) -> Vec<u8> {
    let (start, format) = (u32_at(file, 96), file[104]);
    let record_bytes = usize::from(u16::from_le_bytes([file[105], file[106]]));
    let format_bytes = super::header::FORMATS[usize::from(format)].0;
    let extra = u16::try_from(record_bytes as u64 - format_bytes).unwrap();
    let items = LazItemRecordBuilder::default_for_point_format_id(format, extra).unwrap();
    let vlr = match chunking {
        Chunking::Fixed(size) => LazVlrBuilder::new(items).with_fixed_chunk_size(size).build(),
        Chunking::Variable => LazVlrBuilder::new(items).with_variable_chunk_size().build(),
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
    let points = &file[start..start + 1000 * record_bytes];
    let mut stream = Cursor::new(laz);
    stream.seek(SeekFrom::End(0)).unwrap();
    let mut compressor = LasZipCompressor::new(stream, vlr).unwrap();
    match chunking {
        Chunking::Fixed(_) => compressor.compress_many(points).unwrap(),
        Chunking::Variable => {
            for (index, chunk) in points.chunks(300 * record_bytes).enumerate() {
                let (part, rest) = chunk.split_at(chunk.len().min((index + 1) * record_bytes));
                compressor.compress_many(part).unwrap();
                if !rest.is_empty() {
                    compressor.finish_current_chunk().unwrap();
                    compressor.compress_many(rest).unwrap();
                }
                if index < 3 {
                    compressor.finish_current_chunk().unwrap();
                }
            }
        }
    }
    compressor.done().unwrap();
    compressor.into_inner().into_inner()
}

fn read(bytes: &[u8]) -> Result<Loaded, Error> {
    ReadOptions::default().radius(0.1).read_bytes("scan.las", bytes)
}

fn message(bytes: &[u8]) -> String {
    read(bytes).map(|_| ()).unwrap_err().to_string()
}

/// Checks all that is read of a file of [`points`].
fn check(bytes: &[u8], format: u8) {
    let loaded = read(bytes).unwrap();
    assert_eq!(loaded.format, Format::Las);
    assert_eq!(loaded.report, crate::Report::default(), "format {format}");
    let scene = loaded.scene;
    scene.validate().unwrap();
    let format = las::point::Format::new(format).unwrap();
    let points = points(format, 1000, 256);
    assert_eq!(scene.records.len(), points.len());
    for (i, point) in points.iter().enumerate() {
        let error = scene.position(i) - glam::DVec3::new(point.x, point.y, point.z);
        assert!(error.abs().max_element() < 1e-5, "{format} {i}: {error}");
        let scalar = |name| scene.scalar(name).unwrap().values[i];
        assert_eq!(scalar("intensity"), f32::from(point.intensity));
        assert_eq!(scalar("return_number"), f32::from(point.return_number));
        assert_eq!(scalar("classification"), f32::from(u8::from(point.classification)));
        assert_eq!(scalar("point_source"), f32::from(point.point_source_id));
        assert!((scalar("scan_angle") - point.scan_angle).abs() < 0.0061);
        let color = point.color.map(|color| [color.red, color.green, color.blue]);
        let color = color.map(|color| color.map(|channel| u8::try_from(channel >> 8).unwrap()));
        let stored = scene.attributes.colors.as_ref().map(|colors| colors[i]);
        assert_eq!(stored, color.map(|[r, g, b]| [r, g, b, 255]));
    }
}

#[test]
fn all_formats_are_read_plain_and_compressed() {
    for (format, version) in (0..=10).map(|format| (format, if format < 6 { 3 } else { 4 })) {
        for extra_bytes in [0, 5] {
            let plain = write(format, (1, version), extra_bytes, 256);
            check(&plain, format);
            for chunking in [Chunking::Fixed(50_000), Chunking::Fixed(170), Chunking::Variable] {
                check(&compress(&plain, chunking), format);
            }
        }
    }
}

#[test]
fn a_file_without_chunks_is_read() {
    let chunked = compress(&write(3, (1, 2), 5, 256), Chunking::Fixed(50_000));
    let start = u32_at(&chunked, 96);
    let record = start - 34 - 4 * 6;
    assert_eq!(chunked[record], 2);
    let mut whole = chunked;
    whole[record] = 1;
    whole.drain(start..start + 8);
    check(&whole, 3);
}

#[test]
fn old_versions_are_read() {
    for minor in 0..=4 {
        check(&write(1, (1, minor), 0, 256), 1);
    }
    check(&write(3, (1, 2), 0, 256), 3);
}

#[test]
fn only_wanted_scalars_are_kept() {
    let options = ReadOptions::default().scalars(Scalars::Named(vec!["classification".into()]));
    let scene = options.read_bytes("a.laz", &write(2, (1, 2), 0, 256)).unwrap().scene;
    let names: Vec<_> = scene.attributes.scalars.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["classification"]);
    assert_eq!(scene.attributes.scalars[0].values[..5], [2.0, 3.0, 4.0, 5.0, 2.0]);
    // In layers only some fields are decoded at all; that must not change the others.
    let file = compress(&write(10, (1, 4), 5, 256), Chunking::Fixed(170));
    let all = read(&file).unwrap().scene;
    for name in ["intensity", "classification", "return_number", "scan_angle", "point_source"] {
        let options = ReadOptions::default().radius(0.1);
        let options = options.scalars(Scalars::Named(vec![name.into()]));
        let scene = options.read_bytes("a.laz", &file).unwrap().scene;
        assert_eq!(scene.records, all.records);
        assert_eq!(scene.attributes.colors, all.attributes.colors);
        assert_eq!(scene.attributes.scalars, [all.scalar(name).unwrap().clone()]);
    }
}

#[test]
fn the_depth_of_colors_is_that_of_the_whole_file() {
    let colors = |file: &[u8]| read(file).unwrap().scene.attributes.colors;
    let eight = colors(&write(2, (1, 2), 0, 1)).unwrap();
    assert_eq!(eight[..2], [[0, 10, 255, 255], [1, 10, 254, 255]]);
    // One large value in the last point makes 16 bits of all values before.
    let mut file = write(2, (1, 2), 0, 1);
    let end = file.len();
    file[end - 6..].copy_from_slice(&[0, 0, 0, 0x80, 0xff, 0xff]);
    let sixteen = colors(&file).unwrap();
    assert!(sixteen[..999].iter().all(|&color| color == [0, 0, 0, 255]));
    assert_eq!(sixteen[999], [0, 0x80, 0xff, 255]);
    // No color at all is no column.
    let black = read(&write(2, (1, 2), 0, 0)).unwrap();
    assert_eq!(black.scene.attributes.colors, None);
    assert_eq!(black.report.warnings, ["the colors are left out: all of them are 0"]);
}

#[test]
fn a_header_that_is_wrong_names_the_byte() {
    let file = write(3, (1, 4), 0, 256);
    let with = |at: usize, bytes: &[u8]| {
        let mut file = file.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        message(&file)
    };
    let nan = f64::NAN.to_le_bytes();
    for (at, bytes, expected) in [
        (25, &[5][..], "byte 24: the version must be 1.0 to 1.4, not 1.5"),
        (94, &[227, 0], "byte 94: the header of version 1.4 must have 375 bytes, not 227"),
        (
            96,
            &[0, 0, 0, 9],
            "byte 96: the points must start after the header of 375 bytes and within the file of \
             34528 bytes, not at byte 150994944",
        ),
        (104, &[11], "byte 104: the point format must be 0 to 10, not 11"),
        (105, &[33, 0], "byte 105: a record of point format 3 must have 34 bytes, not 33"),
        (
            247,
            &[255; 8],
            "byte 528: the file ends in its 18446744073709551615 points of 34 bytes: \
             18446744073709551615 bytes are needed, 34000 are left",
        ),
        (
            139,
            &[0; 8],
            "byte 139: the scale of a coordinate must be a finite number other than 0, not 0",
        ),
        (171, &nan, "byte 171: the offset of a coordinate must be a finite number, not NaN"),
    ] {
        assert_eq!(with(at, bytes), format!("scan.las, {expected}"));
    }
    let short = "scan.las, byte 0: the file ends in the header: 227 bytes are needed, 200 are left";
    assert_eq!(message(&file[..200]), short);
    let cut = "scan.las, byte 528: the file ends in its 1000 points of 34 bytes: \
               34000 bytes are needed, 33999 are left";
    assert_eq!(message(&file[..file.len() - 1]), cut);
    let options = ReadOptions::default().format(Format::Las);
    let error = options.read_bytes("scan.las", b"LASER beams").unwrap_err();
    let text = "scan.las, byte 0: the file must start with \"LASF\", not \"LASE\"";
    assert_eq!(error.to_string(), text);
    let error = ReadOptions::default().frame(2).read_bytes("scan.las", &file).unwrap_err();
    let text = "scan.las: there is no frame 2: the file has 1, counted from 0";
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_header_that_does_not_fit_the_points_is_a_warning() {
    let mut file = write(0, (1, 4), 0, 256);
    file[107..111].copy_from_slice(&7_u32.to_le_bytes());
    file[211..219].copy_from_slice(&450.02_f64.to_le_bytes());
    let warnings = read(&file).unwrap().report.warnings;
    assert_eq!(
        warnings,
        [
            "the older field for the number of points says 7, not 1000",
            "z is 450.0 to 450.04, but the header says 450.0 to 450.02",
        ]
    );
}

#[test]
fn positions_that_are_too_large_are_skipped() {
    let mut file = write(0, (1, 2), 0, 256);
    file[131..139].copy_from_slice(&1e300_f64.to_le_bytes());
    let report = read(&file).unwrap().report;
    assert_eq!(report.skipped_count(), 999);
    assert_eq!(report.skipped[0].problem, crate::Problem::Position);
    assert_eq!(report.skipped[0].first, crate::Place::Byte(227 + 54 + 99 + 20));
}

#[test]
fn damaged_compression_is_told() {
    let file = compress(&write(7, (1, 4), 3, 256), Chunking::Fixed(300));
    let record = u32_at(&file, 96) - 34 - 3 * 6;
    let start = u32_at(&file, 96);
    let with = |at: usize, bytes: &[u8]| {
        let mut file = file.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        read(&file)
    };
    let text = |at, bytes: &[u8]| with(at, bytes).unwrap_err().to_string();
    assert_eq!(
        text(record, &[2, 0]),
        format!("scan.las, byte {record}: the compression must fit point format 7, not 2")
    );
    assert_eq!(
        text(record + 2, &[1]),
        format!("scan.las, byte {}: the coder must be 0, not 1", record + 2)
    );
    assert_eq!(
        text(record + 34, &[6]),
        format!(
            "scan.las, byte {}: the compressed items must be those of point format 7, not \
             [(Point10, 3), (RGB14, 3), (Byte14(3), 3)]",
            record + 32
        )
    );
    assert_eq!(
        text(247, &u64::MAX.to_le_bytes()),
        format!(
            "scan.las, byte {start}: the points in {} compressed bytes must be at most {}, \
             not 18446744073709551615",
            file.len() - start,
            (1 << 20) + 64 * (file.len() - start)
        )
    );
    let sizes = start + 8 + 39 + 4;
    let error = text(sizes, &[255; 4]);
    let expected = format!("scan.las, byte {sizes}: the file ends in the layers of a chunk: 42949");
    assert!(error.starts_with(&expected), "{error}");
    assert_eq!(
        text(record - 54 + 2, b"somebody else"),
        "scan.las, byte 375: a file of compressed points must have a record \"laszip encoded\", \
         not none"
    );
    // A table that cannot be used is no harm: the chunks have one size.
    let loaded = with(start, &[255; 8]).unwrap();
    assert_eq!(loaded.scene.records.len(), 1000);
    assert!(loaded.report.warnings[0].starts_with("the table of chunks is damaged and not used: "));
}

#[test]
fn damaged_points_are_told() {
    let plain = write(1, (1, 2), 0, 256);
    let file = compress(&plain, Chunking::Variable);
    let start = u32_at(&file, 96);
    let mut told = [0; 3];
    for at in (start + 8 + 28..file.len()).step_by(41) {
        let mut file = file.clone();
        file[at] ^= 0x10;
        match read(&file) {
            Err(_) => told[0] += 1,
            Ok(loaded) if loaded.report != crate::Report::default() => told[1] += 1,
            Ok(_) => told[2] += 1,
        }
    }
    // The format has no checksums: a little damage to colors and the like cannot be seen.
    assert!(told[0] > 10 * (told[1] + told[2]), "errors, warnings, nothing: {told:?}");
    // Without its table a file with chunks of any size cannot be read.
    let mut file = compress(&plain, Chunking::Variable);
    file[start..start + 8].fill(255);
    let error = message(&file);
    assert!(error.contains("the table of chunks must start at byte"), "{error}");
}

#[test]
fn the_town_is_read() {
    let Some(folder) = std::env::var_os("PUNCTA_DATA") else {
        eprintln!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let path = std::path::Path::new(&folder).join("autzen_town.laz");
    let scene = ReadOptions::default().radius(0.5).read(&path).unwrap().scene;
    assert_eq!(scene.records.len(), 2_800_109);
    assert!(scene.origin.x != 0.0 && scene.origin.y != 0.0);
    let header = las::Reader::from_path(&path).unwrap().header().bounds();
    let bounds = scene.bounds();
    let corners = [(bounds.min + 0.5, header.min), (bounds.max - 0.5, header.max)];
    for (found, said) in corners {
        let error = found - glam::DVec3::new(said.x, said.y, said.z);
        assert!(error.abs().max_element() <= 0.005, "{found} {said:?}");
    }
    let colors = scene.attributes.colors.unwrap();
    let largest = colors.iter().map(|color| color[0]).max();
    let distinct: std::collections::BTreeSet<u8> = colors.iter().map(|color| color[1]).collect();
    assert!(largest > Some(250) && distinct.len() >= 200, "{largest:?} {}", distinct.len());
}
