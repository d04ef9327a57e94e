//! Arealight's pass among wgpu's: wgpu-hal's handles, and what wgpu must be told.

use crate::g_buffer::{GBuffer, clip_from_view, view};
use crate::{Gpu, Result};
use arealight::plan::{Output, ShadeOptions};
use arealight::{Light, PackedLights, Plane};
use arealight_examples::scene;
use arealight_vk::{
    Context, Resource, ShadeFrame, ShadePass, ShadeResources, TableFormat, TableImage, Viewport,
};
use ash::vk;
use wgpu::hal::api::Vulkan;

/// Bytes of a buffer of lights: more than the scene's need.
const ROOM: u64 = 1 << 16;

/// What fails where the device is not Vulkan's.
const NOT_VULKAN: &str = "wgpu runs on another interface than Vulkan";

/// The pass, and what it reads and writes.
pub struct Shading {
    device: ash::Device,
    pass: ShadePass,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    table: Option<TableImage>,
    table_memory: vk::DeviceMemory,
    lights: wgpu::Buffer,
    light_vertices: wgpu::Buffer,
    // The set has their handles
    _views: [wgpu::TextureView; 4],
    gpu: wgpu::Device,
}

impl Shading {
    /// Makes the pass, uploads the table, and points a set at the G-buffer's images.
    ///
    /// # Errors
    /// Where the device is not Vulkan's, or refuses.
    pub fn new(gpu: &Gpu, g_buffer: &GBuffer) -> Result<Self> {
        // doc: context
        // SAFETY: the handles are wgpu's, belong together, and nothing here destroys them.
        let hal = unsafe { gpu.device.as_hal::<Vulkan>() }.ok_or(NOT_VULKAN)?;
        let instance = hal.shared_instance().raw_instance();
        // SAFETY: wgpu's device, which `Shading` holds a reference to, outlives what is made of the context.
        let context = unsafe { Context::new(instance, hal.raw_physical_device(), hal.raw_device()) }?;
        // doc end
        let device = hal.raw_device().clone();
        let options = ShadeOptions { from_depth: true, output: Output::Add, ..ShadeOptions::default() };
        // SAFETY: the pass is dropped when the device is idle: `drop`.
        let pass = unsafe { ShadePass::new(&context, options) }?;
        // SAFETY: the image is uploaded to before it is read.
        let (table, table_memory) = unsafe { upload_table(gpu, &context, &hal) }?;

        // doc: set
        // A set of a pool of yours; views and buffers by their raw handles
        let (pool, set) = allocate(&device, &pass)?;
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let [lights, light_vertices] = [storage; 2].map(|usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: ROOM,
                usage,
                mapped_at_creation: false,
            })
        });
        let [normal, base_color, radiance] = &g_buffer.colors;
        let views = [&g_buffer.depth, normal, base_color, radiance].map(view);
        let [depth, normal, base_color, radiance] = [0, 1, 2, 3].map(|index| raw_view(&views[index]));
        let resources = ShadeResources {
            table: table.resource(),
            lights: Resource::buffer(raw_buffer(&lights)?),
            light_vertices: Resource::buffer(raw_buffer(&light_vertices)?),
            planes: [
                (Plane::Position, Resource::depth(depth?)),
                (Plane::Normal, Resource::sampled(normal?)),
                (Plane::BaseColor, Resource::sampled(base_color?)),
            ]
            .into(),
            radiance: Resource::stored(radiance?),
            ..ShadeResources::default()
        };
        // SAFETY: no pending frame uses the set, and `Shading` holds what it points to.
        unsafe { pass.write_set(set, &resources) }?;
        // doc end
        let gpu = gpu.device.clone();
        Ok(Self {
            device,
            pass,
            pool,
            set,
            table: Some(table),
            table_memory,
            lights,
            light_vertices,
            _views: views,
            gpu,
        })
    }

    // doc: hand_over
    /// Records wgpu's own barriers: what our commands read, and write, is in the state and layout that they
    /// want, and wgpu knows so.
    pub fn hand_over(&self, gpu: &Gpu, g_buffer: &GBuffer) -> wgpu::CommandBuffer {
        let [normal, base_color, radiance] = &g_buffer.colors;
        let texture = |texture, state| wgpu::TextureTransition { texture, selector: None, state };
        let buffer = |buffer| wgpu::BufferTransition { buffer, state: wgpu::BufferUses::STORAGE_READ_ONLY };
        let mut commands = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        commands.transition_resources(
            [&self.lights, &self.light_vertices].map(buffer).into_iter(),
            [
                texture(&g_buffer.depth, wgpu::TextureUses::RESOURCE),
                texture(normal, wgpu::TextureUses::RESOURCE),
                texture(base_color, wgpu::TextureUses::RESOURCE),
                texture(radiance, wgpu::TextureUses::STORAGE_READ_WRITE),
            ]
            .into_iter(),
        );
        commands.finish()
    }
    // doc end

    // doc: record
    /// Records our commands, into an encoder that no command of wgpu's is in.
    ///
    /// # Errors
    /// Where a light is wrong, or the device refuses.
    pub fn record(&self, gpu: &Gpu, g_buffer: &GBuffer, lights: &[Light]) -> Result<wgpu::CommandBuffer> {
        let camera = scene::camera(g_buffer.size);
        let packed = PackedLights::new(lights, camera.position.as_dvec3())?;
        gpu.queue.write_buffer(&self.lights, 0, bytemuck::cast_slice(&packed.lights));
        gpu.queue.write_buffer(&self.light_vertices, 0, bytemuck::cast_slice(&packed.vertices));
        let [width, height] = g_buffer.size.map(|side| side as f32);
        let frame = ShadeFrame {
            size: g_buffer.size,
            // wgpu has y up in clip space: its viewports have a negative height
            viewport: Some(Viewport {
                x: 0.0,
                y: height,
                width,
                height: -height,
                min_depth: 0.0,
                max_depth: 1.0,
            }),
            position_from_clip: Some(clip_from_view(&camera).inverse()),
            lights: packed.summary(),
            ..ShadeFrame::default()
        };
        record_raw(gpu, |commands| {
            // SAFETY: the commands are being recorded, and what the set points to is handed over before them.
            unsafe { self.pass.record(commands, self.set, &frame) }?;
            Ok(())
        })
    }
    // doc end
}

impl Drop for Shading {
    fn drop(&mut self) {
        // Wait for what uses the pass; where that fails the device is lost, and nothing is in use
        let _ = self.gpu.poll(wgpu::PollType::wait_indefinitely());
        self.table = None;
        // SAFETY: these are ours, and no longer in use.
        unsafe {
            self.device.destroy_descriptor_pool(self.pool, None);
            self.device.free_memory(self.table_memory, None);
        }
    }
}

// doc: raw
/// An encoder with raw commands alone: wgpu panics where one has both.
fn record_raw(
    gpu: &Gpu,
    record: impl FnOnce(vk::CommandBuffer) -> Result<()>,
) -> Result<wgpu::CommandBuffer> {
    let mut commands = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    // SAFETY: the command buffer is recorded to, and neither ended nor kept.
    unsafe {
        commands.as_hal_mut::<Vulkan, _, _>(|hal| record(hal.ok_or(NOT_VULKAN)?.raw_handle()))?;
    }
    Ok(commands.finish())
}
// doc end

/// The handle of a view.
fn raw_view(view: &wgpu::TextureView) -> Result<vk::ImageView> {
    // SAFETY: the handle is not destroyed.
    let hal = unsafe { view.as_hal::<Vulkan>() }.ok_or(NOT_VULKAN)?;
    // SAFETY: as above.
    Ok(unsafe { hal.raw_handle() })
}

/// The handle of a buffer.
fn raw_buffer(buffer: &wgpu::Buffer) -> Result<vk::Buffer> {
    // SAFETY: the handle is not destroyed.
    let hal = unsafe { buffer.as_hal::<Vulkan>() }.ok_or(NOT_VULKAN)?;
    // SAFETY: as above.
    Ok(unsafe { hal.raw_handle() })
}

/// A pool with one set.
fn allocate(device: &ash::Device, pass: &ShadePass) -> Result<(vk::DescriptorPool, vk::DescriptorSet)> {
    let sizes = pass.pool_sizes(1);
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    // SAFETY: the device is live.
    let pool = unsafe { device.create_descriptor_pool(&info, None) }?;
    let layouts = [pass.set_layout()];
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
    // SAFETY: pool and layout are live.
    let sets = unsafe { device.allocate_descriptor_sets(&info) }?;
    Ok((pool, sets[0]))
}

/// The table's image with memory of its own, and uploaded to.
///
/// # Safety
/// Memory is freed after the image, when neither is in use.
unsafe fn upload_table(
    gpu: &Gpu,
    context: &Context,
    hal: &wgpu::hal::vulkan::Device,
) -> Result<(TableImage, vk::DeviceMemory)> {
    let table = arealight::LightTable::ggx();
    // SAFETY: the caller's duty.
    let mut image = unsafe { TableImage::new(context, &table, TableFormat::Rgba16Float) }?;
    let needed = image.memory_requirements();
    // SAFETY: the handles are live.
    let types = unsafe {
        hal.shared_instance().raw_instance().get_physical_device_memory_properties(hal.raw_physical_device())
    };
    let local = |index: &u32| {
        needed.memory_type_bits & (1 << index) != 0
            && types.memory_types[*index as usize]
                .property_flags
                .contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
    };
    let index = (0..types.memory_type_count).find(local).ok_or("no memory for the table")?;
    let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(index);
    // SAFETY: the device is live.
    let memory = unsafe { hal.raw_device().allocate_memory(&info, None) }?;
    // SAFETY: the memory is as the image needs it.
    unsafe { image.bind_memory(memory, 0) }?;

    // Upload through a buffer that wgpu fills
    let bytes = image.bytes(&table);
    let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes.len() as u64,
        usage,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&staging, 0, &bytes);
    let mut handed_over = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let source = wgpu::BufferTransition { buffer: &staging, state: wgpu::BufferUses::COPY_SRC };
    handed_over.transition_resources([source].into_iter(), std::iter::empty());
    let raw = raw_buffer(&staging)?;
    let uploaded = record_raw(gpu, |commands| {
        // SAFETY: the buffer holds the table, and is waited for below.
        unsafe { image.record_upload(commands, raw, 0) };
        Ok(())
    })?;
    gpu.queue.submit([handed_over.finish(), uploaded]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok((image, memory))
}
