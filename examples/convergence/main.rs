//! Measures how fast a picture that is drawn bit by bit comes to look like the finished one, for
//! each order in which bricks can be drawn.
//!
//! ```text
//! cargo run --release --example convergence -- hall:n=2e7 --json out.json --plot out.svg
//! cargo run --release --example convergence -- --help
//! ```
//!
//! After each step the picture so far is shaded and compared with the final one, as in section 5.2 of
//! the thesis that puncta is built on: the root of the mean square of the differences over red, green
//! and blue. Each order starts from nothing, and all must end with the same picture. A level counts
//! as reached once the error stays below it. Nothing is interpolated: steps are small, and pictures
//! are compared whenever a little more has been drawn.

mod cli;
#[expect(dead_code, reason = "the tools that measure use more of it")]
mod clock;
mod compare;
mod counting;
mod curve;
mod hindsight;
mod order;
mod plot;
mod report;
mod turn;
mod world;

#[path = "../render/input.rs"]
#[expect(dead_code, reason = "the tool `render` uses more of it")]
mod input;
#[path = "../render/options.rs"]
mod options;
#[path = "../render/progress.rs"]
mod progress;
#[path = "../render/view.rs"]
mod view;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use cli::Cli;
use compare::Target;
use counting::Hidden;
use curve::Plan;
use puncta::{Image, io::png};
use report::Chapter;
use std::{fs, io::Write, path::Path};
use turn::Motion;
use world::{Place, World};

fn main() {
    if let Err(error) = run(&Cli::parse()) {
        // Nobody may be listening any more.
        writeln!(std::io::stderr(), "error: {error:#}").ok();
        std::process::exit(1);
    }
}

fn run(cli: &Cli) -> Result<()> {
    ensure!(cli.every >= 0.0, "--every must not be negative");
    ensure!(cli.turn.iter().all(|degrees| degrees.is_finite()), "--turn must be finite");
    if let Some(folder) = &cli.pictures {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let world = World::read(&cli.origin)?;
    let mut out = std::io::stdout();
    let mut chapters = Vec::new();
    for &place in &cli.views {
        let chapter = measure(cli, &world, place)?;
        // Nobody may be listening any more; the files are written all the same.
        writeln!(out, "{}", report::table(&chapter)).ok();
        if !chapter.turns.is_empty() {
            writeln!(out, "{}", report::turns(&chapter)).ok();
        }
        chapters.push(chapter);
    }
    if let Some(path) = &cli.json {
        let json = report::json(&world, &chapters, hidden(cli));
        let text = serde_json::to_string_pretty(&json)? + "\n";
        fs::write(path, text).with_context(|| path.display().to_string())?;
    }
    match &cli.plot {
        Some(path) => plot::write(&chapters, path),
        None => Ok(()),
    }
}

/// What becomes of what is hidden.
fn hidden(cli: &Cli) -> Hidden {
    if cli.no_skip { Hidden::Drawn } else { Hidden::Skipped }
}

/// Measures all orders for one view.
fn measure(cli: &Cli, world: &World, place: Place) -> Result<Chapter> {
    let name = cli::name(place);
    let view = world.look(place)?;
    let picture = world.draw(&view)?;
    let target = Target::new(world, &view, &picture)?;
    save(cli.pictures.as_deref(), &name, &target.image)?;
    let plan = Plan { budget: cli.budget, every: cli.every, hidden: hidden(cli) };
    let mut curves = Vec::new();
    for &order in &cli.orders {
        let curve = curve::measure(world, &target, order, &plan)?;
        if let Some(image) = &curve.first_impression {
            save(cli.pictures.as_deref(), &format!("{name}-{}", cli::name(order)), image)?;
        }
        curves.push(curve);
    }
    let mut turns = Vec::new();
    for &degrees in &cli.turn {
        for motion in Motion::ALL {
            turns.push(turn::measure(world, &target, motion, degrees)?);
        }
    }
    Ok(Chapter { name, view, curves, turns })
}

fn save(folder: Option<&Path>, name: &str, image: &Image) -> Result<()> {
    match folder {
        Some(folder) => Ok(png::write(folder.join(format!("{name}.png")), image)?),
        None => Ok(()),
    }
}
