//! The final picture of a view, and how far others are from it.
//!
//! Shading costs more than a small step. So only those pixels are shaded again whose record changed.

use crate::world::World;
use anyhow::Result;
use puncta::{Background, Image, NO_RECORD, Picture, View};

/// What a picture is to look like in the end.
#[derive(Debug)]
pub(crate) struct Target<'a> {
    world: &'a World,
    pub(crate) view: &'a View,
    pub(crate) picture: &'a Picture,
    pub(crate) image: Image,
}

impl<'a> Target<'a> {
    pub(crate) fn new(world: &'a World, view: &'a View, picture: &'a Picture) -> Result<Self> {
        Ok(Self { world, view, picture, image: world.shade(view, picture)? })
    }
}

/// A picture in the making, and its image.
#[derive(Debug)]
pub(crate) struct Sketch<'a> {
    target: &'a Target<'a>,
    ids: Vec<u32>,
    pub(crate) image: Image,
}

impl<'a> Sketch<'a> {
    /// A picture of nothing.
    pub(crate) fn new(target: &'a Target<'a>) -> Result<Self> {
        let nothing = Picture::new(target.view.width(), target.view.height())?;
        let image = target.world.shade(target.view, &nothing)?;
        Ok(Self { target, ids: nothing.id, image })
    }

    /// Makes this a later picture.
    pub(crate) fn update(&mut self, picture: &Picture) -> Result<()> {
        let Target { world, view, .. } = self.target;
        let mut changed = picture.clone();
        for (id, old) in changed.id.iter_mut().zip(&self.ids) {
            if id == old {
                *id = NO_RECORD;
            }
        }
        // Nothing of the background is taken, and black is the quickest.
        let shaded = world.shade_before(view, &changed, Background::Solid([0; 3]))?;
        let pixels = self.image.pixels.iter_mut().zip(&shaded.pixels).zip(&changed.id);
        for ((pixel, new), _) in pixels.filter(|(_, id)| **id != NO_RECORD) {
            *pixel = *new;
        }
        self.ids.clone_from(&picture.id);
        Ok(())
    }

    /// The root of the mean square of the differences from the final image over red, green and blue,
    /// which are from 0 to 1.
    pub(crate) fn error(&self) -> f64 {
        let square = |(a, b): (&u8, &u8)| u64::from(a.abs_diff(*b)).pow(2);
        let (ours, last) = (&self.image.pixels, &self.target.image.pixels);
        let pixel =
            |(a, b): (&[u8; 4], &[u8; 4])| a[..3].iter().zip(&b[..3]).map(square).sum::<u64>();
        let sum: u64 = ours.iter().zip(last).map(pixel).sum();
        (sum as f64 / (3 * ours.len()) as f64).sqrt() / 255.0
    }

    /// The number of pixels that show another record than in the end.
    pub(crate) fn wrong(&self) -> u64 {
        let pixels = self.ids.iter().zip(&self.target.picture.id);
        pixels.filter(|(id, last)| id != last).count() as u64
    }
}
