//! Frames in flight: the CPU records one while the GPU does the one before.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use ash::vk;

/// How many frames the CPU may be ahead of the GPU.
pub const FRAMES_IN_FLIGHT: usize = 2;

/// What the commands of a frame wait for, and what they say when they are done, besides their fence; nothing
/// by default.
#[derive(Debug, Clone, Copy, Default)]
pub struct Semaphores {
    /// What is waited for, and the stage that does.
    pub wait: Option<(vk::Semaphore, vk::PipelineStageFlags)>,
    /// What is signalled.
    pub signal: Option<vk::Semaphore>,
}

/// Command buffers and fences of the frames in flight. It waits for them when it is dropped.
pub struct Frames {
    host: Host,
    pool: vk::CommandPool,
    slots: Vec<(vk::CommandBuffer, vk::Fence)>,
    next: usize,
}

impl Frames {
    /// Makes [`FRAMES_IN_FLIGHT`] of each.
    pub fn new(host: &Host) -> Result<Self, HostError> {
        let device = host.device();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER)
            .queue_family_index(host.queue_family());
        // SAFETY: The device is alive.
        unsafe {
            let pool = device.create_command_pool(&info, None).named("vkCreateCommandPool")?;
            let mut frames = Self { host: host.clone(), pool, slots: vec![], next: 0 };
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES_IN_FLIGHT as u32);
            for commands in device.allocate_command_buffers(&info).named("vkAllocateCommandBuffers")? {
                frames.slots.push((commands, signaled_fence(host)?));
            }
            Ok(frames)
        }
    }

    /// Waits until the oldest frame in flight is done, records another in its place, and submits it. `record`
    /// is given the place, whose resources are free now, and the commands.
    ///
    /// # Errors
    /// Those of `record`, and of the device.
    pub fn submit<E: From<HostError>>(
        &mut self,
        record: impl FnOnce(usize, vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<(), E> {
        self.submit_with(|place, commands| record(place, commands).map(|()| Semaphores::default()))
    }

    /// The same with the semaphores that `record` returns.
    pub fn submit_with<E: From<HostError>>(
        &mut self,
        record: impl FnOnce(usize, vk::CommandBuffer) -> Result<Semaphores, E>,
    ) -> Result<(), E> {
        let device = self.host.device();
        let place = self.next;
        let (commands, fence) = self.slots[place];
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: The fence says that the commands' last use is over.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX).named("vkWaitForFences")?;
            device.begin_command_buffer(commands, &begin).named("vkBeginCommandBuffer")?;
        }
        let semaphores = record(place, commands).inspect_err(|_| {
            let no_flags = vk::CommandBufferResetFlags::empty();
            // What was begun cannot be begun again before it is reset; the next frame says where that fails
            // SAFETY: The commands were never submitted.
            let _ = unsafe { device.reset_command_buffer(commands, no_flags) };
        })?;
        // SAFETY: The commands are recorded; the fence is reset only when they are complete.
        unsafe {
            device.end_command_buffer(commands).named("vkEndCommandBuffer")?;
            device.reset_fences(&[fence]).named("vkResetFences")?;
        }
        let submitted = self.queue(commands, fence, semaphores);
        if submitted.is_err() {
            // Nobody would signal the fence; what waits for it next must not wait for ever
            // SAFETY: Nothing uses the fence.
            unsafe { device.destroy_fence(fence, None) };
            self.slots[place].1 = vk::Fence::null();
            self.slots[place].1 = signaled_fence(&self.host)?;
        }
        self.next = (place + 1) % self.slots.len();
        Ok(submitted?)
    }

    fn queue(
        &self,
        commands: vk::CommandBuffer,
        fence: vk::Fence,
        semaphores: Semaphores,
    ) -> Result<(), HostError> {
        let buffers = [commands];
        let (waits, stages): (Vec<_>, Vec<_>) = semaphores.wait.into_iter().unzip();
        let signals: Vec<_> = semaphores.signal.into_iter().collect();
        let submit = [vk::SubmitInfo::default()
            .command_buffers(&buffers)
            .wait_semaphores(&waits)
            .wait_dst_stage_mask(&stages)
            .signal_semaphores(&signals)];
        let queue = self.host.queue();
        // SAFETY: The queue is locked; the commands are recorded and the fence unsignalled.
        unsafe { self.host.device().queue_submit(*queue, &submit, fence) }.named("vkQueueSubmit")
    }

    /// Waits for every frame in flight.
    pub fn wait(&self) -> Result<(), HostError> {
        let fences: Vec<_> = self.slots.iter().map(|(_, fence)| *fence).collect();
        // SAFETY: The fences are ours.
        unsafe { self.host.device().wait_for_fences(&fences, true, u64::MAX) }.named("vkWaitForFences")
    }
}

fn signaled_fence(host: &Host) -> Result<vk::Fence, HostError> {
    let info = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
    // SAFETY: The device is alive.
    unsafe { host.device().create_fence(&info, None) }.named("vkCreateFence")
}

impl Drop for Frames {
    fn drop(&mut self) {
        // What hangs is not waited for, nor destroyed; a lost device has no work left either
        if self.host.is_abandoned() {
            return;
        }
        let _ = self.wait();
        let device = self.host.device();
        // SAFETY: Nothing is pending.
        unsafe {
            self.slots.iter().for_each(|(_, fence)| device.destroy_fence(*fence, None));
            device.destroy_command_pool(self.pool, None);
        }
    }
}
