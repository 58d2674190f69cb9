//! Paths: the places where something was, one after the other.

use glam::Vec3;

/// The way of one thing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path {
    pub(crate) points: Vec<[f32; 3]>,
    /// When it was at each of them.
    pub(crate) times: Vec<f32>,
}

impl Path {
    /// The direction at a point, of length 1; `None` if it stands still.
    pub(crate) fn direction(&self, index: usize) -> Option<Vec3> {
        let after = self.points.get(index + 1).or(self.points.get(index))?;
        let before = self.points.get(index.saturating_sub(1))?;
        (Vec3::from(*after) - Vec3::from(*before)).try_normalize()
    }
}
