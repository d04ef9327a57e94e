//! One kernel as a compute pipeline, and how it is recorded.

use crate::context::Context;
use crate::error::{Error, VulkanCall};
use crate::layouts::Layouts;
use crate::module::check_module;
use crate::prune::prune;
use crate::resource::Resource;
use arealight::kernels::Kernel;
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// A kernel, specialised, ready to be recorded. Dropping it destroys its pipeline, and its layouts with the
/// last that has them.
#[derive(Debug)]
pub struct ComputePass {
    layouts: Arc<Layouts>,
    kernel: &'static Kernel,
    pipeline: vk::Pipeline,
}

impl ComputePass {
    /// Makes the pipeline of `kernel` with pairs of specialisation constant id and value; constants that are
    /// not given keep the shader's default, which is the catch-all.
    ///
    /// # Safety
    /// The returned pass is dropped only when no recorded use of it is pending, and before the device is
    /// destroyed.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a constant that the kernel does not have, [`Error::MissingFeature`]
    /// where the kernel binds more than the device can, [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(
        context: &Context,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
    ) -> Result<Self, Error> {
        // SAFETY: the same contract; the module is the kernel's.
        unsafe { Self::of(&Layouts::new(context, kernel)?, kernel, &kernel.words(), specialization) }
    }

    /// As [`ComputePass::new`], with a SPIR-V module in the place of the kernel's own.
    ///
    /// # Safety
    /// As [`ComputePass::new`]. The module is valid, and has the kernel's bindings, push constants and entry
    /// point.
    ///
    /// # Errors
    /// As [`ComputePass::new`]; [`Error::InvalidArgument`] if it is not a module with the kernel's
    /// entry point and bindings.
    pub unsafe fn with_module(
        context: &Context,
        kernel: &'static Kernel,
        module: &[u32],
        specialization: &[(u32, u32)],
    ) -> Result<Self, Error> {
        check_module(module, kernel, false)?;
        // SAFETY: the same contract.
        unsafe { Self::of(&Layouts::new(context, kernel)?, kernel, module, specialization) }
    }

    /// As [`ComputePass::with_module`], with layouts that others have too, of a module that [`check_module`]
    /// found good.
    ///
    /// # Safety
    /// As [`ComputePass::with_module`]. The layouts are those of a kernel with every binding of this one.
    pub(crate) unsafe fn of(
        layouts: &Arc<Layouts>,
        kernel: &'static Kernel,
        module: &[u32],
        specialization: &[(u32, u32)],
    ) -> Result<Self, Error> {
        if let Some((id, _)) = specialization.iter().find(|(id, _)| !kernel.constants().contains(id)) {
            return Err(Error::InvalidArgument {
                field: "specialization",
                message: format!(
                    "kernel '{}' has no constant {id}; it has {:?}",
                    kernel.name,
                    kernel.constants()
                ),
            });
        }
        let pipeline = make_pipeline(layouts, module, specialization)?;
        layouts.context().names.name(pipeline, kernel.name);
        Ok(Self { layouts: Arc::clone(layouts), kernel, pipeline })
    }

    /// The kernel.
    pub fn kernel(&self) -> &'static Kernel {
        self.kernel
    }

    /// The layout that the host allocates a descriptor set with.
    pub fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.layouts.set_layout()
    }

    /// What `sets` descriptor sets of this pass take from the host's descriptor pool.
    pub fn pool_sizes(&self, sets: u32) -> Vec<vk::DescriptorPoolSize> {
        self.layouts.pool_sizes(sets)
    }

    /// Points a descriptor set at the resources of a run, in the order of [`Kernel::bindings`].
    ///
    /// # Safety
    /// - `set` was allocated with [`ComputePass::set_layout`] and no pending command buffer uses it.
    /// - The resources are valid, and stay so while recorded work that uses the set is pending.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the binding that is missing, null or of the wrong kind; then nothing
    /// is written.
    pub unsafe fn write_set(&self, set: vk::DescriptorSet, resources: &[Resource]) -> Result<(), Error> {
        // SAFETY: the same contract.
        unsafe { self.layouts.write_set(set, resources, &[]) }
    }

    /// Records binding, push constants and one dispatch. Barriers before and after are the host's, by
    /// [`Kernel::bindings`]' accesses: every resource is used in the compute stage.
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with compute.
    /// - `set` was written by [`ComputePass::write_set`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where `constants` is not of the kernel's size or `groups` is beyond the
    /// device's limit, [`Error::Destroyed`] (in debug builds) where the set points at an image of the
    /// recorder's that is gone; then nothing is recorded.
    pub unsafe fn record(
        &self,
        command_buffer: vk::CommandBuffer,
        set: vk::DescriptorSet,
        constants: &[u8],
        groups: [u32; 3],
    ) -> Result<(), Error> {
        self.layouts.check_set(set)?;
        self.layouts.check(self.kernel, constants, groups)?;
        // SAFETY: the same contract.
        unsafe { self.record_checked(command_buffer, &[set], constants, groups) };
        Ok(())
    }

    /// Records what passed [`Layouts::check`], with descriptor sets from 0 on.
    ///
    /// # Safety
    /// As [`ComputePass::record`].
    pub(crate) unsafe fn record_checked(
        &self,
        command_buffer: vk::CommandBuffer,
        sets: &[vk::DescriptorSet],
        constants: &[u8],
        groups: [u32; 3],
    ) {
        // SAFETY: the same contract.
        unsafe {
            self.layouts.bind_sets(command_buffer, sets, [0; 3]);
            self.bind(command_buffer, constants);
            self.layouts.context().device.cmd_dispatch(command_buffer, groups[0], groups[1], groups[2]);
        }
    }

    /// As [`ComputePass::record_checked`], of the workgroups in `rows` alone: of y from the first on to
    /// before the last. Descriptor sets are bound already.
    ///
    /// # Safety
    /// As [`ComputePass::record`]; rows are among those of `groups`.
    pub(crate) unsafe fn record_rows(
        &self,
        command_buffer: vk::CommandBuffer,
        constants: &[u8],
        (groups, rows): ([u32; 3], Range<u32>),
    ) {
        let count = rows.end - rows.start;
        // SAFETY: the same contract; the pipeline was made for any first workgroup.
        unsafe {
            self.bind(command_buffer, constants);
            let device = &self.layouts.context().device;
            device.cmd_dispatch_base(command_buffer, 0, rows.start, 0, groups[0], count, groups[2]);
            if rows.start > 0 {
                // Lavapipe's indirect dispatches begin where the last direct one did: one of nothing begins
                // at 0
                device.cmd_dispatch(command_buffer, 0, 0, 0);
            }
        }
    }

    /// As [`ComputePass::record_rows`], with the groups that are found in a buffer when the commands run.
    ///
    /// # Safety
    /// As [`ComputePass::record`]; `buffer` has the usage `INDIRECT_BUFFER`, and holds at `offset`, a
    /// multiple of 4, a `VkDispatchIndirectCommand` that the device can dispatch.
    pub(crate) unsafe fn record_indirect(
        &self,
        command_buffer: vk::CommandBuffer,
        constants: &[u8],
        (buffer, offset): (vk::Buffer, vk::DeviceSize),
    ) {
        // SAFETY: the same contract.
        unsafe {
            self.bind(command_buffer, constants);
            self.layouts.context().device.cmd_dispatch_indirect(command_buffer, buffer, offset);
        }
    }

    /// Binds the pipeline and its push constants, if the kernel has any.
    unsafe fn bind(&self, command_buffer: vk::CommandBuffer, constants: &[u8]) {
        let (device, layout) = (&self.layouts.context().device, self.layouts.pipeline_layout());
        // SAFETY: the caller vouches for the command buffer; the pipeline is ours and live.
        unsafe {
            device.cmd_bind_pipeline(command_buffer, vk::PipelineBindPoint::COMPUTE, self.pipeline);
            if !constants.is_empty() {
                let stage = vk::ShaderStageFlags::COMPUTE;
                device.cmd_push_constants(command_buffer, layout, stage, 0, constants);
            }
        }
    }
}

impl Drop for ComputePass {
    fn drop(&mut self) {
        // SAFETY: by the contract of ComputePass::new no recorded use is pending and the device is alive.
        unsafe { self.layouts.context().device.destroy_pipeline(self.pipeline, None) };
    }
}

fn make_pipeline(
    layouts: &Layouts,
    words: &[u32],
    specialization: &[(u32, u32)],
) -> Result<vk::Pipeline, Error> {
    let device = &layouts.context().device;
    let pruned = (!layouts.context().whole_modules).then(|| prune(words, specialization));
    let info = vk::ShaderModuleCreateInfo::default().code(pruned.as_deref().unwrap_or(words));
    // SAFETY: the device is valid; the code is SPIR-V that a test validates, also pruned.
    let module = unsafe { device.create_shader_module(&info, None) }.call("vkCreateShaderModule")?;

    let data: Vec<u32> = specialization.iter().map(|&(_, value)| value).collect();
    let entries: Vec<_> = (0u32..)
        .zip(specialization)
        .map(|(place, &(id, _))| {
            vk::SpecializationMapEntry::default().constant_id(id).offset(place * 4).size(4)
        })
        .collect();
    let specialization =
        vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::cast_slice(&data));
    let stage = vk::PipelineShaderStageCreateInfo::default()
        .stage(vk::ShaderStageFlags::COMPUTE)
        .module(module)
        .name(c"main")
        .specialization_info(&specialization);
    let info = vk::ComputePipelineCreateInfo::default()
        .flags(vk::PipelineCreateFlags::DISPATCH_BASE) // ComputePass::record_rows
        .stage(stage)
        .layout(layouts.pipeline_layout());
    // SAFETY: module and layout are live; the cache is the host's, unused elsewhere by contract.
    let made = unsafe { device.create_compute_pipelines(layouts.context().pipeline_cache, &[info], None) };
    // SAFETY: a module may go as soon as pipelines were made from it.
    unsafe { device.destroy_shader_module(module, None) };
    let pipelines = made.map_err(|(_, result)| result).call("vkCreateComputePipelines")?;
    Ok(pipelines[0])
}
