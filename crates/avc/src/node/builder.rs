//! Makes nodes of polylines with times.

use super::Node;
use glam::{DVec3, Vec3};

/// Nodes of trajectories, one after the other.
///
/// # Examples
///
/// ```
/// use puncta_avc::Trajectories;
///
/// let mut all = Trajectories::default();
/// all.push(&[[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]], &[0.0, 1.0, 2.0]);
/// assert_eq!(all.nodes[1].speed(), 1.5);
/// assert_eq!(all.nodes[1].acceleration(), 1.0);
/// assert_eq!(all.faults, Default::default());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectories {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// How many trajectories there are: also the id of the next one.
    pub count: u32,
    /// What was wrong.
    pub faults: TrajectoryFaults,
}

/// How often something was wrong with trajectories.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TrajectoryFaults {
    /// Positions without a time, or times without a position, which were left out.
    pub unpaired: u64,
    /// Nodes with a number that is not finite. They are kept, but not drawn, and the trajectory has a
    /// gap there.
    pub not_finite: u64,
    /// Pairs of neighbors whose time does not increase: no speed is known from them.
    pub not_increasing: u64,
    /// Trajectories for which there was no id, which were left out.
    pub too_many: u64,
}

impl Trajectories {
    /// Adds a trajectory: positions relative to the origin of the scene, and their times.
    ///
    /// Speed and acceleration are the lengths of differences of positions, which allow for unequal
    /// steps of time: they are exact if the acceleration does not change. Where neighbors are of no
    /// use, the nearest difference counts, and 0 if there is none.
    pub fn push(&mut self, positions: &[[f32; 3]], times: &[f32]) {
        // The last id is kept for none.
        let Some(next) = self.count.checked_add(1).filter(|&next| next < u32::MAX) else {
            self.faults.too_many += 1;
            return;
        };
        let count = positions.len().min(times.len());
        self.faults.unpaired += positions.len().abs_diff(times.len()) as u64;
        let (positions, times) = (&positions[..count], &times[..count]);
        let is_finite = |i: usize| Vec3::from(positions[i]).is_finite() && times[i].is_finite();
        let velocities: Vec<Option<(DVec3, f64)>> = (1..count)
            .map(|i| {
                if !(is_finite(i - 1) && is_finite(i)) {
                    return None;
                }
                let step = f64::from(times[i]) - f64::from(times[i - 1]);
                if step <= 0.0 {
                    self.faults.not_increasing += 1;
                    return None;
                }
                let [a, b] = [i - 1, i].map(|i| Vec3::from(positions[i]).as_dvec3());
                Some(((b - a) / step, step))
            })
            .collect();
        self.faults.not_finite += (0..count).filter(|&i| !is_finite(i)).count() as u64;
        let id = self.count;
        self.nodes.extend((0..count).map(|i| {
            let motion = motion(&velocities, i).map(to_f32);
            Node::new(positions[i], id, times[i], motion)
        }));
        self.count = next;
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
const fn to_f32(x: f64) -> f32 {
    x as f32
}

/// The acceleration at a node between two differences.
fn acceleration(pair: &[Option<(DVec3, f64)>]) -> Option<DVec3> {
    let [Some((a, h)), Some((b, k))] = *pair else { return None };
    Some((b - a) * 2.0 / (h + k))
}

/// Speed and acceleration at a node.
fn motion(velocities: &[Option<(DVec3, f64)>], node: usize) -> [f64; 2] {
    let before = node.checked_sub(1).and_then(|i| velocities.get(i).copied().flatten());
    let after = velocities.get(node).copied().flatten();
    // Those at the ends take the acceleration of their neighbor.
    let around = |from: Option<usize>| {
        from.and_then(|from| velocities.get(from..from + 2)).and_then(acceleration)
    };
    match (before, after) {
        (Some((a, h)), Some((b, k))) => {
            let velocity = (a * k + b * h) / (h + k);
            [velocity.length(), ((b - a) * 2.0 / (h + k)).length()]
        }
        (Some((a, h)), None) => {
            let change = around(node.checked_sub(2)).unwrap_or(DVec3::ZERO);
            [(a + change * (h * 0.5)).length(), change.length()]
        }
        (None, Some((b, k))) => {
            let change = around(Some(node)).unwrap_or(DVec3::ZERO);
            [(b - change * (k * 0.5)).length(), change.length()]
        }
        (None, None) => [0.0; 2],
    }
}
