//! What trajectories look like: tubes, lines or balls, and their colors.

use super::{
    glyphs::palette::{PALETTE, mix},
    path::Path,
};
use anyhow::{Result, ensure};
use clap::ValueEnum;
use puncta::{
    ColorMap,
    avc::{Node, NodeStyle},
    core::inner_range,
};

/// As what trajectories are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Draw {
    /// Tubes, thicker where they are fast
    Tubes,
    /// Lines of a width in pixels
    Lines,
    /// A ball at each point
    Spheres,
    /// Tubes in the front half, lines behind
    Auto,
}

/// What gives trajectories their color.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorBy {
    /// A color map
    Speed,
    /// Red along x, green along y, blue along z
    Direction,
    /// A color for each
    Id,
}

/// The color of the one that is selected.
const SELECTED: [u8; 3] = [255, 210, 48];

/// What others turn to, and how much.
const FADED: ([u8; 3], f64) = ([96, 102, 116], 0.82);

/// What to draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) draw: Draw,
    pub(crate) radius: f32,
    /// Of lines, in pixels.
    pub(crate) width: f32,
    pub(crate) selected: Option<u32>,
    /// Those that count as slowest and fastest.
    pub(crate) speeds: [f32; 2],
    /// The distance of the middle from the camera.
    pub(crate) halfway: f32,
}

/// Nearly the range of speeds.
#[expect(clippy::cast_possible_truncation, reason = "they were f32")]
pub(crate) fn speeds(nodes: &[Node]) -> [f32; 2] {
    inner_range(|| nodes.iter().map(|node| f64::from(node.speed())), 0.005)
        .map(|speed| speed as f32)
}

impl Look {
    pub(crate) fn style(&self) -> Result<NodeStyle> {
        let Self { radius, width, .. } = *self;
        ensure!(radius > 0.0 && radius < 1e30, "--radius {radius}: it must be positive");
        ensure!(width > 0.0 && width < 1e6, "--width {width}: it must be positive");
        let kind = match self.draw {
            Draw::Tubes => NodeStyle::TUBE,
            Draw::Lines | Draw::Auto => NodeStyle::LINE,
            Draw::Spheres => NodeStyle::BALL,
        };
        let near = if self.draw == Draw::Auto { self.halfway } else { 0.0 };
        Ok(NodeStyle {
            radii: [radius * 0.7, radius * 1.3],
            speeds: self.speeds,
            width,
            ball: radius * 1.6,
            kind,
            near,
            special: kind,
            // The last id is none.
            selected: self.selected.map_or(0, |id| id.saturating_add(1)),
            selection: if kind == NodeStyle::LINE { NodeStyle::TUBE } else { kind },
            ..NodeStyle::tubes(radius)
        })
    }

    /// The color of each node.
    pub(crate) fn colors(
        &self,
        paths: &[Path],
        nodes: &[Node],
        by: ColorBy,
        map: &ColorMap,
    ) -> Vec<[u8; 4]> {
        let [slow, fast] = self.speeds.map(f64::from);
        let color = |id: usize, index: usize, node: &Node| -> [u8; 3] {
            match by {
                ColorBy::Speed if fast > slow => {
                    let share = (f64::from(node.speed()) - slow) / (fast - slow);
                    map.color(0.06 + 0.94 * share.clamp(0.0, 1.0))
                }
                ColorBy::Speed => map.color(0.5),
                ColorBy::Direction => paths[id].direction(index).map_or([128; 3], |direction| {
                    direction.to_array().map(|x| {
                        #[expect(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "0 to 255"
                        )]
                        let byte = (40.0 + 215.0 * x.abs().min(1.0)) as u8;
                        byte
                    })
                }),
                ColorBy::Id => PALETTE[id % PALETTE.len()],
            }
        };
        let places = paths
            .iter()
            .enumerate()
            .flat_map(|(id, path)| (0..path.points.len()).map(move |index| (id, index)));
        let painted = places.zip(nodes).map(|((id, index), node)| {
            let own = color(id, index, node);
            let [r, g, b] = match self.selected {
                Some(selected) if selected as usize == id => SELECTED,
                Some(_) => mix(own, FADED.0, FADED.1),
                None => own,
            };
            [r, g, b, 255]
        });
        painted.collect()
    }
}
