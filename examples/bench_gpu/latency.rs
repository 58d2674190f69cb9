//! How long a new view waits for an answer, while another picture is drawn.
//!
//! Pictures are drawn in the background, in steps of [`STEP`]. As soon as a view has its first
//! answer, the next one is looked at, after a pause in which the drawing goes on.

use crate::{
    Options,
    place::{Place, roomy},
    progress::Bar,
    table::{Table, number},
};
use anyhow::{Context, Result};
use glam::DVec3;
use puncta::{
    CpuRenderer, Depth, FrustumCull, Gpu, GpuRenderer, Grid, Live, Pipeline, Renderer, Scene,
    Sphere, Step, View, gpu::Skipping,
};
use serde_json::{Value, json};
use std::{
    f64::consts::TAU,
    fmt,
    sync::{Arc, mpsc},
    thread,
    time::Duration,
};

/// What a step may take.
const STEP: Duration = Duration::from_millis(16);

/// How long a picture is drawn on after its first answer.
const PAUSE: Duration = Duration::from_millis(50);

/// How long to wait for an answer before giving up.
const PATIENCE: Duration = Duration::from_secs(600);

/// The answers of a renderer.
#[derive(Debug)]
pub(crate) struct Row {
    renderer: &'static str,
    /// In seconds, ascending.
    latencies: Vec<f64>,
    /// How many pictures were settled before the next view came.
    settled: usize,
}

/// What is drawn, for all that draw it.
#[derive(Clone)]
struct Shown {
    scene: Arc<Scene<Sphere>>,
    grid: Arc<Grid>,
    view: View,
    pivot: DVec3,
}

/// What is told after a step.
enum News {
    Answer(Duration),
    Settled,
    Failed(String),
}

pub(crate) fn measure(gpu: &Gpu, place: Place, options: &Options) -> Result<Vec<Row>> {
    let gpu = GpuRenderer::new(gpu, roomy(place.records(), Skipping::Hidden))?;
    let (view, pivot) = (place.view.clone(), place.pivot());
    let scene = Arc::new(place.world.input.scene);
    let shown = Shown { scene, grid: Arc::new(place.world.grid), view, pivot };
    let gpu = answers(&shown, gpu, options.turns)?;
    let cpu = answers(&shown, CpuRenderer::default(), options.turns)?;
    Ok([("gpu", gpu), ("cpu", cpu)].map(|(renderer, row)| Row { renderer, ..row }).into())
}

/// Turns the view all the way around.
fn answers<D>(shown: &Shown, renderer: D, turns: u32) -> Result<Row>
where
    D: Renderer<Sphere> + Send + 'static,
    D::Error: fmt::Display,
{
    let (sender, news) = mpsc::channel();
    let pipeline = Pipeline::new((FrustumCull, Depth::default()), renderer);
    let on_step = move |step: Step<'_, Sphere, Grid, D>| {
        let said = match (&step.progress, step.latency) {
            (Err(error), _) => Some(News::Failed(error.to_string())),
            (_, Some(latency)) => Some(News::Answer(latency)),
            _ => None,
        };
        let settled = step.progress.as_ref().is_ok_and(|progress| progress.settled());
        for news in said.into_iter().chain(settled.then_some(News::Settled)) {
            // Nobody listens at the end.
            sender.send(news).ok();
        }
    };
    let (scene, grid) = (Arc::clone(&shown.scene), Arc::clone(&shown.grid));
    let live = Live::spawn(scene, grid, pipeline, STEP, on_step)?;
    // The first picture brings the records and makes what the others use.
    live.look(shown.view.clone())?;
    live.wait_idle()?;
    news.try_iter().for_each(drop);
    let bar = Bar::counting("turning", turns.into());
    let (mut latencies, mut settled) = (Vec::new(), 0);
    for turn in 1..=turns {
        let angle = TAU * f64::from(turn) / f64::from(turns);
        live.look(shown.view.clone().orbited(shown.pivot, angle, 0.0))?;
        loop {
            match news.recv_timeout(PATIENCE).context("there is no answer")? {
                News::Answer(latency) => break latencies.push(latency.as_secs_f64()),
                News::Settled => settled += 1,
                News::Failed(error) => anyhow::bail!(error),
            }
        }
        thread::sleep(PAUSE);
        bar.set(turn.into());
    }
    bar.finish();
    settled += news.try_iter().filter(|news| matches!(news, News::Settled)).count();
    drop(live);
    latencies.sort_by(f64::total_cmp);
    Ok(Row { renderer: "", latencies, settled })
}

impl Row {
    /// The latency that this share of the answers stays below, in milliseconds.
    fn quantile(&self, share: f64) -> f64 {
        let last = self.latencies.len().saturating_sub(1) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (last * share).round() as usize;
        self.latencies.get(index).map_or(f64::NAN, |latency| latency * 1e3)
    }
}

pub(crate) fn table(name: &str, rows: &[Row]) -> String {
    let head = ["renderer", "least", "median", "9 of 10", "most", "views", "settled in time"];
    let title = format!("Until a new view is answered: {name}, in steps of 16 ms");
    let mut table = Table::new(&title, head);
    for row in rows {
        let mut cells = vec![row.renderer.to_owned()];
        cells.extend([0.0, 0.5, 0.9, 1.0].map(|share| number(row.quantile(share))));
        cells.extend([row.latencies.len().to_string(), row.settled.to_string()]);
        table.push(cells);
    }
    table.to_string()
}

pub(crate) fn json(rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "renderer": row.renderer,
            "seconds": row.latencies,
            "settled_before_the_next": row.settled,
        })
    };
    rows.iter().map(row).collect()
}
