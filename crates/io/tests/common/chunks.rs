//! Checks that a file in chunks is the same as the file as a whole.

use puncta_core::{Scene, Source};
use puncta_io::{Error, Loaded, ReadOptions};

/// What all files are called.
pub(crate) const NAME: &str = "file";

/// Reads a file in chunks and compares the outcome with that of the whole.
pub(crate) fn check(options: &ReadOptions, bytes: &[u8], whole: &Result<Loaded, Error>) {
    match (whole, stream(options, bytes)) {
        (Err(whole), Err(chunks)) => assert_eq!(whole.to_string(), chunks.to_string()),
        (Ok(whole), Ok((scene, source))) => {
            assert_eq!(whole.format, source.format());
            assert_eq!(whole.scene.records.len() as u64, source.count());
            assert_eq!(whole.report.skipped, source.report().skipped);
            let is_moved = |warning: &String| warning.starts_with("the atoms come in the order of");
            if source.report().warnings.iter().any(is_moved) {
                scene.validate().unwrap();
                assert_eq!(scene.records.len(), whole.scene.records.len());
            } else {
                assert_eq!(&whole.report, source.report());
                // As text, so that NaN is equal to itself.
                assert_eq!(format!("{:?}", whole.scene), format!("{scene:?}"));
            }
        }
        (whole, chunks) => panic!("as a whole {whole:?}, in chunks {:?}", chunks.map(|_| ())),
    }
}

fn stream(options: &ReadOptions, bytes: &[u8]) -> Result<(Scene, puncta_io::FileSource), Error> {
    let mut source = options.stream_bytes(NAME, bytes)?;
    let mut scene = Scene::new(Vec::new());
    while source.append(&mut scene, 5)? == 5 {}
    Ok((scene, source))
}
