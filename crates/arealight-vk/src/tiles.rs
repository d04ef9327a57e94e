//! Tiles of the shade pass: how they are classified, and how the classes are shaded.

use crate::context::{COPIED, USED, WRITTEN};
use crate::error::Error;
use crate::frame::ShadeFrame;
use crate::layouts::Layouts;
use crate::pipelines::Pipelines;
use crate::resource::Resource;
use arealight::LightSummary;
use arealight::gpu::ShadeConstants;
use arealight::kernels::CLASSIFY;
use arealight::plan::{self, ShadeOptions, TileOptions};
use arealight::tiles::{self, TileClass, tile_counts};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The buffer of tile lists: [`crate::ShadeResources::tile_lists`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TileMemory {
    /// Its size in bytes.
    pub size: vk::DeviceSize,
    /// The usages that it needs: the dispatches of the classes are in it.
    pub usage: vk::BufferUsageFlags,
}

/// How tiles are classified. They are shaded by pipelines of the shade pass, one for each class.
#[derive(Debug)]
pub(crate) struct Tiles {
    classify: Pipelines,
    options: TileOptions,
    horizon_cells: u32,
}

/// A frame, checked.
pub(crate) struct TiledFrame {
    constants: ShadeConstants,
    lights: LightSummary,
    /// The rows of tiles that are classified and shaded.
    rows: Range<u32>,
    /// The buffer of the tile lists, and where in it they begin.
    lists: (vk::Buffer, vk::DeviceSize),
}

impl Tiles {
    /// # Safety
    /// As [`Pipelines::new`], of a module of the kernel; the layouts have every binding of the shade kernel.
    pub(crate) unsafe fn new(
        layouts: &Arc<Layouts>,
        module: Vec<u32>,
        tiles: TileOptions,
        table_size: u32,
    ) -> Result<Self, Error> {
        let wrong = |field, message: String| Err(Error::InvalidArgument { field, message });
        if tiles.capacity == 0 {
            return wrong("capacity", "is 0, but a tile's list holds at least one light".to_owned());
        }
        if !(0.0..1.0).contains(&tiles.cull_threshold) {
            let message = format!("is {}, but a fraction of what stays is in [0, 1)", tiles.cull_threshold);
            return wrong("cull_threshold", message);
        }
        if table_size < 2 {
            return wrong("table_size", format!("is {table_size}, but a table has at least 2 nodes a side"));
        }
        // SAFETY: the same contract; the kernel has the shade kernel's bindings.
        let classify = unsafe { Pipelines::new(Arc::clone(layouts), &CLASSIFY, module) };
        Ok(Self { classify, options: tiles, horizon_cells: table_size - 1 })
    }

    pub(crate) fn options(&self) -> TileOptions {
        self.options
    }

    pub(crate) fn memory(&self, size: [u32; 2]) -> TileMemory {
        TileMemory {
            size: tiles::memory(size, self.options.capacity),
            usage: vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::INDIRECT_BUFFER
                | vk::BufferUsageFlags::TRANSFER_DST,
        }
    }

    /// A frame with tiles; none where it has too few lights to be classified.
    pub(crate) fn checked(
        &self,
        frame: &ShadeFrame,
        constants: ShadeConstants,
        rows: Range<u32>,
    ) -> Result<Option<TiledFrame>, Error> {
        let wrong = |message: &str| Error::InvalidArgument { field: "tile_lists", message: message.into() };
        let lists = match frame.tile_lists {
            None => return Err(wrong("is missing, but the pass was made with tiles")),
            Some(Resource::StorageBuffer { buffer, offset, .. }) if buffer != vk::Buffer::null() => {
                (buffer, offset)
            }
            Some(_) => return Err(wrong("is no buffer")),
        };
        if !self.options.classifies(frame.lights) {
            return Ok(None);
        }
        let limits = self.classify.layouts().context().limits;
        limits.check_range(self.memory(frame.size).size, "the buffer of tile lists")?;
        let constants = ShadeConstants {
            capacity: self.options.capacity,
            horizon_cells: self.horizon_cells,
            cull_threshold: self.options.cull_threshold,
            ..constants
        };
        Ok(Some(TiledFrame { constants, lights: frame.lights, rows, lists }))
    }

    /// Makes the pipelines of a frame that are not made yet; those that shade among `shade`.
    pub(crate) fn prepare(
        &self,
        shade: &Pipelines,
        options: ShadeOptions,
        frame: &TiledFrame,
    ) -> Result<(), Error> {
        self.classify.with(self.classify_constants(options, frame), |_| ())?;
        for class in dispatched(options, frame) {
            shade.with(plan::shade_tiles_specialization(options, frame.lights, class), |_| ())?;
        }
        Ok(())
    }

    fn classify_constants(&self, options: ShadeOptions, frame: &TiledFrame) -> Vec<(u32, u32)> {
        plan::classify_specialization(options, frame.lights, self.options)
    }

    /// Records a dispatch that classifies tiles, and an indirect one for each class of them, with the
    /// barriers between. `bind` binds what they read.
    ///
    /// # Safety
    /// As [`crate::ShadePass::record`].
    pub(crate) unsafe fn record(
        &self,
        command_buffer: vk::CommandBuffer,
        bind: impl FnOnce(),
        shade: &Pipelines,
        options: ShadeOptions,
        frame: &TiledFrame,
    ) -> Result<(), Error> {
        // Check everything, and make what is missing, before anything is recorded
        let [columns, rows] = tile_counts(frame.constants.size);
        let (bytes, groups) = (bytemuck::bytes_of(&frame.constants), [columns, rows, 1]);
        self.classify.check(bytes, groups)?;
        self.prepare(shade, options, frame)?;

        let (buffer, offset) = frame.lists;
        let context = self.classify.layouts().context();
        // SAFETY: the same contract; the buffer holds a record per class, whose indirect dispatch the
        // classify kernel writes.
        unsafe {
            self.record_no_tiles(command_buffer, frame);
            bind();
            context.record_barrier(command_buffer, COPIED, USED);
            self.classify.with(self.classify_constants(options, frame), |pass| {
                pass.record_rows(command_buffer, bytes, (groups, frame.rows.clone()));
            })?;
            context.record_barrier(command_buffer, WRITTEN, READ_INDIRECTLY);
            for class in dispatched(options, frame) {
                let place = offset + class as u64 * 4 * tiles::CLASS_WORDS as u64;
                let specialization = plan::shade_tiles_specialization(options, frame.lights, class);
                shade.with(specialization, |pass| {
                    pass.record_indirect(command_buffer, bytes, (buffer, place));
                })?;
            }
        }
        Ok(())
    }

    /// Begins every class without a tile, when the frame or part before has read its own.
    ///
    /// # Safety
    /// As [`Tiles::record`]: the buffer holds as much.
    unsafe fn record_no_tiles(&self, command_buffer: vk::CommandBuffer, frame: &TiledFrame) {
        let none = [tiles::NO_TILES; TileClass::ALL.len()];
        let (buffer, offset) = frame.lists;
        let context = self.classify.layouts().context();
        // SAFETY: the same contract.
        unsafe {
            context.record_barrier(command_buffer, READ_INDIRECTLY, COPIED);
            let none = bytemuck::cast_slice(&none);
            context.device().cmd_update_buffer(command_buffer, buffer, offset, none);
        }
    }
}

/// How the lists of a frame are read: by what shades, and by its indirect dispatches.
const READ_INDIRECTLY: (vk::PipelineStageFlags, vk::AccessFlags) = (
    vk::PipelineStageFlags::from_raw(
        vk::PipelineStageFlags::COMPUTE_SHADER.as_raw() | vk::PipelineStageFlags::DRAW_INDIRECT.as_raw(),
    ),
    vk::AccessFlags::from_raw(
        vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::INDIRECT_COMMAND_READ.as_raw(),
    ),
);

/// The classes whose tiles have pixels to write.
fn dispatched(options: ShadeOptions, frame: &TiledFrame) -> impl Iterator<Item = TileClass> {
    let lights = frame.lights;
    TileClass::ALL.into_iter().filter(move |class| class.is_dispatched(lights, options.output))
}
