//! Valid files of all encodings and types.

use super::*;
use puncta_core::Scene;
use std::{env, fs, path::Path};

fn positions(scene: &Scene) -> Vec<[f64; 3]> {
    (0..scene.records.len()).map(|i| scene.position(i).to_array()).collect()
}

fn values<'s>(scene: &'s Scene, name: &str) -> &'s [f32] {
    &scene.scalar(name).unwrap().values
}

/// Two names, two numbers as bytes, and the value of the second.
type Case = (&'static str, &'static str, &'static [u8], &'static [u8], f64);

/// The types, their two names, and 3 and 200 or -100 in little endian.
const TYPES: [Case; 8] = [
    ("char", "int8", &[3], &[156], -100.0),
    ("uchar", "uint8", &[3], &[200], 200.0),
    ("short", "int16", &[3, 0], &[156, 255], -100.0),
    ("ushort", "uint16", &[3, 0], &[200, 0], 200.0),
    ("int", "int32", &[3, 0, 0, 0], &[156, 255, 255, 255], -100.0),
    ("uint", "uint32", &[3, 0, 0, 0], &[200, 0, 0, 0], 200.0),
    ("float", "float32", &[0, 0, 0x40, 0x40], &[0, 0, 0xc8, 0xc2], -100.0),
    ("double", "float64", &[0, 0, 0, 0, 0, 0, 8, 0x40], &[0, 0, 0, 0, 0, 0, 0x69, 0x40], 200.0),
];

#[test]
fn all_types_of_both_byte_orders_and_names_are_read() {
    for (old, new, three, other, value) in TYPES {
        for (name, format) in [
            (old, "binary_little_endian"),
            (new, "binary_little_endian"),
            (old, "binary_big_endian"),
            (new, "binary_big_endian"),
        ] {
            let properties = ["x", "y", "z", "w"].map(|axis| format!("property {name} {axis}"));
            let mut lines = vec!["element vertex 2"];
            lines.extend(properties.iter().map(|property| &**property));
            let ordered = |bytes: &[u8]| {
                let mut bytes = bytes.to_vec();
                if format == "binary_big_endian" {
                    bytes.reverse();
                }
                bytes
            };
            let mut bytes = header(format, &lines);
            for number in [three, other, three, other, other, three, three, three] {
                bytes.extend(ordered(number));
            }
            let loaded = read(&bytes);
            assert_eq!(positions(&loaded.scene), [[3.0, value, 3.0], [value, 3.0, 3.0]]);
            assert_eq!(values(&loaded.scene, "w"), [value as f32, 3.0]);
            assert_eq!(loaded.report.warnings.len(), 1, "the radius is missing");
        }
    }
}

#[test]
fn a_text_with_everything_is_read() {
    let loaded = read(
        b"ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info num_cols 512\r\n\
        element camera 2\r\nproperty float focus\r\nproperty list uchar float lens\r\n\
        element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty list int int faces\r\n\
        property double z\r\nproperty float radius\r\nproperty uchar red\r\n\
        property uchar green\r\n\
        property uchar blue\r\nproperty uchar element\r\nproperty float distance[<0.1]\r\n\
        property int r\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n\
        end_header\r\n\
        0.5 2 1 2\r\n0.25 0\r\n1 2 0 3.5 0.5 10 20 30 6 1e-3 7\r\n\r\n \
        -1 +2.5e0 2 9 9 -3 .25 1 2 3 8 nan -8\r\n4 5 1 0 6 2 255 255 255 0 0 0\r\n3 0 1 2\r\n",
    );
    let expected = [[1.0, 2.0, 3.5], [-1.0, 2.5, -3.0], [4.0, 5.0, 6.0]];
    assert_eq!(positions(&loaded.scene), expected);
    assert_eq!(loaded.scene.records.iter().map(|r| r.radius).collect::<Vec<_>>(), [0.5, 0.25, 2.0]);
    let colors = [[10, 20, 30, 255], [1, 2, 3, 255], [255; 4]];
    assert_eq!(loaded.scene.attributes.colors, Some(colors.to_vec().into()));
    assert_eq!(loaded.scene.attributes.elements, Some([6, 8, 0].into()));
    assert_eq!(loaded.scene.attributes.scalars.len(), 2);
    let distance = values(&loaded.scene, "distance[<0.1]");
    assert!(distance[0] == 1e-3 && distance[1].is_nan() && distance[2] == 0.0);
    assert_eq!(values(&loaded.scene, "r"), [7.0, -8.0, 0.0]);
    assert_eq!(loaded.report, Default::default());
}

#[test]
fn lists_before_and_inside_vertices_are_passed_over() {
    let lines = [
        "element edge 2",
        "property short a",
        "property short b",
        "element face 2",
        "property uchar flag",
        "property list uchar ushort corners",
        "property list uint char empty",
        "element vertex 2",
        "property list uchar double none",
        "property float x",
        "property float y",
        "property list short uchar bytes",
        "property float z",
        "property float radius",
        "element more 7",
        "property list int int more",
    ];
    for big in [false, true] {
        let mut bytes =
            header(if big { "binary_big_endian" } else { "binary_little_endian" }, &lines);
        let mut add = |number: &[u8]| {
            let mut number = number.to_vec();
            if big {
                number.reverse();
            }
            bytes.extend(number);
        };
        [1_i16, 2, 3, 4].iter().for_each(|n| add(&n.to_le_bytes()));
        for corners in [3_u8, 0] {
            add(&[9]);
            add(&[corners]);
            (0..corners).for_each(|_| add(&7_u16.to_le_bytes()));
            add(&u32::from(corners).to_le_bytes());
            (0..corners).for_each(|_| add(&[1]));
        }
        for i in [1_u8, 2] {
            let f = f32::from(i);
            add(&[i]);
            (0..i).for_each(|_| add(&0.1_f64.to_le_bytes()));
            [f, 10.0 * f].iter().for_each(|x| add(&x.to_le_bytes()));
            add(&i16::from(i).to_le_bytes());
            (0..i).for_each(|_| add(&[255]));
            [100.0 * f, 0.5].iter().for_each(|x| add(&x.to_le_bytes()));
        }
        let loaded = read(&bytes);
        assert_eq!(positions(&loaded.scene), [[1.0, 10.0, 100.0], [2.0, 20.0, 200.0]]);
        assert_eq!(loaded.report, Default::default());
    }
}

/// The colors, scalars and warnings of a text with one vertex.
fn colors(properties: &[(&str, &str)], row: &str) -> (Option<[u8; 4]>, usize, Vec<String>) {
    let mut lines = vec!["element vertex 1".to_owned()];
    let axes = [("float", "x"), ("float", "y"), ("float", "z"), ("float", "radius")];
    lines.extend(
        axes.iter().chain(properties).map(|(kind, name)| format!("property {kind} {name}")),
    );
    let lines: Vec<&str> = lines.iter().map(|line| &**line).collect();
    let loaded = read(&join(&header("ascii", &lines), format!("0 0 0 1 {row}\n").as_bytes()));
    let attributes = loaded.scene.attributes;
    (attributes.colors.map(|colors| colors[0]), attributes.scalars.len(), loaded.report.warnings)
}

#[test]
fn colors_of_all_names_and_types_are_read() {
    let rgb = |kind, names: [&'static str; 3]| names.map(|name| (kind, name));
    let usual = ["red", "green", "blue"];
    let color = |rgba| (Some(rgba), 0, vec![]);
    assert_eq!(colors(&rgb("uchar", usual), "1 2 3"), color([1, 2, 3, 255]));
    assert_eq!(colors(&rgb("ushort", usual), "257 514 65535"), color([1, 2, 255, 255]));
    assert_eq!(colors(&rgb("float", usual), "0 0.2 1"), color([0, 51, 255, 255]));
    assert_eq!(colors(&rgb("double", ["r", "g", "b"]), "0 0.2 1"), color([0, 51, 255, 255]));
    let diffuse = ["diffuse_red", "diffuse_green", "diffuse_blue"];
    assert_eq!(colors(&rgb("uint8", diffuse), "1 2 3"), color([1, 2, 3, 255]));
    let with_alpha = [rgb("uchar", usual).to_vec(), vec![("float", "alpha")]].concat();
    assert_eq!(colors(&with_alpha, "1 2 3 0.4"), color([1, 2, 3, 102]));
    let two = [rgb("uchar", diffuse), rgb("uchar", usual)].concat();
    assert_eq!(colors(&two, "4 5 6 1 2 3"), (Some([1, 2, 3, 255]), 3, vec![]));
    assert_eq!(colors(&rgb("uchar", ["r", "g", "w"]), "1 2 3"), (None, 3, vec![]));
    let warning = "colors of type int have no known largest value; they were kept as scalars";
    assert_eq!(colors(&rgb("int", usual), "1 2 3"), (None, 3, vec![warning.to_owned()]));
    let warning = "1 colors lie outside of 0..1 and were clamped".to_owned();
    assert_eq!(colors(&rgb("float", usual), "0 255 0"), (Some([0, 255, 0, 255]), 0, vec![warning]));
    let warning = "1 colors are not a number; they are white".to_owned();
    assert_eq!(colors(&rgb("float", usual), "0 nan 0"), (Some([255; 4]), 0, vec![warning]));
}

#[test]
fn an_element_is_a_byte() {
    let lines = [
        "element vertex 3",
        "property float x",
        "property float y",
        "property float z",
        "property uchar element",
    ];
    let loaded = read(&join(&header("ascii", &lines), b"0 0 0 6\n1 0 0 256\n2 0 0 1.5\n"));
    assert_eq!(loaded.scene.attributes.elements, Some([6, 0, 0].into()));
    let warning = "2 atomic numbers are not 0 to 255; they were taken for 0".to_owned();
    assert!(loaded.report.warnings.contains(&warning));
    let lines = lines.map(|line| line.replace("uchar", "int"));
    let lines: Vec<&str> = lines.iter().map(|line| &**line).collect();
    let loaded = read(&join(&header("ascii", &lines), b"0 0 0 6\n1 0 0 256\n2 0 0 1.5\n"));
    assert_eq!(loaded.scene.attributes.elements, None);
    assert_eq!(values(&loaded.scene, "element"), [6.0, 256.0, 1.5]);
}

#[test]
fn digits_of_far_vertices_are_kept() {
    let lines = [
        "element vertex 2",
        "property double x",
        "property double y",
        "property double z",
        "property float radius",
    ];
    let text = join(
        &header("ascii", &lines),
        b"637000.01 851000.02 450.03 1\n637001.04 851002.05 451.06 1\n",
    );
    let far = [[637_000.01, 851_000.02, 450.03], [637_001.04, 851_002.05, 451.06]];
    let mut binary = header("binary_big_endian", &lines);
    for position in far {
        position.iter().for_each(|x: &f64| binary.extend(x.to_be_bytes()));
        binary.extend(1.0_f32.to_be_bytes());
    }
    for bytes in [text, binary] {
        for (got, wanted) in positions(&read(&bytes).scene).iter().zip(far) {
            assert!((0..3).all(|axis| (got[axis] - wanted[axis]).abs() < 1e-7));
        }
    }
}

#[test]
fn many_vertices_are_read_chunk_by_chunk() {
    let lines = [
        "element vertex 20000",
        "property float x",
        "property float y",
        "property uchar z",
        "property float radius",
    ];
    let mut bytes = header("binary_little_endian", &lines);
    for i in 0..20_000_u16 {
        let [x, y] = [f32::from(i), 0.5].map(f32::to_le_bytes);
        bytes.extend([&x[..], &y, &[7], &1.0_f32.to_le_bytes()].concat());
    }
    let scene = read(&bytes).scene;
    let expected: Vec<_> = (0..20_000_u16).map(|i| [f64::from(i), 0.5, 7.0]).collect();
    assert_eq!(positions(&scene), expected);
}

#[test]
#[expect(clippy::print_stdout, reason = "a skipped test says so")]
fn a_scan_is_read() {
    let Ok(folder) = env::var("PUNCTA_DATA") else {
        println!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let bytes = fs::read(Path::new(&folder).join("bun_zipper.ply")).unwrap();
    let loaded = ReadOptions::default().read_bytes("bun_zipper.ply", &bytes).unwrap();
    assert_eq!(loaded.scene.records.len(), 35_947);
    assert_eq!(positions(&loaded.scene)[0], [-0.0378297_f32, 0.12794, 0.00447467].map(f64::from));
    assert_eq!(values(&loaded.scene, "confidence")[..2], [0.850855, 0.900159]);
    assert_eq!(values(&loaded.scene, "intensity")[..2], [0.5, 0.5]);
    assert_eq!(loaded.report.skipped, []);
}
