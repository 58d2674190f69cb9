/*!
Which columns there are, and their values as bytes.

Everywhere here columns come in the same order: records, ids, colors, elements, scalars. A *block*
is a scene that has a place for some rows of each of them; buffers are blocks.
*/

use bytemuck::{cast_slice, cast_slice_mut};
use puncta_core::{Column, Scalar, Scene, Sphere};

/// Which columns there are besides records and ids.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) colors: bool,
    pub(crate) elements: bool,
    /// The names of the scalars.
    pub(crate) scalars: Vec<String>,
}

impl Shape {
    /// The columns of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let attributes = &scene.attributes;
        Self {
            colors: attributes.colors.is_some(),
            elements: attributes.elements.is_some(),
            scalars: attributes.scalars.iter().map(|scalar| scalar.name.clone()).collect(),
        }
    }

    /// How many bytes a value of each column has.
    pub(crate) fn widths(&self) -> Vec<usize> {
        let mut widths = vec![size_of::<Sphere>(), size_of::<u32>()];
        widths.extend(self.colors.then_some(size_of::<[u8; 4]>()));
        widths.extend(self.elements.then_some(size_of::<u8>()));
        widths.extend(self.scalars.iter().map(|_| size_of::<f32>()));
        widths
    }

    /// How many bytes a row has.
    pub(crate) fn row_bytes(&self) -> usize {
        self.widths().iter().sum()
    }

    /// A buffer for this many rows.
    pub(crate) fn block(&self, rows: usize) -> Scene {
        let mut block = Scene::new(vec![Sphere::default(); rows]);
        let attributes = &mut block.attributes;
        attributes.ids = Some(vec![0; rows].into());
        attributes.colors = self.colors.then(|| vec![[0; 4]; rows].into());
        attributes.elements = self.elements.then(|| vec![0; rows].into());
        let scalar = |name: &String| Scalar { name: name.clone(), values: vec![0.0; rows].into() };
        attributes.scalars = self.scalars.iter().map(scalar).collect();
        block
    }
}

/// The columns of a block as bytes.
pub(crate) fn bytes(block: &Scene) -> Vec<&[u8]> {
    let attributes = &block.attributes;
    let mut all = vec![cast_slice(block.records.as_slice())];
    all.extend(attributes.ids.as_ref().map(|ids| cast_slice(ids.as_slice())));
    all.extend(attributes.colors.as_ref().map(|colors| cast_slice(colors.as_slice())));
    all.extend(attributes.elements.as_ref().map(Column::as_slice));
    all.extend(attributes.scalars.iter().map(|scalar| cast_slice(scalar.values.as_slice())));
    all
}

/// The columns of a block as bytes that can be changed.
pub(crate) fn bytes_mut(block: &mut Scene) -> Vec<&mut [u8]> {
    let attributes = &mut block.attributes;
    let mut all = vec![cast_slice_mut(block.records.to_mut().as_mut_slice())];
    all.extend(attributes.ids.as_mut().map(|ids| cast_slice_mut(ids.to_mut().as_mut_slice())));
    all.extend(attributes.colors.as_mut().map(|c| cast_slice_mut(c.to_mut().as_mut_slice())));
    all.extend(attributes.elements.as_mut().map(|elements| elements.to_mut().as_mut_slice()));
    let scalars = attributes.scalars.iter_mut();
    all.extend(scalars.map(|scalar| cast_slice_mut(scalar.values.to_mut().as_mut_slice())));
    all
}

/// Keeps the rows of a block for which `keep` holds.
pub(crate) fn retain(block: &mut Scene, keep: &[bool]) {
    fn column<T: Clone>(column: &mut Column<T>, keep: &[bool]) {
        let mut keep = keep.iter();
        column.to_mut().retain(|_| keep.next().is_none_or(|&keep| keep));
    }
    column(&mut block.records, keep);
    let attributes = &mut block.attributes;
    attributes.ids.iter_mut().for_each(|ids| column(ids, keep));
    attributes.colors.iter_mut().for_each(|colors| column(colors, keep));
    attributes.elements.iter_mut().for_each(|elements| column(elements, keep));
    attributes.scalars.iter_mut().for_each(|scalar| column(&mut scalar.values, keep));
}

/// Copies values of `width` bytes to their places.
pub(crate) fn scatter(from: &[u8], to: &mut [u8], width: usize, places: &[u32]) {
    fn of<const N: usize>(from: &[u8], to: &mut [u8], places: &[u32]) {
        let (from, to) = (from.as_chunks::<N>().0, to.as_chunks_mut::<N>().0);
        for (value, &place) in from.iter().zip(places) {
            to[place as usize] = *value;
        }
    }
    match width {
        1 => of::<1>(from, to, places),
        4 => of::<4>(from, to, places),
        _ => of::<{ size_of::<Sphere>() }>(from, to, places),
    }
}
