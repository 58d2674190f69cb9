//! How fast it goes: the last pictures, and the graph of them.

use crate::{drawing::Frame, theme};
use egui::{Align2, FontId, Pos2, Sense, Stroke, Ui, vec2};
use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

/// How many pictures are kept.
const KEPT: usize = 120;

/// The width of what stands beside the lines.
const LABELS: f32 = 36.0;

/// The lowest and the highest line of the graph, as powers of ten of a second.
const DECADES: [i32; 2] = [-3, 1];

/// How long a picture took.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Until there was something to see.
    answer: Duration,
    /// Until nothing could change any more.
    settled: Option<Duration>,
    begun: Instant,
}

/// The last pictures.
#[derive(Debug, Default)]
pub(crate) struct History {
    entries: VecDeque<Entry>,
    /// The number of pixels of the picture that is being drawn.
    pub(crate) pixels: u64,
    /// How long the window takes to make up what it paints.
    work: Duration,
}

impl History {
    /// Takes in a step of a picture.
    pub(crate) fn take(&mut self, frame: &Frame, pixels: u64) {
        self.pixels = pixels;
        if let Some(answer) = frame.latency {
            let begun = frame.at.checked_sub(answer).unwrap_or(frame.at);
            self.entries.push_back(Entry { answer, settled: None, begun });
            if self.entries.len() > KEPT {
                self.entries.pop_front();
            }
        }
        let is_settled = frame.progress.as_ref().is_ok_and(puncta::Progress::settled);
        if let (Some(entry), true) = (self.entries.back_mut(), is_settled) {
            entry.settled = Some(frame.at.saturating_duration_since(entry.begun));
        }
    }

    pub(crate) fn note_work(&mut self, took: Duration) {
        self.work = (self.work * 9 + took) / 10;
    }

    /// The graph, with a legend below.
    pub(crate) fn show(&self, ui: &mut Ui) {
        let size = vec2(ui.available_width(), 96.0);
        let (response, painter) = ui.allocate_painter(size, Sense::hover());
        let rect = response.rect;
        painter.rect_filled(rect, 4.0, theme::WELL);
        let inner = rect.shrink2(vec2(6.0, 8.0));
        let height = |seconds: f64| {
            let [low, high] = DECADES.map(f64::from);
            let share = ((seconds.max(1e-9).log10() - low) / (high - low)).clamp(0.0, 1.0);
            inner.bottom() - inner.height() * theme::rough(share)
        };
        for decade in DECADES[0]..=DECADES[1] {
            let y = height(10_f64.powi(decade));
            let line = inner.left() + LABELS..=inner.right();
            painter.hline(line, y, Stroke::new(1.0, theme::LINE));
            let text = ["1 ms", "10 ms", "100 ms", "1 s", "10 s"];
            let text = usize::try_from(decade - DECADES[0]).ok().and_then(|i| text.get(i));
            let at = Pos2::new(inner.left(), y);
            let font = FontId::proportional(9.0);
            painter.text(at, Align2::LEFT_CENTER, text.unwrap_or(&""), font, theme::FAINT);
        }
        let step = (inner.width() - LABELS) / KEPT as f32;
        for (place, entry) in self.entries.iter().rev().enumerate() {
            let x = inner.right() - (place as f32 + 0.5) * step;
            let answer = Pos2::new(x, height(entry.answer.as_secs_f64()));
            if let Some(settled) = entry.settled {
                let top = height(settled.as_secs_f64());
                let line = Stroke::new(1.0, theme::GOOD.gamma_multiply(0.35));
                painter.vline(x, top..=answer.y, line);
                painter.circle_filled(Pos2::new(x, top), 1.3, theme::GOOD);
            }
            painter.circle_filled(answer, 1.5, theme::ACCENT);
        }
        let last = self.entries.back();
        let settled = self.entries.iter().rev().find_map(|entry| entry.settled);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let mut tell = |name, color, time: Option<Duration>| {
                let text = format!("{name} {}", time.map_or("-".to_owned(), self::time));
                ui.label(egui::RichText::new(text).small().color(color));
            };
            tell("answer", theme::ACCENT, last.map(|entry| entry.answer));
            tell("settled", theme::GOOD, settled);
            tell("window", theme::FAINT, Some(self.work));
        });
    }
}

/// A time as people like to read it.
pub(crate) fn time(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        _ if seconds < 0.00995 => format!("{:.1} ms", seconds * 1e3),
        _ if seconds < 0.9995 => format!("{:.0} ms", seconds * 1e3),
        _ => format!("{seconds:.1} s"),
    }
}
