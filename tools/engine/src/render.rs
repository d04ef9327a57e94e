//! What a camera sees of a scene and its lights.

pub(crate) mod cells;
pub(crate) mod fog;
pub(crate) mod shadowed;
pub(crate) mod tiled;

use crate::host::{Buffer, DescriptorPool, Usage};
use crate::{Engine, EngineError, GBuffer};
use arealight::gpu::ShadeConstants;
use arealight::kernels::{Binding, Kernel};
use arealight::plan::{Output, ShadeOptions};
use arealight::{Effects, Light, LightSummary, PackedLights, Plane, Planes, Quality};
use arealight_scene::SceneBuffers;
use arealight_tool_kernels::LightSampling;
use arealight_tool_kernels::gpu::{ReferenceConstants, VisibilityConstants};
use arealight_tool_kernels::kernels::{COUPLED, HAS_ALPHA, REFERENCE, SHADOWS, VISIBILITY};
use arealight_vk::{Resource, ShadeFrame, ShadeResources};
use ash::vk;
use bytemuck::Pod;
use glam::{DVec3, Vec3, Vec4};
use std::rc::Rc;
use std::time::Duration;

/// What the kernels call the buffers of a scene.
const GEOMETRY: [&str; 5] = ["nodes", "triangles", "materials", "textures", "texels"];

/// What the Monte Carlo reference does: [`SceneRenderer::reference`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reference {
    /// Samples a pixel: of each light a point, and of the BRDF a direction.
    pub samples: u32,
    /// Another seed gives independent noise.
    pub seed: u32,
    /// Whether the scene's triangles block light. Without, light passes through everything, as in the shade
    /// pass.
    pub shadows: bool,
    /// Whether diffuse lobes get what the Fresnel term leaves, as in glTF; else the two are added, as without
    /// [`Effects::COUPLED`].
    pub coupled: bool,
    /// And so by what the lobe above leaves of all light, not of each direction's; below coats, too.
    pub by_albedo: bool,
}

impl Default for Reference {
    /// 256 samples, without shadows, materials as in glTF.
    fn default() -> Self {
        Self { samples: 256, seed: 0, shadows: false, coupled: true, by_albedo: false }
    }
}

/// Pairs of a pixel and a light that one submission shades at most, but for single rows of workgroups: a
/// driver may reset a device whose submission takes over two seconds, in which one that does ten million
/// pairs a second is done. That is a tenth of what integrated GPUs do.
const PAIRS_PER_SUBMISSION: u64 = 1 << 24;

/// A scene on the device, with the images of one view of it.
///
/// Call [`SceneRenderer::visibility`] first; then [`SceneRenderer::shade`] or [`SceneRenderer::reference`]
/// adds reflected light to the emission that the camera sees directly.
pub struct SceneRenderer<'a> {
    engine: &'a Engine,
    lights: LightSummary,
    size: [u32; 2],
    camera: VisibilityConstants,
    g_buffer: GBuffer,
    geometry: Rc<[Buffer; GEOMETRY.len()]>,
    has_alpha: (u32, u32),
    light_buffers: Rc<LightBuffers>,
    sampling: LightSampling,
    most_pairs: u64,
    shown: bool,
}

/// What lights are packed into.
struct LightBuffers {
    lights: Buffer,
    vertices: Buffer,
    shapes: Buffer,
}

impl<'a> SceneRenderer<'a> {
    /// Uploads a scene and makes the images of a view of `size` pixels. `lights` are world positions; the
    /// buffers' origin is subtracted from them.
    ///
    /// # Errors
    /// [`EngineError`] names the buffer or image that is too large, or the light that cannot be shaded.
    pub fn new(
        engine: &'a Engine,
        scene: &SceneBuffers,
        lights: &[Light],
        camera: VisibilityConstants,
        size: [u32; 2],
    ) -> Result<Self, EngineError> {
        let packed = PackedLights::new(lights, scene.origin)?;
        engine.check_layers(lights)?;
        let geometry = [
            engine.storage("hierarchy nodes", &scene.nodes)?,
            engine.storage("triangles", &scene.triangles)?,
            engine.storage("materials", &scene.materials)?,
            engine.storage("textures", &scene.textures)?,
            engine.storage("texels", &scene.texels)?,
        ];
        Ok(Self {
            engine,
            lights: packed.summary(),
            size,
            camera,
            g_buffer: GBuffer::new(engine, size)?,
            geometry: Rc::new(geometry),
            has_alpha: (HAS_ALPHA, scene.has_alpha().into()),
            light_buffers: Rc::new(LightBuffers {
                lights: engine.storage("lights", &packed.lights)?,
                vertices: engine.storage("light vertices", &packed.vertices)?,
                shapes: engine.storage("shapes", &packed.shapes)?,
            }),
            sampling: LightSampling::new(lights, &packed),
            most_pairs: PAIRS_PER_SUBMISSION,
            shown: false,
        })
    }

    /// Finds the surface at each pixel, and writes the emission that the camera sees. GPU time, where the
    /// queue has timestamps.
    pub fn visibility(&mut self) -> Result<Option<Duration>, EngineError> {
        let pass = self.engine.pass(&VISIBILITY, &[self.has_alpha], &self.bound_to(&VISIBILITY, &[]))?;
        let took = self.engine.host().try_submit_timed(|commands| {
            for image in self.g_buffer.surfaces().chain([&self.g_buffer.radiance]) {
                image.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE);
            }
            pass.record(commands, &self.camera, self.items())?;
            for image in self.g_buffer.surfaces() {
                image.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_READ);
            }
            Ok::<_, EngineError>(())
        })?;
        self.shown = true;
        Ok(took)
    }

    /// Adds the light that surfaces reflect, by the fitted lobes; `surfaces` is what they need
    /// ([`ShadeOptions::surfaces`]). GPU time, where the queue has timestamps.
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails.
    pub fn shade(&mut self, surfaces: Effects, quality: Quality) -> Result<Option<Duration>, EngineError> {
        let options = ShadeOptions { quality, output: Output::Add, ..ShadeOptions::default() };
        self.each_pass(surfaces, |renderer, surfaces| renderer.shade_as(ShadeOptions { surfaces, ..options }))
    }

    /// Runs `shade` for each of [`Effects::passes`]. The sum of its times, where it has any.
    ///
    /// # Errors
    /// Those of `shade`.
    pub fn each_pass(
        &mut self,
        surfaces: Effects,
        mut shade: impl FnMut(&mut Self, Effects) -> Result<Option<Duration>, EngineError>,
    ) -> Result<Option<Duration>, EngineError> {
        let took: Result<Vec<_>, _> = surfaces.passes().map(|surfaces| shade(self, surfaces)).collect();
        Ok(took?.into_iter().sum())
    }

    /// As [`SceneRenderer::shade`], with everything that a pass can be told: positions come from an image of
    /// ours, and radiance is added to one.
    pub fn shade_as(&mut self, options: ShadeOptions) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let pass = self.engine.shade_pass(self.seen(options))?;
        let pool: DescriptorPool = self.engine.host().descriptor_pool(1, &pass.pool_sizes(1))?;
        // SAFETY: The layout is the pass's, and alive.
        let set = unsafe { pool.allocate(pass.set_layout()) }?;
        // SAFETY: The set is new, and the resources live until the submission was waited for.
        unsafe { pass.write_set(set, &self.shade_resources(options.surfaces)) }?;
        // doc: parts
        let parts = self.shade_frame().parts(self.most_pairs); // 2^24 pairs
        self.submit_parts(parts, |commands, part| {
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            // SAFETY: The commands are being recorded outside a render pass; the set was written with images
            // of the frame's size.
            unsafe { pass.record(commands, set, part) }?;
            Ok(())
        })
        // doc end
    }

    /// Submits the parts of a frame one after the other. The sum of their GPU times, where the queue has
    /// timestamps.
    fn submit_parts(
        &self,
        parts: impl Iterator<Item = ShadeFrame>,
        record: impl Fn(vk::CommandBuffer, &ShadeFrame) -> Result<(), EngineError>,
    ) -> Result<Option<Duration>, EngineError> {
        let host = self.engine.host();
        let took: Result<Vec<_>, EngineError> =
            parts.map(|part| host.try_submit_timed(|commands| record(commands, &part))).collect();
        Ok(took?.into_iter().sum())
    }

    /// As [`SceneRenderer::shade`], by another kernel of the shade kernel's bindings and push constants: one
    /// to compare with.
    pub fn shade_by(
        &mut self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
    ) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let resources = self.bound_to(kernel, &[]);
        let pass = self.engine.pass(kernel, specialization, &resources)?;
        let constants = self.shade_constants();
        self.engine.host().try_submit_timed(|commands| {
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            pass.record(commands, &constants, self.items())
        })
    }

    /// Adds the light that surfaces reflect, by Monte Carlo samples of the true BRDF. `progress` is told how
    /// many samples are done. GPU time, where the queue has timestamps.
    pub fn reference(
        &mut self,
        reference: Reference,
        progress: impl FnMut(u32),
    ) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let Reference { samples, shadows, coupled, by_albedo, seed } = reference;
        let coupled = if by_albedo { 2 } else { coupled.into() };
        let specialization = [(SHADOWS, shadows.into()), (COUPLED, coupled), self.has_alpha];
        self.sampled(
            (&REFERENCE, &specialization),
            (samples, shadows),
            progress,
            |first_sample, sample_count| ReferenceConstants {
                camera: self.camera.position().to_array(),
                light_count: self.lights.light_count,
                first_sample,
                sample_count,
                weight: (f64::from(sample_count) / f64::from(samples)) as f32,
                seed,
                shape_count: self.lights.shape_count,
            },
        )
    }

    /// Runs a kernel of Monte Carlo until all samples are taken, by the constants of each dispatch: of its
    /// first sample, and how many there are.
    fn sampled<C: Pod>(
        &self,
        (kernel, specialization): (&'static Kernel, &[(u32, u32)]),
        (samples, shadows): (u32, bool),
        mut progress: impl FnMut(u32),
        constants: impl Fn(u32, u32) -> C,
    ) -> Result<Option<Duration>, EngineError> {
        let light_sampling = self.engine.storage("light sampling", &self.sampling.lights)?;
        let light_triangles = self.engine.storage("light triangles", &self.sampling.triangles)?;
        let own = [("light_sampling", &light_sampling), ("light_triangles", &light_triangles)];
        let pass = self.engine.pass(kernel, specialization, &self.bound_to(kernel, &own))?;
        let mut total = Some(Duration::ZERO);
        let mut done = 0;
        while done < samples {
            let count = self.samples_a_dispatch(shadows).min(samples - done);
            let constants = constants(done, count);
            let took = self.engine.host().try_submit_timed(|commands: vk::CommandBuffer| {
                self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
                pass.record(commands, &constants, self.items())
            })?;
            total = total.zip(took).map(|(total, took)| total + took);
            done += count;
            progress(done);
        }
        Ok(total)
    }

    /// So many that a dispatch takes about a second on a CPU and far less on a GPU, whose driver may reset
    /// the device after two seconds; at least one for each pixel and light, however many there are. With
    /// shadows each sample is two rays, which cost some eight times as much. And so few that an invocation's
    /// loops, over faces and in rays among them, end before llvmpipe stops them, at 65,535 rounds.
    fn samples_a_dispatch(&self, shadows: bool) -> u32 {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let lights = u64::from(self.lights.light_count + self.lights.shape_count).max(1);
        let faces = self.sampling.triangles.len() as u64;
        let rounds = if shadows { 4 * faces + 600 * lights } else { faces + lights };
        let most = (1 << if shadows { 20 } else { 23 }) / (pixels * lights);
        most.min(60_000 / rounds).clamp(1, 64) as u32
    }

    /// The radiance image: rgb, and in w whether there is a surface; rows from the top.
    pub fn radiance(&mut self) -> Result<Vec<Vec4>, EngineError> {
        self.ensure_visible()?;
        let texels: Vec<[f32; 4]> = self.g_buffer.radiance.download(Usage::COMPUTE_WRITE)?;
        Ok(texels.into_iter().map(Vec4::from_array).collect())
    }

    /// The index of the triangle that each pixel shows, if any.
    pub fn triangles(&mut self) -> Result<Vec<Option<u32>>, EngineError> {
        self.ensure_visible()?;
        let texels: Vec<[f32; 4]> = self.g_buffer[Plane::Position].download(Usage::COMPUTE_READ)?;
        Ok(texels.into_iter().map(|[.., triangle]| (triangle as u32).checked_sub(1)).collect())
    }

    /// Puts colours into the radiance image in the place of what was shaded, rows from the top.
    pub fn show(&mut self, colors: &[Vec3]) -> Result<(), EngineError> {
        self.ensure_visible()?;
        let texels: Vec<[f32; 4]> = colors.iter().map(|color| color.extend(1.0).to_array()).collect();
        Ok(self.g_buffer.radiance.upload(&texels, Usage::COMPUTE_WRITE)?)
    }

    /// Looks from elsewhere: the surfaces are found again by the next [`SceneRenderer::visibility`].
    pub fn look(&mut self, camera: VisibilityConstants) {
        self.camera = camera;
        self.shown = false;
    }

    /// Shades in submissions of at most so many pairs of a pixel and a light, but for single rows of
    /// workgroups, instead of 2^24.
    pub fn split(&mut self, most_pairs: u64) {
        self.most_pairs = most_pairs;
    }

    /// Other lights of the same kinds, at most as many, relative to `origin`.
    ///
    /// # Errors
    /// [`EngineError`] names the light that cannot be shaded; where they do not fit, or the device fails.
    pub fn set_lights(&mut self, lights: &[Light], origin: DVec3) -> Result<(), EngineError> {
        let packed = PackedLights::new(lights, origin)?;
        self.light_buffers.lights.upload(&packed.lights)?;
        self.light_buffers.vertices.upload(&packed.vertices)?;
        self.light_buffers.shapes.upload(&packed.shapes)?;
        self.lights = packed.summary();
        self.sampling = LightSampling::new(lights, &packed);
        Ok(())
    }

    /// Other texels of the scene's images, as many ([`SceneBuffers::show_frames`]).
    ///
    /// # Errors
    /// [`EngineError`] where the device fails.
    pub fn set_texels(&mut self, texels: &[u32]) -> Result<(), EngineError> {
        self.shown = false;
        Ok(self.geometry[GEOMETRY.len() - 1].upload(texels)?)
    }

    /// What the lights are.
    pub fn lights(&self) -> LightSummary {
        self.lights
    }

    /// The G-buffer, after [`SceneRenderer::visibility`].
    pub fn g_buffer(&self) -> &GBuffer {
        &self.g_buffer
    }

    fn ensure_visible(&mut self) -> Result<(), EngineError> {
        if !self.shown {
            self.visibility()?;
        }
        Ok(())
    }

    /// What a kernel is bound to, by the names of its bindings: buffers of its own, what is in the G-buffer,
    /// of lights and of the scene. What frames of ours lack is the buffer of lights.
    fn bound_to(&self, kernel: &Kernel, own: &[(&str, &Buffer)]) -> Vec<Resource> {
        let of = |binding: &Binding| {
            let buffer = |buffer: &Buffer| Resource::buffer(buffer.handle());
            if let Some((_, found)) = own.iter().find(|(name, _)| *name == binding.name) {
                return buffer(found);
            }
            if let Some(image) = self.g_buffer.bound_at(binding) {
                return image;
            }
            match binding.name {
                "table_image" => self.engine.table(),
                "light_textures" => self.engine.light_textures(),
                "light_vertices" => buffer(&self.light_buffers.vertices),
                "shapes" => buffer(&self.light_buffers.shapes),
                name => match GEOMETRY.iter().position(|known| *known == name) {
                    Some(index) => buffer(&self.geometry[index]),
                    None => buffer(&self.light_buffers.lights),
                },
            }
        };
        kernel.bindings().iter().map(of).collect()
    }

    /// What a pass reads that is for surfaces with these effects.
    fn shade_resources(&self, surfaces: Effects) -> ShadeResources {
        let lets_through = surfaces.contains(Effects::TRANSMISSION);
        ShadeResources {
            table: self.engine.table(),
            lights: Resource::buffer(self.light_buffers.lights.handle()),
            light_vertices: Resource::buffer(self.light_buffers.vertices.handle()),
            planes: Planes::from_fn(|plane| match plane {
                Plane::BaseColor if lets_through => Some(self.g_buffer.read_transmitted()),
                _ => Some(self.g_buffer.read(plane)),
            }),
            radiance: Resource::StorageImage { view: self.g_buffer.radiance.view() },
            light_textures: Some(self.engine.light_textures()),
            shapes: Some(Resource::buffer(self.light_buffers.shapes.handle())),
            ..ShadeResources::default()
        }
    }

    /// Push constants of the shade kernel, and of those that are like it.
    fn shade_constants(&self) -> ShadeConstants {
        ShadeConstants {
            position_from_clip: glam::Mat4::IDENTITY.to_cols_array_2d(),
            camera: self.camera.position().to_array(),
            light_count: self.lights.light_count,
            shape_count: self.lights.shape_count,
            quad_count: self.lights.quad_count,
            size: self.size,
            ..ShadeConstants::default()
        }
    }

    /// Options of a pass that shades what this camera sees.
    fn seen(&self, options: ShadeOptions) -> ShadeOptions {
        ShadeOptions { orthographic: self.camera.orthographic != 0, ..options }
    }

    fn shade_frame(&self) -> ShadeFrame {
        ShadeFrame {
            size: self.size,
            camera: self.camera.seen_from(),
            lights: self.lights,
            ..ShadeFrame::default()
        }
    }

    fn items(&self) -> [u32; 3] {
        [self.size[0], self.size[1], 1]
    }
}
