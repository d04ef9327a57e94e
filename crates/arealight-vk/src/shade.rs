//! The shade pass: a G-buffer, lights and the table go in, radiance comes out.

mod bound;
mod resources;

pub use bound::Bound;
pub(crate) use resources::accesses_of;
pub use resources::{ResourceAccess, ShadeResources};

use crate::context::Context;
use crate::error::Error;
use crate::frame::{GROUP_SIDE, ShadeFrame};
use crate::layouts::{Descriptors, Layouts};
use crate::module::check_module;
use crate::pipelines::Pipelines;
use crate::resource::Resource;
use crate::tiles::{TileMemory, TiledFrame, Tiles};
use crate::view::{check_view, view_of};
use arealight::gpu::ShadeConstants;
use arealight::kernels::{CLASSIFY, Kernel, SHADE, TILE_BINDINGS, read_samples, store_to};
use arealight::plan::{self, Output, ShadeOptions, TileOptions};
use arealight::{Effects, LightSummary, Plane};
use ash::vk;
use resources::{LIGHT_COUNTS, LOBE_HORIZONS, TILE_LISTS, needed};
use std::ops::Range;

/// The options, tiles and modules of a shade pass.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadePassInfo {
    /// How the host's surfaces are stored and shaded.
    pub options: ShadeOptions,
    /// With tiles (docs/tiles.md) [`ShadeResources::lobe_horizons`] and `tile_lists` are needed.
    pub tiles: Option<TileOptions>,
    /// Nodes a side of the table that will be bound, [`arealight::LightTable::size`]; by default those of the
    /// built-in one. Only tiles depend on it.
    pub table_size: u32,
    /// A module that the host compiled from the kernel's sources, for a G-buffer of its own
    /// (docs/embed-glsl.md), in which case [`ShadeOptions::g_buffer`] does not count; or one that asks the
    /// host what part of each light arrives (docs/embed-shadows.md). By default the kernel's own.
    pub module: Option<Vec<u32>>,
    /// The module of the kernel `classify` that goes with `module`, with tiles.
    pub tile_module: Option<Vec<u32>>,
    /// The layout of descriptor set 1, where what a module of the host's reads is.
    pub host_set: Option<vk::DescriptorSetLayout>,
    /// How the pass gets at its resources.
    pub descriptors: Descriptors,
}

impl Default for ShadePassInfo {
    /// [`ShadeOptions::default`], the kernel's own module without tiles, and descriptor sets.
    fn default() -> Self {
        Self {
            options: ShadeOptions::default(),
            tiles: None,
            table_size: 64,
            module: None,
            tile_module: None,
            host_set: None,
            descriptors: Descriptors::Sets,
        }
    }
}

impl From<ShadeOptions> for ShadePassInfo {
    fn from(options: ShadeOptions) -> Self {
        Self { options, ..Self::default() }
    }
}

/// The shade kernel, specialised for a host's surfaces and a quality, for every kind of light.
///
/// A frame's pipeline has what its lights and the surfaces need, and nothing else.
/// It is made when the first such frame is recorded, or ahead by [`ShadePass::prepare`], and kept.
///
/// With [`ShadePassInfo::tiles`] a dispatch first lists the lights that contribute to each tile of 8
/// × 8 pixels, and tiles of quads alone run less code than others. The picture is the same but for lights
/// that are left out, by [`TileOptions`].
#[derive(Debug)]
pub struct ShadePass {
    pipelines: Pipelines,
    tiles: Option<Tiles>,
    options: ShadeOptions,
}

impl ShadePass {
    /// Creates the set and pipeline layouts, from a [`ShadePassInfo`] or just [`ShadeOptions`].
    ///
    /// # Safety
    /// - As [`crate::ComputePass::new`]: drop the pass when no recorded use of it is pending, before the
    ///   device goes.
    /// - Modules are valid SPIR-V of this version's kernels; [`ShadePassInfo::host_set`] is a layout of the
    ///   device, valid as long as the pass.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field that is out of range, or a module without the kernel's
    /// entry point and bindings; [`Error::MissingFeature`] where the device has too few storage buffers for a
    /// stage, or was made without `VK_KHR_push_descriptor` that [`Descriptors::Pushed`] needs;
    /// [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(context: &Context, info: impl Into<ShadePassInfo>) -> Result<Self, Error> {
        let ShadePassInfo { options, tiles, table_size, module, tile_module, host_set, descriptors } =
            info.into();
        check_options(options)?;
        let shade = module_of(&SHADE, options, (module.as_deref(), host_set.is_some()))?;
        // Frames without tiles have none of their bindings
        let is_used = |name| match name {
            LIGHT_COUNTS => options.light_counts,
            name => tiles.is_some() || !TILE_BINDINGS.contains(&name),
        };
        let bindings = SHADE.bindings().iter().copied();
        let bindings = bindings.filter(|binding| context.whole_modules || is_used(binding.name)).collect();
        // SAFETY: the same contract; what is no module of the kernel was refused.
        unsafe {
            let layouts = Layouts::with(context, &SHADE, bindings, (descriptors, host_set))?;
            let tiles = match tiles {
                None => None,
                Some(_) if module.is_some() && tile_module.is_none() => {
                    let message = "is missing: tiles are classified by the G-buffer of `module`".into();
                    return Err(Error::InvalidArgument { field: "tile_module", message });
                }
                Some(tiles) => {
                    let classify =
                        module_of(&CLASSIFY, options, (tile_module.as_deref(), host_set.is_some()))?;
                    Some(Tiles::new(&layouts, classify, tiles, table_size)?)
                }
            };
            Ok(Self { pipelines: Pipelines::new(layouts, &SHADE, shade), tiles, options })
        }
    }

    /// The options of the pass.
    pub fn options(&self) -> ShadeOptions {
        self.options
    }

    /// How tiles get their lists of lights, in a pass with tiles.
    pub fn tiles(&self) -> Option<TileOptions> {
        self.tiles.as_ref().map(Tiles::options)
    }

    /// What [`ShadeResources::tile_lists`] needs for images of `size` pixels; none in a pass without tiles.
    pub fn tile_memory(&self, size: [u32; 2]) -> Option<TileMemory> {
        self.tiles.as_ref().map(|tiles| tiles.memory(size))
    }

    /// How many bytes [`ShadeResources::picks`] needs for images of `size` pixels.
    pub fn picks_size(&self, size: [u32; 2]) -> vk::DeviceSize {
        plan::shadow_picks_size(self.options.shadow_rays, size)
    }

    /// The layout that the host allocates a descriptor set with.
    pub fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.pipelines.layouts().set_layout()
    }

    /// What `sets` descriptor sets of this pass take from the host's descriptor pool.
    pub fn pool_sizes(&self, sets: u32) -> Vec<vk::DescriptorPoolSize> {
        self.pipelines.layouts().pool_sizes(sets)
    }

    /// How the pass uses each resource. The lists of tiles are not among them: they are written and read
    /// within the pass, with barriers of its own, from `TRANSFER` to `DRAW_INDIRECT` and `COMPUTE_SHADER`.
    /// Before the buffer is used by another frame the host waits for those stages, as for any buffer that is
    /// written again.
    pub fn accesses(&self) -> Vec<ResourceAccess> {
        let mut accesses = accesses_of(&SHADE);
        let is_used = |name| match name {
            TILE_LISTS => false,
            LIGHT_COUNTS => self.options.light_counts,
            _ => Plane::bound_at(name) != Some(Plane::Stencil) || self.options.reads(Plane::Stencil),
        };
        accesses.retain(|access| is_used(access.name));
        if self.tiles.is_some() {
            accesses.extend(accesses_of(&CLASSIFY).into_iter().filter(|access| access.name == LOBE_HORIZONS));
        }
        accesses
    }

    /// In which stages, and how, the pass uses any of its resources: what one barrier for all of them is made
    /// of.
    pub fn stages_and_access(&self) -> (vk::PipelineStageFlags, vk::AccessFlags) {
        let all = self.accesses();
        (
            all.iter().fold(vk::PipelineStageFlags::empty(), |stages, one| stages | one.stage),
            all.iter().fold(vk::AccessFlags::empty(), |access, one| access | one.access),
        )
    }

    /// Points a descriptor set at the resources of a run.
    ///
    /// # Safety
    /// As [`crate::ComputePass::write_set`]: the set is not in use, and the resources outlive the recorded
    /// work.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the resource that is missing, null or of the wrong kind.
    pub unsafe fn write_set(&self, set: vk::DescriptorSet, resources: &ShadeResources) -> Result<(), Error> {
        let (resources, absent) = self.in_order(resources)?;
        // SAFETY: the same contract.
        unsafe { self.pipelines.layouts().write_set(set, &resources, &absent) }
    }

    /// Makes the pipelines for frames whose lights need what this one's do, where they are not made yet. That
    /// takes a moment, which [`ShadePass::record`] would take otherwise.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] as [`ShadePass::record`]; [`Error::Vulkan`] where a call fails.
    pub fn prepare(&self, frame: &ShadeFrame) -> Result<(), Error> {
        let constants = self.constants(frame)?;
        match self.tiled(frame, constants)? {
            Some((tiles, frame)) => tiles.prepare(&self.pipelines, self.options, &frame),
            None => self.pipelines.with(plan::shade_specialization(self.options, frame.lights), |_| ()),
        }
    }

    /// Records the pass. The host's barriers make the resources visible before, by [`ShadePass::accesses`].
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with compute.
    /// - A set was written by [`ShadePass::write_set`], or what is pushed is valid, with images that hold the
    ///   frame's pixels and buffers that hold the lights that `frame.lights` is of; picks are of
    ///   [`ShadePass::picks_size`]; with tiles, with `frame.tile_lists`, a buffer of
    ///   [`ShadePass::tile_memory`] for that size, which no pending commands use without a barrier between.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field of `frame` that is wrong, or the resource that its lights
    /// need and the set was written without; [`Error::MissingFeature`] where a buffer for so many pixels is
    /// larger than the device binds; [`Error::Vulkan`] where a pipeline cannot be made. Then nothing is
    /// recorded.
    pub unsafe fn record<'a>(
        &self,
        command_buffer: vk::CommandBuffer,
        bound: impl Into<Bound<'a>>,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        // Check everything before anything is recorded
        let layouts = self.pipelines.layouts();
        let bound = bound.into();
        layouts.check_host_set(bound.host_set())?;
        layouts.check_light_offsets(frame.light_offsets)?;
        let constants = self.constants(frame)?;
        let pushed = match bound {
            Bound::Pushed { resources, .. } => self.pushed(resources, frame)?,
            Bound::Set(set) | Bound::Sets([set, _]) => {
                layouts.check_takes_sets()?;
                layouts.check_present(set, &needed(frame.lights))?;
                layouts.check_set(set)?;
                vec![]
            }
        };

        // SAFETY: the same contract.
        let bind = || unsafe {
            match bound {
                Bound::Set(set) => layouts.bind_sets(command_buffer, &[set], frame.light_offsets),
                Bound::Sets(sets) => layouts.bind_sets(command_buffer, &sets, frame.light_offsets),
                Bound::Pushed { host_set, .. } => layouts.push(command_buffer, &pushed, host_set),
            }
        };
        let names = &layouts.context().names;
        if let Some((tiles, frame)) = self.tiled(frame, constants)? {
            // SAFETY: the same contract.
            return unsafe {
                let _label = names.label(command_buffer, c"arealight tiles");
                tiles.record(command_buffer, bind, &self.pipelines, self.options, &frame)
            };
        }
        let groups = SHADE.groups_for([frame.size[0], frame.size[1], 1]);
        let rows = group_rows(frame)?;
        self.pipelines.check(bytemuck::bytes_of(&constants), groups)?;
        self.pipelines.with(plan::shade_specialization(self.options, frame.lights), |pass| {
            // SAFETY: the same contract.
            unsafe {
                let _label = names.label(command_buffer, c"arealight shade");
                bind();
                pass.record_rows(command_buffer, bytemuck::bytes_of(&constants), (groups, rows));
            }
        })
    }

    /// The resources to push for a frame, checked.
    fn pushed(&self, resources: &ShadeResources, frame: &ShadeFrame) -> Result<Vec<Resource>, Error> {
        let layouts = self.pipelines.layouts();
        layouts.check_takes_resources()?;
        let (resources, absent) = self.in_order(resources)?;
        layouts.check_resources(&resources)?;
        match needed(frame.lights).into_iter().find(|binding| absent.contains(binding)) {
            Some(field) => {
                let message = "is missing, but the frame's lights need it".into();
                Err(Error::InvalidArgument { field, message })
            }
            None => Ok(resources),
        }
    }

    /// The resources as the pass's bindings have them; the bindings of those that are missing.
    fn in_order(&self, resources: &ShadeResources) -> Result<(Vec<Resource>, Vec<&'static str>), Error> {
        resources.in_order(self.options, self.tiles.is_some(), self.pipelines.layouts().bindings())
    }

    /// The tiles of a frame that is classified.
    fn tiled(
        &self,
        frame: &ShadeFrame,
        constants: ShadeConstants,
    ) -> Result<Option<(&Tiles, TiledFrame)>, Error> {
        let Some(tiles) = &self.tiles else { return Ok(None) };
        let frame = tiles.checked(frame, constants, group_rows(frame)?)?;
        Ok(frame.map(|frame| (tiles, frame)))
    }

    /// The push constants of a frame.
    fn constants(&self, frame: &ShadeFrame) -> Result<ShadeConstants, Error> {
        let view = view_of(self.options, frame)?;
        check_lights(frame.lights)?;
        group_rows(frame)?;
        let limits = self.pipelines.layouts().context().limits;
        limits.check_range(self.picks_size(frame.size), "the buffer of shadow picks")?;
        Ok(ShadeConstants {
            position_from_clip: view.position_from_clip.to_cols_array_2d(),
            camera: view.camera,
            light_count: frame.lights.light_count,
            shape_count: frame.lights.shape_count,
            quad_count: frame.lights.quad_count,
            size: frame.size,
            offset: frame.offset,
            seed: frame.seed,
            stencil: u32::from(frame.stencil.compare_mask) | u32::from(frame.stencil.reference) << 8,
            ..ShadeConstants::default()
        })
    }
}

/// A kernel's own module or the host's, for the images of a pass.
fn module_of(
    kernel: &'static Kernel,
    options: ShadeOptions,
    (own, has_host_set): (Option<&[u32]>, bool),
) -> Result<Vec<u32>, Error> {
    let mut words = match own {
        None => kernel.words(),
        Some(words) => {
            check_module(words, kernel, has_host_set)?;
            words.to_vec()
        }
    };
    store_to(options.format, &mut words);
    read_samples(options.samples, &mut words);
    Ok(words)
}

/// The rows of workgroups that a record shades.
fn group_rows(frame: &ShadeFrame) -> Result<Range<u32>, Error> {
    let end_of_frame = frame.size[1];
    let Some([first, end]) = frame.rows else { return Ok(0..end_of_frame.div_ceil(GROUP_SIDE)) };
    let wrong = |message: String| Err(Error::InvalidArgument { field: "rows", message });
    if first >= end || end > end_of_frame {
        return wrong(format!("{first} to {end} are no rows of the frame's {end_of_frame}"));
    }
    if first % GROUP_SIDE != 0 || (end % GROUP_SIDE != 0 && end != end_of_frame) {
        return wrong(format!("{first} to {end} cut workgroups, which are {GROUP_SIDE} rows each"));
    }
    Ok(first / GROUP_SIDE..end.div_ceil(GROUP_SIDE))
}

/// Refuses options that no pass can be made with.
fn check_options(options: ShadeOptions) -> Result<(), Error> {
    check_view(options)?;
    if !options.surfaces.intersects(Effects::LOBES) {
        return Err(Error::InvalidArgument {
            field: "surfaces",
            message: format!("have no lobe, and would be black: {}", options.surfaces),
        });
    }
    let wrong = |field, message: &str| Err(Error::InvalidArgument { field, message: message.into() });
    if options.shadow_rays > ShadeOptions::MOST_SHADOW_RAYS {
        return wrong("shadow_rays", "is more than ShadeOptions::MOST_SHADOW_RAYS");
    }
    if options.shadow_rays > 0 && options.output != Output::Overwrite {
        return wrong(
            "output",
            "adds, but with shadow rays the unshadowed radiance has an image of its own: \
            ShadowOptions::output adds",
        );
    }
    if options.shadow_rays > 0 && options.separate_lobes {
        return wrong("separate_lobes", "is set, but with shadow rays the lobes' radiance is one sum");
    }
    Ok(())
}

/// Refuses an inconsistent summary of packed lights.
pub(crate) fn check_lights(lights: LightSummary) -> Result<(), Error> {
    let wrong = |message: String| Err(Error::InvalidArgument { field: "lights", message });
    let LightSummary { light_count, quad_count, shape_count, effects } = lights;
    if quad_count > light_count {
        return wrong(format!("has {quad_count} quads of {light_count} lights"));
    }
    for (count, effects_of, kind) in [
        (light_count - quad_count, Effects::BEYOND_QUADS, "lights beyond quads"),
        (shape_count, Effects::SHAPES, "shapes"),
    ] {
        if count > 0 && !effects.intersects(effects_of) {
            return wrong(format!("has {count} {kind}, but none of the effects: {effects_of}"));
        }
    }
    Ok(())
}
