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
/// Numbers have the fewest digits that give them back. Colors have a fourth column, the alpha,
/// where one is not opaque. The names of scalars are changed where they could not be read again.
pub(crate) fn write(out: &mut dyn Write, scene: &Scene<Sphere>) -> io::Result<()> {
    let attributes = &scene.attributes;
    let (colors, elements) = (attributes.colors.as_deref(), attributes.elements.as_deref());
    let scalars: Vec<&[f32]> = attributes.scalars.iter().map(|s| s.values.as_slice()).collect();
    let has_alpha = colors.is_some_and(|colors| colors.iter().any(|color| color[3] < 255));
    let channels = if has_alpha { 4 } else { 3 };
    writeln!(out, "{}", scene.records.len())?;
    write_header(out, scene, channels)?;
    for (index, record) in scene.records.iter().enumerate() {
        if let Some(element) = elements.and_then(|column| column.get(index)) {
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
        for values in &scalars {
            write!(out, " {:?}", values.get(index).copied().unwrap_or(f32::NAN))?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Loaded, ReadOptions};
    use glam::DVec3;
    use puncta_core::Scalar;

    fn read(text: &str) -> Loaded {
        ReadOptions::default().read_bytes("a.xyz", text.as_bytes()).unwrap()
    }

    fn rewrite(scene: &Scene) -> (String, Loaded) {
        let mut text = Vec::new();
        write(&mut text, scene).unwrap();
        let text = String::from_utf8(text).unwrap();
        let loaded = read(&text);
        (text, loaded)
    }

    fn positions(scene: &Scene) -> Vec<DVec3> {
        (0..scene.records.len()).map(|index| scene.position(index)).collect()
    }

    fn bits(scene: &Scene) -> Vec<(String, Vec<u32>)> {
        let bits = |scalar: &Scalar| scalar.values.iter().map(|value| value.to_bits()).collect();
        scene.attributes.scalars.iter().map(|scalar| (scalar.name.clone(), bits(scalar))).collect()
    }

    /// Numbers without any pattern.
    fn noise(count: u32) -> impl Iterator<Item = f64> {
        let mut state = 1_u64;
        (0..count).map(move |_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    #[test]
    fn everything_comes_back() {
        let mut text =
            "1000\nProperties=species:S:1:pos:R:3:radius:R:1:color:I:3:a:R:1:b:R:1\n".to_owned();
        let numbers: Vec<f64> = noise(9000).collect();
        for row in numbers.chunks(9) {
            let [x, y, z, radius, red, green, blue, a, b] = row.try_into().unwrap();
            let [red, green, blue] = [red, green, blue].map(|c: f64| (c * 255.0).round());
            let (x, y, z) = (x * 977.0 + 637_000.0, y * 500.0 - 8.5e6, z);
            let b = (b - 0.5) * 1e-30;
            text += &format!("Fe {x} {y} {z} {} {red} {green} {blue} {a} {b}\n", radius + 1e-3);
        }
        let scene = read(&text).scene;
        assert!(scene.origin.x != 0.0 && scene.origin.y != 0.0);
        let (_, again) = rewrite(&scene);
        assert_eq!(again.report, Default::default());
        let again = again.scene;
        assert_eq!(positions(&again), positions(&scene));
        assert_eq!(again.records, scene.records);
        assert_eq!(again.attributes.colors, scene.attributes.colors);
        assert_eq!(again.attributes.elements, scene.attributes.elements);
        assert_eq!(bits(&again), bits(&scene));
    }

    #[test]
    fn extreme_numbers_come_back() {
        let radii = [f32::MIN_POSITIVE, 1e-30, 0.1, 1.0 / 3.0, 16_777_217.0, 8.5e37];
        let records =
            radii.map(|radius| Sphere::new([radius / 7.0, -radius, 0.0], radius)).to_vec();
        let mut scene = Scene::new(records);
        let values = vec![f32::MIN_POSITIVE / 4.0, -0.0, f32::INFINITY, 8.5e37, 0.1, f32::EPSILON];
        scene.attributes.scalars.push(Scalar { name: "s".into(), values: values.into() });
        let (_, again) = rewrite(&scene);
        let found: Vec<f32> = again.scene.records.iter().map(|record| record.radius).collect();
        assert_eq!(found, radii);
        assert_eq!(bits(&again.scene), bits(&scene));
    }

    #[test]
    fn every_color_comes_back() {
        let byte = |i: u8| [i, 255 - i, i / 2, if i < 128 { 255 } else { i }];
        for alpha in [false, true] {
            let mut scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0); 256]);
            let colors =
                (0..=255).map(byte).map(|[r, g, b, a]| [r, g, b, if alpha { a } else { 255 }]);
            scene.attributes.colors = Some(colors.collect());
            let (text, again) = rewrite(&scene);
            assert_eq!(text.contains("color:R:4"), alpha);
            assert_eq!(again.scene.attributes.colors, scene.attributes.colors);
        }
    }

    #[test]
    fn names_are_made_safe() {
        let mut scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0)]);
        let names = ["a b", "a:b", "pos", "Z", "", "a_b", "\"x=1\"", "Radius", "c_1[2]", "größe"];
        for (index, name) in (0_u8..).zip(names) {
            let values = vec![f32::from(index)];
            scene.attributes.scalars.push(Scalar { name: name.into(), values: values.into() });
        }
        scene.attributes.elements = Some(vec![8].into());
        let (_, again) = rewrite(&scene);
        let found: Vec<_> =
            again.scene.attributes.scalars.iter().map(|s| (s.name.as_str(), s.values[0])).collect();
        let safe = [
            "a_b", "a_b_2", "pos_2", "Z_2", "scalar", "a_b_3", "_x_1_", "Radius_2", "c_1_2_",
            "größe",
        ];
        let expected: Vec<_> = safe.into_iter().zip((0_u8..).map(f32::from)).collect();
        assert_eq!(found, expected);
        assert_eq!(again.scene.attributes.elements, Some([8].into()));
    }

    #[test]
    fn no_records_make_an_empty_frame() {
        let mut text = Vec::new();
        write(&mut text, &Scene::new(Vec::new())).unwrap();
        assert_eq!(text, b"0\nProperties=pos:R:3:radius:R:1\n");
    }
}
