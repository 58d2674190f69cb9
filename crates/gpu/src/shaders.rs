/*!
Tests of shaders without any driver: all modules that are put together are valid, they need no more than
is said, their structs lie in memory as those of Rust do, and every pipeline can be built.
*/

use crate::{
    Error, Fragment, Gpu, GpuConfig, GpuRenderer, Setup, compositor,
    gpu::{WANTED, experimental},
    kernel::shader,
    kernels, raster,
    round::{CHUNK_BYTES, DISC_BYTES},
    shade_pass, solid_shaders,
};
use naga::{
    Module,
    proc::Layouter,
    valid::{Capabilities, ModuleInfo, ValidationFlags, Validator},
};
use puncta_avc::{Arc, Arrow, Block, Cuboid, Disc, Glyphs, Node, Polygon, Prism};

/// Names, offsets and sizes of a struct's members.
pub(crate) type Members = Vec<(String, u32, u32)>;

/// The module of a source, if it needs no more than these capabilities.
pub(crate) fn module(name: &str, source: &str, needs: Capabilities) -> Result<Module, String> {
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| error.emit_to_string_with_path(source, name))?;
    let checked: Result<ModuleInfo, _> =
        Validator::new(ValidationFlags::all(), needs).validate(&module);
    checked.map_err(|error| error.emit_to_string_with_path(source, name))?;
    Ok(module)
}

/// The size of a struct and its members.
pub(crate) fn layout(module: &Module, name: &str) -> (u32, Members) {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let has_name = |ty: &naga::Type| ty.name.as_deref() == Some(name);
    let (_, ty) = module.types.iter().find(|(_, ty)| has_name(ty)).unwrap();
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name}") };
    let member = |member: &naga::StructMember| {
        let size = layouter[member.ty].size;
        (member.name.clone().unwrap_or_default(), member.offset, size)
    };
    (*span, members.iter().map(member).collect())
}

/// Asserts that a struct of Rust and one of a source have the same members at the same places.
macro_rules! assert_same_layout {
    ($source:expr, $name:literal, $type:ident { $($field:ident),* $(,)? }) => {{
        let module = crate::shaders::module($name, $source, crate::shaders::everything()).unwrap();
        let (size, members) = crate::shaders::layout(&module, $name);
        fn size_of_field<T, F>(_: fn(&T) -> &F) -> usize {
            size_of::<F>()
        }
        let number = |n: usize| u32::try_from(n).unwrap();
        let own: crate::shaders::Members = vec![$((
            stringify!($field).to_owned(),
            number(std::mem::offset_of!($type, $field)),
            number(size_of_field(|it: &$type| &it.$field)),
        )),*];
        assert_eq!(members, own);
        assert_eq!(size, number(size_of::<$type>()));
    }};
}
pub(crate) use assert_same_layout;

/// All that any of the shaders needs.
pub(crate) fn everything() -> Capabilities {
    WIDE | Capabilities::SHADER_INT64_ATOMIC_ALL_OPS
        | Capabilities::EARLY_DEPTH_TEST
        | Capabilities::MESH_SHADER
}

const WIDE: Capabilities =
    Capabilities::SHADER_INT64.union(Capabilities::SHADER_INT64_ATOMIC_MIN_MAX);

/// Every module that is the same everywhere.
fn core_sources() -> Vec<(&'static str, &'static str)> {
    let others = [("compositor", compositor::SOURCE), ("over blocks", solid_shaders::OVER_BLOCKS)];
    kernels::SOURCES.into_iter().chain(shade_pass::SOURCES).chain(others).collect()
}

/// Every module of drawing: its name, its source and what it needs beyond core WebGPU.
fn drawing() -> Vec<(String, String, Capabilities)> {
    let mut all = Vec::new();
    // All operations include the two.
    let load = Capabilities::SHADER_INT64 | Capabilities::SHADER_INT64_ATOMIC_ALL_OPS;
    for (word, visibility, words) in [
        ("narrow", shader!("visibility_narrow"), Capabilities::empty()),
        ("wide", shader!("visibility_wide"), WIDE),
        ("load", shader!("visibility_load"), load),
    ] {
        for setup in Setup::ALL {
            for fragment in Fragment::ALL {
                let mut needs = words;
                needs.set(Capabilities::MESH_SHADER, setup == Setup::Mesh);
                needs.set(Capabilities::EARLY_DEPTH_TEST, fragment == Fragment::SphereEarly);
                let name = format!("{setup} {fragment} {word}");
                all.push((name, raster::source(setup, fragment, visibility), needs));
            }
        }
        all.push((format!("splat {word}"), raster::splat_source(visibility), words));
        let mut glyph = |name, sources: [String; 3]| {
            for (part, source) in ["all", "seen", "large"].iter().zip(sources) {
                all.push((format!("{name} {part} {word}"), source, words));
            }
        };
        glyph("arcs", solid_shaders::sources::<Arc>(visibility, (true, 16_384)));
        // As where groups cannot share forms.
        glyph("arcs alone", solid_shaders::sources::<Arc>(visibility, (true, 1024)));
        glyph("arrows", solid_shaders::sources::<Arrow>(visibility, (true, 16_384)));
        glyph("blocks", solid_shaders::sources::<Block>(visibility, (true, 16_384)));
        glyph("cuboids", solid_shaders::sources::<Cuboid>(visibility, (true, 16_384)));
        glyph("discs", solid_shaders::sources::<Disc>(visibility, (true, 16_384)));
        glyph("nodes", solid_shaders::sources::<Node>(visibility, (true, 16_384)));
        glyph("polygons", solid_shaders::sources::<Polygon>(visibility, (true, 16_384)));
        glyph("prisms", solid_shaders::sources::<Prism>(visibility, (true, 16_384)));
    }
    all
}

/// Every module: its name and its source.
pub(crate) fn sources() -> Vec<(String, String)> {
    let core =
        core_sources().into_iter().map(|(name, source)| (name.to_owned(), source.to_owned()));
    core.chain(drawing().into_iter().map(|(name, source, _)| (name, source))).collect()
}

#[test]
fn kernels_are_core_webgpu() {
    for (name, source) in core_sources() {
        module(name, source, Capabilities::empty()).unwrap_or_else(|what| panic!("{what}"));
    }
}

/// They are valid with what is said, and not with any less.
#[test]
fn drawing_needs_what_is_said() {
    for (name, source, needs) in drawing() {
        module(&name, &source, needs).unwrap_or_else(|what| panic!("{what}"));
        for one in needs.iter() {
            assert!(module(&name, &source, needs - one).is_err(), "{name} does not need {one:?}");
        }
    }
}

/// A struct that several modules have is the same one in all of them.
#[test]
fn structs_are_the_same_everywhere() {
    let module = |(name, source): (String, String)| {
        let module = module(&name, &source, everything()).unwrap();
        (name, module)
    };
    let modules: Vec<(String, Module)> = sources().into_iter().map(module).collect();
    let is_there = |module: &Module, name: &str| {
        module.types.iter().any(|(_, ty)| ty.name.as_deref() == Some(name))
    };
    let sizes = [
        ("Camera", None),
        ("Run", None),
        ("Round", None),
        ("Counts", None),
        ("Disc", Some(DISC_BYTES)),
        ("Chunk", Some(CHUNK_BYTES)),
        ("Tile", Some(8)),
        ("Shade", None),
        ("Entry", None),
        ("Block", Some(solid_shaders::BLOCK_BYTES)),
    ];
    for (name, size) in sizes {
        let having = modules.iter().filter(|(_, module)| is_there(module, name));
        let layouts: Vec<_> = having.map(|(at, module)| (at, layout(module, name))).collect();
        let (_, first) = &layouts[0];
        for (at, other) in &layouts {
            assert_eq!(other, first, "{name} of {at}");
        }
        assert!(size.is_none_or(|size| size == u64::from(first.0)), "{name}: {first:?}");
    }
    // What the mesh shader sees of what was counted is its beginning.
    let of = |name: &str| modules.iter().find(|(at, _)| at.starts_with(name)).unwrap();
    let seen = layout(&of("mesh").1, "Counted").1;
    assert_eq!(seen, layout(&of("cull").1, "Counts").1[..seen.len()]);
}

/// A device that does nothing, but checks everything it is told.
fn noop(required_features: wgpu::Features) -> Gpu {
    let limits = wgpu::Limits::default();
    let has_mesh = required_features.contains(wgpu::Features::EXPERIMENTAL_MESH_SHADER);
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features,
        required_limits: if has_mesh {
            limits.using_recommended_minimum_mesh_shader_values()
        } else {
            limits
        },
        experimental_features: if has_mesh { experimental() } else { Default::default() },
        ..Default::default()
    });
    Gpu::from_device(device, queue)
}

#[test]
fn every_pipeline_can_be_built() {
    let without_loads = WANTED - wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS;
    let none = wgpu::Features::empty();
    for (features, is_full) in [(none, false), (without_loads, true), (WANTED, true)] {
        let gpu = noop(features);
        assert_eq!(gpu.is_wide(), is_full);
        for setup in Setup::ALL {
            for fragment in Fragment::ALL {
                let config = GpuConfig {
                    setup: Some(setup),
                    fragment: Some(fragment),
                    ..GpuConfig::default()
                };
                let needs_more = setup == Setup::Mesh || fragment == Fragment::SphereEarly;
                match GpuRenderer::new(&gpu, config) {
                    Ok(_) => assert!(is_full || !needs_more, "{setup} {fragment}"),
                    Err(Error::Unsupported { .. }) => assert!(!is_full && needs_more),
                    Err(error) => panic!("{setup} {fragment}: {error}"),
                }
            }
        }
    }
}

#[test]
fn everything_of_glyphs_can_be_built() {
    let without_loads = WANTED - wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS;
    for features in [wgpu::Features::empty(), without_loads, WANTED] {
        let (gpu, glyphs) = (noop(features), Glyphs::<Cuboid>::new([]));
        GpuRenderer::of(&gpu, glyphs, GpuConfig::default()).unwrap();
    }
}

/// Forms are shared if there is room for 64 of them, and not otherwise.
#[test]
fn forms_are_shared_where_there_is_room() {
    let visibility = shader!("visibility_narrow");
    // An arc has 9 words and two truths, and 4 bytes to be even; a truth counts for 5 bytes at most.
    for (bytes, is_shared) in [(16_384, true), (64 * 60, true), (64 * 48 - 1, false), (0, false)] {
        let [all, seen, large] = solid_shaders::sources::<Arc>(visibility, (true, bytes));
        assert_eq!(all.contains("array<Form, 64>"), is_shared, "{bytes}");
        assert_eq!(seen.contains("array<Form, 64>"), is_shared);
        assert!(!large.contains("array<Form, 64>"));
    }
    assert!(
        !solid_shaders::sources::<Cuboid>(visibility, (true, 16_384))[0]
            .contains("array<Form, 64>")
    );
}

#[test]
fn everything_of_shading_can_be_built() {
    use crate::{Compositor, CompositorConfig, CompositorDepth};
    let gpu = noop(wgpu::Features::empty());
    let shading = shade_pass::Shading::new(&gpu, [64, 48]).unwrap();
    for format in [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Bgra8UnormSrgb] {
        for depth in [None, Some(CompositorDepth::reversed(0.1))] {
            for samples in [1, 4] {
                let config = CompositorConfig { format, samples, depth };
                let mut compositor = Compositor::new(&gpu, &config).unwrap();
                compositor.prepare(&shading.shaded).unwrap();
            }
        }
    }
}

/// The test of layouts notices what it is there for.
#[test]
fn other_layouts_are_noticed() {
    #[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
    #[repr(C)]
    struct Two {
        a: [f32; 3],
        b: [f32; 3],
    }
    let source = "struct Two { a: vec3<f32>, b: vec3<f32> } var<private> two: Two;";
    let wrong = std::panic::catch_unwind(|| assert_same_layout!(source, "Two", Two { a, b }));
    assert!(wrong.is_err());
    let source = "struct Two { a: array<f32, 3>, b: array<f32, 3> } var<private> two: Two;";
    assert_same_layout!(source, "Two", Two { a, b });
    let swapped = std::panic::catch_unwind(|| assert_same_layout!(source, "Two", Two { b, a }));
    assert!(swapped.is_err());
}
