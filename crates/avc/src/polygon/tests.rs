use super::*;
use crate::{Glyphs, Mesh};
use proptest::prelude::*;
use std::f64::consts::TAU;

type Ring = Vec<[f64; 2]>;

fn meshes(set: &PolygonSet) -> Vec<Mesh> {
    let glyphs = Glyphs::<Polygon>::new([]).with_table(set.table.clone());
    assert_eq!(glyphs.faults(&set.records).sum(), 0);
    let cloud = glyphs.cloud(&set.records);
    let sight = Sight::everywhere(1.0);
    (0..set.records.len()).map(|i| Mesh::of::<Polygon>(&Polygon::form(&cloud, i, &sight))).collect()
}

/// Whether it is closed, has this volume and lies in its ball.
fn check(set: &PolygonSet, volume: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(&set.failures, &[]);
    let meshes = meshes(set);
    let mesh = &meshes[0];
    if let Err(what) = mesh.check() {
        prop_assert!(false, "{}", what);
    }
    let found = mesh.volume();
    prop_assert!((found - volume).abs() <= 1e-5 * volume.abs(), "{} {}", found, volume);
    let radius = f64::from(set.records[0].radius());
    prop_assert!(mesh.vertices.iter().all(|vertex| vertex.as_dvec3().length() <= radius));
    Ok(())
}

fn area_of(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() * 0.5
}

/// Corners around a point: star-shaped, mostly concave.
fn star(center: [f64; 2], radii: &[f64]) -> Ring {
    let place = |(index, radius): (usize, &f64)| {
        let angle = TAU * index as f64 / radii.len() as f64;
        [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
    };
    radii.iter().enumerate().map(place).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn stars_are_closed(
        radii in prop::collection::vec(0.5..5.0_f64, 3..200),
        center in [-100.0..100.0_f64, -100.0..100.0_f64],
        is_reversed in any::<bool>(),
        is_closed in any::<bool>(),
    ) {
        let mut ring = star(center, &radii);
        let volume = area_of(&ring) * 1.5;
        if is_reversed { ring.reverse(); }
        if is_closed { ring.push(ring[0]); }
        let mut set = PolygonSet::default();
        set.push(&[ring], 7.0, 1.5).unwrap();
        check(&set, volume)?;
    }

    /// Large ones with a hole in each cell of a lattice: many corners are in line with those of others.
    #[test]
    fn polygons_with_holes_are_closed(
        cells in 1..6_u8,
        corners in 3..12_usize,
        holes in prop::collection::vec(prop::collection::vec(0.1..0.45_f64, 12), 36),
        is_square in any::<bool>(),
    ) {
        let side = f64::from(cells);
        let mut rings: Vec<Ring> = vec![vec![[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]]];
        for (index, radii) in (0..cells * cells).zip(&holes) {
            let [x, y] = [index % cells, index / cells].map(|k| f64::from(k) + 0.5);
            rings.push(if is_square {
                vec![[x - 0.25, y - 0.25], [x + 0.25, y - 0.25], [x + 0.25, y + 0.25], [x - 0.25, y + 0.25]]
            } else {
                star([x, y], &radii[..corners])
            });
        }
        let area: f64 = rings.iter().skip(1).map(|ring| area_of(ring).abs()).sum();
        let mut set = PolygonSet::default();
        set.push(&rings, 0.0, 2.0).unwrap();
        check(&set, (side * side - area) * 2.0)?;
    }

    /// Outlines of columns of whole heights: concave, with corners that are in line with others.
    #[test]
    fn skylines_are_closed(heights in prop::collection::vec(1..5_u8, 1..60)) {
        let mut ring: Ring = vec![[0.0, 0.0], [heights.len() as f64, 0.0]];
        for (x, &height) in heights.iter().enumerate().rev() {
            ring.push([x as f64 + 1.0, height.into()]);
            ring.push([x as f64, height.into()]);
        }
        let volume = heights.iter().map(|&height| f64::from(height)).sum();
        let mut set = PolygonSet::default();
        set.push(&[ring], 0.0, 1.0).unwrap();
        check(&set, volume)?;
    }

    /// Whatever comes is closed, or said not to be: corners on a small lattice cross in all ways.
    #[test]
    fn any_rings_are_closed_or_refused(
        rings in prop::collection::vec(prop::collection::vec((0..7_i8, 0..7_i8), 1..14), 1..4),
    ) {
        let place = |&(x, y): &(i8, i8)| [f64::from(x), f64::from(y)];
        let rings: Vec<Ring> = rings.iter().map(|ring| ring.iter().map(place).collect()).collect();
        let mut set = PolygonSet::default();
        let made = set.push(&rings, 0.0, 1.0);
        prop_assert_eq!(made.is_ok(), set.records.len() == 1);
        prop_assert_eq!(made.is_err(), set.failures.len() == 1);
        for mesh in meshes(&set) {
            if let Err(what) = mesh.check() {
                prop_assert!(false, "{}", what);
            }
        }
    }

    /// Names of what is not there draw nothing, and are counted; whatever the words, nothing panics.
    #[test]
    fn any_words_are_safe(
        table in prop::collection::vec(any::<u32>(), 0..60),
        first in 0..40_u32,
        corners in 0..12_u32,
        rings in 0..5_u32,
    ) {
        let polygon = Polygon { height: 1.0, first, corners, rings, ..Polygon::zeroed() };
        let glyphs = Glyphs::<Polygon>::new([]).with_table(table);
        let records = [polygon, Polygon { first: u32::MAX, corners: u32::MAX, ..polygon }];
        let cloud = glyphs.cloud(&records);
        for index in 0..2 {
            let form = Polygon::form(&cloud, index, &Sight::everywhere(1.0));
            let _ = (Mesh::of::<Polygon>(&form), Polygon::fault(&cloud, index));
        }
        prop_assert_eq!(Polygon::fault(&cloud, 1), Some(Fault::Unknown));
    }
}

#[test]
fn polygons_of_many_corners_take_wide_words() {
    for (count, bytes) in
        [(1024_u16, 12 * 1024 - 8), (1025, 16 * 1025 - 16), (5000, 16 * 5000 - 16)]
    {
        let radii: Vec<f64> =
            (0..count).map(|i| 1.0 + f64::from(i % 97 * 31 % 100) * 0.01).collect();
        let ring = star([3.0, 4.0], &radii);
        let mut set = PolygonSet::default();
        set.push(std::slice::from_ref(&ring), 0.0, 1.0).unwrap();
        assert_eq!(set.records[0].corners, u32::from(count));
        assert_eq!(set.table.len() * 4, bytes);
        check(&set, area_of(&ring)).unwrap();
    }
}

#[test]
fn triangles_are_kept_as_they_are() {
    for corners in [NARROW, CORNERS_MAX] {
        let last = corners - 1;
        for triangle in
            [[0, 1, last], [last, 0, 5], [7, last, last - 1], [last / 2, last / 3, last / 5]]
        {
            let mut words = vec![0; 2 * corners as usize];
            words.extend(pack(triangle, corners));
            let form = PolygonForm { words: &words, height: 1.0, corners, rings: 1, roof: 1 };
            assert_eq!(form.roof_triangle(0), triangle);
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    use PolygonError::{NoArea, NoExtent, NotFinite, NotSimple};
    let square = || vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let small = |x: f64| vec![[x, 1.0], [x + 1.0, 1.0], [x + 1.0, 2.0], [x, 2.0]];
    let eight = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.5]];
    let cases: Vec<(Vec<Ring>, f32, PolygonError)> = vec![
        (vec![], 1.0, NoArea { ring: 0 }),
        (vec![vec![]], 1.0, NoArea { ring: 0 }),
        (vec![vec![[1.0, 1.0]]], 1.0, NoArea { ring: 0 }),
        (vec![vec![[1.0, 1.0], [2.0, 1.0], [1.0, 1.0]]], 1.0, NoArea { ring: 0 }),
        (vec![vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.5, 1.5]]], 1.0, NoArea { ring: 0 }),
        (vec![square(), vec![[1.0, 1.0], [2.0, 2.0]]], 1.0, NoArea { ring: 1 }),
        (vec![square()], 0.0, NoExtent),
        (vec![square()], f32::NAN, NotFinite),
        (vec![vec![[0.0, 0.0], [1.0, f64::NAN], [2.0, 2.0]]], 1.0, NotFinite),
        (vec![vec![[0.0, 0.0], [1e300, 0.0], [0.0, 1.0]]], 1.0, NotFinite),
        (vec![eight], 1.0, NotSimple),
        // A hole across the outer ring, one beyond it, and two that overlap.
        (vec![square(), small(3.5)], 1.0, NotSimple),
        (vec![square(), small(6.0)], 1.0, NotSimple),
        (vec![square(), small(1.0), small(1.5)], 1.0, NotSimple),
    ];
    let mut set = PolygonSet::default();
    for (polygon, (rings, height, error)) in cases.into_iter().enumerate() {
        assert_eq!(set.push(&rings, 0.0, height), Err(error), "{polygon}");
        assert_eq!(set.failures[polygon], PolygonFailure { polygon, error });
    }
    assert!(set.records.is_empty() && set.table.is_empty());
    assert_eq!(set.failures[1].to_string(), "polygon 1: ring 0 has no area");
}

#[test]
fn corners_that_say_nothing_are_left_out() {
    let ring = [
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [9.0, 4.0],
        [4.0, 4.0],
        [2.0, 4.0],
        [0.0, 4.0],
        [0.0, 0.0],
        [1.0, 0.0],
    ];
    let mut set = PolygonSet::default();
    set.push(&[ring], 0.0, 1.0).unwrap();
    assert_eq!(set.records[0].corners, 4);
    check(&set, 16.0).unwrap();
}

#[test]
fn a_record_of_zeros_is_nothing() {
    assert_eq!(size_of::<Polygon>(), 32);
    let glyphs = Glyphs::<Polygon>::new([]);
    let nan = Polygon { height: f32::NAN, ..Polygon::zeroed() };
    let records = [Polygon::zeroed(), nan, Polygon { height: 1.0, ..Polygon::zeroed() }];
    let faults = glyphs.faults(&records);
    assert_eq!((faults.no_extent, faults.not_finite, faults.unknown), (1, 1, 1));
    for index in 0..3 {
        let form = Polygon::form(&glyphs.cloud(&records), index, &Sight::everywhere(1.0));
        assert_eq!(Polygon::size(&form), Size::NOTHING);
    }
}
