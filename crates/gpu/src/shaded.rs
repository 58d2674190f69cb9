//! What shading makes: an image on the GPU, and its depths.

use crate::{
    Error, Gpu,
    kernel::{Pool, Work, read},
};
use puncta_core::Image;

/// The format of the colors, which hold sRGB as bytes: shaders read them as they are.
const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The format of the depths.
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// An image on the GPU. Clones are handles of the same image.
///
/// A renderer shades into the same textures until the size of its images changes. What was submitted to
/// the queue before still shows what was there before.
#[derive(Clone, Debug)]
pub struct Shaded {
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
    depth_view: wgpu::TextureView,
}

impl Shaded {
    pub(crate) fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<Self, Error> {
        let texture = |label, format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage
                    | wgpu::TextureUsages::STORAGE_BINDING
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        gpu.guard("an image", || {
            let copied = wgpu::TextureUsages::COPY_SRC;
            let color = texture("Shaded::color", COLOR_FORMAT, copied);
            let depth = texture("Shaded::depth", DEPTH_FORMAT, copied);
            let view = |texture: &wgpu::Texture| {
                texture.create_view(&wgpu::TextureViewDescriptor::default())
            };
            Self { color_view: view(&color), depth_view: view(&depth), color }
        })
    }

    /// The colors, of the format `Rgba8Unorm`: bytes in sRGB with straight alpha, as
    /// [`Image`] has them. This is what egui takes as a texture, if the background is not transparent.
    #[must_use]
    pub const fn color(&self) -> &wgpu::TextureView {
        &self.color_view
    }

    /// View depths, of the format `R32Float`: of the nearest that is seen in a pixel, +inf for nothing.
    #[must_use]
    pub const fn depth(&self) -> &wgpu::TextureView {
        &self.depth_view
    }

    /// The texture of the colors, to be copied from.
    #[must_use]
    pub const fn texture(&self) -> &wgpu::Texture {
        &self.color
    }

    /// The number of columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.color.width(), self.color.height()]
    }

    /// Reads the colors back.
    pub(crate) fn read(&self, gpu: &Gpu, pool: &mut Pool) -> Result<Image, Error> {
        let [width, height] = self.size();
        let row_bytes = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row_bytes) * u64::from(height);
        let rows = pool.storage(gpu, "Shaded::rows", bytes)?;
        gpu.guard("an image", || {
            let mut work = Work::new(gpu, "Shaded::read");
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes),
                rows_per_image: None,
            };
            work.encoder.copy_texture_to_buffer(
                self.color.as_image_copy(),
                wgpu::TexelCopyBufferInfo { buffer: &rows, layout },
                self.color.size(),
            );
            work.submit();
        })?;
        let bytes = read(gpu, pool, &[(&rows, 0..bytes)])?;
        let rows = bytes.chunks_exact(row_bytes as usize);
        let pixels =
            rows.flat_map(|row| bytemuck::cast_slice::<u8, [u8; 4]>(&row[..width as usize * 4]));
        Ok(Image { width, height, pixels: pixels.copied().collect() })
    }
}
