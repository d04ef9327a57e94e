//! Descriptor sets for tools: allocated from a pool, freed with it.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use ash::vk;

/// A descriptor pool. Its sets live as long as it does.
#[derive(Debug)]
pub struct DescriptorPool {
    host: Host,
    raw: vk::DescriptorPool,
}

impl Host {
    /// Makes a pool for `max_sets` sets that together hold what `sizes` says.
    ///
    /// # Errors
    /// [`HostError::OutOfMemory`], or [`HostError::Vulkan`] where Vulkan refuses.
    pub fn descriptor_pool(
        &self,
        max_sets: u32,
        sizes: &[vk::DescriptorPoolSize],
    ) -> Result<DescriptorPool, HostError> {
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(max_sets).pool_sizes(sizes);
        // SAFETY: The device is alive.
        let raw = unsafe { self.device().create_descriptor_pool(&info, None) };
        Ok(DescriptorPool { host: self.clone(), raw: raw.named("vkCreateDescriptorPool")? })
    }
}

impl DescriptorPool {
    /// Allocates a set. Its descriptors are undefined until written.
    ///
    /// # Safety
    /// The layout is one of this host's device, and alive.
    ///
    /// # Errors
    /// [`HostError::Vulkan`] where the pool is used up.
    pub unsafe fn allocate(&self, layout: vk::DescriptorSetLayout) -> Result<vk::DescriptorSet, HostError> {
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.raw).set_layouts(&layouts);
        // SAFETY: The pool is of this device; the caller vouches for the layout.
        let sets = unsafe { self.host.device().allocate_descriptor_sets(&info) };
        Ok(sets.named("vkAllocateDescriptorSets")?.first().copied().unwrap_or_default())
    }
}

impl Drop for DescriptorPool {
    fn drop(&mut self) {
        if !self.host.is_abandoned() {
            // SAFETY: The pool is of this device, and nothing uses its sets: submissions are waited for.
            unsafe { self.host.device().destroy_descriptor_pool(self.raw, None) };
        }
    }
}
