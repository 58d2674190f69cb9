//! Counts, bytes and seconds.

use crate::{input::Input, options::Options};
use anyhow::{Context, Result};
use puncta::{Amount, Grid, Picture, View};
use serde_json::{Map, Value, json};
use std::{fmt, fs, time::Instant};

/// What was done and how long it took.
#[derive(Debug, Default)]
pub(crate) struct Statistics {
    /// The bricks and records that were drawn for the first picture.
    pub(crate) drawn: Amount,
    /// What draws.
    pub(crate) backend: String,
    seconds: Vec<(&'static str, f64)>,
    values: Map<String, Value>,
}

impl Statistics {
    /// Does something and notes how long it takes.
    pub(crate) fn time<T>(&mut self, step: &'static str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.seconds.push((step, start.elapsed().as_secs_f64()));
        result
    }

    /// Notes what is known once the first picture is drawn.
    pub(crate) fn describe(&mut self, input: &Input, grid: &Grid, view: &View, picture: &Picture) {
        let bounds = input.bounds;
        let values = json!({
            "input": input.name,
            "format": input.format,
            "particles": input.scene.records.len(),
            "skipped": input.skipped,
            "notices": input.notices,
            "bounds": { "min": bounds.min.to_array(), "max": bounds.max.to_array() },
            "origin": input.scene.origin.to_array(),
            "grid": { "dims": grid.dims(), "bricks": grid.bricks().len() },
            "bricks_drawn": self.drawn.bricks,
            "particles_drawn": self.drawn.records,
            "visible_particles": picture.visible_records().len(),
            "covered_pixels": picture.covered_pixels(),
            "view": {
                "size": [view.width(), view.height()],
                "eye": view.eye().to_array(),
                "forward": view.forward().to_array(),
                "up": view.up().to_array(),
                "near": view.near(),
            },
            "backend": self.backend,
            "threads": rayon::current_num_threads(),
            "bytes": {
                "records": size_of_val(input.scene.records.as_slice()),
                "attributes": input.scene.attributes.bytes(),
                "grid": grid.bytes(),
                "picture": size_of_val(picture.depth.as_slice()) * 2,
            },
        });
        if let Value::Object(values) = values {
            self.values.extend(values);
        }
    }

    /// Writes the file that was asked for.
    pub(crate) fn finish(&mut self, options: &Options) -> Result<()> {
        let seconds: Map<String, Value> =
            self.seconds.iter().map(|&(step, seconds)| (step.to_owned(), json!(seconds))).collect();
        self.values.insert("seconds".to_owned(), Value::Object(seconds));
        self.values.insert("peak_memory_bytes".to_owned(), json!(peak_memory_bytes()));
        match &options.json {
            Some(path) => {
                let text = serde_json::to_string_pretty(&self.values)? + "\n";
                fs::write(path, text).with_context(|| path.display().to_string())
            }
            None => Ok(()),
        }
    }
}

impl fmt::Display for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = |name: &str| self.values.get(name).cloned().unwrap_or_default();
        write!(
            f,
            "{} particles, {} drawn, {} visible;",
            value("particles"),
            value("particles_drawn"),
            value("visible_particles")
        )?;
        for (step, seconds) in &self.seconds {
            write!(f, " {step} {seconds:.2} s,")?;
        }
        match peak_memory_bytes() {
            Some(bytes) => write!(f, " peak memory {:.0} MiB", bytes as f64 / (1 << 20) as f64),
            None => Ok(()),
        }
    }
}

/// The most memory that was resident at once; only Linux tells.
fn peak_memory_bytes() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
