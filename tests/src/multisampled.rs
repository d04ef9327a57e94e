//! Images of several samples a pixel, each of which a test chose.

use crate::TestEngine;
use crate::floor::SIZE;
use arealight_engine::host::{DescriptorPool, Image, ImageDescription};
use arealight_vk::Resource;
use ash::vk;

const VERTEX: &[u8] = include_bytes!("../spirv/samples.vert.spv");
const FRAGMENT: &[u8] = include_bytes!("../spirv/samples.frag.spv");

/// What a sample of the G-buffer holds: `Texel` in `tests/kernels/samples.frag`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Texel {
    /// Position and 1; or depth. 0 without a surface.
    pub position: [f32; 4],
    /// And roughness.
    pub normal: [f32; 4],
    /// Base colour and metalness.
    pub color: [f32; 4],
}

/// Images of the G-buffer with several samples.
pub struct Multisampled {
    images: [Image; 3],
}

/// What draws them, which goes with its last use.
struct Drawing<'a> {
    device: &'a ash::Device,
    set_layout: vk::DescriptorSetLayout,
    set: vk::DescriptorSet,
    layout: vk::PipelineLayout,
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// One for each sample, whose mask has that bit alone.
    pipelines: Vec<vk::Pipeline>,
    _pool: DescriptorPool,
}

impl Drop for Drawing<'_> {
    fn drop(&mut self) {
        // SAFETY: The submission was waited for.
        unsafe {
            self.pipelines.iter().for_each(|pipeline| self.device.destroy_pipeline(*pipeline, None));
            self.device.destroy_framebuffer(self.framebuffer, None);
            self.device.destroy_render_pass(self.render_pass, None);
            self.device.destroy_pipeline_layout(self.layout, None);
            self.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

impl Multisampled {
    /// Draws `samples` texels of each pixel of [`SIZE`].
    pub fn new(engine: &TestEngine, samples: u32, texels: &[Texel]) -> Self {
        let host = engine.host();
        let images = ["position", "normal", "color"].map(|name| {
            let description = ImageDescription {
                name,
                extent: SIZE,
                layers: 1,
                format: vk::Format::R32G32B32A32_SFLOAT,
                usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::COLOR_ATTACHMENT,
            };
            host.multisampled_image(&description, samples).unwrap()
        });
        let buffer = host.storage_buffer("texels", texels).unwrap();
        let views = [&images[0], &images[1], &images[2]].map(Image::view);
        // SAFETY: The submission is waited for, and what it uses lives until then.
        unsafe {
            let drawing = Drawing::new(engine, samples, buffer.handle(), &views);
            host.submit(|commands| drawing.record(commands, samples)).unwrap();
        }
        Self { images }
    }

    /// Position, normal and base colour, as a pass reads them.
    pub fn resources(&self) -> [Resource; 3] {
        [0, 1, 2].map(|index: usize| Resource::sampled(self.images[index].view()))
    }
}

impl<'a> Drawing<'a> {
    /// # Safety
    /// The buffer and the views outlive it.
    unsafe fn new(engine: &'a TestEngine, samples: u32, buffer: vk::Buffer, views: &[vk::ImageView]) -> Self {
        let (host, device) = (engine.host(), engine.host().device());
        let kind = vk::DescriptorType::STORAGE_BUFFER;
        let pool =
            host.descriptor_pool(1, &[vk::DescriptorPoolSize { ty: kind, descriptor_count: 1 }]).unwrap();
        let binding = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)];
        let ranges = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::FRAGMENT).size(12)];
        // SAFETY: The device is alive, and all infos live until the calls return.
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&binding);
            let set_layout = device.create_descriptor_set_layout(&info, None).unwrap();
            let set = pool.allocate(set_layout).unwrap();
            let whole = [vk::DescriptorBufferInfo::default().buffer(buffer).range(vk::WHOLE_SIZE)];
            let write =
                vk::WriteDescriptorSet::default().dst_set(set).descriptor_type(kind).buffer_info(&whole);
            device.update_descriptor_sets(&[write], &[]);
            let set_layouts = [set_layout];
            let info = vk::PipelineLayoutCreateInfo::default()
                .set_layouts(&set_layouts)
                .push_constant_ranges(&ranges);
            let layout = device.create_pipeline_layout(&info, None).unwrap();
            let render_pass = make_render_pass(device, samples, views.len());
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(render_pass)
                .attachments(views)
                .width(SIZE[0])
                .height(SIZE[1])
                .layers(1);
            let framebuffer = device.create_framebuffer(&info, None).unwrap();
            let pipelines = (0..samples)
                .map(|index| make_pipeline(device, (layout, render_pass), samples, index))
                .collect();
            Self { device, set_layout, set, layout, render_pass, framebuffer, pipelines, _pool: pool }
        }
    }

    /// # Safety
    /// The commands are being recorded.
    unsafe fn record(&self, commands: vk::CommandBuffer, samples: u32) {
        let area =
            vk::Rect2D { extent: vk::Extent2D { width: SIZE[0], height: SIZE[1] }, ..vk::Rect2D::default() };
        let begin = vk::RenderPassBeginInfo::default()
            .render_pass(self.render_pass)
            .framebuffer(self.framebuffer)
            .render_area(area);
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: The same contract; everything is alive.
        unsafe {
            self.device.cmd_begin_render_pass(commands, &begin, vk::SubpassContents::INLINE);
            self.device.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[self.set], &[]);
            for (index, pipeline) in (0..samples).zip(&self.pipelines) {
                let constants = [SIZE[0], samples, index];
                self.device.cmd_bind_pipeline(commands, point, *pipeline);
                self.device.cmd_push_constants(
                    commands,
                    self.layout,
                    vk::ShaderStageFlags::FRAGMENT,
                    0,
                    bytemuck::cast_slice(&constants),
                );
                self.device.cmd_draw(commands, 3, 1, 0, 0);
            }
            self.device.cmd_end_render_pass(commands);
        }
    }
}

/// # Safety
/// The device is alive.
unsafe fn make_render_pass(device: &ash::Device, samples: u32, count: usize) -> vk::RenderPass {
    let attachment = vk::AttachmentDescription::default()
        .format(vk::Format::R32G32B32A32_SFLOAT)
        .samples(vk::SampleCountFlags::from_raw(samples))
        .load_op(vk::AttachmentLoadOp::DONT_CARE)
        .store_op(vk::AttachmentStoreOp::STORE)
        .initial_layout(vk::ImageLayout::UNDEFINED)
        .final_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    let attachments = vec![attachment; count];
    let references: Vec<_> = (0..count as u32)
        .map(|attachment| vk::AttachmentReference {
            attachment,
            layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        })
        .collect();
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&references)];
    let written = [vk::SubpassDependency::default()
        .src_subpass(0)
        .dst_subpass(vk::SUBPASS_EXTERNAL)
        .src_stage_mask(vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT)
        .src_access_mask(vk::AccessFlags::COLOR_ATTACHMENT_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags::COMPUTE_SHADER)
        .dst_access_mask(vk::AccessFlags::SHADER_READ)];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&written);
    // SAFETY: The same contract.
    unsafe { device.create_render_pass(&info, None) }.unwrap()
}

/// # Safety
/// The device is alive, as the layout and the render pass are.
unsafe fn make_pipeline(
    device: &ash::Device,
    (layout, render_pass): (vk::PipelineLayout, vk::RenderPass),
    samples: u32,
    index: u32,
) -> vk::Pipeline {
    let words = |bytes: &[u8]| bytemuck::pod_collect_to_vec::<u8, u32>(bytes);
    let [vertex, fragment] = [VERTEX, FRAGMENT].map(|bytes| {
        // SAFETY: The same contract; the words are SPIR-V.
        unsafe {
            device.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words(bytes)), None)
        }
        .unwrap()
    });
    let stage = |stage, module| {
        vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
    };
    let stages =
        [stage(vk::ShaderStageFlags::VERTEX, vertex), stage(vk::ShaderStageFlags::FRAGMENT, fragment)];
    let vertices = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewports = [vk::Viewport {
        width: SIZE[0] as f32,
        height: SIZE[1] as f32,
        max_depth: 1.0,
        ..Default::default()
    }];
    let scissors =
        [vk::Rect2D { extent: vk::Extent2D { width: SIZE[0], height: SIZE[1] }, ..Default::default() }];
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewports(&viewports).scissors(&scissors);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let mask = [1 << index];
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::from_raw(samples))
        .sample_mask(&mask);
    let write =
        vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    let writes = [write; 3];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&writes);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertices)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .color_blend_state(&blend)
        .layout(layout)
        .render_pass(render_pass);
    // SAFETY: As above; modules may go when the pipeline is there.
    unsafe {
        let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None).unwrap();
        device.destroy_shader_module(vertex, None);
        device.destroy_shader_module(fragment, None);
        made[0]
    }
}
