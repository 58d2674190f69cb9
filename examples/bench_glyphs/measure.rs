//! One scene in all representations: who takes part, and what is measured of them.

use crate::{
    Options,
    candidates::{self, Devices},
    clock::{Span, time},
    easel::{NOTHING, Sight, differing},
    scene::Scene,
    table::in_turn,
    way::{Footprint, Way},
};
use anyhow::{Context, Result, ensure};

/// What was measured of a representation, or why it could not be.
#[derive(Debug)]
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) outcome: Result<Measured, String>,
}

#[derive(Debug)]
pub(crate) struct Measured {
    pub(crate) first: First,
    pub(crate) frames: Vec<Span>,
    /// Without pixels; none if the representation cannot do that.
    pub(crate) away: Vec<Span>,
}

/// What the first frame tells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct First {
    pub(crate) footprint: Footprint,
    /// Vertices that are made in a frame.
    pub(crate) vertices: Option<u64>,
    /// Pixels that do not show what the first representation shows.
    pub(crate) differing: usize,
    /// Pixels that show something.
    pub(crate) covered: usize,
    has_away: bool,
}

struct Subject<'a> {
    name: &'static str,
    way: Box<dyn Way + 'a>,
    first: First,
}

/// Measures all representations in turn.
pub(crate) fn measure(devices: &Devices, scene: &Scene, options: &Options) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let mut subjects = Vec::new();
    let mut reference = None;
    let all = candidates::all(devices, scene).into_iter();
    for (name, way) in all.filter(|(name, _)| options.wants(name)) {
        match way {
            Ok(mut way) => {
                let first = look(&mut *way, &mut reference).context(name)?;
                subjects.push((Subject { name, way, first }, vec![]));
            }
            Err(error) => rows.push(Row { name, outcome: Err(format!("{error:#}")) }),
        }
    }
    ensure!(!(rows.is_empty() && subjects.is_empty()), "no representation has such a name");
    in_turn(options, &mut subjects, |subject| subject.draw(Sight::Here))?;
    let can = |(subject, _): &&mut (Subject<'_>, Vec<Span>)| subject.first.has_away;
    let away = subjects.iter_mut().filter(can);
    let mut away: Vec<_> = away.map(|(subject, _)| (subject, vec![])).collect();
    in_turn(options, &mut away, |subject| subject.draw(Sight::Away))?;
    let mut away: Vec<_> = away.into_iter().map(|(one, spans)| (one.name, spans)).collect();
    for (Subject { name, first, .. }, frames) in subjects {
        let away = away.iter_mut().find(|(other, _)| *other == name);
        let away = away.map(|(_, spans)| std::mem::take(spans)).unwrap_or_default();
        rows.push(Row { name, outcome: Ok(Measured { first, frames, away }) });
    }
    Ok(rows)
}

/// Draws a first frame, and compares it.
fn look(way: &mut dyn Way, reference: &mut Option<Vec<u32>>) -> Result<First> {
    let has_away = way.draw(Sight::Away)?;
    let has_pixels = has_away && way.words()?.iter().any(|word| *word != NOTHING);
    ensure!(!has_pixels, "pixels are drawn where there should be none");
    way.draw(Sight::Here)?;
    way.check()?;
    let words = way.words()?;
    let covered = words.iter().filter(|word| **word != NOTHING).count();
    let differing = reference.as_ref().map_or(0, |reference| differing(reference, &words));
    reference.get_or_insert(words);
    Ok(First {
        footprint: way.footprint(),
        vertices: way.vertices()?,
        differing,
        covered,
        has_away,
    })
}

impl Subject<'_> {
    fn draw(&mut self, sight: Sight) -> Result<Span> {
        let (drawn, span) = time(|| self.way.draw(sight));
        drawn.map(|_| span).context(self.name)
    }
}
