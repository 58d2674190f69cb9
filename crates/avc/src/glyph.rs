//! The trait: from a record to a form, and from a form to geometry.

use crate::Sight;
use bytemuck::Pod;
use glam::Vec3;
use puncta_core::{Column, Record};
use std::fmt::{self, Debug};

/// A small record that becomes a closed surface while it is drawn.
///
/// The record's *form* is what is drawn of it: [`Glyph::form`] makes it from the record, from what all
/// records share ([`Cloud`]) and from the view ([`Sight`]). A form has some vertices and triangles,
/// which are asked for one by one, in any order and as often as need be; so nothing is kept of them.
///
/// # What must hold
///
/// * A record of zeros is nothing: it has no triangles. So is one with a number that is not finite, or
///   of an extent that is not positive.
/// * Vertices are relative to [`Record::position`], and lie in [`Glyph::ball`], as does the ball in the
///   boxes of the record's brick: for most glyphs it is the ball of the [`Record`].
/// * Triangles are counterclockwise, seen from outside. The surface is closed: each edge belongs to two
///   triangles, which go along it in opposite directions. A sheet is closed if it has two sides.
/// * A form may leave out what surely cannot be seen from [`Sight::eye`], and nothing else.
/// * The functions of [`Glyph::WGSL`] give the same, up to rounding. Levels of detail must be the same
///   bit by bit: they may only depend on comparisons of products, which round alike everywhere.
///
/// # WGSL
///
/// [`Glyph::WGSL`] declares a `struct Form` and these functions. `at` is the place of a record.
///
/// ```wgsl
/// fn glyph_position(at: u32) -> vec3<f32>
/// fn glyph_ball(at: u32) -> vec4<f32>                     // centre and radius
/// fn glyph_form(at: u32, sight: Sight) -> Form
/// fn glyph_size(form: Form) -> vec2<u32>                  // vertices, triangles
/// fn glyph_vertex(form: Form, vertex: u32) -> vec3<f32>   // relative to the position
/// fn glyph_triangle(form: Form, triangle: u32) -> vec3<u32>
/// ```
///
/// They read by `word(at, k)` and `real(at, k)` the `k`-th word of a record, by `style_word(k)` and
/// `style_real(k)` that of [`Glyph::Style`], and by `table_word(i)` and `table_real(i)` the words of
/// [`Glyphs::table`]. `ring`, `sides` and `circle` are those of this crate.
pub trait Glyph: Record + Pod {
    /// What all records share: sizes, what is selected, when to draw what. A multiple of 4 bytes.
    type Style: Pod + Send + Sync + Debug + PartialEq;

    /// What is drawn of a record: its type, its sizes, its level of detail. It may borrow from the table.
    type Form<'a>: Copy + Debug;

    /// The twin of this implementation.
    const WGSL: &'static str;

    /// Whether a form depends on the records before and after ([`Cloud::get`]): up to one before and
    /// two after. Such records must stay in their order, so they are not sorted:
    /// see [`Runs`](crate::Runs).
    const HAS_NEIGHBORS: bool = false;

    /// Whether no form has more triangles than a box, or hardly any has. On a GPU one lane then draws all
    /// triangles of a record; otherwise they are shared among lanes. The picture is the same.
    const HAS_FEW_TRIANGLES: bool = false;

    /// The transfer function: what is drawn of a record.
    fn form<'a>(cloud: &Cloud<'a, Self>, index: usize, sight: &Sight) -> Self::Form<'a>;

    /// How many vertices and triangles a form has. Without triangles nothing is drawn.
    fn size(form: &Self::Form<'_>) -> Size;

    /// A vertex, relative to the position of the record.
    fn vertex(form: &Self::Form<'_>, vertex: u32) -> Vec3;

    /// The vertices of a triangle, counterclockwise seen from outside.
    fn triangle(form: &Self::Form<'_>, triangle: u32) -> [u32; 3];

    /// A ball that holds all vertices, whatever the view.
    fn ball(cloud: &Cloud<'_, Self>, index: usize) -> (Vec3, f32) {
        let record = cloud.get(index);
        (record.position(), record.radius())
    }

    /// Why nothing is drawn of a record, if it has a fault.
    fn fault(cloud: &Cloud<'_, Self>, index: usize) -> Option<Fault>;
}

/// How many vertices and triangles there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// The number of vertices.
    pub vertices: u32,
    /// The number of triangles.
    pub triangles: u32,
}

impl Size {
    /// Nothing.
    pub const NOTHING: Self = Self { vertices: 0, triangles: 0 };
}

/// What is wrong with a record of which nothing is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// A number is NaN or infinite.
    NotFinite,
    /// An extent is zero or negative, or a turn ends where it starts.
    NoExtent,
    /// It names what is not in the table, or is not its own there.
    Unknown,
}

/// How many records have which fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Records with a number that is NaN or infinite.
    pub not_finite: u64,
    /// Records without an extent.
    pub no_extent: u64,
    /// Records that name what is not in the table.
    pub unknown: u64,
}

impl Faults {
    /// How many records are not drawn.
    #[must_use]
    pub const fn sum(&self) -> u64 {
        self.not_finite + self.no_extent + self.unknown
    }

    fn with(mut self, fault: Option<Fault>) -> Self {
        match fault {
            None => {}
            Some(Fault::NotFinite) => self.not_finite += 1,
            Some(Fault::NoExtent) => self.no_extent += 1,
            Some(Fault::Unknown) => self.unknown += 1,
        }
        self
    }

    const fn plus(self, other: Self) -> Self {
        Self {
            not_finite: self.not_finite + other.not_finite,
            no_extent: self.no_extent + other.no_extent,
            unknown: self.unknown + other.unknown,
        }
    }
}

/// What all glyphs of a scene share, and how finely they are drawn.
pub struct Glyphs<G: Glyph> {
    /// Sizes, and what is selected.
    pub style: G::Style,
    /// What records refer to, such as the corners of polygons. Numbers lie in it by their bits.
    pub table: Column<u32>,
    /// How far a curved surface may be off, in pixels: see [`Sight`].
    pub tolerance: f32,
}

impl<G: Glyph> Clone for Glyphs<G> {
    fn clone(&self) -> Self {
        Self { style: self.style, table: self.table.clone(), tolerance: self.tolerance }
    }
}

impl<G: Glyph> PartialEq for Glyphs<G> {
    fn eq(&self, other: &Self) -> bool {
        (&self.style, &self.table, self.tolerance) == (&other.style, &other.table, other.tolerance)
    }
}

impl<G: Glyph> Debug for Glyphs<G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Glyphs")
            .field("style", &self.style)
            .field("table", &self.table.len())
            .field("tolerance", &self.tolerance)
            .finish()
    }
}

/// A tolerance that nobody notices.
pub(crate) const TOLERANCE: f32 = 0.25;

impl<G: Glyph> Glyphs<G> {
    /// Glyphs of this style.
    #[must_use]
    pub fn new(style: G::Style) -> Self {
        Self { style, table: Column::new(), tolerance: TOLERANCE }
    }

    /// The same with a table.
    #[must_use]
    pub fn with_table(mut self, table: impl Into<Column<u32>>) -> Self {
        self.table = table.into();
        self
    }

    /// The same with another tolerance, in pixels. What is not positive counts as the smallest there is.
    #[must_use]
    pub const fn with_tolerance(mut self, pixels: f32) -> Self {
        self.tolerance = pixels;
        self
    }

    /// These glyphs with some records.
    #[must_use]
    pub fn cloud<'a>(&'a self, records: &'a [G]) -> Cloud<'a, G> {
        Cloud { records, style: &self.style, table: self.table.as_slice() }
    }

    /// Counts the records that are not drawn, because something is wrong with them.
    #[must_use]
    pub fn faults(&self, records: &[G]) -> Faults {
        use rayon::prelude::*;
        let cloud = self.cloud(records);
        let add = |faults: Faults, index: usize| faults.with(G::fault(&cloud, index));
        (0..records.len())
            .into_par_iter()
            .fold(Faults::default, add)
            .reduce(Faults::default, Faults::plus)
    }
}

/// Records and what they share.
#[derive(Debug)]
pub struct Cloud<'a, G: Glyph> {
    /// The records.
    pub records: &'a [G],
    /// What all of them share.
    pub style: &'a G::Style,
    /// What they refer to.
    pub table: &'a [u32],
}

impl<G: Glyph> Clone for Cloud<'_, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<G: Glyph> Copy for Cloud<'_, G> {}

impl<G: Glyph> Cloud<'_, G> {
    /// A record; zeros where there is none.
    #[must_use]
    #[inline]
    pub fn get(&self, index: usize) -> G {
        self.records.get(index).copied().unwrap_or_else(G::zeroed)
    }

    /// The record before one, zeros where there is none.
    #[must_use]
    #[inline]
    pub fn before(&self, index: usize) -> G {
        index.checked_sub(1).map_or_else(G::zeroed, |before| self.get(before))
    }
}
