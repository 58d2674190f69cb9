/*!
A scene, how it is seen, and how it is drawn without a pixel of it being seen.

For the time that geometry takes, the thesis turns the camera away. Here bricks beside the picture
would be left out before anything is done with them. So they are told to reach into the picture,
while all their records lie beside it: nothing is culled, every record is placed on the screen, and
none covers a pixel.
*/

use crate::world::{self, Origin, World};
use anyhow::{Result, ensure};
use glam::DVec3;
use puncta::{
    Amount, Brick, Bricks, GpuRenderer, Picture, Pipeline, Scene, Sphere, Stage, View,
    gpu::{GpuConfig, Skipping},
};

/// How large the scene is beside the picture, in pixels.
const SIZE_AWAY: f64 = 256.0;

/// A scene in its grid.
#[derive(Debug)]
pub(crate) struct Place {
    pub(crate) world: World,
    pub(crate) view: View,
    /// What the CPU's renderer draws.
    pub(crate) exact: Picture,
    pub(crate) away: Away,
}

impl Place {
    pub(crate) fn new(name: &str, size: &str) -> Result<Self> {
        let input = Some(name.to_owned());
        let world =
            World::read(&Origin { input, size: size.to_owned(), grid: None, radius: None })?;
        let view = world.look(world::Place::Overview)?;
        let exact = world.draw(&view)?;
        let away = Away::new(world.scene(), world.grid.bricks(), &view)?;
        Ok(Self { world, view, exact, away })
    }

    pub(crate) fn records(&self) -> u64 {
        self.world.scene().records.len() as u64
    }

    /// The number of pixels that show another record than they should.
    pub(crate) fn differing(&self, picture: &Picture) -> usize {
        self.exact.id.iter().zip(&picture.id).filter(|(exact, id)| exact != id).count()
    }

    /// The point that cameras turn around.
    pub(crate) fn pivot(&self) -> DVec3 {
        self.world.input.bounds.center()
    }
}

/// A scene beside the picture, and bricks that are not.
#[derive(Debug)]
pub(crate) struct Away {
    pub(crate) view: View,
    pub(crate) bricks: Vec<Brick>,
}

impl Away {
    #[expect(clippy::cast_possible_truncation, reason = "a pixel more or less is no matter")]
    pub(crate) fn new(scene: &Scene<Sphere>, bricks: &[Brick], like: &View) -> Result<Self> {
        let bounds = scene.bounds();
        let size = bounds.extent().max_element();
        let pixel = size / SIZE_AWAY;
        let right = bounds.max.x;
        let eye = DVec3::new(
            right + (2.0 + f64::from(like.width()) * 0.5) * pixel,
            bounds.min.y - 4.0 * size,
            bounds.center().z,
        );
        let view = View::look_at(eye, eye + DVec3::Y, DVec3::Z)?
            .with_size(like.width(), like.height())?
            .with_orthographic(f64::from(like.height()) * pixel)?;
        let reach = (right + 4.0 * pixel - scene.origin.x) as f32;
        let reaching = |brick: &Brick| {
            let mut brick = brick.clone();
            brick.bounds.max.x = brick.bounds.max.x.max(reach);
            brick
        };
        Ok(Self { view, bricks: bricks.iter().map(reaching).collect() })
    }

    /// Draws all of it, which shows nothing but brings all records to the device.
    pub(crate) fn draw<S: Stage<Vec<Brick>>>(
        &self,
        pipeline: &mut Pipeline<S, GpuRenderer>,
        scene: &Scene<Sphere>,
    ) -> Result<()> {
        let drawn = draw(pipeline, (scene, &self.bricks), &self.view)?;
        let all = scene.records.len() as u64;
        ensure!(drawn.records == all, "{} of {all} records are drawn", drawn.records);
        Ok(())
    }
}

/// A renderer's settings with room for so many records, and some to spare.
pub(crate) fn roomy(records: u64, skipping: Skipping) -> GpuConfig {
    GpuConfig { skipping, record_bytes: (records + 2048) * 24, ..GpuConfig::default() }
}

/// Draws a whole picture.
pub(crate) fn draw<G: Bricks, S: Stage<G>>(
    pipeline: &mut Pipeline<S, GpuRenderer>,
    (scene, bricks): (&Scene<Sphere>, &G),
    view: &View,
) -> Result<Amount> {
    let mut steps = pipeline.progressive(scene, bricks, view, u64::MAX)?;
    for step in &mut steps {
        step?;
    }
    Ok(steps.progress().drawn)
}
