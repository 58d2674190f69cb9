/*!
What every crate of puncta speaks: records, scenes, views, pictures, and the traits at the joints.

A [`Scene`] holds [`Record`]s (any type with a position and a radius) relative to an `f64` origin.
A spatial structure, such as the uniform grid of `puncta-grid`, cuts the records into [`Brick`]s.
For a [`View`], [`Stage`]s narrow and order the bricks, and a [`Renderer`] draws them into a
[`Picture`]: view depth and record id for each pixel. A [`Pipeline`] ties these together, and a
[`Live`] runs it on a thread of its own, for programs that must not wait.

```
use glam::DVec3;
use puncta_core::{Scene, Sphere, View};

let scene = Scene::new(vec![Sphere::new([0.0, 0.0, 0.0], 1.0), Sphere::new([2.0, 0.0, 0.0], 0.5)]);
let view = View::look_at(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, DVec3::Y)?.fitted(&scene.bounds());
assert!(view.eye().z > 2.0);
# Ok::<(), puncta_core::Error>(())
```

# Coordinates

World coordinates are `f64` and right-handed, in the units of the data. The stored position of a
record is an `f32` offset from [`Scene::origin`], so a scene keeps its digits wherever it lies.
Camera coordinates are *right, up, forward*: the third one is the **view depth**, which is positive
in front of the camera. Pixel rows run from the top, and the ray of a pixel goes through its centre.

# What a picture shows

At each pixel: the nearest *front* surface along the ray, that is the nearest point where the ray
enters a sphere, at a view depth of at least [`View::near`]. Equal depths go to the lower id. So a
sphere that holds the camera is not drawn (the ray never enters it), and where the near plane cuts
a sphere open, one looks through the cut at what lies behind.
*/

mod background;
mod bound;
mod bounds;
mod brick;
mod budget;
mod camera;
mod column;
mod error;
mod frame;
mod image;
mod live;
mod picture;
mod pipeline;
mod range;
mod record;
mod renderer;
mod scene;
mod source;
mod stage;
mod view;

pub use crate::{
    background::Background,
    bound::{Bounder, ScreenBound, depth_below},
    bounds::{Aabb, Bounds},
    brick::{Block, Brick, Bricks, Visible, VisibleBrick},
    budget::Budget,
    camera::{Camera, Hit, ScreenBox, nearest_depth},
    column::Column,
    error::Error,
    image::Image,
    live::{Live, Step},
    picture::{NO_RECORD, Picture},
    pipeline::{Pipeline, Progressive},
    range::{RangeBins, inner_range},
    record::{Record, Sphere},
    renderer::{Amount, Content, Progress, Renderer},
    scene::{Attributes, MAX_RECORDS, Scalar, Scene},
    source::{SliceSource, Source},
    stage::{Frame, Stage},
    view::{MAX_SIDE, Projection, View},
};
