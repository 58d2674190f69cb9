//! The scene in its grid, how it is colored, and where it is looked at from.

use crate::{
    input::{self, Input},
    options::Options,
    progress::Bar,
    view,
};
use anyhow::{Context, Result};
use clap::{Args, Parser, ValueEnum};
use glam::DVec3;
use puncta::{
    Background, Bounds, ColorMap, Coloring, CpuRenderer, Depth, FrustumCull, Grid, GridConfig,
    Image, Picture, Pipeline, Projection, Resolution, Scene, Shading, Sphere, View, io::elements,
    shade,
};
use std::num::NonZero;

/// How far the eye of the detail moves towards what it looks at.
const CLOSE: f64 = 0.7;

/// Where a scene comes from, and how it is to be seen.
#[derive(Clone, Debug, Args)]
pub(crate) struct Origin {
    /// A file or a generator such as hall:n=2e7, as in the tool `render`; a built-in scene by
    /// default
    pub(crate) input: Option<String>,

    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x1024")]
    pub(crate) size: String,

    /// Grid cells along the longest side; by default some 512 records share a cell
    #[arg(long, value_name = "N")]
    pub(crate) grid: Option<NonZero<u32>>,

    /// One radius for all particles
    #[arg(long, value_name = "R")]
    pub(crate) radius: Option<f64>,
}

/// What to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Place {
    /// The whole scene
    Overview,
    /// A part of it from nearby
    Detail,
    /// From within
    Inside,
}

/// A scene in its grid.
#[derive(Debug)]
pub(crate) struct World {
    pub(crate) input: Input,
    pub(crate) grid: Grid,
    overview: View,
    map: ColorMap,
    /// The values at the ends of the color map, so that they are found once.
    range: Option<[f64; 2]>,
}

impl World {
    /// Reads a scene and sorts it.
    pub(crate) fn read(origin: &Origin) -> Result<Self> {
        let options = render_options(origin)?;
        let input = input::read(&options)?;
        Self::new(input, &options, origin.grid)
    }

    /// A scene in a grid with some number of cells along its longest side.
    pub(crate) fn new(
        mut input: Input,
        options: &Options,
        cells: Option<NonZero<u32>>,
    ) -> Result<Self> {
        let overview = view::choose(options, &input)?;
        let outlook = input.outlook;
        let map = ColorMap::named(outlook.map_or("viridis", |outlook| outlook.colormap))?;
        let range = outlook.map(|outlook| outlook.range);
        let range = coloring(&input, &map, range).range(&input.scene)?;
        let known = input.known.as_mut().and_then(|known| known.grid.take());
        let grid = match (known, cells) {
            (Some(grid), None) => grid,
            _ => sort(&mut input.scene, cells)?,
        };
        Ok(Self { input, grid, overview, map, range })
    }

    pub(crate) fn name(&self) -> &str {
        &self.input.name
    }

    pub(crate) fn scene(&self) -> &Scene<Sphere> {
        &self.input.scene
    }

    /// The image of a picture.
    pub(crate) fn shade(&self, view: &View, picture: &Picture) -> Result<Image> {
        self.shade_before(view, picture, Background::default())
    }

    /// The image of a picture before another background.
    pub(crate) fn shade_before(
        &self,
        view: &View,
        picture: &Picture,
        background: Background,
    ) -> Result<Image> {
        let coloring = coloring(&self.input, &self.map, self.range);
        let shading = Shading { coloring, background, ..Shading::default() };
        Ok(shade(self.scene(), view, picture, &shading)?)
    }

    /// The whole picture, drawn at once.
    pub(crate) fn draw(&self, view: &View) -> Result<Picture> {
        let mut pipeline = Pipeline::new((FrustumCull, Depth::default()), CpuRenderer::default());
        Ok(pipeline.render(self.scene(), &self.grid, view)?)
    }

    /// A view of this scene.
    pub(crate) fn look(&self, place: Place) -> Result<View> {
        match place {
            Place::Overview => Ok(self.overview.clone()),
            Place::Detail => self.detail(),
            Place::Inside => self.inside(),
        }
    }

    fn detail(&self) -> Result<View> {
        let far = &self.overview;
        let focus = focus(far, &self.draw(far)?).context("the overview shows nothing")?;
        let near = View::look_at(far.eye().lerp(focus, CLOSE), focus, far.up())?;
        let near = near.with_size(far.width(), far.height())?;
        Ok(match far.projection() {
            Projection::Perspective { fov_y } => near.with_perspective(fov_y)?,
            Projection::Orthographic { height } => {
                near.with_orthographic(height * (1.0 - CLOSE))?
            }
        })
    }

    fn inside(&self) -> Result<View> {
        let bounds = self.inner_bounds();
        let (up, extent) = (self.input.up, bounds.extent());
        let level = DVec3::AXES.into_iter().filter(|axis| axis.dot(up).abs() < 0.5);
        let along = level.max_by(|a, b| extent.dot(*a).total_cmp(&extent.dot(*b)));
        let along = along.context("there is no horizontal axis")?;
        let middle = bounds.center();
        let eye = middle - along * (extent.dot(along) * 0.25);
        let view = View::look_at(eye, middle, up)?;
        let view = view.with_size(self.overview.width(), self.overview.height())?;
        Ok(view.with_perspective(60_f64.to_radians())?)
    }

    /// The box of nearly all records.
    fn inner_bounds(&self) -> Bounds {
        let known = self.input.known.as_ref();
        known.map_or_else(|| self.input.scene.inner_bounds(0.001), |known| known.inner)
    }
}

/// Sorts a scene into a grid with some number of cells along its longest side.
pub(crate) fn sort(scene: &mut Scene<Sphere>, cells: Option<NonZero<u32>>) -> Result<Grid> {
    let spinner = Bar::spinner("sorting");
    let cells = cells.map(|cells| Resolution::LongestSide(cells.get()));
    let resolution = cells.unwrap_or_default();
    let grid = Grid::sort_scene(scene, &GridConfig { resolution, ..GridConfig::default() })?;
    spinner.finish();
    Ok(grid)
}

/// What the tool `render` would be told.
pub(crate) fn render_options(origin: &Origin) -> Result<Options> {
    let mut words = vec!["render".to_owned(), "--size".to_owned(), origin.size.clone()];
    if let Some(radius) = origin.radius {
        words.extend(["--radius".to_owned(), radius.to_string()]);
    }
    if let Some(input) = &origin.input {
        words.extend(["--".to_owned(), input.clone()]);
    }
    Options::try_parse_from(words).map_err(|error| {
        let said = error.to_string();
        let first = said.lines().next().unwrap_or_default();
        anyhow::anyhow!("{}", first.trim_start_matches("error: "))
    })
}

fn coloring<'a>(input: &'a Input, map: &'a ColorMap, range: Option<[f64; 2]>) -> Coloring<'a> {
    let attributes = &input.scene.attributes;
    let has_elements =
        attributes.elements.as_ref().is_some_and(|elements| elements.iter().any(|&e| e != 0));
    match (&input.scalar, &attributes.colors) {
        _ if has_elements => Coloring::Elements(&elements::CPK),
        (_, Some(_)) => Coloring::Colors,
        (Some(name), None) => Coloring::Scalar { name, map, range },
        (None, None) => Coloring::Height { axis: input.up, map, range },
    }
}

/// The point of the scene that is seen nearest to the middle of a picture.
pub(crate) fn focus(view: &View, picture: &Picture) -> Option<DVec3> {
    let width = picture.width as usize;
    let seen = picture.depth.iter().enumerate().filter(|(_, depth)| depth.is_finite());
    let place = |pixel: usize| [(pixel % width) as f64, (pixel / width) as f64];
    let middle = [f64::from(picture.width - 1) * 0.5, f64::from(picture.height - 1) * 0.5];
    let distance = |pixel: usize| {
        let [column, row] = place(pixel);
        (column - middle[0]).powi(2) + (row - middle[1]).powi(2)
    };
    let (pixel, &depth) = seen.min_by(|(a, _), (b, _)| distance(*a).total_cmp(&distance(*b)))?;
    let ([column, row], depth) = (place(pixel), f64::from(depth));
    let ray = view.ray(column, row) * if view.is_perspective() { depth } else { 1.0 };
    Some(view.eye() + view.right() * ray.x + view.up() * ray.y + view.forward() * depth)
}
