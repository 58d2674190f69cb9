//! The window's surface, and the paint on it: wgpu and egui, tied together.

use anyhow::{Context, Result};
use egui::{ClippedPrimitive, TexturesDelta};
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use puncta::gpu::wgpu;
use puncta::gpu::wgpu::CurrentSurfaceTexture;
use std::{io::Write, sync::Arc};
use winit::{event_loop::ActiveEventLoop, window::Window};

/// What a window is painted on.
pub(crate) struct Surface {
    surface: wgpu::Surface<'static>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    config: wgpu::SurfaceConfiguration,
    painter: egui_wgpu::Renderer,
}

impl Surface {
    pub(crate) fn new(events: &ActiveEventLoop, window: &Arc<Window>) -> Result<Self> {
        let display = Box::new(events.owned_display_handle());
        let descriptor = wgpu::InstanceDescriptor::new_with_display_handle(display);
        let instance = wgpu::Instance::new(descriptor);
        let surface = instance.create_surface(Arc::clone(window)).context("no surface")?;
        let options = wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .context("no graphics driver can show a window")?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("Surface::device"),
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
        // By default wgpu would end the program.
        device.on_uncaptured_error(Arc::new(|error| {
            writeln!(std::io::stderr(), "error: the window: {error}").ok();
        }));
        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .context("the surface fits no graphics driver")?;
        let formats = surface.get_capabilities(&adapter).formats;
        config.format = egui_wgpu::preferred_framebuffer_format(&formats)?;
        config.present_mode = wgpu::PresentMode::AutoVsync;
        config.desired_maximum_frame_latency = 1;
        surface.configure(&device, &config);
        let painter = egui_wgpu::Renderer::new(&device, config.format, RendererOptions::default());
        Ok(Self { surface, device, queue, config, painter })
    }

    /// The largest number of rows or columns of an image.
    pub(crate) fn side_max(&self) -> usize {
        self.device.limits().max_texture_dimension_2d as usize
    }

    pub(crate) fn resize(&mut self, width: u32, height: u32) {
        if width > 0 && height > 0 {
            (self.config.width, self.config.height) = (width, height);
            self.surface.configure(&self.device, &self.config);
        }
    }

    /// Paints the window; whether that could be done.
    pub(crate) fn paint(
        &mut self,
        shapes: &[ClippedPrimitive],
        textures: &TexturesDelta,
        pixels_per_point: f32,
    ) -> bool {
        // The textures are told once only, so they are brought even if nothing can be shown.
        for (id, deltas) in &textures.set {
            for delta in deltas {
                self.painter.update_texture(&self.device, &self.queue, *id, delta);
            }
        }
        let target = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(target) => Some(target),
            CurrentSurfaceTexture::Suboptimal(_)
            | CurrentSurfaceTexture::Outdated
            | CurrentSurfaceTexture::Lost => {
                self.surface.configure(&self.device, &self.config);
                None
            }
            _ => None,
        };
        if let Some(target) = &target {
            let size_in_pixels = [self.config.width, self.config.height];
            self.draw(shapes, target, &ScreenDescriptor { size_in_pixels, pixels_per_point });
        }
        for id in &textures.free {
            self.painter.free_texture(id);
        }
        let is_painted = target.is_some();
        if let Some(target) = target {
            self.queue.present(target);
        }
        is_painted
    }

    fn draw(
        &mut self,
        shapes: &[ClippedPrimitive],
        target: &wgpu::SurfaceTexture,
        screen: &ScreenDescriptor,
    ) {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("Surface::draw") };
        let mut encoder = self.device.create_command_encoder(&descriptor);
        let Self { painter, device, queue, .. } = self;
        let mut commands = painter.update_buffers(device, queue, &mut encoder, shapes, screen);
        let view = target.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Surface::pass"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        painter.render(&mut pass.forget_lifetime(), shapes, screen);
        commands.push(encoder.finish());
        queue.submit(commands);
    }
}
