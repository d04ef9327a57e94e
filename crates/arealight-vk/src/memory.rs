//! Memory through the gpu-allocator crate.

use crate::context::Context;
use crate::error::{Error, VulkanCall};
use crate::image::{Image, ImageInfo};
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
    ///
    /// # Errors
    /// [`Error::MissingFeature`] where no set can bind so large a one; [`Error::Vulkan`] where a call fails.
    pub(crate) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        usage: vk::BufferUsageFlags,
        (size, location): (vk::DeviceSize, MemoryLocation),
    ) -> Result<Self, Error> {
        let device = &context.device;
        if usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER) {
            context.limits.check_range(size, "a buffer of AreaLights")?;
        }
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

/// The least size of a buffer: a record of any kind of light.
pub(crate) const LEAST: vk::DeviceSize = 64;

/// A mapped buffer of these bytes, for shaders and copies.
///
/// # Safety
/// As [`Buffer::new`].
pub(crate) unsafe fn mapped(
    context: &Context,
    allocator: &SharedAllocator,
    bytes: &[u8],
) -> Result<Buffer, Error> {
    // SAFETY: the same contract.
    unsafe { holding(context, allocator, bytes, MemoryLocation::CpuToGpu) }
}

/// A buffer for these bytes, for shaders and copies, which has them where it is mapped.
///
/// # Safety
/// As [`Buffer::new`].
pub(crate) unsafe fn holding(
    context: &Context,
    allocator: &SharedAllocator,
    bytes: &[u8],
    location: MemoryLocation,
) -> Result<Buffer, Error> {
    let copies = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | copies;
    let size = (bytes.len() as vk::DeviceSize).max(LEAST);
    // SAFETY: the same contract.
    let mut buffer = unsafe { Buffer::new(context, allocator, usage, (size, location)) }?;
    buffer.write(bytes);
    Ok(buffer)
}

/// An image that shaders store to, with memory.
pub(crate) struct StoredImage {
    pub(crate) image: Image,
    _memory: Memory,
}

impl StoredImage {
    /// # Safety
    /// As [`Buffer::new`].
    pub(crate) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        format: vk::Format,
        extent: [u32; 3],
        image_type: vk::ImageType,
    ) -> Result<Self, Error> {
        let info = ImageInfo {
            name: "image",
            image_type,
            format,
            extent,
            levels: 1,
            layers: 1,
            usage: vk::ImageUsageFlags::STORAGE,
        };
        // SAFETY: the same contract.
        let mut image = unsafe { Image::new(context, info) }?;
        let requirements = image.memory_requirements();
        let bind = |memory, offset| {
            // SAFETY: the memory was allocated for this image.
            unsafe { image.bind_memory(memory, offset) }
        };
        let allocation = allocate(&mut allocator.lock(), "arealight image", requirements, bind)?;
        Ok(Self { image, _memory: allocator.keep(allocation) })
    }
}
