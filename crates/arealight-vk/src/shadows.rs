//! Shadows: rays for the lights and lobes that the shade pass picked, and what their mean makes of its
//! radiance.

use crate::context::{COPIED, Context, USED, WRITTEN};
use crate::error::Error;
use crate::frame::ShadeFrame;
use crate::layouts::{Descriptors, Layouts};
use crate::module::check_module;
use crate::pipelines::Pipelines;
use crate::resource::Resource;
use crate::shade::{Bound, ResourceAccess, ShadeResources, accesses_of, check_lights};
use crate::view::{View, check_view, view_of};
use arealight::gpu::ShadowConstants;
use arealight::kernels::{Binding, SHADOW_FILTER, SHADOW_HISTORY, SHADOW_RAYS, store_to};
use arealight::plan::{self, Output, ShadeOptions, ShadowFilter, ShadowHistory};
use arealight::{LightSummary, Plane};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;

/// The output of a shadow pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ShadowOptions {
    /// How rays are filtered.
    pub filter: ShadowFilter,
    /// Of how many frames' rays a mean is made before.
    pub history: ShadowHistory,
    /// What is done to [`ShadowResources::radiance`].
    pub output: Output,
}

/// The options and modules of a shadow pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShadowPassInfo {
    /// Those of the shade passes before it.
    pub options: ShadeOptions,
    /// What is done with their radiance.
    pub shadows: ShadowOptions,
    /// A module that the host compiled from the kernel `shadow_rays.comp` with its own answer to what blocks
    /// a ray (docs/embed-shadows.md): a shadow map, an acceleration structure. By default rays meet
    /// [`ShadowResources::blockers`].
    pub module: Option<Vec<u32>>,
    /// The layout of descriptor set 1, where what that module reads is.
    pub host_set: Option<vk::DescriptorSetLayout>,
}

/// The host's resources of a shadow pass beyond those of its shade pass, of whose planes it reads
/// [`Plane::Motion`], too, with [`ShadowHistory::MotionVectors`].
#[derive(Debug, Clone, Copy)]
pub struct ShadowResources {
    /// An image of [`ShadowPass::SHADOW_FORMAT`] and the frame's size, with the usage `STORAGE`. The pass
    /// alone writes it.
    pub shadow: Resource,
    /// Where radiance goes, in the format of [`ShadeOptions::format`]. With none it replaces the unshadowed
    /// one in [`ShadeResources::radiance`].
    pub radiance: Option<Resource>,
    /// With [`ShadowOptions::history`], a buffer of [`plan::shadow_history_size`] bytes with the usages
    /// `STORAGE_BUFFER` and `TRANSFER_DST`, which holds zeros before the first frame and after each cut. The
    /// pass alone writes it; it is the same one for all frames of a view.
    pub history: Option<Resource>,
    /// What blocks rays; none with [`ShadowPassInfo::module`].
    pub blockers: Option<BlockerResources>,
}

/// A dispatch of a shadow pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ShadowStage {
    /// Traces the rays.
    Rays,
    /// Makes means over frames of them, with [`ShadowOptions::history`].
    History,
    /// Filters them, and multiplies the radiance.
    Filter,
}

/// What differs from frame to frame.
#[derive(Debug, Clone, Copy)]
pub struct ShadowFrame<'a> {
    /// That of the shade pass. With [`ShadowOptions::history`] it has [`ShadeFrame::position_from_clip`],
    /// also where positions come from an image, and [`ShadeFrame::seed`] counts frames.
    pub shade: &'a ShadeFrame,
    /// What is added to positions relative to this frame's origin for positions relative to that of the frame
    /// before. Read only with [`ShadowOptions::history`].
    pub origin_shift: Vec3,
}

/// The buffers of [`arealight::Blockers`].
#[derive(Debug, Clone, Copy)]
pub struct BlockerResources {
    /// [`arealight::Blockers::nodes`].
    pub nodes: Resource,
    /// [`arealight::Blockers::triangles`]; without triangles any buffer.
    pub triangles: Resource,
}

/// Shadow rays after a [`crate::ShadePass`] with [`ShadeOptions::shadow_rays`]: two dispatches, or three with
/// a history. Each ray is drawn from the lobe that it was picked for, over the light that it was picked for,
/// so that the part of the rays that arrive is, on average, the part of the radiance that does; where all or
/// none arrive there is no noise.
///
/// Rays to a polygon with an image are drawn by what it shows, in grey; to a disk with one evenly.
#[derive(Debug)]
pub struct ShadowPass {
    rays: Pipelines,
    history: Pipelines,
    filter: Pipelines,
    options: ShadeOptions,
    shadows: ShadowOptions,
}

impl ShadowPass {
    /// The format of [`ShadowResources::shadow`].
    pub const SHADOW_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

    /// Creates the set and pipeline layouts.
    ///
    /// # Safety
    /// As [`crate::ShadePass::new`], of [`ShadowPassInfo::module`] and [`ShadowPassInfo::host_set`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where the options have no shadow rays, or more than a pixel may have, or
    /// the module lacks the kernel's entry point and bindings; [`Error::MissingFeature`] where the device has
    /// too few storage buffers for a stage; [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(context: &Context, info: ShadowPassInfo) -> Result<Self, Error> {
        let ShadowPassInfo { options, shadows, module, host_set } = info;
        check_rays(options)?;
        let module = module.unwrap_or_else(|| SHADOW_RAYS.words());
        check_module(&module, &SHADOW_RAYS, host_set.is_some())?;
        let mut filter = SHADOW_FILTER.words();
        store_to(options.format, &mut filter);
        let binding = (Descriptors::Sets, host_set);
        // SAFETY: the same contract; every kernel has the bindings of the layouts.
        unsafe {
            let layouts = Layouts::with(context, &SHADOW_RAYS, SHADOW_RAYS.bindings().to_vec(), binding)?;
            let pipelines = |kernel, module| Pipelines::new(Arc::clone(&layouts), kernel, module);
            Ok(Self {
                rays: pipelines(&SHADOW_RAYS, module),
                history: pipelines(&SHADOW_HISTORY, SHADOW_HISTORY.words()),
                filter: pipelines(&SHADOW_FILTER, filter),
                options,
                shadows,
            })
        }
    }

    /// The layout that the host allocates descriptor set 0 with.
    pub fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.rays.layouts().set_layout()
    }

    /// What `sets` descriptor sets of this pass take from the host's descriptor pool.
    pub fn pool_sizes(&self, sets: u32) -> Vec<vk::DescriptorPoolSize> {
        self.rays.layouts().pool_sizes(sets)
    }

    /// How the pass uses each resource. What the shade pass before it wrote (`radiance_image` and
    /// `shadow_picks` there; here `unshadowed_image` and `shadow_picks`) is made visible by a barrier of the
    /// host's. Between its own two dispatches the pass has one of its own.
    pub fn accesses(&self) -> Vec<ResourceAccess> {
        let mut accesses = accesses_of(&SHADOW_RAYS);
        let filter = accesses_of(&SHADOW_FILTER).into_iter();
        let is_new = |access: &ResourceAccess| ["unshadowed_image", "radiance_image"].contains(&access.name);
        accesses.extend(filter.filter(is_new));
        let history = accesses_of(&SHADOW_HISTORY).into_iter();
        let is_kept = |access: &ResourceAccess| ["shadow_history", "g_motion"].contains(&access.name);
        accesses.extend(history.filter(|access| self.has_history() && is_kept(access)));
        accesses
    }

    /// Points a descriptor set at the resources of a run: `shade` are those of the shade pass before it.
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
        resources: &ShadowResources,
    ) -> Result<(), Error> {
        let missing = |field, message: &str| Error::InvalidArgument { field, message: message.into() };
        let picks = shade.picks.ok_or_else(|| missing("picks", "is missing: the shade pass writes it"))?;
        if resources.history.is_none() && self.has_history() {
            return Err(missing(
                "history",
                "is missing, but the pass keeps a history: see ShadowOptions::history",
            ));
        }
        let has_motion = self.shadows.history == ShadowHistory::MotionVectors;
        shade.check_planes(|plane| self.options.reads(plane) || (plane == Plane::Motion && has_motion))?;
        let blockers = match (resources.blockers, self.rays.layouts().has_host_set()) {
            (Some(blockers), _) => blockers,
            (None, true) => BlockerResources { nodes: shade.lights, triangles: shade.lights },
            (None, false) => {
                return Err(missing(
                    "blockers",
                    "are missing, but the pass was made without a module of the host's",
                ));
            }
        };
        let layouts = self.rays.layouts();
        let of = |binding: &Binding| match binding.name {
            "shadow_image" => resources.shadow,
            "radiance_image" => resources.radiance.unwrap_or(shade.radiance),
            "nodes" => blockers.nodes,
            "blocker_triangles" => blockers.triangles,
            "shadow_history" => resources.history.unwrap_or(picks),
            _ => shade.at(binding),
        };
        let all: Vec<_> = layouts.bindings().iter().map(of).collect();
        // SAFETY: the same contract.
        unsafe { layouts.write_set(set, &all, &shade.absent(layouts.bindings())) }
    }

    /// Makes the pipelines for a frame of these lights, which [`ShadowPass::record`] would otherwise do when
    /// the first such frame is recorded.
    ///
    /// # Errors
    /// [`Error::Vulkan`] where a call fails.
    pub fn prepare(&self, lights: LightSummary) -> Result<(), Error> {
        self.rays.with(self.rays_constants(lights), |_| ())?;
        if self.has_history() {
            self.history.with(self.history_constants(), |_| ())?;
        }
        self.filter.with(self.filter_constants(), |_| ())
    }

    fn rays_constants(&self, lights: LightSummary) -> Vec<(u32, u32)> {
        plan::shadow_rays_specialization(self.options, lights)
    }

    fn filter_constants(&self) -> Vec<(u32, u32)> {
        let ShadowOptions { filter, history, output } = self.shadows;
        plan::shadow_filter_specialization(self.options, filter, history, output)
    }

    fn history_constants(&self) -> Vec<(u32, u32)> {
        plan::shadow_history_specialization(self.options, self.shadows.history)
    }

    pub(crate) fn has_history(&self) -> bool {
        self.shadows.history != ShadowHistory::Off
    }

    /// Records the pass, for the frame that the shade pass recorded. With a history, `resources` are those
    /// that the set was written with: its buffer is updated too.
    ///
    /// # Safety
    /// As [`crate::ShadePass::record`]; the set was written by [`ShadowPass::write_set`] with `resources`,
    /// and the host's allocated with the layout that the pass was made with. A history's buffer is of
    /// [`plan::shadow_history_size`], and the frame before of this view was recorded earlier on its queue.
    ///
    /// # Errors
    /// As [`crate::ShadePass::record`]; [`Error::InvalidArgument`] names the field of `frame` that is
    /// missing, not to be, or wrong.
    pub unsafe fn record<'a>(
        &self,
        command_buffer: vk::CommandBuffer,
        bound: impl Into<Bound<'a>>,
        resources: &ShadowResources,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), Error> {
        let ready = self.checked(bound.into(), resources, frame)?;
        let context = self.rays.layouts().context();
        // SAFETY: the same contract; barriers are between the stages.
        unsafe {
            let _label = context.names.label(command_buffer, c"arealight shadows");
            for stage in self.stages() {
                if *stage != ShadowStage::Rays {
                    context.record_barrier(command_buffer, WRITTEN, USED);
                }
                self.dispatch(*stage, command_buffer, &ready)?;
            }
        }
        Ok(())
    }

    /// The dispatches of the pass, in order.
    pub fn stages(&self) -> &'static [ShadowStage] {
        if self.has_history() {
            &[ShadowStage::Rays, ShadowStage::History, ShadowStage::Filter]
        } else {
            &[ShadowStage::Rays, ShadowStage::Filter]
        }
    }

    /// One dispatch of [`ShadowPass::record`], for a host that has commands of its own between them, such as
    /// timestamps. What the one before wrote is made visible to it by a barrier of the host's.
    ///
    /// # Safety
    /// As [`ShadowPass::record`].
    ///
    /// # Errors
    /// As [`ShadowPass::record`].
    pub unsafe fn record_stage<'a>(
        &self,
        stage: ShadowStage,
        command_buffer: vk::CommandBuffer,
        bound: impl Into<Bound<'a>>,
        resources: &ShadowResources,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), Error> {
        let ready = self.checked(bound.into(), resources, frame)?;
        // SAFETY: the same contract.
        unsafe { self.dispatch(stage, command_buffer, &ready) }
    }

    /// A frame, where everything about it is right; what is missing of the pipelines is made.
    fn checked(
        &self,
        bound: Bound<'_>,
        resources: &ShadowResources,
        frame: &ShadowFrame<'_>,
    ) -> Result<ReadyFrame, Error> {
        let sets = bound.sets(self.rays.layouts(), frame.shade.lights)?;
        let view = view_of(self.options, frame.shade)?;
        if frame.shade.rows.is_some() {
            let message = "are a part of the frame, but shadows are of all of it: record its parts by the \
            shade pass alone";
            return Err(Error::InvalidArgument { field: "rows", message: message.into() });
        }
        let head = self.history_head(resources, frame, &view)?;
        let ShadeFrame { seed, size, lights, .. } = *frame.shade;
        check_lights(lights)?;
        if head.is_some() {
            let limits = self.rays.layouts().context().limits;
            limits.check_range(plan::shadow_history_size(size), "the history of shadows")?;
        }
        let position_from_clip = view.position_from_clip.to_cols_array_2d();
        let constants = ShadowConstants { position_from_clip, camera: view.camera, seed, size };
        let groups = SHADOW_RAYS.groups_for([size[0], size[1], 1]);
        self.rays.check(bytemuck::bytes_of(&constants), groups)?;
        self.prepare(lights)?;
        Ok(ReadyFrame { sets, constants, groups, head, lights })
    }

    /// Records one dispatch.
    ///
    /// # Safety
    /// As [`ShadowPass::record`].
    unsafe fn dispatch(
        &self,
        stage: ShadowStage,
        command_buffer: vk::CommandBuffer,
        ready: &ReadyFrame,
    ) -> Result<(), Error> {
        let (pipelines, specialization) = match stage {
            ShadowStage::Rays => (&self.rays, self.rays_constants(ready.lights)),
            ShadowStage::History => (&self.history, self.history_constants()),
            ShadowStage::Filter => (&self.filter, self.filter_constants()),
        };
        // SAFETY: the same contract; the head is within the buffer, which nothing else uses now.
        unsafe {
            if let Some(HistoryHead { buffer, offset, words }) = ready.head
                && stage == ShadowStage::Rays
            {
                let context = self.rays.layouts().context();
                context.record_barrier(command_buffer, WRITTEN, COPIED);
                context.device().cmd_update_buffer(
                    command_buffer,
                    buffer,
                    offset,
                    bytemuck::cast_slice(&words),
                );
                context.record_barrier(command_buffer, COPIED, USED);
            }
            pipelines.with(specialization, |pass| {
                let bytes = bytemuck::bytes_of(&ready.constants);
                pass.record_checked(command_buffer, &ready.sets, bytes, ready.groups);
            })
        }
    }

    /// What a pass with a history writes into its head.
    fn history_head(
        &self,
        resources: &ShadowResources,
        frame: &ShadowFrame<'_>,
        view: &View,
    ) -> Result<Option<HistoryHead>, Error> {
        if !self.has_history() {
            return Ok(None);
        }
        let wrong = |field, message: &str| Err(Error::InvalidArgument { field, message: message.into() });
        let Some(Resource::StorageBuffer { buffer, offset, .. }) = resources.history else {
            return wrong("history", "is no buffer, but the pass keeps a history");
        };
        if frame.shade.position_from_clip.is_none() {
            return wrong("position_from_clip", "is missing, but the pass keeps a history");
        }
        let clip_from_position = view.position_from_clip.inverse();
        if !clip_from_position.is_finite() {
            return wrong("position_from_clip", "has no inverse");
        }
        if !frame.origin_shift.is_finite() {
            return wrong("origin_shift", "holds NaN or infinity");
        }
        let mut words = [0.0; plan::SHADOW_HISTORY_HEAD / 2];
        words[..16].copy_from_slice(&clip_from_position.to_cols_array());
        words[16..19].copy_from_slice(&frame.origin_shift.to_array());
        let parity = vk::DeviceSize::from(frame.shade.seed & 1);
        Ok(Some(HistoryHead { buffer, offset: offset + parity * size_of_val(&words) as u64, words }))
    }
}

/// A frame that was checked.
struct ReadyFrame {
    /// From 0 on.
    sets: Vec<vk::DescriptorSet>,
    constants: ShadowConstants,
    groups: [u32; 3],
    head: Option<HistoryHead>,
    lights: LightSummary,
}

/// Of a history's head, what one frame writes: see `shadow_history.glsl`.
#[derive(Clone, Copy)]
struct HistoryHead {
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
    words: [f32; plan::SHADOW_HISTORY_HEAD / 2],
}

fn check_rays(options: ShadeOptions) -> Result<(), Error> {
    check_view(options)?;
    if (1..=ShadeOptions::MOST_SHADOW_RAYS).contains(&options.shadow_rays) {
        return Ok(());
    }
    let most = ShadeOptions::MOST_SHADOW_RAYS;
    let message = format!("is {}, but a pixel of a shadow pass has 1 to {most}", options.shadow_rays);
    Err(Error::InvalidArgument { field: "shadow_rays", message })
}
