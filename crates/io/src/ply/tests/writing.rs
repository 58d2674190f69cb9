//! What is written is read back, by this reader and by another one.

use super::*;
use crate::ply::write;
use glam::DVec3;
use ply_rs_bw::{
    parser::Parser,
    ply::{DefaultElement, Property},
};
use puncta_core::{Scalar, Scene, Sphere};

fn written(scene: &Scene) -> Vec<u8> {
    let mut out = Vec::new();
    write(&mut out, scene).unwrap();
    out
}

fn scene() -> Scene {
    let sphere = |i: u16| {
        let x = f32::from(i);
        Sphere::new([0.1 * x, (1.7 * x).sin(), 3.0 - 0.3 * x], 0.1 + 0.7 * x)
    };
    Scene::new((0..1000).map(sphere).collect::<Vec<_>>())
}

fn with_attributes(mut scene: Scene) -> Scene {
    let attributes = &mut scene.attributes;
    attributes.colors =
        Some((0..1000_u16).map(|i| [i as u8, (i >> 8) as u8, 9, 255 - i as u8]).collect());
    attributes.elements = Some((0..1000_u16).map(|i| (i % 119) as u8).collect());
    let values = |scale: f32| (0..1000_u16).map(|i| scale * f32::from(i)).collect();
    attributes.scalars.push(Scalar { name: "speed".into(), values: values(0.1) });
    attributes.scalars.push(Scalar { name: "c_iso[1]".into(), values: values(-1e30) });
    scene
}

#[test]
fn scenes_come_back_as_they_were() {
    for scene in [scene(), with_attributes(scene())] {
        let loaded = read(&written(&scene));
        assert!(loaded.scene == scene);
        assert_eq!(loaded.report, Default::default());
    }
}

#[test]
fn numbers_keep_their_bits() {
    let mut scene = Scene::new(vec![Sphere::new([-0.0, f32::MIN_POSITIVE, 1e-45], 1e30); 5]);
    let values = vec![f32::NAN, f32::INFINITY, -0.0, 1e-45, f32::MAX];
    scene.attributes.scalars.push(Scalar { name: "s".into(), values: values.into() });
    let loaded = read(&written(&scene)).scene;
    let bits = |scene: &Scene| {
        scene.scalar("s").unwrap().values.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&loaded), bits(&scene));
}

#[test]
fn scenes_with_an_origin_keep_their_positions() {
    let mut first = with_attributes(scene());
    first.origin = DVec3::new(1e7, -5e6, 64.0);
    let bytes = written(&first);
    assert!(bytes.windows(17).any(|line| line == b"property double x"));
    // The reader chooses another origin, whose offsets may round; after that, nothing changes.
    let loaded = read(&bytes).scene;
    assert!(loaded.attributes == first.attributes);
    for i in 0..1000 {
        assert!((loaded.position(i) - first.position(i)).abs().max_element() < 2e-5);
        assert_eq!(loaded.records[i].radius, first.records[i].radius);
    }
    let again = read(&written(&loaded)).scene;
    assert!((0..1000).all(|i| again.position(i) == loaded.position(i)));
}

#[test]
fn names_of_scalars_are_made_safe() {
    let mut scene = Scene::new(vec![Sphere::new([0.0; 3], 1.0)]);
    let names = [
        "my speed\n",
        "x",
        "radius",
        "r",
        "g",
        "b",
        "red",
        "",
        "x_",
        "my_speed_",
        "element",
        "größe",
    ];
    for (value, name) in (0_u8..).zip(names) {
        let values = vec![f32::from(value)];
        scene.attributes.scalars.push(Scalar { name: name.into(), values: values.into() });
    }
    scene.attributes.elements = Some(vec![6].into());
    let loaded = read(&written(&scene)).scene;
    let safe: Vec<_> = loaded.attributes.scalars.iter().map(|scalar| &*scalar.name).collect();
    let wanted = [
        "my_speed_",
        "x_",
        "radius_",
        "r_",
        "g",
        "b",
        "red_",
        "_",
        "x__",
        "my_speed__",
        "element_",
        "größe",
    ];
    assert_eq!(safe, wanted);
    assert!((0_u8..).zip(&loaded.attributes.scalars).all(|(i, s)| s.values == [f32::from(i)]));
    assert_eq!((loaded.attributes.colors, loaded.attributes.elements), (None, Some([6].into())));
}

#[test]
fn another_reader_reads_the_same() {
    let mut scene = with_attributes(scene());
    scene.attributes.scalars.truncate(1);
    for origin in [DVec3::ZERO, DVec3::new(1e7, -5e6, 64.0)] {
        scene.origin = origin;
        let parser = Parser::<DefaultElement>::new();
        let ply = parser.read_ply(&mut &written(&scene)[..]).unwrap();
        let vertices = &ply.payload["vertex"];
        assert_eq!(vertices.len(), 1000);
        for (i, vertex) in vertices.iter().enumerate() {
            let number = |name: &str| match vertex[name] {
                Property::Float(x) => f64::from(x),
                Property::Double(x) => x,
                Property::UChar(x) => f64::from(x),
                ref other => panic!("{name}: {other:?}"),
            };
            let position = DVec3::from(["x", "y", "z"].map(number));
            assert_eq!(position, scene.position(i));
            assert_eq!(number("radius"), f64::from(scene.records[i].radius));
            let color = scene.attributes.colors.as_ref().unwrap()[i].map(f64::from);
            assert_eq!(["red", "green", "blue", "alpha"].map(number), color);
            assert_eq!(
                number("element"),
                f64::from(scene.attributes.elements.as_ref().unwrap()[i])
            );
            assert_eq!(number("speed"), f64::from(scene.attributes.scalars[0].values[i]));
        }
    }
}

#[test]
fn columns_of_another_length_are_refused() {
    let mut scene = with_attributes(scene());
    scene.attributes.scalars[0].values.to_mut().pop();
    let error = write(&mut Vec::new(), &scene).unwrap_err().in_file("b.ply");
    assert_eq!(error.to_string(), "b.ply: attribute speed has 999 values for 1000 records");
}
