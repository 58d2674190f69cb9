//! A program's own render pass: it draws a wall, and lets a shaded image be drawn with it.

use puncta::{
    Gpu, View,
    gpu::{Compositor, CompositorConfig, CompositorDepth, Shaded, wgpu},
};

pub(crate) const PLAIN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(crate) const LINEAR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// The color of the wall, which is the same in light and in sRGB.
pub(crate) const WALL: [u8; 4] = [255, 0, 255, 255];

fn texture(gpu: &Gpu, view: &View, format: wgpu::TextureFormat) -> wgpu::Texture {
    let (width, height) = (view.width(), view.height());
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    if format != wgpu::TextureFormat::Depth32Float {
        usage |= wgpu::TextureUsages::COPY_SRC;
    }
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("window"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// The pixels of a pass in which the wall is what the attachments are cleared to.
pub(crate) fn draw(
    gpu: &Gpu,
    (shaded, view): (&Shaded, &View),
    (format, wall): (wgpu::TextureFormat, f32),
) -> Vec<[u8; 4]> {
    let depth = Some(CompositorDepth::reversed(view.near() as f32));
    let config = CompositorConfig { format, samples: 1, depth };
    let mut compositor = Compositor::new(gpu, &config).unwrap();
    compositor.prepare(shaded).unwrap();
    let color = texture(gpu, view, format);
    let depth = texture(gpu, view, wgpu::TextureFormat::Depth32Float);
    let [color_view, depth_view] = [&color, &depth].map(|t| t.create_view(&Default::default()));
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let clear = wgpu::Color { r: 1.0, g: 0.0, b: 1.0, a: 1.0 };
    let attachment = wgpu::RenderPassColorAttachment {
        view: &color_view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("window"),
        color_attachments: &[Some(attachment)],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(wall),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    compositor.render(&mut pass);
    drop(pass);
    read(gpu, encoder, &color)
}

fn read(gpu: &Gpu, mut encoder: wgpu::CommandEncoder, color: &wgpu::Texture) -> Vec<[u8; 4]> {
    let row_bytes = (color.width() * 4).next_multiple_of(256);
    let staging = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("window"),
        size: u64::from(row_bytes) * u64::from(color.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let bytes_per_row = Some(row_bytes);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &staging, layout };
    encoder.copy_texture_to_buffer(color.as_image_copy(), to, color.size());
    gpu.queue().submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    gpu.device().poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = staging.get_mapped_range(..).unwrap();
    let pixels = |row: &[u8]| bytemuck::cast_slice(&row[..color.width() as usize * 4]).to_vec();
    bytes.chunks_exact(row_bytes as usize).flat_map(pixels).collect()
}
