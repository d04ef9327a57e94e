//! Submission of one-time commands, barriers between them, and how long they took.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use ash::vk::{self, AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
use std::time::Duration;

/// How something is used: the stage, the access and, of an image, the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Usage {
    /// The stage that uses it.
    pub stage: Stage,
    /// What that stage does.
    pub access: Access,
    /// The layout that an image is in; buffers ignore it.
    pub layout: Layout,
}

impl Usage {
    /// Not used yet: an image's contents may be thrown away.
    pub const UNDEFINED: Self = Self::of(Stage::TOP_OF_PIPE, Access::NONE, Layout::UNDEFINED);
    /// Copied from.
    pub const COPY_SOURCE: Self =
        Self::of(Stage::TRANSFER, Access::TRANSFER_READ, Layout::TRANSFER_SRC_OPTIMAL);
    /// Copied or cleared to.
    pub const COPY_DESTINATION: Self =
        Self::of(Stage::TRANSFER, Access::TRANSFER_WRITE, Layout::TRANSFER_DST_OPTIMAL);
    /// Read by a compute shader, an image as a sampled one.
    pub const COMPUTE_READ: Self =
        Self::of(Stage::COMPUTE_SHADER, Access::SHADER_READ, Layout::SHADER_READ_ONLY_OPTIMAL);
    /// Read and written by a compute shader, an image as a storage image.
    pub const COMPUTE_WRITE: Self = Self::of(
        Stage::COMPUTE_SHADER,
        Access::from_raw(Access::SHADER_READ.as_raw() | Access::SHADER_WRITE.as_raw()),
        Layout::GENERAL,
    );

    const fn of(stage: Stage, access: Access, layout: Layout) -> Self {
        Self { stage, access, layout }
    }
}

impl Host {
    /// Records commands, submits them and waits until the GPU has done them. Everything written by commands
    /// is visible to later submissions and to the CPU.
    ///
    /// # Errors
    /// [`HostError::TimedOut`], [`HostError::DeviceLost`], [`HostError::OutOfMemory`].
    pub fn submit(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<(), HostError> {
        self.try_submit(|commands| {
            record(commands);
            Ok(())
        })
    }

    /// As [`Host::submit`], for a recording that can fail: then nothing is submitted.
    ///
    /// # Errors
    /// The recording's, and those of [`Host::submit`].
    pub fn try_submit<E: From<HostError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<(), E> {
        self.run(record, None).map(|_| ())
    }

    /// As [`Host::try_submit`], and measures how long the GPU took from the first command to the last. `None`
    /// where the queue has no timestamps.
    ///
    /// # Errors
    /// The recording's, and those of [`Host::submit`].
    pub fn try_submit_timed<E: From<HostError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<Option<Duration>, E> {
        if self.timestamp_valid_bits() == 0 {
            return self.run(record, None);
        }
        let stopwatch = Stopwatch::new(self)?;
        self.run(record, Some(&stopwatch))
    }

    fn run<E: From<HostError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
        stopwatch: Option<&Stopwatch<'_>>,
    ) -> Result<Option<Duration>, E> {
        let submission = Submission::new(self)?;
        submission.begin()?;
        if let Some(stopwatch) = stopwatch {
            stopwatch.start(submission.commands);
        }
        record(submission.commands)?;
        if let Some(stopwatch) = stopwatch {
            stopwatch.stop(submission.commands);
        }
        submission.finish()?;
        Ok(stopwatch.map(Stopwatch::elapsed).transpose()?)
    }

    /// Records a barrier for all memory: what `before` wrote is there for `after`. Layouts are left alone.
    pub fn barrier(&self, commands: vk::CommandBuffer, before: Usage, after: Usage) {
        let barrier =
            [vk::MemoryBarrier::default().src_access_mask(before.access).dst_access_mask(after.access)];
        let flags = vk::DependencyFlags::empty();
        // SAFETY: The commands are being recorded; the stages belong to a queue that computes.
        unsafe {
            self.device().cmd_pipeline_barrier(
                commands,
                before.stage,
                after.stage,
                flags,
                &barrier,
                &[],
                &[],
            );
        }
    }
}

/// A pool with one command buffer, and the fence it signals. A pool each: pools are not for several threads.
struct Submission<'a> {
    host: &'a Host,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
}

impl<'a> Submission<'a> {
    fn new(host: &'a Host) -> Result<Self, HostError> {
        if host.is_abandoned() {
            return Err(HostError::TimedOut { timeout: host.timeout() });
        }
        let device = host.device();
        let mut submission = Self {
            host,
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
        };
        let pool_info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(host.queue_family());
        // SAFETY: The device is alive and the infos are valid; so for all three calls.
        unsafe {
            submission.pool = device.create_command_pool(&pool_info, None).named("vkCreateCommandPool")?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(submission.pool)
                .command_buffer_count(1);
            let buffers = device.allocate_command_buffers(&info).named("vkAllocateCommandBuffers")?;
            submission.commands = buffers.first().copied().unwrap_or_default();
            let fence_info = vk::FenceCreateInfo::default();
            submission.fence = device.create_fence(&fence_info, None).named("vkCreateFence")?;
        }
        Ok(submission)
    }

    fn begin(&self) -> Result<(), HostError> {
        let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: The command buffer was just allocated.
        unsafe { self.host.device().begin_command_buffer(self.commands, &info) }.named("vkBeginCommandBuffer")
    }

    /// Makes all writes visible to the CPU and to whatever comes later, submits, and waits.
    fn finish(&self) -> Result<(), HostError> {
        let device = self.host.device();
        let everything = Usage::of(Stage::ALL_COMMANDS, Access::MEMORY_WRITE, Layout::UNDEFINED);
        let access = Access::MEMORY_READ | Access::MEMORY_WRITE | Access::HOST_READ;
        let anything = Usage::of(Stage::ALL_COMMANDS | Stage::HOST, access, Layout::UNDEFINED);
        self.host.barrier(self.commands, everything, anything);
        // SAFETY: The command buffer is being recorded.
        unsafe { device.end_command_buffer(self.commands) }.named("vkEndCommandBuffer")?;
        let buffers = [self.commands];
        let info = [vk::SubmitInfo::default().command_buffers(&buffers)];
        {
            let queue = self.host.queue();
            // SAFETY: The queue is locked; the command buffer is recorded and the fence unsignalled.
            unsafe { device.queue_submit(*queue, &info, self.fence) }.named("vkQueueSubmit")?;
        }
        let timeout = self.host.timeout();
        let nanoseconds = u64::try_from(timeout.as_nanos()).unwrap_or(u64::MAX);
        // SAFETY: The fence is of this device and was submitted.
        match unsafe { device.wait_for_fences(&[self.fence], true, nanoseconds) } {
            Err(vk::Result::TIMEOUT) => {
                self.host.abandon();
                Err(HostError::TimedOut { timeout })
            }
            waited => waited.named("vkWaitForFences"),
        }
    }
}

impl Drop for Submission<'_> {
    fn drop(&mut self) {
        if self.host.is_abandoned() {
            return;
        }
        // SAFETY: The GPU has finished with both, or never began; the pool frees its command buffer.
        unsafe {
            self.host.device().destroy_fence(self.fence, None);
            self.host.device().destroy_command_pool(self.pool, None);
        }
    }
}

/// Two timestamps around commands.
struct Stopwatch<'a> {
    host: &'a Host,
    queries: vk::QueryPool,
}

impl<'a> Stopwatch<'a> {
    fn new(host: &'a Host) -> Result<Self, HostError> {
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
        // SAFETY: The device is alive and its queue has timestamps.
        let queries = unsafe { host.device().create_query_pool(&info, None) }.named("vkCreateQueryPool")?;
        Ok(Self { host, queries })
    }

    fn start(&self, commands: vk::CommandBuffer) {
        let device = self.host.device();
        // SAFETY: The commands are being recorded, outside of any query.
        unsafe {
            device.cmd_reset_query_pool(commands, self.queries, 0, 2);
            device.cmd_write_timestamp(commands, vk::PipelineStageFlags::TOP_OF_PIPE, self.queries, 0);
        }
    }

    fn stop(&self, commands: vk::CommandBuffer) {
        let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
        // SAFETY: The commands are being recorded, and the query was reset by `start`.
        unsafe { self.host.device().cmd_write_timestamp(commands, stage, self.queries, 1) };
    }

    /// The time between the timestamps, of a finished submission.
    fn elapsed(&self) -> Result<Duration, HostError> {
        let mut ticks = [0_u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: Both queries were written, and the array holds a 64-bit result for each.
        unsafe { self.host.device().get_query_pool_results(self.queries, 0, &mut ticks, flags) }
            .named("vkGetQueryPoolResults")?;
        let period = self.host.properties().limits.timestamp_period;
        Ok(between(ticks, self.host.timestamp_valid_bits(), period))
    }
}

impl Drop for Stopwatch<'_> {
    fn drop(&mut self) {
        if !self.host.is_abandoned() {
            // SAFETY: The pool is of this device, and the submission that used it has finished.
            unsafe { self.host.device().destroy_query_pool(self.queries, None) };
        }
    }
}

/// The time between two timestamps of `valid_bits` that may have wrapped; `period` is nanoseconds a tick.
fn between(ticks: [u64; 2], valid_bits: u32, period: f32) -> Duration {
    let mask = u64::MAX >> (64 - valid_bits.clamp(1, 64));
    let passed = ticks[1].wrapping_sub(ticks[0]) & mask;
    Duration::from_nanos((passed as f64 * f64::from(period)) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_become_time_and_may_wrap() {
        assert_eq!(between([100, 350], 64, 2.0), Duration::from_nanos(500));
        assert_eq!(between([u64::MAX, 1], 64, 1.0), Duration::from_nanos(2));
        // Of 36 valid bits those above are noise.
        let noise = 5 << 36;
        assert_eq!(between([noise | ((1 << 36) - 10), 20], 36, 1.0), Duration::from_nanos(30));
    }
}
