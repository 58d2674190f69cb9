//! The worker: what takes long and is not drawing. It reads, sorts, changes radii, wakes up GPUs
//! and writes images, one after the other, and tells the window when something is done.

use crate::{
    drawing::{self, Desk},
    input::{self, Input},
    look::{Palette, middle},
    options::BackendKind,
    options::Options,
    progress::Bar,
    view,
    viewing::Message,
};
use anyhow::{Context, Result, bail};
use glam::DVec3;
use puncta::{
    CpuRenderer, Gpu, GpuConfig, GpuRenderer, Grid, GridConfig, Image, Live, Resolution, Scene,
    Sphere, View, gpu::Extent, io::png,
};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{self, Sender},
    },
    thread,
};
use winit::event_loop::EventLoopProxy;

/// A scene that can be drawn.
#[derive(Debug)]
pub(crate) struct Content {
    pub(crate) name: String,
    pub(crate) format: String,
    /// What was skipped and guessed when it was read.
    pub(crate) notices: Vec<String>,
    pub(crate) scene: Arc<Scene<Sphere>>,
    pub(crate) grid: Arc<Grid>,
    /// The same with the radii of the file.
    base: Arc<Scene<Sphere>>,
    pub(crate) radius_scale: f32,
    /// Whether the radii can be changed.
    pub(crate) is_fixed: bool,
    /// A view of everything.
    pub(crate) home: View,
    pub(crate) up: DVec3,
    pub(crate) middle: (DVec3, f64),
    pub(crate) palette: Palette,
}

impl Content {
    /// Whether the two differ in nothing but their radii.
    pub(crate) fn is_same_file(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.base, &other.base)
    }
}

/// A thread that draws.
#[derive(Debug)]
pub(crate) struct Engine {
    pub(crate) live: Live<Sphere, Grid>,
    pub(crate) desk: Arc<Desk>,
    pub(crate) backend: BackendKind,
    /// What it draws with.
    pub(crate) name: String,
    /// Why it is not what was asked for.
    pub(crate) notice: Option<String>,
}

/// How to draw on a GPU.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    pub(crate) adapter: Option<String>,
    pub(crate) config: GpuConfig,
}

/// What the worker can do.
#[derive(Debug)]
pub(crate) enum Job {
    /// Read a scene and sort it.
    Open(Box<Options>),
    /// Give the records of a scene other radii.
    Scale(Arc<Content>, f32),
    /// Start a thread that draws.
    Start(Arc<Content>, Arc<Desk>, BackendKind, Wanted),
    /// Write an image.
    Save(PathBuf, Image),
}

/// Starts the worker, which ends when nobody can send it anything any more.
pub(crate) fn spawn(proxy: EventLoopProxy<Message>) -> Result<Sender<Job>> {
    let (jobs, received) = mpsc::channel();
    let work = move || {
        for job in received {
            let message = match job {
                Job::Open(options) => Message::Opened(open(&options).map(Arc::new)),
                Job::Scale(content, factor) => {
                    Message::Scaled(scale(&content, factor).map(Arc::new))
                }
                Job::Start(content, desk, backend, wanted) => {
                    Message::Started(start(&content, desk, (backend, &wanted), &proxy))
                }
                Job::Save(path, image) => Message::Saved(save(&path, &image).map(|()| path)),
            };
            if proxy.send_event(message).is_err() {
                return;
            }
        }
    };
    thread::Builder::new()
        .name("worker".into())
        .spawn(work)
        .context("the system gives no thread")?;
    Ok(jobs)
}

fn open(options: &Options) -> Result<Content> {
    let mut input = input::read(options)?;
    if input.scene.records.is_empty() {
        bail!("{}: there are no particles in it", input.name);
    }
    let home = view::choose(options, &input)?;
    let middle = middle(&view::bounds(&input));
    let known = input.known.as_mut().and_then(|known| known.grid.take());
    let is_fixed = input.known.is_some();
    let grid = match (known, options.grid) {
        (Some(grid), None) => grid,
        _ => {
            let _bar = Bar::spinner("sorting");
            let resolution = options
                .grid
                .map_or_else(Resolution::default, |cells| Resolution::LongestSide(cells.get()));
            Grid::sort_scene(&mut input.scene, &GridConfig { resolution, ..Default::default() })?
        }
    };
    let Input { name, format, scene, notices, up, scalar, outlook, known, .. } = input;
    let up = options.up.unwrap_or(up);
    let palette = Palette::new(&scene, (known.as_ref(), outlook), (scalar.as_deref(), up));
    let scene = Arc::new(scene);
    Ok(Content {
        name,
        format,
        notices,
        base: Arc::clone(&scene),
        scene,
        grid: Arc::new(grid),
        radius_scale: 1.0,
        is_fixed,
        home,
        up,
        middle,
        palette,
    })
}

/// The same scene with radii that are a multiple of those that it was read with.
fn scale(content: &Content, factor: f32) -> Result<Content> {
    let _bar = Bar::spinner("sorting");
    let mut scene = Scene::clone(&content.base);
    for sphere in scene.records.to_mut() {
        sphere.radius = (sphere.radius * factor).clamp(f32::MIN_POSITIVE, f32::MAX);
    }
    let grid = Grid::sort_scene(&mut scene, &GridConfig::default())?;
    Ok(Content {
        name: content.name.clone(),
        format: content.format.clone(),
        notices: content.notices.clone(),
        base: Arc::clone(&content.base),
        scene: Arc::new(scene),
        grid: Arc::new(grid),
        radius_scale: factor,
        is_fixed: content.is_fixed,
        home: content.home.clone(),
        up: content.up,
        middle: content.middle,
        palette: content.palette.clone(),
    })
}

/// Starts a drawing thread, on the CPU if there is no such GPU as was asked for.
fn start(
    content: &Content,
    desk: Arc<Desk>,
    (backend, wanted): (BackendKind, &Wanted),
    proxy: &EventLoopProxy<Message>,
) -> Result<Engine> {
    let _bar = Bar::spinner("starting");
    let proxy = proxy.clone();
    let what = (Arc::clone(&content.scene), Arc::clone(&content.grid));
    let wake = move || {
        // There is nobody to wake up if the window is gone.
        proxy.send_event(Message::Drawn).ok();
    };
    let gpu = match backend {
        BackendKind::Cpu => Err(None),
        BackendKind::Gpu => Gpu::new(wanted.adapter.as_deref(), Extent::Full)
            .and_then(|gpu| Ok((GpuRenderer::new(&gpu, wanted.config.clone())?, gpu)))
            .map_err(|error| Some(format!("drawing on the CPU: {error}"))),
    };
    let no_thread = "the system gives no thread to draw on";
    match gpu {
        Ok((renderer, gpu)) => Ok(Engine {
            live: drawing::spawn(renderer, what, Arc::clone(&desk), wake).context(no_thread)?,
            desk,
            backend: BackendKind::Gpu,
            name: gpu.name().to_owned(),
            notice: None,
        }),
        Err(notice) => Ok(Engine {
            live: drawing::spawn(CpuRenderer::default(), what, Arc::clone(&desk), wake)
                .context(no_thread)?,
            desk,
            backend: BackendKind::Cpu,
            name: format!("CPU, {} threads", rayon::current_num_threads()),
            notice,
        }),
    }
}

fn save(path: &Path, image: &Image) -> Result<()> {
    Ok(png::write(path, image)?)
}
