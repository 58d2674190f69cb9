//! The depths of glyphs in a picture whose ids are right, in `f64`.

use puncta_avc::Surface;

/// How far a silhouette may be off, in pixels: where `f64` sees nothing, the depth is that of a ray so
/// far away.
const HAIR: f64 = 1e-3;

/// The view depths of a surface at some pixels, which are ascending, of a picture; where rays miss it, of a
/// ray a hair away.
///
/// Facet by facet: a glyph may have a hundred thousand, of which each covers few of the pixels.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "all are inside")]
pub(crate) fn depths(surface: &Surface, pixels: &[usize], size: [u32; 2]) -> Vec<Option<f64>> {
    let width = size[0] as usize;
    let mut depths = vec![None; pixels.len()];
    let (Some(first), Some(last)) = (pixels.first(), pixels.last()) else { return depths };
    let around = [first / width, last / width].map(|row| row as i64);
    for facet in surface.facets() {
        let spans = facet.spans(size);
        let rows = spans.rows();
        for row in rows[0].max(around[0])..=rows[1].min(around[1]) {
            let [from, to] = spans.of(row as f64);
            if from > to {
                continue;
            }
            let of_row = facet.depth_of_row(row as f64);
            let start = row as usize * width;
            let place = pixels.partition_point(|&pixel| pixel < start + from as usize);
            let covered = pixels[place..].iter().zip(&mut depths[place..]);
            for (pixel, depth) in covered.take_while(|(pixel, _)| **pixel <= start + to as usize) {
                let new = of_row.at((pixel - start) as f64);
                *depth = Some(depth.map_or(new, |old: f64| old.min(new)));
            }
        }
    }
    for (&pixel, depth) in pixels.iter().zip(&mut depths) {
        if depth.is_none() {
            let (column, row) = ((pixel % width) as f64, (pixel / width) as f64);
            *depth = surface.depth_around(column, row, HAIR);
        }
    }
    depths
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;
    use puncta_avc::{Arc, Cuboid, Disc, Glyph, Glyphs, Lens, Level};
    use puncta_core::{Camera, View};

    fn agree<G: Glyph<Style = [u32; 0]>>(record: G, eye: DVec3) -> Result<(), TestCaseError> {
        let view = View::look_at(eye, DVec3::ZERO, DVec3::Z).unwrap().with_size(33, 21).unwrap();
        let camera = Camera::new(&view, DVec3::ZERO);
        let glyphs = Glyphs::<G>::new([]);
        let (lens, records) = (Lens::new(&camera, 0.1), [record]);
        let mut surface = Surface::default();
        surface.fill(&lens, &glyphs.cloud(&records), 0, Level::Record);
        // Those of other records are not asked for.
        let pixels: Vec<usize> = (0..33 * 21).filter(|pixel| pixel % 7 != 3).collect();
        let found = depths(&surface, &pixels, [33, 21]);
        for (pixel, found) in pixels.into_iter().zip(found) {
            let (column, row) = ((pixel % 33) as f64, (pixel / 33) as f64);
            prop_assert_eq!(found, surface.depth_around(column, row, HAIR), "{}", pixel);
        }
        Ok(())
    }

    proptest! {
        /// Facet by facet and pixel by pixel, depths are the same.
        #[test]
        fn depths_are_those_of_each_pixel(
            eye in [1.0..3.0, -3.0..3.0, -3.0..3.0_f64],
            sides in [0.1_f32..2.0, 0.1_f32..2.0, 0.01_f32..1.0],
        ) {
            let (eye, [a, b, height]) = (DVec3::from(eye), sides);
            agree(Cuboid::new([0.1, 0.2, 0.0], sides), eye)?;
            agree(Disc::new([0.0; 3], [a, b, height], a), eye)?;
            let arc = Arc { center: [0.0; 3], radii: [a * 0.3, a], turns: [0.1, b], height };
            agree(arc, eye)?;
        }
    }
}
