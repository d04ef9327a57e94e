//! Shading with shadows: the same picture, with what of each light's radiance arrives.

use crate::host::{Buffer, DescriptorPool, Image, ImageDescription, OwnSet, Usage};
use crate::{Engine, EngineError, Kept, SceneRenderer};
use arealight::plan::{self, Output, ShadeOptions, ShadowFilter, ShadowHistory};
use arealight::{Blockers, Effects};
use arealight_scene::{BufferError, SceneBuffers};
use arealight_tool_kernels::gpu::GpuTriangle;
use arealight_tool_kernels::kernels::SHADOW_RAYS_MASKED;
use arealight_vk::{
    BlockerResources, Bound, Resource, ShadeFrame, ShadePass, ShadeResources, ShadowFrame, ShadowOptions,
    ShadowPass, ShadowPassInfo, ShadowResources, ShadowStage,
};
use ash::vk;
use glam::{Vec3, Vec4};
use std::rc::Rc;
use std::time::Duration;

/// What of a scene blocks light, on the device: of every view of it.
pub struct BlockerBuffers {
    nodes: Buffer,
    triangles: Buffer,
    /// Whether some of it is cut out.
    is_masked: bool,
}

impl BlockerBuffers {
    pub(super) fn resources(&self) -> BlockerResources {
        // doc: blockers
        BlockerResources {
            nodes: Resource::buffer(self.nodes.handle()), // of Blockers::new
            triangles: Resource::buffer(self.triangles.handle()),
        }
        // doc end
    }
}

/// What shading a view with shadows needs: passes, images, and the scene's blockers.
pub struct ShadowedView {
    shade: Kept<ShadePass>,
    shadow: Kept<ShadowPass>,
    /// Of the shade pass and of the shadow pass.
    sets: [vk::DescriptorSet; 2],
    _pool: DescriptorPool,
    unshadowed: Image,
    shadows: Image,
    picks: Buffer,
    history: Buffer,
    blockers: Rc<BlockerBuffers>,
    /// Set 1, where blockers are cut out.
    masks: Option<OwnSet>,
}

impl ShadowedView {
    /// Makes the images that a run writes ready to be written.
    fn begin(&self, commands: vk::CommandBuffer) {
        for image in [&self.unshadowed, &self.shadows] {
            image.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE);
        }
    }

    fn shadow_sets(&self) -> Bound<'_> {
        match &self.masks {
            None => Bound::Set(self.sets[1]),
            Some(masks) => Bound::Sets([self.sets[1], masks.set]),
        }
    }

    /// The dispatches of the shadow pass, in order.
    pub fn stages(&self) -> &'static [ShadowStage] {
        self.shadow.stages()
    }

    /// Other blockers than the scene's, relative to its origin, at most as many.
    ///
    /// # Errors
    /// [`EngineError`] where they are not finite, do not fit, or the device fails.
    pub fn set_blockers(&self, triangles: &[[Vec3; 3]]) -> Result<(), EngineError> {
        let blockers = Blockers::new(triangles).map_err(BufferError::from)?;
        self.blockers.nodes.upload(&blockers.nodes)?;
        self.blockers.triangles.upload(&blockers.triangles)?;
        Ok(())
    }

    /// What the last run's rays found: of each pixel the part of its light that arrives, the penumbra's
    /// width, 1 where there is light, and the number of rays.
    pub fn shadows(&self) -> Result<Vec<Vec4>, EngineError> {
        let texels: Vec<[u16; 4]> = self.shadows.download(Usage::COMPUTE_WRITE)?;
        let number = |bits| half::f16::from_bits(bits).to_f32();
        Ok(texels.into_iter().map(|texel| Vec4::from_array(texel.map(number))).collect())
    }

    /// The last run's radiance without shadows.
    pub fn unshadowed(&self) -> Result<Vec<Vec4>, EngineError> {
        let texels: Vec<[f32; 4]> = self.unshadowed.download(Usage::COMPUTE_WRITE)?;
        Ok(texels.into_iter().map(Vec4::from_array).collect())
    }
}

/// Every triangle of a scene as the kernels have those of [`Blockers`], in the order of its hierarchy. Those
/// that are not all there have as their number one more than their index in the scene.
fn blockers(scene: &SceneBuffers) -> Vec<[[f32; 4]; 3]> {
    let record = |(number, t): (u32, &GpuTriangle)| {
        let number = if scene.materials[t.material as usize].is_whole() { 0 } else { number };
        let vertex = |[x, y, z]: [f32; 3], number| [x, y, z, f32::from_bits(number)];
        [vertex(t.p0, number), vertex(t.p1, 0), vertex(t.p2, 0)]
    };
    (1..).zip(&scene.triangles).map(record).collect()
}

impl SceneRenderer<'_> {
    /// What blocks light in a scene.
    ///
    /// # Errors
    /// [`EngineError`] where it does not fit the device, or the device fails.
    pub fn blockers(&self, scene: &SceneBuffers) -> Result<Rc<BlockerBuffers>, EngineError> {
        Ok(Rc::new(BlockerBuffers {
            nodes: self.engine.storage("blocker nodes", &scene.nodes)?,
            triangles: self.engine.storage("blocker triangles", &blockers(scene))?,
            is_masked: scene.has_alpha(),
        }))
    }

    /// Makes what shading this view of `scene` with shadows needs. `options` have shadow rays; radiance is
    /// added to the image of the view.
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails, or which option no shadow can be made with.
    pub fn shadowed(
        &self,
        scene: &SceneBuffers,
        options: ShadeOptions,
        of: (ShadowFilter, ShadowHistory),
    ) -> Result<ShadowedView, EngineError> {
        self.shadowed_by(&self.blockers(scene)?, options, of)
    }

    fn shadowed_by(
        &self,
        blockers: &Rc<BlockerBuffers>,
        options: ShadeOptions,
        (filter, history): (ShadowFilter, ShadowHistory),
    ) -> Result<ShadowedView, EngineError> {
        let (engine, host) = (self.engine, self.engine.host());
        let options = self.seen(options);
        // Blockers that are cut out are asked for in a module and a set of our own
        let masks = blockers.is_masked.then(|| self.masks()).transpose()?;
        let module = blockers.is_masked.then(|| SHADOW_RAYS_MASKED.words());
        let host_set = masks.as_ref().map(|masks| masks.layout);
        // doc: passes
        // SAFETY: The passes are dropped when no frame uses them, before the device.
        let (shade, shadow) = unsafe {
            let output = ShadowOptions { filter, history, output: Output::Add };
            let info = ShadowPassInfo { options, shadows: output, module, host_set };
            (ShadePass::new(engine.context(), options)?, ShadowPass::new(engine.context(), info)?)
        };
        // doc end
        let image = |name, format| {
            let usage = vk::ImageUsageFlags::STORAGE;
            host.image(&ImageDescription { name, extent: self.size, layers: 1, format, usage })
        };
        let sizes = [shade.pool_sizes(1), shadow.pool_sizes(1)].concat();
        let pool = host.descriptor_pool(2, &sizes)?;
        // SAFETY: The layouts are the passes', and alive.
        let sets = unsafe { [pool.allocate(shade.set_layout())?, pool.allocate(shadow.set_layout())?] };
        let view = ShadowedView {
            sets,
            _pool: pool,
            unshadowed: image("unshadowed radiance", vk::Format::R32G32B32A32_SFLOAT)?,
            shadows: image("shadows", ShadowPass::SHADOW_FORMAT)?,
            picks: engine.storage("shadow picks", &vec![0_u32; shade.picks_size(self.size) as usize / 4])?,
            history: engine.shadow_history(if history == ShadowHistory::Off { [0; 2] } else { self.size })?,
            blockers: Rc::clone(blockers),
            masks,
            shade: Kept::new(host, shade),
            shadow: Kept::new(host, shadow),
        };
        self.bind_shadowed(&view)?;
        Ok(view)
    }

    /// Makes shadows of another view those of this one, which is no larger.
    ///
    /// # Errors
    /// [`EngineError`] where the device fails.
    pub fn bind_shadowed(&self, view: &ShadowedView) -> Result<(), EngineError> {
        let resources = self.shadowed_resources(view, view.shade.options().surfaces);
        // doc: sets
        // SAFETY: No submission uses the sets, and the resources live until submissions were waited for.
        unsafe {
            view.shade.write_set(view.sets[0], &resources)?;
            view.shadow.write_set(view.sets[1], &resources, &self.shadow_resources(view))?;
        }
        // doc end
        let frame = self.shade_frame();
        view.shade.prepare(&frame)?;
        Ok(view.shadow.prepare(frame.lights)?)
    }

    /// Makes the shadows of another view those of this one, which is of the next frame: they go on.
    ///
    /// # Errors
    /// As [`SceneRenderer::shadowed`].
    pub fn take_over(
        &self,
        view: &mut ShadowedView,
        blockers: &Rc<BlockerBuffers>,
    ) -> Result<(), EngineError> {
        view.blockers = Rc::clone(blockers);
        view.masks = blockers.is_masked.then(|| self.masks()).transpose()?;
        self.bind_shadowed(view)
    }

    /// [`SceneRenderer::shadowed`] of each pass over the options' surfaces.
    ///
    /// # Errors
    /// As [`SceneRenderer::shadowed`].
    pub fn shadowed_passes(
        &self,
        blockers: &Rc<BlockerBuffers>,
        options: ShadeOptions,
        of: (ShadowFilter, ShadowHistory),
    ) -> Result<Vec<ShadowedView>, EngineError> {
        let view = |surfaces| self.shadowed_by(blockers, ShadeOptions { surfaces, ..options }, of);
        options.surfaces.passes().map(view).collect()
    }

    /// Shades those, one after the other, with rays of that seed.
    ///
    /// # Errors
    /// As [`SceneRenderer::shade_shadowed`].
    pub fn shade_shadowed_passes(
        &mut self,
        views: &[ShadowedView],
        seed: u32,
    ) -> Result<Option<Duration>, EngineError> {
        let took: Result<Vec<_>, _> = views.iter().map(|view| self.shade_shadowed(view, seed)).collect();
        Ok(took?.into_iter().sum())
    }

    /// What [`SHADOW_RAYS_MASKED`] reads.
    fn masks(&self) -> Result<OwnSet, EngineError> {
        let [_, own @ ..] = self.geometry.each_ref().map(|buffer| Resource::buffer(buffer.handle()));
        // SAFETY: The buffers live until submissions were waited for.
        Ok(unsafe { self.engine.host().own_set(1, &own) }?)
    }

    fn shadow_resources(&self, view: &ShadowedView) -> ShadowResources {
        // doc: resources
        ShadowResources {
            shadow: Resource::StorageImage { view: view.shadows.view() },
            radiance: Some(Resource::StorageImage { view: self.g_buffer.radiance.view() }),
            history: Some(Resource::buffer(view.history.handle())),
            blockers: Some(view.blockers.resources()),
        }
        // doc end
    }

    fn shadowed_frame(&self, seed: u32) -> ShadeFrame {
        let position_from_clip = Some(self.camera.position_from_clip());
        ShadeFrame { seed, position_from_clip, ..self.shade_frame() }
    }

    fn shadowed_resources(&self, view: &ShadowedView, surfaces: Effects) -> ShadeResources {
        ShadeResources {
            radiance: Resource::StorageImage { view: view.unshadowed.view() },
            picks: Some(Resource::buffer(view.picks.handle())),
            ..self.shade_resources(surfaces)
        }
    }

    /// As [`SceneRenderer::shade`], with shadows, by the random numbers of `seed`.
    pub fn shade_shadowed(
        &mut self,
        view: &ShadowedView,
        seed: u32,
    ) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let whole = self.shadowed_frame(seed);
        let frame = ShadowFrame { shade: &whole, origin_shift: Vec3::ZERO };
        let resources = self.shadow_resources(view);
        self.submit_parts(whole.parts(self.most_pairs), |commands, &shade| {
            if is_first(&shade) {
                view.begin(commands);
            }
            if !is_last(&shade) {
                // SAFETY: As below.
                return Ok(unsafe { view.shade.record(commands, view.sets[0], &shade) }?);
            }
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            // doc: record
            // SAFETY: The commands are being recorded outside a render pass; the sets were
            // written with images of the frame's size, and submissions are waited for.
            unsafe {
                view.shade.record(commands, view.sets[0], &shade)?;
                self.engine.compute_barrier(commands);
                view.shadow.record(commands, view.shadow_sets(), &resources, &frame)?;
            }
            // doc end
            Ok(())
        })
    }

    /// The first step of [`SceneRenderer::shade_shadowed`], as a submission of its own to tell its time
    /// apart: shades without shadows, and picks lights and lobes for the rays.
    pub fn shade_picking(&mut self, view: &ShadowedView, seed: u32) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        self.submit_parts(self.shadowed_frame(seed).parts(self.most_pairs), |commands, part| {
            if is_first(part) {
                view.begin(commands);
            }
            // SAFETY: As in `shade_shadowed`.
            unsafe { view.shade.record(commands, view.sets[0], part)? };
            Ok(())
        })
    }

    /// A step after it: a dispatch of the shadow pass.
    pub fn shadow_stage(
        &self,
        view: &ShadowedView,
        stage: ShadowStage,
        seed: u32,
    ) -> Result<Option<Duration>, EngineError> {
        let shade = self.shadowed_frame(seed);
        let frame = ShadowFrame { shade: &shade, origin_shift: Vec3::ZERO };
        let resources = self.shadow_resources(view);
        self.engine.host().try_submit_timed(|commands| {
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            // SAFETY: As in `shade_shadowed`.
            unsafe { view.shadow.record_stage(stage, commands, view.shadow_sets(), &resources, &frame)? };
            Ok(())
        })
    }
}

/// Whether a part of a frame begins with its first row.
fn is_first(part: &ShadeFrame) -> bool {
    part.rows.is_none_or(|[first, _]| first == 0)
}

/// Whether a part of a frame ends with its last row.
fn is_last(part: &ShadeFrame) -> bool {
    part.rows.is_none_or(|[_, end]| end == part.size[1])
}

impl Engine {
    /// A buffer for what is kept of shadows, of a view that has no frame yet.
    fn shadow_history(&self, size: [u32; 2]) -> Result<Buffer, EngineError> {
        let words = plan::shadow_history_size(size) as usize / 4;
        self.storage("shadow history", &vec![0_u32; words])
    }

    /// What dispatches before wrote is read by those after.
    ///
    /// # Safety
    /// `commands` is being recorded, outside a render pass.
    unsafe fn compute_barrier(&self, commands: vk::CommandBuffer) {
        let barrier = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE)];
        let (compute, flags) = (vk::PipelineStageFlags::COMPUTE_SHADER, vk::DependencyFlags::empty());
        // SAFETY: The same contract.
        unsafe {
            self.host().device().cmd_pipeline_barrier(commands, compute, compute, flags, &barrier, &[], &[]);
        }
    }
}
