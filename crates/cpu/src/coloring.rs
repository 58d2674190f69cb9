//! Colorings: where the colors of records come from.

use crate::{ColorMap, Error};
use glam::DVec3;
use puncta_core::{Record, Scene, inner_range};
use std::fmt;

/// The share of records that may lie outside of a range on either side.
const OUTSIDE: f64 = 0.002;

/// Where the colors of records come from. All colors are sRGB.
#[derive(Clone, Copy, Debug)]
pub enum Coloring<'a> {
    /// One color for all.
    Uniform([u8; 3]),
    /// The colors of the scene.
    Colors,
    /// A color for each atomic number; numbers beyond the list get the first one.
    Elements(&'a [[u8; 3]]),
    /// A scalar through a color map.
    Scalar {
        /// The name of the scalar.
        name: &'a str,
        /// The colors of the range.
        map: &'a ColorMap,
        /// The values of the map's ends; `None` for nearly the range of the scalar.
        range: Option<[f64; 2]>,
    },
    /// The distance along an axis through a color map.
    Height {
        /// The direction that is up in the world.
        axis: DVec3,
        /// The colors of the range.
        map: &'a ColorMap,
        /// The values of the map's ends; `None` for nearly the range of the scene.
        range: Option<[f64; 2]>,
    },
    /// What a function says of each record.
    Each(Each<'a>),
}

/// A function that colors each record.
///
/// # Examples
///
/// ```
/// use puncta_core::{Scene, Sphere};
/// use puncta_cpu::{Coloring, Each};
///
/// let scene = Scene::new(vec![Sphere::default(), Sphere::new([0.0; 3], 3.0)]);
/// let of = |index: u32| if scene.records[index as usize].radius > 1.0 { [255; 3] } else { [0; 3] };
/// let colors = Coloring::Each(Each::new(&of)).colors(&scene)?;
/// assert_eq!([colors.of(0), colors.of(1)], [[0; 3], [255; 3]]);
/// # Ok::<(), puncta_cpu::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Each<'a> {
    of: &'a (dyn Fn(u32) -> [u8; 3] + Sync),
}

impl<'a> Each<'a> {
    /// The function gets an index into [`Scene::records`], of a record that is there, and gives an sRGB
    /// color.
    #[must_use]
    pub const fn new(of: &'a (dyn Fn(u32) -> [u8; 3] + Sync)) -> Self {
        Self { of }
    }
}

impl fmt::Debug for Each<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Each").finish_non_exhaustive()
    }
}

impl<'a> Coloring<'a> {
    /// Checks that a scene has what this coloring needs, without looking at any value.
    ///
    /// # Errors
    ///
    /// [`Error::NoColumn`] when it has not.
    pub fn check<R: Record>(&self, scene: &Scene<R>) -> Result<(), Error> {
        let missing = match *self {
            Self::Colors if scene.attributes.colors.is_none() => "colors",
            Self::Elements(_) if scene.attributes.elements.is_none() => "elements",
            Self::Scalar { name, .. } => return scalar(scene, name).map(|_| ()),
            _ => return Ok(()),
        };
        Err(Error::NoColumn { what: missing.to_owned() })
    }

    /// The values that the ends of the color map stand for; `None` if there is no color map.
    ///
    /// Unless it is given, the range leaves out the outermost 0.2 % of the records on either side:
    /// a few strays would turn everything else into one color.
    ///
    /// # Errors
    ///
    /// [`Error::NoColumn`] when the scene has no such scalar.
    pub fn range<R: Record>(&self, scene: &Scene<R>) -> Result<Option<[f64; 2]>, Error> {
        Ok(match *self {
            Coloring::Scalar { range: Some(range), .. }
            | Coloring::Height { range: Some(range), .. } => Some(range),
            Coloring::Scalar { name, .. } => {
                let values = scalar(scene, name)?;
                Some(inner_range(|| values.iter().map(|&value| f64::from(value)), OUTSIDE))
            }
            Coloring::Height { axis, .. } => {
                let records = scene.records.as_slice();
                let offsets = || records.iter().map(|record| record.position().as_dvec3());
                let heights = || offsets().map(|offset| axis.dot(scene.origin + offset));
                Some(inner_range(heights, OUTSIDE))
            }
            _ => None,
        })
    }

    /// The colors of the records of a scene.
    ///
    /// # Errors
    ///
    /// [`Error::NoColumn`] when the scene lacks the column to color by.
    ///
    /// # Examples
    ///
    /// ```
    /// use puncta_core::{Scene, Sphere};
    /// use puncta_cpu::{ColorMap, Coloring};
    ///
    /// let scene = Scene::new(vec![Sphere::default(), Sphere::new([0.0, 0.0, 9.0], 1.0)]);
    /// let map = ColorMap::default();
    /// let (axis, range) = (glam::DVec3::Z, Some([0.0, 9.0]));
    /// let colors = Coloring::Height { axis, map: &map, range }.colors(&scene)?;
    /// assert_eq!([colors.of(0), colors.of(1)], [map.color(0.0), map.color(1.0)]);
    /// # Ok::<(), puncta_cpu::Error>(())
    /// ```
    pub fn colors<R: Record>(&self, scene: &'a Scene<R>) -> Result<Colors<'a, R>, Error> {
        let missing = |what: &str| Error::NoColumn { what: what.to_owned() };
        let range = self.range(scene)?.unwrap_or([0.0, 1.0]);
        let source = match *self {
            Self::Uniform(color) => Source::Uniform(color),
            Self::Colors => {
                let colors = scene.attributes.colors.as_ref();
                Source::Column(colors.ok_or_else(|| missing("colors"))?)
            }
            Self::Elements(palette) => {
                let elements = scene.attributes.elements.as_ref();
                Source::Elements(elements.ok_or_else(|| missing("elements"))?, palette)
            }
            Self::Scalar { name, map, .. } => Source::Scalar(scalar(scene, name)?, map, range),
            Self::Height { axis, map, .. } => {
                Source::Height((axis, scene.origin), &scene.records, map, range)
            }
            Self::Each(each) => Source::Each(each, scene.records.len()),
        };
        Ok(Colors { source })
    }
}

/// The colors of the records of a scene, which [`Coloring::colors`] makes.
#[derive(Clone, Copy, Debug)]
pub struct Colors<'a, R> {
    source: Source<'a, R>,
}

#[derive(Clone, Copy, Debug)]
enum Source<'a, R> {
    Uniform([u8; 3]),
    Column(&'a [[u8; 4]]),
    Elements(&'a [u8], &'a [[u8; 3]]),
    Scalar(&'a [f32], &'a ColorMap, [f64; 2]),
    /// An axis and the origin, and the records along it.
    Height((DVec3, DVec3), &'a [R], &'a ColorMap, [f64; 2]),
    /// For so many records.
    Each(Each<'a>, usize),
}

/// Of what a scene says nothing about.
const UNKNOWN: [u8; 3] = [128; 3];

impl<R: Record> Colors<'_, R> {
    /// The sRGB color of the record at an index of [`Scene::records`], and grey where there is none.
    #[must_use]
    pub fn of(&self, index: u32) -> [u8; 3] {
        let share = |value: f64, [low, high]: [f64; 2]| {
            if high > low { (value - low) / (high - low) } else { 0.5 }
        };
        let (id, index) = (index, index as usize);
        let found = match self.source {
            Source::Uniform(color) => Some(color),
            Source::Column(colors) => colors.get(index).map(|&[r, g, b, _]| [r, g, b]),
            Source::Elements(elements, palette) => elements.get(index).and_then(|&element| {
                palette.get(usize::from(element)).or(palette.first()).copied()
            }),
            Source::Scalar(values, map, range) => {
                values.get(index).map(|&value| map.color(share(value.into(), range)))
            }
            Source::Height((axis, origin), records, map, range) => {
                let height = |record: &R| axis.dot(origin + record.position().as_dvec3());
                records.get(index).map(|record| map.color(share(height(record), range)))
            }
            Source::Each(each, records) => (index < records).then(|| (each.of)(id)),
        };
        found.unwrap_or(UNKNOWN)
    }
}

fn scalar<'a, R: Record>(scene: &'a Scene<R>, name: &str) -> Result<&'a [f32], Error> {
    let scalar = scene.scalar(name).ok_or_else(|| {
        let names: Vec<&str> = scene.attributes.scalars.iter().map(|s| s.name.as_str()).collect();
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Error::NoColumn { what: format!("scalar {name:?} (it has {known})") }
    })?;
    Ok(&scalar.values)
}
