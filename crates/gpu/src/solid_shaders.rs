//! The shaders of glyphs: how they are put together, and how much they do.

use crate::kernel::shader;
use puncta_avc::{Glyph, PRELUDE};
use wgpu::naga;

/// The bytes of `Block` of `glyph_large.wgsl`.
pub(crate) const BLOCK_BYTES: u64 = 32;

/// How much one lane, or one list, may be given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Most {
    /// Triangles that a lane goes through.
    triangles: u32,
    /// Pixels that it draws itself.
    spent: u32,
    /// Blocks that it leaves.
    left: u32,
    /// Tiles that it looks at to find whether its record is hidden.
    tiles: u32,
    /// Blocks for which there is room, at least.
    pub(crate) blocks: u64,
}

impl Most {
    /// On a GPU: some milliseconds of a lane.
    const GPU: Self =
        Self { triangles: 1 << 14, spent: 1 << 16, left: 1 << 13, tiles: 1 << 12, blocks: 1 << 18 };

    /// Lavapipe ends a shader that has gone through loops 65,535 times. It counts for eight lanes
    /// together: at worst they take turns. So this is at most 512 x 32 for triangles, whose corners and owners
    /// are found in loops, 8 x 4096 + 8 x 512 for pixels and blocks, and 4096 + 64 for tiles.
    const CPU: Self = Self { triangles: 512, spent: 4096, left: 512, tiles: 4096, blocks: 1 << 15 };

    pub(crate) const fn of(is_cpu: bool) -> Self {
        if is_cpu { Self::CPU } else { Self::GPU }
    }

    /// As constants of shaders.
    fn source(self) -> String {
        let Self { triangles, spent, left, tiles, blocks: _ } = self;
        format!(
            "const TRIANGLES_MAX: u32 = {triangles}u;\nconst SPENT_MAX: u32 = {spent}u;\n\
             const LEFT_MAX: u32 = {left}u;\nconst TILES_MAX: u32 = {tiles}u;\n"
        )
    }
}

/// The words of a record, and of the style.
pub(crate) const fn words<G: Glyph>() -> (usize, usize) {
    const {
        assert!(size_of::<G>().is_multiple_of(4), "a record must be made of words of 32 bits");
        assert!(size_of::<G::Style>().is_multiple_of(4), "so must a style");
    }
    (size_of::<G>() / 4, size_of::<G::Style>() / 4)
}

/// What lies before the code of a glyph, and its code.
pub(crate) fn glyph_source<G: Glyph>() -> String {
    let (words, style) = words::<G>();
    let constants = format!("const WORDS: u32 = {}u;\nconst STYLE: u32 = {style}u;\n", words + 1);
    [&constants, PRELUDE, shader!("glyph_words"), G::WGSL].concat()
}

/// The shaders of a glyph: what draws chunks, what does so for records that were seen before, and what
/// draws blocks of large triangles. Groups may keep so many bytes.
pub(crate) fn sources<G: Glyph>(
    visibility: &str,
    (is_cpu, group_bytes): (bool, u32),
) -> [String; 3] {
    let before = shader!("camera", "disc", "work", "place");
    let glyph = glyph_source::<G>();
    // A group keeps 64 forms, and where their triangles end.
    let can_share =
        form_bytes(&glyph).is_some_and(|bytes| bytes.saturating_add(4) <= group_bytes / 64);
    let after = shader!("glyph_large", "glyph_facet", "glyph_triangle");
    let common = [before, visibility, &glyph, after, &Most::of(is_cpu).source()].concat();
    let draw = if G::HAS_FEW_TRIANGLES || !can_share {
        shader!("hidden", "glyph", "glyph_alone")
    } else {
        shader!("hidden", "glyph", "glyph_together")
    };
    let wanted = [shader!("glyph_any"), shader!("glyph_seen")];
    let [all, seen] = wanted.map(|wanted| [&common, draw, wanted].concat());
    [all, seen, common + shader!("glyph_blocks")]
}

/// The bytes of a `Form` in memory at most, if there is one.
fn form_bytes(source: &str) -> Option<u32> {
    let module = naga::front::wgsl::parse_str(source).ok()?;
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).ok()?;
    let is_form = |(_, ty): &(_, &naga::Type)| ty.name.as_deref() == Some("Form");
    let (form, _) = module.types.iter().find(is_form)?;
    // A truth has one byte here, and four in the memory of a group.
    Some(layouter[form].to_stride().saturating_add(bools(&module, form).saturating_mul(4)))
}

/// How many numbers of a type are truths.
fn bools(module: &naga::Module, ty: naga::Handle<naga::Type>) -> u32 {
    use naga::{ArraySize, ScalarKind, TypeInner};
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => u32::from(scalar.kind == ScalarKind::Bool),
        TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Bool => *size as u32,
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            bools(module, *base).saturating_mul(count.get())
        }
        TypeInner::Struct { members, .. } => {
            members.iter().fold(0, |sum, it| bools(module, it.ty).saturating_add(sum))
        }
        _ => 0,
    }
}

/// The shader that counts blocks.
pub(crate) const OVER_BLOCKS: &str = shader!("work", "glyph_large", "glyph_over");
