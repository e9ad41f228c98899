//! Sizes that are counted on the device: dispatches take them there. Twin: sizes.wgsl.

use std::mem::offset_of;

use bytemuck::bytes_of;
use wgpu::BufferUsages;

use crate::compute_pass::{ComputePass, Workgroups};
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::{self, COUNTED_CHUNKS, COUNTED_ENTRIES, COUNTED_GROUPS};
use crate::pass_bindings;
use crate::pipelines::Orders;
use crate::variant::RayOrigin;

/// Numbers of entries, groups and chunks, at the places that the shader has for them.
pub(crate) type Numbers = [u32; 3];

/// Numbers of samples of a strip.
#[derive(Clone, Copy)]
pub(crate) struct Points {
    /// Those of the first step.
    pub first: u64,
    /// Those that there is room for in any step.
    pub most: u64,
}

pub(crate) const ENTRIES: usize = COUNTED_ENTRIES as usize;
pub(crate) const GROUPS: usize = COUNTED_GROUPS as usize;
pub(crate) const CHUNKS: usize = COUNTED_CHUNKS as usize;

/// What is counted in a room.
pub(crate) struct Sizes {
    pub buffer: wgpu::Buffer,
    /// Numbers that there is room for.
    pub capacity: Numbers,
    /// Numbers that there is to be room for: a quarter more than was needed.
    pub wanted: Numbers,
}

/// A pass that sizes dispatches.
pub(crate) type SizesPass = ComputePass<pass_bindings::Sizes<'static>>;

/// The pass that sizes dispatches by one of the numbers.
pub(crate) fn pass(orders: &mut Orders, counted: usize, seen: RayOrigin) -> SizesPass {
    let constants = [("COUNTED", counted as f64), seen.constant()];
    let entry_point = pass_bindings::Sizes::COUNT_SIZES;
    ComputePass::order(orders, "sizes", entry_point, &constants)
}

impl Sizes {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let copied = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let usage = BufferUsages::STORAGE | BufferUsages::INDIRECT | copied;
        let bytes = size_of::<layout::Sizes>() as u64;
        Ok(Self {
            buffer: gpu.buffer("sizes", bytes, usage).await?,
            capacity: [0; 3],
            wanted: [0; 3],
        })
    }

    /// Workgroups by one of the numbers: one for each block of entries that is sorted, for each group, or for each chunk.
    pub(crate) fn workgroups(&self, counted: usize) -> Workgroups {
        let each = offset_of!(layout::Sizes, groups) - offset_of!(layout::Sizes, blocks);
        let at = offset_of!(layout::Sizes, blocks) + counted * each;
        Workgroups::Counted(self.buffer.clone(), at as u64)
    }

    /// Tells the device how much room there is.
    pub(crate) fn set_capacity(&mut self, gpu: &Gpu, capacity: Numbers) {
        if self.capacity != capacity {
            self.capacity = capacity;
            let at = offset_of!(layout::Sizes, capacity) as u64;
            gpu.queue
                .write_buffer(&self.buffer, at, bytes_of(&capacity));
        }
    }

    /// Takes note of what was needed of strips that will have `1 / parts` of the rows.
    pub(crate) fn want(&mut self, gpu: &Gpu, needed: Numbers, parts: u32) {
        for ((wanted, needed), most) in self.wanted.iter_mut().zip(needed).zip(self.capacity) {
            if needed > most {
                *wanted = (needed / parts).saturating_add(needed / 4);
            }
        }
        let at = offset_of!(layout::Sizes, needed) as u64;
        gpu.queue
            .write_buffer(&self.buffer, at, bytes_of(&[0_u32; 3]));
    }
}
