//! Memory through the gpu-allocator crate.

use crate::context::{Context, color_range};
use crate::error::{Error, VulkanCall};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Allocates for an image's `requirements`, and binds it by `bind`. Where that fails, the memory is given
/// back.
pub(crate) fn allocate(
    allocator: &mut Allocator,
    name: &str,
    requirements: vk::MemoryRequirements,
    bind: impl FnOnce(vk::DeviceMemory, vk::DeviceSize) -> Result<(), Error>,
) -> Result<Allocation, Error> {
    allocate_at(allocator, name, (requirements, MemoryLocation::GpuOnly, false), bind)
}

fn allocate_at(
    allocator: &mut Allocator,
    name: &str,
    (requirements, location, linear): (vk::MemoryRequirements, MemoryLocation, bool),
    bind: impl FnOnce(vk::DeviceMemory, vk::DeviceSize) -> Result<(), Error>,
) -> Result<Allocation, Error> {
    let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
    let allocation = allocator
        .allocate(&AllocationCreateDesc { name, requirements, location, linear, allocation_scheme })
        .map_err(|_| Error::Vulkan {
            call: "gpu_allocator::Allocator::allocate",
            result: vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
        })?;
    // SAFETY: the handle is only passed on; whoever binds it keeps the allocation.
    let memory = unsafe { allocation.memory() };
    match bind(memory, allocation.offset()) {
        Ok(()) => Ok(allocation),
        Err(error) => {
            // Giving back what was just taken can fail only for a foreign allocation
            let _ = allocator.free(allocation);
            Err(error)
        }
    }
}

/// An allocator that what was allocated shares, to give it back.
#[derive(Clone)]
pub(crate) struct SharedAllocator(pub(crate) Arc<Mutex<Allocator>>);

impl SharedAllocator {
    pub(crate) fn lock(&self) -> MutexGuard<'_, Allocator> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Memory that is given back when it is dropped.
    pub(crate) fn keep(&self, allocation: Allocation) -> Memory {
        Memory { allocator: self.clone(), allocation: Some(allocation) }
    }
}

/// Memory that is given back when it is dropped. What is bound to it is dropped before.
pub(crate) struct Memory {
    allocator: SharedAllocator,
    allocation: Option<Allocation>,
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take() {
            // Only a foreign allocation cannot be freed
            let _ = self.allocator.lock().free(allocation);
        }
    }
}

/// A buffer with memory.
pub(crate) struct Buffer {
    context: Context,
    pub(crate) raw: vk::Buffer,
    pub(crate) size: vk::DeviceSize,
    memory: Option<Memory>,
}

impl Buffer {
    /// In memory of the device, or mapped.
    ///
    /// # Safety
    /// It is dropped when no pending work uses it, before the device.
    pub(crate) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        usage: vk::BufferUsageFlags,
        (size, location): (vk::DeviceSize, MemoryLocation),
    ) -> Result<Self, Error> {
        let device = &context.device;
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is valid by the contract of Context::new, here and below.
        let raw = unsafe { device.create_buffer(&info, None) }.call("vkCreateBuffer")?;
        // From here on dropping it destroys it
        let mut buffer = Self { context: context.clone(), raw, size, memory: None };
        // SAFETY: as above.
        let requirements = unsafe { device.get_buffer_memory_requirements(raw) };
        let bind = |memory, offset| {
            // SAFETY: the memory was allocated for this buffer.
            unsafe { device.bind_buffer_memory(raw, memory, offset) }.call("vkBindBufferMemory")
        };
        let what = (requirements, location, true);
        let allocation = allocate_at(&mut allocator.lock(), "arealight buffer", what, bind)?;
        buffer.memory = Some(allocator.keep(allocation));
        Ok(buffer)
    }

    /// Writes to the beginning of a mapped buffer that is as large, and that no pending work uses.
    pub(crate) fn write(&mut self, bytes: &[u8]) {
        let allocation = self.memory.as_mut().and_then(|memory| memory.allocation.as_mut());
        if let Some(mapped) = allocation.and_then(Allocation::mapped_slice_mut) {
            mapped[..bytes.len()].copy_from_slice(bytes);
        }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: by the contract of Buffer::new.
        unsafe { self.context.device.destroy_buffer(self.raw, None) };
    }
}

/// An image that shaders store to, with a view and memory.
pub(crate) struct Image {
    context: Context,
    pub(crate) raw: vk::Image,
    pub(crate) view: vk::ImageView,
    pub(crate) extent: [u32; 3],
    memory: Option<Memory>,
}

impl Image {
    /// # Safety
    /// As [`Buffer::new`].
    pub(crate) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        format: vk::Format,
        extent: [u32; 3],
        image_type: vk::ImageType,
    ) -> Result<Self, Error> {
        let device = &context.device;
        let [width, height, depth] = extent;
        let info = vk::ImageCreateInfo::default()
            .image_type(image_type)
            .format(format)
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::STORAGE);
        // SAFETY: the device is valid by the contract of Context::new, here and below.
        let raw = unsafe { device.create_image(&info, None) }.call("vkCreateImage")?;
        let view = vk::ImageView::null();
        // From here on dropping it destroys it
        let mut image = Self { context: context.clone(), raw, view, extent, memory: None };
        // SAFETY: as above.
        let requirements = unsafe { device.get_image_memory_requirements(raw) };
        let allocation =
            allocate(&mut allocator.lock(), "arealight image", requirements, |memory, offset| {
                // SAFETY: the memory was allocated for this image.
                unsafe { device.bind_image_memory(raw, memory, offset) }.call("vkBindImageMemory")
            })?;
        image.memory = Some(allocator.keep(allocation));
        let kind = vk::ImageViewType::from_raw(image_type.as_raw()); // of one layer
        // SAFETY: as above.
        image.view = unsafe { context.view(raw, kind, format, color_range(0..1, 1)) }?;
        Ok(image)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: by the contract of Image::new; a null view is ignored.
        unsafe {
            self.context.device.destroy_image_view(self.view, None);
            self.context.device.destroy_image(self.raw, None);
        }
    }
}
