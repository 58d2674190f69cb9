//! What the bricks that are left could still change.

use crate::{
    Error, GpuRenderer, Skipping,
    frame::{TILE, tiles},
    kernel::{Work, read},
    round::{Counts, RoundData, Stage},
    table::Known,
};
use bytemuck::{Pod, Zeroable};
use puncta_core::VisibleBrick;

/// `Left` of `survey.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Left {
    run: u32,
    far: f32,
}

/// Notes what each brick may gain, and counts the pixels that are open.
pub(crate) fn survey<S>(
    renderer: &mut GpuRenderer<S>,
    bricks: &mut [VisibleBrick],
) -> Result<u64, Error> {
    let GpuRenderer { gpu, kernels, bench, frame, .. } = renderer;
    let frame = frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
    let mut left = Vec::with_capacity(bricks.len());
    for brick in bricks.iter() {
        if let Known::Plain(run) | Known::Close(run) = frame.table.known(brick.index()) {
            left.push(Left { run, far: brick.far() });
        }
    }
    let runs = frame.table.buffer(gpu)?;
    let list = bench.pool.filled(gpu, "survey::left", &left)?;
    let gains = bench.pool.storage(gpu, "survey::gains", left.len() as u64 * 4)?;
    let count = u32::try_from(left.len()).unwrap_or(u32::MAX);
    let data = RoundData { pieces: count, capacity: 0, small: 0, pass_of_two: 0 };
    let skipping = Skipping::Hidden;
    let mut stage = Stage { gpu, kernels, bench, frame, skipping, seen: None };
    gpu.guard("a survey", || {
        let mut work = Work::new(gpu, "survey");
        stage.freshen(&mut work);
        let (bench, target) = (&*stage.bench, &stage.frame.target);
        let round = bench.write_round(gpu, data);
        work.encoder.clear_buffer(&bench.counts, 0, None);
        let outlook = [(10, target.outlook.as_entire_binding())];
        kernels.clear_outlook.run(&mut work, &outlook, tiles(&target.view));
        let bindings = [
            (0, target.camera.as_entire_binding()),
            (1, runs.as_entire_binding()),
            (2, round.as_entire_binding()),
            (3, list.as_entire_binding()),
            (4, gains.as_entire_binding()),
            (8, target.tiles.as_entire_binding()),
            (9, target.visibility.as_entire_binding()),
            (10, target.outlook.as_entire_binding()),
        ];
        kernels.look.run(&mut work, &bindings, count);
        let bindings = [
            (0, target.camera.as_entire_binding()),
            (7, bench.counts.as_entire_binding()),
            (9, target.visibility.as_entire_binding()),
            (10, target.outlook.as_entire_binding()),
        ];
        kernels.count_open.run(&mut work, &bindings, tiles(&target.view));
        work.submit();
    })?;
    frame.has_outlook = true;
    let counted = size_of::<Counts>() as u64;
    let bytes = left.len() as u64 * 4;
    let parts = [(&bench.counts.clone(), 0..counted), (&gains, 0..bytes)];
    let bytes = read(gpu, &mut bench.pool, &parts)?;
    let (counts, gains) = bytes.split_at(size_of::<Counts>());
    let counts: Counts = bytemuck::pod_read_unaligned(counts);
    let mut gains = gains.chunks_exact(4).map(bytemuck::pod_read_unaligned::<f32>);
    for brick in bricks {
        let is_known =
            matches!(frame.table.known(brick.index()), Known::Plain(_) | Known::Close(_));
        let gain = if is_known { gains.next() } else { None };
        brick.set_gain(gain.unwrap_or(0.0));
    }
    Ok(counts.open.into())
}

/// Keeps those of some bricks that are not hidden by what is drawn.
pub(crate) fn glance<S>(renderer: &mut GpuRenderer<S>, bricks: &[u32]) -> Result<Vec<u32>, Error> {
    let GpuRenderer { gpu, kernels, bench, frame, .. } = renderer;
    let frame = frame.as_mut().ok_or(puncta_core::Error::NotBegun)?;
    let run = |&brick: &u32| match frame.table.known(brick) {
        Known::Plain(run) | Known::Close(run) => Some((brick, Left { run, far: 0.0 })),
        Known::Unknown | Known::Outside => None,
    };
    let (bricks, left): (Vec<u32>, Vec<Left>) = bricks.iter().filter_map(run).unzip();
    let runs = frame.table.buffer(gpu)?;
    let list = bench.pool.filled(gpu, "survey::left", &left)?;
    let gains = bench.pool.storage(gpu, "survey::gains", left.len() as u64 * 4)?;
    let count = u32::try_from(left.len()).unwrap_or(u32::MAX);
    let data = RoundData { pieces: count, capacity: 0, small: 0, pass_of_two: 0 };
    let skipping = Skipping::Hidden;
    let mut stage = Stage { gpu, kernels, bench, frame, skipping, seen: None };
    gpu.guard("a glance", || {
        let mut work = Work::new(gpu, "glance");
        stage.freshen(&mut work);
        let round = stage.bench.write_round(gpu, data);
        let bindings = [
            (0, stage.frame.target.camera.as_entire_binding()),
            (1, runs.as_entire_binding()),
            (2, round.as_entire_binding()),
            (3, list.as_entire_binding()),
            (4, gains.as_entire_binding()),
            (8, stage.frame.target.tiles.as_entire_binding()),
        ];
        kernels.glance.run(&mut work, &bindings, count);
        work.submit();
    })?;
    let bytes = read(gpu, &mut bench.pool, &[(&gains, 0..left.len() as u64 * 4)])?;
    let is_open = words(&bytes).into_iter().map(|gain| gain != 0);
    Ok(bricks.into_iter().zip(is_open).filter(|(_, is_open)| *is_open).map(|(b, _)| b).collect())
}

/// Which pixels are open since the last survey.
pub(crate) fn open_pixels<S>(renderer: &mut GpuRenderer<S>) -> Result<Vec<bool>, Error> {
    let GpuRenderer { gpu, bench, frame, .. } = renderer;
    let frame = frame.as_ref().ok_or(puncta_core::Error::NotBegun)?;
    let (target, view) = (&frame.target, &frame.target.view);
    if !frame.has_outlook {
        return Ok(vec![true; target.pixels() as usize]);
    }
    let (pixels, count) = (u64::from(target.pixels()) * 8, tiles(view));
    let parts = [(&target.visibility, 0..pixels), (&target.outlook, 0..u64::from(count) * 4)];
    let bytes = read(gpu, &mut bench.pool, &parts)?;
    let (keys, outlook) = bytes.split_at(target.pixels() as usize * 8);
    let (keys, outlook) = (words(keys), words(outlook));
    let (width, across) = (view.width(), view.width().div_ceil(TILE));
    let is_open = |pixel: u32| {
        let (row, column) = (pixel / width, pixel % width);
        let nearest = outlook[(row / TILE * across + column / TILE) as usize];
        let depth = (!keys[pixel as usize * 2 + 1]).min(f32::INFINITY.to_bits());
        nearest != u32::MAX && depth | 1 << 31 >= nearest
    };
    Ok((0..target.pixels()).map(is_open).collect())
}

/// The words of some bytes.
pub(crate) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{kernels::SURVEY, shaders::assert_same_layout};

    #[test]
    fn what_is_left_is_that_of_the_shaders() {
        assert_same_layout!(SURVEY, "Left", Left { run, far });
    }
}
