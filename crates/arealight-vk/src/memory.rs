//! Memory for our images through the gpu-allocator crate.

use crate::error::Error;
use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};

/// Allocates for an image's `requirements`, and binds it by `bind`. Where that fails, the memory is given
/// back.
pub(crate) fn allocate(
    allocator: &mut Allocator,
    name: &str,
    requirements: vk::MemoryRequirements,
    bind: impl FnOnce(vk::DeviceMemory, vk::DeviceSize) -> Result<(), Error>,
) -> Result<Allocation, Error> {
    let allocation = allocator
        .allocate(&AllocationCreateDesc {
            name,
            requirements,
            location: gpu_allocator::MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })
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
