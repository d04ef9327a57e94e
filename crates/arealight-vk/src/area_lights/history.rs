//! What is kept of shadows from frame to frame.

use crate::context::{COPIED, Context, USED, WRITTEN};
use crate::error::Error;
use crate::memory::{Buffer, SharedAllocator};
use arealight::plan;
use ash::vk;
use glam::{DVec3, Vec3};
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// A buffer that every frame reads and writes, whatever its place.
pub(super) struct History {
    pub(super) buffer: Arc<Buffer>,
    /// Of the pictures, in pixels.
    pub(super) size: [u32; 2],
    /// What positions of the frame before were relative to; none where nothing is to be known of it.
    pub(super) before: Option<DVec3>,
}

impl History {
    /// # Safety
    /// As [`Buffer::new`].
    pub(super) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let what = (plan::shadow_history_size(size), MemoryLocation::GpuOnly);
        // SAFETY: the same contract.
        let buffer = unsafe { Buffer::new(context, allocator, usage, what) }?;
        Ok(Self { buffer: Arc::new(buffer), size, before: None })
    }

    /// [`crate::ShadowFrame::origin_shift`] of a frame.
    pub(super) fn origin_shift(&self, origin: DVec3) -> Vec3 {
        self.before.map_or(Vec3::ZERO, |before| (origin - before).as_vec3())
    }

    /// Records that nothing is known, where that is so.
    ///
    /// # Safety
    /// The command buffer is recording, outside a render pass.
    pub(super) unsafe fn record_beginning(&self, context: &Context, command_buffer: vk::CommandBuffer) {
        if self.before.is_none() {
            // SAFETY: the same contract; the frames before may still use the buffer.
            unsafe {
                context.record_barrier(command_buffer, WRITTEN, COPIED);
                context.device.cmd_fill_buffer(command_buffer, self.buffer.raw, 0, vk::WHOLE_SIZE, 0);
                context.record_barrier(command_buffer, COPIED, USED);
            }
        }
    }
}
