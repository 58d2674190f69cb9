//! Paths: the places where something was, one after the other.

use glam::Vec3;

/// The way of one thing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Path {
    /// What the user knows it by.
    pub(crate) id: u64,
    pub(crate) points: Vec<[f32; 3]>,
    /// How fast it is at each point; nothing if the steps tell.
    pub(crate) speeds: Vec<f32>,
}

impl Path {
    pub(crate) const fn new(id: u64) -> Self {
        Self { id, points: Vec::new(), speeds: Vec::new() }
    }

    /// The direction at a point, of length 1; zero if it stands still.
    pub(crate) fn direction(&self, index: usize) -> Vec3 {
        self.step(index).normalize_or_zero()
    }

    /// How fast it is at a point: the length of its steps unless that is known.
    pub(crate) fn speed(&self, index: usize) -> f32 {
        self.speeds.get(index).copied().unwrap_or_else(|| self.step(index).length())
    }

    /// From the point before to the point after, by the number of steps.
    fn step(&self, index: usize) -> Vec3 {
        let (before, after) = (index.saturating_sub(1), (index + 1).min(self.points.len() - 1));
        let steps = (after - before).max(1) as f32;
        (Vec3::from(self.points[after]) - Vec3::from(self.points[before])) / steps
    }
}
