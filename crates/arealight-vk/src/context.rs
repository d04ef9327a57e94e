//! The host's device, and the pipeline cache it lends.

use crate::debug_names::DebugNames;
use crate::error::Error;
use crate::limits::{DescriptorLimits, ImageLimits, light_texture_limits};
use crate::written_sets::WrittenSets;
use ash::vk;
use std::ops::Range;

/// What a copy or a dispatch wrote, and what the next dispatch may do with it.
pub(crate) const COPIED: (vk::PipelineStageFlags, vk::AccessFlags) =
    (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
pub(crate) const WRITTEN: (vk::PipelineStageFlags, vk::AccessFlags) =
    (vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_WRITE);
pub(crate) const USED: (vk::PipelineStageFlags, vk::AccessFlags) = (
    vk::PipelineStageFlags::COMPUTE_SHADER,
    vk::AccessFlags::from_raw(vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::SHADER_WRITE.as_raw()),
);

/// The recorder's view of the host's device, from which passes are made. Cheap to clone.
#[derive(Clone)]
pub struct Context {
    instance: ash::Instance,
    pub(crate) device: ash::Device,
    pub(crate) pipeline_cache: vk::PipelineCache,
    pub(crate) max_group_count: [u32; 3],
    pub(crate) limits: DescriptorLimits,
    /// `None` where the device has no such images at all.
    pub(crate) light_texture_limits: Option<ImageLimits>,
    /// Whether drivers get modules as they are, not as [`crate::prune`] leaves them.
    pub(crate) whole_modules: bool,
    pub(crate) names: DebugNames,
    pub(crate) written_sets: WrittenSets,
}

impl std::fmt::Debug for Context {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context").field("device", &self.device.handle()).finish_non_exhaustive()
    }
}

impl Context {
    /// Checks the device, which has a queue with compute, and takes its function table. No optional feature
    /// is needed. All handles stay the host's: nothing of them is destroyed, waited for or submitted to.
    ///
    /// A host that uses another version of ash, or none, makes the function tables from its raw handles with
    /// `ash::Instance::load_with` and `ash::Device::load_with`, re-exported here as [`crate::ash`].
    ///
    /// # Safety
    /// - The handles are valid, the physical device of the instance and the device of the physical device;
    ///   all are for Vulkan 1.1 or later.
    /// - The device outlives the context and everything made from it.
    ///
    /// # Errors
    /// [`Error::MissingFeature`] where the device is older than Vulkan 1.1; [`Error::Vulkan`] where a call
    /// fails.
    pub unsafe fn new(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        device: &ash::Device,
    ) -> Result<Self, Error> {
        // SAFETY: the caller vouches for the instance and the physical device.
        let properties = unsafe { instance.get_physical_device_properties(physical_device) };
        if properties.api_version < vk::API_VERSION_1_1 {
            return Err(Error::MissingFeature { feature: "Vulkan 1.1", needed_by: "every kernel" });
        }
        Ok(Self {
            instance: instance.clone(),
            device: device.clone(),
            pipeline_cache: vk::PipelineCache::null(),
            max_group_count: properties.limits.max_compute_work_group_count,
            limits: DescriptorLimits {
                sampled_images: properties.limits.max_per_stage_descriptor_sampled_images,
                storage_images: properties.limits.max_per_stage_descriptor_storage_images,
                storage_buffers: properties.limits.max_per_stage_descriptor_storage_buffers,
                storage_buffer_alignment: properties.limits.min_storage_buffer_offset_alignment,
                storage_buffer_range: properties.limits.max_storage_buffer_range,
                volume_side: properties.limits.max_image_dimension3_d,
            },
            light_texture_limits: light_texture_limits(instance, physical_device)?,
            whole_modules: false,
            names: DebugNames::default(),
            written_sets: WrittenSets::default(),
        })
    }

    /// Makes pipelines with a cache of the host's.
    ///
    /// # Safety
    /// The cache is the device's, outlives what is made of the context, and was made without
    /// `VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT`.
    #[must_use = "the context is returned"]
    pub unsafe fn with_pipeline_cache(mut self, cache: vk::PipelineCache) -> Self {
        self.pipeline_cache = cache;
        self
    }

    /// Hands modules to the driver as they are, without [`prune`](crate::prune()): for a debugger of shaders,
    /// or to compare. On Mesa a pipeline then takes from 8 to 150 times as long to make. Sets have every
    /// binding then, seven storage buffers among them.
    #[must_use = "the context is returned"]
    pub fn with_whole_modules(mut self) -> Self {
        self.whole_modules = true;
        self
    }

    /// Has what is made from the context named (`arealight shade`) and what is recorded labelled, for
    /// debuggers and the validation layer.
    ///
    /// # Safety
    /// The instance is the device's, and was made with `VK_EXT_debug_utils`.
    #[must_use = "the context is returned"]
    pub unsafe fn with_debug_utils(mut self, instance: &ash::Instance) -> Self {
        self.names = DebugNames::new(ash::ext::debug_utils::Device::new(instance, &self.device));
        self
    }

    /// The functions of `VK_KHR_push_descriptor`, with which the device was made.
    pub(crate) fn push_descriptors(&self) -> Result<ash::khr::push_descriptor::Device, Error> {
        let (device, name) = (self.device.handle(), c"vkCmdPushDescriptorSetKHR");
        // SAFETY: the device is valid by the contract of Context::new.
        if unsafe { self.instance.get_device_proc_addr(device, name.as_ptr()) }.is_none() {
            let needed_by = "pushed descriptors";
            return Err(Error::MissingFeature { feature: "VK_KHR_push_descriptor", needed_by });
        }
        Ok(ash::khr::push_descriptor::Device::new(&self.instance, &self.device))
    }

    /// The device's function table.
    pub fn device(&self) -> &ash::Device {
        &self.device
    }

    /// A barrier for what a pass's own commands hand on to each other: stages, and what they do.
    ///
    /// # Safety
    /// `command_buffer` is being recorded, outside a render pass.
    pub(crate) unsafe fn record_barrier(
        &self,
        command_buffer: vk::CommandBuffer,
        (before, written): (vk::PipelineStageFlags, vk::AccessFlags),
        (after, used): (vk::PipelineStageFlags, vk::AccessFlags),
    ) {
        let barrier = [vk::MemoryBarrier::default().src_access_mask(written).dst_access_mask(used)];
        let flags = vk::DependencyFlags::empty();
        // SAFETY: the same contract.
        unsafe { self.device.cmd_pipeline_barrier(command_buffer, before, after, flags, &barrier, &[], &[]) };
    }

    /// Barriers of images between two stages.
    ///
    /// # Safety
    /// As above; the images are live.
    pub(crate) unsafe fn record_images(
        &self,
        command_buffer: vk::CommandBuffer,
        (before, after): (vk::PipelineStageFlags, vk::PipelineStageFlags),
        images: &[vk::ImageMemoryBarrier<'_>],
    ) {
        let flags = vk::DependencyFlags::empty();
        // SAFETY: the same contract.
        unsafe { self.device.cmd_pipeline_barrier(command_buffer, before, after, flags, &[], &[], images) };
    }
}

/// Levels of an image of colours, and its layers from the first on.
pub(crate) const fn color_range(levels: Range<u32>, layer_count: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        base_mip_level: levels.start,
        level_count: levels.end - levels.start,
        base_array_layer: 0,
        layer_count,
    }
}
