//! The layouts of the examples `city` and `sunburst`: areas and turns are those of the sizes, and
//! nothing overlaps.

#[path = "../examples/sunburst/rings.rs"]
mod rings;
#[path = "../examples/city/treemap.rs"]
mod treemap;

use proptest::prelude::*;
use rings::{RADIUS, rings, shares};
use treemap::{Rect, squarify};

/// Sizes as those of files: many orders of magnitude, and nothing at all.
fn sizes() -> impl Strategy<Value = Vec<f64>> {
    let size = prop_oneof![1 => Just(0.0), 9 => (0.0_f64..30.0).prop_map(|power| power.exp2())];
    prop::collection::vec(size, 0..120).prop_map(|mut sizes| {
        sizes.sort_by(|a, b| b.total_cmp(a));
        sizes
    })
}

fn rect() -> impl Strategy<Value = Rect> {
    let side = || 1e-3_f64..1e4;
    (-1e4_f64..1e4, -1e4_f64..1e4, side(), side()).prop_map(|(x, y, width, height)| Rect {
        x,
        y,
        width,
        height,
    })
}

/// Whether an area is right: of up to 120 rows, each takes a share that is rounded a few times.
fn is_near(rect: Rect, area: f64) -> bool {
    (rect.width * rect.height - area).abs() <= 1e-12 * area
}

proptest! {
    #[test]
    fn treemaps_are_fair_and_do_not_overlap(sizes in sizes(), within in rect()) {
        let rects = squarify(&sizes, within);
        prop_assert_eq!(rects.len(), sizes.len());
        let (sum, area) = (sizes.iter().sum::<f64>(), within.width * within.height);
        // A place is the sum of up to 120 numbers around 1e4.
        let slack = 1e-11 * (1e4 + within.width + within.height);
        for (rect, size) in rects.iter().zip(&sizes) {
            let wanted = if sum > 0.0 { size / sum * area } else { 0.0 };
            prop_assert!(is_near(*rect, wanted), "{rect:?} {wanted}");
            prop_assert!(rect.width >= 0.0 && rect.height >= 0.0);
            prop_assert!(rect.x >= within.x - slack && rect.y >= within.y - slack);
            prop_assert!(rect.x + rect.width <= within.x + within.width + slack);
            prop_assert!(rect.y + rect.height <= within.y + within.height + slack);
        }
        for (i, a) in rects.iter().enumerate() {
            for b in &rects[..i] {
                let x = (a.x + a.width).min(b.x + b.width) - a.x.max(b.x);
                let y = (a.y + a.height).min(b.y + b.height) - a.y.max(b.y);
                prop_assert!(x <= slack || y <= slack, "{a:?} {b:?}");
            }
        }
    }

    /// The order of sizes changes how square they are, and nothing else.
    #[test]
    fn treemaps_of_any_order_are_fair(sizes in sizes().prop_shuffle(), within in rect()) {
        let (sum, area) = (sizes.iter().sum::<f64>(), within.width * within.height);
        for (rect, size) in squarify(&sizes, within).iter().zip(&sizes) {
            let wanted = if sum > 0.0 { size / sum * area } else { 0.0 };
            prop_assert!(is_near(*rect, wanted), "{rect:?} {wanted}");
        }
    }

    #[test]
    fn turns_are_shared_fairly(
        from in -2.0_f64..2.0,
        turn in 1e-6_f64..1.0,
        bytes in prop::collection::vec(0_u64..1 << 40, 1..60),
    ) {
        let parts = shares([from, from + turn], &bytes);
        let all: u64 = bytes.iter().sum();
        prop_assert_eq!(parts.len(), bytes.len());
        prop_assert_eq!(parts[0][0], from);
        for (index, (part, bytes)) in parts.iter().zip(&bytes).enumerate() {
            // Parts meet without a gap, bit by bit.
            prop_assert!(index == 0 || parts[index - 1][1] == part[0]);
            let wanted = if all > 0 { turn * *bytes as f64 / all as f64 } else { 0.0 };
            // An end is rounded three times, near numbers up to 3.
            prop_assert!((part[1] - part[0] - wanted).abs() <= 8.0 * f64::EPSILON * 3.0);
        }
        let end = if all > 0 { from + turn } else { from };
        prop_assert!((parts[bytes.len() - 1][1] - end).abs() <= 8.0 * f64::EPSILON * 3.0);
    }

    #[test]
    fn rings_lie_around_each_other(levels in 1_usize..80) {
        let rings = rings(levels);
        prop_assert_eq!(rings.len(), levels + 1);
        for pair in rings.windows(2) {
            prop_assert_eq!(pair[0][1], pair[1][0]);
            prop_assert!(pair[1][1] > pair[1][0]);
        }
        prop_assert!((rings[levels][1] - RADIUS).abs() < 1e-9 * RADIUS);
    }
}

/// The example of the paper: 6, 6, 4, 3, 2, 2 and 1 in a rectangle of 6 by 4.
#[test]
fn the_treemap_of_the_paper_is_found() {
    let within = Rect { x: 0.0, y: 0.0, width: 6.0, height: 4.0 };
    let rects = squarify(&[6.0, 6.0, 4.0, 3.0, 2.0, 2.0, 1.0], within);
    let is_near = |rect: Rect, [x, y, width, height]: [f64; 4]| {
        let sides = [rect.x - x, rect.y - y, rect.width - width, rect.height - height];
        sides.iter().all(|side| side.abs() < 1e-12)
    };
    assert!(is_near(rects[0], [0.0, 0.0, 3.0, 2.0]) && is_near(rects[1], [0.0, 2.0, 3.0, 2.0]));
    let (seventh, third) = (7.0 / 3.0, 12.0 / 7.0);
    assert!(is_near(rects[2], [3.0, 0.0, third, seventh]), "{:?}", rects[2]);
    assert!(is_near(rects[3], [3.0 + third, 0.0, 3.0 - third, seventh]), "{:?}", rects[3]);
    let last = rects[4..].iter().all(|rect| rect.y >= seventh - 1e-12);
    assert!(last, "{:?}", &rects[4..]);
    assert!(rects.iter().all(|rect| rect.shorter() > 0.0));
    assert_eq!(within.inset(2.5), Rect { x: 2.5, y: 2.0, width: 1.0, height: 0.0 });
}
