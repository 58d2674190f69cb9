//! What was measured, as text, as tables and as JSON.

use crate::{
    case::Case,
    clock::{Span, median},
    order::Order,
    part::Part,
    thesis::{self, Line},
};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The time of the processors for one thread.
fn share(span: Span) -> f64 {
    span.processors / rayon::current_num_threads() as f64
}

/// The median of a part. The plain graph knows one thread only, and so is all of its time.
fn time_of(case: &Case, part: Part) -> Option<[f64; 2]> {
    let span = case.median(part)?;
    Some([span.wall, if part == Part::Naive { span.processors } else { share(span) }])
}

impl Case {
    /// What the thesis calls the sum: culling, graph and order, here that of density.
    fn sum(&self) -> Option<Span> {
        let mut sum = self.median(Part::Cull)?;
        sum += self.median(Part::Order(Order::Density))?;
        Some(sum)
    }

    fn title(&self) -> String {
        let [x, y, z] = self.dims;
        format!("{} in {x}x{y}x{z}", self.name)
    }
}

/// A few lines for people.
pub(crate) fn text(case: &Case) -> String {
    let mut text = format!(
        "{}: {} bricks, {} in view, edges as those of the plain graph: {:.3} %",
        case.title(),
        case.bricks,
        case.in_view.bricks,
        case.agreement * 100.0
    );
    for &(part, _) in &case.parts {
        if let Some([wall, share]) = time_of(case, part) {
            let (wall, share) = (wall * 1e3, share * 1e3);
            write!(text, "\n  {:18} {wall:9.3} ms {share:9.3} ms", part.name()).ok();
        }
    }
    if let (Some(Line { scene, bricks, graph, sum, .. }), Some(ours)) = (case.thesis, case.sum()) {
        let factor = f64::from(sum) / (ours.wall * 1e3);
        write!(
            text,
            "\n  thesis, {scene}: {bricks} bricks, graph {graph} ms, sum {sum} ms; {factor:.0} times \
             that of culling and density here"
        )
        .ok();
    }
    for (way, drawn, spans) in &case.frames {
        if let Some(span) = median(spans) {
            let (wall, share) = (span.wall * 1e3, share(span) * 1e3);
            let part = 100.0 * drawn.records as f64 / case.in_view.records as f64;
            write!(
                text,
                "\n  frame {:14} {wall:7.1} ms {share:9.1} ms, {part:5.1} % of the records drawn",
                way.name()
            )
            .ok();
        }
    }
    text
}

/// Tables in Markdown: milliseconds at the wall, and in brackets those of the processors for each
/// thread.
pub(crate) fn tables(cases: &[Case]) -> String {
    let parts = Part::all();
    let mut table = "| scene and grid | bricks | in view |".to_owned();
    parts.iter().for_each(|part| table += &format!(" {} |", part.name()));
    table += " cull + density | thesis: bricks, graph, sum |\n|---|---|---|";
    parts.iter().for_each(|_| table += "---|");
    table += "---|---|";
    for case in cases {
        write!(table, "\n| {} | {} | {} |", case.title(), case.bricks, case.in_view.bricks).ok();
        for &part in &parts {
            table += &time_of(case, part).map_or_else(|| " |".to_owned(), cell);
        }
        let sum = case.sum().map(|span| [span.wall, share(span)]);
        table += &sum.map_or_else(|| " |".to_owned(), cell);
        table += &case.thesis.map_or_else(
            || " |".to_owned(),
            |line| format!(" {}, {}, {} |", line.bricks, line.graph, line.sum),
        );
    }
    table + "\n\n" + &frames(cases)
}

/// The table of whole frames.
fn frames(cases: &[Case]) -> String {
    let mut table = "| scene and grid | order | records drawn | of those in view | whole frame |\n\
                     |---|---|---|---|---|\n"
        .to_owned();
    for case in cases {
        for (way, drawn, spans) in &case.frames {
            let part = 100.0 * drawn.records as f64 / case.in_view.records as f64;
            let time = median(spans).map(|span| [span.wall, share(span)]);
            let time = time.map_or_else(|| " |".to_owned(), cell);
            let (title, way) = (case.title(), way.name());
            writeln!(table, "| {title} | {way} | {} | {part:.1} % |{time}", drawn.records).ok();
        }
    }
    table
}

fn cell([wall, share]: [f64; 2]) -> String {
    format!(" {:.2} ({:.2}) |", wall * 1e3, share * 1e3)
}

/// All times.
pub(crate) fn json(cases: &[Case]) -> Value {
    json!({
        "threads": rayon::current_num_threads(),
        "cases": cases.iter().map(case).collect::<Vec<_>>(),
        "thesis": thesis::LINES.iter().map(line).collect::<Vec<_>>(),
    })
}

fn case(case: &Case) -> Value {
    let parts = case.parts.iter().map(|(part, spans)| (part.name(), times(spans)));
    let frames = case.frames.iter().map(|(way, drawn, spans)| {
        let mut value = times(spans);
        value["drawn"] = json!({ "bricks": drawn.bricks, "records": drawn.records });
        (way.name(), value)
    });
    json!({
        "name": case.name,
        "dims": case.dims,
        "bricks": case.bricks,
        "in_view": { "bricks": case.in_view.bricks, "records": case.in_view.records },
        "graph_agrees_with_plain_graph": case.agreement,
        "parts": parts.collect::<Map<_, _>>(),
        "frames": frames.collect::<Map<_, _>>(),
        "thesis": case.thesis.as_ref().map(line),
    })
}

fn times(spans: &[Span]) -> Value {
    let median = median(spans);
    json!({
        "seconds": spans.iter().map(|span| span.wall).collect::<Vec<_>>(),
        "processor_seconds": spans.iter().map(|span| span.processors).collect::<Vec<_>>(),
        "median_seconds": median.map(|span| span.wall),
        "median_processor_seconds_a_thread": median.map(share),
    })
}

fn line(line: &Line) -> Value {
    json!({
        "scene": line.scene, "cells": line.cells, "bricks": line.bricks,
        "graph_milliseconds": line.graph, "sum_milliseconds": line.sum,
    })
}
