//! What cannot be read, and what is said about it.

use super::*;

/// A file of version 1.0: header and table up to byte 76, then 1 list: its types at 80, its radius
/// at 82, its count at 86, its particles from 94 to 126.
fn small() -> Vec<u8> {
    let particles = [1.0, 2.0].map(|x| join(&singles(&[x, 0.0, 0.0]), &[9; 4]));
    let small = file(100, &[frame(100, &[list(100, (1, 2), &particles)])]);
    assert_eq!((small.len(), read(&small).scene.records.len()), (126, 2));
    small
}

#[test]
fn numbers_that_are_wrong_are_named() {
    for (at, bytes, text) in [
        (
            6,
            0_u16.to_le_bytes().to_vec(),
            "byte 6: the version must be 100 to 103 (0 marks a file not written to its end), not 0",
        ),
        (6, 99_u16.to_le_bytes().to_vec(), "byte 6: the version must be 100 to 103, not 99"),
        (6, 104_u16.to_le_bytes().to_vec(), "byte 6: the version must be 100 to 103, not 104"),
        (
            60,
            59_u64.to_le_bytes().to_vec(),
            "byte 60: the offset of frame 0 must be 76 or more, not 59",
        ),
        (
            60,
            127_u64.to_le_bytes().to_vec(),
            "byte 60: the offset of frame 0 must be at most the 126 bytes of the file, not 127",
        ),
        (
            68,
            76_u64.to_le_bytes().to_vec(),
            "byte 68: the end of the last frame must be 77 or more, not 76",
        ),
        (
            68,
            u64::MAX.to_le_bytes().to_vec(),
            "byte 68: the end of the last frame must be at most the 126 bytes of the file, \
             not 18446744073709551615",
        ),
        (
            8,
            2_u32.to_le_bytes().to_vec(),
            "byte 60: the offset of frame 0 must be 84 or more, not 76",
        ),
        (8, 0_u32.to_le_bytes().to_vec(), "there is no frame 0: the file has 0, counted from 0"),
        (
            8,
            u32::MAX.to_le_bytes().to_vec(),
            "byte 60: the file ends in the seek table: 34359738368 bytes are needed, 66 are left",
        ),
        (
            76,
            2_u32.to_le_bytes().to_vec(),
            "byte 126: the frame must have 2 more bytes for the header of a list, not 0",
        ),
        (76, 0_u32.to_le_bytes().to_vec(), "there is nothing to draw: 0 records were skipped"),
        (80, vec![5], "byte 80: the vertex type must be 0 to 4, not 5"),
        (81, vec![8], "byte 80: the color type must be 0 to 7, not 8"),
        (
            86,
            3_u64.to_le_bytes().to_vec(),
            "byte 86: the particles, 16 bytes each, must fit into the 32 bytes left of the \
             frame, not 3",
        ),
        (
            86,
            u64::MAX.to_le_bytes().to_vec(),
            "byte 86: the particles, 16 bytes each, must fit into the 32 bytes left of the \
             frame, not 18446744073709551615",
        ),
    ] {
        let mut file = small();
        file.splice(at..at + bytes.len(), bytes.iter().copied());
        let error = ReadOptions::default().read_bytes("a.mmpld", &file).unwrap_err().to_string();
        let separator = if text.starts_with("byte") { ", " } else { ": " };
        assert_eq!(error, format!("a.mmpld{separator}{text}"));
    }
}

#[test]
fn another_file_is_no_mmpld() {
    let options = ReadOptions::default().format(crate::Format::Mmpld);
    let error = options.read_bytes("a.bin", b"MMPGD\0 and more").unwrap_err();
    let text = r#"a.bin, byte 0: the file must start with "MMPLD\x00", not "MMPGD\x00""#;
    assert_eq!(error.to_string(), text);
}

#[test]
fn cut_files_are_errors_wherever_they_are_cut() {
    let small = small();
    for length in 1..small.len() {
        let cut = &small[..length];
        assert!(ReadOptions::default().read_bytes("a.mmpld", cut).is_err(), "{length}");
        assert!(ReadOptions::default().read_bytes("a.mmpld", &gzip(cut)).is_err(), "{length}");
    }
    let text = "a.mmpld, byte 94: the file ends in the particles: 32 bytes are needed, 26 are left";
    let error = ReadOptions::default().read_bytes("a.mmpld", &gzip(&small[..120])).unwrap_err();
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_cluster_block_must_fit() {
    let mut list = list(101, (1, 2), &[join(&singles(&[1.0; 3]), &[9; 4])]);
    let at = list.len() - 5 - 8;
    list.splice(at..at + 8, 6_u64.to_le_bytes());
    let text =
        "a.mmpld, byte 114: a cluster block must fit into the 5 bytes left of the frame, not 6";
    assert_eq!(fault(&file(101, &[frame(101, &[list])])), text);
}

#[test]
fn quantized_positions_need_a_box() {
    let mut list = list(100, (3, 2), &[join(&words(&[1, 2, 3]), &[9; 4])]);
    let mut bytes = file(100, &[frame(100, &[list.split_off(0)])]);
    bytes.splice(12..36, [0; 24]);
    let text = "a.mmpld, byte 80: quantized positions must have a box with an extent, not [0.0, \
                0.0, 0.0, 0.0, 0.0, 0.0]";
    assert_eq!(fault(&bytes), text);
}

#[test]
fn counts_that_a_compressed_file_does_not_hold_allocate_nothing() {
    // The seek table of a compressed file cannot be checked: all of it may be a lie.
    let mut file = small();
    file.splice(68..76, (1_u64 << 60).to_le_bytes());
    file.splice(86..94, (1_u64 << 50).to_le_bytes());
    let error = ReadOptions::default().read_bytes("a.mmpld", &gzip(&file)).unwrap_err();
    let text =
        "a.mmpld, byte 94: the file ends in the particles: 65536 bytes are needed, 32 are left";
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_frame_that_is_ambiguous_throughout_is_given_up() {
    // Zeros are lists without positions, of 26 bytes with their cluster block and 14 without. So
    // there are ways without number to read many, and none of them has an odd length.
    let mut bytes = frame(101, &[list(101, (2, 2), &[join(&singles(&[1.0; 4]), &[9; 4])])]);
    bytes.splice(0..4, 100_001_u32.to_le_bytes());
    bytes.extend(vec![0; 26 * 100_000 + 1]);
    let loaded = read(&file(101, &[bytes]));
    assert_eq!(loaded.scene.records.len(), 1);
    let [warning] = &loaded.report.warnings[..] else { panic!("one warning") };
    assert!(warning.starts_with("1 of the 2600052 bytes of frame 0"), "{warning}");
}
