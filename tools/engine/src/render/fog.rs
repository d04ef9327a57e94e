//! A medium before what was shaded, by froxels and by Monte Carlo.

use super::shadowed::BlockerBuffers;
use crate::host::{DescriptorPool, Image, ImageDescription, Usage};
use crate::{EngineError, Kept, SceneRenderer};
use arealight::plan::MediumOptions;
use arealight_scene::{Camera, Scene, SceneFog};
use arealight_tool_kernels::gpu::MediumReferenceConstants;
use arealight_tool_kernels::kernels::{REFERENCE_MEDIUM, SHADOWS};
use arealight_vk::{MediumFrame, MediumPass, MediumPassInfo, MediumResources, Resource};
use ash::vk;
use glam::Vec3;
use std::rc::Rc;
use std::time::Duration;

/// An even medium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fog {
    /// Extinction per unit of length.
    pub density: f32,
    /// What is scattered of what is taken away, a channel: in [0, 1].
    pub albedo: Vec3,
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
    /// Where it ends.
    pub farthest: f32,
    /// [`MediumFrame::cull_radiance`].
    pub cull_radiance: f32,
}

impl Fog {
    /// That of a scene, which ends beyond all that a camera sees of it.
    pub fn of_scene(scene: &Scene, camera: &Camera, fog: SceneFog) -> Self {
        let corners = scene.triangles.iter().flat_map(|triangle| triangle.positions);
        let farthest = corners.map(|corner| corner.distance(camera.position)).fold(1e-3, f64::max) as f32;
        let albedo = Vec3::splat(fog.albedo as f32);
        Self {
            density: fog.density as f32,
            albedo,
            anisotropy: fog.anisotropy as f32,
            farthest,
            cull_radiance: 0.0,
        }
    }
}

/// What fog takes before a view of a scene.
pub struct FogView {
    froxels: [u32; 3],
    volume: Image,
    set: vk::DescriptorSet,
    _pool: DescriptorPool,
    _blockers: Rc<BlockerBuffers>,
    pass: Kept<MediumPass>,
}

impl SceneRenderer<'_> {
    /// Makes what fog takes by `froxels` across, down and away; everything blocks as a whole. `medium` is
    /// that of [`MediumOptions::by_image`].
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails.
    pub fn fog_view(
        &self,
        blockers: &Rc<BlockerBuffers>,
        froxels: [u32; 3],
        (options, medium): (MediumOptions, Option<Resource>),
    ) -> Result<FogView, EngineError> {
        let (engine, host) = (self.engine, self.engine.host());
        // doc: pass
        let info = MediumPassInfo { options, ..MediumPassInfo::default() };
        // SAFETY: The pass is dropped when no frame uses it, before the device.
        let pass = unsafe { MediumPass::new(engine.context(), info) }?;
        // doc end
        let pass = Kept::new(host, pass);
        let [width, height, depth] = froxels;
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
        let (extent, format) = ([width, height], MediumPass::FORMAT);
        let volume =
            host.volume(&ImageDescription { name: "froxels", extent, layers: 1, format, usage }, depth)?;
        let resources = MediumResources {
            froxels: Resource::stored(volume.view()),
            medium,
            blockers: Some(blockers.resources()),
        };
        let pool = host.descriptor_pool(1, &pass.pool_sizes(1))?;
        // SAFETY: The layout is the pass's; the set is new, and the resources live until submissions were
        // waited for.
        let set = unsafe {
            let set = pool.allocate(pass.set_layout())?;
            pass.write_set(set, &self.shade_resources(arealight::Effects::empty()), &resources)?;
            set
        };
        pass.prepare(self.lights)?;
        Ok(FogView { froxels, volume, set, _pool: pool, _blockers: Rc::clone(blockers), pass })
    }

    /// Puts a fog before the picture, with random numbers of `seed`.
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails.
    pub fn add_fog(&mut self, view: &FogView, fog: &Fog, seed: u32) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let FogView { froxels, ref volume, set, ref pass, .. } = *view;
        // doc: frame
        let frame = MediumFrame {
            froxels, // 160 x 90 x 64
            size: self.size,
            camera: self.camera.position(),
            position_from_clip: self.camera.position_from_clip(),
            lights: self.lights,
            scattering: fog.albedo * fog.density,
            extinction: fog.density,
            anisotropy: fog.anisotropy,
            nearest: fog.farthest / 16.0,
            farthest: fog.farthest,
            cull_radiance: fog.cull_radiance,
            seed,
        };
        // doc end
        self.engine.host().try_submit_timed(|commands| {
            volume.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE);
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            // SAFETY: The commands are being recorded outside a render pass; submissions are waited for.
            Ok(unsafe { pass.record(commands, set, &frame) }?)
        })
    }

    /// The same by Monte Carlo, with so many samples a pixel; `progress` is told how many are done.
    ///
    /// # Errors
    /// [`EngineError`] where the device fails.
    pub fn fog_reference(
        &mut self,
        fog: &Fog,
        samples: u32,
        (shadows, seed): (bool, u32),
        progress: impl FnMut(u32),
    ) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let specialization = [(SHADOWS, shadows.into()), self.has_alpha];
        self.sampled(
            (&REFERENCE_MEDIUM, &specialization),
            (samples, shadows),
            progress,
            |first_sample, sample_count| MediumReferenceConstants {
                position_from_clip: self.camera.position_from_clip().to_cols_array_2d(),
                camera: self.camera.position().to_array(),
                light_count: self.lights.light_count,
                scattering: (fog.albedo * fog.density).to_array(),
                extinction: fog.density,
                shape_count: self.lights.shape_count,
                first_sample,
                sample_count,
                weight: (f64::from(sample_count) / f64::from(samples)) as f32,
                anisotropy: fog.anisotropy,
                farthest: fog.farthest,
                seed,
                reserved: 0,
            },
        )
    }
}
