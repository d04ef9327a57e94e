//! Shading by tiles, on the engine's own memory.

use super::SceneRenderer;
use crate::kept::Kept;
use crate::{Engine, EngineError};
use arealight::gpu::GpuTileClass;
use arealight::plan::{ShadeOptions, TileOptions};
use arealight::{TileClass, tiles};
use arealight_host::{Buffer, DescriptorPool, Location, Usage};
use arealight_vk::{Resource, ShadeFrame, TileResources, TiledShade};
use ash::vk;
use std::time::Duration;

/// The pipelines, buffers and descriptor sets of shading a view by tiles, for any number of runs.
pub struct TiledView {
    // Goes before the pool that its sets are of
    pass: Kept<TiledShade>,
    sets: [vk::DescriptorSet; 2],
    lobe_horizons: Buffer,
    tile_lists: Buffer,
    _pool: DescriptorPool,
    size: [u32; 2],
}

/// What was found of a view's tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TileCounts {
    /// How many tiles each class had.
    pub classes: Vec<(TileClass, u32)>,
    /// How many lights the tiles' lists held together; a tile that was shaded by all of the frame's counts those.
    pub lights: u64,
}

impl TileCounts {
    /// Whether tiles were classified: [`TileOptions::least_quads`] says which frames' are.
    pub fn is_classified(&self) -> bool {
        self.classes.iter().any(|(_, count)| *count > 0)
    }

    /// How many lights a tile had in the mean.
    pub fn lights_a_tile(&self) -> f64 {
        let tiles: u32 = self.classes.iter().map(|(_, count)| count).sum();
        self.lights as f64 / f64::from(tiles.max(1))
    }
}

impl TiledView {
    fn resources(&self) -> TileResources {
        let buffer = |buffer: &Buffer| Resource::buffer(buffer.handle());
        TileResources { lobe_horizons: buffer(&self.lobe_horizons), tile_lists: buffer(&self.tile_lists) }
    }

    /// What the last run found, of a frame of so many lights.
    ///
    /// # Errors
    /// [`EngineError`] where the device fails.
    pub fn counts(&self, light_count: usize) -> Result<TileCounts, EngineError> {
        let words: Vec<u32> = self.tile_lists.download()?;
        let found: &[GpuTileClass] = bytemuck::cast_slice(&words[..tiles::FIRST_LIST as usize]);
        let classes = TileClass::ALL.into_iter().zip(found.iter().map(|found| found.tile_count)).collect();
        let [columns, rows] = tiles::tile_counts(self.size);
        let tile_count = (columns * rows) as usize;
        let record = (tiles::RECORD_HEADER + self.pass.tile_options().capacity) as usize;
        let first_record = tiles::FIRST_LIST as usize + TileClass::ALL.len() * tile_count;
        let mut lights = 0;
        for (place, found) in found.iter().enumerate().skip(TileClass::Quads as usize) {
            let list = &words[tiles::FIRST_LIST as usize + place * tile_count..][..found.tile_count as usize];
            for &tile in list {
                let [column, row] = tiles::unpack(tile);
                let total = words[first_record + (row * columns + column) as usize * record + 1];
                lights += if total == u32::MAX { light_count as u64 } else { total.into() };
            }
        }
        Ok(TileCounts { classes, lights })
    }
}

impl SceneRenderer<'_> {
    /// Makes what shading this view by tiles needs.
    ///
    /// # Errors
    /// [`EngineError`] names a light that calls for more than the options' effects, or says why the device fails.
    pub fn tiled(&self, options: ShadeOptions, tiles: TileOptions) -> Result<TiledView, EngineError> {
        let engine = self.engine;
        let host = engine.host();
        // SAFETY: As in Engine::pass.
        let pass = unsafe { TiledShade::new(engine.context(), options, engine.table_size(), tiles) }?;
        let pass = Kept::new(host, pass);
        pass.without_tiles().check_lights(self.lights)?;
        pass.without_tiles().check_shapes(self.shapes)?;
        let lobe_horizons = engine.storage("lobe horizons", engine.lobe_horizons())?;
        let tile_lists = engine.tile_lists(pass.memory(self.size))?;
        let pool = host.descriptor_pool(2, &pass.pool_sizes(1))?;
        let [classify, shade] = pass.set_layouts();
        // SAFETY: The layouts are the pass's, and alive.
        let sets = unsafe { [pool.allocate(classify)?, pool.allocate(shade)?] };
        let view = TiledView { pass, sets, lobe_horizons, tile_lists, _pool: pool, size: self.size };
        // SAFETY: The sets are new, and the resources live until submissions were waited for.
        unsafe { view.pass.write_sets(view.sets, &self.shade_resources(), &view.resources()) }?;
        view.pass.prepare(&self.shade_frame())?;
        Ok(view)
    }

    /// As [`SceneRenderer::shade`], by tiles.
    ///
    /// # Errors
    /// [`EngineError`] where the device fails.
    pub fn shade_tiled(&mut self, view: &TiledView) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let frame: ShadeFrame = self.shade_frame();
        self.engine.host().try_submit_timed(|commands| {
            self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
            // SAFETY: The commands are being recorded outside a render pass; the sets were written with images of
            // the frame's size, and submissions are waited for.
            unsafe { view.pass.record(commands, view.sets, &view.resources(), &frame) }?;
            Ok(())
        })
    }
}

impl Engine {
    /// A buffer with the device for the lists of tiles.
    fn tile_lists(&self, bytes: u64) -> Result<Buffer, EngineError> {
        let name = "tile lists";
        self.check_storage(name, bytes)?;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::INDIRECT_BUFFER;
        Ok(self.host().buffer(name, bytes, usage, Location::Device)?)
    }
}
