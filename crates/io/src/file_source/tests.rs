//! Tests of files in chunks: whatever a file is, chunks of it are what a scene of it is.

use super::*;
use puncta_core::Attributes;

/// Reads a file in chunks of at most `limit` records, into one scene.
fn stream(
    options: &ReadOptions,
    (name, bytes): (&Path, &[u8]),
    limit: usize,
) -> Result<Loaded, Error> {
    let mut source = options.stream_bytes(name, bytes)?;
    let mut scene = Scene::new(Vec::new());
    loop {
        let before = scene.records.len();
        let appended = source.append(&mut scene, limit)?;
        assert_eq!(scene.records.len(), before + appended);
        assert_eq!(source.remaining(), Some(source.count() - scene.records.len() as u64));
        if appended < limit {
            break;
        }
    }
    assert_eq!(source.remaining(), Some(0));
    assert_eq!(source.append(&mut scene, limit)?, 0);
    let mut centers = Bounds::EMPTY;
    (0..scene.records.len()).for_each(|index| centers.add(scene.position(index)));
    assert_eq!(source.centers(), centers);
    Ok(Loaded { scene, format: source.format(), report: source.report().clone() })
}

/// A scene with all its numbers as bits, so that NaN is equal to itself and zeros are not.
fn bits(scene: &Scene) -> impl PartialEq + std::fmt::Debug {
    let Attributes { ids, colors, elements, scalars } = &scene.attributes;
    let scalar = |scalar: &puncta_core::Scalar| {
        let values: Vec<u32> = scalar.values.iter().map(|value| value.to_bits()).collect();
        (scalar.name.clone(), values)
    };
    let record = |sphere: &Sphere| (sphere.center.map(f32::to_bits), sphere.radius.to_bits());
    (
        scene.origin.to_array().map(f64::to_bits),
        scene.records.iter().map(record).collect::<Vec<_>>(),
        (ids.clone(), colors.clone(), elements.clone()),
        scalars.iter().map(scalar).collect::<Vec<_>>(),
    )
}

/// Checks that a file that was read as a whole is the same in chunks.
pub(crate) fn assert_same(
    options: &ReadOptions,
    (name, bytes): (&Path, &[u8]),
    loaded: &Result<Loaded, Error>,
) {
    for limit in [1, 7, usize::MAX] {
        match (loaded, stream(options, (name, bytes), limit)) {
            (Err(whole), Err(chunks)) => assert_eq!(whole.to_string(), chunks.to_string()),
            (Ok(whole), Ok(mut chunks)) => {
                assert_eq!(whole.format, chunks.format);
                let is_moved =
                    |warning: &String| warning.starts_with("the atoms come in the order of");
                if chunks.report.warnings.iter().any(is_moved) {
                    chunks.report.warnings.retain(|warning| !is_moved(warning));
                    assert_same_atoms(whole, chunks);
                } else {
                    assert_eq!(whole.report, chunks.report);
                    assert_eq!(bits(&whole.scene), bits(&chunks.scene));
                }
            }
            (whole, chunks) => panic!("as a whole {whole:?}, in chunks {chunks:?}"),
        }
    }
}

/// Checks that atoms are the same but for their order.
fn assert_same_atoms(whole: &Loaded, chunks: Loaded) {
    assert_eq!(whole.report.skipped, chunks.report.skipped);
    let [whole, mut chunks] = [whole.scene.clone(), chunks.scene];
    assert_eq!(whole.origin.to_array(), chunks.origin.to_array());
    if chunks.attributes.ids.is_some() && chunks.scalar("id").is_some() {
        // Then these tell the order.
        let ids = chunks.attributes.ids.clone().unwrap_or_default();
        let mut order: Vec<usize> = (0..ids.len()).collect();
        order.sort_by_key(|&index| ids[index]);
        let expected = whole.attributes.ids.clone();
        let expected = expected.unwrap_or((0..).take(ids.len()).collect());
        assert_eq!(order.iter().map(|&index| ids[index]).collect::<Vec<_>>(), expected);
        for (record, &index) in whole.records.iter().zip(&order) {
            assert_eq!(record, &chunks.records[index]);
        }
        return;
    }
    let key = |sphere: &Sphere| (sphere.center.map(f32::to_bits), sphere.radius.to_bits());
    let mut expected: Vec<_> = whole.records.iter().map(key).collect();
    expected.sort_unstable();
    chunks.records.to_mut().sort_unstable_by_key(key);
    assert_eq!(chunks.records.iter().map(key).collect::<Vec<_>>(), expected);
}
