//! A picture that is being drawn: its buffers, and what is known of its content.

use crate::{
    Error, Gpu,
    kernel::{Work, storage},
    table::Table,
    target::Target,
};
use puncta_core::{Camera, Content, Record, View};

/// A picture that is being drawn.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) target: Target,
    pub(crate) content: Option<Key>,
    pub(crate) camera: Option<Camera>,
    pub(crate) table: Table,
    /// By brick, whether it was drawn.
    pub(crate) drawn: wgpu::Buffer,
    /// The bricks that records may be seen of.
    pub(crate) touched: Vec<bool>,
    pub(crate) has_drawn: bool,
    pub(crate) have_tiles: bool,
    pub(crate) are_tiles_fresh: bool,
    pub(crate) has_depth: bool,
    pub(crate) has_outlook: bool,
}

/// The place in the world and in memory of what is drawn, and how much it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Key {
    origin: glam::DVec3,
    records: (u64, u64, usize),
    pub(crate) bricks: (usize, usize),
}

impl Key {
    pub(crate) fn of<R: Record>(content: &Content<'_, R>) -> Self {
        Self {
            origin: content.scene.origin,
            records: crate::store::key(content.scene),
            bricks: (content.bricks.as_ptr() as usize, content.bricks.len()),
        }
    }
}

impl Frame {
    pub(crate) fn new(gpu: &Gpu, view: &View) -> Result<Self, Error> {
        Ok(Self {
            target: Target::new(gpu, view)?,
            content: None,
            camera: None,
            table: Table::default(),
            drawn: storage(gpu, "Frame::drawn", 16)?,
            touched: Vec::new(),
            has_drawn: false,
            have_tiles: false,
            are_tiles_fresh: false,
            has_depth: false,
            has_outlook: false,
        })
    }

    pub(crate) fn restart(&mut self, gpu: &Gpu, view: &View, radius_min: f32) -> Result<(), Error> {
        (self.content, self.camera) = (None, None);
        self.touched.clear();
        self.has_drawn = false;
        (self.have_tiles, self.are_tiles_fresh) = (false, false);
        (self.has_depth, self.has_outlook) = (false, false);
        self.target.restart(gpu, view, radius_min)
    }

    /// Whether this is what was drawn.
    pub(crate) fn is_of<R: Record>(&self, content: &Content<'_, R>) -> bool {
        self.content == Some(Key::of(content))
    }

    /// Gets ready for this content.
    pub(crate) fn prepare<R: Record>(
        &mut self,
        gpu: &Gpu,
        content: &Content<'_, R>,
    ) -> Result<(), Error> {
        let key = Key::of(content);
        match self.content {
            Some(known) if known == key => return Ok(()),
            Some(_) => return Err(Error::OtherContent),
            None => {}
        }
        let bytes = content.bricks.len() as u64 * 4;
        if self.drawn.size() < bytes {
            self.drawn = storage(gpu, "Frame::drawn", bytes)?;
        }
        gpu.guard("bricks", || {
            let mut work = Work::new(gpu, "Frame::prepare");
            work.encoder.clear_buffer(&self.drawn, 0, None);
            work.submit();
        })?;
        self.table.clear(content.bricks.len());
        self.touched.resize(content.bricks.len(), false);
        self.camera = Some(Camera::new(&self.target.view, content.scene.origin));
        self.content = Some(key);
        Ok(())
    }
}
