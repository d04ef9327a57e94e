//! Buffers, and how data gets into and out of them.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Where memory is, and who gets at it quickly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// With the device; uploads and downloads go through a staging buffer.
    Device,
    /// Mapped, for the CPU to write.
    Upload,
    /// Mapped and cached, for the CPU to read.
    Readback,
}

impl Location {
    fn allocator(self) -> MemoryLocation {
        match self {
            Self::Device => MemoryLocation::GpuOnly,
            Self::Upload => MemoryLocation::CpuToGpu,
            Self::Readback => MemoryLocation::GpuToCpu,
        }
    }
}

/// A buffer with its memory. It holds its host.
#[derive(Debug)]
pub struct Buffer {
    host: Host,
    name: String,
    raw: vk::Buffer,
    size: u64,
    /// Locked, since threads may share the buffer and its mapping.
    allocation: Mutex<Option<Allocation>>,
}

/// Memory on the device for something that is not this crate's. It holds its host.
#[derive(Debug)]
pub struct Memory {
    host: Host,
    allocation: Option<Allocation>,
}

impl Memory {
    /// Takes an allocation of the host's allocator.
    pub fn new(host: &Host, allocation: Allocation) -> Self {
        Self { host: host.clone(), allocation: Some(allocation) }
    }

    /// What it is a part of, and where in that it begins.
    ///
    /// # Safety
    /// The handle is not freed, and not used after this is dropped.
    pub unsafe fn place(&self) -> (vk::DeviceMemory, u64) {
        // SAFETY: the same contract.
        let place = |one: &Allocation| (unsafe { one.memory() }, one.offset());
        self.allocation.as_ref().map(place).unwrap_or_default()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if self.host.is_abandoned() {
            std::mem::forget(self.allocation.take());
        }
        self.host.free(self.allocation.take());
    }
}

/// The smallest buffer that [`Host::storage_buffer`] makes: Vulkan knows no empty ones.
const SMALLEST: u64 = 16;

impl Host {
    /// Makes a buffer of `size` bytes, at least 1. Its contents are undefined. It can be copied from and to.
    ///
    /// # Errors
    /// [`HostError::InvalidArgument`] where the size is 0; [`HostError::OutOfMemory`].
    pub fn buffer(
        &self,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
    ) -> Result<Buffer, HostError> {
        if size == 0 {
            let message = "a buffer of 0 bytes cannot be made".to_owned();
            return Err(HostError::InvalidArgument { name: name.to_owned(), message });
        }
        let usage = usage | vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: The device is alive, and the info valid: neither size nor usage is 0.
        let raw = unsafe { self.device().create_buffer(&info, None) }.named("vkCreateBuffer")?;
        let buffer =
            Buffer { host: self.clone(), name: name.to_owned(), raw, size, allocation: Mutex::new(None) };

        // SAFETY: The buffer is of this device.
        let requirements = unsafe { self.device().get_buffer_memory_requirements(raw) };
        let allocation = self.allocate(name, requirements, location, true)?;
        // SAFETY: The allocation's memory is of this device and fits the buffer, which has none yet.
        let bound =
            unsafe { self.device().bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        *buffer.allocation() = Some(allocation);
        bound.named("vkBindBufferMemory")?;
        Ok(buffer)
    }

    /// Makes a storage buffer with the device that holds `items`. Where there are none, it has 16 bytes,
    /// because a buffer cannot be empty and a descriptor wants one.
    ///
    /// # Errors
    /// [`HostError::OutOfMemory`], and whatever the upload meets.
    pub fn storage_buffer<T: Pod>(&self, name: &str, items: &[T]) -> Result<Buffer, HostError> {
        let size = (size_of_val(items) as u64).max(SMALLEST);
        let buffer = self.buffer(name, size, vk::BufferUsageFlags::STORAGE_BUFFER, Location::Device)?;
        if !items.is_empty() {
            buffer.upload(items)?;
        }
        Ok(buffer)
    }

    /// Memory on the device for an image that is not this crate's.
    pub fn memory(&self, name: &str, requirements: vk::MemoryRequirements) -> Result<Memory, HostError> {
        Ok(Memory::new(self, self.allocate(name, requirements, Location::Device, false)?))
    }

    /// Memory for a buffer (`linear`) or an image.
    pub(crate) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: Location,
        linear: bool,
    ) -> Result<Allocation, HostError> {
        let description = AllocationCreateDesc {
            name,
            requirements,
            location: location.allocator(),
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let allocated = self.with_allocator(|allocator| allocator.allocate(&description));
        allocated.map_err(|error| HostError::OutOfMemory {
            what: format!("{} bytes for {name} ({error})", requirements.size),
        })
    }

    /// Gives an allocation back. A failure is the allocator's own fault, and can only leak.
    pub(crate) fn free(&self, allocation: Option<Allocation>) {
        if let Some(allocation) = allocation {
            let freed = self.with_allocator(|allocator| allocator.free(allocation));
            debug_assert!(freed.is_ok(), "{freed:?}");
        }
    }
}

impl Buffer {
    /// The handle.
    pub fn handle(&self) -> vk::Buffer {
        self.raw
    }

    /// Its size in bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Writes `items` to the buffer's beginning, and waits until they are there.
    ///
    /// # Errors
    /// [`HostError::InvalidArgument`] where they do not fit; whatever the copy meets.
    pub fn upload<T: Pod>(&self, items: &[T]) -> Result<(), HostError> {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        if bytes.is_empty() {
            return Ok(());
        }
        if bytes.len() as u64 > self.size {
            return Err(self.argument(format!("{} bytes do not fit into {}", bytes.len(), self.size)));
        }
        if let Some(mapped) = self.allocation().as_mut().and_then(Allocation::mapped_slice_mut) {
            mapped[..bytes.len()].copy_from_slice(bytes);
            return Ok(());
        }
        let name = format!("{}, staged", self.name);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = self.host.buffer(&name, bytes.len() as u64, usage, Location::Upload)?;
        staging.upload(bytes)?;
        self.host.submit(|commands| staging.record_copy(commands, self, bytes.len() as u64))
    }

    /// Reads the whole buffer, after waiting for what was submitted.
    pub fn download<T: Pod>(&self) -> Result<Vec<T>, HostError> {
        let item = size_of::<T>() as u64;
        if item == 0 || !self.size.is_multiple_of(item) {
            return Err(self.argument(format!("{} bytes are not a number of items of {item}", self.size)));
        }
        let mut items = vec![T::zeroed(); (self.size / item) as usize];
        if let Some(mapped) = self.allocation().as_ref().and_then(Allocation::mapped_slice) {
            bytemuck::cast_slice_mut(&mut items).copy_from_slice(&mapped[..self.size as usize]);
            return Ok(items);
        }
        let name = format!("{}, read back", self.name);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let staging = self.host.buffer(&name, self.size, usage, Location::Readback)?;
        self.host.submit(|commands| self.record_copy(commands, &staging, self.size))?;
        staging.download()
    }

    /// Records a copy of the first `size` bytes.
    fn record_copy(&self, commands: vk::CommandBuffer, to: &Self, size: u64) {
        let region = [vk::BufferCopy::default().size(size)];
        // SAFETY: Both buffers hold that many bytes and can be copied; the commands are being recorded.
        unsafe { self.host.device().cmd_copy_buffer(commands, self.raw, to.raw, &region) };
    }

    fn allocation(&self) -> MutexGuard<'_, Option<Allocation>> {
        self.allocation.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn argument(&self, message: String) -> HostError {
        HostError::InvalidArgument { name: self.name.clone(), message }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let allocation = self.allocation().take();
        if self.host.is_abandoned() {
            std::mem::forget(allocation);
            return;
        }
        // SAFETY: The buffer is of this device, and nothing uses it: submissions are waited for.
        unsafe { self.host.device().destroy_buffer(self.raw, None) };
        self.host.free(allocation);
    }
}
