//! From radiance to what a screen takes, on the GPU: a compute pass between the engine's image and a
//! window's.

use crate::Result;
use crate::draw::{image, shader_module};
use arealight_host::{DescriptorPool, Host, Image};
use ash::vk;

/// Pixels a side of a workgroup of `tone_map.comp`.
const GROUP: u32 = 8;

/// The pass, for one image of radiance.
pub struct ToneMap {
    host: Host,
    shown: Image,
    size: [u32; 2],
    sets: DescriptorPool,
    set: vk::DescriptorSet,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl ToneMap {
    /// Makes the pass for an image of `size` pixels, of `R32G32B32A32_SFLOAT`, in `GENERAL` layout.
    ///
    /// # Safety
    /// The image outlives the use of this, and no pending work uses this when it is dropped.
    pub unsafe fn new(host: &Host, radiance: &Image, size: [u32; 2]) -> Result<Self> {
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC;
        let shown = image(host, "shown", vk::Format::R8G8B8A8_UNORM, size, usage)?;
        let kind = vk::DescriptorType::STORAGE_IMAGE;
        let sets =
            host.descriptor_pool(1, &[vk::DescriptorPoolSize::default().ty(kind).descriptor_count(2)])?;
        let mut made = Self {
            host: host.clone(),
            shown,
            size,
            sets,
            set: vk::DescriptorSet::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
        };
        made.make_pipeline(kind)?;

        // SAFETY: the layout is the device's.
        made.set = unsafe { made.sets.allocate(made.set_layout) }?;
        let images = [radiance.view(), made.shown.view()].map(|view| {
            let info = vk::DescriptorImageInfo::default();
            [info.image_view(view).image_layout(vk::ImageLayout::GENERAL)]
        });
        let write = vk::WriteDescriptorSet::default().dst_set(made.set).descriptor_type(kind);
        let writes =
            [write.dst_binding(0).image_info(&images[0]), write.dst_binding(1).image_info(&images[1])];
        // SAFETY: nothing uses the set yet.
        unsafe { host.device().update_descriptor_sets(&writes, &[]) };
        Ok(made)
    }

    fn make_pipeline(&mut self, kind: vk::DescriptorType) -> Result<()> {
        let device = self.host.device();
        let binding = |index| {
            let binding = vk::DescriptorSetLayoutBinding::default().binding(index).descriptor_count(1);
            binding.descriptor_type(kind).stage_flags(vk::ShaderStageFlags::COMPUTE)
        };
        let bindings = [binding(0), binding(1)];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device is alive, and what infos point to outlives the calls; so below.
        self.set_layout = unsafe { device.create_descriptor_set_layout(&info, None) }?;
        let layouts = [self.set_layout];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
        // SAFETY: as above.
        self.layout = unsafe { device.create_pipeline_layout(&info, None) }?;

        let module = shader_module(&self.host, include_bytes!("../spirv/tone_map.spv"))?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main");
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(self.layout);
        // SAFETY: as above; the pipeline does not need its module once it is made.
        let made = unsafe {
            let made = device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
            device.destroy_shader_module(module, None);
            made
        };
        self.pipeline = made.map_err(|(_, error)| error)?[0];
        Ok(())
    }

    /// Records the pass behind compute work that wrote the radiance, and a copy of the picture to `target`:
    /// an image of the same size that can be blitted to, whose contents are lost, and which is left in
    /// `layout`.
    ///
    /// # Safety
    /// The commands are being recorded, and the image is free from the stage `TRANSFER` on.
    pub unsafe fn record(&self, commands: vk::CommandBuffer, target: vk::Image, layout: vk::ImageLayout) {
        let Self { host, shown, size: [width, height], .. } = self;
        let (compute, transfer) = (vk::PipelineStageFlags::COMPUTE_SHADER, vk::PipelineStageFlags::TRANSFER);
        let (undefined, general) = (vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let copied = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let (none, written) = (vk::AccessFlags::empty(), vk::AccessFlags::SHADER_WRITE);
        let (read, copy) = (vk::AccessFlags::TRANSFER_READ, vk::AccessFlags::TRANSFER_WRITE);
        // SAFETY: the caller's contract.
        unsafe {
            // Behind the copy of the frame before, and what wrote the radiance
            let radiance = [vk::MemoryBarrier::default()
                .src_access_mask(written)
                .dst_access_mask(vk::AccessFlags::SHADER_READ)];
            let anew = [transition(shown.handle(), [undefined, general], [none, written])];
            self.barrier(commands, [compute | transfer, compute], &radiance, &anew);
            let point = vk::PipelineBindPoint::COMPUTE;
            host.device().cmd_bind_pipeline(commands, point, self.pipeline);
            host.device().cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[self.set], &[]);
            host.device().cmd_dispatch(commands, width.div_ceil(GROUP), height.div_ceil(GROUP), 1);

            // A blit, which converts what differs in format
            let ready = transition(shown.handle(), [general, source], [written, read]);
            self.barrier(commands, [compute, transfer], &[], &[ready]);
            let lost = transition(target, [undefined, copied], [none, copy]);
            self.barrier(commands, [transfer, transfer], &[], &[lost]);
            let layers =
                vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
            let end = vk::Offset3D { x: width.cast_signed(), y: height.cast_signed(), z: 1 };
            let whole = [vk::Offset3D::default(), end];
            let blit = vk::ImageBlit::default()
                .src_subresource(layers)
                .src_offsets(whole)
                .dst_subresource(layers)
                .dst_offsets(whole);
            let nearest = vk::Filter::NEAREST;
            host.device().cmd_blit_image(commands, shown.handle(), source, target, copied, &[blit], nearest);
            let left = transition(target, [copied, layout], [copy, none]);
            self.barrier(commands, [transfer, vk::PipelineStageFlags::BOTTOM_OF_PIPE], &[], &[left]);
        }
    }

    /// # Safety
    /// The commands are being recorded.
    unsafe fn barrier(
        &self,
        commands: vk::CommandBuffer,
        [from, to]: [vk::PipelineStageFlags; 2],
        memory: &[vk::MemoryBarrier<'_>],
        images: &[vk::ImageMemoryBarrier<'_>],
    ) {
        let (device, no_flags) = (self.host.device(), vk::DependencyFlags::empty());
        // SAFETY: the same contract.
        unsafe { device.cmd_pipeline_barrier(commands, from, to, no_flags, memory, &[], images) };
    }
}

impl Drop for ToneMap {
    fn drop(&mut self) {
        let device = self.host.device();
        // SAFETY: by the contract of ToneMap::new nothing is pending; null handles are ignored.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

/// What happens to a whole image between two accesses.
fn transition(
    image: vk::Image,
    [old, new]: [vk::ImageLayout; 2],
    [before, after]: [vk::AccessFlags; 2],
) -> vk::ImageMemoryBarrier<'static> {
    let whole = vk::ImageSubresourceRange::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .level_count(1)
        .layer_count(1);
    vk::ImageMemoryBarrier::default()
        .image(image)
        .subresource_range(whole)
        .old_layout(old)
        .new_layout(new)
        .src_access_mask(before)
        .dst_access_mask(after)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
}
