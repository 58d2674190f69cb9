//! Pictures: what a ray through each pixel's centre meets first.

use crate::{Error, MAX_SIDE, Record, Scene};

/// The id of a pixel that shows no record.
pub const NO_RECORD: u32 = u32::MAX;

/// View depth and record for each pixel, rows from the top.
///
/// This is the exact result of rendering; colors are made from it afterwards, by shading.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// The distance along the forward axis of the view; +inf where nothing is seen.
    pub depth: Vec<f32>,
    /// The record that is seen, as an index into [`Scene::records`]; [`NO_RECORD`] for nothing.
    pub id: Vec<u32>,
}

impl Picture {
    /// A picture of nothing.
    ///
    /// # Errors
    ///
    /// [`Error::PictureSize`] when a side is zero or above [`MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, Error> {
        if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(Error::PictureSize { width, height });
        }
        let pixels = width as usize * height as usize;
        Ok(Self { width, height, depth: vec![f32::INFINITY; pixels], id: vec![NO_RECORD; pixels] })
    }

    /// The ids that the seen records had before any sorting ([`Scene::id`]), by pixel.
    ///
    /// While [`Picture::id`] says where a record lies now, these stay the same however the scene is
    /// sorted.
    ///
    /// # Panics
    ///
    /// When the picture is not one of this scene.
    #[must_use]
    pub fn original_ids<R: Record>(&self, scene: &Scene<R>) -> Vec<u32> {
        let original = |&id: &u32| if id == NO_RECORD { id } else { scene.id(id) };
        self.id.iter().map(original).collect()
    }

    /// How many pixels show a record.
    #[must_use]
    pub fn covered_pixels(&self) -> usize {
        self.id.iter().filter(|&&id| id != NO_RECORD).count()
    }

    /// The seen records, each once, in ascending order.
    #[must_use]
    pub fn visible_records(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = self.id.iter().copied().filter(|&id| id != NO_RECORD).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;

    #[test]
    fn sizes_without_pixels_or_with_too_many_are_refused() {
        assert!(Picture::new(0, 5).is_err());
        assert!(Picture::new(5, MAX_SIDE + 1).is_err());
    }

    #[test]
    fn original_ids_undo_a_sort() -> Result<(), Error> {
        let mut scene = Scene::new(vec![Sphere::default(); 2]);
        scene.keep_order();
        scene.swap(0, 1);
        let mut picture = Picture::new(2, 1)?;
        picture.id[1] = 0;
        assert_eq!(picture.original_ids(&scene), [NO_RECORD, 1]);
        assert_eq!(picture.visible_records(), [0]);
        assert_eq!(picture.covered_pixels(), 1);
        Ok(())
    }
}
