//! A ring of mapped buffers: a thread fills one while the device copies from another.

use crate::ways::PIECE;
use anyhow::{Context, Result};
use puncta::{Gpu, gpu::wgpu};
use std::{
    sync::mpsc::{self, Receiver, Sender},
    thread,
};

/// How many buffers there are.
const RING: usize = 3;

/// The buffers; those that can be filled come back through a channel.
#[derive(Debug)]
pub(crate) struct Ring {
    back: Sender<wgpu::Buffer>,
    free: Receiver<wgpu::Buffer>,
}

impl Ring {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let (back, free) = mpsc::channel();
        for _ in 0..RING {
            let made = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("Ring::staging"),
                size: PIECE as u64,
                usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: true,
            });
            // The other end is in this function.
            back.send(made).ok();
        }
        Self { back, free }
    }

    pub(crate) fn bring(&self, gpu: &Gpu, target: &wgpu::Buffer, bytes: &[u8]) -> Result<()> {
        let mut pieces = bytes.chunks(PIECE).zip((0_u64..).step_by(PIECE));
        thread::scope(|scope| {
            let (jobs, waiting) = mpsc::channel::<(wgpu::Buffer, u64, &[u8])>();
            let (done, filled) = mpsc::channel();
            scope.spawn(move || {
                for (staging, offset, piece) in waiting {
                    let result = fill(&staging, piece);
                    if done.send((staging, offset, piece.len() as u64, result)).is_err() {
                        break;
                    }
                }
            });
            let (mut under_way, mut rest) = (0, bytes.len());
            loop {
                // One buffer is left for the device.
                while under_way < RING - 1 && rest > 0 {
                    let staging = self.next(gpu)?;
                    let Some((piece, offset)) = pieces.next() else { break };
                    jobs.send((staging, offset, piece)).ok();
                    under_way += 1;
                    rest -= piece.len();
                }
                if under_way == 0 {
                    return Ok(());
                }
                let (staging, offset, size, result) = filled.recv()?;
                under_way -= 1;
                result?;
                staging.unmap();
                let mut encoder = gpu.device().create_command_encoder(&Default::default());
                encoder.copy_buffer_to_buffer(&staging, 0, target, offset, size);
                gpu.queue().submit([encoder.finish()]);
                let (back, handle) = (self.back.clone(), staging.clone());
                staging.map_async(wgpu::MapMode::Write, .., move |result| {
                    if result.is_ok() {
                        back.send(handle).ok();
                    }
                });
            }
        })
    }

    /// A buffer that can be filled.
    fn next(&self, gpu: &Gpu) -> Result<wgpu::Buffer> {
        if let Ok(free) = self.free.try_recv() {
            return Ok(free);
        }
        gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
        self.free.try_recv().context("no staging buffer came back")
    }
}

fn fill(staging: &wgpu::Buffer, piece: &[u8]) -> Result<()> {
    let mut view = staging.get_mapped_range_mut(..piece.len() as u64)?;
    view.copy_from_slice(piece);
    Ok(())
}
