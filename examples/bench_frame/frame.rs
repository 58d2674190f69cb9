//! The rest of a frame: drawing until nothing can change any more.
//!
//! The renderer leaves out what lies behind what was drawn before. It cannot be told not to, but from
//! back to front hardly anything lies behind: so this is the cost of a frame without skipping.

use crate::{
    clock::{self, Span},
    order::Order,
    world::World,
};
use anyhow::{Result, ensure};
use clap::ValueEnum;
use puncta::{
    Amount, CpuRenderer, Depth, Frame, FrustumCull, Grid, Pipeline, Stage, View, Visible,
};

/// The way in which a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    In(Order),
    BackToFront,
}

impl Way {
    fn all() -> Vec<Self> {
        let orders = Order::value_variants().iter().copied();
        let orders = orders.filter(|order| order.stage().is_some()).map(Self::In);
        orders.chain([Self::BackToFront]).collect()
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::In(order) => {
                let value = order.to_possible_value();
                value.map_or_else(String::new, |value| value.get_name().to_owned())
            }
            Self::BackToFront => "back to front".to_owned(),
        }
    }

    fn stage(self) -> Box<dyn Stage<Grid>> {
        match self {
            Self::In(order) => order.stage().unwrap_or_else(|| Box::new(())),
            Self::BackToFront => Box::new(|frame: &Frame<'_, Grid>, visible: &mut Visible| {
                Depth::default().apply(frame, visible);
                visible.bricks.reverse();
            }),
        }
    }
}

/// Draws whole pictures in all ways in turn: what was drawn, and how long it took with culling and
/// ordering.
pub(crate) fn measure(
    world: &World,
    view: &View,
    repetitions: usize,
) -> Result<Vec<(Way, Amount, Vec<Span>)>> {
    let mut ways: Vec<_> = Way::all()
        .into_iter()
        .map(|way| {
            let pipeline = Pipeline::new((FrustumCull, way.stage()), CpuRenderer::default());
            (way, pipeline, Amount::default(), vec![])
        })
        .collect();
    for repetition in 0..=repetitions {
        for (way, pipeline, drawn, spans) in &mut ways {
            pipeline.forget::<puncta::Sphere>();
            let (progress, span) = clock::time(|| {
                let mut steps = pipeline.progressive(world.scene(), &world.grid, view, u64::MAX)?;
                for step in &mut steps {
                    step?;
                }
                anyhow::Ok(steps.progress())
            });
            let progress = progress?;
            ensure!(progress.settled(), "{way:?} ends unsettled");
            *drawn = progress.drawn;
            if repetition > 0 {
                spans.push(span);
            }
        }
    }
    Ok(ways.into_iter().map(|(way, _, drawn, spans)| (way, drawn, spans)).collect())
}
