//! The shade pass by tiles: the lights that matter to each tile of 8 × 8 pixels, and no more code than those call for.

use crate::context::Context;
use crate::error::Error;
use crate::pass::Resource;
use crate::pipelines::Pipelines;
use crate::shade::{ResourceAccess, ShadeFrame, ShadePass, ShadeResources, accesses_of};
use arealight::gpu::{GpuTileClass, ShadeConstants, TileConstants};
use arealight::kernels::{CLASSIFY, SHADE_TILES};
use arealight::plan::{self, ShadeOptions, ShadeVariant, TileOptions};
use arealight::tiles::{self, TileClass, tile_counts};
use ash::vk;

/// What tiles need beyond [`ShadeResources`]. The host makes these buffers, and leaves them alone between frames.
#[derive(Debug, Clone, Copy)]
pub struct TileResources {
    /// [`arealight::LightTable::lobe_horizons`] of the table.
    pub lobe_horizons: Resource,
    /// [`TiledShade::memory`] bytes; the buffer has the usages `INDIRECT_BUFFER` and `TRANSFER_DST` too.
    pub tile_lists: Resource,
}

/// The shade pass by tiles: a dispatch that classifies tiles, then an indirect one for each class of them. The picture is that
/// of [`ShadePass`], but for lights that are left out, by [`TileOptions`]. Frames of few quads are shaded without
/// ([`TileOptions::least_quads`]); then no class has a tile.
///
/// As in [`ShadePass`], pipelines have what the lights of a frame call for, and are made when they are first needed.
#[derive(Debug)]
pub struct TiledShade {
    shade: ShadePass,
    classify: Pipelines,
    classes: Pipelines,
    tiles: TileOptions,
    horizon_cells: u32,
}

/// A frame, checked.
struct Checked {
    constants: TileConstants,
    variant: ShadeVariant,
    /// How many tiles there are in each direction.
    tiles: [u32; 2],
    is_classified: bool,
}

impl Checked {
    /// Groups of the classification, or of the shading of all tiles.
    fn groups(&self) -> [u32; 3] {
        let [columns, rows] = self.tiles;
        if self.is_classified {
            CLASSIFY.groups_for([columns.saturating_mul(rows), 1, 1])
        } else {
            [columns, rows, 1]
        }
    }
}

impl TiledShade {
    /// Makes what all pipelines of the pass have in common. `table_size` is how many nodes a side the table has that will be
    /// bound.
    ///
    /// # Safety
    /// As [`ShadePass::new`]: drop the pass when no recorded use of it is pending, before the device goes.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field of `tiles` that is out of range; [`Error::Vulkan`] where a call fails.
    pub unsafe fn new(
        context: &Context,
        options: ShadeOptions,
        table_size: u32,
        tiles: TileOptions,
    ) -> Result<Self, Error> {
        if tiles.capacity == 0 {
            let message = "is 0, but a tile's list holds a light at least".to_owned();
            return Err(Error::InvalidArgument { field: "capacity", message });
        }
        if !(0.0..1.0).contains(&tiles.negligible) {
            let message = format!("is {}, but a part is in [0, 1)", tiles.negligible);
            return Err(Error::InvalidArgument { field: "negligible", message });
        }
        // SAFETY: the same contract.
        unsafe {
            let shade = ShadePass::new(context, options)?;
            Ok(Self {
                shade,
                classify: Pipelines::new(context, &CLASSIFY, CLASSIFY.words())?,
                classes: Pipelines::new(context, &SHADE_TILES, SHADE_TILES.words_for(options.format))?,
                tiles,
                horizon_cells: table_size.max(2) - 1,
            })
        }
    }

    /// The same pass without tiles: it packs lights and shapes for both, and checks them.
    pub fn without_tiles(&self) -> &ShadePass {
        &self.shade
    }

    /// How tiles get their lists of lights.
    pub fn tile_options(&self) -> TileOptions {
        self.tiles
    }

    /// How large [`TileResources::tile_lists`] is for an image of `size` pixels, in bytes.
    pub fn memory(&self, size: [u32; 2]) -> u64 {
        tiles::memory(size, self.tiles.capacity)
    }

    /// The layouts that the host allocates the two descriptor sets of a run with: the classification's, and the shading's.
    pub fn set_layouts(&self) -> [vk::DescriptorSetLayout; 2] {
        [self.classify.layouts().set_layout(), self.classes.layouts().set_layout()]
    }

    /// What the sets of `runs` take from the host's descriptor pool.
    pub fn pool_sizes(&self, runs: u32) -> Vec<vk::DescriptorPoolSize> {
        [&self.classify, &self.classes].into_iter().flat_map(|pass| pass.layouts().pool_sizes(runs)).collect()
    }

    /// How the pass uses each of the host's resources. The tile lists are written and read within, with barriers of its own,
    /// from `TRANSFER` to `DRAW_INDIRECT` and `COMPUTE_SHADER`: before its next run the host waits for those stages, as
    /// for any buffer that is written again.
    pub fn accesses(&self) -> Vec<ResourceAccess> {
        let mut accesses = accesses_of(&SHADE_TILES);
        accesses.retain(|access| access.name != "tile_lists");
        accesses.extend(accesses_of(&CLASSIFY).into_iter().filter(|access| access.name == "lobe_horizons"));
        accesses
    }

    /// Points descriptor sets, one of each layout, at the resources of a run.
    ///
    /// # Safety
    /// As [`ShadePass::write_set`]: the sets are not in use, and the resources outlive the recorded work.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the resource that is missing, null or of the wrong kind.
    pub unsafe fn write_sets(
        &self,
        sets: [vk::DescriptorSet; 2],
        resources: &ShadeResources,
        tiles: &TileResources,
    ) -> Result<(), Error> {
        let classify = [
            tiles.lobe_horizons,
            resources.lights,
            resources.shapes,
            resources.position,
            resources.normal,
            resources.base_color,
            resources.specular,
            tiles.tile_lists,
        ];
        let shade: Vec<Resource> =
            self.shade.in_order(resources)?.into_iter().chain([tiles.tile_lists]).collect();
        // SAFETY: the same contract.
        unsafe {
            self.classify.layouts().write_set(sets[0], &classify)?;
            self.classes.layouts().write_set(sets[1], &shade)
        }
    }

    /// As [`ShadePass::prepare`], of the pipelines of every class that the frame may have.
    ///
    /// # Errors
    /// As [`ShadePass::prepare`].
    pub fn prepare(&self, frame: &ShadeFrame) -> Result<(), Error> {
        self.prepare_checked(&self.checked(frame)?)
    }

    fn prepare_checked(&self, &Checked { variant, is_classified, .. }: &Checked) -> Result<(), Error> {
        if !is_classified {
            return self.classes.with(self.all_tiles_constants(variant), |_| ());
        }
        self.classify.with(self.classify_constants(variant), |_| ())?;
        for class in self.called_for(variant) {
            self.classes
                .with(plan::shade_tiles_specialization(self.shade.options(), variant, class), |_| ())?;
        }
        Ok(())
    }

    /// Records the pass, with the barriers between its dispatches. The host's barriers make its resources visible before, by
    /// [`TiledShade::accesses`].
    ///
    /// # Safety
    /// - `command_buffer` is recording, outside a render pass, on a queue with compute.
    /// - `sets` were written by [`TiledShade::write_sets`] with `tiles`, with images of `frame.size`, buffers that hold
    ///   `frame.light_count` lights and `frame.shape_count` shapes, and one of [`TiledShade::memory`] for that size.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] names the field of `frame` or of `tiles` that is wrong, [`Error::Vulkan`] where a
    /// pipeline cannot be made; then nothing is recorded.
    pub unsafe fn record(
        &self,
        command_buffer: vk::CommandBuffer,
        sets: [vk::DescriptorSet; 2],
        tiles: &TileResources,
        frame: &ShadeFrame,
    ) -> Result<(), Error> {
        // Check everything, and make what is missing, before anything is recorded
        let checked = self.checked(frame)?;
        let Resource::StorageBuffer { buffer, offset, .. } = tiles.tile_lists else {
            let message = "is no buffer".to_owned();
            return Err(Error::InvalidArgument { field: "tile_lists", message });
        };
        let (bytes, groups) = (bytemuck::bytes_of(&checked.constants), checked.groups());
        self.classify.layouts().check(sets[0], bytes, groups)?;
        self.classes.layouts().check(sets[1], bytes, groups)?;
        self.prepare_checked(&checked)?;

        let names = &self.classify.layouts().context().names;
        // SAFETY: the same contract.
        let _label = unsafe { names.label(command_buffer, c"arealight tiles") };
        // SAFETY: the same contract; the buffer holds a record a class, whose indirect dispatch the classify kernel writes.
        unsafe {
            self.record_reset(command_buffer, buffer, offset);
            if !checked.is_classified {
                return self.classes.with(self.all_tiles_constants(checked.variant), |pass| {
                    pass.record_checked(command_buffer, sets[1], bytes, groups);
                });
            }
            self.classify.with(self.classify_constants(checked.variant), |pass| {
                pass.record_checked(command_buffer, sets[0], bytes, groups);
            })?;
            self.record_barrier(
                command_buffer,
                (vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_WRITE),
                (
                    vk::PipelineStageFlags::COMPUTE_SHADER | vk::PipelineStageFlags::DRAW_INDIRECT,
                    vk::AccessFlags::SHADER_READ | vk::AccessFlags::INDIRECT_COMMAND_READ,
                ),
            );
            for class in self.called_for(checked.variant) {
                let place = offset + class as u64 * size_of::<GpuTileClass>() as u64;
                let specialization =
                    plan::shade_tiles_specialization(self.shade.options(), checked.variant, class);
                self.classes.with(specialization, |pass| {
                    pass.record_indirect(command_buffer, sets[1], bytes, (buffer, place));
                })?;
            }
        }
        Ok(())
    }

    /// What [`TiledShade::record`] refuses, and what it records.
    fn checked(&self, frame: &ShadeFrame) -> Result<Checked, Error> {
        let (constants, variant) = self.shade.checked(frame)?;
        let is_classified = self.tiles.classifies(&constants);
        let ShadeConstants { position_from_clip, camera, light_count, shape_count, quad_count } = constants;
        // Where the pass has nothing beyond quads, all lights are
        let quad_count = if variant.effects.intersects(arealight::Effects::BEYOND_QUADS) {
            quad_count
        } else {
            light_count
        };
        let constants = TileConstants {
            position_from_clip,
            camera,
            light_count,
            size: frame.size,
            capacity: self.tiles.capacity,
            horizon_cells: self.horizon_cells,
            shape_count,
            quad_count,
            negligible: self.tiles.negligible,
        };
        Ok(Checked { constants, variant, tiles: tile_counts(frame.size), is_classified })
    }

    fn all_tiles_constants(&self, variant: ShadeVariant) -> Vec<(u32, u32)> {
        plan::shade_all_tiles_specialization(self.shade.options(), variant)
    }

    fn classify_constants(&self, variant: ShadeVariant) -> Vec<(u32, u32)> {
        plan::classify_specialization(self.shade.options(), variant, self.tiles)
    }

    /// The classes that something is to be done for.
    fn called_for(&self, variant: ShadeVariant) -> impl Iterator<Item = TileClass> {
        let output = self.shade.options().output;
        TileClass::ALL.into_iter().filter(move |class| class.is_called_for(variant.effects, output))
    }

    /// Begins every class without a tile.
    unsafe fn record_reset(
        &self,
        command_buffer: vk::CommandBuffer,
        buffer: vk::Buffer,
        offset: vk::DeviceSize,
    ) {
        let none = [GpuTileClass { z: 1, ..GpuTileClass::default() }; TileClass::ALL.len()];
        // SAFETY: the caller's contract: the buffer holds as much, and nothing else uses it now.
        unsafe {
            let device = self.classify.layouts().context().device();
            device.cmd_update_buffer(command_buffer, buffer, offset, bytemuck::cast_slice(&none));
            self.record_barrier(
                command_buffer,
                (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE),
                (
                    vk::PipelineStageFlags::COMPUTE_SHADER,
                    vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE,
                ),
            );
        }
    }

    /// A barrier for what the dispatches hand on to each other.
    unsafe fn record_barrier(
        &self,
        command_buffer: vk::CommandBuffer,
        (before, written): (vk::PipelineStageFlags, vk::AccessFlags),
        (after, used): (vk::PipelineStageFlags, vk::AccessFlags),
    ) {
        let barrier = [vk::MemoryBarrier::default().src_access_mask(written).dst_access_mask(used)];
        let flags = vk::DependencyFlags::empty();
        // SAFETY: the caller's contract.
        unsafe {
            let device = self.classify.layouts().context().device();
            device.cmd_pipeline_barrier(command_buffer, before, after, flags, &barrier, &[], &[]);
        }
    }
}
