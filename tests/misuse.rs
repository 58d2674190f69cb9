//! What stages, renderers and contents of a user's own may do wrong, or unexpectedly: nothing panics,
//! nothing is lost, and progress says what is.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use puncta::{
    Amount, Brick, Content, CpuRenderer, Frame, Picture, Pipeline, Record, Renderer, Scene, Sphere,
    Stage, View, Visible,
    core::{Aabb, Block, VisibleBrick},
};
use std::ops::Range;

fn brick(scene: &Scene, records: Range<u32>) -> Brick {
    let (mut bounds, mut radius_max) = (Aabb::EMPTY, 0.0_f32);
    for record in &scene.records[records.start as usize..records.end as usize] {
        bounds.add(record.position());
        radius_max = radius_max.max(record.radius());
    }
    Brick { records, bounds, radius_max, density: 0.5 }
}

fn begun(view: &View) -> CpuRenderer {
    let mut renderer = CpuRenderer::default();
    Renderer::<Sphere>::begin(&mut renderer, view).unwrap();
    renderer
}

/// Two scenes that differ in their origins alone, and share their bricks, in one picture: what is
/// hidden in one place is not in the other.
#[test]
fn bricks_can_be_drawn_in_two_places() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0), Sphere::new([0.0, 0.0, -3.0], 0.5)]);
    let moved = Scene { origin: DVec3::X * 2.5, ..scene.clone() };
    let bricks = [brick(&scene, 0..1), brick(&scene, 1..2)];
    let view = View::look_at(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(190, 90).unwrap();
    let mut renderer = begun(&view);
    let mut draw = |scene: &Scene, which: Range<usize>| {
        let content = Content { scene, bricks: &bricks, blocks: &[] };
        let mut visible = Visible::all(&bricks, scene.origin, &view).bricks;
        renderer.draw(&content, &visible[which]).unwrap();
        renderer.survey(&content, &mut visible).unwrap();
        visible[1].gain()
    };
    assert_eq!(draw(&scene, 0..1), 0.0);
    assert!(draw(&moved, 0..0) > 10.0);
    draw(&moved, 1..2);
    let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
    let picture = renderer.finish(&content).unwrap();
    assert_eq!(picture.visible_records(), [0, 1]);
}

/// Blocks may be others at the next call.
#[test]
fn blocks_may_change_while_a_picture_is_drawn() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 2.0), Sphere::new([0.0, 0.0, -9.0], 0.5)]);
    let bricks = [brick(&scene, 0..1), brick(&scene, 1..2)];
    let behind = [Block::of_run(1, &bricks[1..])];
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(64, 64).unwrap();
    let mut renderer = begun(&view);
    let mut visible = Visible::all(&bricks, scene.origin, &view).bricks;
    let content = Content { scene: &scene, bricks: &bricks, blocks: &behind };
    renderer.draw(&content, &[]).unwrap();
    let content = Content { blocks: &[], ..content };
    renderer.draw(&content, &visible[..1]).unwrap();
    renderer.survey(&content, &mut visible).unwrap();
    assert!(!visible[1].is_open());
    assert!(visible[0].is_open());
}

/// What a stage may do wrong when it orders anew: it takes the bricks of another list.
#[test]
fn bricks_of_another_list_are_not_drawn() {
    struct Swaps(Vec<Brick>);
    impl<G: ?Sized> Stage<G> for Swaps {
        fn apply(&mut self, _: &Frame<'_, G>, _: &mut Visible) {}
        fn refine(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
            *visible = Visible::all(&self.0, frame.origin, frame.view);
        }
    }
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5); 3]);
    let own = [0..1, 1..2, 2..3].map(|range| brick(&scene, range));
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(64, 64).unwrap();
    let mut pipeline = Pipeline::new(Swaps(vec![own[0].clone(); 9]), CpuRenderer::default());
    let mut steps = pipeline.progressive(&scene, &own, &view, 1).unwrap();
    for _ in 0..10 {
        steps.next().map(Result::unwrap);
        assert!(steps.left().iter().all(|brick| brick.index() < 3));
    }
}

/// What a stage drops while a picture is drawn is told as culled, and the picture ends.
#[test]
fn what_is_dropped_on_the_way_is_culled() {
    struct Drops;
    impl<G: ?Sized> Stage<G> for Drops {
        fn apply(&mut self, _: &Frame<'_, G>, _: &mut Visible) {}
        fn refine(&mut self, _: &Frame<'_, G>, visible: &mut Visible) {
            visible.bricks.pop();
        }
    }
    let at = |x: f32| Sphere::new([x, 0.0, 0.0], 0.4);
    let scene = Scene::new(vec![at(-1.0), at(0.0), at(1.0)]);
    let own = [0..1, 1..2, 2..3].map(|range| brick(&scene, range));
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let mut pipeline = Pipeline::new(Drops, CpuRenderer::default());
    let view = view.with_size(64, 64).unwrap();
    let mut steps = pipeline.progressive(&scene, &own, &view, 1).unwrap();
    let first = steps.next().unwrap().unwrap();
    assert_eq!([first.drawn.bricks, first.left.bricks, first.culled.bricks], [1, 1, 1]);
    let last = steps.next().unwrap().unwrap();
    assert!(last.settled() && steps.next().is_none());
    assert_eq!([last.drawn.records, last.left.records, last.culled.records], [2, 0, 1]);
}

#[test]
fn what_is_asked_before_a_picture_is_begun_is_an_error() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5)]);
    let bricks = [brick(&scene, 0..1)];
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
    let mut visible = Visible::all(&bricks, scene.origin, &view).bricks;
    let mut renderer = CpuRenderer::default();
    assert!(renderer.draw(&content, &visible).is_err());
    assert!(renderer.recall(&content, &visible).is_err());
    assert!(renderer.survey(&content, &mut visible).is_err());
    assert!(renderer.finish(&content).is_err());
    assert!(!renderer.is_open(0, 0));
}

/// A renderer whose device fails now and then.
struct Failing {
    inner: CpuRenderer,
    surveys: usize,
    /// How many pictures can be begun.
    begins_left: usize,
}

impl Default for Failing {
    fn default() -> Self {
        Self { inner: CpuRenderer::default(), surveys: 0, begins_left: usize::MAX }
    }
}

impl Renderer<Sphere> for Failing {
    type Error = puncta::cpu::Error;

    fn begin(&mut self, view: &View) -> Result<(), Self::Error> {
        let failure = puncta::core::Error::NotBegun;
        self.begins_left = self.begins_left.checked_sub(1).ok_or(failure)?;
        Renderer::<Sphere>::begin(&mut self.inner, view)
    }

    fn draw(
        &mut self,
        content: &Content<'_, Sphere>,
        bricks: &[VisibleBrick],
    ) -> Result<Amount, Self::Error> {
        self.inner.draw(content, bricks)
    }

    fn survey(
        &mut self,
        content: &Content<'_, Sphere>,
        left: &mut [VisibleBrick],
    ) -> Result<Option<u64>, Self::Error> {
        self.surveys += 1;
        if self.surveys.is_multiple_of(3) {
            return Err(puncta::core::Error::NotBegun.into());
        }
        self.inner.survey(content, left)
    }

    fn finish(&mut self, content: &Content<'_, Sphere>) -> Result<Picture, Self::Error> {
        self.inner.finish(content)
    }
}

/// A picture ends with an error, and the next one is complete all the same.
#[test]
fn a_picture_can_follow_one_that_failed() {
    let at = |x: u8| Sphere::new([f32::from(x), 0.0, 0.0], 0.4);
    let scene = Scene::new((0..4).map(at).collect::<Vec<_>>());
    let own = [0..1, 1..2, 2..3, 3..4].map(|range| brick(&scene, range));
    let view = View::look_at(DVec3::Z * 9.0, DVec3::X * 1.5, DVec3::Y).unwrap();
    let view = view.with_size(64, 64).unwrap();
    let mut pipeline = Pipeline::new((), Failing::default());
    let mut steps = pipeline.progressive(&scene, &own, &view, 1).unwrap();
    assert!(steps.nth(2).unwrap().is_err());
    assert!(steps.next().is_none() && !steps.progress().settled());
    steps.look(&view).unwrap();
    assert_eq!(steps.left().len(), 4);
    steps.next().unwrap().unwrap();
    assert_eq!(steps.progress().drawn.bricks, 1);
    assert_eq!(steps.left().len(), 3);
}

/// A view that cannot be begun leaves nothing to draw, and no complete picture either.
#[test]
fn a_view_that_cannot_be_drawn_is_not_settled() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5)]);
    let own = [brick(&scene, 0..1)];
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let view = view.with_size(16, 16).unwrap();
    let mut pipeline = Pipeline::new((), Failing { begins_left: 1, ..Failing::default() });
    let mut steps = pipeline.progressive(&scene, &own, &view, 1).unwrap();
    assert!(steps.look(&view).is_err());
    assert!(steps.left().is_empty() && steps.next().is_none());
    assert!(!steps.progress().settled());
}

/// What was settled in one picture is open in the next one.
#[test]
fn all_pixels_of_a_new_picture_are_open() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5)]);
    let bricks = [brick(&scene, 0..1)];
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    let content = Content { scene: &scene, bricks: &bricks, blocks: &[] };
    let mut renderer = begun(&view);
    assert!(renderer.is_open(0, 0));
    assert_eq!(renderer.survey(&content, &mut []).unwrap(), Some(0));
    assert!(!renderer.is_open(0, 0));
    Renderer::<Sphere>::begin(&mut renderer, &view).unwrap();
    assert!(renderer.is_open(0, 0) && !renderer.is_open(view.width(), 0));
}

#[test]
fn bricks_of_records_that_are_not_there_are_errors() {
    let scene = Scene::new(vec![Sphere::new([0.0; 3], 0.5)]);
    let good = brick(&scene, 0..1);
    let view = View::look_at(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y).unwrap();
    for (start, end) in [(1, 0), (0, 2), (1, 2), (5, 5)] {
        let bricks = vec![good.clone(), Brick { records: start..end, ..good.clone() }];
        let mut pipeline = Pipeline::new((), CpuRenderer::default());
        assert!(pipeline.render(&scene, &bricks, &view).is_err(), "{start}..{end}");
    }
    let bricks = vec![good.clone(), Brick { records: 1..1, ..good }];
    let mut pipeline = Pipeline::new((), CpuRenderer::default());
    assert!(pipeline.render(&scene, &bricks, &view).unwrap().covered_pixels() > 0);
}
