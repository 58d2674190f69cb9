//! The scene: from a file, a generator, or built in.

use crate::{
    options::{ColorBy, Columns, Options, Radii},
    progress::Bar,
};
use anyhow::{Context, Result, bail};
use glam::DVec3;
use puncta::{
    Bounds, Format, Grid, Loaded, ReadOptions, Scene, Source, Sphere,
    grid::{BrickFile, Verify},
    io::{Scalars, elements, synthetic::Generator},
};
use std::{collections::HashMap, fs::File, io::Read, path::Path, sync::Arc};

/// What is drawn without an input: laser ablation, 1.5 million atoms.
const BUILT_IN: &str = "ablation:n=1500000";

/// A scene and what is known about it.
#[derive(Debug)]
pub(crate) struct Input {
    pub(crate) name: String,
    pub(crate) format: String,
    pub(crate) scene: Scene<Sphere>,
    /// The box around all records.
    pub(crate) bounds: Bounds,
    pub(crate) skipped: u64,
    pub(crate) notices: Vec<String>,
    /// The direction that is up.
    pub(crate) up: DVec3,
    /// The scalar to color by if there is nothing better.
    pub(crate) scalar: Option<String>,
    /// How to look at the built-in scene.
    pub(crate) outlook: Option<Outlook>,
    /// What a brick file knows besides.
    pub(crate) known: Option<Known>,
}

/// What is known of a scene without looking at its records.
#[derive(Debug)]
pub(crate) struct Known {
    /// Until it is taken.
    pub(crate) grid: Option<Grid>,
    /// The box around nearly all records.
    pub(crate) inner: Bounds,
    /// The ranges of x, y and z.
    pub(crate) axes: [[f64; 2]; 3],
    /// The ranges of scalars.
    pub(crate) scalars: HashMap<String, [f64; 2]>,
}

/// A view and colors that suit a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outlook {
    pub(crate) eye: DVec3,
    pub(crate) target: DVec3,
    /// In degrees.
    pub(crate) fov: f64,
    pub(crate) colormap: &'static str,
    pub(crate) range: [f64; 2],
}

/// The crater and the plume above it, by temperature.
const BUILT_IN_OUTLOOK: Outlook = Outlook {
    eye: DVec3::new(4.6, -4.1, 2.3),
    target: DVec3::new(0.0, 0.0, 0.62),
    fov: 32.0,
    colormap: "inferno",
    range: [-900.0, 5500.0],
};

pub(crate) fn read(options: &Options) -> Result<Input> {
    let Some(name) = options.input.as_deref() else {
        return Ok(Input { outlook: Some(BUILT_IN_OUTLOOK), ..generate(BUILT_IN, options)? });
    };
    if Generator::is_spec(name) && !Path::new(name).exists() {
        generate(name, options)
    } else if is_brick_file(name) {
        open_bricks(name, options)
    } else {
        read_file(name, options)
    }
}

fn generate(spec: &str, options: &Options) -> Result<Input> {
    let mut generator: Generator = spec.parse()?;
    if options.frame > 0 {
        bail!("{spec}: there is no frame {}: a generator has 1, counted from 0", options.frame);
    }
    let up = generator.up();
    let name = generator.to_string();
    let total = generator.remaining().unwrap_or(0);
    let bar = Bar::counting("making", total);
    let mut scene = Scene::new(Vec::new());
    let room = scene.records.to_mut().try_reserve_exact(usize::try_from(total)?);
    let bytes = total * size_of::<Sphere>() as u64;
    room.with_context(|| format!("{spec}: no room for n={total} spheres, {bytes} bytes"))?;
    const CHUNK: usize = 1 << 16;
    loop {
        let made = generator.append(&mut scene, CHUNK)?;
        bar.set(scene.records.len() as u64);
        if made < CHUNK {
            break;
        }
    }
    bar.finish();
    set_radii(&mut scene, options)?;
    let scalar = scene.attributes.scalars.first().map(|scalar| scalar.name.clone());
    let format = "generator".to_owned();
    let bounds = scene.bounds();
    Ok(Input {
        name,
        format,
        scene,
        bounds,
        skipped: 0,
        notices: vec![],
        up,
        scalar,
        outlook: None,
        known: None,
    })
}

/// Gives the records of a generator the radii that were asked for.
#[expect(clippy::cast_possible_truncation, reason = "radii are stored as f32")]
fn set_radii(scene: &mut Scene<Sphere>, options: &Options) -> Result<()> {
    if options.radius.is_none() && options.radius_scale == 1.0 {
        return Ok(());
    }
    for sphere in scene.records.to_mut() {
        let radius = options.radius.unwrap_or(f64::from(sphere.radius)) * options.radius_scale;
        sphere.radius = radius as f32;
        if !(sphere.radius.is_normal() && sphere.radius > 0.0) {
            bail!("the radius must be positive and finite, not {radius}");
        }
    }
    Ok(())
}

/// Whether a file says that it is a brick file, by its content or else by its name.
fn is_brick_file(name: &str) -> bool {
    let mut head = [0; 8];
    let read = File::open(name).and_then(|mut file| file.read_exact(&mut head));
    match read {
        Ok(()) => BrickFile::is_start(&head),
        Err(_) => Path::new(name).extension().is_some_and(|extension| extension == "bricks"),
    }
}

/// Opens a brick file: its records are not loaded.
fn open_bricks(name: &str, options: &Options) -> Result<Input> {
    if options.frame > 0 {
        bail!("{name}: there is no frame {}: a brick file has 1, counted from 0", options.frame);
    }
    if options.radius.is_some() || options.radius_scale != 1.0 {
        bail!("{name}: the radii of a brick file cannot be changed: choose them when it is made");
    }
    let verify = if options.unverified { Verify::Tables } else { Verify::Whole };
    let spinner = Bar::spinner("opening");
    let file = BrickFile::open_with(name, verify)?;
    spinner.finish();
    let scalars = file.scene.attributes.scalars.iter();
    let range = |name: &String| Some((name.clone(), file.scalar_range(name)?));
    let scalars = scalars.filter_map(|scalar| range(&scalar.name)).collect();
    let (bounds, inner) = (file.bounds(), file.inner_bounds());
    let axes = [0, 1, 2].map(|axis| file.axis_range(axis));
    let BrickFile { scene, grid, .. } = file;
    Ok(Input {
        name: name.to_owned(),
        format: "bricks".to_owned(),
        skipped: 0,
        notices: vec![],
        up: DVec3::Y,
        scalar: None,
        outlook: None,
        known: Some(Known { grid: Some(grid), inner, axes, scalars }),
        bounds,
        scene,
    })
}

fn read_file(name: &str, options: &Options) -> Result<Input> {
    let wanted = match &options.color_by {
        ColorBy::Scalar(name) => vec![name.clone()],
        _ => vec![],
    };
    let bar = Arc::new(Bar::bytes("reading"));
    let told = bar.clone();
    let mut reader = ReadOptions::default()
        .frame(options.frame)
        .radius_scale(options.radius_scale)
        .radii(match options.radii {
            Radii::Vdw => elements::Radii::VanDerWaals,
            Radii::Covalent => elements::Radii::Covalent,
        })
        .strict(options.strict)
        .on_progress(move |position, total| told.set_of(position, total));
    if let Some(radius) = options.radius {
        reader = reader.radius(radius);
    }
    let scalars = match options.columns {
        Columns::Needed => Scalars::Named(wanted.clone()),
        Columns::All => Scalars::All,
    };
    let Loaded { scene, format, report } = reader.clone().scalars(scalars).read(name)?;
    bar.finish();
    if wanted.iter().any(|wanted| scene.scalar(wanted).is_none()) {
        let all = reader.scalars(Scalars::All).read(name)?.scene.attributes.scalars;
        let names: Vec<&str> = all.iter().map(|scalar| scalar.name.as_str()).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        bail!("{name}: there is no scalar {:?}; there are: {names}", wanted[0]);
    }
    let skipped = report.skipped.iter().map(|skipped| {
        format!(
            "{} records skipped: {}, first at {}: {}",
            skipped.count, skipped.problem, skipped.first, skipped.value
        )
    });
    Ok(Input {
        name: name.to_owned(),
        format: format.to_string(),
        skipped: report.skipped_count(),
        notices: skipped.chain(report.warnings.iter().cloned()).collect(),
        up: if format == Format::Las { DVec3::Z } else { DVec3::Y },
        scalar: None,
        outlook: None,
        known: None,
        bounds: scene.bounds(),
        scene,
    })
}
