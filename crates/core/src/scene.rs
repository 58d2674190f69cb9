//! Scenes: records, the origin they are relative to, and what else is known about them.

use crate::{Bounds, Column, Error, NO_RECORD, Record, Sphere, inner_range};
use glam::DVec3;

/// The largest number of records in a scene: ids are `u32`, and one value means *nothing*.
pub const MAX_RECORDS: usize = NO_RECORD as usize;

/// Records relative to an `f64` origin, and their attributes.
///
/// # Examples
///
/// A scene far from home keeps the digits of its records:
///
/// ```
/// use glam::DVec3;
/// use puncta_core::{Scene, Sphere};
///
/// let mut scene = Scene::new(vec![Sphere::new([0.25, 0.0, 0.0], 0.5)]);
/// scene.origin = DVec3::new(1e7, 0.0, 0.0);
/// assert_eq!(scene.position(0).x, 10_000_000.25);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene<R = Sphere> {
    /// The world position that stored positions are relative to.
    pub origin: DVec3,
    /// The records; sorting reorders them.
    pub records: Column<R>,
    /// One value for each record, reordered with the records.
    pub attributes: Attributes,
}

/// What is known about records besides place and extent. Present columns have one value a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    /// The index each record had in its file or array; `None` while they still lie in that order.
    pub ids: Option<Column<u32>>,
    /// Colors: sRGB and alpha, which opaque renderers do not use.
    pub colors: Option<Column<[u8; 4]>>,
    /// Atomic numbers; 0 for an unknown element.
    pub elements: Option<Column<u8>>,
    /// Named measurements.
    pub scalars: Vec<Scalar>,
}

/// One measurement for each record.
#[derive(Clone, Debug, PartialEq)]
pub struct Scalar {
    /// The name of the measurement.
    pub name: String,
    /// A value for each record; NaN where there is none.
    pub values: Column<f32>,
}

/// No records around the origin.
impl<R: Record> Default for Scene<R> {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

impl<R: Record> Scene<R> {
    /// A scene around the origin, without attributes.
    #[must_use]
    pub fn new(records: impl Into<Column<R>>) -> Self {
        Self { origin: DVec3::ZERO, records: records.into(), attributes: Attributes::default() }
    }

    /// The world position of a record.
    ///
    /// # Panics
    ///
    /// When there is no record `index`.
    #[must_use]
    pub fn position(&self, index: usize) -> DVec3 {
        self.origin + self.records[index].position().as_dvec3()
    }

    /// The index that a record had before any sorting: what a user knows it by.
    ///
    /// # Panics
    ///
    /// When the scene has ids, but none for `index`.
    #[must_use]
    pub fn id(&self, index: u32) -> u32 {
        self.attributes.ids.as_ref().map_or(index, |ids| ids[index as usize])
    }

    /// The scalar of this name.
    #[must_use]
    pub fn scalar(&self, name: &str) -> Option<&Scalar> {
        self.attributes.scalars.iter().find(|scalar| scalar.name == name)
    }

    /// The world box around all records, radii included; those that are not finite are left out.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for record in self.records.as_slice() {
            let (position, radius) = (record.position().as_dvec3(), f64::from(record.radius()));
            if position.is_finite() && radius.is_finite() {
                bounds.add(position - radius);
                bounds.add(position + radius);
            }
        }
        Bounds { min: bounds.min + self.origin, max: bounds.max + self.origin }
    }

    /// The world box around nearly all records: on each axis a share of `outside` at either end may
    /// lie beyond it. Strays that blow up [`Scene::bounds`] are left out.
    ///
    /// Of more than a million records only a million, evenly spread, are looked at.
    #[must_use]
    pub fn inner_bounds(&self, outside: f64) -> Bounds {
        const SAMPLES: usize = 1 << 20;
        let records = self.records.as_slice();
        let step = records.len().div_ceil(SAMPLES).max(1);
        let sample = || records.iter().step_by(step);
        let offsets = || sample().map(|record| record.position().as_dvec3());
        let along = |axis: usize| inner_range(|| offsets().map(|offset| offset[axis]), outside);
        let [x, y, z] = [along(0), along(1), along(2)];
        let min = DVec3::new(x[0], y[0], z[0]);
        let max = DVec3::new(x[1], y[1], z[1]);
        Bounds { min: self.origin + min, max: self.origin + max }
    }

    /// Checks that there are ids enough and that each attribute has one value for each record.
    ///
    /// # Errors
    ///
    /// [`Error::TooManyRecords`], [`Error::AttributeLength`] or [`Error::Origin`].
    pub fn validate(&self) -> Result<(), Error> {
        let records = self.records.len();
        if records > MAX_RECORDS {
            return Err(Error::TooManyRecords { records });
        }
        if !self.origin.is_finite() {
            return Err(Error::Origin { origin: self.origin });
        }
        for (name, values) in self.attributes.lengths() {
            if values != records {
                return Err(Error::AttributeLength { name: name.to_owned(), values, records });
            }
        }
        Ok(())
    }

    /// Writes down the present order in [`Attributes::ids`], unless an order is there already.
    pub fn keep_order(&mut self) {
        let records = self.records.len();
        self.attributes.ids.get_or_insert_with(|| (0..NO_RECORD).take(records).collect());
    }

    /// Drops all records and their values. The origin, the columns, and the room they have stay: so a
    /// [`Source`](crate::Source) gives one chunk after the other in the memory of one.
    ///
    /// # Examples
    ///
    /// ```
    /// use puncta_core::{Scene, SliceSource, Source, Sphere};
    ///
    /// let records: Vec<Sphere> = (0..10_u8).map(|i| Sphere::new([i.into(); 3], 1.0)).collect();
    /// let (mut source, mut chunk, mut sum) = (SliceSource::new(&records), Scene::default(), 0.0);
    /// while source.append(&mut chunk, 4)? > 0 {
    ///     sum += chunk.records.iter().map(|sphere| sphere.center[0]).sum::<f32>();
    ///     chunk.clear();
    /// }
    /// assert_eq!(sum, 45.0);
    /// # Ok::<(), std::convert::Infallible>(())
    /// ```
    pub fn clear(&mut self) {
        self.records.clear();
        let Attributes { ids, colors, elements, scalars } = &mut self.attributes;
        ids.iter_mut().for_each(Column::clear);
        colors.iter_mut().for_each(Column::clear);
        elements.iter_mut().for_each(Column::clear);
        scalars.iter_mut().for_each(|scalar| scalar.values.clear());
    }

    /// Swaps two records and their attributes. Columns that are shared are copied first.
    ///
    /// # Panics
    ///
    /// When there is no such record, or an attribute does not have its value.
    #[inline]
    pub fn swap(&mut self, a: usize, b: usize) {
        self.records.to_mut().swap(a, b);
        self.attributes.swap(a, b);
    }
}

impl Attributes {
    /// Swaps the values of two records. Columns that are shared are copied first.
    ///
    /// # Panics
    ///
    /// When an attribute does not have such a value.
    pub fn swap(&mut self, a: usize, b: usize) {
        if let Some(ids) = &mut self.ids {
            ids.to_mut().swap(a, b);
        }
        if let Some(colors) = &mut self.colors {
            colors.to_mut().swap(a, b);
        }
        if let Some(elements) = &mut self.elements {
            elements.to_mut().swap(a, b);
        }
        for scalar in &mut self.scalars {
            scalar.values.to_mut().swap(a, b);
        }
    }

    /// The bytes of all present columns, those that are shared included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.ids.as_ref().map_or(0, |ids| size_of_val(ids.as_slice()))
            + self.colors.as_ref().map_or(0, |colors| size_of_val(colors.as_slice()))
            + self.elements.as_ref().map_or(0, |elements| elements.len())
            + self.scalars.iter().map(|s| size_of_val(s.values.as_slice())).sum::<usize>()
    }

    /// The name and length of each present column.
    fn lengths(&self) -> impl Iterator<Item = (&str, usize)> {
        let ids = self.ids.as_ref().map(|ids| ("ids", ids.len()));
        let colors = self.colors.as_ref().map(|colors| ("colors", colors.len()));
        let elements = self.elements.as_ref().map(|elements| ("elements", elements.len()));
        let scalars = self.scalars.iter().map(|s| (s.name.as_str(), s.values.len()));
        ids.into_iter().chain(colors).chain(elements).chain(scalars)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Scene {
        let at = |x| Sphere::new([x, 0.0, 0.0], 1.0);
        Scene::new(vec![at(0.0), at(1.0), at(2.0)])
    }

    #[test]
    fn attributes_follow_a_swap() {
        let mut scene = three();
        scene.attributes.colors = Some([[0; 4], [1; 4], [2; 4]].into());
        scene.attributes.elements = Some([6, 7, 8].into());
        scene
            .attributes
            .scalars
            .push(Scalar { name: "speed".into(), values: [0.0, 1.0, 2.0].into() });
        scene.keep_order();
        scene.swap(0, 2);
        assert_eq!(scene.id(0), 2);
        assert_eq!(scene.records[0].center[0], 2.0);
        assert_eq!(scene.attributes.colors.as_ref().map(|colors| colors[2]), Some([0; 4]));
        assert_eq!(scene.attributes.elements, Some([8, 7, 6].into()));
        assert_eq!(scene.scalar("speed").map(|s| s.values[0]), Some(2.0));
        assert_eq!(scene.attributes.bytes(), 3 * (4 + 4 + 1 + 4));
    }

    #[test]
    fn lengths_that_differ_are_told() {
        let mut scene = three();
        scene.attributes.elements = Some([1].into());
        let error = scene.validate().unwrap_err();
        assert_eq!(error.to_string(), "attribute elements has 1 values for 3 records");
    }

    #[test]
    fn records_that_are_not_finite_do_not_spoil_the_bounds() {
        let mut scene = three();
        let bad = [[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0]];
        scene.records.extend(bad.map(|center| Sphere::new(center, 1.0)));
        assert_eq!(scene.bounds().max, DVec3::new(3.0, 1.0, 1.0));
    }
}
