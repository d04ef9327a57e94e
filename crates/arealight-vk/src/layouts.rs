//! The layout of a kernel's descriptor sets, and how they are written.

use crate::context::Context;
use crate::error::{Error, VulkanCall};
use crate::resource::Resource;
use arealight::kernels::{Binding, BindingKind, Kernel};
use ash::vk;
use std::sync::Arc;

/// The sampler of every binding of [`BindingKind::FilteredImage`], which is immutable in our layouts:
/// trilinear, clamped to the edge. For hosts that make layouts of our kernels themselves.
pub fn filtered_image_sampler() -> vk::SamplerCreateInfo<'static> {
    vk::SamplerCreateInfo::default()
        .mag_filter(vk::Filter::LINEAR)
        .min_filter(vk::Filter::LINEAR)
        .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
        .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
        .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
        .address_mode_w(vk::SamplerAddressMode::CLAMP_TO_EDGE)
        .max_lod(vk::LOD_CLAMP_NONE)
}

/// How shade passes get at the host's resources.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Descriptors {
    /// By descriptor sets that the host allocates.
    #[default]
    Sets,
    /// By such sets, in which the buffers of lights, their vertices and shapes are dynamic ones
    /// (`STORAGE_BUFFER_DYNAMIC`): each frame says their offsets,
    /// [`ShadeFrame::light_offsets`](crate::ShadeFrame::light_offsets), for rings of buffers. Sets are
    /// written with the range of a frame.
    LightOffsets,
    /// By [`Bound::Pushed`](crate::Bound::Pushed), when commands are recorded. The device was made with
    /// `VK_KHR_push_descriptor`.
    Pushed,
}

/// What every pipeline of a kernel has in common: a descriptor set is for all that share it.
pub(crate) struct Layouts {
    context: Context,
    kernel: &'static Kernel,
    /// The kernel's, or some of them.
    bindings: Vec<Binding>,
    /// Of set 1, where a module of the host's reads what is the host's.
    host_set: Option<vk::DescriptorSetLayout>,
    /// How set 0 gets at resources.
    descriptors: Descriptors,
    push: Option<ash::khr::push_descriptor::Device>,
    sampler: vk::Sampler,
    set_layout: vk::DescriptorSetLayout,
    pipeline_layout: vk::PipelineLayout,
}

impl std::fmt::Debug for Layouts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Layouts").field("kernel", &self.kernel.name).finish_non_exhaustive()
    }
}

impl Layouts {
    /// # Safety
    /// They are dropped before the device is destroyed, when no recorded use of them is pending.
    pub(crate) unsafe fn new(context: &Context, kernel: &'static Kernel) -> Result<Arc<Self>, Error> {
        // SAFETY: the same contract.
        unsafe { Self::with(context, kernel, kernel.bindings().to_vec(), (Descriptors::Sets, None)) }
    }

    /// As [`Layouts::new`], with no more of the kernel's bindings than its pipelines use, with how set 0 gets
    /// at resources, and with the layout of a second set, which is the host's.
    ///
    /// # Safety
    /// As [`Layouts::new`]; the layout is valid until they are dropped.
    pub(crate) unsafe fn with(
        context: &Context,
        kernel: &'static Kernel,
        bindings: Vec<Binding>,
        (descriptors, host_set): (Descriptors, Option<vk::DescriptorSetLayout>),
    ) -> Result<Arc<Self>, Error> {
        check_limits(context, kernel, &bindings)?;
        let is_filtered = bindings.iter().any(|binding| binding.kind == BindingKind::FilteredImage);
        // Handles that were made before a later call fails are destroyed with these half-made layouts
        let mut layouts = Self {
            context: context.clone(),
            kernel,
            bindings,
            host_set,
            descriptors,
            push: (descriptors == Descriptors::Pushed).then(|| context.push_descriptors()).transpose()?,
            sampler: vk::Sampler::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            pipeline_layout: vk::PipelineLayout::null(),
        };
        if is_filtered {
            layouts.make_sampler()?;
        }
        layouts.make_layouts()?;
        context.names.name(layouts.set_layout, kernel.name);
        context.names.name(layouts.pipeline_layout, kernel.name);
        Ok(Arc::new(layouts))
    }

    fn make_sampler(&mut self) -> Result<(), Error> {
        let info = filtered_image_sampler();
        // SAFETY: the device is valid by the contract of Context::new.
        self.sampler = unsafe { self.context.device.create_sampler(&info, None) }.call("vkCreateSampler")?;
        Ok(())
    }

    fn make_layouts(&mut self) -> Result<(), Error> {
        let device = &self.context.device;
        let samplers = [self.sampler];
        let bindings: Vec<_> = self
            .bindings
            .iter()
            .map(|binding| {
                let layout = vk::DescriptorSetLayoutBinding::default()
                    .binding(binding.number)
                    .descriptor_type(self.descriptor_type(binding))
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE);
                match binding.kind {
                    BindingKind::FilteredImage => layout.immutable_samplers(&samplers),
                    _ => layout,
                }
            })
            .collect();
        let flags = match self.descriptors {
            Descriptors::Pushed => vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR,
            Descriptors::Sets | Descriptors::LightOffsets => vk::DescriptorSetLayoutCreateFlags::empty(),
        };
        let info = vk::DescriptorSetLayoutCreateInfo::default().flags(flags).bindings(&bindings);
        // SAFETY: the device is valid by the contract of Context::new; the info outlives the call.
        self.set_layout = unsafe { device.create_descriptor_set_layout(&info, None) }
            .call("vkCreateDescriptorSetLayout")?;

        let set_layouts: Vec<_> = std::iter::once(self.set_layout).chain(self.host_set).collect();
        let range = vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(self.kernel.push_constant_size());
        // Vulkan takes no empty range
        let ranges: Vec<_> = Some(range).filter(|range| range.size > 0).into_iter().collect();
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts).push_constant_ranges(&ranges);
        // SAFETY: as above.
        self.pipeline_layout =
            unsafe { device.create_pipeline_layout(&info, None) }.call("vkCreatePipelineLayout")?;
        Ok(())
    }

    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    pub(crate) fn pipeline_layout(&self) -> vk::PipelineLayout {
        self.pipeline_layout
    }

    pub(crate) fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Whether set 1 is the host's.
    pub(crate) fn has_host_set(&self) -> bool {
        self.host_set.is_some()
    }

    /// Whether a pass is recorded with a set of the host's where it was made with one.
    pub(crate) fn check_host_set(&self, host_set: Option<vk::DescriptorSet>) -> Result<(), Error> {
        let message = match (host_set.is_some(), self.has_host_set()) {
            (true, false) => "is given, but the pass was made without a module of the host's",
            (false, true) => "is missing, but the pass was made with a module of the host's",
            _ => return Ok(()),
        };
        Err(Error::InvalidArgument { field: "host_set", message: message.into() })
    }

    pub(crate) fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.set_layout
    }

    pub(crate) fn pool_sizes(&self, sets: u32) -> Vec<vk::DescriptorPoolSize> {
        let types = [
            vk::DescriptorType::SAMPLED_IMAGE,
            vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            vk::DescriptorType::STORAGE_IMAGE,
            vk::DescriptorType::STORAGE_BUFFER,
            vk::DescriptorType::STORAGE_BUFFER_DYNAMIC,
        ];
        types
            .into_iter()
            .filter_map(|ty| {
                let count = self.bindings.iter().filter(|b| self.descriptor_type(b) == ty).count() as u32;
                (count > 0).then(|| vk::DescriptorPoolSize { ty, descriptor_count: count * sets })
            })
            .collect()
    }

    fn descriptor_type(&self, binding: &Binding) -> vk::DescriptorType {
        let is_dynamic = self.descriptors == Descriptors::LightOffsets;
        match binding.kind {
            BindingKind::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
            BindingKind::FilteredImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            BindingKind::StorageBuffer if is_dynamic && is_of_lights(binding) => {
                vk::DescriptorType::STORAGE_BUFFER_DYNAMIC
            }
            BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        }
    }

    /// Something stands in the place of the bindings `absent`, for frames that do not read them.
    ///
    /// # Safety
    /// As [`ComputePass::write_set`].
    pub(crate) unsafe fn write_set(
        &self,
        set: vk::DescriptorSet,
        resources: &[Resource],
        absent: &[&'static str],
    ) -> Result<(), Error> {
        self.check_takes_sets()?;
        self.check_resources(resources)?;
        self.with_writes(set, resources, |writes| {
            // SAFETY: the caller vouches for the set and the resources; kinds were checked above.
            unsafe { self.context.device.update_descriptor_sets(writes, &[]) };
        });
        self.context.written_sets.write(set, &self.bindings, resources, absent);
        Ok(())
    }

    /// Whether resources are what the bindings hold.
    pub(crate) fn check_resources(&self, resources: &[Resource]) -> Result<(), Error> {
        let wrong = |field, message| Err(Error::InvalidArgument { field, message });
        let (name, count) = (self.kernel.name, self.bindings.len());
        if resources.len() != count {
            let message = format!("{} given, but kernel '{name}' has {count} bindings", resources.len());
            return wrong("resources", message);
        }
        for (binding, resource) in self.bindings.iter().zip(resources) {
            if resource.is_null() {
                let known = if binding.content.is_empty() { "what its kernel says" } else { binding.content };
                return wrong(binding.name, format!("is a null handle; it must hold {known}"));
            }
            if resource.kind() != binding.kind {
                let message = format!("is a {:?}, but must be a {:?}", resource.kind(), binding.kind);
                return wrong(binding.name, message);
            }
            let is_dynamic = self.descriptor_type(binding) == vk::DescriptorType::STORAGE_BUFFER_DYNAMIC;
            if is_dynamic && matches!(resource, Resource::StorageBuffer { range: vk::WHOLE_SIZE, .. }) {
                let message =
                    "is the whole buffer, but with offsets that differ by frame its range must be given";
                return wrong(binding.name, message.into());
            }
        }
        Ok(())
    }

    /// What writes resources to a set.
    fn with_writes(
        &self,
        set: vk::DescriptorSet,
        resources: &[Resource],
        act: impl FnOnce(&[vk::WriteDescriptorSet<'_>]),
    ) {
        // The infos are collected first, since the writes point into them
        let images: Vec<[vk::DescriptorImageInfo; 1]> = resources.iter().map(|r| [image_info(*r)]).collect();
        let buffers: Vec<[vk::DescriptorBufferInfo; 1]> =
            resources.iter().map(|r| [buffer_info(*r)]).collect();
        let writes: Vec<_> = self
            .bindings
            .iter()
            .zip(images.iter().zip(&buffers))
            .map(|(binding, (image, buffer))| {
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding.number)
                    .descriptor_type(self.descriptor_type(binding));
                match binding.kind {
                    BindingKind::StorageBuffer => write.buffer_info(buffer),
                    _ => write.image_info(image),
                }
            })
            .collect();
        act(&writes);
    }

    /// Binds descriptor sets from 0 on.
    ///
    /// # Safety
    /// `command_buffer` is recording; the sets were made with the layouts, and written.
    pub(crate) unsafe fn bind_sets(
        &self,
        command_buffer: vk::CommandBuffer,
        sets: &[vk::DescriptorSet],
        light_offsets: [u32; 3],
    ) {
        let offsets: &[u32] =
            if self.descriptors == Descriptors::LightOffsets { &light_offsets } else { &[] };
        let (point, layout) = (vk::PipelineBindPoint::COMPUTE, self.pipeline_layout);
        // SAFETY: the same contract.
        unsafe {
            self.context.device.cmd_bind_descriptor_sets(command_buffer, point, layout, 0, sets, offsets);
        }
    }

    /// Pushes what set 0 holds, and binds the host's set.
    ///
    /// # Safety
    /// `command_buffer` is recording, and the resources are valid until its commands have run; they passed
    /// [`Layouts::check_resources`].
    pub(crate) unsafe fn push(
        &self,
        command_buffer: vk::CommandBuffer,
        resources: &[Resource],
        host_set: Option<vk::DescriptorSet>,
    ) {
        let Some(functions) = &self.push else { return };
        let (point, layout) = (vk::PipelineBindPoint::COMPUTE, self.pipeline_layout);
        self.with_writes(vk::DescriptorSet::null(), resources, |writes| {
            // SAFETY: the same contract.
            unsafe { functions.cmd_push_descriptor_set(command_buffer, point, layout, 0, writes) };
        });
        if let Some(set) = host_set {
            // SAFETY: the same contract.
            unsafe {
                self.context.device.cmd_bind_descriptor_sets(command_buffer, point, layout, 1, &[set], &[]);
            }
        }
    }

    /// Refuses sets where resources are pushed.
    pub(crate) fn check_takes_sets(&self) -> Result<(), Error> {
        if self.push.is_none() {
            return Ok(());
        }
        let message = "is given, but the pass takes resources: Bound::Pushed".into();
        Err(Error::InvalidArgument { field: "set", message })
    }

    /// Refuses pushed resources where there are sets.
    pub(crate) fn check_takes_resources(&self) -> Result<(), Error> {
        if self.push.is_some() {
            return Ok(());
        }
        let message = "are given, but the pass takes sets: see ShadePassInfo::descriptors".into();
        Err(Error::InvalidArgument { field: "resources", message })
    }

    /// Whether offsets can be bound.
    pub(crate) fn check_light_offsets(&self, offsets: [u32; 3]) -> Result<(), Error> {
        let wrong = |message: String| Err(Error::InvalidArgument { field: "light_offsets", message });
        if self.descriptors != Descriptors::LightOffsets && offsets != [0; 3] {
            return wrong(
                "are given, but ShadePassInfo::descriptors are not Descriptors::LightOffsets".into(),
            );
        }
        let alignment = self.context.limits.storage_buffer_alignment;
        match offsets.iter().find(|offset| !u64::from(**offset).is_multiple_of(alignment)) {
            Some(offset) => wrong(format!("has {offset}, which is no multiple of {alignment}")),
            None => Ok(()),
        }
    }

    /// Checks that a set has what a frame needs.
    pub(crate) fn check_present(&self, set: vk::DescriptorSet, needed: &[&'static str]) -> Result<(), Error> {
        self.context.written_sets.check_present(set, needed)
    }

    /// What [`ComputePass::record`] refuses of `kernel`, which is the layouts' own or another that they
    /// serve.
    pub(crate) fn check(&self, kernel: &Kernel, constants: &[u8], groups: [u32; 3]) -> Result<(), Error> {
        if constants.len() != kernel.push_constant_size() as usize {
            return Err(Error::InvalidArgument {
                field: "constants",
                message: format!(
                    "{} bytes, but kernel '{}' takes {}",
                    constants.len(),
                    kernel.name,
                    kernel.push_constant_size()
                ),
            });
        }
        if (0..3).any(|axis| groups[axis] > self.context.max_group_count[axis]) {
            return Err(Error::InvalidArgument {
                field: "groups",
                message: format!(
                    "{groups:?}, but the device dispatches at most {:?}",
                    self.context.max_group_count
                ),
            });
        }
        Ok(())
    }

    /// What [`ComputePass::record`] refuses of a set.
    pub(crate) fn check_set(&self, set: vk::DescriptorSet) -> Result<(), Error> {
        self.context.written_sets.check(set)
    }
}

impl Drop for Layouts {
    fn drop(&mut self) {
        // SAFETY: by the contract of Layouts::new no recorded use is pending and the device is alive;
        // null handles are ignored.
        unsafe {
            let device = &self.context.device;
            device.destroy_pipeline_layout(self.pipeline_layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
            device.destroy_sampler(self.sampler, None);
        }
    }
}

/// Tiles, shadows, media and counts of lights bind more than every Vulkan device can.
fn check_limits(context: &Context, kernel: &'static Kernel, bindings: &[Binding]) -> Result<(), Error> {
    use BindingKind::{FilteredImage, SampledImage, StorageBuffer, StorageImage};
    let limits = context.limits;
    for (kinds, limit, feature) in [
        (&[SampledImage, FilteredImage][..], limits.sampled_images, "maxPerStageDescriptorSampledImages"),
        (&[StorageImage], limits.storage_images, "maxPerStageDescriptorStorageImages"),
        (&[StorageBuffer], limits.storage_buffers, "maxPerStageDescriptorStorageBuffers"),
    ] {
        let count = bindings.iter().filter(|binding| kinds.contains(&binding.kind)).count();
        if count > limit as usize {
            return Err(Error::MissingFeature { feature, needed_by: kernel.name });
        }
    }
    Ok(())
}

/// Whether it is a buffer of lights, which frames in a ring have each their own part of.
fn is_of_lights(binding: &Binding) -> bool {
    ["lights", "light_vertices", "shapes"].contains(&binding.name)
}

fn image_info(resource: Resource) -> vk::DescriptorImageInfo {
    match resource {
        Resource::SampledImage { view, layout } | Resource::FilteredImage { view, layout } => {
            vk::DescriptorImageInfo::default().image_view(view).image_layout(layout)
        }
        Resource::StorageImage { view } => {
            vk::DescriptorImageInfo::default().image_view(view).image_layout(vk::ImageLayout::GENERAL)
        }
        Resource::StorageBuffer { .. } => vk::DescriptorImageInfo::default(),
    }
}

fn buffer_info(resource: Resource) -> vk::DescriptorBufferInfo {
    match resource {
        Resource::StorageBuffer { buffer, offset, range } => {
            vk::DescriptorBufferInfo::default().buffer(buffer).offset(offset).range(range)
        }
        _ => vk::DescriptorBufferInfo::default(),
    }
}
