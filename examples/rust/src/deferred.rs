//! A deferred engine: it draws a G-buffer of its own, and Arealight shades it.

use crate::Result;
use crate::draw::{Draw, Users};
use crate::g_buffer::GBuffer;
use crate::gpu::{Buffer, DescriptorPool, FRAMES_IN_FLIGHT, Frames, Gpu, Image, Memory, Semaphores};
use crate::picture::{Picture, Readback};
use crate::scene;
use arealight::PackedLights;
use arealight::gpu::GpuLight;
use arealight::plan::{Output, ShadeOptions, TileOptions};
use arealight_vk::{
    Context, HostDevice, Resource, ShadeFrame, ShadePass, ShadeResources, TableFormat, TableImage,
    TileResources,
};
use ash::vk;
use glam::{Vec3, Vec4};

/// What the buffers of the lights have room for.
const MOST_LIGHTS: usize = 16;

/// The engine, with images of one size. Fields are dropped from the top: frames in flight end first, and memory goes
/// after what lies in it.
pub struct Deferred<'a> {
    frames: Frames<'a>,
    places: Vec<Place<'a>>,
    readback: Readback<'a>,
    draw: Draw<'a>,
    shade: ShadePass,
    users: Users,
    _sets: DescriptorPool<'a>,
    table: TableImage,
    _table_memory: Memory<'a>,
    lobe_horizons: Buffer<'a>,
    g_buffer: GBuffer<'a>,
    size: [u32; 2],
    gpu: &'a Gpu<'a>,
}

/// What each frame in flight has for itself, because the CPU writes it anew for every frame.
struct Place<'a> {
    vertices: Buffer<'a>,
    lights: Buffer<'a>,
    light_vertices: Buffer<'a>,
    tile_lists: Buffer<'a>,
    set: vk::DescriptorSet,
}

impl<'a> Deferred<'a> {
    /// Makes the engine for pictures of `size` pixels.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &'a Gpu<'a>, size: [u32; 2]) -> Result<Self> {
        let mut frames = Frames::new(gpu)?;
        let g_buffer = GBuffer::new(gpu, size)?;

        // doc: context
        // Hand over the device: handles only, which stay yours
        let host = HostDevice {
            instance: gpu.instance,
            physical_device: gpu.physical_device,
            device: &gpu.device,
            pipeline_cache: vk::PipelineCache::null(), // or yours
        };
        // SAFETY: the handles belong together, and outlive what is made of the context.
        let context = unsafe { Context::new(&host) }?;
        // doc end

        // doc: pass
        // Make the pass for the way in which your surfaces are stored; it takes every kind of light
        let options = ShadeOptions {
            from_depth: true,
            output: Output::Add, // to the emission that was drawn
            ..ShadeOptions::default()
        };
        g_buffer.formats().check(options)?; // says which image has another format than it should
        let table = arealight_table::ggx();
        // With tiles, for scenes of many lights; without, ShadePass::new. (Of two lights, as here, tiles would save nothing, and
        // TileOptions::default() would classify none.)
        let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
        // SAFETY: the pass is dropped after the frames, and before the device.
        let shade = unsafe { ShadePass::with_tiles(&context, options, tiles, table.size()) }?;
        // doc end

        // doc: table
        // Give the light table memory, and fill it
        let format = TableFormat::Rgba16Float;
        // SAFETY: the image goes after the frames, and its memory after the image.
        let mut image = unsafe { TableImage::new(&context, &table, format) }?;
        let memory = gpu.device_memory(image.memory_requirements())?;
        // SAFETY: the memory was made for the image.
        unsafe { image.bind_memory(memory.raw, 0) }?;
        let bytes = format.bytes(&table);
        let staging = gpu.buffer(vk::BufferUsageFlags::TRANSFER_SRC, bytes.len())?;
        staging.write(&bytes)?;
        frames.submit(|_, commands| {
            // SAFETY: the staging buffer holds the table until the wait below.
            unsafe { image.record_upload(commands, staging.raw, 0) };
            Ok(())
        })?;
        frames.wait()?;
        // doc end

        // doc: tiles
        // With tiles: upload where the horizons of the table's lobes are
        let horizons = table.lobe_horizons();
        let bytes: &[u8] = bytemuck::cast_slice(&horizons);
        let lobe_horizons = gpu.buffer(vk::BufferUsageFlags::STORAGE_BUFFER, bytes.len())?;
        lobe_horizons.write(bytes)?;
        // doc end

        // doc: sets
        // Allocate a descriptor set from a pool of yours for each frame in flight
        let sets = DescriptorPool::new(gpu, &shade.pool_sizes(FRAMES_IN_FLIGHT as u32))?;
        let mut places = vec![];
        for _ in 0..FRAMES_IN_FLIGHT {
            // SAFETY: the layout is the pass's.
            let set = unsafe { sets.allocate(shade.set_layout()) }?;
            places.push(Place::new(gpu, tile_lists(gpu, &shade, size)?, set)?);
        }
        // doc end

        // doc: barriers
        // Place your barriers by what the pass says of itself: here, in the render pass
        let accesses = shade.accesses();
        let users = Users {
            stages: accesses.iter().fold(vk::PipelineStageFlags::TRANSFER, |all, one| all | one.stage),
            access: accesses.iter().fold(vk::AccessFlags::TRANSFER_READ, |all, one| all | one.access),
        };
        // doc end
        // SAFETY: the images outlive the drawing, which is dropped after the frames.
        let draw = unsafe { g_buffer.make_draw(gpu, size, users) }?;
        let engine = Self {
            frames,
            places,
            readback: Readback::new(gpu, size)?,
            draw,
            shade,
            users,
            _sets: sets,
            table: image,
            _table_memory: memory,
            lobe_horizons,
            g_buffer,
            size,
            gpu,
        };
        engine.write_sets()?;
        Ok(engine)
    }

    /// Points the sets at the images and buffers; no frame is in flight.
    fn write_sets(&self) -> Result<()> {
        let Self { table, g_buffer, lobe_horizons, .. } = self;
        // doc: write
        // Point the sets at your images and buffers
        let sampled = |image: &Image<'_>, layout| Resource::SampledImage { view: image.view, layout };
        let read_only = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        for place in &self.places {
            let resources = ShadeResources {
                table: table.resource(),
                lights: Resource::buffer(place.lights.raw),
                light_vertices: Resource::buffer(place.light_vertices.raw),
                shapes: None,         // without disks, spheres and tubes
                light_textures: None, // without textured lights
                position: sampled(&g_buffer.depth, vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL),
                normal: sampled(&g_buffer.normal_roughness, read_only),
                base_color: sampled(&g_buffer.base_color_metalness, read_only),
                specular: None, // without Effects::SPECULAR_INPUT
                coat: None,     // without Effects::COAT
                radiance: Resource::StorageImage { view: g_buffer.radiance.view },
                glossy: None, // its radiance is in that image too, without ShadeOptions::separate_lobes
                picks: None,  // without shadow rays
                tiles: Some(TileResources {
                    lobe_horizons: Resource::buffer(lobe_horizons.raw),
                    tile_lists: Resource::buffer(place.tile_lists.raw),
                }), // without tiles, None
            };
            // SAFETY: no pending frame uses the set, and the resources outlive its next use.
            unsafe { self.shade.write_set(place.set, &resources) }?;
        }
        // doc end
        Ok(())
    }

    /// Goes on with pictures of another size. Waits for the frames in flight.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        // doc: resize
        // Make images and what draws to them anew when no frame uses them, and point the sets at them: the pass knows no size
        self.frames.wait()?;
        let (g_buffer, readback) = (GBuffer::new(self.gpu, size)?, Readback::new(self.gpu, size)?);
        // SAFETY: as in Deferred::new; the drawing before goes before its images.
        self.draw = unsafe { g_buffer.make_draw(self.gpu, size, self.users) }?;
        for place in &mut self.places {
            place.tile_lists = tile_lists(self.gpu, &self.shade, size)?;
        }
        (self.g_buffer, self.readback, self.size) = (g_buffer, readback, size);
        self.write_sets()
        // doc end
    }

    /// The image of the radiance, which a frame leaves in `GENERAL` layout; another after [`Deferred::resize`].
    pub fn radiance(&self) -> &Image<'a> {
        &self.g_buffer.radiance
    }

    /// Draws and shades the scene as it is after `seconds`. Waits for nothing but the frame before the last.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn frame(&mut self, seconds: f64) -> Result<()> {
        self.frame_then(seconds, |_, _| Ok(Semaphores::default()))
    }

    /// Likewise, and records `then` behind it, which is given the place among the frames in flight, and the commands.
    ///
    /// # Errors
    /// As [`Deferred::frame`], and those of `then`.
    pub fn frame_then(
        &mut self,
        seconds: f64,
        then: impl FnOnce(usize, vk::CommandBuffer) -> Result<Semaphores>,
    ) -> Result<()> {
        let Self { frames, places, draw, shade, size, .. } = self;
        frames.submit_with(|index, commands| {
            let place = &places[index];
            // doc: frame
            // Write what is new in this frame: no other frame reads this place's buffers
            let camera = scene::camera(*size);
            let packed = PackedLights::new(&scene::lights(seconds), camera.position.as_dvec3())?;
            place.lights.write(bytemuck::cast_slice(&packed.lights))?;
            place.light_vertices.write(bytemuck::cast_slice(&packed.vertices))?;
            let vertices = scene::vertices(seconds);
            place.vertices.write(bytemuck::cast_slice(&vertices))?;

            // Draw the G-buffer, and shade it: all is relative to the camera
            let frame = ShadeFrame {
                size: *size,
                camera: Vec3::ZERO,
                position_from_clip: Some(camera.clip_from_view.inverse()),
                lights: packed.summary(),
                tile_lists: Some(Resource::buffer(place.tile_lists.raw)),
                seed: 0,
            };
            // SAFETY: the commands are being recorded; buffers and sets are this place's.
            unsafe {
                draw.record(commands, &camera, place.vertices.raw, vertices.len(), None);
                shade.record(commands, place.set, &frame)?;
            }
            // doc end
            then(index, commands)
        })
    }

    /// Waits for the last frame, and returns its radiance.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn picture(&mut self) -> Result<Picture> {
        let Self { frames, readback, g_buffer, .. } = self;
        readback.read(
            frames,
            &g_buffer.radiance,
            vk::ImageLayout::GENERAL,
            Users { stages: vk::PipelineStageFlags::COMPUTE_SHADER, access: vk::AccessFlags::SHADER_WRITE },
        )
    }
}

// doc: tile_lists
/// A buffer for the lists of tiles of pictures of `size` pixels: each frame in flight has one, which the pass alone writes.
fn tile_lists<'a>(gpu: &'a Gpu<'a>, shade: &ShadePass, size: [u32; 2]) -> Result<Buffer<'a>> {
    let needed = shade.tile_memory(size).ok_or("the pass has tiles")?;
    gpu.buffer(needed.usage, needed.size as usize)
}
// doc end

impl<'a> Place<'a> {
    fn new(gpu: &'a Gpu<'a>, tile_lists: Buffer<'a>, set: vk::DescriptorSet) -> Result<Self> {
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let vertices = size_of_val(scene::vertices(0.0).as_slice());
        Ok(Self {
            vertices: gpu.buffer(vk::BufferUsageFlags::VERTEX_BUFFER, vertices)?,
            lights: gpu.buffer(storage, MOST_LIGHTS * size_of::<GpuLight>())?,
            light_vertices: gpu.buffer(storage, MOST_LIGHTS * 4 * size_of::<Vec4>())?,
            tile_lists,
            set,
        })
    }
}
