//! A curve: how the error of a picture falls while it is drawn in some order.

use crate::{
    clock::{self, Span},
    compare::{Sketch, Target},
    counting::{Counting, Hidden},
    hindsight::Hindsight,
    order::Order,
    progress::Bar,
    world::World,
};
use anyhow::{Result, ensure};
use puncta::{Amount, FrustumCull, Image, Pipeline, Progress};

/// The shares of the first error that are looked for.
pub(crate) const LEVELS: [f64; 4] = [0.5, 0.1, 0.01, 0.0];

/// The share of the first error at which a picture gives an impression of the final one.
const IMPRESSION: f64 = 0.5;

/// What a picture was compared at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// The time to cull, to order and to draw, without comparing.
    pub(crate) time: Span,
    pub(crate) progress: Progress,
    /// The root of the mean square of the differences from the final image.
    pub(crate) error: f64,
    /// The number of pixels that show another record than the final picture.
    pub(crate) wrong: u64,
}

/// All points of an order, the first of which is that of the empty picture.
#[derive(Debug)]
pub(crate) struct Curve {
    pub(crate) order: Order,
    pub(crate) in_view: Amount,
    pub(crate) steps: u64,
    pub(crate) points: Vec<Point>,
    /// The first image whose error is at most half of that of the empty picture.
    pub(crate) first_impression: Option<Image>,
}

impl Curve {
    pub(crate) fn first_error(&self) -> f64 {
        self.points.first().map_or(0.0, |point| point.error)
    }

    /// The point from which on the error is at most this share of the first one.
    pub(crate) fn reached(&self, share: f64) -> Option<&Point> {
        let most = share * self.first_error();
        let above = self.points.iter().rposition(|point| point.error > most);
        self.points.get(above.map_or(0, |last| last + 1))
    }

    /// The point at which nothing that was left could change a pixel.
    pub(crate) fn settled(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.progress.settled())
    }
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// The records of a step; a thousandth of those in view by default.
    pub(crate) budget: Option<u64>,
    /// The share by which more must have been drawn before pictures are compared again.
    pub(crate) every: f64,
    pub(crate) hidden: Hidden,
}

/// Draws a picture in an order from nothing, and compares it with the final one again and again.
pub(crate) fn measure(
    world: &World,
    target: &Target<'_>,
    order: Order,
    plan: &Plan,
) -> Result<Curve> {
    let (scene, view) = (world.scene(), target.view);
    let order_stage = match order.stage() {
        Some(stage) => stage,
        None => Box::new(Hindsight::new(target, &world.grid)?),
    };
    let stages = (FrustumCull, order_stage);
    let mut pipeline = Pipeline::new(stages, Counting::new(plan.hidden));
    let in_view = in_view(world, target)?;
    let budget = plan.budget.unwrap_or((in_view.records / 1000).max(1));
    let (begun, mut time) = clock::time(|| pipeline.progressive(scene, &world.grid, view, budget));
    let mut steps = begun?;
    let bar = Bar::counting("drawing", in_view.records);
    let mut sketch = Sketch::new(target)?;
    let point = |sketch: &Sketch<'_>, time, progress| Point {
        time,
        progress,
        error: sketch.error(),
        wrong: sketch.wrong(),
    };
    let mut curve = Curve { order, in_view, steps: 0, points: vec![], first_impression: None };
    curve.points.push(point(&sketch, time, steps.progress()));
    let mut compared = 0.0;
    loop {
        let (step, span) = clock::time(|| steps.next());
        let Some(progress) = step.transpose()? else { break };
        time += span;
        curve.steps += 1;
        bar.set(in_view.records - progress.left.records);
        let drawn = progress.drawn.records as f64;
        if drawn >= compared * (1.0 + plan.every) || progress.left.bricks == 0 {
            compared = drawn;
            sketch.update(&steps.picture()?)?;
            let point = point(&sketch, time, progress);
            if curve.first_impression.is_none() && point.error <= IMPRESSION * curve.first_error() {
                curve.first_impression = Some(sketch.image.clone());
            }
            curve.points.push(point);
        }
    }
    bar.finish();
    let picture = steps.picture()?;
    ensure!(picture == *target.picture, "{order:?} ends with another picture");
    ensure!(sketch.image == target.image, "{order:?} ends with another image");
    ensure!(steps.progress().settled(), "{order:?} ends unsettled");
    Ok(curve)
}

/// What the culling leaves.
fn in_view(world: &World, target: &Target<'_>) -> Result<Amount> {
    let mut pipeline = Pipeline::new(FrustumCull, Counting::default());
    let steps = pipeline.progressive(world.scene(), &world.grid, target.view, 1)?;
    Ok(steps.progress().left)
}
