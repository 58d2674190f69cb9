/*!
The writer: binary, little endian.

Positions are `double` where the scene has an origin, else `float`; then come `radius`, colors with
alpha, the atomic number as `element`, and all scalars. Space in the name of a scalar becomes `_`,
and one is added as long as another property has the name, or as it would make a scalar part of a
color. Ids have no place in the format: what is written is in the order of the scene.
*/

use crate::error::{ErrorKind, Fault};
use glam::DVec3;
use puncta_core::{Scene, Sphere};
use std::io::{BufWriter, Write};

/// Writes a scene.
pub(crate) fn write(out: &mut (impl Write + ?Sized), scene: &Scene<Sphere>) -> Result<(), Fault> {
    scene.validate().map_err(|error| ErrorKind::Decoder(error.to_string()))?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    out.write_all(header(scene).as_bytes())?;
    let attributes = &scene.attributes;
    let (colors, elements) = (attributes.colors.as_deref(), attributes.elements.as_deref());
    let scalars: Vec<&[f32]> = attributes.scalars.iter().map(|s| s.values.as_slice()).collect();
    for (index, record) in scene.records.iter().enumerate() {
        if scene.origin == DVec3::ZERO {
            record.center.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        } else {
            let position = scene.position(index).to_array();
            position.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        }
        out.write_all(&record.radius.to_le_bytes())?;
        if let Some(colors) = colors {
            out.write_all(&colors[index])?;
        }
        if let Some(elements) = elements {
            out.write_all(&[elements[index]])?;
        }
        for values in &scalars {
            out.write_all(&values[index].to_le_bytes())?;
        }
    }
    Ok(out.flush()?)
}

fn header(scene: &Scene<Sphere>) -> String {
    let attributes = &scene.attributes;
    let axis = if scene.origin == DVec3::ZERO { "float" } else { "double" };
    let mut properties = vec![(axis, "x"), (axis, "y"), (axis, "z"), ("float", "radius")];
    if attributes.colors.is_some() {
        properties.extend(["red", "green", "blue", "alpha"].map(|name| ("uchar", name)));
    }
    if attributes.elements.is_some() {
        properties.push(("uchar", "element"));
    }
    let names: Vec<String> = properties.iter().map(|(_, name)| (*name).to_owned()).collect();
    let scalars = attributes.scalars.iter().map(|scalar| &*scalar.name);
    let scalars = safe_names(scalars, names);
    properties.extend(scalars.iter().map(|name| ("float", &**name)));

    let mut header = "ply\nformat binary_little_endian 1.0\n".to_owned();
    header += &format!("element vertex {}\n", scene.records.len());
    for (number, name) in properties {
        header += &format!("property {number} {name}\n");
    }
    header + "end_header\n"
}

/// Names for scalars that differ from each other and from the names in `taken`.
fn safe_names<'s>(names: impl Iterator<Item = &'s str>, mut taken: Vec<String>) -> Vec<String> {
    let others = taken.len();
    for name in names {
        let safe = |c: char| if c.is_whitespace() || c.is_control() { '_' } else { c };
        // A longer name could not be read again.
        let mut name: String = name.chars().take(200).map(safe).collect();
        // Without the first of its parts, nothing is a color.
        let is_color = ["red", "diffuse_red", "r"].contains(&&*name);
        if name.is_empty() || is_color {
            name.push('_');
        }
        while taken.contains(&name) {
            name.push('_');
        }
        taken.push(name);
    }
    taken.split_off(others)
}
