//! Shadows: rays for the lights and lobes that the shade pass picked, and what their mean makes of its radiance.

use crate::context::Context;
use crate::error::Error;
use crate::layouts::Layouts;
use crate::pass::{Resource, check_module};
use crate::pipelines::Pipelines;
use crate::shade::{ResourceAccess, ShadeFrame, ShadeResources, accesses_of, push_constants_of_view};
use arealight::gpu::ShadowConstants;
use arealight::kernels::{SHADOW_FILTER, SHADOW_RAYS, store_to};
use arealight::plan::{self, Output, ShadeOptions, ShadowFilter};
use ash::vk;
use std::sync::Arc;

/// What a shadow pass does with the radiance of a shade pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ShadowOptions {
    /// How rays are filtered.
    pub filter: ShadowFilter,
    /// What is done to [`ShadowResources::radiance`].
    pub output: Output,
}

/// The host's resources of a shadow pass beyond those of its shade pass.
#[derive(Debug, Clone, Copy)]
pub struct ShadowResources {
    /// An image of [`ShadowPass::SHADOW_FORMAT`] and the frame's size, with the usage `STORAGE`. The pass alone writes it.
    pub shadow: Resource,
    /// Where radiance goes, in the format of [`ShadeOptions::format`]. With none it replaces the unshadowed one in
    /// [`ShadeResources::radiance`].
    pub radiance: Option<Resource>,
    /// What blocks rays; none with a module that asks the host ([`ShadowPass::with_module`]).
    pub blockers: Option<BlockerResources>,
}

/// The buffers of [`arealight::Blockers`].
#[derive(Debug, Clone, Copy)]
pub struct BlockerResources {
    /// [`arealight::Blockers::nodes`].
    pub nodes: Resource,
    /// [`arealight::Blockers::triangles`]; without triangles any buffer.
    pub triangles: Resource,
}

/// Shadow rays after a [`crate::ShadePass`] with [`ShadeOptions::shadow_rays`]: two dispatches. Each ray is drawn from the lobe that it was picked
/// for, over the light that it was picked for, so that the part of the rays that arrive is, on average, the part of the radiance that does; where
/// all or none arrive there is no noise.
///
/// Of textured lights every texel counts alike; ends of open and flat tubes are no part of their outline.
#[derive(Debug)]
pub struct ShadowPass {
    rays: Pipelines,
    filter: Pipelines,
    options: ShadeOptions,
    shadows: ShadowOptions,
}

impl ShadowPass {
    /// The format of [`ShadowResources::shadow`].
    pub const SHADOW_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

    /// A pass whose rays meet [`ShadowResources::blockers`], after shade passes of `options`.
    ///
    /// # Safety
    /// As [`crate::ShadePass::new`].
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where `options` have no shadow rays, or more than a pixel may have; [`Error::MissingFeature`] where the device has
    /// too few storage buffers for a stage; [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(
        context: &Context,
        options: ShadeOptions,
        shadows: ShadowOptions,
    ) -> Result<Self, Error> {
        check_rays(options)?;
        // SAFETY: the same contract; the module is the kernel's.
        unsafe {
            let layouts = Layouts::new(context, &SHADOW_RAYS)?;
            Ok(Self::of(&layouts, options, shadows, SHADOW_RAYS.words()))
        }
    }

    /// As [`ShadowPass::new`], of a module that the host compiled from the kernel `shadow_rays.comp` with its own answer to what blocks a ray
    /// (docs/shadows.md): a shadow map, an acceleration structure. What that reads is in descriptor set 1, of this layout.
    ///
    /// # Safety
    /// As [`ShadowPass::new`]. The module is valid SPIR-V of this version's kernel; `host_set` is a layout of the device, valid as long as the pass.
    ///
    /// # Errors
    /// As [`ShadowPass::new`]; [`Error::InvalidArgument`] for what is no SPIR-V.
    pub unsafe fn with_module(
        context: &Context,
        options: ShadeOptions,
        shadows: ShadowOptions,
        module: Vec<u32>,
        host_set: vk::DescriptorSetLayout,
    ) -> Result<Self, Error> {
        check_rays(options)?;
        check_module(&module)?;
        // SAFETY: the same contract.
        unsafe {
            let layouts = Layouts::with_host_set(context, &SHADOW_RAYS, Some(host_set))?;
            Ok(Self::of(&layouts, options, shadows, module))
        }
    }

    /// # Safety
    /// As [`Pipelines::new`].
    unsafe fn of(
        layouts: &Arc<Layouts>,
        options: ShadeOptions,
        shadows: ShadowOptions,
        module: Vec<u32>,
    ) -> Self {
        let mut filter = SHADOW_FILTER.words();
        store_to(options.format, &mut filter);
        // SAFETY: the same contract; both kernels have the bindings of the layouts.
        unsafe {
            Self {
                rays: Pipelines::new(Arc::clone(layouts), &SHADOW_RAYS, module),
                filter: Pipelines::new(Arc::clone(layouts), &SHADOW_FILTER, filter),
                options,
                shadows,
            }
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

    /// How the pass uses each resource. What the shade pass before it wrote (`radiance_image` and `shadow_picks` there; here
    /// `unshadowed_image` and `shadow_picks`) is made visible by a barrier of the host's. Between its own two dispatches the pass has one of its own.
    pub fn accesses(&self) -> Vec<ResourceAccess> {
        let mut accesses = accesses_of(&SHADOW_RAYS);
        let filter = accesses_of(&SHADOW_FILTER).into_iter();
        let is_new = |access: &ResourceAccess| ["unshadowed_image", "radiance_image"].contains(&access.name);
        accesses.extend(filter.filter(is_new));
        accesses
    }

    /// Points a descriptor set at the resources of a run: `shade` are those of the shade pass before it.
    ///
    /// # Safety
    /// As [`crate::ComputePass::write_set`]: the set is not in use, and the resources outlive the recorded work.
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
        let all = [
            shade.table,
            shade.lights,
            shade.light_vertices,
            shade.position,
            shade.normal,
            shade.base_color,
            shade.specular.unwrap_or(shade.base_color),
            shade.radiance,
            shade.shapes.unwrap_or(shade.lights),
            shade.coat.unwrap_or(shade.base_color),
            picks,
            resources.shadow,
            resources.radiance.unwrap_or(shade.radiance),
            blockers.nodes,
            blockers.triangles,
        ];
        // SAFETY: the same contract.
        unsafe { self.rays.layouts().write_set(set, &all) }
    }

    /// Makes the pipelines, which [`ShadowPass::record`] would otherwise do when it is first called.
    ///
    /// # Errors
    /// [`Error::Vulkan`] where a call fails.
    pub fn prepare(&self) -> Result<(), Error> {
        self.rays.with(self.rays_constants(), |_| ())?;
        self.filter.with(self.filter_constants(), |_| ())
    }

    fn rays_constants(&self) -> Vec<(u32, u32)> {
        plan::shadow_rays_specialization(self.options)
    }

    fn filter_constants(&self) -> Vec<(u32, u32)> {
        plan::shadow_filter_specialization(self.options, self.shadows.filter, self.shadows.output)
    }

    /// Records the pass, for the frame that the shade pass recorded. `host_set` is bound as set 1 for a module of the host's.
    ///
    /// # Safety
    /// As [`crate::ShadePass::record`]; `set` was written by [`ShadowPass::write_set`], and `host_set` allocated with the layout that the pass was
    /// made with.
    ///
    /// # Errors
    /// As [`crate::ShadePass::record`]; [`Error::InvalidArgument`] where `host_set` is missing or not to be.
    pub unsafe fn record(
        &self,
        command_buffer: vk::CommandBuffer,
        set: vk::DescriptorSet,
        host_set: Option<vk::DescriptorSet>,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        let layouts = self.rays.layouts();
        if host_set.is_some() != layouts.has_host_set() {
            let message = if host_set.is_some() {
                "is given, but the pass was made without a module of the host's"
            } else {
                "is missing, but the pass was made with a module of the host's"
            };
            return Err(Error::InvalidArgument { field: "host_set", message: message.into() });
        }
        // Check everything, and make what is missing, before anything is recorded
        let (position_from_clip, camera) = push_constants_of_view(self.options, frame)?;
        let constants = ShadowConstants { position_from_clip, camera, seed: frame.seed, size: frame.size };
        let (bytes, groups) =
            (bytemuck::bytes_of(&constants), SHADOW_RAYS.groups_for([frame.size[0], frame.size[1], 1]));
        self.rays.check(set, bytes, groups)?;
        self.prepare()?;

        let sets: Vec<_> = std::iter::once(set).chain(host_set).collect();
        // SAFETY: the same contract.
        unsafe {
            let _label = layouts.context().names.label(command_buffer, c"arealight shadows");
            self.rays.with(self.rays_constants(), |pass| {
                pass.record_checked(command_buffer, &sets, bytes, groups);
            })?;
            self.record_barrier(command_buffer);
            self.filter.with(self.filter_constants(), |pass| {
                pass.record_checked(command_buffer, &sets, bytes, groups);
            })
        }
    }

    /// What the rays wrote is read by the filter.
    ///
    /// # Safety
    /// As [`ShadowPass::record`].
    unsafe fn record_barrier(&self, command_buffer: vk::CommandBuffer) {
        let barrier = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::SHADER_READ)];
        let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
        let flags = vk::DependencyFlags::empty();
        let device = self.rays.layouts().context().device();
        // SAFETY: the same contract.
        unsafe { device.cmd_pipeline_barrier(command_buffer, compute, compute, flags, &barrier, &[], &[]) };
    }
}

fn check_rays(options: ShadeOptions) -> Result<(), Error> {
    if (1..=ShadeOptions::MOST_SHADOW_RAYS).contains(&options.shadow_rays) {
        return Ok(());
    }
    let most = ShadeOptions::MOST_SHADOW_RAYS;
    let message = format!("is {}, but a pixel of a shadow pass has 1 to {most}", options.shadow_rays);
    Err(Error::InvalidArgument { field: "shadow_rays", message })
}
