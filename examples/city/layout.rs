//! The city: districts for folders, one upon the other, and houses for files.

use super::{
    glyphs::palette::mix,
    kinds::Kinds,
    tree::{File, Folder},
    treemap::{Rect, squarify},
};
use clap::ValueEnum;
use puncta::Cuboid;

/// The length of the city, and its width.
pub(crate) const SIDES: [f64; 2] = [1200.0, 900.0];

/// How high the highest house is.
const HIGHEST: f64 = 230.0;

/// How high a district stands above that around it.
const STEP: f64 = 5.0;

/// The margin of a district, as a share of its shorter side, and at most.
const MARGIN: (f64, f64) = (0.035, 7.0);

/// The margin of a house.
const GAP: (f64, f64) = (0.09, 2.0);

/// How much lighter houses are than their kind, so that districts can be told apart.
const TINTS: [f64; 5] = [0.0, 0.22, 0.08, 0.32, 0.15];

/// What makes houses high.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Height {
    /// The time since the last change
    Age,
    /// Bytes
    Size,
    /// Ends of lines
    Lines,
}

impl Height {
    /// What it is, in words.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Age => "age",
            Self::Size => "size",
            Self::Lines => "lines",
        }
    }

    fn of(self, file: &File) -> f64 {
        match self {
            Self::Age => file.age,
            Self::Size => file.bytes as f64,
            Self::Lines => file.lines as f64,
        }
    }
}

/// The cuboids of a city and their colors.
#[derive(Debug, Default)]
pub(crate) struct City {
    pub(crate) cuboids: Vec<Cuboid>,
    pub(crate) colors: Vec<[u8; 4]>,
    /// Files and folders whose rectangle is too thin for numbers.
    pub(crate) too_small: u64,
}

/// Lays out a folder.
pub(crate) fn build(root: &Folder, kinds: &Kinds, height: Height) -> City {
    let highest = root.all_files().into_iter().map(|file| height.of(file)).fold(0.0, f64::max);
    let mut plan = Plan { kinds, height, highest, districts: 0, city: City::default() };
    let [width, height] = SIDES;
    plan.district(root, Rect { x: -width * 0.5, y: -height * 0.5, width, height }, 0);
    plan.city
}

struct Plan<'a> {
    kinds: &'a Kinds,
    height: Height,
    highest: f64,
    /// How many districts there are so far.
    districts: usize,
    city: City,
}

impl Plan<'_> {
    fn district(&mut self, folder: &Folder, rect: Rect, level: u16) {
        let floor = f64::from(level) * STEP;
        let tint = TINTS[self.districts % TINTS.len()];
        self.districts += 1;
        self.put(rect, [floor, floor + STEP], ground(level));
        let margin = if level == 0 { MARGIN.1 } else { (rect.shorter() * MARGIN.0).min(MARGIN.1) };
        // The larger ones first, files or folders.
        enum Part<'a> {
            File(&'a File),
            Folder(&'a Folder),
        }
        let files = folder.files.iter().map(|file| (file.bytes, Part::File(file)));
        let folders = folder.folders.iter().map(|folder| (folder.bytes, Part::Folder(folder)));
        let mut parts: Vec<(u64, Part<'_>)> = folders.chain(files).collect();
        parts.sort_by_key(|(bytes, _)| std::cmp::Reverse(*bytes));
        let sizes: Vec<f64> = parts.iter().map(|(bytes, _)| *bytes as f64).collect();
        for (rect, (_, part)) in squarify(&sizes, rect.inset(margin)).into_iter().zip(parts) {
            match part {
                Part::File(file) => self.house(file, rect, floor + STEP, tint),
                Part::Folder(folder) => {
                    let margin = (rect.shorter() * MARGIN.0 * 0.5).min(MARGIN.1 * 0.5);
                    self.district(folder, rect.inset(margin), level.saturating_add(1));
                }
            }
        }
    }

    fn house(&mut self, file: &File, rect: Rect, floor: f64, tint: f64) {
        let rect = rect.inset((rect.shorter() * GAP.0).min(GAP.1));
        let share = if self.highest > 0.0 { self.height.of(file) / self.highest } else { 0.0 };
        let roof = floor + (share.sqrt() * HIGHEST).max(1.0);
        let color = mix(self.kinds.color(&file.kind), [255; 3], tint);
        self.put(rect, [floor, roof], color);
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn put(&mut self, rect: Rect, [low, high]: [f64; 2], [r, g, b]: [u8; 3]) {
        let middle = [rect.x + rect.width * 0.5, rect.y + rect.height * 0.5, (low + high) * 0.5];
        let extent = [rect.width, rect.height, high - low].map(|side| side as f32);
        if extent.iter().all(|side| *side > 0.0) {
            self.city.cuboids.push(Cuboid::new(middle.map(|x| x as f32), extent));
            self.city.colors.push([r, g, b, 255]);
        } else {
            self.city.too_small += 1;
        }
    }
}

/// The color of a district: the lighter the higher.
fn ground(level: u16) -> [u8; 3] {
    mix([112, 120, 134], [226, 229, 232], f64::from(level.min(6)) / 6.0)
}
