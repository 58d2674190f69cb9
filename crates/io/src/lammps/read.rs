//! The reader: finds the frame, then reads its rows.

use super::{cell::Cell, ids::Ids, layout::Layout};
use crate::{
    ReadOptions,
    atoms::Atoms,
    builder::{Report, Row},
    error::{ErrorKind, Fault, Place, quote},
    input::Input,
    table::Role,
    text::{self, Lines},
};
use puncta_core::Scene;

/// What the items before the atoms of a frame tell.
#[derive(Default)]
struct Head {
    count: Option<u64>,
    cell: Option<Cell>,
}

/// The atoms of a frame, which come next.
struct Frame {
    count: u64,
    cell: Option<Cell>,
    /// The names of the columns.
    names: Vec<u8>,
    place: Place,
}

/// Reads a frame.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let mut lines = Lines::new(input);
    for frames in 0.. {
        let Some(frame) = advance_to_atoms(&mut lines)? else {
            return Err(ErrorKind::NoSuchFrame { frame: options.frame, frames }.into());
        };
        if frames == options.frame {
            return read_frame(&mut lines, &frame, options);
        }
        for found in 0..frame.count {
            advance_to_row(&mut lines, frame.count, found)?;
        }
    }
    Err(ErrorKind::NoSuchFrame { frame: options.frame, frames: u64::MAX }.into())
}

/// What follows after `ITEM:` in the line that was read last.
fn item<'l>(lines: &'l Lines<'_, '_>) -> Option<&'l [u8]> {
    lines.text().trim_ascii_start().strip_prefix(b"ITEM:").map(<[u8]>::trim_ascii)
}

/// Reads items up to the atoms of the next frame; `None` if there is none.
fn advance_to_atoms(lines: &mut Lines<'_, '_>) -> Result<Option<Frame>, Fault> {
    let mut head = Head::default();
    let mut is_known = true;
    while lines.advance_to_text()? {
        let Some(item) = item(lines) else {
            if is_known {
                let what = "a line that is not part of an item must start with ITEM:";
                return Err(Fault::invalid(lines.place(), what, quote(lines.text())));
            }
            continue;
        };
        if let Some(names) = item.strip_prefix(b"ATOMS") {
            let (names, place) = (names.to_vec(), lines.place());
            let Some(count) = head.count else {
                let what = "ITEM: NUMBER OF ATOMS must come before the atoms";
                return Err(Fault::invalid(place, what, quote(lines.text())));
            };
            return Ok(Some(Frame { count, cell: head.cell, names, place }));
        }
        is_known = true;
        if item == b"NUMBER OF ATOMS" {
            lines.expect("the number of atoms")?;
            let count = text::count(lines.text(), lines.place(), "the number of atoms")?;
            head.count = Some(count);
        } else if let Some(kind) = item.strip_prefix(b"BOX BOUNDS") {
            let kind = kind.to_vec();
            head.cell = Some(Cell::read(lines, &kind)?);
        } else {
            is_known = false;
        }
    }
    Ok(None)
}

/// Goes to the next row of a frame of `count` atoms, of which `found` were read.
fn advance_to_row(lines: &mut Lines<'_, '_>, count: u64, found: u64) -> Result<(), Fault> {
    if lines.advance()? && !lines.text().starts_with(b"ITEM:") {
        return Ok(());
    }
    Err(text::too_few(lines.place(), count, found))
}

/// Reads the rows of a frame.
fn read_frame(
    lines: &mut Lines<'_, '_>,
    frame: &Frame,
    options: &ReadOptions,
) -> Result<(Scene, Report), Fault> {
    if frame.count > 0 {
        advance_to_row(lines, frame.count, 0)?;
        lines.hold();
    }
    let named = (frame.names.as_slice(), frame.place);
    let layout = Layout::new(named, lines.text(), frame.cell, options)?;
    let mut values = layout.table.values();
    let mut atoms = Atoms::of_table(options, &layout.table);
    let has_ids =
        layout.table.roles.iter().any(|role| matches!(role, Role::Id | Role::IdScalar(_)));
    let mut ids = Ids::new(atoms.builder(), has_ids);
    if lines.can_hold(frame.count, layout.table.roles.len()) {
        atoms.reserve(frame.count)?;
        ids.reserve(frame.count);
    }
    for found in 0..frame.count {
        advance_to_row(lines, frame.count, found)?;
        let parsed = layout.table.parse(lines.text(), &mut values);
        let id = ids.push(values.id, parsed.is_ok());
        match parsed {
            Ok(()) => {
                values.axes = layout.position(values.axes);
                atoms.push(Row { id, ..values.row() }, lines.place())?;
            }
            Err((problem, text)) => atoms.skip(problem, lines.place(), || quote(text))?,
        }
    }
    if layout.is_flat {
        atoms.warn("the frame has no z: it lies at z = 0");
    }
    if lines.advance_to_text()? && item(lines).is_none() {
        let (place, text) = (lines.place(), quote(lines.text()));
        atoms.warn(format!("{place}, after the frame, was not read: it starts no item, {text}"));
    }
    ids.tell(atoms.builder());
    let (mut scene, mut report) = atoms.finish()?;
    ids.put_in_order(&mut scene, &mut report);
    Ok((scene, report))
}
