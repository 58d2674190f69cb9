//! Color maps: the presets of the crate `colorgrad`, by name.

use crate::Error;
use colorgrad::{Gradient, preset};

/// The number of samples of a map: more than eight bits of color can tell apart.
const SAMPLES: u16 = 1024;

/// A preset of `colorgrad` that is sampled once.
type Preset = fn() -> Vec<[f32; 3]>;

/// Names and presets; the first is the default.
const PRESETS: [(&str, Preset); 16] = [
    ("viridis", || sample(&preset::viridis())),
    ("magma", || sample(&preset::magma())),
    ("inferno", || sample(&preset::inferno())),
    ("plasma", || sample(&preset::plasma())),
    ("cividis", || sample(&preset::cividis())),
    ("turbo", || sample(&preset::turbo())),
    ("cubehelix", || sample(&preset::cubehelix_default())),
    ("warm", || sample(&preset::warm())),
    ("cool", || sample(&preset::cool())),
    ("greys", || sample(&preset::greys())),
    ("blues", || sample(&preset::blues())),
    ("yl_gn_bu", || sample(&preset::yl_gn_bu())),
    ("yl_or_rd", || sample(&preset::yl_or_rd())),
    ("rd_bu", || sample(&preset::rd_bu())),
    ("rd_yl_bu", || sample(&preset::rd_yl_bu())),
    ("spectral", || sample(&preset::spectral())),
];

/// A way from numbers between 0 and 1 to colors.
///
/// # Examples
///
/// ```
/// use puncta_cpu::ColorMap;
///
/// let map = ColorMap::named("viridis")?;
/// assert_eq!(map.color(0.0), [68, 1, 84]);
/// assert_eq!(ColorMap::named("viridis_r")?.color(1.0), map.color(0.0));
/// assert!(ColorMap::named("veridis").is_err());
/// # Ok::<(), puncta_cpu::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMap {
    /// Colors in sRGB.
    samples: Vec<[u8; 3]>,
}

impl ColorMap {
    /// The map of this name; `_r` after a name reverses it.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownColorMap`] with all known names.
    pub fn named(name: &str) -> Result<Self, Error> {
        let wanted = name.to_ascii_lowercase().replace('-', "_");
        let (wanted, reversed) =
            wanted.strip_suffix("_r").map_or((wanted.as_str(), false), |name| (name, true));
        let found = PRESETS.iter().find(|(name, _)| *name == wanted);
        let (_, preset) = found.ok_or_else(|| Error::UnknownColorMap {
            name: name.to_owned(),
            known: Self::names().collect::<Vec<_>>().join(", "),
        })?;
        let mut samples: Vec<[u8; 3]> = preset().into_iter().map(|c| c.map(to_byte)).collect();
        if reversed {
            samples.reverse();
        }
        Ok(Self { samples })
    }

    /// The names of all maps.
    pub fn names() -> impl Iterator<Item = &'static str> {
        PRESETS.iter().map(|(name, _)| *name)
    }

    /// The sRGB color for a share of the range; shares outside of 0 to 1 get the color of the end,
    /// and NaN gets grey.
    #[must_use]
    pub fn color(&self, share: f64) -> [u8; 3] {
        if share.is_nan() {
            return [128; 3];
        }
        let last = self.samples.len().saturating_sub(1);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is clamped"
        )]
        let sample = (share.clamp(0.0, 1.0) * last as f64).round() as usize;
        self.samples.get(sample).copied().unwrap_or([128; 3])
    }
}

impl Default for ColorMap {
    fn default() -> Self {
        Self { samples: PRESETS[0].1().into_iter().map(|c| c.map(to_byte)).collect() }
    }
}

fn sample(gradient: &impl Gradient) -> Vec<[f32; 3]> {
    let at = |i: u16| gradient.at(f32::from(i) / f32::from(SAMPLES - 1));
    (0..SAMPLES).map(at).map(|color| [color.r, color.g, color.b]).collect()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is clamped")]
fn to_byte(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0).round() as u8
}
