//! Whether the tables of a file are those of a grid.

use super::header::{Fault, Header, fault};
use crate::{Cells, Grid, codes::Layout};
use puncta_core::{Aabb, Brick};

/// The grid of a file.
pub(crate) fn grid(header: &Header, bricks: Vec<Brick>, codes: Vec<u32>) -> Result<Grid, Fault> {
    check_places(header)?;
    if header.records == 0 {
        let layout = Layout::new([0; 3], 0);
        return Ok(Grid::new(Cells::EMPTY, layout, (bricks, codes), None));
    }
    let cells = cells(header)?;
    let bits = Layout::new(header.dims, 0).bits();
    if header.block_bits > bits {
        let what = format!("at most {bits} bits of a code can tell the block");
        return Err(fault(124, what, header.block_bits));
    }
    let layout = Layout::new(header.dims, header.block_bits);
    // The tables end with codes and sums; what is wrong is named by the brick and not by its byte.
    let start = header.tables_start;
    let mut last = None;
    for (index, (brick, &code)) in bricks.iter().zip(&codes).enumerate() {
        if last.is_some_and(|last| last >= code) {
            let what = format!("the code of brick {index} must be above that of the one before");
            return Err(fault(start, what, code));
        }
        last = Some(code);
        let place = layout.decode(code);
        if code >> bits != 0 || !cells.contains(place) {
            let what = format!("the code of brick {index} must be that of a cell");
            return Err(fault(start, what, code));
        }
        let Aabb { min, max } = brick.bounds;
        let is_box = is_box(&brick.bounds);
        if !is_box || cells.place(min) != place || cells.place(max) != place {
            let what = format!("the box of brick {index} must lie in its cell {place:?}");
            return Err(fault(start, what, format!("{min} to {max}")));
        }
        for (name, value) in [("largest radius", brick.radius_max), ("density", brick.density)] {
            if !(0.0..f32::INFINITY).contains(&value) {
                let what = format!("the {name} of brick {index} must be finite and not negative");
                return Err(fault(start, what, value));
            }
        }
    }
    Ok(Grid::new(cells, layout, (bricks, codes), None))
}

/// The cells of a file.
fn cells(header: &Header) -> Result<Cells, Fault> {
    let Header { dims, corner, scale, bounds, .. } = *header;
    let count = dims.iter().try_fold(1_u64, |count, &dim| count.checked_mul(dim.into()));
    let is_grid = count.is_some_and(|count| (1..=crate::cells::CELLS_MAX).contains(&count))
        && dims.iter().all(|&dim| u64::from(dim) <= crate::cells::AXIS_MAX);
    if !is_grid {
        let what = "the numbers of cells along the axes must be those of a grid";
        return Err(fault(72, what, format!("{dims:?}")));
    }
    if !corner.is_finite() {
        return Err(fault(84, "the corner of the cells must be finite", corner));
    }
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(fault(96, "the scale of the cells must be positive and finite", scale));
    }
    if !is_box(&bounds) {
        let Aabb { min, max } = bounds;
        return Err(fault(100, "the box of the records must be one", format!("{min} to {max}")));
    }
    Ok(Cells::from_parts(dims, corner, scale, bounds))
}

fn check_places(header: &Header) -> Result<(), Fault> {
    if !header.origin.is_finite() {
        return Err(fault(48, "the origin must be finite", header.origin));
    }
    for (byte, bounds) in [(128, header.inner), (176, header.outer)] {
        if bounds.min.is_nan() || bounds.max.is_nan() {
            let value = format!("{} to {}", bounds.min, bounds.max);
            return Err(fault(byte, "the corners of a box must be numbers", value));
        }
    }
    Ok(())
}

fn is_box(bounds: &Aabb) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite() && bounds.min.cmple(bounds.max).all()
}
