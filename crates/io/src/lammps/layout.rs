//! The columns of a frame: which of them are positions, and in which units.

use super::cell::Cell;
use crate::{
    ReadOptions,
    error::{Fault, Place, quote},
    table::{Role, Table},
    text::{columns, number},
};

/// The names of the axes, with those that are preferred first.
const SETS: [[&[u8]; 3]; 4] =
    [[b"x", b"y", b"z"], [b"xu", b"yu", b"zu"], [b"xs", b"ys", b"zs"], [b"xsu", b"ysu", b"zsu"]];

/// The first set of names for scaled coordinates.
const SCALED: usize = 2;

/// The table of a frame, and how its coordinates become positions.
pub(super) struct Layout {
    pub(super) table: Table,
    /// Which axes are scaled.
    scaled: [bool; 3],
    cell: Option<Cell>,
    /// Whether the frame has no third coordinate.
    pub(super) is_flat: bool,
}

impl Layout {
    /// The layout of columns of these names, where the first row has these numbers.
    pub(super) fn new(
        (names, place): (&[u8], Place),
        first: &[u8],
        cell: Option<Cell>,
        options: &ReadOptions,
    ) -> Result<Self, Fault> {
        Table::check(columns(names).count() as u64, place)?;
        let set = |axis: usize, set: &[&[u8]; 3]| columns(names).any(|name| name == set[axis]);
        let full = SETS.iter().position(|names| (0..3).all(|axis| set(axis, names)));
        let chosen: [Option<usize>; 3] = std::array::from_fn(|axis| {
            full.or_else(|| SETS.iter().position(|names| set(axis, names)))
        });
        if chosen[0].is_none() || chosen[1].is_none() {
            let what = "the columns must have x, y and z, or xu, xs, xsu and their like";
            return Err(Fault::invalid(place, what, quote(names.trim_ascii())));
        }
        let scaled = chosen.map(|set| set.is_some_and(|set| set >= SCALED));
        check_scale(scaled, cell, (names, place))?;
        let axis_of = |name: &[u8]| {
            (0..3).find(|&axis| chosen[axis].is_some_and(|set| SETS[set][axis] == name))
        };
        let table = table(names, first, options, axis_of);
        Ok(Self { table, scaled, cell, is_flat: chosen[2].is_none() })
    }

    /// The position that the coordinates of a row stand for.
    pub(super) fn position(&self, mut axes: [f64; 3]) -> [f64; 3] {
        match (&self.cell, self.scaled) {
            (Some(cell), [true, true, true]) => cell.position(axes),
            (Some(cell), scaled) => {
                for (axis, value) in axes.iter_mut().enumerate() {
                    if scaled[axis] {
                        *value = cell.coordinate(axis, *value);
                    }
                }
                axes
            }
            (None, _) => axes,
        }
    }
}

/// Checks that there is a box to scale the axes with.
fn check_scale(
    scaled: [bool; 3],
    cell: Option<Cell>,
    (names, place): (&[u8], Place),
) -> Result<(), Fault> {
    let wrong = |what: &str| Err(Fault::invalid(place, what, quote(names.trim_ascii())));
    match (scaled, cell) {
        ([false, false, false], _) => Ok(()),
        (_, None) => wrong("scaled coordinates must follow after ITEM: BOX BOUNDS"),
        ([true, true, true], Some(_)) => Ok(()),
        (_, Some(cell)) if cell.is_straight() => Ok(()),
        _ => wrong("the coordinates in a tilted box must be scaled on all axes or on none"),
    }
}

/// The table of columns of these names.
fn table(
    names: &[u8],
    first: &[u8],
    options: &ReadOptions,
    axis_of: impl Fn(&[u8]) -> Option<usize>,
) -> Table {
    let mut table = Table::default();
    let mut texts = columns(first);
    for name in columns(names) {
        let is_number = texts.next().is_none_or(|text| number(text).is_some());
        let is_new = |role| !table.has(role);
        match name {
            b"element" if is_new(Role::Element) => table.push(Role::Element),
            b"radius" if is_new(Role::Radius) && is_new(Role::Diameter) => {
                table.push(Role::Radius);
            }
            b"diameter" if is_new(Role::Radius) && is_new(Role::Diameter) => {
                table.push(Role::Diameter);
            }
            _ => match axis_of(name).map(Role::Axis).filter(|role| is_new(*role)) {
                Some(role) => table.push(role),
                None if is_number || name == b"id" => push_scalar(&mut table, name, options),
                None => table.push(Role::Ignored),
            },
        }
    }
    table
}

/// Adds a column of measurements; the one of ids is read even if it is not wanted.
fn push_scalar(table: &mut Table, name: &[u8], options: &ReadOptions) {
    let text = String::from_utf8_lossy(name).into_owned();
    match (name, options.wants(&text)) {
        (b"id", true) => table.push_scalar(text, options, Role::IdScalar),
        (b"id", false) => table.push(Role::Id),
        _ => table.push_scalar(text, options, Role::Scalar),
    }
}
