//! What comes out: an image, arrays of numbers.

use crate::{
    Drawing, draw,
    input::Input,
    options::{ColorBy, Options},
    progress::Bar,
    statistics::Statistics,
};
use anyhow::{Context, Result};
use glam::DVec3;
use puncta::{
    ColorMap, Coloring, Grid, Image, Picture, Scene, Shading, Sphere, View,
    cpu::draw_legend,
    io::{elements, npy, png},
    shade,
};

/// Writes depths and ids.
pub(crate) fn write_numbers(
    options: &Options,
    scene: &Scene<Sphere>,
    picture: &Picture,
) -> Result<()> {
    let size = (picture.width, picture.height);
    if let Some(path) = &options.depth {
        npy::write_f32(path, size, &picture.depth)?;
    }
    if let Some(path) = &options.ids {
        npy::write_u32(path, size, &picture.original_ids(scene))?;
    }
    Ok(())
}

/// How to make the image: everything that can be wrong with it is found before anything is drawn.
#[derive(Debug)]
pub(crate) struct Look {
    map: ColorMap,
    /// The view of the picture that the image is made of, with more pixels if they are to be averaged.
    fine: View,
    supersample: u32,
}

impl Look {
    pub(crate) fn new(options: &Options, input: &Input, view: &View) -> Result<Self> {
        let suited = input.outlook.map_or("viridis", |outlook| outlook.colormap);
        let map = ColorMap::named(options.colormap.as_deref().unwrap_or(suited))?;
        coloring(options, input, &map).check(&input.scene)?;
        let fine = |factor: u32| {
            let side = |side: u32| side.saturating_mul(factor);
            view.clone().with_size(side(view.width()), side(view.height()))
        };
        let (fine, supersample) = match options.supersample {
            Some(factor) => (fine(factor).context("lower --supersample or --size")?, factor),
            None => fine(2).map_or_else(|_| (view.clone(), 1), |fine| (fine, 2)),
        };
        Ok(Self { map, fine, supersample })
    }
}

/// Makes the image, of a finer picture if pixels are to be averaged.
pub(crate) fn image(
    options: &Options,
    (input, grid): (&Input, &Grid),
    look: &Look,
    picture: Picture,
    (pipeline, statistics): (&mut Drawing, &mut Statistics),
) -> Result<Image> {
    let coloring = coloring(options, input, &look.map);
    let (view, supersample) = (&look.fine, look.supersample);
    let picture = if supersample > 1 {
        drop(picture);
        draw(pipeline, (&input.scene, grid), view, ("supersample", statistics))?
    } else {
        picture
    };
    let spinner = Bar::spinner("shading");
    let background = options.background.unwrap_or_default();
    let shading = Shading { coloring, background, supersample, ..Shading::default() };
    let image = statistics.time("shade", || -> Result<Image> {
        let size = (view.width() / supersample, view.height() / supersample);
        let coarse = view.clone().with_size(size.0, size.1)?;
        let mut image = shade(&input.scene, &coarse, &picture, &shading)?;
        if let (true, Some(range)) = (options.legend, coloring.range(&input.scene)?) {
            draw_legend(&mut image, &look.map, range, &title(coloring));
        }
        Ok(image)
    });
    spinner.finish();
    image
}

pub(crate) fn write_image(options: &Options, image: &Image) -> Result<()> {
    Ok(png::write(&options.out, image)?)
}

/// Where the image lies, in full.
pub(crate) fn place(options: &Options) -> String {
    let path = options.out.canonicalize().unwrap_or_else(|_| options.out.clone());
    format!("the picture is {}", path.display())
}

fn coloring<'a>(options: &'a Options, input: &'a Input, map: &'a ColorMap) -> Coloring<'a> {
    let attributes = &input.scene.attributes;
    let range = options.range.or(input.outlook.map(|outlook| outlook.range));
    let known = input.known.as_ref();
    let scalar = |name: &'a str| {
        let range = range.or(known.and_then(|known| known.scalars.get(name).copied()));
        Coloring::Scalar { name, map, range }
    };
    let axis = options.up.unwrap_or(input.up).normalize_or(input.up);
    let along = DVec3::AXES.iter().position(|&x_y_or_z| x_y_or_z == axis);
    let along = known.zip(along).map(|(known, along)| known.axes[along]);
    let height = Coloring::Height { axis, map, range: options.range.or(along) };
    let has_elements =
        attributes.elements.as_ref().is_some_and(|elements| elements.iter().any(|&e| e != 0));
    match &options.color_by {
        ColorBy::Element => Coloring::Elements(&elements::CPK),
        ColorBy::Rgb => Coloring::Colors,
        ColorBy::Height => height,
        ColorBy::Uniform => Shading::default().coloring,
        ColorBy::Scalar(name) => scalar(name),
        ColorBy::Auto if has_elements => Coloring::Elements(&elements::CPK),
        ColorBy::Auto if attributes.colors.is_some() => Coloring::Colors,
        ColorBy::Auto => input.scalar.as_deref().map_or(height, scalar),
    }
}

fn title(coloring: Coloring<'_>) -> String {
    match coloring {
        Coloring::Scalar { name, .. } => name.to_owned(),
        Coloring::Height { .. } => "height".to_owned(),
        _ => String::new(),
    }
}
