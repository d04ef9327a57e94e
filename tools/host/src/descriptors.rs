//! Descriptor sets for tools: allocated from a pool, freed with it.

use crate::device::Host;
use crate::error::{HostError, NameCall as _};
use arealight_vk::Resource;
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

/// A descriptor set of a host's own shader, as kernels of its have it for set 1, with its layout and pool.
#[derive(Debug)]
pub struct OwnSet {
    pool: DescriptorPool,
    /// What pipelines are made with.
    pub layout: vk::DescriptorSetLayout,
    /// The set.
    pub set: vk::DescriptorSet,
}

impl Host {
    /// Makes a set of storage buffers, or of images that are read by texel, for the compute stage, at
    /// bindings from `first` on.
    ///
    /// # Safety
    /// The resources are of this host, of those kinds, and outlive what reads the set.
    ///
    /// # Errors
    /// [`HostError::OutOfMemory`], or [`HostError::Vulkan`] where Vulkan refuses.
    pub unsafe fn own_set(&self, first: u32, resources: &[Resource]) -> Result<OwnSet, HostError> {
        let kind = |resource: &Resource| match resource {
            Resource::StorageBuffer { .. } => vk::DescriptorType::STORAGE_BUFFER,
            _ => vk::DescriptorType::SAMPLED_IMAGE,
        };
        let binding = |(number, resource)| {
            let binding = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_count(1);
            binding.descriptor_type(kind(resource)).stage_flags(vk::ShaderStageFlags::COMPUTE)
        };
        let bindings: Vec<_> = (first..).zip(resources).map(binding).collect();
        let size = |resource| vk::DescriptorPoolSize { ty: kind(resource), descriptor_count: 1 };
        let pool = self.descriptor_pool(1, &resources.iter().map(size).collect::<Vec<_>>())?;
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: The device is alive; the caller vouches for the resources.
        unsafe {
            let layout = self.device().create_descriptor_set_layout(&info, None);
            let layout = layout.named("vkCreateDescriptorSetLayout")?;
            let mut own = OwnSet { pool, layout, set: vk::DescriptorSet::null() };
            own.set = own.pool.allocate(layout)?;
            for (number, resource) in (first..).zip(resources) {
                let write = vk::WriteDescriptorSet::default().dst_set(own.set).dst_binding(number);
                let write = write.descriptor_type(kind(resource));
                match *resource {
                    Resource::StorageBuffer { buffer, offset, range } => {
                        let info = [vk::DescriptorBufferInfo { buffer, offset, range }];
                        self.device().update_descriptor_sets(&[write.buffer_info(&info)], &[]);
                    }
                    Resource::SampledImage { view, layout } | Resource::FilteredImage { view, layout } => {
                        let info = [vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)];
                        self.device().update_descriptor_sets(&[write.image_info(&info)], &[]);
                    }
                    Resource::StorageImage { .. } => {}
                }
            }
            Ok(own)
        }
    }
}

impl Drop for OwnSet {
    fn drop(&mut self) {
        if !self.pool.host.is_abandoned() {
            // SAFETY: The layout is of this device, and nothing uses it: submissions are waited for.
            unsafe { self.pool.host.device().destroy_descriptor_set_layout(self.layout, None) };
        }
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
