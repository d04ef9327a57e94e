//! Memory of the images that a host binds.

/// What a type with an `image` and a `bind_memory` of its own has for the host: how much memory, by hand or
/// by gpu-allocator, which calls it so.
macro_rules! image_memory {
    ($name:literal) => {
        /// What memory the image needs.
        pub fn memory_requirements(&self) -> vk::MemoryRequirements {
            self.image.memory_requirements()
        }

        /// Binds memory of the host, and makes the views.
        ///
        /// # Safety
        /// - Called once. `memory` and `offset` satisfy [`Self::memory_requirements`].
        /// - The memory is freed only after this is dropped.
        ///
        /// # Errors
        /// [`Error::Vulkan`] where a call fails.
        pub unsafe fn bind_memory(
            &mut self,
            memory: vk::DeviceMemory,
            offset: vk::DeviceSize,
        ) -> Result<(), Error> {
            // SAFETY: the same contract.
            unsafe { self.image.bind_memory(memory, offset) }
        }

        /// Allocates memory through gpu-allocator and binds it: steps 2 and 3 in one.
        ///
        /// The allocation is the host's: give it back to the allocator after this is dropped.
        ///
        /// # Safety
        /// Called once, with an allocator of the same device.
        ///
        /// # Errors
        /// [`Error::Vulkan`] with `ERROR_OUT_OF_DEVICE_MEMORY` where the allocator has none, or where a call
        /// fails (then the memory was given back, and this is only good for dropping).
        #[cfg(feature = "gpu-allocator")]
        pub unsafe fn allocate(
            &mut self,
            allocator: &mut gpu_allocator::vulkan::Allocator,
        ) -> Result<gpu_allocator::vulkan::Allocation, Error> {
            let requirements = self.memory_requirements();
            crate::memory::allocate(allocator, $name, requirements, |memory, offset| {
                // SAFETY: the memory was allocated for this image's requirements.
                unsafe { self.bind_memory(memory, offset) }
            })
        }
    };
}
pub(crate) use image_memory;
