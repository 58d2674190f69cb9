//! The writer: extended XYZ whose numbers come back as they were.

use super::properties;
use crate::{builder::is_radius, elements};
use puncta_core::{Scene, Sphere};
use std::{
    collections::HashSet,
    io::{self, Write},
};

/// Writes a scene as a frame, in the order of its records.
///
/// Numbers have the fewest digits that give them back. Colors have a fourth column, the alpha, where
/// one is not opaque. The names of scalars are changed where they could not be read again.
pub(crate) fn write(out: &mut dyn Write, scene: &Scene<Sphere>) -> io::Result<()> {
    let attributes = &scene.attributes;
    let colors = attributes.colors.as_deref();
    let has_alpha = colors.is_some_and(|colors| colors.iter().any(|color| color[3] < 255));
    let channels = if has_alpha { 4 } else { 3 };
    writeln!(out, "{}", scene.records.len())?;
    write_header(out, scene, channels)?;
    for (index, record) in scene.records.iter().enumerate() {
        if let Some(element) = attributes.elements.as_ref().and_then(|column| column.get(index)) {
            write!(out, "{} ", elements::symbol(*element).unwrap_or("X"))?;
        }
        let [x, y, z] = scene.position(index).to_array();
        write!(out, "{x:?} {y:?} {z:?} ")?;
        write_radius(out, record.radius)?;
        if let Some(color) = colors.and_then(|column| column.get(index)) {
            for channel in &color[..channels] {
                write!(out, " {:?}", f32::from(*channel) / 255.0)?;
            }
        }
        for scalar in &attributes.scalars {
            write!(out, " {:?}", scalar.values.get(index).copied().unwrap_or(f32::NAN))?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// Writes the comment, which names the columns.
fn write_header(out: &mut dyn Write, scene: &Scene<Sphere>, channels: usize) -> io::Result<()> {
    let attributes = &scene.attributes;
    let species = if attributes.elements.is_some() { "species:S:1:" } else { "" };
    write!(out, "Properties={species}pos:R:3:radius:R:1")?;
    if attributes.colors.is_some() {
        write!(out, ":color:R:{channels}")?;
    }
    let mut taken = HashSet::new();
    for scalar in &attributes.scalars {
        write!(out, ":{}:R:1", safe_name(&scalar.name, &mut taken))?;
    }
    out.write_all(b"\n")
}

/// Writes a radius, which readers parse in double precision before they round it.
fn write_radius(out: &mut dyn Write, radius: f32) -> io::Result<()> {
    let text = format!("{radius:?}");
    #[expect(clippy::cast_possible_truncation, reason = "this is how the radius is read")]
    let comes_back = text.parse::<f64>().is_ok_and(|read| read as f32 == radius && is_radius(read));
    if comes_back {
        return out.write_all(text.as_bytes());
    }
    write!(out, "{:?}", f64::from(radius))
}

/// A name that the format can hold, that no other column has, and that means nothing else.
fn safe_name(name: &str, taken: &mut HashSet<String>) -> String {
    let is_safe = |c: &char| c.is_alphanumeric() || "_-+.".contains(*c);
    let mut safe: String = name.chars().map(|c| if is_safe(&c) { c } else { '_' }).collect();
    if safe.is_empty() {
        safe.push_str("scalar");
    }
    let first = safe.clone();
    let mut number = 2;
    while properties::has_role(&safe) || taken.contains(&safe) {
        safe = format!("{first}_{number}");
        number += 1;
    }
    taken.insert(safe.clone());
    safe
}
