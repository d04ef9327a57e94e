//! Drawing the scene's triangles into images: a render pass with its only pipeline.

use crate::Result;
use crate::scene::{Camera, Vertex};
use arealight_host::{Host, Image, ImageDescription};
use ash::vk;
use std::mem::offset_of;

/// The size of [`Camera::constants`].
const CAMERA_BYTES: u32 = 19 * 4;

/// Who uses the images beside the drawing: stages, and what they do there.
#[derive(Clone, Copy)]
pub struct Users {
    /// Where.
    pub stages: vk::PipelineStageFlags,
    /// What.
    pub access: vk::AccessFlags,
}

impl Users {
    /// Copies from them.
    pub const TRANSFER_READ: Self =
        Self { stages: vk::PipelineStageFlags::TRANSFER, access: vk::AccessFlags::TRANSFER_READ };

    /// Compute shaders that write them.
    pub const COMPUTE_WRITE: Self =
        Self { stages: vk::PipelineStageFlags::COMPUTE_SHADER, access: vk::AccessFlags::SHADER_WRITE };
}

impl std::ops::BitOr for Users {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self { stages: self.stages | other.stages, access: self.access | other.access }
    }
}

/// What is drawn how.
pub struct DrawOptions<'a> {
    /// The images drawn to, by location, each with the layout it is left in.
    pub colors: &'a [(&'a Image, vk::ImageLayout)],
    /// The depth buffer. It is left readable.
    pub depth: &'a Image,
    /// The size of all of them.
    pub size: [u32; 2],
    /// The fragment shader, whose set 0 has the layout `set_layout`, if any.
    pub fragment: &'static [u8],
    /// See there.
    pub set_layout: Option<vk::DescriptorSetLayout>,
    /// Who uses the images between one drawing and the next.
    pub users: Users,
}

/// A render pass that clears its images and draws the scene.
pub struct Draw {
    host: Host,
    size: [u32; 2],
    clears: Vec<vk::ClearValue>,
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl Draw {
    /// Makes the render pass, its framebuffer and its pipeline.
    ///
    /// # Safety
    /// The images and the layout outlive this, and no pending work uses it when it is dropped.
    pub unsafe fn new(host: &Host, options: &DrawOptions<'_>) -> Result<Self> {
        // Far away is 0
        let mut clears = vec![vk::ClearValue::default(); options.colors.len()];
        clears.push(vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil: 0 } });
        let mut draw = Self {
            host: host.clone(),
            size: options.size,
            clears,
            render_pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
        };
        draw.make_render_pass(options)?;
        draw.make_pipeline(options)?;
        Ok(draw)
    }

    fn make_render_pass(&mut self, options: &DrawOptions<'_>) -> Result<()> {
        let depth_layout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        let images: Vec<_> = options.colors.iter().copied().chain([(options.depth, depth_layout)]).collect();
        let attachments: Vec<_> = images
            .iter()
            .map(|(image, left_in)| {
                vk::AttachmentDescription::default()
                    .format(image.format())
                    .samples(vk::SampleCountFlags::TYPE_1)
                    .load_op(vk::AttachmentLoadOp::CLEAR)
                    .store_op(vk::AttachmentStoreOp::STORE)
                    .final_layout(*left_in)
            })
            .collect();
        let colors: Vec<_> = (0..options.colors.len() as u32)
            .map(|index| {
                vk::AttachmentReference::default()
                    .attachment(index)
                    .layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            })
            .collect();
        let depth = vk::AttachmentReference::default()
            .attachment(colors.len() as u32)
            .layout(vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        let subpasses = [vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colors)
            .depth_stencil_attachment(&depth)];

        // Wait for the users of the last picture before, and let those of this one wait after
        let stages = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT
            | vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS
            | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS;
        let access =
            vk::AccessFlags::COLOR_ATTACHMENT_WRITE | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE;
        let Users { stages: user_stages, access: user_access } = options.users;
        let before = vk::SubpassDependency::default()
            .src_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(user_stages | stages)
            .src_access_mask(user_access | access)
            .dst_stage_mask(stages)
            .dst_access_mask(access | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ);
        let after = vk::SubpassDependency::default()
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(stages)
            .src_access_mask(access)
            .dst_stage_mask(user_stages)
            .dst_access_mask(user_access);
        let dependencies = [before, after];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses)
            .dependencies(&dependencies);
        let views: Vec<_> = images.iter().map(|(image, _)| image.view()).collect();
        // SAFETY: the device is alive, and what infos point to outlives the calls.
        unsafe {
            self.render_pass = self.host.device().create_render_pass(&info, None)?;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(self.render_pass)
                .attachments(&views)
                .width(self.size[0])
                .height(self.size[1])
                .layers(1);
            self.framebuffer = self.host.device().create_framebuffer(&info, None)?;
        }
        Ok(())
    }

    fn make_pipeline(&mut self, options: &DrawOptions<'_>) -> Result<()> {
        let device = self.host.device();
        let set_layouts: Vec<_> = options.set_layout.into_iter().collect();
        let constants =
            [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::VERTEX).size(CAMERA_BYTES)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&set_layouts)
            .push_constant_ranges(&constants);
        // SAFETY: the device is alive, and what infos point to outlives the calls; so below.
        self.layout = unsafe { device.create_pipeline_layout(&info, None) }?;

        let vertex = shader_module(&self.host, include_bytes!("../spirv/scene.vert.spv"))?;
        let made = shader_module(&self.host, options.fragment).and_then(|fragment| {
            let made = self.make_pipeline_of(vertex, fragment, options.colors.len());
            // SAFETY: pipelines do not need their modules once they are made.
            unsafe { device.destroy_shader_module(fragment, None) };
            made
        });
        // SAFETY: as above.
        unsafe { device.destroy_shader_module(vertex, None) };
        self.pipeline = made?;
        Ok(())
    }

    fn make_pipeline_of(
        &self,
        vertex: vk::ShaderModule,
        fragment: vk::ShaderModule,
        colors: usize,
    ) -> Result<vk::Pipeline> {
        let stage = |stage, module| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        };
        let stages =
            [stage(vk::ShaderStageFlags::VERTEX, vertex), stage(vk::ShaderStageFlags::FRAGMENT, fragment)];
        let bindings = [vk::VertexInputBindingDescription::default().stride(size_of::<Vertex>() as u32)];
        let (three, four) = (vk::Format::R32G32B32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT);
        let attributes = [
            (three, offset_of!(Vertex, position)),
            (three, offset_of!(Vertex, normal)),
            (four, offset_of!(Vertex, base_color)),
            (four, offset_of!(Vertex, emission)),
        ];
        let attributes: Vec<_> = (0..)
            .zip(attributes)
            .map(|(location, (format, offset))| {
                let attribute = vk::VertexInputAttributeDescription::default().location(location);
                attribute.format(format).offset(offset as u32)
            })
            .collect();
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let extent = vk::Extent2D { width: self.size[0], height: self.size[1] };
        let viewports = [vk::Viewport {
            width: extent.width as f32,
            height: extent.height as f32,
            max_depth: 1.0,
            ..Default::default()
        }];
        let scissors = [extent.into()];
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewports(&viewports).scissors(&scissors);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(vk::CullModeFlags::BACK)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::GREATER);
        let opaque =
            vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
        let blends = vec![opaque; colors];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .layout(self.layout)
            .render_pass(self.render_pass);
        // SAFETY: as above.
        let made =
            unsafe { self.host.device().create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
        Ok(made.map_err(|(_, error)| error)?[0])
    }

    /// Records the drawing of `count` vertices.
    ///
    /// # Safety
    /// The commands are being recorded, outside a render pass; the buffer holds so many [`Vertex`]; the set
    /// is of the layout that this was made with.
    pub unsafe fn record(
        &self,
        commands: vk::CommandBuffer,
        camera: &Camera,
        vertices: vk::Buffer,
        count: usize,
        set: Option<vk::DescriptorSet>,
    ) {
        let device = self.host.device();
        let extent = vk::Extent2D { width: self.size[0], height: self.size[1] };
        let begin = vk::RenderPassBeginInfo::default()
            .render_pass(self.render_pass)
            .framebuffer(self.framebuffer)
            .render_area(extent.into())
            .clear_values(&self.clears);
        let point = vk::PipelineBindPoint::GRAPHICS;
        let (vertex, constants) = (vk::ShaderStageFlags::VERTEX, camera.constants());
        // SAFETY: the caller's contract.
        unsafe {
            device.cmd_begin_render_pass(commands, &begin, vk::SubpassContents::INLINE);
            device.cmd_bind_pipeline(commands, point, self.pipeline);
            if let Some(set) = set {
                device.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[set], &[]);
            }
            device.cmd_push_constants(commands, self.layout, vertex, 0, bytemuck::cast_slice(&constants));
            device.cmd_bind_vertex_buffers(commands, 0, &[vertices], &[0]);
            device.cmd_draw(commands, count as u32, 1, 0, 0);
            device.cmd_end_render_pass(commands);
        }
    }
}

impl Drop for Draw {
    fn drop(&mut self) {
        let device = self.host.device();
        // SAFETY: by the contract of Draw::new nothing is pending; null handles are ignored.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.render_pass, None);
        }
    }
}

/// A shader, which whoever asks for it destroys.
pub fn shader_module(host: &Host, spirv: &[u8]) -> Result<vk::ShaderModule> {
    let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let words: Vec<u32> = spirv.chunks_exact(4).map(word).collect();
    // Without what the effects and the quality, constants of a shader that includes the library, rule out
    let words = arealight_vk::prune(&words, &[]);
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: the device is alive, and the words outlive the call.
    Ok(unsafe { host.device().create_shader_module(&info, None) }?)
}

/// An image of one layer to draw to, for messages `name`.
///
/// # Errors
/// Where there is no memory left, or the device has no such images.
pub fn image(
    host: &Host,
    name: &str,
    format: vk::Format,
    extent: [u32; 2],
    usage: vk::ImageUsageFlags,
) -> Result<Image> {
    Ok(host.image(&ImageDescription { name, extent, layers: 1, format, usage })?)
}
