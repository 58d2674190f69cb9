//! Files in chunks: what is special about files, which bytes in memory are not.

#![expect(clippy::unwrap_used, reason = "this is a test")]
#![expect(clippy::print_stdout, reason = "a test that is skipped says so")]

#[path = "common/chunks.rs"]
mod chunks;

use puncta_core::{Scene, Source, Sphere};
use puncta_io::{ErrorKind, FileSource, Format, ReadOptions};
use std::{
    fs::{self, OpenOptions},
    io::{Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread,
};
use tempfile::TempDir;

/// Many times what is read ahead: 6 MB of records.
const COUNT: u16 = 60_000;

/// A file of positions and columns, far from home.
fn file() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply");
    let mut text = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {COUNT}\nproperty float x\n\
         property float y\nproperty float z\n"
    );
    (0..22).for_each(|column| text += &format!("property float c{column}\n"));
    let mut bytes = (text + "end_header\n").into_bytes();
    for i in 0..COUNT {
        let row = (0..25).map(|column| f32::from(i) + if column == 0 { 1e6 } else { 0.5 });
        bytes.extend(row.flat_map(f32::to_le_bytes));
    }
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn into_scene(source: FileSource) -> Result<Scene, puncta_io::Error> {
    source.into_scene()
}

#[test]
fn a_file_in_chunks_is_the_whole_file() {
    let (_folder, path) = file();
    let options = ReadOptions::default();
    let whole = options.read(&path).unwrap();
    assert!(whole.scene.origin.x > 9e5 && whole.report.warnings.len() == 1);
    for limit in [1000, 50_000, 70_000] {
        let mut source = options.stream(&path).unwrap();
        assert_eq!(source.format(), Format::Ply);
        assert_eq!(source.report(), &whole.report);
        let mut scene = Scene::new(Vec::new());
        while source.append(&mut scene, limit).unwrap() == limit {}
        assert_eq!(scene, whole.scene);
    }
    assert_eq!(into_scene(options.stream(&path).unwrap()).unwrap(), whole.scene);
}

#[test]
fn chunks_that_are_cleared_have_the_columns_of_their_records() {
    let (_folder, path) = file();
    let options = ReadOptions::default().radius(1.0);
    let whole = options.read(&path).unwrap().scene;
    let mut source = options.stream(&path).unwrap();
    let (mut chunk, mut done) = (Scene::new(Vec::new()), 0);
    loop {
        chunk.records.to_mut().clear();
        chunk.attributes.scalars.iter_mut().for_each(|scalar| scalar.values.to_mut().clear());
        let appended = source.append(&mut chunk, 777).unwrap();
        chunk.validate().unwrap();
        assert_eq!(chunk.origin, whole.origin);
        assert_eq!(chunk.records[..], whole.records[done..done + appended]);
        for (found, expected) in chunk.attributes.scalars.iter().zip(&whole.attributes.scalars) {
            assert_eq!(found.name, expected.name);
            assert_eq!(found.values[..], expected.values[done..done + appended]);
        }
        done += appended;
        assert_eq!(source.remaining(), Some(u64::from(COUNT) - done as u64));
        if appended < 777 {
            break;
        }
    }
    assert_eq!(done, usize::from(COUNT));
}

/// Changes the bytes at a distance from the end of a file.
fn overwrite(path: &Path, before_end: i64, bytes: &[u8]) {
    let mut file = OpenOptions::new().write(true).open(path).unwrap();
    file.seek(SeekFrom::End(-before_end)).unwrap();
    file.write_all(bytes).unwrap();
}

#[test]
fn a_file_that_changes_is_an_error_behind_the_records_before_it() {
    type Change = fn(&Path);
    let changes: [(Change, &str); 3] = [
        (|path| overwrite(path, 100, &7_f32.to_le_bytes()), "the file changed while it was read"),
        (|path| overwrite(path, 100, &f32::NAN.to_le_bytes()), "the file changed"),
        (
            |path| {
                let file = OpenOptions::new().write(true).open(path).unwrap();
                file.set_len(file.metadata().unwrap().len() - 100).unwrap();
            },
            "the file ends in the vertices",
        ),
    ];
    for (change, text) in changes {
        let (_folder, path) = file();
        let mut source = ReadOptions::default().radius(1.0).stream(&path).unwrap();
        change(&path);
        let mut scene: Scene<Sphere> = Scene::new(Vec::new());
        let error = loop {
            match source.append(&mut scene, 1000) {
                Ok(appended) => assert_eq!(appended, 1000),
                Err(error) => break error,
            }
        };
        assert!(error.to_string().contains(text), "{error}");
        assert_eq!(error.path, path);
        assert!(scene.records.len() < usize::from(COUNT), "{text}");
        assert_eq!(source.append(&mut scene, 1000).unwrap(), 0, "{text}");
    }
}

#[test]
fn a_longer_file_is_no_matter_while_its_records_are_the_same() {
    let (_folder, path) = file();
    let options = ReadOptions::default().radius(1.0);
    let source = options.stream(&path).unwrap();
    OpenOptions::new().append(true).open(&path).unwrap().write_all(b"more").unwrap();
    assert_eq!(into_scene(source).unwrap().records.len(), usize::from(COUNT));
}

#[test]
fn a_source_that_is_dropped_reads_no_more() {
    let (_folder, path) = file();
    let bytes = Arc::new(AtomicU64::new(0));
    let seen = Arc::clone(&bytes);
    let options = ReadOptions::default()
        .radius(1.0)
        .on_progress(move |position, _| seen.store(position, Ordering::SeqCst));
    let mut source = options.stream(&path).unwrap();
    let mut scene = Scene::new(Vec::new());
    assert_eq!(source.append(&mut scene, 1).unwrap(), 1);
    drop(source);
    drop(options);
    // Nobody else holds on to what is called: the reader is gone.
    assert_eq!(Arc::strong_count(&bytes), 1);
    assert!(bytes.load(Ordering::SeqCst) < fs::metadata(&path).unwrap().len());
}

#[test]
fn a_panic_of_the_reader_is_an_error() {
    let (_folder, path) = file();
    let options = ReadOptions::default()
        .radius(1.0)
        .on_progress(|_, _| assert_ne!(thread::current().name(), Some("puncta-io"), "enough"));
    let error = into_scene(options.stream(&path).unwrap()).unwrap_err();
    assert!(matches!(error.kind, ErrorKind::Decoder(_)), "{error}");
    assert!(
        error.to_string().contains("the reader failed") && error.to_string().contains("enough")
    );
}

#[test]
fn what_is_no_file_is_refused_as_ever() {
    let folder = tempfile::tempdir().unwrap();
    let options = ReadOptions::default();
    assert!(matches!(options.stream(folder.path()).unwrap_err().kind, ErrorKind::Folder));
    let path = folder.path().join("none.xyz");
    assert!(matches!(options.stream(&path).unwrap_err().kind, ErrorKind::Io(_)));
    fs::write(&path, b"").unwrap();
    assert!(matches!(options.stream(&path).unwrap_err().kind, ErrorKind::Empty));
    fs::write(&path, b"1\n\nC nan 0 0\n").unwrap();
    let error = options.stream(&path).unwrap_err();
    assert!(matches!(error.kind, ErrorKind::NoRecords { skipped: 1 }));
}

/// Rows of atoms of this name, with something to take the place of one row near the end.
fn atoms(name: &str, odd: &str) -> String {
    let rows = (0..100_000_u32).map(|i| match i {
        99_990 => odd.to_owned(),
        _ => format!("{name} {i}.5 {} 0.25 {i}\n", i % 100),
    });
    rows.collect()
}

/// LAS 1.2 with points of format 2, whose colors have 8 bits but for one near the end.
fn scan(count: u32, color: [u8; 6]) -> Vec<u8> {
    let mut file = vec![0; 227];
    file[..4].copy_from_slice(b"LASF");
    file[24..26].copy_from_slice(&[1, 2]);
    file[94..96].copy_from_slice(&227_u16.to_le_bytes());
    file[96..100].copy_from_slice(&227_u32.to_le_bytes());
    file[104] = 2;
    file[105..107].copy_from_slice(&26_u16.to_le_bytes());
    file[107..111].copy_from_slice(&count.to_le_bytes());
    for axis in 0..3 {
        file[131 + 8 * axis..139 + 8 * axis].copy_from_slice(&0.01_f64.to_le_bytes());
        file[155 + 8 * axis..163 + 8 * axis].copy_from_slice(&1e6_f64.to_le_bytes());
    }
    for i in 0..count {
        let mut point = [0; 26];
        point[..4].copy_from_slice(&i.to_le_bytes());
        point[20..26].copy_from_slice(&[7, 0, 8, 0, 9, 0]);
        if i + 10 >= count {
            point[20..26].copy_from_slice(&color);
        }
        file.extend(point);
    }
    file
}

#[test]
fn what_the_end_tells_holds_from_the_first_chunk_on() {
    let bad = "C x 0 0 0\n";
    let texts = [
        // A row that cannot be used: from then on there are ids.
        format!("100000\ncomment\n{}", atoms("Ar", bad)),
        // No comment: the last row tells that the first one is an atom, too.
        format!("100000\n{}", atoms("He", "Ar 0 0 0 7\n")),
        format!("100000\n{}", atoms("Q", bad)),
        format!("100001\nAr nan 0 0 0\n{}", atoms("Ar", bad)),
        // Names that are no elements, and one that is.
        format!("100000\ncomment\n{}", atoms("Q", "Q 0 0 0 0\n")),
        format!("100000\ncomment\n{}", atoms("Q", "Ar 0 0 0 0\n")),
        // Ids that ascend, with one that is no number or comes twice.
        format!(
            "ITEM: NUMBER OF ATOMS\n100000\nITEM: ATOMS type x y z id\n{}",
            atoms("1", "1 0 0 0 x\n")
        ),
        format!(
            "ITEM: NUMBER OF ATOMS\n100000\nITEM: ATOMS type x y z id\n{}",
            atoms("1", "1 0 0 0 99989\n")
        ),
    ];
    let scans = [[7, 1, 8, 0, 9, 0], [7, 0, 8, 0, 9, 0]].map(|color| scan(60_000, color));
    for (index, bytes) in texts.into_iter().map(String::into_bytes).chain(scans).enumerate() {
        for options in [ReadOptions::default(), ReadOptions::default().radius(0.5)] {
            let whole = options.read_bytes(chunks::NAME, &bytes);
            assert!(whole.is_ok(), "{index}: {whole:?}");
            chunks::check(&options, &bytes, &whole);
        }
    }
}

#[test]
fn atoms_in_disorder_keep_their_ids() {
    let count = 100_000_u64;
    let rows = |step: u64| -> String {
        let row = |i| {
            let id = i * 7919 % count;
            format!("{} 1 {id} 0.5 {i}\n", id * step + 1)
        };
        (0..count).map(row).collect()
    };
    let head = format!("ITEM: NUMBER OF ATOMS\n{count}\nITEM: ATOMS id type x y z\n");
    let options = ReadOptions::default().radius(1.0);
    let [dense, sparse] = [1, 2].map(|step| (head.clone() + &rows(step)).into_bytes());
    let whole = options.read_bytes("a.dump", &dense).unwrap().scene;
    let source = options.stream_bytes("a.dump", dense).unwrap();
    let warning = "the atoms come in the order of the file, not in that of their ids";
    assert_eq!(source.report().warnings, [warning]);
    let scene = into_scene(source).unwrap();
    for index in 0..scene.records.len() {
        let rank = scene.id(u32::try_from(index).unwrap()) as usize;
        assert_eq!(scene.records[index], whole.records[rank]);
    }
    let source = options.stream_bytes("a.dump", sparse).unwrap();
    let warning = "the atoms come in the order of the file, and are known by their rows: their ids \
                   are not consecutive";
    assert_eq!(source.report().warnings, [warning]);
    let scene = into_scene(source).unwrap();
    assert_eq!(scene.attributes.ids, None);
    assert_eq!(scene.position(7).z, 7.0);
}

#[test]
fn real_files_are_the_same_in_chunks() {
    let Some(data) = std::env::var_os("PUNCTA_DATA") else {
        println!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let data = Path::new(&data);
    let names = [
        "autzen_town.laz",
        "bace_membrane.pdb",
        "bun_zipper.ply",
        "ges2.xyz",
        "mmpld",
        "sph_hilbert_18856.vtk",
    ];
    let options = ReadOptions::default();
    for name in names {
        let path = data.join(name);
        let paths: Vec<PathBuf> = match fs::read_dir(&path) {
            Ok(folder) => folder.map(|entry| entry.unwrap().path()).collect(),
            Err(_) => vec![path],
        };
        for path in paths.iter().filter(|path| Format::from_name(path).is_some()) {
            let (whole, source) = (options.read(path), options.stream(path));
            match (whole, source) {
                (Ok(whole), Ok(source)) => {
                    assert_eq!(source.report(), &whole.report, "{}", path.display());
                    let scene = into_scene(source).unwrap();
                    // As text, so that NaN is equal to itself.
                    let text = |scene: &Scene| format!("{scene:?}");
                    let is_same = whole.scene == scene || text(&whole.scene) == text(&scene);
                    assert!(is_same, "{}", path.display());
                }
                (Err(whole), Err(chunks)) => assert_eq!(whole.to_string(), chunks.to_string()),
                (whole, chunks) => panic!("{}: {whole:?}, {chunks:?}", path.display()),
            }
        }
    }
}
