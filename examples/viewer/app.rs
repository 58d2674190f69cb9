//! The state of the viewer: what is shown, what was asked for, and what follows from what.

use crate::{
    asking::{Asking, REST, Wish},
    camera::Camera,
    cli::{Cli, Order},
    drawing::{Desk, Frame, Shown, lock},
    graph::History,
    look::{self, Look},
    options::BackendKind,
    options::ColorBy,
    picking::Pick,
    pointer::Anchor,
    viewing::Message,
    worker::{Content, Engine, Job, Wanted},
};
use anyhow::Result;
use egui::{Context, TextureHandle, TextureOptions};
use puncta::{ColorMap, GpuConfig, Image, Progress, cpu::draw_legend};
use std::{
    io::Write,
    path::{Path, PathBuf},
    sync::{Arc, mpsc::Sender},
    time::{Duration, Instant},
};

pub(crate) struct App {
    pub(crate) cli: Cli,
    jobs: Sender<Job>,
    pub(crate) content: Option<Arc<Content>>,
    pub(crate) engine: Option<Engine>,
    /// What was asked for to draw with.
    pub(crate) backend: BackendKind,
    pub(crate) camera: Option<Camera>,
    pub(crate) look: Look,
    pub(crate) order: Order,
    /// Whether pictures get smooth edges when the camera rests.
    pub(crate) is_smooth: bool,
    /// Whether the panel beside the picture is there.
    pub(crate) has_panel: bool,
    /// The factor of radii that was chosen last.
    pub(crate) radius_scale: f32,
    is_scaling: bool,
    pub(crate) pick: Option<Pick>,
    pub(crate) shown: Option<Shown>,
    pub(crate) texture: Option<TextureHandle>,
    pub(crate) progress: Progress,
    pub(crate) history: History,
    /// What went wrong, until the user has read it.
    pub(crate) error: Option<String>,
    /// What was done last.
    pub(crate) notice: String,
    pub(crate) name: String,
    title: Option<String>,
    asking: Asking,
    /// Whether the user is holding the camera.
    pub(crate) is_held: bool,
    /// Where the last zoom went: see `pointer.rs`.
    pub(crate) anchor: Anchor,
}

impl App {
    /// A viewer that opens what the options name.
    pub(crate) fn new(cli: Cli, jobs: Sender<Job>) -> Result<Self> {
        if let Some(map) = &cli.render.colormap {
            ColorMap::named(map)?;
        }
        let look = Look::unknown(&cli.render);
        let mut app = Self {
            jobs,
            content: None,
            engine: None,
            backend: cli.render.backend,
            camera: None,
            look,
            order: cli.order,
            is_smooth: cli.render.supersample != Some(1),
            has_panel: true,
            radius_scale: 1.0,
            is_scaling: false,
            pick: None,
            shown: None,
            texture: None,
            progress: Progress::default(),
            history: History::default(),
            error: None,
            notice: String::new(),
            name: cli.render.input.clone().unwrap_or_default(),
            title: None,
            asking: Asking::default(),
            is_held: false,
            anchor: Anchor::default(),
            cli,
        };
        app.send(Job::Open(Box::new(app.cli.render.clone())));
        Ok(app)
    }

    /// Gives the worker something to do.
    pub(crate) fn send(&mut self, job: Job) {
        if self.jobs.send(job).is_err() {
            self.error = Some("the worker has stopped: please start the viewer again".to_owned());
        }
    }

    /// Opens a file or a generator instead of what is shown.
    pub(crate) fn open(&mut self, name: &str) {
        self.cli.render.input = Some(name.to_owned()).filter(|name| !name.is_empty());
        self.notice.clear();
        self.error = None;
        (self.cli.render.color_by, self.cli.render.range) = (ColorBy::Auto, None);
        let mut options = self.cli.render.clone();
        // These were meant for the scene that the command line names.
        (options.eye, options.target, options.near) = (None, None, None);
        (options.ortho, options.frame) = (None, 0);
        self.send(Job::Open(Box::new(options)));
    }

    /// Draws with something else.
    pub(crate) fn start(&mut self, backend: BackendKind) {
        let Some(content) = self.content.clone() else { return };
        self.backend = backend;
        let config = GpuConfig {
            setup: self.cli.setup,
            fragment: self.cli.fragment,
            ..GpuConfig::default()
        };
        let wanted = Wanted { adapter: self.cli.render.adapter.clone(), config };
        let desk = Arc::new(Desk::new(self.look.clone(), self.order));
        self.send(Job::Start(content, desk, backend, wanted));
    }

    /// Takes in what another thread has to say.
    pub(crate) fn receive(&mut self, message: Message, context: &Context) {
        match message {
            Message::Opened(Ok(content)) => self.take_new(content),
            Message::Scaled(Ok(content)) => {
                self.is_scaling = false;
                self.take_scaled(content);
            }
            Message::Started(Ok(engine)) => self.take_engine(engine),
            Message::Saved(Ok(path)) => {
                self.notice = format!("wrote {}", path.canonicalize().unwrap_or(path).display());
            }
            Message::Drawn => {
                let desk = self.engine.as_ref().map(|engine| Arc::clone(&engine.desk));
                for frame in desk.map(|desk| desk.take()).unwrap_or_default() {
                    self.take_frame(frame, context);
                }
            }
            Message::Scaled(Err(error)) => {
                self.is_scaling = false;
                self.error = Some(format!("{error:#}"));
            }
            Message::Opened(Err(error))
            | Message::Started(Err(error))
            | Message::Saved(Err(error)) => self.error = Some(format!("{error:#}")),
        }
    }

    fn take_new(&mut self, content: Arc<Content>) {
        let near = self.cli.render.near;
        let camera = Camera::new(content.home.clone(), content.up, content.middle);
        let size = self.camera.as_ref().map(|camera| camera.view().clone());
        let mut camera = camera.with_near(near.filter(|_| self.content.is_none()));
        if let Some(view) = size {
            camera.resize((view.width(), view.height()));
        }
        self.camera = Some(camera);
        self.look = Look::new(&self.cli.render, &content.palette);
        (self.pick, self.anchor, self.radius_scale) = (None, Anchor::default(), 1.0);
        self.name.clone_from(&content.name);
        let short = Path::new(&content.name).file_name().map(|name| name.to_string_lossy());
        self.title = Some(format!("{} - puncta", short.unwrap_or_default()));
        self.notice = content.notices.first().cloned().unwrap_or_default();
        self.content = Some(content);
        if self.engine.is_some() {
            self.set_look();
            self.show_content();
        } else {
            self.start(self.backend);
        }
    }

    fn take_scaled(&mut self, content: Arc<Content>) {
        let is_of_this = |now: &Arc<Content>| content.is_same_file(now);
        if !self.content.as_ref().is_some_and(is_of_this) {
            return;
        }
        if let Some(pick) = &mut self.pick {
            pick.find_in(&content.scene);
        }
        self.content = Some(content);
        self.show_content();
    }

    fn take_engine(&mut self, engine: Engine) {
        self.backend = engine.backend;
        if let Some(notice) = &engine.notice {
            self.notice.clone_from(notice);
        }
        if let Some(before) = self.engine.replace(engine) {
            // It may be in the middle of a step, and the window does not wait.
            std::thread::spawn(move || drop(before));
        }
        self.set_look();
        self.set_order();
        self.show_content();
    }

    /// Draws what is open now.
    fn show_content(&mut self) {
        let (Some(engine), Some(content), Some(camera)) =
            (&self.engine, &self.content, &self.camera)
        else {
            return;
        };
        let view = camera.view().clone();
        let (scene, grid) = (Arc::clone(&content.scene), Arc::clone(&content.grid));
        *lock(&engine.desk.fine) = None;
        if let Err(error) = engine.live.show_from(scene, grid, view.clone()) {
            self.error = Some(error.to_string());
        }
        self.asking = Asking { view: Some(view), moved: Instant::now() };
    }

    fn take_frame(&mut self, frame: Frame, context: &Context) {
        let pixels = u64::from(frame.view.width()) * u64::from(frame.view.height());
        self.history.take(&frame, pixels);
        match frame.progress {
            Ok(progress) => self.progress = progress,
            Err(error) => self.error = Some(error),
        }
        let Some(mut shown) = frame.shown else { return };
        let is_current =
            self.content.as_ref().is_some_and(|now| Arc::ptr_eq(&now.scene, &shown.scene));
        if !is_current {
            return;
        }
        if let Some(image) = shown.texture.take() {
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let texture = context.load_texture("picture", image, TextureOptions::LINEAR);
                    self.texture = Some(texture);
                }
            }
        }
        if self.cli.log && self.progress.settled() {
            let (eye, covered) = (shown.view.eye(), shown.picture.covered_pixels());
            let (width, height) = (shown.view.width(), shown.view.height());
            let line = format!("settled {width}x{height} eye={eye} covered={covered}");
            // Nobody may be listening any more.
            writeln!(std::io::stdout(), "{line}").ok();
        }
        self.shown = Some(shown);
    }

    /// Asks for the picture that is to be seen now, if it was not asked for yet. Returns when to
    /// look again.
    pub(crate) fn ask(&mut self) -> Option<Duration> {
        let (Some(engine), Some(camera)) = (&self.engine, &self.camera) else { return None };
        let factor = if self.is_smooth { 2 } else { 1 };
        let state = (self.is_settled(), self.is_held);
        let (next, fine) = match self.asking.wish(camera.view(), factor, state) {
            Wish::Nothing => return None,
            Wish::Wait(time) => return Some(time),
            Wish::Plain(view) => (view, None),
            Wish::Fine(view) => {
                let size = (view.width(), view.height());
                (view, Some(size))
            }
        };
        *lock(&engine.desk.fine) = fine;
        let pixels = u64::from(next.width()) * u64::from(next.height());
        if let Err(error) = engine.live.look(next) {
            self.error = Some(error.to_string());
        }
        self.progress.open = pixels;
        Some(REST)
    }

    /// Whether the picture that was asked for last is there, and complete.
    fn is_settled(&self) -> bool {
        let is_asked = |shown: &Shown| self.asking.view.as_ref() == Some(&shown.view);
        self.progress.settled() && self.shown.as_ref().is_some_and(is_asked)
    }

    /// Whether there is nothing more to come.
    pub(crate) fn is_at_rest(&self) -> bool {
        let is_final = |shown: &Shown| shown.factor == 2 || !self.is_smooth;
        self.is_settled() && self.shown.as_ref().is_some_and(is_final)
    }

    /// Draws anew, as something else than the camera has changed.
    fn redraw(&mut self) {
        self.asking.view = None;
    }

    /// Makes images as `look` says from now on.
    pub(crate) fn set_look(&mut self) {
        if let Some(engine) = &self.engine {
            *lock(&engine.desk.look) = self.look.clone();
        }
        self.redraw();
    }

    /// Draws in the chosen order from now on.
    pub(crate) fn set_order(&mut self) {
        if let Some(engine) = &self.engine {
            *lock(&engine.desk.order) = Some(self.order);
        }
        self.redraw();
    }

    /// Colors by something else.
    pub(crate) fn color_by(&mut self, color_by: ColorBy) {
        self.look.color_by = color_by;
        self.look.range = self.content.as_ref().and_then(|now| now.palette.range(&self.look));
        self.set_look();
    }

    /// Sees to it that the radii become what was chosen.
    pub(crate) fn scale(&mut self) {
        let Some(content) = &self.content else { return };
        if !self.is_scaling && !content.is_fixed && content.radius_scale != self.radius_scale {
            self.is_scaling = true;
            self.send(Job::Scale(Arc::clone(content), self.radius_scale));
        }
    }

    /// Goes back to a view of everything.
    pub(crate) fn go_home(&mut self) {
        let (Some(content), Some(before)) = (&self.content, &self.camera) else { return };
        let camera = Camera::new(content.home.clone(), content.up, content.middle);
        let mut camera = camera.with_near(self.cli.render.near);
        camera.resize((before.view().width(), before.view().height()));
        self.camera = Some(camera);
    }

    /// What is seen, with a legend if that was asked for.
    pub(crate) fn image(&self) -> Option<Image> {
        let shown = self.shown.as_ref()?;
        let mut image = shown.image.clone();
        if self.cli.render.legend
            && look::is_mapped(&self.look.color_by)
            && let (Some(range), Ok(map)) = (shown.range, ColorMap::named(&self.look.map))
        {
            draw_legend(&mut image, &map, range, &look::name(&self.look.color_by));
        }
        Some(image)
    }

    /// Writes what is seen to a file that is not there yet.
    pub(crate) fn save(&mut self) {
        let Some(image) = self.image() else { return };
        let path = free_path(&self.cli.render.out);
        self.notice = format!("writing {}", path.display());
        self.send(Job::Save(path, image));
    }

    /// The title of the window, if there is a new one.
    pub(crate) fn new_title(&mut self) -> Option<String> {
        self.title.take()
    }

    /// Notes how long the window took to make up what it paints.
    pub(crate) fn note_work(&mut self, took: Duration) {
        self.history.note_work(took);
    }
}

/// This path, or with a number behind its name if there is such a file.
fn free_path(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let numbered = |number: u32| path.with_file_name(format!("{stem}-{number}.png"));
    let mut paths = std::iter::once(path.to_owned()).chain((2..10_000).map(numbered));
    paths.find(|path| !path.exists()).unwrap_or_else(|| path.to_owned())
}
