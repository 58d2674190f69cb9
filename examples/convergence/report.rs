//! What was measured, as tables and as JSON.

use crate::{
    cli,
    counting::Hidden,
    curve::{Curve, LEVELS, Point},
    order::Order,
    turn::Turned,
    world::World,
};
use puncta::{Amount, View};
use serde_json::{Value, json};
use std::fmt::Write;

/// All that was measured for one view.
#[derive(Debug)]
pub(crate) struct Chapter {
    pub(crate) name: String,
    pub(crate) view: View,
    pub(crate) curves: Vec<Curve>,
    pub(crate) turns: Vec<Turned>,
}

/// A share of the first error, or the end.
#[derive(Clone, Copy, Debug)]
enum Mark {
    Share(f64),
    Settled,
}

impl Mark {
    fn all() -> impl Iterator<Item = Self> {
        LEVELS.into_iter().map(Self::Share).chain([Self::Settled])
    }

    fn name(self) -> String {
        match self {
            Self::Share(share) => format!("{} %", share * 100.0),
            Self::Settled => "settled".to_owned(),
        }
    }

    fn of(self, curve: &Curve) -> Option<&Point> {
        match self {
            Self::Share(share) => curve.reached(share),
            Self::Settled => curve.settled(),
        }
    }
}

/// A table in Markdown: for each order and mark the records that were drawn, in brackets as a
/// multiple of those of the order by depth, and the seconds.
pub(crate) fn table(chapter: &Chapter) -> String {
    let Amount { bricks, records } =
        chapter.curves.first().map_or_else(Amount::default, |curve| curve.in_view);
    let mut table = format!("{}: {records} records in {bricks} bricks in view", chapter.name);
    if let Some(curve) = chapter.curves.first() {
        write!(table, ", first error {:.4}", curve.first_error()).ok();
    }
    table += "\n\n| order |";
    Mark::all().for_each(|mark| table += &format!(" {} | s |", mark.name()));
    table += "\n|---|";
    Mark::all().for_each(|_| table += "---|---|");
    let by_depth = chapter.curves.iter().find(|curve| curve.order == Order::Depth);
    for curve in &chapter.curves {
        write!(table, "\n| {} |", cli::name(curve.order)).ok();
        for mark in Mark::all() {
            let Some(point) = mark.of(curve) else {
                table += " | |";
                continue;
            };
            let records = point.progress.drawn.records;
            write!(table, " {records}").ok();
            if let Some(depth) = by_depth.and_then(|depth| mark.of(depth)) {
                write!(table, " ({:.2})", ratio(records, depth.progress.drawn.records)).ok();
            }
            write!(table, " | {:.3} |", point.time.wall).ok();
        }
    }
    table + "\n"
}

fn ratio(a: u64, b: u64) -> f64 {
    if a == b { 1.0 } else { a as f64 / b as f64 }
}

/// A table in Markdown of what is seen right after the camera moved.
pub(crate) fn turns(chapter: &Chapter) -> String {
    let mut table = format!("{}, after the camera moved\n\n", chapter.name);
    table += "| motion | degrees | recalled | right | same record | of covered | empty | open | \
              first ms | whole ms |\n|---|---|---|---|---|---|---|---|---|---|";
    for turned in &chapter.turns {
        let found = &turned.agreement;
        let share = |count: u64, of: u64| format!("{:.2} %", 100.0 * count as f64 / of as f64);
        let row = [
            turned.motion.name().to_owned(),
            turned.degrees.to_string(),
            turned.recalled.to_string(),
            share(found.same, found.pixels),
            share(found.same_record, found.pixels),
            share(found.covered_same_record, found.covered),
            share(found.pixels - found.covered, found.pixels),
            share(turned.open, found.pixels),
            format!("{:.1}", turned.first.wall * 1e3),
            format!("{:.1}", turned.whole.wall * 1e3),
        ];
        write!(table, "\n| {} |", row.join(" | ")).ok();
    }
    table + "\n"
}

/// Everything.
pub(crate) fn json(world: &World, chapters: &[Chapter], hidden: Hidden) -> Value {
    json!({
        "input": world.name(),
        "records": world.scene().records.len(),
        "grid": { "dims": world.grid.dims(), "bricks": puncta::Bricks::bricks(&world.grid).len() },
        "skips_hidden": hidden == Hidden::Skipped,
        "threads": rayon::current_num_threads(),
        "views": chapters.iter().map(view).collect::<Vec<_>>(),
    })
}

fn view(chapter: &Chapter) -> Value {
    let view = &chapter.view;
    json!({
        "name": chapter.name,
        "size": [view.width(), view.height()],
        "eye": view.eye().to_array(),
        "forward": view.forward().to_array(),
        "up": view.up().to_array(),
        "orders": chapter.curves.iter().map(curve).collect::<Vec<_>>(),
        "motions": chapter.turns.iter().map(motion).collect::<Vec<_>>(),
    })
}

fn curve(curve: &Curve) -> Value {
    let reached = Mark::all().map(|mark| (mark.name(), mark.of(curve).map_or(Value::Null, point)));
    json!({
        "order": cli::name(curve.order),
        "in_view": amount(curve.in_view),
        "steps": curve.steps,
        "reached": reached.collect::<serde_json::Map<_, _>>(),
        "points": curve.points.iter().map(point).collect::<Vec<_>>(),
    })
}

fn point(point: &Point) -> Value {
    json!({
        "error": point.error,
        "wrong": point.wrong,
        "open": point.progress.open,
        "drawn": amount(point.progress.drawn),
        "skipped": amount(point.progress.skipped),
        "left": amount(point.progress.left),
        "seconds": point.time.wall,
        "processor_seconds": point.time.processors,
    })
}

fn motion(turned: &Turned) -> Value {
    let found = &turned.agreement;
    json!({
        "motion": turned.motion.name(),
        "degrees": turned.degrees,
        "recalled": turned.recalled,
        "open": turned.open,
        "pixels": found.pixels,
        "covered": found.covered,
        "same": found.same,
        "same_record": found.same_record,
        "covered_same_record": found.covered_same_record,
        "first_seconds": turned.first.wall,
        "whole_seconds": turned.whole.wall,
    })
}

fn amount(amount: Amount) -> Value {
    json!({ "bricks": amount.bricks, "records": amount.records })
}
