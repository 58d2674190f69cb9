//! What comes out: an image, arrays of numbers.

use crate::{
    draw,
    input::Input,
    options::{ColorBy, Options},
    statistics::Statistics,
};
use anyhow::{Context, Result};
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

/// Makes the image, of a finer picture if pixels are to be averaged.
pub(crate) fn image(
    options: &Options,
    (input, grid): (&Input, &Grid),
    view: &View,
    picture: Picture,
    statistics: &mut Statistics,
) -> Result<Image> {
    let suited = input.outlook.map_or("viridis", |outlook| outlook.colormap);
    let map = ColorMap::named(options.colormap.as_deref().unwrap_or(suited))?;
    let coloring = coloring(options, input, &map);
    let range = coloring.range(&input.scene)?;
    let factor = options.supersample;
    let picture = if factor > 1 {
        drop(picture);
        let side = |side: u32| side.saturating_mul(factor);
        let fine = view.clone().with_size(side(view.width()), side(view.height()));
        let fine = fine.context("too many samples: lower --supersample or --size")?;
        draw(&input.scene, grid, &fine, "supersample", statistics)?
    } else {
        picture
    };
    let background = options.background.unwrap_or_default();
    let shading = Shading { coloring, background, supersample: factor, ..Shading::default() };
    let mut image = statistics.time("shade", || shade(&input.scene, view, &picture, &shading))?;
    if let (true, Some(range)) = (options.legend, range) {
        draw_legend(&mut image, &map, range, &title(coloring));
    }
    Ok(image)
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
    let scalar = |name| Coloring::Scalar { name, map, range };
    let up = options.up.unwrap_or(input.up);
    let height = Coloring::Height { axis: up.normalize_or(input.up), map, range: options.range };
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
