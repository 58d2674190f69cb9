/*!
Rings of sectors: a ring for each depth, and in it a sector for each file and folder.

A sector takes the share of its folder's turn that it has of the folder's bytes.
*/

use super::{
    glyphs::palette::{PALETTE, mix},
    kinds::Kinds,
    rings::{rings, shares},
    tree::{File, Folder},
};
use clap::ValueEnum;

/// How high the middle is, and at least a sector.
pub(crate) const HIGHEST: f64 = 150.0;
const LOWEST: f64 = 10.0;

/// The gap around a sector in units of length, and the most of its sides that it takes.
const GAP: (f64, f64) = (1.5, 0.12);

/// What makes sectors high.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Height {
    /// The nearer to the middle the higher
    Depth,
    /// The time since the last change
    Age,
    /// Ends of lines
    Lines,
}

impl Height {
    /// What makes a file high, if not its place.
    fn of(self, file: &File) -> f64 {
        match self {
            Self::Depth => 0.0,
            Self::Age => file.age,
            Self::Lines => file.lines as f64,
        }
    }
}

/// What gives sectors their color.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorBy {
    /// The outermost folder that it lies in
    Folder,
    /// The kind of file
    Kind,
}

/// What stands on a part of a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sector {
    /// Where it begins and ends, in turns.
    pub(crate) turns: [f64; 2],
    pub(crate) radii: [f64; 2],
    pub(crate) height: f64,
    pub(crate) color: [u8; 3],
}

/// Lays out a folder.
pub(crate) fn build(root: &Folder, kinds: &Kinds, height: Height, color: ColorBy) -> Vec<Sector> {
    let levels = depth(root);
    let most = root.all_files().into_iter().map(|file| height.of(file)).fold(0.0, f64::max);
    let mut plan = Plan { rings: rings(levels), kinds, height, color, most, sectors: vec![] };
    let grey = [236, 236, 232];
    let middle = if height == Height::Depth { plan.top(0) } else { 2.0 * LOWEST };
    plan.put([0.0, 1.0], 0, middle, grey);
    plan.below(root, [0.0, 1.0], 1, None);
    plan.sectors
}

/// How many rings there are around the middle.
fn depth(folder: &Folder) -> usize {
    1 + folder.folders.iter().map(depth).max().unwrap_or(0)
}

struct Plan<'a> {
    rings: Vec<[f64; 2]>,
    kinds: &'a Kinds,
    height: Height,
    color: ColorBy,
    /// The most that makes a file high.
    most: f64,
    sectors: Vec<Sector>,
}

enum Part<'a> {
    File(&'a File),
    Folder(&'a Folder),
}

impl Plan<'_> {
    /// All that lies in a folder, in rings from `level` on. `hue` is that of the outermost folder.
    fn below(&mut self, folder: &Folder, turns: [f64; 2], level: usize, hue: Option<[u8; 3]>) {
        let files = folder.files.iter().map(|file| (file.bytes, Part::File(file)));
        let folders = folder.folders.iter().map(|folder| (folder.bytes, Part::Folder(folder)));
        let mut parts: Vec<(u64, Part<'_>)> = folders.chain(files).collect();
        parts.sort_by_key(|(bytes, _)| std::cmp::Reverse(*bytes));
        let bytes: Vec<u64> = parts.iter().map(|(bytes, _)| *bytes).collect();
        let mut folders = 0;
        for (index, (turns, (_, part))) in shares(turns, &bytes).into_iter().zip(parts).enumerate()
        {
            match part {
                Part::File(file) => {
                    let color = match (self.color, hue) {
                        (ColorBy::Kind, _) => self.kinds.color(&file.kind),
                        (ColorBy::Folder, hue) => tint(hue, level, index),
                    };
                    let height = match self.height {
                        Height::Depth => self.top(level),
                        _ if self.most > 0.0 => {
                            let share = (self.height.of(file) / self.most).sqrt();
                            LOWEST + share * (HIGHEST - LOWEST)
                        }
                        _ => LOWEST,
                    };
                    self.put(turns, level, height, color);
                }
                Part::Folder(folder) => {
                    let hue = hue.unwrap_or(PALETTE[folders % PALETTE.len()]);
                    folders += 1;
                    let color = match self.color {
                        ColorBy::Folder => tint(Some(hue), level, index),
                        ColorBy::Kind => mix([150, 156, 166], [236, 236, 232], level as f64 / 8.0),
                    };
                    let height = match self.height {
                        Height::Depth => self.top(level),
                        _ => LOWEST,
                    };
                    self.put(turns, level, height, color);
                    self.below(folder, turns, level + 1, Some(hue));
                }
            }
        }
    }

    /// How high a ring is where depth says it.
    fn top(&self, level: usize) -> f64 {
        let share = 1.0 - level as f64 / self.rings.len() as f64;
        LOWEST + share.powf(1.4) * (HIGHEST - LOWEST)
    }

    fn put(&mut self, [from, to]: [f64; 2], level: usize, height: f64, color: [u8; 3]) {
        let [inner, outer] = self.rings[level];
        // A gap that is as wide all along the sides would bend them: it is right in the middle.
        let around = std::f64::consts::TAU * (inner + outer) * 0.5;
        let gap = |size: f64, unit: f64| (GAP.0 / unit).min(GAP.1 * size) * 0.5;
        let (side, edge) = (gap(to - from, around), gap(outer - inner, 1.0));
        let is_whole = to - from >= 1.0;
        let turns = if is_whole { [from, to] } else { [from + side, to - side] };
        let radii = [if level == 0 { 0.0 } else { inner + edge }, outer - edge];
        self.sectors.push(Sector { turns, radii, height, color });
    }
}

/// The color of an outermost folder, lighter outwards, and in steps so that neighbors differ.
fn tint(hue: Option<[u8; 3]>, level: usize, index: usize) -> [u8; 3] {
    let hue = hue.unwrap_or([150, 156, 166]);
    let outwards = (level.saturating_sub(1) as f64 * 0.085).min(0.6);
    mix(hue, [255, 250, 240], outwards + [0.0, 0.12, 0.05][index % 3])
}
