//! Scenes with all kinds of columns as sources, and what is known of them afterwards.

#![allow(dead_code, reason = "each test uses some of it")]

use glam::DVec3;
use puncta_core::{Scalar, Scene, Source, Sphere};
use puncta_grid::{ConvertConfig, ConvertError, Error, convert};
use std::{collections::BTreeMap, convert::Infallible, fs, path::Path};

/// A scene as a source, in chunks that vary.
pub(crate) struct Chunks {
    pub(crate) scene: Scene,
    pub(crate) next: usize,
}

impl Source for Chunks {
    type Record = Sphere;
    type Error = Infallible;

    fn remaining(&self) -> Option<u64> {
        None
    }

    fn append(&mut self, to: &mut Scene, limit: usize) -> Result<usize, Infallible> {
        let end = (self.next + limit).min(self.scene.records.len());
        let rows = self.next..end;
        to.origin = self.scene.origin;
        to.records.extend(self.scene.records[rows.clone()].iter().copied());
        let (to, from) = (&mut to.attributes, &self.scene.attributes);
        if let Some(ids) = &from.ids {
            to.ids.get_or_insert_default().extend(ids[rows.clone()].iter().copied());
        }
        if let Some(colors) = &from.colors {
            to.colors.get_or_insert_default().extend(colors[rows.clone()].iter().copied());
        }
        if let Some(elements) = &from.elements {
            to.elements.get_or_insert_default().extend(elements[rows.clone()].iter().copied());
        }
        for (index, scalar) in from.scalars.iter().enumerate() {
            if to.scalars.len() == index {
                to.scalars.push(Scalar { name: scalar.name.clone(), values: vec![].into() });
            }
            to.scalars[index].values.extend(scalar.values[rows.clone()].iter().copied());
        }
        self.next = end;
        Ok(rows.len())
    }
}

/// Which columns there are: bits of a number.
pub(crate) fn scene_of(records: Vec<Sphere>, columns: u8) -> Scene {
    let count = records.len();
    let mut scene = Scene::new(records);
    scene.origin = DVec3::new(1e7, -3.25, 0.1);
    let attributes = &mut scene.attributes;
    if columns & 1 != 0 {
        attributes.colors = Some((0..count).map(|i| (i as u32 * 77).to_le_bytes()).collect());
    }
    if columns & 2 != 0 {
        attributes.elements = Some((0..count).map(|i| (i % 251) as u8).collect());
    }
    for name in ["speed", "\u{3c1} of it"].iter().take(usize::from(columns >> 2 & 3)) {
        let values = (0..count).map(|i| if i % 5 == 3 { f32::NAN } else { i as f32 }).collect();
        attributes.scalars.push(Scalar { name: (*name).into(), values });
    }
    if columns & 16 != 0 {
        let id = |i: usize| 4_000_000_000 - (i as u32).wrapping_mul(2_654_435_769) % 3_999_999_999;
        attributes.ids = Some((0..count).map(id).collect());
    }
    scene
}

/// Everything about the rows of a range, by their ids: bits, so that NaN is what it is.
pub(crate) fn rows(scene: &Scene, range: std::ops::Range<u32>) -> BTreeMap<u32, Vec<u32>> {
    let a = &scene.attributes;
    range
        .map(|index| {
            let i = index as usize;
            let record = scene.records[i];
            let mut row: Vec<u32> = record.center.map(f32::to_bits).into();
            row.push(record.radius.to_bits());
            row.extend(a.colors.as_ref().map(|colors| u32::from_le_bytes(colors[i])));
            row.extend(a.elements.as_ref().map(|elements| u32::from(elements[i])));
            row.extend(a.scalars.iter().map(|scalar| scalar.values[i].to_bits()));
            (scene.id(index), row)
        })
        .collect()
}

pub(crate) fn convert_to(path: &Path, scene: &Scene, config: &ConvertConfig) -> Result<(), Error> {
    let result = convert(Chunks { scene: scene.clone(), next: 0 }, path, config);
    match result {
        Ok(_) => Ok(()),
        Err(ConvertError::Grid(error)) => Err(error),
        Err(other) => panic!("{other}"),
    }
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}
