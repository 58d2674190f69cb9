//! Colors: what the user chose, and what of that a scene has.

use crate::{
    input::{Known, Outlook},
    options::{ColorBy, Options},
};
use glam::DVec3;
use puncta::{Background, Bounds, ColorMap, Coloring, Scene, Shading, Sphere, io::elements};

/// What the background is unless the user says so.
const BACKGROUND: Background = Background::Gradient([17, 20, 26], [44, 51, 62]);

/// How images are made of pictures.
#[derive(Clone, Debug)]
pub(crate) struct Look {
    /// Never [`ColorBy::Auto`].
    pub(crate) color_by: ColorBy,
    /// The name of a color map.
    pub(crate) map: String,
    /// The values at the ends of the color map; `None` for nearly all there are.
    pub(crate) range: Option<[f64; 2]>,
    /// The direction of height.
    pub(crate) up: DVec3,
    pub(crate) uniform: [u8; 3],
    pub(crate) background: Background,
}

impl Look {
    /// What suits a scene, if the options say nothing else.
    pub(crate) fn new(options: &Options, palette: &Palette) -> Self {
        let map = palette.outlook.map_or("viridis", |outlook| outlook.colormap);
        let map = options.colormap.as_deref().unwrap_or(map).to_owned();
        let color_by = match &options.color_by {
            ColorBy::Auto => palette.choices.first().cloned().unwrap_or(ColorBy::Uniform),
            chosen => chosen.clone(),
        };
        let mut look = Self {
            color_by,
            map,
            range: None,
            up: options.up.unwrap_or(palette.up).normalize_or(palette.up),
            uniform: match Shading::default().coloring {
                Coloring::Uniform(color) => color,
                _ => [200; 3],
            },
            background: options.background.unwrap_or(BACKGROUND),
        };
        look.range = options.range.or_else(|| palette.range(&look));
        look
    }

    /// What is chosen before a scene is known.
    pub(crate) fn unknown(options: &Options) -> Self {
        let (choices, scalars) = (Vec::new(), Vec::new());
        let palette = Palette { choices, outlook: None, up: DVec3::Y, axes: None, scalars };
        Self::new(options, &palette)
    }

    /// How to color with this map.
    pub(crate) fn coloring<'a>(
        &'a self,
        map: &'a ColorMap,
        range: Option<[f64; 2]>,
    ) -> Coloring<'a> {
        match &self.color_by {
            ColorBy::Element => Coloring::Elements(&elements::CPK),
            ColorBy::Rgb => Coloring::Colors,
            ColorBy::Height => Coloring::Height { axis: self.up, map, range },
            ColorBy::Scalar(name) => Coloring::Scalar { name, map, range },
            ColorBy::Uniform | ColorBy::Auto => Coloring::Uniform(self.uniform),
        }
    }
}

/// What a scene can be colored by.
#[derive(Clone, Debug)]
pub(crate) struct Palette {
    /// The best first.
    pub(crate) choices: Vec<ColorBy>,
    pub(crate) outlook: Option<Outlook>,
    up: DVec3,
    /// The ranges of x, y and z, and of scalars, as far as they are known without a look at them.
    axes: Option<[[f64; 2]; 3]>,
    scalars: Vec<(String, [f64; 2])>,
}

impl Palette {
    pub(crate) fn new(
        scene: &Scene<Sphere>,
        (known, outlook): (Option<&Known>, Option<Outlook>),
        (preferred, up): (Option<&str>, DVec3),
    ) -> Self {
        let attributes = &scene.attributes;
        let mut choices = Vec::new();
        if attributes.elements.as_ref().is_some_and(|all| all.iter().any(|&e| e != 0)) {
            choices.push(ColorBy::Element);
        }
        if attributes.colors.is_some() {
            choices.push(ColorBy::Rgb);
        }
        let scalar = |name: &str| ColorBy::Scalar(name.to_owned());
        let names = || attributes.scalars.iter().map(|scalar| scalar.name.as_str());
        choices.extend(names().filter(|&name| preferred == Some(name)).map(scalar));
        choices.push(ColorBy::Height);
        choices.extend(names().filter(|&name| preferred != Some(name)).map(scalar));
        choices.push(ColorBy::Uniform);
        let scalars = known.map(|known| known.scalars.iter());
        let scalars = scalars.into_iter().flatten().map(|(name, range)| (name.clone(), *range));
        let axes = known.map(|known| known.axes);
        Self { choices, outlook, up, axes, scalars: scalars.collect() }
    }

    /// The range of what a scene is colored by, if it is known already.
    pub(crate) fn range(&self, look: &Look) -> Option<[f64; 2]> {
        match &look.color_by {
            ColorBy::Scalar(name) => {
                let known = self.scalars.iter().find(|(known, _)| known == name);
                let suited = self.outlook.map(|outlook| outlook.range);
                known.map(|(_, range)| *range).or(suited)
            }
            ColorBy::Height => {
                let axis = DVec3::AXES.iter().position(|&x_y_or_z| x_y_or_z == look.up)?;
                self.axes.map(|axes| axes[axis])
            }
            _ => None,
        }
    }
}

/// What a choice is called.
pub(crate) fn name(color_by: &ColorBy) -> String {
    match color_by {
        ColorBy::Auto => "auto".to_owned(),
        ColorBy::Element => "element".to_owned(),
        ColorBy::Rgb => "file colors".to_owned(),
        ColorBy::Height => "height".to_owned(),
        ColorBy::Uniform => "one color".to_owned(),
        ColorBy::Scalar(name) => name.clone(),
    }
}

/// Whether values go through a color map.
pub(crate) const fn is_mapped(color_by: &ColorBy) -> bool {
    matches!(color_by, ColorBy::Height | ColorBy::Scalar(_))
}

/// The middle and the size of a box.
pub(crate) fn middle(bounds: &Bounds) -> (DVec3, f64) {
    if bounds.is_empty() { (DVec3::ZERO, 1.0) } else { (bounds.center(), bounds.extent().length()) }
}
