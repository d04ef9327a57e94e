//! What an engine has before Arealight comes: a device, memory, commands and frames in flight. Nothing
//! optional is enabled: Vulkan 1.1 as every device has it.

use crate::Result;
use arealight_vk::gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use arealight_vk::gpu_allocator::{AllocationSizes, AllocatorDebugSettings};
use ash::vk;
use std::ffi::CStr;
use std::sync::{Arc, Mutex};

/// How many frames the CPU may be ahead of the GPU.
pub const FRAMES_IN_FLIGHT: usize = 2;

/// A Vulkan instance that destroys itself.
pub struct Instance {
    raw: ash::Instance,
    /// Where the instance comes from: a window's surface asks for it.
    pub entry: ash::Entry,
}

impl Instance {
    /// Opens Vulkan.
    ///
    /// # Errors
    /// Where there is no loader, or no driver.
    pub fn new() -> Result<Self> {
        Self::with(&[])
    }

    /// Opens Vulkan with extensions, such as those of a window.
    ///
    /// # Errors
    /// As [`Instance::new`], and where an extension is not there.
    pub fn with(extensions: &[&CStr]) -> Result<Self> {
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let info =
            vk::InstanceCreateInfo::default().application_info(&application).enabled_extension_names(&names);
        // SAFETY: the loader's initialisers are safe to run; the info outlives the call, and the entry the
        // instance.
        unsafe {
            let entry = ash::Entry::load()?;
            Ok(Self { raw: entry.create_instance(&info, None)?, entry })
        }
    }
}

impl std::ops::Deref for Instance {
    type Target = ash::Instance;

    fn deref(&self) -> &ash::Instance {
        &self.raw
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: a Gpu borrows the instance, so none is left.
        unsafe { self.raw.destroy_instance(None) };
    }
}

/// A device with a queue that draws and computes.
pub struct Gpu<'a> {
    /// Where the device comes from.
    pub instance: &'a ash::Instance,
    /// The first device that draws and computes.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: ash::Device,
    /// Its only queue.
    pub queue: vk::Queue,
    family: u32,
}

impl<'a> Gpu<'a> {
    /// Makes a device, with no extension and no feature.
    ///
    /// # Errors
    /// Where there is no device that draws and computes.
    pub fn new(instance: &'a ash::Instance) -> Result<Self> {
        Self::with(instance, &[], |_, _| true)
    }

    /// Makes the first device with a queue that draws, computes and `fits`, which is given the device and the
    /// queue's family; with extensions, such as that which presents to a window.
    ///
    /// # Errors
    /// Where there is none.
    pub fn with(
        instance: &'a ash::Instance,
        extensions: &[&CStr],
        fits: impl Fn(vk::PhysicalDevice, u32) -> bool,
    ) -> Result<Self> {
        let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        // SAFETY: the instance is alive for 'a; what infos point to outlives the calls.
        unsafe {
            let (physical_device, family) = instance
                .enumerate_physical_devices()?
                .into_iter()
                .find_map(|device| {
                    let families = instance.get_physical_device_queue_family_properties(device);
                    let does = |index: &u32| {
                        families[*index as usize].queue_flags.contains(needed) && fits(device, *index)
                    };
                    Some((device, (0..families.len() as u32).find(does)?))
                })
                .ok_or("no Vulkan device does on one queue all that is asked for")?;
            let queues =
                [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
            let info =
                vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
            let device = instance.create_device(physical_device, &info, None)?;
            let queue = device.get_device_queue(family, 0);
            Ok(Self { instance, physical_device, device, queue, family })
        }
    }

    /// An allocator for what owns memory of its own.
    ///
    /// # Errors
    /// Where the device has no memory that it could manage.
    pub fn allocator(&self) -> Result<Arc<Mutex<Allocator>>> {
        Ok(Arc::new(Mutex::new(Allocator::new(&AllocatorCreateDesc {
            instance: self.instance.clone(),
            device: self.device.clone(),
            physical_device: self.physical_device,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::default(),
        })?)))
    }

    /// Memory of a type that `requirements` allow and that has `flags`. A real engine takes many resources
    /// out of one allocation.
    fn allocate(
        &self,
        requirements: vk::MemoryRequirements,
        flags: vk::MemoryPropertyFlags,
    ) -> Result<vk::DeviceMemory> {
        // SAFETY: the handles are alive.
        let types = unsafe { self.instance.get_physical_device_memory_properties(self.physical_device) };
        let fits = |&(index, kind): &(usize, &vk::MemoryType)| {
            requirements.memory_type_bits & (1 << index) != 0 && kind.property_flags.contains(flags)
        };
        let (index, _) =
            types.memory_types_as_slice().iter().enumerate().find(fits).ok_or("no such memory")?;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(requirements.size)
            .memory_type_index(index as u32);
        // SAFETY: the device is alive.
        Ok(unsafe { self.device.allocate_memory(&info, None) }?)
    }

    /// Memory on the device for what has these requirements.
    ///
    /// # Errors
    /// Where there is none left.
    pub fn device_memory(&self, requirements: vk::MemoryRequirements) -> Result<Memory<'_>> {
        let raw = self.allocate(requirements, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
        Ok(Memory { gpu: self, raw })
    }

    /// A buffer that the CPU writes or reads.
    ///
    /// # Errors
    /// Where there is no memory left.
    pub fn buffer(&self, usage: vk::BufferUsageFlags, size: usize) -> Result<Buffer<'_>> {
        let info = vk::BufferCreateInfo::default().size(size as u64).usage(usage);
        let flags = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: the device is alive; the memory is for this buffer and is mapped once, until it is freed.
        unsafe {
            let mut buffer = Buffer {
                raw: self.device.create_buffer(&info, None)?,
                memory: Memory { gpu: self, raw: vk::DeviceMemory::null() },
                mapped: std::ptr::null_mut(),
                size,
            };
            let requirements = self.device.get_buffer_memory_requirements(buffer.raw);
            buffer.memory.raw = self.allocate(requirements, flags)?;
            self.device.bind_buffer_memory(buffer.raw, buffer.memory.raw, 0)?;
            buffer.mapped = self
                .device
                .map_memory(buffer.memory.raw, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?
                .cast();
            Ok(buffer)
        }
    }

    /// A buffer that holds these bytes.
    ///
    /// # Errors
    /// Where there is no memory left.
    pub fn filled_buffer(&self, usage: vk::BufferUsageFlags, bytes: &[u8]) -> Result<Buffer<'_>> {
        let buffer = self.buffer(usage, bytes.len())?;
        buffer.write(bytes)?;
        Ok(buffer)
    }

    /// An image to draw to.
    ///
    /// # Errors
    /// Where there is no memory left, or the device has no such images.
    pub fn image(&self, format: vk::Format, size: [u32; 2], usage: vk::ImageUsageFlags) -> Result<Image<'_>> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        let aspect_mask = if usage.contains(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT) {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        };
        let range =
            vk::ImageSubresourceRange { aspect_mask, level_count: 1, layer_count: 1, ..Default::default() };
        // SAFETY: the device is alive; the memory is for this image.
        unsafe {
            let mut image = Image {
                raw: self.device.create_image(&info, None)?,
                view: vk::ImageView::null(),
                format,
                memory: Memory { gpu: self, raw: vk::DeviceMemory::null() },
            };
            let requirements = self.device.get_image_memory_requirements(image.raw);
            image.memory.raw = self.allocate(requirements, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            self.device.bind_image_memory(image.raw, image.memory.raw, 0)?;
            let view = vk::ImageViewCreateInfo::default()
                .image(image.raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range);
            image.view = self.device.create_image_view(&view, None)?;
            Ok(image)
        }
    }

    /// A shader, which whoever asks for it destroys.
    ///
    /// # Errors
    /// Where memory is out.
    pub fn shader_module(&self, spirv: &[u8]) -> Result<vk::ShaderModule> {
        let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let words: Vec<u32> = spirv.chunks_exact(4).map(word).collect();
        // Without what the effects and the quality, constants of a shader that includes the library, rule out
        let words = arealight_vk::prune(&words, &[]);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the device is alive, and the words outlive the call.
        Ok(unsafe { self.device.create_shader_module(&info, None) }?)
    }
}

impl Drop for Gpu<'_> {
    fn drop(&mut self) {
        // SAFETY: everything of the device borrows this, so nothing is left.
        unsafe { self.device.destroy_device(None) };
    }
}

/// Memory that is freed when this is dropped.
pub struct Memory<'a> {
    gpu: &'a Gpu<'a>,
    /// The handle.
    pub raw: vk::DeviceMemory,
}

impl Drop for Memory<'_> {
    fn drop(&mut self) {
        // SAFETY: owners drop their memory last, when no work is pending.
        unsafe { self.gpu.device.free_memory(self.raw, None) };
    }
}

/// A buffer that stays mapped.
pub struct Buffer<'a> {
    /// The handle.
    pub raw: vk::Buffer,
    mapped: *mut u8,
    size: usize,
    memory: Memory<'a>,
}

impl Buffer<'_> {
    /// Copies to the beginning of the buffer, which no pending work may read.
    ///
    /// # Errors
    /// Where the buffer is too small.
    pub fn write(&self, bytes: &[u8]) -> Result<()> {
        if bytes.len() > self.size {
            return Err(format!("{} bytes do not fit into a buffer of {}", bytes.len(), self.size).into());
        }
        // SAFETY: the memory is mapped, and holds so many bytes.
        unsafe { self.mapped.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
        Ok(())
    }

    /// What the buffer holds, which no pending work may write.
    pub fn read(&self) -> &[u8] {
        // SAFETY: the memory is mapped, coherent and of this size.
        unsafe { std::slice::from_raw_parts(self.mapped, self.size) }
    }
}

impl Drop for Buffer<'_> {
    fn drop(&mut self) {
        // SAFETY: owners wait for pending work first.
        unsafe { self.memory.gpu.device.destroy_buffer(self.raw, None) };
    }
}

/// An image of one level and layer, with a view.
pub struct Image<'a> {
    /// The handle.
    pub raw: vk::Image,
    /// A view of all of it.
    pub view: vk::ImageView,
    /// What a texel is.
    pub format: vk::Format,
    memory: Memory<'a>,
}

impl Drop for Image<'_> {
    fn drop(&mut self) {
        // SAFETY: owners wait for pending work first.
        unsafe {
            self.memory.gpu.device.destroy_image_view(self.view, None);
            self.memory.gpu.device.destroy_image(self.raw, None);
        }
    }
}

/// What the commands of a frame wait for, and what they say when they are done, beside their fence; nothing
/// by default.
#[derive(Debug, Clone, Copy, Default)]
pub struct Semaphores {
    /// What is waited for, and the stage that does.
    pub wait: Option<(vk::Semaphore, vk::PipelineStageFlags)>,
    /// What is signalled.
    pub signal: Option<vk::Semaphore>,
}

/// Command buffers and fences of the frames in flight.
pub struct Frames<'a> {
    gpu: &'a Gpu<'a>,
    pool: vk::CommandPool,
    slots: Vec<(vk::CommandBuffer, vk::Fence)>,
    next: usize,
}

impl<'a> Frames<'a> {
    /// Makes [`FRAMES_IN_FLIGHT`] of each.
    ///
    /// # Errors
    /// Where memory is out.
    pub fn new(gpu: &'a Gpu<'a>) -> Result<Self> {
        let device = &gpu.device;
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER)
            .queue_family_index(gpu.family);
        let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: the device is alive.
        unsafe {
            let pool = device.create_command_pool(&info, None)?;
            let mut frames = Self { gpu, pool, slots: vec![], next: 0 };
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES_IN_FLIGHT as u32);
            for commands in device.allocate_command_buffers(&info)? {
                frames.slots.push((commands, device.create_fence(&signaled, None)?));
            }
            Ok(frames)
        }
    }

    /// Waits until the oldest frame in flight is done, records another in its place, and submits it. `record`
    /// is given the place, whose resources are free now, and the commands.
    ///
    /// # Errors
    /// Those of `record`, and of the device.
    pub fn submit(&mut self, record: impl FnOnce(usize, vk::CommandBuffer) -> Result<()>) -> Result<()> {
        self.submit_with(|place, commands| record(place, commands).map(|()| Semaphores::default()))
    }

    /// Likewise with the semaphores that `record` returns.
    ///
    /// # Errors
    /// As [`Frames::submit`].
    pub fn submit_with(
        &mut self,
        record: impl FnOnce(usize, vk::CommandBuffer) -> Result<Semaphores>,
    ) -> Result<()> {
        let device = &self.gpu.device;
        let place = self.next;
        let (commands, fence) = self.slots[place];
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the fence says that the commands' last use is over; it is reset only when they are
        // complete.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.begin_command_buffer(commands, &begin)?;
            let semaphores = match record(place, commands) {
                Ok(semaphores) => semaphores,
                Err(error) => {
                    // What was begun cannot be begun again before it is reset
                    device.reset_command_buffer(commands, vk::CommandBufferResetFlags::empty())?;
                    return Err(error);
                }
            };
            device.end_command_buffer(commands)?;
            device.reset_fences(&[fence])?;
            let buffers = [commands];
            let (waits, stages): (Vec<_>, Vec<_>) = semaphores.wait.into_iter().unzip();
            let signals: Vec<_> = semaphores.signal.into_iter().collect();
            let submit = [vk::SubmitInfo::default()
                .command_buffers(&buffers)
                .wait_semaphores(&waits)
                .wait_dst_stage_mask(&stages)
                .signal_semaphores(&signals)];
            if let Err(error) = device.queue_submit(self.gpu.queue, &submit, fence) {
                // Nobody would signal the fence; what waits for it next must not wait for ever
                device.destroy_fence(fence, None);
                self.slots[place].1 = vk::Fence::null();
                let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
                self.slots[place].1 = device.create_fence(&signaled, None)?;
                return Err(error.into());
            }
        }
        self.next = (place + 1) % self.slots.len();
        Ok(())
    }

    /// Records commands, submits them and waits until they are done, and every frame in flight with them.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn run(&mut self, record: impl FnOnce(vk::CommandBuffer)) -> Result<()> {
        self.submit_with(|_, commands| {
            record(commands);
            Ok(Semaphores::default())
        })?;
        self.wait()
    }

    /// Waits for every frame in flight.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn wait(&self) -> Result<()> {
        let fences: Vec<_> = self.slots.iter().map(|(_, fence)| *fence).collect();
        // SAFETY: the fences are ours.
        Ok(unsafe { self.gpu.device.wait_for_fences(&fences, true, u64::MAX) }?)
    }
}

impl Drop for Frames<'_> {
    fn drop(&mut self) {
        // A lost device has no work left either
        let _ = self.wait();
        // SAFETY: nothing is pending.
        unsafe {
            for (_, fence) in &self.slots {
                self.gpu.device.destroy_fence(*fence, None);
            }
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}

/// A pool of descriptor sets, which go with it.
pub struct DescriptorPool<'a> {
    gpu: &'a Gpu<'a>,
    raw: vk::DescriptorPool,
}

impl<'a> DescriptorPool<'a> {
    /// Makes a pool for [`FRAMES_IN_FLIGHT`] sets that together take `sizes`.
    ///
    /// # Errors
    /// Where memory is out.
    pub fn new(gpu: &'a Gpu<'a>, sizes: &[vk::DescriptorPoolSize]) -> Result<Self> {
        let info =
            vk::DescriptorPoolCreateInfo::default().max_sets(FRAMES_IN_FLIGHT as u32).pool_sizes(sizes);
        // SAFETY: the device is alive.
        Ok(Self { gpu, raw: unsafe { gpu.device.create_descriptor_pool(&info, None) }? })
    }

    /// Allocates a set.
    ///
    /// # Errors
    /// Where the pool is used up.
    ///
    /// # Safety
    /// The layout is the device's.
    pub unsafe fn allocate(&self, layout: vk::DescriptorSetLayout) -> Result<vk::DescriptorSet> {
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.raw).set_layouts(&layouts);
        // SAFETY: the caller vouches for the layout.
        Ok(unsafe { self.gpu.device.allocate_descriptor_sets(&info) }?[0])
    }
}

impl Drop for DescriptorPool<'_> {
    fn drop(&mut self) {
        // SAFETY: owners drop it when no frame that uses its sets is in flight.
        unsafe { self.gpu.device.destroy_descriptor_pool(self.raw, None) };
    }
}
