//! Table 5.1 of *Visibility-Driven Progressive Rendering of Large Particle Data*: milliseconds for a
//! frame on one thread of an Intel Core i7-3820, the most of a series.

/// A line of the table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) scene: &'static str,
    /// Cells along the longest side.
    pub(crate) cells: u32,
    pub(crate) bricks: u32,
    pub(crate) graph: u32,
    /// Culling, graph and order.
    pub(crate) sum: u32,
}

const fn line(scene: &'static str, [cells, bricks, graph, sum]: [u32; 4]) -> Line {
    Line { scene, cells, bricks, graph, sum }
}

pub(crate) const LINES: [Line; 12] = [
    line("LaserBig", [50, 3_518, 2, 2]),
    line("LaserBig", [100, 18_973, 16, 21]),
    line("LaserBig", [150, 45_781, 40, 55]),
    line("LaserBig", [200, 91_865, 71, 99]),
    line("LaserCharge", [50, 4_023, 3, 3]),
    line("LaserCharge", [100, 28_232, 23, 31]),
    line("LaserCharge", [150, 89_027, 65, 95]),
    line("LaserCharge", [200, 196_626, 133, 200]),
    line("Halle10", [50, 2_790, 4, 4]),
    line("Halle10", [100, 12_316, 19, 22]),
    line("Halle10", [150, 30_265, 56, 67]),
    line("Halle10", [200, 54_972, 126, 144]),
];

/// The line of a block of nearly all as many bricks: those scenes fill their grids.
pub(crate) fn like_block(bricks: usize) -> Option<Line> {
    let factor = |line: &Line| {
        let (a, b) = (bricks as f64, f64::from(line.bricks));
        (a / b).max(b / a)
    };
    let blocks = LINES.iter().filter(|line| line.scene != "Halle10");
    let best = blocks.min_by(|a, b| factor(a).total_cmp(&factor(b)))?;
    (factor(best) < 1.25).then_some(*best)
}

/// The line of a hall in a grid with this many cells along its longest side.
pub(crate) fn hall(cells: u32) -> Option<Line> {
    LINES.iter().find(|line| line.scene == "Halle10" && line.cells == cells).copied()
}
