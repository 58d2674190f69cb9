//! Axis-aligned boxes: in world coordinates (`f64`) and around stored records (`f32`).

use glam::{DVec3, Vec3};

/// An axis-aligned box in world coordinates. Empty when a minimum lies above its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Whether the box holds no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The centre of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.min + (self.max - self.min) * 0.5
    }

    /// The lengths of the sides; zero for an empty box.
    #[must_use]
    pub fn extent(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// Grows the box so that it holds `point`; coordinates that are NaN are passed over.
    pub fn add(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether `point` lies in the box, its faces included.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Whether the boxes have a point in common.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { self.min } else { self.max };
            DVec3::new(pick(0).x, pick(1).y, pick(2).z)
        })
    }
}

/// An axis-aligned box around stored positions, relative to the origin of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Grows the box so that it holds `point`; coordinates that are NaN are passed over.
    #[inline]
    pub fn add(&mut self, point: Vec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether `point` lies in the box, its faces included.
    #[must_use]
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// The box in world coordinates, grown by `radius` on every side.
    #[must_use]
    pub fn to_world(&self, origin: DVec3, radius: f32) -> Bounds {
        let radius = DVec3::splat(f64::from(radius));
        Bounds {
            min: origin + (self.min.as_dvec3() - radius),
            max: origin + (self.max.as_dvec3() + radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_box_has_no_extent() {
        assert!(Bounds::EMPTY.is_empty());
        assert_eq!(Bounds::EMPTY.extent(), DVec3::ZERO);
    }

    #[test]
    fn corners_are_the_eight_choices() {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) };
        let corners = bounds.corners();
        assert_eq!(corners[0], bounds.min);
        assert_eq!(corners[7], bounds.max);
        assert_eq!(corners[5], DVec3::new(1.0, 0.0, 3.0));
    }

    #[test]
    fn nan_does_not_spoil_a_box() {
        let mut aabb = Aabb::EMPTY;
        aabb.add(Vec3::new(1.0, f32::NAN, 2.0));
        aabb.add(Vec3::new(0.0, 5.0, 3.0));
        assert_eq!(aabb.min, Vec3::new(0.0, 5.0, 2.0));
        assert!(aabb.contains(Vec3::new(0.5, 5.0, 2.5)));
        assert!(!aabb.contains(Vec3::new(0.5, f32::NAN, 2.5)));
    }
}
