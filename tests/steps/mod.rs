//! What pictures that are drawn step by step are tested with: scenes, views, orders, and what must
//! hold at every step.

use glam::DVec3;
use proptest::{prelude::*, test_runner::TestCaseError};
use puncta::{
    Amount, Density, DensityFifo, Depth, Frame, FrustumCull, Grid, GridConfig, Level, Picture,
    Pipeline, Progress, Renderer, Scene, Sphere, Stage, Transmittance, View, Visible,
    core::VisibleBrick,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Orders that have nothing in common.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Any {
    Nearest,
    Farthest,
    Shuffled,
    MostOpen,
}

impl<G: ?Sized> Stage<G> for Any {
    fn apply(&mut self, frame: &Frame<'_, G>, visible: &mut Visible) {
        Depth::default().apply(frame, visible);
        match self {
            Self::Nearest | Self::MostOpen => {}
            Self::Farthest => visible.bricks.reverse(),
            Self::Shuffled => {
                visible.bricks.sort_by_key(|brick| brick.index().wrapping_mul(0x9e37_79b1));
            }
        }
    }

    fn refine(&mut self, _frame: &Frame<'_, G>, visible: &mut Visible) {
        if let Self::MostOpen = self {
            let most = |brick: &VisibleBrick| (!brick.gain().to_bits(), brick.index());
            visible.bricks.sort_by_key(most);
        }
    }
}

/// Those, and those that there are.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Order {
    Any(Any),
    Level,
    Density,
    DensityFifo,
    Transmittance,
}

impl Order {
    pub(crate) fn stage(self) -> Box<dyn Stage<Grid>> {
        match self {
            Self::Any(any) => Box::new(any),
            Self::Level => Box::new(Level::default()),
            Self::Density => Box::new(Density::default()),
            Self::DensityFifo => Box::new(DensityFifo::default()),
            Self::Transmittance => Box::new(Transmittance::default()),
        }
    }
}

pub(crate) fn orders() -> impl Strategy<Value = Order> {
    prop_oneof![
        Just(Order::Any(Any::Nearest)),
        Just(Order::Any(Any::Farthest)),
        Just(Order::Any(Any::Shuffled)),
        Just(Order::Any(Any::MostOpen)),
        Just(Order::Level),
        Just(Order::Density),
        Just(Order::DensityFifo),
        Just(Order::Transmittance),
    ]
}

/// Spheres in a cube, in a few clusters or on sheets, with radii over two decades; some coincide.
pub(crate) fn scene(seed: u64) -> Scene {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let count = [0, 1, 30, 300, 3000][random.random_range(0..5)];
    let kind = random.random_range(0..3);
    let largest = [0.02_f32, 0.1, 0.5][random.random_range(0..3)];
    let mut sphere = || {
        let mut axis = || random.random::<f32>() * 2.0 - 1.0;
        let mut center = [axis(), axis(), axis()];
        match kind {
            1 => center = center.map(|x| (x * 2.0).round() * 0.5 + x * 0.1),
            2 => center[2] = (center[2] * 3.0).round() / 3.0,
            _ => {}
        }
        Sphere { center, radius: largest * 0.01_f32.powf(random.random::<f32>()) }
    };
    let mut records: Vec<Sphere> = (0..count).map(|_| sphere()).collect();
    for i in 0..count / 10 {
        records[i] = records[count - 1 - i];
    }
    let mut scene = Scene::new(records);
    scene.origin = if seed.is_multiple_of(4) { DVec3::splat(1e7) } else { DVec3::ZERO };
    scene
}

pub(crate) fn view() -> impl Strategy<Value = View> {
    let eyes = [-3.0_f64..3.0, -3.0_f64..3.0, -3.0_f64..3.0];
    let sizes = (1_u32..90, 1_u32..90);
    (eyes, sizes, 0.05_f64..2.0, any::<bool>(), prop_oneof![Just(1e-6), Just(0.3)]).prop_map(
        |(eye, (width, height), opening, is_perspective, near)| {
            let view = View::look_at(DVec3::from(eye), DVec3::splat(0.017), DVec3::Z).unwrap();
            let view = view.with_size(width, height).unwrap().with_near(near).unwrap();
            if is_perspective {
                view.with_perspective(opening).unwrap()
            } else {
                view.with_orthographic(opening * 2.0).unwrap()
            }
        },
    )
}

/// The same view, moved with a scene.
pub(crate) fn moved(view: &View, origin: DVec3) -> View {
    let eye = origin + view.eye();
    let moved = View::look_at(eye, eye + view.forward(), view.up()).unwrap();
    let moved = moved.with_size(view.width(), view.height()).unwrap();
    let moved = moved.with_near(view.near()).unwrap();
    match view.projection() {
        puncta::Projection::Perspective { fov_y } => moved.with_perspective(fov_y).unwrap(),
        puncta::Projection::Orthographic { height } => moved.with_orthographic(height).unwrap(),
    }
}

pub(crate) fn bits(picture: &Picture) -> Vec<(u32, u32)> {
    picture.depth.iter().map(|depth| depth.to_bits()).zip(picture.id.iter().copied()).collect()
}

fn sum(progress: &Progress) -> Amount {
    let mut sum = progress.drawn;
    sum += progress.skipped;
    sum += progress.left;
    sum += progress.culled;
    sum
}

/// A deep stack of sheets: nearly everything is hidden, and must be found to be.
pub(crate) fn wall() -> (Scene, Grid) {
    let sphere = |i: u32| {
        let at = |shift: u32| (i >> shift & 31) as f32;
        Sphere::new([at(0), at(5), at(10)], 0.8)
    };
    let mut scene = Scene::new((0..32_768).map(sphere).collect::<Vec<_>>());
    let grid = Grid::sort_scene(&mut scene, &GridConfig::longest_side(16)).unwrap();
    (scene, grid)
}

pub(crate) fn front(scene: &Scene) -> View {
    let view = View::look_at(DVec3::new(60.0, 45.0, 80.0), DVec3::splat(15.5), DVec3::Y).unwrap();
    view.with_size(160, 120).unwrap().fitted(&scene.bounds())
}

/// Renderers that tell which pixels are open, row by row.
pub(crate) trait Opens: Renderer<Sphere> {
    fn open(&mut self, view: &View) -> Vec<bool>;
}

/// A pipeline of any of the orders.
pub(crate) type Ordered<D> = Pipeline<(FrustumCull, Box<dyn Stage<Grid>>), D>;

/// At every step no pixel outside of the open set changes later, and in the end the picture is what
/// is expected, bit by bit.
pub(crate) fn check_steps<D: Opens>(
    pipeline: &mut Ordered<D>,
    (scene, grid): (&Scene, &Grid),
    (view, budget): (&View, u64),
    expected: &[(u32, u32)],
) -> Result<(), TestCaseError>
where
    D::Error: std::fmt::Debug,
{
    let mut steps = pipeline.progressive(scene, grid, view, budget).unwrap();
    let all = Amount { bricks: grid.bricks().len() as u64, records: scene.records.len() as u64 };
    prop_assert_eq!(sum(&steps.progress()), all);
    let mut count = 0;
    while let Some(progress) = steps.next() {
        let progress = progress.unwrap();
        let now = bits(&steps.picture().unwrap());
        let open = steps.renderer_mut().open(view);
        prop_assert_eq!(sum(&progress), all);
        prop_assert_eq!(progress.settled(), progress.left.bricks == 0);
        if progress.left.bricks > 0 {
            let pixels = open.iter().filter(|&&is_open| is_open).count() as u64;
            prop_assert_eq!(progress.open, pixels);
        }
        for (pixel, is_open) in open.into_iter().enumerate() {
            let is_open = is_open && !progress.settled();
            prop_assert!(is_open || now[pixel] == expected[pixel], "pixel {}", pixel);
        }
        count += 1;
        prop_assert!(count <= all.bricks + 1, "each step draws a brick or what was seen");
    }
    prop_assert!(steps.progress().settled());
    let last = bits(&steps.picture().unwrap());
    prop_assert_eq!(last.as_slice(), expected);
    Ok(())
}
