//! How images of one view differ, summed up over many.

use puncta::{Image, Picture};

/// The share of the pixels that may differ by more than one step in a channel.
const SHARE_MAX: f64 = 1e-5;

/// By how many steps each pixel differs, in the channel that differs most.
pub(crate) fn steps(a: &Image, b: &Image) -> Vec<u8> {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let step = |(a, b): (&[u8; 4], &[u8; 4])| {
        a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    };
    a.pixels.iter().zip(&b.pixels).map(step).collect()
}

/// For each pixel of an image, whether all of it shows the same records in two pictures.
fn same_records(a: &Picture, b: &Picture, image: &Image) -> Vec<bool> {
    let (width, factor) = (image.width as usize, (a.width / image.width) as usize);
    let is_same = |pixel: usize| {
        let first = pixel / width * factor * a.width as usize + pixel % width * factor;
        (0..factor * factor).all(|sample| {
            let place = first + sample / factor * a.width as usize + sample % factor;
            a.id[place] == b.id[place]
        })
    };
    (0..image.pixels.len()).map(is_same).collect()
}

/// The sum over many images, so that a share of 1e-5 is something.
#[derive(Default)]
pub(crate) struct Tally {
    pixels: usize,
    covered: usize,
    /// Pixels that differ at all, and by more than a step.
    differing: usize,
    beyond: usize,
    /// Pixels that show other records: where two are equally near, or a ray touches.
    other: usize,
}

impl Tally {
    pub(crate) fn add(&mut self, name: &str, cpu: (&Image, &Picture), gpu: (&Image, &Picture)) {
        let same = same_records(cpu.1, gpu.1, cpu.0);
        let of_same = || steps(cpu.0, gpu.0).into_iter().zip(&same).filter(|(_, same)| **same);
        let differing = of_same().filter(|(step, _)| *step > 0).count();
        let beyond = of_same().filter(|(step, _)| *step > 1).count();
        let other = same.iter().filter(|same| !**same).count();
        println!(
            "{name:<50} beyond a step {beyond:>3}, differing {differing:>5}, other {other:>3}"
        );
        self.pixels += same.len();
        self.covered += cpu.1.covered_pixels() * same.len() / cpu.1.id.len();
        self.differing += differing;
        self.beyond += beyond;
        self.other += other;
    }

    pub(crate) fn check(&self) {
        let Self { pixels, covered, differing, beyond, other } = *self;
        println!("of {pixels} pixels {beyond} beyond a step, {differing} differing, {other} other");
        assert!(covered * 10 > pixels, "there must be something to shade");
        assert!(beyond as f64 <= SHARE_MAX * pixels as f64, "{beyond} of {pixels} pixels differ");
        assert!(other * 2000 < pixels, "{other} of {pixels} pixels show other records");
    }
}
