//! A medium before a picture: fog, smoke, haze.

use crate::context::{Context, USED, WRITTEN};
use crate::error::Error;
use crate::layouts::{Descriptors, Layouts};
use crate::module::check_module;
use crate::pipelines::Pipelines;
use crate::resource::Resource;
use crate::shade::{Bound, ResourceAccess, ShadeResources, accesses_of, check_lights};
use crate::shadows::BlockerResources;
use arealight::gpu::MediumConstants;
use arealight::kernels::{
    Binding, Kernel, MEDIUM_COMPOSE, MEDIUM_HIDE, MEDIUM_INTEGRATE, MEDIUM_SCATTER, store_to,
};
use arealight::plan::{self, MediumOptions};
use arealight::{LightSummary, Plane};
use ash::vk;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// The options and modules of a medium's pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MediumPassInfo {
    /// How it is shaded.
    pub options: MediumOptions,
    /// A module that the host compiled from `medium_scatter.comp` with its own answer to what arrives of a
    /// light, or to what blocks a ray (docs/embed-shadows.md).
    pub module: Option<Vec<u32>>,
    /// The layout of descriptor set 1, where what that module reads is.
    pub host_set: Option<vk::DescriptorSetLayout>,
}

/// What the pass binds beside the shade pass's resources, whose lights and positions it reads and whose
/// radiance it attenuates.
#[derive(Debug, Clone, Copy)]
pub struct MediumResources {
    /// A 3D image of [`MediumPass::FORMAT`] with the usage `STORAGE`, of [`MediumFrame::froxels`]. The pass
    /// alone writes it; what it leaves there a host can sample for what it draws afterwards.
    pub froxels: Resource,
    /// With [`MediumOptions::by_image`], a sampled 3D image of the same size: scattering coefficients in rgb,
    /// extinction in a, per unit of length.
    pub medium: Option<Resource>,
    /// What blocks rays, with [`MediumOptions::shadow_rays`]; none with a module that answers by itself.
    pub blockers: Option<BlockerResources>,
}

/// What differs from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MediumFrame {
    /// Froxels across, down and away from the camera: at most 65535 each, and a volume of the device's.
    /// 160 x 90 x 64 is usual.
    pub froxels: [u32; 3],
    /// The picture's size in pixels, which is that of the images.
    pub size: [u32; 2],
    /// The position of a perspective camera, relative to the origin that lights are packed with.
    pub camera: Vec3,
    /// The inverse of (projection x view), from clip space, y down, to positions relative to the origin.
    pub position_from_clip: Mat4,
    /// Of the lights in the set's buffers.
    pub lights: LightSummary,
    /// What is scattered per unit of length, a channel: extinction times albedo. From 0.
    pub scattering: Vec3,
    /// What is scattered or absorbed per unit of length. From 0.
    pub extinction: f32,
    /// Henyey and Greenstein's g, the mean cosine of the angle by which light is turned. In (-1, 1); it
    /// counts up to .95 of either sign.
    pub anisotropy: f32,
    /// Slices are even up to about this distance, then each is longer by a factor. Above 0.
    pub nearest: f32,
    /// Where the last slice ends. Above `nearest`.
    pub farthest: f32,
    /// Lights are left out of 8 x 8 froxels that together add no more than this to a pixel's radiance, in the
    /// sum of the channels, for each unit of albedo: far below what your exposure shows. With 0 only lights
    /// that nothing comes of. Without [`MediumOptions::least_lights`] none is.
    pub cull_radiance: f32,
    /// Of the random numbers that distances and rays are drawn with: one more in each frame.
    pub seed: u32,
}

/// A dispatch of a medium's pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MediumStage {
    /// Fills froxels with what is scattered of the lights: rgb per unit of length, and extinction.
    Scatter,
    /// Sums it from the camera on: to each froxel's far side the radiance, and the part that is let through.
    Integrate,
    /// Puts it before the picture.
    Compose,
}

impl MediumStage {
    /// All of them, in order.
    pub const ALL: [Self; 3] = [Self::Scatter, Self::Integrate, Self::Compose];

    fn kernel(self) -> &'static Kernel {
        match self {
            Self::Scatter => &MEDIUM_SCATTER,
            Self::Integrate => &MEDIUM_INTEGRATE,
            Self::Compose => &MEDIUM_COMPOSE,
        }
    }
}

/// Light that a medium scatters once, before what a [`crate::ShadePass`] shaded: dispatches over a grid of
/// froxels.
#[derive(Debug)]
pub struct MediumPass {
    stages: [Pipelines; 3],
    hide: Pipelines,
    options: MediumOptions,
}

impl MediumPass {
    /// The format of [`MediumResources::froxels`].
    pub const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

    /// Creates the set and pipeline layouts.
    ///
    /// # Safety
    /// As [`crate::ShadePass::new`], of [`MediumPassInfo::module`] and [`MediumPassInfo::host_set`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where the module lacks the kernel's entry point and bindings;
    /// [`Error::MissingFeature`] where the device has too few storage buffers for a stage; [`Error::Vulkan`]
    /// where a call fails.
    pub unsafe fn new(context: &Context, info: MediumPassInfo) -> Result<Self, Error> {
        let MediumPassInfo { options, module, host_set } = info;
        let module = module.unwrap_or_else(|| MEDIUM_SCATTER.words());
        check_module(&module, &MEDIUM_SCATTER, host_set.is_some())?;
        if options.samples > MediumOptions::MOST_SAMPLES {
            let message = format!("is {}, and at most {}", options.samples, MediumOptions::MOST_SAMPLES);
            return Err(Error::InvalidArgument { field: "samples", message });
        }
        let mut compose = MEDIUM_COMPOSE.words();
        store_to(options.format, &mut compose); // froxels have a format of their own
        let bindings = MEDIUM_SCATTER.bindings().to_vec();
        // SAFETY: the same contract; every kernel has the bindings of the layouts.
        unsafe {
            let layouts = Layouts::with(context, &MEDIUM_SCATTER, bindings, (Descriptors::Sets, host_set))?;
            let pipelines = |kernel, module| Pipelines::new(Arc::clone(&layouts), kernel, module);
            let stages = [
                pipelines(&MEDIUM_SCATTER, module),
                pipelines(&MEDIUM_INTEGRATE, MEDIUM_INTEGRATE.words()),
                pipelines(&MEDIUM_COMPOSE, compose),
            ];
            let hide = pipelines(&MEDIUM_HIDE, MEDIUM_HIDE.words());
            Ok(Self { stages, hide, options })
        }
    }

    fn layouts(&self) -> &Layouts {
        self.stages[0].layouts()
    }

    /// The layout that the host allocates descriptor set 0 with.
    pub fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.layouts().set_layout()
    }

    /// What `sets` descriptor sets of this pass take from the host's descriptor pool.
    pub fn pool_sizes(&self, sets: u32) -> Vec<vk::DescriptorPoolSize> {
        self.layouts().pool_sizes(sets)
    }

    /// How the pass uses each resource. Between its own dispatches it has barriers of its own.
    pub fn accesses(&self) -> Vec<ResourceAccess> {
        let mut accesses = accesses_of(&MEDIUM_SCATTER);
        let composed = accesses_of(&MEDIUM_COMPOSE).into_iter();
        accesses.extend(composed.filter(|access| access.name != "froxels"));
        accesses
    }

    /// Points a descriptor set at the resources of a run: of `shade` the lights, [`Plane::Position`] and the
    /// radiance that the medium is put before.
    ///
    /// # Safety
    /// As [`crate::ComputePass::write_set`]: the set is not in use, and the resources outlive the recorded
    /// work.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the resource that is missing, null or of the wrong kind.
    pub unsafe fn write_set(
        &self,
        set: vk::DescriptorSet,
        shade: &ShadeResources,
        resources: &MediumResources,
    ) -> Result<(), Error> {
        let missing = |field, message: &str| Err(Error::InvalidArgument { field, message: message.into() });
        shade.check_planes(|plane| plane == Plane::Position)?;
        if self.options.by_image && resources.medium.is_none() {
            return missing("medium", "is missing, but the pass reads it: see MediumOptions::by_image");
        }
        let answers = !self.options.shadow_rays || self.layouts().has_host_set();
        if !answers && resources.blockers.is_none() {
            return missing("blockers", "are missing, but the pass has rays: see MediumOptions::shadow_rays");
        }
        let any = BlockerResources { nodes: shade.lights, triangles: shade.lights };
        let blockers = resources.blockers.unwrap_or(any);
        let of = |binding: &Binding| match binding.name {
            "froxels" => resources.froxels,
            "medium_image" => resources.medium.or(shade.planes[Plane::Position]).unwrap_or_default(),
            "nodes" => blockers.nodes,
            "blocker_triangles" => blockers.triangles,
            _ => shade.at(binding),
        };
        let bindings = self.layouts().bindings();
        let all: Vec<_> = bindings.iter().map(of).collect();
        // SAFETY: the same contract.
        unsafe { self.layouts().write_set(set, &all, &shade.absent(bindings)) }
    }

    /// Makes the pipelines for a frame of these lights, which [`MediumPass::record`] would otherwise do when
    /// the first such frame is recorded.
    ///
    /// # Errors
    /// [`Error::Vulkan`] where a call fails.
    pub fn prepare(&self, lights: LightSummary) -> Result<(), Error> {
        self.hide(|_| ())?;
        MediumStage::ALL.into_iter().try_for_each(|stage| self.with(stage, lights, |_| ()))
    }

    /// Does something with the pipeline that marks what pixels look through, unless all is filled.
    fn hide(&self, act: impl FnOnce(&crate::ComputePass)) -> Result<(), Error> {
        if self.options.fill_hidden {
            return Ok(());
        }
        self.hide.with(plan::medium_hide_specialization(self.options), act)
    }

    /// Does something with the pipeline of a stage.
    fn with(
        &self,
        stage: MediumStage,
        lights: LightSummary,
        act: impl FnOnce(&crate::ComputePass),
    ) -> Result<(), Error> {
        let specialization = match stage {
            MediumStage::Scatter => plan::medium_scatter_specialization(self.options, lights),
            MediumStage::Integrate => vec![],
            MediumStage::Compose => plan::medium_compose_specialization(self.options),
        };
        self.stages[stage as usize].with(specialization, act)
    }

    /// Records the pass, after the frame's radiance.
    ///
    /// # Safety
    /// As [`crate::ShadePass::record`]; the set was written by [`MediumPass::write_set`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field of `frame` that is wrong; [`Error::Vulkan`] where a call
    /// fails.
    pub unsafe fn record<'a>(
        &self,
        command_buffer: vk::CommandBuffer,
        bound: impl Into<Bound<'a>>,
        frame: &MediumFrame,
    ) -> Result<(), Error> {
        let bound = bound.into();
        let context = self.layouts().context();
        self.prepare(frame.lights)?;
        // SAFETY: the same contract; barriers are between the stages.
        unsafe {
            let _label = context.names.label(command_buffer, c"arealight medium");
            for stage in MediumStage::ALL {
                if stage != MediumStage::Scatter {
                    context.record_barrier(command_buffer, WRITTEN, USED);
                }
                self.record_stage(stage, command_buffer, bound, frame)?;
            }
        }
        Ok(())
    }

    /// One dispatch of [`MediumPass::record`], for a host that integrates or composes by itself, or has
    /// commands of its own between them. What the one before wrote is made visible to it by a barrier of the
    /// host's.
    ///
    /// # Safety
    /// As [`MediumPass::record`].
    ///
    /// # Errors
    /// As [`MediumPass::record`].
    pub unsafe fn record_stage<'a>(
        &self,
        stage: MediumStage,
        command_buffer: vk::CommandBuffer,
        bound: impl Into<Bound<'a>>,
        frame: &MediumFrame,
    ) -> Result<(), Error> {
        let sets = bound.into().sets(self.layouts(), frame.lights)?;
        let constants = constants_of(frame)?;
        let bytes = bytemuck::bytes_of(&constants);
        let [columns, rows, slices] = frame.froxels;
        let groups = stage.kernel().groups_for(match stage {
            MediumStage::Scatter => [columns, rows, slices],
            MediumStage::Integrate => [columns, rows, 1],
            MediumStage::Compose => [frame.size[0], frame.size[1], 1],
        });
        self.stages[stage as usize].check(bytes, groups)?;
        if stage == MediumStage::Scatter {
            self.hide(|pass| {
                let groups = MEDIUM_HIDE.groups_for([columns, rows, 1]);
                // SAFETY: the same contract.
                unsafe {
                    pass.record_checked(command_buffer, &sets, bytes, groups);
                    self.layouts().context().record_barrier(command_buffer, WRITTEN, USED);
                }
            })?;
        }
        self.with(stage, frame.lights, |pass| {
            // SAFETY: the same contract.
            unsafe { pass.record_checked(command_buffer, &sets, bytes, groups) };
        })
    }
}

/// A frame's constants, checked.
fn constants_of(frame: &MediumFrame) -> Result<MediumConstants, Error> {
    let wrong = |field, message: &str| Err(Error::InvalidArgument { field, message: message.into() });
    let counts = frame.froxels;
    if counts.iter().any(|count| !(1..=0xffff).contains(count)) {
        return wrong("froxels", "must be from 1 to 65535 along each axis");
    }
    if frame.size.contains(&0) {
        return wrong("size", "has no pixels");
    }
    check_lights(frame.lights)?;
    if !frame.camera.is_finite() {
        return wrong("camera", "holds NaN or infinity");
    }
    if !frame.position_from_clip.is_finite() {
        return wrong("position_from_clip", "holds NaN or infinity");
    }
    let is_amount = |x: f32| x.is_finite() && x >= 0.0;
    if !frame.scattering.to_array().into_iter().all(is_amount) {
        return wrong("scattering", "must be finite and not negative");
    }
    if !is_amount(frame.extinction) {
        return wrong("extinction", "must be finite and not negative");
    }
    if !is_amount(frame.cull_radiance) {
        return wrong("cull_radiance", "must be finite and not negative");
    }
    if frame.anisotropy.is_nan() || frame.anisotropy.abs() >= 1.0 {
        return wrong("anisotropy", "must be between -1 and 1");
    }
    if !(frame.nearest > 0.0 && frame.farthest > frame.nearest && frame.farthest.is_finite()) {
        return wrong("farthest", "must be finite and above `nearest`, and that above 0");
    }
    Ok(MediumConstants {
        position_from_clip: frame.position_from_clip.to_cols_array_2d(),
        camera: frame.camera.to_array(),
        light_count: frame.lights.light_count,
        scattering: frame.scattering.to_array(),
        extinction: frame.extinction,
        shape_count: frame.lights.shape_count,
        quad_count: frame.lights.quad_count,
        seed: frame.seed,
        anisotropy: frame.anisotropy,
        columns_rows: counts[0] | counts[1] << 16,
        slices_cull: counts[2] | frame.cull_radiance.to_bits() & 0xffff_0000,
        nearest: frame.nearest,
        farthest: frame.farthest,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_no_kernel_can_have_are_refused_by_field() {
        let good = MediumFrame {
            froxels: [160, 90, 64],
            size: [1280, 720],
            camera: Vec3::ZERO,
            position_from_clip: Mat4::IDENTITY,
            lights: LightSummary::default(),
            scattering: Vec3::splat(0.1),
            extinction: 0.1,
            anisotropy: 0.8,
            nearest: 1.0,
            farthest: 50.0,
            cull_radiance: 1.0,
            seed: 0,
        };
        let constants = constants_of(&good).unwrap();
        let [columns, rows] = [constants.columns_rows & 0xffff, constants.columns_rows >> 16];
        assert_eq!([columns, rows, constants.slices_cull & 0xffff], good.froxels);
        for (field, frame) in [
            ("froxels", MediumFrame { froxels: [160, 0, 64], ..good }),
            ("froxels", MediumFrame { froxels: [160, 90, 65536], ..good }),
            ("size", MediumFrame { size: [0, 720], ..good }),
            ("camera", MediumFrame { camera: Vec3::NAN, ..good }),
            ("position_from_clip", MediumFrame { position_from_clip: Mat4::NAN, ..good }),
            ("scattering", MediumFrame { scattering: Vec3::new(0.0, -1.0, 0.0), ..good }),
            ("extinction", MediumFrame { extinction: f32::INFINITY, ..good }),
            ("anisotropy", MediumFrame { anisotropy: 1.0, ..good }),
            ("cull_radiance", MediumFrame { cull_radiance: -1.0, ..good }),
            ("cull_radiance", MediumFrame { cull_radiance: f32::NAN, ..good }),
            ("anisotropy", MediumFrame { anisotropy: f32::NAN, ..good }),
            ("farthest", MediumFrame { farthest: 1.0, ..good }),
            ("farthest", MediumFrame { nearest: 0.0, ..good }),
        ] {
            match constants_of(&frame) {
                Err(Error::InvalidArgument { field: named, .. }) => assert_eq!(named, field),
                other => panic!("{field}: {other:?}"),
            }
        }
    }
}
