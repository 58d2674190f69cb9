use super::*;
use crate::{CHORDS_MAX, Glyphs, Mesh};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn form(arc: Arc, sight: &Sight) -> ArcForm {
    Arc::form(&Glyphs::<Arc>::new([]).cloud(&[arc]), 0, sight)
}

fn arcs() -> impl Strategy<Value = Arc> {
    let inner = prop_oneof![Just(0.0_f32), 0.0..10.0_f32, Just(1.0)];
    let width = prop_oneof![1e-3..10.0_f32, Just(1.0)];
    let start =
        prop_oneof![-3.0..3.0_f32, -1e5..1e5_f32, (-64..64_i8).prop_map(|i| f32::from(i) / 64.0)];
    let turn = prop_oneof![
        1e-6..1.2_f32,
        Just(1.0),
        Just(0.5),
        (1..64_i8).prop_map(|i| f32::from(i) / 64.0)
    ];
    (inner, width, start, turn, 1e-3..10.0_f32).prop_map(|(inner, width, start, turn, height)| {
        Arc {
            center: [1.0, 2.0, 3.0],
            radii: [inner, inner + width],
            turns: [start, start + turn],
            height,
        }
    })
}

/// How far a point lies from the polygon with these corners that stands for a circle around the axis.
fn distance(point: DVec2, chords: u32, radius: f64) -> f64 {
    let step = TAU / f64::from(chords);
    let chord = (point.y.atan2(point.x) / step).floor();
    let near = |chord: f64| {
        let [a, b] = [chord, chord + 1.0].map(|k| DVec2::from_angle(k * step) * radius);
        let share = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        point.distance(a + (b - a) * share)
    };
    near(chord).min(near(chord - 1.0)).min(near(chord + 1.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn arcs_are_closed_and_within_their_ball(arc in arcs(), chords in 1.0..200.0_f32) {
        let form = form(arc, &Sight::everywhere(chords));
        let mesh = Mesh::of::<Arc>(&form);
        let is_nothing = arc.turns[0] == arc.turns[1];
        prop_assert_eq!(mesh.triangles.is_empty(), is_nothing);
        if let Err(what) = mesh.check() {
            prop_assert!(false, "{} {:?}", what, form);
        }
        let radius = f64::from(arc.radius());
        prop_assert!(mesh.vertices.iter().all(|vertex| vertex.as_dvec3().length() <= radius));
        // Every vertex is used.
        let mut is_used = vec![false; mesh.vertices.len()];
        mesh.triangles.iter().flatten().for_each(|&vertex| is_used[vertex as usize] = true);
        prop_assert!(is_used.into_iter().all(|is_used| is_used));
    }

    /// Vertices lie on the polygon of their circle, whatever the ends: to the rounding of `f32`.
    #[test]
    fn arcs_that_share_a_circle_share_its_curve(arc in arcs(), chords in 1.0..2000.0_f32) {
        let sight = Sight::everywhere(chords);
        let mesh = Mesh::of::<Arc>(&form(arc, &sight));
        for vertex in &mesh.vertices {
            let point = vertex.as_dvec3().truncate();
            let near = arc.radii.map(|radius| {
                let true_radius = f64::from(radius);
                if radius == 0.0 { point.length() } else {
                    distance(point, sight.ring(radius), true_radius) / true_radius
                }
            });
            prop_assert!(near[0].min(near[1]) < 1e-6, "{:?} {:?}", vertex, near);
        }
    }

    /// So the outer curve of one arc and the inner one of another, which start and end anywhere, are
    /// the same at the angles that they share, bit by bit.
    #[test]
    fn arcs_that_share_an_angle_share_its_points(arc in arcs(), chords in 1.0..2000.0_f32, turn in 0.01..0.9_f32) {
        let sight = Sight::everywhere(chords);
        let end = arc.turns[1];
        let next = Arc { turns: [end, end + turn], ..arc };
        let (first, second) = (form(arc, &sight), form(next, &sight));
        if !first.is_ring && !second.is_ring && Arc::size(&first).triangles > 0 && Arc::size(&second).triangles > 0 {
            for corner in 0..4 {
                let a = Arc::vertex(&first, first.corner(first.segments, corner));
                let b = Arc::vertex(&second, second.corner(0, corner));
                prop_assert_eq!(a, b);
            }
        }
        let outside = Arc { radii: [arc.radii[1], arc.radii[1] * 2.0], ..arc };
        let outside = form(outside, &sight);
        for index in 0..first.breaks() {
            let radius = first.radii[1];
            let a = polygon(first.chords[1], first.angle(index)) * radius;
            let b = polygon(outside.chords[0], first.angle(index)) * radius;
            prop_assert_eq!(a, b);
        }
    }

    #[test]
    fn breakpoints_ascend_and_are_the_corners_between(arc in arcs(), chords in 1.0..2000.0_f32) {
        let form = form(arc, &Sight::everywhere(chords));
        if !form.is_ring && form.segments > 0 {
            let [start, end] = arc.turns.map(f64::from);
            let steps = f64::from(form.chords[1]);
            let (after, until) = ((start * steps).floor() + 1.0, (end * steps).ceil());
            prop_assert_eq!(f64::from(form.segments) - 1.0, until - after);
            for index in 1..form.segments {
                let turns = (after + f64::from(index - 1)) / steps;
                prop_assert_eq!(f64::from(form.angle(index)), turns - turns.floor());
            }
        }
    }

    /// The chords are off by the sagitta of the level at most.
    #[test]
    fn chords_are_near_the_circle(arc in arcs(), chords in 1.0..500.0_f32) {
        let sight = Sight::everywhere(chords);
        let form = form(arc, &sight);
        let [inner, outer] = arc.radii.map(f64::from);
        let sagitta = |radius: f64, chords: u32| radius * (1.0 - (PI / f64::from(chords)).cos());
        for index in 0..form.segments {
            let next = if index + 1 == form.breaks() { 0 } else { index + 1 };
            for (side, radius) in [(3, inner), (0, outer)] {
                let [a, b] = [index, next].map(|at| {
                    Arc::vertex(&form, form.corner(at, side)).as_dvec3().truncate()
                });
                let chords = form.chords[usize::from(side == 0)];
                for share in [0.0, 0.25, 0.5, 0.75] {
                    let off = radius - (a + (b - a) * share).length();
                    prop_assert!(off >= -1e-6 * radius && off <= sagitta(radius, chords) + 1e-6 * radius);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn volumes_converge(arc in arcs()) {
        let form = arc.form_of([CHORDS_MAX; 2]);
        let [inner, outer] = arc.radii.map(f64::from);
        let turn = (f64::from(arc.turns[1]) - f64::from(arc.turns[0])).min(1.0);
        let exact = turn * PI * (outer * outer - inner * inner) * f64::from(arc.height);
        let volume = Mesh::of::<Arc>(&form).volume();
        // Thin and short ones differ by the rounding of their corners.
        let slack = 1e-6 * exact + 1e-6 * outer * outer * f64::from(arc.height);
        prop_assert!((volume - exact).abs() <= slack, "{} {}", volume, exact);
    }
}

#[test]
fn limits_are_what_is_said() {
    let sight = Sight::everywhere(16.0);
    let arc = Arc { center: [0.0; 3], radii: [1.0, 2.0], turns: [0.1, 0.4], height: 1.0 };
    let size = |arc: Arc| Arc::size(&form(arc, &sight));
    let ring = size(Arc { turns: [0.0, 1.0], ..arc });
    assert_eq!((ring.vertices, ring.triangles), (4 * 32, 8 * 32));
    assert_eq!(size(Arc { turns: [-0.3, 7.0], ..arc }), ring);
    assert_eq!(size(Arc { turns: [-3e38, 3e38], ..arc }), ring);
    let cake = size(Arc { radii: [0.0, 2.0], turns: [0.0, 1.0], ..arc });
    assert_eq!((cake.vertices, cake.triangles), (2 * 32 + 2, 4 * 32));
    let mesh = Mesh::of::<Arc>(&form(Arc { turns: [0.0, 1.0], ..arc }, &sight));
    assert_eq!(mesh.vertices[0].as_dvec3(), DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn what_has_no_extent_is_nothing_and_counted() {
    assert_eq!(size_of::<Arc>(), 32);
    let arc = Arc { center: [0.0; 3], radii: [1.0, 2.0], turns: [0.1, 0.4], height: 1.0 };
    let nan = f32::NAN;
    let odd = [
        Arc::zeroed(),
        Arc { radii: [2.0, 2.0], ..arc },
        Arc { radii: [-1.0, 2.0], ..arc },
        Arc { turns: [0.4, 0.1], ..arc },
        Arc { turns: [0.4, 0.4], ..arc },
        Arc { height: -1.0, ..arc },
        Arc { center: [0.0, nan, 0.0], ..arc },
        Arc { radii: [nan, 2.0], ..arc },
        Arc { radii: [1.0, f32::INFINITY], ..arc },
        Arc { turns: [nan, 1.0], ..arc },
        Arc { turns: [0.0, f32::INFINITY], ..arc },
        Arc { height: nan, ..arc },
    ];
    let glyphs = Glyphs::<Arc>::new([]);
    let faults = glyphs.faults(&odd);
    assert_eq!((faults.no_extent, faults.not_finite), (6, 6));
    for index in 0..odd.len() {
        let form = Arc::form(&glyphs.cloud(&odd), index, &Sight::everywhere(10.0));
        assert_eq!(Arc::size(&form), Size::NOTHING);
    }
}
