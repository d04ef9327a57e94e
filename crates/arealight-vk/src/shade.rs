//! The shade pass: a G-buffer, lights and the table go in, radiance comes out.

mod resources;

pub(crate) use resources::accesses_of;
pub use resources::{ResourceAccess, ShadeResources};

use crate::context::Context;
use crate::error::Error;
use crate::layouts::Layouts;
use crate::module::check_module;
use crate::pass::Resource;
use crate::pipelines::Pipelines;
use crate::tiles::{TileMemory, TiledFrame, Tiles};
use crate::view::{Viewport, check_view, view_of};
use arealight::gpu::ShadeConstants;
use arealight::kernels::{CLASSIFY, FRAME_BINDINGS, SHADE, read_samples, store_to};
use arealight::plan::{self, Output, ShadeOptions, TileOptions};
use arealight::{Effects, LightSummary};
use ash::vk;
use glam::{Mat4, Vec3};
use resources::{LIGHT_COUNTS, LOBE_HORIZONS, STENCIL, TILE_LISTS, needed};
use std::ops::Range;

/// What differs from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShadeFrame {
    /// How many pixels are shaded, from the corner x = y = 0 of the radiance images on, or from `offset`. The
    /// images may be larger. The G-buffer's images have a texel for each pixel, or
    /// [`ShadeOptions::texels_per_pixel`] to a side.
    pub size: [u32; 2],
    /// With [`ShadeOptions::rectangle`], the first pixel that is shaded; else zero. In the G-buffer it has
    /// the same place, times [`ShadeOptions::texels_per_pixel`].
    pub offset: [u32; 2],
    /// The viewport that drew the G-buffer. Its height is negative where y is up in clip space, as in hosts
    /// that come from Direct3D, Metal or WebGPU. None: just the texels of `size` and `offset`, y down, depth
    /// from 0 to 1. Only positions from depth, and a shadow's history, depend on it.
    pub viewport: Option<Viewport>,
    /// The camera's position relative to the origin that lights and positions are packed with; with
    /// [`ShadeOptions::orthographic`] the direction to it, of any length but zero. With shadow rays the
    /// length is that at which a perspective camera would stand that sees as much: what counts as one plane
    /// depends on it.
    pub camera: Vec3,
    /// The inverse of (projection × view), from clip space to positions relative to the origin: of the matrix
    /// that drew the depth, jitter included. Needed with [`ShadeOptions::from_depth`], else ignored.
    pub position_from_clip: Option<Mat4>,
    /// [`PackedLights::summary`](arealight::PackedLights::summary) of the lights in the set's buffers; with
    /// [`ShadeOptions::light_counts`] the most that there may be.
    pub lights: LightSummary,
    /// With tiles, [`ShadeResources::tile_lists`] of the set: dispatches are read from it. Passes without
    /// tiles do not use it.
    pub tile_lists: Option<Resource>,
    /// With [`ShadeOptions::shadow_rays`], of the random numbers that rays are drawn with: one more in each
    /// frame. Else ignored.
    pub seed: u32,
    /// The rows of pixels that this record shades, from the first to before the second, of those that `size`
    /// says; None: all. Both are multiples of 8, or the second is the last row's end. A frame of more work
    /// than a driver's watchdog allows is recorded and submitted by [`ShadeFrame::parts`]. The picture is the
    /// same to the bit.
    pub rows: Option<[u32; 2]>,
    /// With [`ShadeOptions::stencil`], which pixels are shaded. Else ignored.
    pub stencil: StencilTest,
    /// With [`Context::with_light_offsets`], where the frame's lights, vertices and shapes begin, in bytes
    /// after what the set was written with. Else zero.
    pub light_offsets: [u32; 3],
}

/// Shades pixels whose stencil equals the reference in the bits of the mask: `VK_COMPARE_OP_EQUAL`. By
/// default all are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StencilTest {
    /// The bits that are compared.
    pub compare_mask: u8,
    /// What they must be.
    pub reference: u8,
}

impl ShadeFrame {
    /// The frame in parts of whole rows of workgroups, each with at most `most` pairs of a pixel and a light;
    /// the smallest part is a row of workgroups (8 rows of pixels). docs/gpu.md has the cost of a light; 2^24
    /// pairs take less than two seconds on a device that does ten million a second. Tiles leave out pairs
    /// that are counted here.
    pub fn parts(&self, most: u64) -> impl Iterator<Item = Self> + use<> {
        let frame = *self;
        let [first, end] = frame.rows.unwrap_or([0, frame.size[1]]);
        let lights = u64::from(frame.lights.light_count) + u64::from(frame.lights.shape_count);
        let pairs_of_group_row = u64::from(GROUP_SIDE) * u64::from(frame.size[0]) * lights.max(1);
        let group_rows = (most / pairs_of_group_row.max(1)).clamp(1, u64::from(u32::MAX / GROUP_SIDE));
        let step = group_rows as u32 * GROUP_SIDE;
        (first..end)
            .step_by(step as usize)
            .map(move |row| Self { rows: Some([row, row.saturating_add(step).min(end)]), ..frame })
    }
}

/// Rows of pixels of a workgroup, of the kernels shade and classify alike.
const GROUP_SIDE: u32 = arealight::tiles::SIDE;

/// The shade kernel, specialised for a host's surfaces and a quality, for every kind of light.
///
/// A frame's pipeline has what its lights and the surfaces need, and nothing else.
/// It is made when the first such frame is recorded, or ahead by [`ShadePass::prepare`], and kept.
///
/// With tiles ([`ShadePass::with_tiles`]) a dispatch first lists the lights that contribute to each tile of 8
/// × 8 pixels, and tiles of quads alone run less code than others. The picture is the same but for lights
/// that are left out, by [`TileOptions`].
#[derive(Debug)]
pub struct ShadePass {
    pipelines: Pipelines,
    tiles: Option<Tiles>,
    options: ShadeOptions,
}

impl ShadePass {
    /// Creates the set and pipeline layouts.
    ///
    /// # Safety
    /// As [`crate::ComputePass::new`]: drop the pass when no recorded use of it is pending, before the device
    /// goes.
    ///
    /// # Errors
    /// [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(context: &Context, options: ShadeOptions) -> Result<Self, Error> {
        // SAFETY: the same contract; the module is the kernel's.
        unsafe { Self::of_module(context, options, SHADE.words(), None) }
    }

    /// As [`ShadePass::new`], with tiles (docs/tiles.md): [`ShadeResources::lobe_horizons`] and `tile_lists`
    /// are needed then. `table_size` is how many nodes a side the table has that will be bound,
    /// [`arealight::LightTable::size`].
    ///
    /// # Safety
    /// As [`ShadePass::new`].
    ///
    /// # Errors
    /// As [`ShadePass::new`]; [`Error::InvalidArgument`] names the field of `tiles` that is out of range;
    /// [`Error::MissingFeature`] where the device has too few storage buffers for a stage.
    pub unsafe fn with_tiles(
        context: &Context,
        options: ShadeOptions,
        tiles: TileOptions,
        table_size: u32,
    ) -> Result<Self, Error> {
        check_options(options)?;
        // SAFETY: the same contract; the modules are the kernels'.
        unsafe {
            let descriptors = context.descriptors.clone();
            let layouts = Layouts::with(context, &SHADE, SHADE.bindings, (descriptors, None))?;
            let tiles = Tiles::new(&layouts, options, tiles, table_size)?;
            let pipelines = Pipelines::new(layouts, &SHADE, SHADE.words_for(options.format, options.samples));
            Ok(Self { pipelines, tiles: Some(tiles), options })
        }
    }

    /// As [`ShadePass::new`], of a module that the host compiled from the kernel's sources, for a G-buffer of
    /// its own (docs/embed-glsl.md): [`ShadeOptions::g_buffer`] does not count then.
    ///
    /// # Safety
    /// As [`ShadePass::new`]. The module is valid SPIR-V of this version's `shade.comp`.
    ///
    /// # Errors
    /// As [`ShadePass::new`]; [`Error::InvalidArgument`] if it is not a module with the kernel's
    /// entry point and bindings.
    pub unsafe fn with_module(
        context: &Context,
        options: ShadeOptions,
        module: Vec<u32>,
    ) -> Result<Self, Error> {
        check_module(&module, &SHADE)?;
        // SAFETY: the same contract.
        unsafe { Self::of_module(context, options, module, None) }
    }

    /// As [`ShadePass::with_module`], of a module that asks the host what part of each light arrives
    /// (docs/shadows.md): what it reads is in descriptor set 1, of this layout, which
    /// [`ShadePass::record_with_set`] binds.
    ///
    /// # Safety
    /// As [`ShadePass::with_module`]; `host_set` is a layout of the device, valid as long as the pass.
    ///
    /// # Errors
    /// As [`ShadePass::with_module`].
    pub unsafe fn with_module_and_set(
        context: &Context,
        options: ShadeOptions,
        module: Vec<u32>,
        host_set: vk::DescriptorSetLayout,
    ) -> Result<Self, Error> {
        check_module(&module, &SHADE)?;
        // SAFETY: the same contract.
        unsafe { Self::of_module(context, options, module, Some(host_set)) }
    }

    /// # Safety
    /// As [`ShadePass::with_module_and_set`].
    unsafe fn of_module(
        context: &Context,
        options: ShadeOptions,
        mut module: Vec<u32>,
        host_set: Option<vk::DescriptorSetLayout>,
    ) -> Result<Self, Error> {
        check_options(options)?;
        store_to(options.format, &mut module);
        read_samples(options.samples, &mut module);
        // Frames without tiles have none of their bindings
        let used = FRAME_BINDINGS + usize::from(options.light_counts);
        let bindings = if context.whole_modules { SHADE.bindings } else { &SHADE.bindings[..used] };
        // SAFETY: the same contract.
        unsafe {
            let layouts = Layouts::with(context, &SHADE, bindings, (context.descriptors.clone(), host_set))?;
            Ok(Self { pipelines: Pipelines::new(layouts, &SHADE, module), tiles: None, options })
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
        4 * vk::DeviceSize::from(self.options.shadow_rays)
            * size.map(vk::DeviceSize::from).iter().product::<u64>()
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
            STENCIL => self.options.stencil,
            LIGHT_COUNTS => self.options.light_counts,
            _ => true,
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
        unsafe { self.pipelines.layouts().write_set_without(set, &resources, &absent) }
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
    /// - `set` was written by [`ShadePass::write_set`], with images that hold the frame's pixels and buffers
    ///   that hold the lights that `frame.lights` is of; with tiles, with `frame.tile_lists`, a buffer of
    ///   [`ShadePass::tile_memory`] for that size, which no pending commands use without a barrier between.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field of `frame` that is wrong, or (in debug builds) the resource
    /// that its lights need and the set was written without; [`Error::Vulkan`] where a pipeline cannot be
    /// made. Then nothing is recorded.
    pub unsafe fn record(
        &self,
        command_buffer: vk::CommandBuffer,
        set: vk::DescriptorSet,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        // SAFETY: the same contract.
        unsafe { self.record_with(command_buffer, &Bound::Set(set), None, frame) }
    }

    /// As [`ShadePass::record`], of a pass made by [`ShadePass::with_module_and_set`]: `host_set` is bound as
    /// set 1.
    ///
    /// # Safety
    /// As [`ShadePass::record`]; `host_set` was allocated with the layout that the pass was made with, and
    /// written.
    ///
    /// # Errors
    /// As [`ShadePass::record`].
    pub unsafe fn record_with_set(
        &self,
        command_buffer: vk::CommandBuffer,
        set: vk::DescriptorSet,
        host_set: vk::DescriptorSet,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        // SAFETY: the same contract.
        unsafe { self.record_with(command_buffer, &Bound::Set(set), Some(host_set), frame) }
    }

    /// As [`ShadePass::record`], of a context [with push descriptors](Context::with_push_descriptors): the
    /// resources are pushed, and no set is needed. `host_set` is bound as set 1, where the pass was made by
    /// [`ShadePass::with_module_and_set`].
    ///
    /// # Safety
    /// As [`ShadePass::record`] and [`ShadePass::write_set`]: the resources outlive the recorded work.
    ///
    /// # Errors
    /// As [`ShadePass::record`] and [`ShadePass::write_set`].
    pub unsafe fn record_pushed(
        &self,
        command_buffer: vk::CommandBuffer,
        resources: &ShadeResources,
        host_set: Option<vk::DescriptorSet>,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        let layouts = self.pipelines.layouts();
        layouts.check_takes_resources()?;
        let (resources, absent) = self.in_order(resources)?;
        layouts.check_resources(&resources)?;
        if let Some(field) = needed(frame.lights).into_iter().find(|binding| absent.contains(binding)) {
            let message = "is missing, but the frame's lights need it".into();
            return Err(Error::InvalidArgument { field, message });
        }
        // SAFETY: the same contract.
        unsafe { self.record_with(command_buffer, &Bound::Pushed(resources), host_set, frame) }
    }

    /// # Safety
    /// As [`ShadePass::record_with_set`] or [`ShadePass::record_pushed`]; what is pushed was checked.
    unsafe fn record_with(
        &self,
        command_buffer: vk::CommandBuffer,
        bound: &Bound,
        host_set: Option<vk::DescriptorSet>,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        // Check everything before anything is recorded
        let layouts = self.pipelines.layouts();
        layouts.check_host_set(host_set)?;
        layouts.check_light_offsets(frame.light_offsets)?;
        let constants = self.constants(frame)?;
        if let Bound::Set(set) = bound {
            layouts.check_takes_sets()?;
            layouts.check_present(*set, &needed(frame.lights))?;
            layouts.check_set(*set)?;
        }

        // SAFETY: the same contract.
        let bind = || unsafe {
            match bound {
                Bound::Set(set) => {
                    let sets: Vec<_> = std::iter::once(*set).chain(host_set).collect();
                    layouts.bind_sets(command_buffer, &sets, frame.light_offsets);
                }
                Bound::Pushed(resources) => layouts.push(command_buffer, resources, host_set),
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

    /// The resources as the pass's bindings have them; the bindings of those that are missing.
    fn in_order(&self, resources: &ShadeResources) -> Result<(Vec<Resource>, Vec<&'static str>), Error> {
        let bindings = self.pipelines.layouts().bindings().len();
        resources.in_order(self.options, self.tiles.is_some(), bindings)
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

/// The resources that a frame's commands read.
enum Bound {
    Set(vk::DescriptorSet),
    Pushed(Vec<Resource>),
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
fn check_lights(lights: LightSummary) -> Result<(), Error> {
    let wrong = |message: String| Err(Error::InvalidArgument { field: "lights", message });
    let LightSummary { light_count, quad_count, shape_count, effects } = lights;
    if quad_count > light_count {
        return wrong(format!("has {quad_count} quads of {light_count} lights"));
    }
    let beyond_quads = Effects::POLYGON | Effects::TEXTURED | Effects::MESH;
    for (count, effects_of, kind) in [
        (light_count - quad_count, beyond_quads, "lights beyond quads"),
        (shape_count, Effects::SHAPES, "shapes"),
    ] {
        if count > 0 && !effects.intersects(effects_of) {
            return wrong(format!("has {count} {kind}, but none of the effects: {effects_of}"));
        }
    }
    Ok(())
}
