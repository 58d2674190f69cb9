//! The arrows between the crates, as `docs/architecture.md` draws them.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test may panic, and its numbers are small"
)]

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};

/// What each crate may use of the others, in its code and in its tests.
const ARROWS: [(&str, &[&str]); 9] = [
    ("puncta-core", &[]),
    ("puncta-avc", &["puncta-core"]),
    ("puncta-io", &["puncta-core"]),
    ("puncta-grid", &["puncta-core"]),
    ("puncta-occlusion", &["puncta-core", "puncta-grid"]),
    ("puncta-cpu", &["puncta-core", "puncta-avc", "puncta-grid", "puncta-occlusion"]),
    ("puncta-gpu", &["puncta-core", "puncta-avc", "puncta-grid", "puncta-occlusion"]),
    ("puncta-viewer", &["puncta"]),
    (
        "puncta",
        &[
            "puncta-core",
            "puncta-avc",
            "puncta-io",
            "puncta-grid",
            "puncta-occlusion",
            "puncta-cpu",
            "puncta-gpu",
        ],
    ),
];

/// Crates that only some of ours may name.
const RESERVED: [(&str, &[&str]); 3] = [
    ("memmap2", &["puncta-grid"]),
    (
        "rayon",
        &[
            "puncta-avc",
            "puncta-cpu",
            "puncta-gpu",
            "puncta-grid",
            "puncta-occlusion",
            "puncta-viewer",
        ],
    ),
    ("wgpu", &["puncta-gpu"]),
];

fn metadata() -> Metadata {
    MetadataCommand::new().no_deps().exec().unwrap()
}

fn dependencies(package: &Package, kind: DependencyKind) -> Vec<&str> {
    let of_kind = package.dependencies.iter().filter(|dependency| dependency.kind == kind);
    of_kind.map(|dependency| dependency.name.as_str()).collect()
}

#[test]
fn crates_use_only_what_the_map_allows() {
    let metadata = metadata();
    let mut names: Vec<&str> = metadata.packages.iter().map(|p| p.name.as_str()).collect();
    let mut known: Vec<&str> = ARROWS.iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    known.sort_unstable();
    assert_eq!(names, known, "the map must name each crate of the workspace");
    for (name, allowed) in ARROWS {
        let package = metadata.packages.iter().find(|p| p.name.as_str() == name).unwrap();
        for kind in [DependencyKind::Normal, DependencyKind::Development, DependencyKind::Build] {
            for used in dependencies(package, kind) {
                let is_ours = used.starts_with("puncta");
                assert!(!is_ours || allowed.contains(&used), "{name} must not use {used}");
            }
        }
    }
}

#[test]
fn some_dependencies_have_one_home() {
    for package in &metadata().packages {
        for (reserved, homes) in RESERVED {
            let uses = dependencies(package, DependencyKind::Normal).contains(&reserved);
            let name = package.name.as_str();
            assert!(!uses || homes.contains(&name), "{name} must not use {reserved}");
        }
    }
}

#[test]
fn one_version_and_one_licence_for_all() {
    let metadata = metadata();
    let first = &metadata.packages[0];
    for package in &metadata.packages {
        assert_eq!(package.version, first.version, "{}", package.name);
        assert_eq!(package.license.as_deref(), Some("MIT"), "{}", package.name);
        // Windows need a newer compiler than what a program depends on.
        if package.name.as_str() != "puncta-viewer" {
            assert_eq!(package.rust_version, first.rust_version, "{}", package.name);
        }
    }
}
