//! The [deferred](crate::deferred) engine with the recorder alone: table, buffers, sets and lists of tiles
//! are the engine's.

use crate::g_buffer::GBuffer;
use crate::picture::Picture;
use crate::{Result, scene};
use arealight::plan::{Output, ShadeOptions, TileOptions};
use arealight::{LightTable, PackedLights, Plane, SpecularLobes};
use arealight_host::{Buffer, DescriptorPool, FRAMES_IN_FLIGHT, Frames, Host, Location, Memory, Usage};
use arealight_vk::{
    Context, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources, TableFormat, TableImage,
};
use ash::vk;

/// Bytes of a buffer that changes with the frame: more than the scene's vertices and lights need.
const ROOM: u64 = 1 << 16;

/// The engine, with images of one size. Fields are dropped from the top: frames in flight end first, memory
/// goes after what lies in it.
pub struct Recorded {
    frames: Frames,
    places: Vec<Place>,
    tile_lists: Vec<Buffer>,
    /// What a frame draws to, and leaves the radiance in, in `GENERAL` layout; another after
    /// [`Recorded::resize`].
    pub g_buffer: GBuffer,
    shade: ShadePass,
    _sets: DescriptorPool,
    table: (TableImage, Memory),
    lobe_horizons: Buffer,
    host: Host,
}

/// What each frame in flight has for itself, because it is written anew for every frame.
struct Place {
    set: vk::DescriptorSet,
    vertices: Buffer,
    lights: Buffer,
    light_vertices: Buffer,
}

/// The table on the device, with its memory.
pub(crate) fn upload_table(
    host: &Host,
    context: &Context,
    table: &LightTable,
) -> Result<(TableImage, Memory)> {
    // doc: table
    // Give the light table memory, and fill it
    // SAFETY: the image goes after the frames, and its memory, which was made for it, after the image.
    let mut image = unsafe { TableImage::new(context, table, TableFormat::Rgba16Float) }?;
    let memory = host.memory("light table", image.memory_requirements())?;
    // SAFETY: as above.
    unsafe {
        let (place, offset) = memory.place();
        image.bind_memory(place, offset)?;
    }
    let staging = host.storage_buffer("light table, staged", &image.bytes(table))?;
    // SAFETY: the staging buffer holds the table until the commands are done.
    host.submit(|commands| unsafe { image.record_upload(commands, staging.handle(), 0) })?;
    // doc end
    Ok((image, memory))
}

impl Recorded {
    /// Makes the engine for pictures of `size` pixels.
    pub fn new(host: &Host, size: [u32; 2]) -> Result<Self> {
        // doc: context
        // SAFETY: the handles, which stay yours, belong together, and outlive what is made of the context.
        let context = unsafe { Context::new(host.instance(), host.physical_device(), host.device()) }?;
        // doc end

        // doc: pass
        // Make the pass for the way in which your surfaces are stored; it takes every kind of
        // light. It adds to the emission that was drawn
        let options = ShadeOptions { from_depth: true, output: Output::Add, ..ShadeOptions::default() };
        GBuffer::formats().check(options)?; // says which image has another format than it should
        let table = LightTable::ggx();
        // With tiles, for scenes of many lights. (TileOptions::default() classifies no frame of two.)
        let tiles = TileOptions::default();
        let info = ShadePassInfo { tiles: Some(tiles), table_size: table.size(), ..options.into() };
        // SAFETY: the pass is dropped after the frames, and before the device.
        let shade = unsafe { ShadePass::new(&context, info) }?;
        // doc end

        let (image, memory) = upload_table(host, &context, &table)?;

        // doc: tiles
        // With tiles: upload where the horizons of the table's lobes are
        let lobe_horizons = host.storage_buffer("lobe horizons", &table.lobe_horizons(SpecularLobes::One))?;
        // doc end

        // doc: sets
        // Allocate a descriptor set from a pool of yours for each frame in flight
        let pool =
            host.descriptor_pool(FRAMES_IN_FLIGHT as u32, &shade.pool_sizes(FRAMES_IN_FLIGHT as u32))?;
        let buffer = |name, usage| host.buffer(name, ROOM, usage, Location::Upload);
        let mut places = vec![];
        for _ in 0..FRAMES_IN_FLIGHT {
            // SAFETY: the layout is the pass's.
            let set = unsafe { pool.allocate(shade.set_layout()) }?;
            places.push(Place {
                set,
                vertices: buffer("vertices", vk::BufferUsageFlags::VERTEX_BUFFER)?,
                lights: buffer("lights", vk::BufferUsageFlags::STORAGE_BUFFER)?,
                light_vertices: buffer("light vertices", vk::BufferUsageFlags::STORAGE_BUFFER)?,
            });
        }
        // doc end

        // doc: barriers
        // Place your barriers by what the pass says of itself: here, in the render pass that
        // draws the G-buffer
        let g_buffer = GBuffer::new(host, size, shade.stages_and_access())?;
        // doc end
        let (table, tile_lists) = ((image, memory), vec![]);
        let (frames, host) = (Frames::new(host)?, host.clone());
        let mut engine =
            Self { frames, places, tile_lists, g_buffer, shade, _sets: pool, table, lobe_horizons, host };
        engine.write_sets()?;
        Ok(engine)
    }

    /// Points the sets at the images and buffers; no frame is in flight.
    fn write_sets(&mut self) -> Result<()> {
        // doc: write
        // With tiles: a buffer for their lists, which the pass alone writes, for each frame in flight
        let needed = self.shade.tile_memory(self.g_buffer.size).ok_or("the pass has tiles")?;
        let lists = |_| Ok(self.host.buffer("tile lists", needed.size, needed.usage, Location::Device)?);
        self.tile_lists = (0..FRAMES_IN_FLIGHT).map(lists).collect::<Result<_>>()?;
        // Point the sets at your images and buffers. What your frames never read is left out
        for (place, lists) in self.places.iter().zip(&self.tile_lists) {
            let resources = ShadeResources {
                table: self.table.0.resource(),
                lights: Resource::buffer(place.lights.handle()),
                light_vertices: Resource::buffer(place.light_vertices.handle()),
                planes: [
                    (Plane::Position, Resource::depth(self.g_buffer.depth.view())),
                    (Plane::Normal, Resource::sampled(self.g_buffer.normal_roughness.view())),
                    (Plane::BaseColor, Resource::sampled(self.g_buffer.base_color_metalness.view())),
                ]
                .into(),
                radiance: Resource::stored(self.g_buffer.radiance.view()),
                lobe_horizons: Some(Resource::buffer(self.lobe_horizons.handle())), // with tiles, as the next
                tile_lists: Some(Resource::buffer(lists.handle())),
                ..ShadeResources::default()
            };
            // SAFETY: no pending frame uses the set, and the resources outlive its next use.
            unsafe { self.shade.write_set(place.set, &resources) }?;
        }
        // doc end
        Ok(())
    }

    /// Goes on with pictures of another size. Waits for the frames in flight.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        // doc: resize
        // Make what has a size anew when no frame uses it, and point the sets at it: the pass
        // itself knows no size
        self.frames.wait()?;
        self.g_buffer = GBuffer::new(&self.host, size, self.g_buffer.users)?;
        self.write_sets()
        // doc end
    }

    /// Draws and shades the scene as it is after `seconds`. Waits for nothing but the frame before the last.
    pub fn frame(&mut self, seconds: f64) -> Result<()> {
        let Self { frames, places, tile_lists, g_buffer, shade, .. } = self;
        frames.submit(|index, commands| {
            let place = &places[index];
            // doc: frame
            // Write what is new in this frame: no other frame reads this place's buffers
            let camera = scene::camera(g_buffer.size);
            let packed = PackedLights::new(&scene::lights(seconds), camera.position.as_dvec3())?;
            place.lights.upload(&packed.lights)?;
            place.light_vertices.upload(&packed.vertices)?;
            let vertices = scene::vertices(seconds);
            place.vertices.upload(&vertices)?;

            // Draw the G-buffer, and shade it: all is relative to the camera, which is at zero
            let frame = ShadeFrame {
                size: g_buffer.size,
                position_from_clip: Some(camera.clip_from_view.inverse()),
                lights: packed.summary(),
                tile_lists: Some(Resource::buffer(tile_lists[index].handle())),
                ..ShadeFrame::default()
            };
            // SAFETY: the commands are being recorded; buffers and sets are this place's.
            unsafe {
                g_buffer.draw.record(commands, &camera, place.vertices.handle(), vertices.len(), None);
                shade.record(commands, place.set, &frame)?;
            }
            // doc end
            Ok(())
        })
    }

    /// Waits for the last frame, and returns its radiance.
    pub fn picture(&mut self) -> Result<Picture> {
        Picture::read(&self.frames, &self.g_buffer.radiance, Usage::COMPUTE_WRITE)
    }
}
