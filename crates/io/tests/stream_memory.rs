//! The promise of memory: a file in chunks takes a few megabytes, however many records it has.
//!
//! There is but one test here, since memory is counted over all threads.

#![expect(clippy::unwrap_used, reason = "this is a test")]
#![expect(clippy::print_stdout, reason = "what was measured is told, and what was skipped")]

#[path = "common/threads.rs"]
mod threads;

use flate2::{Compression, write::GzEncoder};
use puncta_core::{Scene, Source};
use puncta_io::ReadOptions;
use std::{
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};
use threads::with_peak;

/// The most bytes of all threads: chunks, and buffers of files.
const PEAK_MAX: usize = 5 << 20;

/// How many more the decoder of LAZ needs.
const DECODER: usize = 3 << 20;

/// Enough that all records together, of 16 bytes at least, are no few megabytes.
const COUNT: u32 = 1_000_000;

/// Writes a file of so many records.
type Make = fn(&mut dyn Write, u32) -> std::io::Result<()>;

fn ply(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {count}\n")?;
    write!(file, "property float x\nproperty float y\nproperty float z\nproperty float s\n")?;
    writeln!(file, "end_header")?;
    (0..count).try_for_each(|i| {
        let [x, y] = [i % 1000, i / 1000].map(|x| x as f32);
        file.write_all(&[x + 5000.0, y, 0.0, x * y].map(f32::to_le_bytes).concat())
    })
}

fn xyz(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    write!(file, "{count}\nsome argon, and a name that is none\nQ 0 0 0 0\n")?;
    (1..count).try_for_each(|i| writeln!(file, "Ar {} {}.5 1.25 {i}", i % 1000, i / 1000))?;
    Ok(())
}

fn pdb(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    (0..count).try_for_each(|i| {
        let [x, y] = [i % 1000, i / 1000];
        writeln!(file, "ATOM      1  CA  ALA A   1    {x:4}.000{y:4}.000   1.000  0.50 35.88")
    })
}

/// Atoms in an order of no kind.
fn lammps(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    write!(file, "ITEM: NUMBER OF ATOMS\n{count}\nITEM: ATOMS id type x y z\n")?;
    (0..count).try_for_each(|i| {
        let id = u64::from(i) * 7919 % u64::from(count) + 1;
        writeln!(file, "{id} 1 {}.5 {} 0", i % 1000, i / 1000)
    })
}

/// LAS 1.2 with points of format 2: place, intensity and color.
fn las(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    let mut header = vec![0; 227];
    header[..4].copy_from_slice(b"LASF");
    header[24..26].copy_from_slice(&[1, 2]);
    header[94..96].copy_from_slice(&227_u16.to_le_bytes());
    header[96..100].copy_from_slice(&227_u32.to_le_bytes());
    header[104] = 2;
    header[105..107].copy_from_slice(&26_u16.to_le_bytes());
    header[107..111].copy_from_slice(&count.to_le_bytes());
    for axis in 0..3 {
        header[131 + 8 * axis..139 + 8 * axis].copy_from_slice(&0.01_f64.to_le_bytes());
        header[155 + 8 * axis..163 + 8 * axis].copy_from_slice(&1e6_f64.to_le_bytes());
    }
    file.write_all(&header)?;
    (0..count).try_for_each(|i| {
        let mut point = [0; 26];
        point[..4].copy_from_slice(&(i % 1000).to_le_bytes());
        point[4..8].copy_from_slice(&(i / 1000).to_le_bytes());
        // The last color tells that all are of 16 bits.
        point[20..26].copy_from_slice(&[1, u8::from(i + 1 == count), 2, 0, 3, 0]);
        file.write_all(&point)
    })
}

fn mmpld(file: &mut dyn Write, count: u32) -> std::io::Result<()> {
    let end = 60 + 16 + 4 + 2 + 8 + 19 * u64::from(count);
    file.write_all(b"MMPLD\0\x64\0\x01\0\0\0")?;
    file.write_all(&[0; 48])?;
    file.write_all(&[76_u64.to_le_bytes(), end.to_le_bytes()].concat())?;
    file.write_all(&[1, 0, 0, 0, 2, 1])?;
    file.write_all(&u64::from(count).to_le_bytes())?;
    // Positions with a radius, and a color of three bytes.
    let mut row = [0; 19];
    (0..count).try_for_each(|i| {
        row[..4].copy_from_slice(&(i as f32).to_le_bytes());
        row[12..16].copy_from_slice(&0.5_f32.to_le_bytes());
        file.write_all(&row)
    })
}

/// Reads a file in chunks that nobody keeps; returns how many records it has.
fn stream(options: &ReadOptions, path: &Path) -> u64 {
    const LIMIT: usize = 10_000;
    let mut source = options.stream(path).unwrap();
    let (mut count, mut chunk) = (0, Scene::new(Vec::new()));
    loop {
        chunk.records.to_mut().clear();
        chunk.attributes = puncta_core::Attributes::default();
        let appended = source.append(&mut chunk, LIMIT).unwrap();
        chunk.validate().unwrap();
        count += appended as u64;
        if appended < LIMIT {
            return count;
        }
    }
}

#[test]
fn memory_does_not_depend_on_the_number_of_records() {
    let folder = tempfile::tempdir().unwrap();
    let files: [(&str, Make); 6] = [
        ("a.ply", ply),
        ("a.xyz", xyz),
        ("a.pdb", pdb),
        ("a.lammpstrj", lammps),
        ("a.las", las),
        ("a.mmpld", mmpld),
    ];
    for (name, make) in files {
        let plain = folder.path().join(name);
        let mut file = BufWriter::new(File::create(&plain).unwrap());
        make(&mut file, COUNT).unwrap();
        file.flush().unwrap();
        let packed = folder.path().join(format!("{name}.gz"));
        let file = GzEncoder::new(File::create(&packed).unwrap(), Compression::fast());
        let mut file = BufWriter::new(file);
        make(&mut file, COUNT).unwrap();
        file.into_inner().unwrap().finish().unwrap();
        for path in [plain, packed] {
            // A compressed scan is decompressed as a whole: it is not read in order.
            if path.ends_with("a.las.gz") {
                continue;
            }
            let (count, peak) = with_peak(|| stream(&ReadOptions::default(), &path));
            println!("{}: {peak} bytes", path.display());
            assert_eq!(count, u64::from(COUNT), "{}", path.display());
            assert!(peak < PEAK_MAX, "{}: {peak} bytes", path.display());
        }
    }
    let Some(data) = std::env::var_os("PUNCTA_DATA") else {
        println!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let scan = Path::new(&data).join("autzen_town.laz");
    let (count, peak) = with_peak(|| stream(&ReadOptions::default(), &scan));
    println!("{}: {peak} bytes", scan.display());
    assert_eq!(count, 2_800_109);
    assert!(peak < PEAK_MAX + DECODER, "{peak} bytes");
}
