//! A forward engine: its fragment shader includes the GLSL library, and reads table and lights by bridges of
//! its own.

use crate::Result;
use crate::draw::{Draw, DrawOptions, Users, image};
use crate::picture::Picture;
use crate::recorded::upload_table;
use crate::scene;
use arealight::{LightTable, PackedLights};
use arealight_host::{
    Buffer, DescriptorPool, FRAMES_IN_FLIGHT, Frames, Host, Image, Location, Memory, Usage,
};
use arealight_vk::{Context, TableImage};
use ash::vk;
use bytemuck::{Pod, Zeroable};

/// The engine, with images of one size. Fields are dropped from the top, as those of the deferred one.
pub struct Forward {
    frames: Frames,
    places: Vec<Place>,
    draw: Draw,
    _sets: DescriptorPool,
    _bindings: Bindings,
    _table: TableImage,
    _table_memory: Memory,
    radiance: Image,
    _depth: Image,
    size: [u32; 2],
}

/// What each frame in flight has for itself.
struct Place {
    vertices: Buffer,
    lamps: Buffer,
    set: vk::DescriptorSet,
}

// doc: lamps
/// A light as `forward.frag` reads it: of [`arealight::gpu::GpuLight`] what lights without a texture need.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Lamp {
    radiance: [f32; 3],
    first_vertex: u32,
    center: [f32; 3],
    vertex_count: u32,
    normal: [f32; 3],
    reserved: f32,
}

/// The uniform buffer of `forward.frag`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Uniforms {
    lamps: [Lamp; 16],
    vertices: [[f32; 4]; 64],
    lamp_count: u32,
}

impl Uniforms {
    fn new(packed: &PackedLights) -> Result<Self> {
        let mut all = Self::zeroed();
        if packed.lights.len() > all.lamps.len() || packed.vertices.len() > all.vertices.len() {
            return Err("more lights than the uniform buffer holds".into());
        }
        for (lamp, light) in all.lamps.iter_mut().zip(&packed.lights) {
            *lamp = Lamp {
                radiance: light.radiance,
                first_vertex: light.first_vertex,
                center: light.center,
                vertex_count: light.vertex_count,
                normal: light.normal,
                reserved: 0.0,
            };
        }
        all.vertices[..packed.vertices.len()].copy_from_slice(&packed.vertices);
        all.lamp_count = packed.lights.len() as u32;
        Ok(all)
    }
}
// doc end

impl Forward {
    /// Makes the engine for pictures of `size` pixels.
    pub fn new(host: &Host, size: [u32; 2]) -> Result<Self> {
        let frames = Frames::new(host)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let radiance = image(host, "radiance", vk::Format::R32G32B32A32_SFLOAT, size, usage)?;
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let depth = image(host, "depth", vk::Format::D32_SFLOAT, size, usage)?;

        // Give the light table memory, and fill it
        // SAFETY: the handles are of one device, which goes after the image, which goes after the frames.
        let context = unsafe { Context::new(host.instance(), host.physical_device(), host.device()) }?;
        let (table, table_memory) = upload_table(host, &context, &LightTable::ggx())?;

        // Point a set at the table and at each place's lights
        let bindings = Bindings::new(host)?;
        let sets = host.descriptor_pool(FRAMES_IN_FLIGHT as u32, &Bindings::pool_sizes())?;
        let mut places = vec![];
        for _ in 0..FRAMES_IN_FLIGHT {
            let bytes = size_of_val(scene::vertices(0.0).as_slice()) as u64;
            let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
            let place = Place {
                vertices: host.buffer(
                    "vertices",
                    bytes,
                    vk::BufferUsageFlags::VERTEX_BUFFER,
                    Location::Upload,
                )?,
                lamps: host.buffer("lamps", size_of::<Uniforms>() as u64, uniform, Location::Upload)?,
                // SAFETY: the layout is ours.
                set: unsafe { sets.allocate(bindings.layout) }?,
            };
            // SAFETY: the set is new, and goes before table and buffer.
            unsafe { bindings.write(place.set, &table, &place.lamps) };
            places.push(place);
        }

        let options = DrawOptions {
            colors: &[(&radiance, vk::ImageLayout::TRANSFER_SRC_OPTIMAL)],
            depth: &depth,
            size,
            fragment: include_bytes!("../spirv/forward.frag.spv"),
            set_layout: Some(bindings.layout),
            users: Users::TRANSFER_READ,
        };
        // SAFETY: images and layout outlive the drawing, which is dropped after the frames.
        let draw = unsafe { Draw::new(host, &options) }?;
        Ok(Self {
            frames,
            places,
            draw,
            _sets: sets,
            _bindings: bindings,
            _table: table,
            _table_memory: table_memory,
            radiance,
            _depth: depth,
            size,
        })
    }

    /// Draws the scene as it is after `seconds`. Waits for nothing but the frame before the last.
    pub fn frame(&mut self, seconds: f64) -> Result<()> {
        let Self { frames, places, draw, size, .. } = self;
        frames.submit(|place, commands| {
            let place = &places[place];
            // doc: frame
            let camera = scene::camera(*size);
            let packed = PackedLights::new(&scene::lights(seconds), camera.position.as_dvec3())?;
            place.lamps.upload(&[Uniforms::new(&packed)?])?;
            // doc end
            let vertices = scene::vertices(seconds);
            place.vertices.upload(&vertices)?;
            // SAFETY: the commands are being recorded; buffers and set are this place's.
            unsafe {
                draw.record(commands, &camera, place.vertices.handle(), vertices.len(), Some(place.set));
            }
            Ok(())
        })
    }

    /// Waits for the last frame, and returns its radiance.
    pub fn picture(&mut self) -> Result<Picture> {
        // What the render pass left is visible to transfers
        Picture::read(&self.frames, &self.radiance, Usage::COPY_SOURCE)
    }
}

/// Set 0 of `forward.frag`: the table with a sampler, and the lights.
struct Bindings {
    host: Host,
    sampler: vk::Sampler,
    layout: vk::DescriptorSetLayout,
}

impl Bindings {
    const TYPES: [vk::DescriptorType; 2] =
        [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::UNIFORM_BUFFER];

    fn new(host: &Host) -> Result<Self> {
        let bindings: Vec<_> = (0..)
            .zip(Self::TYPES)
            .map(|(number, kind)| {
                let binding = vk::DescriptorSetLayoutBinding::default().binding(number);
                binding.descriptor_type(kind).descriptor_count(1).stage_flags(vk::ShaderStageFlags::FRAGMENT)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let mut made = Self {
            host: host.clone(),
            sampler: vk::Sampler::null(),
            layout: vk::DescriptorSetLayout::null(),
        };
        // SAFETY: the device is alive. The table is read by texel, so that any sampler will do.
        unsafe {
            made.sampler = host.device().create_sampler(&vk::SamplerCreateInfo::default(), None)?;
            made.layout = host.device().create_descriptor_set_layout(&info, None)?;
        }
        Ok(made)
    }

    fn pool_sizes() -> [vk::DescriptorPoolSize; 2] {
        Self::TYPES.map(|ty| vk::DescriptorPoolSize { ty, descriptor_count: FRAMES_IN_FLIGHT as u32 })
    }

    /// # Safety
    /// As of `vkUpdateDescriptorSets`.
    unsafe fn write(&self, set: vk::DescriptorSet, table: &TableImage, lamps: &Buffer) {
        let image = [vk::DescriptorImageInfo {
            sampler: self.sampler,
            image_view: table.view(),
            image_layout: TableImage::LAYOUT,
        }];
        let buffer = [vk::DescriptorBufferInfo { buffer: lamps.handle(), offset: 0, range: vk::WHOLE_SIZE }];
        let write = |binding: u32| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(Self::TYPES[binding as usize])
        };
        let writes = [write(0).image_info(&image), write(1).buffer_info(&buffer)];
        // SAFETY: the caller's contract.
        unsafe { self.host.device().update_descriptor_sets(&writes, &[]) };
    }
}

impl Drop for Bindings {
    fn drop(&mut self) {
        // SAFETY: this goes after the frames.
        unsafe {
            self.host.device().destroy_descriptor_set_layout(self.layout, None);
            self.host.device().destroy_sampler(self.sampler, None);
        }
    }
}
