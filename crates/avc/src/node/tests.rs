use super::*;
use crate::{Glyphs, Mesh, Runs};
use glam::DVec3;
use proptest::prelude::*;
use puncta_core::Bricks;

/// Ways between nodes: any, straight on, back, a little aside, at a right angle, and none.
fn paths() -> impl Strategy<Value = Vec<[f32; 3]>> {
    let way = [-2.0..2.0_f32, -2.0..2.0_f32, -2.0..2.0_f32];
    let start = [-100.0..100.0_f32, -100.0..100.0_f32, -1e6..1e6_f32];
    (start, prop::collection::vec((way, 0..8_u8, 0.01..2.0_f32), 0..12)).prop_map(
        |(start, steps)| {
            let (mut at, mut last) = (Vec3::from(start), Vec3::X);
            let mut path = vec![start];
            for (way, kind, length) in steps {
                let way = Vec3::from(way);
                let step = match kind {
                    0 => Vec3::ZERO,
                    1 => last * length,
                    2 => -last,
                    3 => last + way * 0.02,
                    4 => last.cross(way).normalize_or(Vec3::Y) * length,
                    5 => way * 0.01,
                    _ => way,
                };
                at += step;
                path.push(at.into());
                last = if step == Vec3::ZERO { last } else { step };
            }
            path
        },
    )
}

fn nodes_of(paths: &[Vec<[f32; 3]>]) -> Vec<Node> {
    let mut all = Trajectories::default();
    for path in paths {
        let times: Vec<f32> = (0..path.len()).map(|i| i as f32 * 0.5).collect();
        all.push(path, &times);
    }
    assert_eq!(all.faults, TrajectoryFaults::default());
    all.nodes
}

fn forms(nodes: &[Node], style: NodeStyle, sight: &Sight) -> Vec<NodeForm> {
    let glyphs = Glyphs::<Node>::new(style);
    let cloud = glyphs.cloud(nodes);
    (0..nodes.len()).map(|index| Node::form(&cloud, index, sight)).collect()
}

fn sight(chords: f32) -> Sight {
    Sight { pixel: 0.05, ..Sight::everywhere(chords) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(250))]

    #[test]
    fn pieces_are_closed_and_within_their_ball(
        paths in prop::collection::vec(paths(), 1..4),
        radii in [1e-3..1.0_f32, 1e-3..1.0_f32],
        kind in 0..4_u32,
        chords in 1.0..60.0_f32,
    ) {
        let nodes = nodes_of(&paths);
        let style = NodeStyle { radii, kind, speeds: [0.5, 3.0], ..NodeStyle::tubes(0.5) };
        let glyphs = Glyphs::<Node>::new(style);
        let cloud = glyphs.cloud(&nodes);
        prop_assert_eq!(glyphs.faults(&nodes).sum(), 0);
        for (index, node) in nodes.iter().enumerate() {
            let form = Node::form(&cloud, index, &sight(chords));
            let mesh = Mesh::of::<Node>(&form);
            if let Err(what) = mesh.check() {
                prop_assert!(false, "{} {:?}", what, form);
            }
            let (center, radius) = Node::ball(&cloud, index);
            let center = center.as_dvec3() - node.position().as_dvec3();
            for vertex in &mesh.vertices {
                // The centre is rounded where nodes lie far from the origin.
                let far = vertex.as_dvec3().distance(center);
                prop_assert!(far <= f64::from(radius), "{} {}", far, radius);
            }
            let mut is_used = vec![false; mesh.vertices.len()];
            mesh.triangles.iter().flatten().for_each(|&vertex| is_used[vertex as usize] = true);
            prop_assert!(is_used.into_iter().all(|is_used| is_used));
        }
    }

    /// All of the surface but flat caps is as near to the tube, or to the ball at its end, as the level
    /// allows; and all corners of rings are as far from the way as the radius.
    #[test]
    fn tubes_are_as_near_as_the_level_allows(
        path in paths(),
        radius in 1e-2..1.0_f32,
        chords in 4.0..80.0_f32,
    ) {
        let nodes = nodes_of(&[path]);
        let r = f64::from(radius);
        let allowed = std::f64::consts::PI.powi(2) * 0.5 / f64::from(chords).powi(2);
        for form in forms(&nodes, NodeStyle::tubes(radius), &sight(chords)) {
            let mesh = Mesh::of::<Node>(&form);
            let step = form.step.as_dvec3();
            let (length, way) = (step.length(), step.normalize_or(DVec3::Z));
            let distance = |point: DVec3| {
                let along = point.dot(way);
                if along < 0.0 && form.ends[0].has_dome {
                    point.length()
                } else if along > length && form.ends[1].has_dome {
                    point.distance(step)
                } else {
                    (point - way * along).length()
                }
            };
            let slack = 2e-6 * (r + length);
            for vertex in &mesh.vertices {
                prop_assert!((distance(vertex.as_dvec3()) - r).abs() <= slack);
            }
            let flat = [0, 1].map(|end| if form.ends[end].has_dome { 0 } else { form.sides.saturating_sub(2) });
            let curved = mesh.triangles.len() - flat[0] as usize - flat[1] as usize;
            let is_flat_first = !form.ends[0].has_dome;
            for (index, triangle) in mesh.triangles.iter().enumerate() {
                let bands = curved - if form.ends[1].has_dome { form.sides as usize } else { 0 };
                let is_cap = if is_flat_first {
                    (bands..bands + flat[0] as usize).contains(&index) || (flat[1] > 0 && index >= bands)
                } else {
                    index >= curved
                };
                if is_cap { continue; }
                let [a, b, c] = triangle.map(|vertex| mesh.vertices[vertex as usize].as_dvec3());
                for [u, v] in [[0.5, 0.5], [0.5, 0.0], [0.0, 0.5], [0.33, 0.33], [0.1, 0.45]] {
                    let off = r - distance(a * (1.0 - u - v) + b * u + c * v);
                    prop_assert!(off >= -slack && off <= allowed + slack, "{} {} {:?}", off, allowed, form);
                }
            }
        }
    }

    /// The ring at a joint has the same offsets in both pieces, bit by bit, and lies at the same place,
    /// up to the rounding of the way.
    #[test]
    fn pieces_share_the_ring_of_a_joint(
        path in paths(),
        radii in [1e-3..0.5_f32, 1e-3..0.5_f32],
        chords in 1.0..60.0_f32,
    ) {
        let nodes = nodes_of(&[path]);
        let style = NodeStyle { radii, speeds: [0.5, 3.0], ..NodeStyle::tubes(0.5) };
        let forms = forms(&nodes, style, &sight(chords));
        for pair in forms.windows(2) {
            let [a, b] = pair else { continue };
            let is_joint = a.step != Vec3::ZERO && b.step != Vec3::ZERO;
            if !is_joint { continue; }
            // Both have a dome, or neither.
            prop_assert_eq!(a.ends[1].has_dome, b.ends[0].has_dome);
            if a.ends[1].has_dome || a.sides != b.sides { continue; }
            for side in 0..a.sides {
                let turns = side as f32 / a.sides as f32;
                let offset = |end: &joint::End, radius: f32| (end.corner(turns) * radius).to_array().map(f32::to_bits);
                prop_assert_eq!(offset(&a.ends[1], a.radii[1]), offset(&b.ends[0], b.radii[0]));
                let above = a.size().vertices - a.sides * (1 + a.ends[1].has_dome as u32);
                let last = above - u32::from(a.ends[0].has_dome) + side;
                let first = b.vertex(side) + a.step;
                prop_assert!(a.vertex(last).distance(first) <= 1e-6 * (a.step.length() + a.radii[1]));
            }
        }
    }

    /// Whatever the numbers are, what is drawn is finite.
    #[test]
    fn nothing_is_ever_nan(
        places in prop::collection::vec([any::<f32>(), any::<f32>(), any::<f32>()], 1..6),
        motion in any::<u32>(),
        radii in [any::<f32>(), any::<f32>()],
        words in [any::<f32>(), any::<f32>(), any::<f32>(), any::<f32>()],
        kind in 0..5_u32,
    ) {
        let node = |&position: &[f32; 3]| Node { position, trajectory: 1, time: 0.0, motion };
        let nodes: Vec<Node> = places.iter().map(node).collect();
        let [slow, fast, width, ball] = words;
        let mut style = NodeStyle::tubes(1.0);
        style = NodeStyle { speeds: [slow, fast], width, ball, kind, ..style };
        for style in [style, NodeStyle { radii, ..style }] {
            for form in forms(&nodes, style, &sight(8.0)) {
                let mesh = Mesh::of::<Node>(&form);
                prop_assert!(mesh.vertices.iter().all(|vertex| vertex.is_finite()));
            }
        }
    }

    #[test]
    fn runs_hold_all_balls(paths in prop::collection::vec(paths(), 0..30), length in 1..70_usize) {
        let nodes = nodes_of(&paths);
        let glyphs = Glyphs::<Node>::new(NodeStyle::tubes(0.3));
        let cloud = glyphs.cloud(&nodes);
        let runs = Runs::with_length(&cloud, length);
        let mut next = 0;
        for brick in runs.bricks() {
            prop_assert_eq!(brick.records.start, next);
            prop_assert!(brick.records.len() <= length);
            next = brick.records.end;
            for index in brick.records.clone() {
                let (center, _) = Node::ball(&cloud, index as usize);
                let held = brick.bounds.to_world(DVec3::ZERO, brick.radius_max);
                let position = nodes[index as usize].position();
                let mesh = Mesh::of::<Node>(&Node::form(&cloud, index as usize, &sight(8.0)));
                prop_assert!(brick.bounds.contains(center));
                prop_assert!(mesh.vertices.iter().all(|v| held.contains(position.as_dvec3() + v.as_dvec3())));
            }
        }
        prop_assert_eq!(next as usize, nodes.len());
        prop_assert_eq!(runs.blocks().len(), runs.bricks().len().div_ceil(puncta_core::Block::RUN));
    }

    /// Differences are exact if the acceleration does not change, whatever the steps of time.
    #[test]
    fn speeds_of_constant_acceleration_are_exact(steps in prop::collection::vec(0.1..2.0_f32, 2..20)) {
        let mut times = vec![0.0_f32];
        steps.iter().for_each(|step| times.push(times[times.len() - 1] + step));
        let place = |t: f32| [3.0 * t, 2.0 * t * t, 1.0];
        let path: Vec<[f32; 3]> = times.iter().map(|&t| place(t)).collect();
        let mut all = Trajectories::default();
        all.push(&path, &times);
        for (node, time) in all.nodes.iter().zip(times) {
            let speed = (9.0 + 16.0 * time * time).sqrt();
            prop_assert!((node.speed() - speed).abs() <= 2e-3 * speed, "{} {}", node.speed(), speed);
            prop_assert!((node.acceleration() - 4.0).abs() <= 0.02);
        }
    }

    #[test]
    fn angles_are_turns(turns in 0.0..1.0_f32, radius in 1e-3..1e3_f32) {
        let point = crate::circle(turns) * radius;
        let off = (joint::turns_of(point.x, point.y) - turns).abs();
        prop_assert!(off.min(1.0 - off) <= 2e-7, "{}", off);
    }
}

#[test]
fn limits_are_what_is_said() {
    let tubes = NodeStyle::tubes(0.25);
    let counts = |path: &[[f32; 3]]| -> Vec<[u32; 2]> {
        let forms = forms(&nodes_of(&[path.to_vec()]), tubes, &sight(16.0));
        forms.iter().map(|form| [form.sides, form.size().triangles]).collect()
    };
    let domes = |path: &[[f32; 3]]| -> Vec<[bool; 2]> {
        let forms = forms(&nodes_of(&[path.to_vec()]), tubes, &sight(16.0));
        forms.iter().map(|form| [form.ends[0].has_dome, form.ends[1].has_dome]).collect()
    };
    // One node is a ball, and so is a trajectory that never moves, at each of its pieces.
    assert_eq!(counts(&[[1.0; 3]]), [[12, 12 * 2 * 5]]);
    assert_eq!(counts(&[[1.0; 3], [1.0; 3]]), [[12, 120], [0, 0]]);
    // A piece of two domes, then one of each.
    assert_eq!(counts(&[[0.0; 3], [1.0; 3]])[1], [0, 0]);
    let straight = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
    assert_eq!(domes(&straight)[..3], [[true, false], [false, false], [false, true]]);
    // A right angle is mitred, a sharper one is not, nor one that is too large for its pieces.
    assert_eq!(domes(&[[0.0; 3], [1.2, 0.0, 0.0], [1.2, 1.2, 0.0]])[0], [true, false]);
    assert_eq!(domes(&[[0.0; 3], [1.0, 0.0, 0.0], [0.9, 1.0, 0.0]])[0], [true, true]);
    assert_eq!(domes(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.4, 0.0]])[0], [true, true]);
    // Beside a node that is there twice there are domes.
    let twice = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    assert_eq!(domes(&twice)[..3], [[true, true], [true, true], [true, true]]);
}

#[test]
fn the_style_chooses_what_is_drawn() {
    let mut nodes = nodes_of(&[vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![[0.0; 3], [1.0, 0.0, 0.0]]]);
    nodes[2] = Node::new([0.0; 3], 1, 0.0, [2.0, 9.0]);
    let style = NodeStyle {
        kind: NodeStyle::LINE,
        acceleration: 5.0,
        special: NodeStyle::BALL,
        near: 0.5,
        ..NodeStyle::tubes(0.25)
    };
    let drawn = |style: NodeStyle, nearest: f32| {
        let forms = forms(&nodes, style, &Sight { nearest, ..sight(32.0) });
        [0, 2].map(|index| (forms[index].sides, forms[index].radii[0]))
    };
    let [line, ball] = drawn(style, 1.0);
    assert_eq!(line, (4, 1.5 * 0.5 * 0.05));
    assert_eq!(ball.1, 0.5);
    // Near, and selected, it is a tube.
    assert_eq!(drawn(style, 0.4)[0].1, 0.25);
    assert_eq!(drawn(NodeStyle { selected: 1, ..style }, 1.0)[0], (24, 0.25));
    let nothing = NodeStyle { kind: NodeStyle::NOTHING, ..style };
    assert_eq!(drawn(nothing, 1.0)[0].0, 0);
    // Wide lines are not wider than the tube.
    assert_eq!(drawn(NodeStyle { width: 1e3, ..style }, 1.0)[0].1, 0.25);
}

#[test]
fn what_is_wrong_is_counted() {
    assert_eq!((size_of::<Node>(), size_of::<NodeStyle>()), (24, 48));
    let mut all = Trajectories::default();
    let nan = f32::NAN;
    all.push(&[[0.0; 3], [1.0, 0.0, 0.0], [nan, 0.0, 0.0], [3.0, 0.0, 0.0]], &[0.0, 1.0, 2.0, 3.0]);
    all.push(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &[0.0, 0.0]);
    let expected = TrajectoryFaults { unpaired: 1, not_finite: 1, not_increasing: 1, too_many: 0 };
    assert_eq!(all.faults, expected);
    assert_eq!((all.count, all.nodes.len()), (2, 6));
    all.nodes.push(Node::zeroed());
    let glyphs = Glyphs::<Node>::new(NodeStyle::tubes(0.1));
    let faults = glyphs.faults(&all.nodes);
    assert_eq!((faults.not_finite, faults.unknown), (1, 1));
    let forms = forms(&all.nodes, glyphs.style, &sight(8.0));
    let drawn: Vec<bool> = forms.iter().map(|form| form.sides > 0).collect();
    // The node after the gap is alone.
    assert_eq!(drawn, [true, false, false, true, true, false, false]);
    assert_eq!(Glyphs::<Node>::new(NodeStyle::zeroed()).faults(&all.nodes[..1]).no_extent, 1);
}

#[test]
fn numbers_that_halves_cannot_hold() {
    let motion = |value: f32| Node::new([0.0; 3], 0, 0.0, [value, 1.0]).speed();
    assert_eq!(motion(1e9), f16::MAX.to_f32());
    assert_eq!(motion(1e-5), 0.0);
    assert_eq!(motion(0.5), 0.5);
    assert!(!Node::new([0.0; 3], 0, 0.0, [f32::NAN, 1.0]).is_finite());
}
