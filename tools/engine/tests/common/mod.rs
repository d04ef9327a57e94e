//! A minimal compute pipeline for the canaries.

use arealight_engine::host::{Buffer, DescriptorPool, Host};
use ash::vk;

/// A kernel over storage buffers, with a `uint` of push constants, and one descriptor set.
pub struct Kernel<'a> {
    host: &'a Host,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    _pool: DescriptorPool,
    set: vk::DescriptorSet,
}

impl<'a> Kernel<'a> {
    pub fn new(host: &'a Host, spirv: &[u8], buffers: &[&Buffer]) -> Self {
        let device = host.device();
        let kind = vk::DescriptorType::STORAGE_BUFFER;
        let stage = vk::ShaderStageFlags::COMPUTE;
        let bindings: Vec<_> = (0..buffers.len() as u32)
            .map(|binding| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind)
                    .descriptor_count(1)
                    .stage_flags(stage)
            })
            .collect();
        let sizes = [vk::DescriptorPoolSize { ty: kind, descriptor_count: buffers.len() as u32 }];
        let pool = host.descriptor_pool(1, &sizes).unwrap();
        let words: Vec<u32> =
            spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        // SAFETY: The device is alive, every info is valid, and the set is not in use.
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let set_layout = device.create_descriptor_set_layout(&info, None).unwrap();
            let set = pool.allocate(set_layout).unwrap();
            for (binding, buffer) in buffers.iter().enumerate() {
                let info =
                    [vk::DescriptorBufferInfo::default().buffer(buffer.handle()).range(vk::WHOLE_SIZE)];
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding as u32)
                    .descriptor_type(kind)
                    .buffer_info(&info);
                device.update_descriptor_sets(&[write], &[]);
            }
            let set_layouts = [set_layout];
            let constants = [vk::PushConstantRange { stage_flags: stage, offset: 0, size: 4 }];
            let info = vk::PipelineLayoutCreateInfo::default()
                .set_layouts(&set_layouts)
                .push_constant_ranges(&constants);
            let layout = device.create_pipeline_layout(&info, None).unwrap();
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            let module = device.create_shader_module(&info, None).unwrap();
            let shader =
                vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main");
            let info = vk::ComputePipelineCreateInfo::default().stage(shader).layout(layout);
            let pipelines = device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
            let pipeline = pipelines.unwrap()[0];
            device.destroy_shader_module(module, None);
            Self { host, set_layout, layout, pipeline, _pool: pool, set }
        }
    }

    /// Records a dispatch of one group of 64.
    pub fn dispatch(&self, commands: vk::CommandBuffer, constant: u32) {
        let device = self.host.device();
        let bind = vk::PipelineBindPoint::COMPUTE;
        let stage = vk::ShaderStageFlags::COMPUTE;
        // SAFETY: The commands are being recorded, and the set fits the pipeline.
        unsafe {
            device.cmd_bind_pipeline(commands, bind, self.pipeline);
            device.cmd_bind_descriptor_sets(commands, bind, self.layout, 0, &[self.set], &[]);
            device.cmd_push_constants(commands, self.layout, stage, 0, &constant.to_le_bytes());
            device.cmd_dispatch(commands, 1, 1, 1);
        }
    }
}

impl Drop for Kernel<'_> {
    fn drop(&mut self) {
        let device = self.host.device();
        // SAFETY: Nothing uses them: submissions are waited for.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
