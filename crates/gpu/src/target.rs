//! The buffers of a picture.

use crate::{
    Error, Gpu,
    frame::{CameraData, tiles},
    kernel::{Kernel, Work, storage, uniform},
    raster::DEPTH_FORMAT,
};
use puncta_core::View;

/// What a picture is drawn into.
#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) view: View,
    pub(crate) camera: wgpu::Buffer,
    /// Two words for each pixel.
    pub(crate) visibility: wgpu::Buffer,
    pub(crate) tiles: wgpu::Buffer,
    pub(crate) outlook: wgpu::Buffer,
    /// The depths whose ids were drawn, where words have 32 bits.
    pub(crate) known: Option<wgpu::Buffer>,
    pub(crate) depth: wgpu::TextureView,
}

impl Target {
    /// The buffers for pictures of the size of `view`.
    pub(crate) fn new(gpu: &Gpu, view: &View) -> Result<Self, Error> {
        let (width, height) = (view.width(), view.height());
        let pixels = u64::from(width) * u64::from(height);
        let (bytes, limit) = (pixels * 8, gpu.binding_bytes_max());
        if bytes > limit {
            let adapter = gpu.name().to_owned();
            return Err(Error::PictureTooLarge { width, height, bytes, limit, adapter });
        }
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width.max(height) > limit {
            let adapter = gpu.name().to_owned();
            return Err(Error::PictureTooWide { width, height, limit, adapter });
        }
        let camera_bytes = size_of::<CameraData>() as u64;
        let known = (!gpu.is_wide()).then(|| storage(gpu, "Target::known", pixels * 4));
        Ok(Self {
            view: view.clone(),
            camera: uniform(gpu, "Target::camera", camera_bytes)?,
            visibility: storage(gpu, "Target::visibility", pixels * 8)?,
            tiles: storage(gpu, "Target::tiles", u64::from(tiles(view)) * 8)?,
            outlook: storage(gpu, "Target::outlook", u64::from(tiles(view)) * 4)?,
            known: known.transpose()?,
            depth: depth(gpu, view)?,
        })
    }

    /// Whether pictures of this view fit.
    pub(crate) fn fits(&self, view: &View) -> bool {
        (self.view.width(), self.view.height()) == (view.width(), view.height())
    }

    /// Makes it the picture of nothing.
    pub(crate) fn restart(&mut self, gpu: &Gpu, view: &View, radius_min: f32) -> Result<(), Error> {
        self.view = view.clone();
        gpu.guard("a picture", || {
            let data = CameraData::new(view, radius_min);
            gpu.queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&data));
            let mut work = Work::new(gpu, "Target::restart");
            work.encoder.clear_buffer(&self.visibility, 0, None);
            if let Some(known) = &self.known {
                work.encoder.clear_buffer(known, 0, None);
            }
            work.submit();
        })
    }

    /// Where words have 32 bits, makes pixels whose depth has changed forget their ids. Returns whether
    /// they are to be drawn now, by drawing once more.
    pub(crate) fn claim(&self, work: &mut Work<'_>, claim: &Kernel) -> bool {
        let Some(known) = &self.known else { return false };
        let bindings = [
            (0, self.camera.as_entire_binding()),
            (9, self.visibility.as_entire_binding()),
            (10, known.as_entire_binding()),
        ];
        claim.run(work, &bindings, self.pixels());
        true
    }

    pub(crate) fn pixels(&self) -> u32 {
        self.view.width() * self.view.height()
    }
}

fn depth(gpu: &Gpu, view: &View) -> Result<wgpu::TextureView, Error> {
    gpu.guard("a depth buffer", || {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("Target::depth"),
            size: wgpu::Extent3d {
                width: view.width(),
                height: view.height(),
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    })
}
