//! Tables in Markdown, and times in their cells.

use crate::{
    Options,
    clock::{Span, median},
};
use anyhow::Result;
use serde_json::{Value, json};
use std::fmt;

/// A table with a title.
#[derive(Debug)]
pub(crate) struct Table {
    title: String,
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(title: &str, head: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let head = head.into_iter().map(Into::into).collect();
        Self { title: title.to_owned(), head, rows: vec![] }
    }

    pub(crate) fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
        let rule = vec!["---"; self.head.len()].join("|");
        writeln!(f, "**{}**\n\n{}\n|{rule}|", self.title, line(&self.head))?;
        self.rows.iter().try_for_each(|row| writeln!(f, "{}", line(row)))
    }
}

/// The median of milliseconds at the wall, and in brackets that of all processors together.
pub(crate) fn cell(spans: &[Span]) -> String {
    median(spans).map_or_else(String::new, |span| {
        format!("{} ({})", number(span.wall * 1e3), number(span.processors * 1e3))
    })
}

/// The median at the wall in milliseconds.
pub(crate) fn wall(spans: &[Span]) -> Option<f64> {
    median(spans).map(|span| span.wall * 1e3)
}

/// The least at the wall in milliseconds.
pub(crate) fn best(spans: &[Span]) -> String {
    let best = spans.iter().map(|span| span.wall * 1e3).fold(f64::INFINITY, f64::min);
    number(best)
}

/// A number with three digits or a few more.
pub(crate) fn number(value: f64) -> String {
    match value {
        value if value >= 99.5 => format!("{value:.0}"),
        value if value >= 9.95 => format!("{value:.1}"),
        value => format!("{value:.2}"),
    }
}

/// All times in seconds.
pub(crate) fn times(spans: &[Span]) -> Value {
    let of = |pick: fn(&Span) -> f64| spans.iter().map(pick).collect::<Vec<_>>();
    json!({
        "seconds": of(|span| span.wall),
        "processor_seconds": of(|span| span.processors),
        "median_seconds": median(spans).map(|span| span.wall),
    })
}

/// Who takes part, and the times.
pub(crate) type Timed<T> = Vec<(T, Vec<Span>)>;

/// Measures all in turn, as often as is asked for; what takes long is measured less often.
pub(crate) fn in_turn<T>(
    options: &Options,
    contenders: &mut Timed<T>,
    mut measure: impl FnMut(&mut T) -> Result<Span>,
) -> Result<()> {
    for _ in 0..options.runs {
        for (contender, spans) in &mut *contenders {
            let spent: f64 = spans.iter().map(|span| span.wall).sum();
            if spans.is_empty() || spent < options.seconds {
                spans.push(measure(contender)?);
            }
        }
    }
    Ok(())
}
