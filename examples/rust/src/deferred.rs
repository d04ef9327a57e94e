//! A deferred engine: it draws a G-buffer of its own, and Arealight shades it.

use crate::g_buffer::GBuffer;
use crate::picture::Picture;
use crate::{Result, scene};
use arealight_host::{Buffer, FRAMES_IN_FLIGHT, Frames, Host, Location, Semaphores, Usage};
use arealight_vk::arealight::Plane;
use arealight_vk::arealight::plan::{Output, ShadeOptions, TileOptions};
use arealight_vk::{AreaLights, AreaLightsInfo, Resource, ShadeFrame, ShadeResources, TableFormat};
use ash::vk;

/// Bytes of the scene's vertices, and more.
const ROOM: u64 = 1 << 16;

/// The engine. Fields are dropped from the top: frames in flight end first.
pub struct Deferred {
    frames: Frames,
    vertices: Vec<Buffer>,
    /// What a frame draws to, and leaves the radiance in, in `GENERAL` layout; another after
    /// [`Deferred::resize`].
    pub g_buffer: GBuffer,
    area_lights: AreaLights,
    host: Host,
}

impl Deferred {
    /// Makes the engine for pictures of `size` pixels.
    pub fn new(host: &Host, size: [u32; 2]) -> Result<Self> {
        // doc: new
        // How your surfaces are stored and shaded. It adds to the emission that was drawn
        let options = ShadeOptions { from_depth: true, output: Output::Add, ..ShadeOptions::default() };
        GBuffer::formats().check(options)?; // says which image has another format than it should
        let tiles = Some(TileOptions::default());
        let info = AreaLightsInfo {
            options,
            tiles,
            table_format: TableFormat::Rgba16Float, // half the memory
            frames_in_flight: FRAMES_IN_FLIGHT,
            ..AreaLightsInfo::default()
        };
        // SAFETY: your handles belong together; it is dropped after the frames, and before the device.
        let area_lights = unsafe {
            AreaLights::new(host.instance(), host.physical_device(), host.device(), host.allocator()?, &info)
        }?;
        // doc end
        // Your barriers: here in the render pass that draws the G-buffer
        let g_buffer = GBuffer::new(host, size, area_lights.stages_and_access())?;
        let usage = vk::BufferUsageFlags::VERTEX_BUFFER;
        let buffer = |_| Ok(host.buffer("vertices", ROOM, usage, Location::Upload)?);
        let vertices = (0..FRAMES_IN_FLIGHT).map(buffer).collect::<Result<_>>()?;
        Ok(Self { frames: Frames::new(host)?, vertices, g_buffer, area_lights, host: host.clone() })
    }

    /// Goes on with pictures of another size. Waits for the frames in flight, which use the images.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        self.frames.wait()?;
        self.g_buffer = GBuffer::new(&self.host, size, self.g_buffer.users)?;
        Ok(())
    }

    /// Draws and shades the scene as it is after `seconds`. `first` is given the place among the frames in
    /// flight; `then`, recorded behind, what that returns. Waits for nothing but the frame before the last.
    pub fn frame<T>(
        &mut self,
        seconds: f64,
        first: impl FnOnce(usize) -> Result<T>,
        then: impl FnOnce(T, vk::CommandBuffer) -> Semaphores,
    ) -> Result<()> {
        let Self { frames, vertices, g_buffer, area_lights, .. } = self;
        frames.submit_with(|place, commands| {
            let found = first(place)?;
            let (camera, triangles) = (scene::camera(g_buffer.size), scene::vertices(seconds));
            vertices[place].upload(&triangles)?;
            // SAFETY: the commands are being recorded, and the frame before at this place is done.
            unsafe {
                g_buffer.draw.record(commands, &camera, vertices[place].handle(), triangles.len(), None);
            };
            // doc: frame
            // Your images, of any size. What your options don't read is left out
            let images = ShadeResources {
                planes: [
                    (Plane::Position, Resource::depth(g_buffer.depth.view())),
                    (Plane::Normal, Resource::sampled(g_buffer.normal_roughness.view())),
                    (Plane::BaseColor, Resource::sampled(g_buffer.base_color_metalness.view())),
                ]
                .into(),
                radiance: Resource::stored(g_buffer.radiance.view()),
                ..ShadeResources::default()
            };
            let view = ShadeFrame {
                size: g_buffer.size,
                position_from_clip: Some(camera.clip_from_view.inverse()), // jitter included
                ..ShadeFrame::default()
            };
            // Lights in the world, in float64. This engine's positions are relative to its camera
            let (lights, origin) = (scene::lights(seconds), camera.position.as_dvec3());
            // SAFETY: as above; the images outlive the frame.
            unsafe { area_lights.shade(commands, place, &lights, origin, &view, &images) }?;
            // doc end
            Ok(then(found, commands))
        })
    }

    /// Waits for the last frame, and returns its radiance.
    pub fn picture(&mut self) -> Result<Picture> {
        Picture::read(&self.frames, &self.g_buffer.radiance, Usage::COMPUTE_WRITE)
    }
}
