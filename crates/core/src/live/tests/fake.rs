//! A renderer that does as it is told and tells what it does, and what it draws.

use crate::{
    Aabb, Amount, Brick, Error, Frame, Live, Picture, Pipeline, Renderer, Scene, Sphere, Step,
    View, Visible, VisibleBrick,
};
use glam::DVec3;
use std::sync::{
    Arc,
    mpsc::{Receiver, Sender, channel},
};

/// Views of these widths go wrong.
pub(super) const BAD_BEGIN: u32 = 7001;
pub(super) const BAD_DRAW: u32 = 7002;
pub(super) const PANIC_BEGIN: u32 = 7003;
pub(super) const PANIC_DRAW: u32 = 7004;
pub(super) const PANIC_STAGE: u32 = 7005;
pub(super) const PANIC_TOLD: u32 = 7006;

#[derive(Debug, PartialEq, thiserror::Error)]
pub(super) enum Fault {
    #[error(transparent)]
    Core(#[from] Error),
    #[error("cannot begin")]
    Begin,
    #[error("cannot draw")]
    Draw,
}

/// What the renderer was asked to do: views are known by their width, scenes by their size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Call {
    Begin(u32),
    Draw(u32, usize),
}

/// Tells each call, and draws only when it may: if there is a gate, for each message through it,
/// and freely once the other end is gone.
pub(super) struct Fake {
    pub(super) calls: Sender<Call>,
    pub(super) gate: Option<Receiver<()>>,
    /// Whether it remembers what it drew.
    pub(super) has_memory: bool,
    pub(super) has_drawn: bool,
    pub(super) width: u32,
}

impl Fake {
    pub(super) fn new() -> (Self, Receiver<Call>) {
        let (calls, told) = channel();
        (Self { calls, gate: None, has_memory: false, has_drawn: false, width: 0 }, told)
    }

    pub(super) fn gated() -> (Self, Receiver<Call>, Sender<()>) {
        let (fake, told) = Self::new();
        let (open, gate) = channel();
        (Self { gate: Some(gate), ..fake }, told, open)
    }
}

impl Renderer<Sphere> for Fake {
    type Error = Fault;

    fn begin(&mut self, view: &View) -> Result<(), Fault> {
        self.width = view.width();
        self.calls.send(Call::Begin(self.width)).ok();
        match self.width {
            BAD_BEGIN => Err(Fault::Begin),
            PANIC_BEGIN => panic!("begin {}", self.width),
            _ => Ok(()),
        }
    }

    fn draw(
        &mut self,
        content: &crate::Content<'_, Sphere>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Fault> {
        self.calls.send(Call::Draw(self.width, content.scene.records.len())).ok();
        if let Some(gate) = &self.gate {
            gate.recv().ok();
        }
        self.has_drawn = true;
        match self.width {
            BAD_DRAW => Err(Fault::Draw),
            PANIC_DRAW => panic!("draw"),
            _ => Ok(Amount::of(content.bricks, bricks)),
        }
    }

    fn recall(&mut self, _: &crate::Content<'_, Sphere>, _: &[VisibleBrick]) -> Result<u64, Fault> {
        Ok(u64::from(self.has_memory && self.has_drawn))
    }

    fn finish(&mut self, _: &crate::Content<'_, Sphere>) -> Result<Picture, Fault> {
        Ok(Picture::new(self.width, 1)?)
    }
}

pub(super) fn stage(frame: &Frame<'_, Vec<Brick>>, _: &mut Visible) {
    assert_ne!(frame.view.width(), PANIC_STAGE, "stage");
}

pub(super) fn view(width: u32) -> View {
    let view = View::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y).unwrap();
    view.with_size(width, 1).unwrap()
}

/// Spheres, each in a brick of its own: with a budget of 1, each is a step.
pub(super) fn content(count: u32) -> (Arc<Scene>, Arc<Vec<Brick>>) {
    let bounds = Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO };
    let brick = |i| Brick { records: i..i + 1, bounds, radius_max: 1.0, density: 1.0 };
    let records = vec![Sphere::new([0.0; 3], 1.0); count as usize];
    (Arc::new(Scene::new(records)), Arc::new((0..count).map(brick).collect()))
}

/// What a step told.
#[derive(Debug, PartialEq)]
pub(super) struct Told {
    pub(super) width: u32,
    pub(super) left: Result<u64, Fault>,
    pub(super) has_latency: bool,
}

impl Told {
    pub(super) fn of(step: Step<'_, Sphere, Vec<Brick>, Fake>) -> Self {
        Self {
            width: step.view.width(),
            left: step.progress.map(|progress| progress.left.bricks),
            has_latency: step.latency.is_some(),
        }
    }
}

pub(super) type FakeLive = Live<Sphere, Vec<Brick>>;

pub(super) fn spawn(fake: Fake, count: u32) -> (FakeLive, Receiver<Told>) {
    let (scene, bricks) = content(count);
    let (tell, told) = channel();
    let on_step = move |step: Step<'_, Sphere, Vec<Brick>, Fake>| {
        assert_ne!(step.view.width(), PANIC_TOLD, "told");
        tell.send(Told::of(step)).ok();
    };
    let live = Live::spawn(scene, bricks, Pipeline::new(stage, fake), 1, on_step).unwrap();
    (live, told)
}
