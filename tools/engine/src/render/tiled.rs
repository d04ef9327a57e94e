//! Shading by tiles, on the engine's own memory.

use super::SceneRenderer;
use crate::host::{Buffer, DescriptorPool, Location, Usage};
use crate::kept::Kept;
use crate::{Engine, EngineError};
use arealight::plan::{ShadeOptions, TileOptions};
use arealight::{Effects, TileClass, tiles};
use arealight_vk::{Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources, TileMemory};
use ash::vk;
use std::cell::RefCell;
use std::ops::Add;
use std::time::Duration;

/// The pipelines, buffers and descriptor set of shading a view by tiles, for any number of runs.
pub struct TiledView {
    // Goes before the pool that its set is of
    pass: Kept<ShadePass>,
    set: vk::DescriptorSet,
    lobe_horizons: Buffer,
    tile_lists: Buffer,
    _pool: DescriptorPool,
    tiles: TileOptions,
    surfaces: Effects,
    size: [u32; 2],
    /// The tiles of each class that the parts of the last run found, but for the last part.
    found_before: RefCell<[Vec<u32>; TileClass::ALL.len()]>,
}

/// What was found of a view's tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TileCounts {
    /// How many tiles each class had; none where the frame was shaded without tiles
    /// ([`TileOptions::least_quads`]).
    pub classes: Vec<(TileClass, u32)>,
    /// How many lights of all kinds the tiles' lists held in all; a tile that was shaded by all of the
    /// frame's counts those.
    pub lights: u64,
}

impl Add for TileCounts {
    type Output = Self;

    /// Those of two parts of a picture.
    fn add(self, other: Self) -> Self {
        let classes = self.classes.into_iter().zip(other.classes);
        let classes = classes.map(|((class, count), (_, more))| (class, count + more)).collect();
        Self { classes, lights: self.lights + other.lights }
    }
}

impl TileCounts {
    /// Whether tiles were classified: [`TileOptions::least_quads`] decides which frames' are.
    pub fn is_classified(&self) -> bool {
        self.classes.iter().any(|(_, count)| *count > 0)
    }

    /// The mean number of lights per tile.
    pub fn lights_per_tile(&self) -> f64 {
        let tiles: u32 = self.classes.iter().map(|(_, count)| count).sum();
        self.lights as f64 / f64::from(tiles.max(1))
    }
}

/// The lists of tiles, as the classification wrote them.
pub struct TileLists {
    words: Vec<u32>,
    /// The tiles of each class.
    classes: [Vec<u32>; TileClass::ALL.len()],
    capacity: u32,
    size: [u32; 2],
}

impl TileLists {
    fn tile_count(&self) -> usize {
        tiles::tile_counts(self.size).map(|count| count as usize).iter().product()
    }

    /// Adds the tiles that the classification put in the lists of classes.
    fn add_classified(&mut self) {
        let tile_count = self.tile_count();
        for (class, tiles_of) in self.classes.iter_mut().enumerate() {
            let count = self.words[(class + 1) * tiles::CLASS_WORDS - 1] as usize;
            let first = tiles::FIRST_LIST as usize + class * tile_count;
            tiles_of.extend(&self.words[first..][..count]);
        }
    }

    /// How many tiles each class has.
    pub fn classes(&self) -> Vec<(TileClass, u32)> {
        TileClass::ALL.into_iter().zip(self.classes.iter().map(|tiles_of| tiles_of.len() as u32)).collect()
    }

    /// The column and row of each tile of a class.
    pub fn tiles_of(&self, class: TileClass) -> impl Iterator<Item = [u32; 2]> {
        self.classes[class as usize].iter().map(|tile| tiles::unpack(*tile))
    }

    /// The indices of a tile's polygons, and of its shapes; none where it is shaded by all lights.
    pub fn lights(&self, [column, row]: [u32; 2]) -> Option<[&[u32]; 2]> {
        let [columns, _] = tiles::tile_counts(self.size);
        let first = tiles::FIRST_LIST as usize + TileClass::ALL.len() * self.tile_count();
        let length = (tiles::RECORD_HEADER + self.capacity) as usize;
        let record = &self.words[first + (row * columns + column) as usize * length..][..length];
        let (counts, lights) = record.split_at(tiles::RECORD_HEADER as usize);
        if counts[0] == tiles::ALL_LIGHTS {
            return None;
        }
        let (polygons, shapes) = lights.split_at(counts[1] as usize);
        Some([polygons, &shapes[..counts[2] as usize]])
    }
}

impl TiledView {
    /// The lists that the last run wrote.
    pub fn lists(&self) -> Result<TileLists, EngineError> {
        let classes = self.found_before.borrow().clone();
        let words = self.tile_lists.download()?;
        let mut lists = TileLists { words, classes, capacity: self.tiles.capacity, size: self.size };
        lists.add_classified();
        Ok(lists)
    }

    /// Bytes of the lists.
    pub fn memory(&self) -> u64 {
        self.pass.tile_memory(self.size).map_or(0, |memory| memory.size)
    }

    /// What the last run found, of a frame of so many lights of all kinds.
    pub fn counts(&self, light_count: usize) -> Result<TileCounts, EngineError> {
        let lists = self.lists()?;
        let listed = [TileClass::Quads, TileClass::Any].into_iter().flat_map(|class| lists.tiles_of(class));
        let lights = listed.map(|tile| match lists.lights(tile) {
            Some([polygons, shapes]) => (polygons.len() + shapes.len()) as u64,
            None => light_count as u64,
        });
        Ok(TileCounts { lights: lights.sum(), classes: lists.classes() })
    }
}

impl SceneRenderer<'_> {
    /// Makes what shading this view by tiles needs.
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails.
    pub fn tiled(&self, options: ShadeOptions, tiles: TileOptions) -> Result<TiledView, EngineError> {
        let engine = self.engine;
        let host = engine.host();
        let table_size = engine.table_size();
        let info = ShadePassInfo { tiles: Some(tiles), table_size, ..self.seen(options).into() };
        // SAFETY: As in Engine::pass.
        let pass = unsafe { ShadePass::new(engine.context(), info) }?;
        let pass = Kept::new(host, pass);
        let lobe_horizons =
            engine.storage("lobe horizons", engine.lobe_horizons(options.quality.specular_lobes))?;
        let tile_lists = engine.tile_lists(pass.tile_memory(self.size).expect("the pass has tiles"))?;
        let pool = host.descriptor_pool(1, &pass.pool_sizes(1))?;
        // SAFETY: The layout is the pass's, and alive.
        let set = unsafe { pool.allocate(pass.set_layout()) }?;
        let (size, found_before) = (self.size, RefCell::default());
        let surfaces = options.surfaces;
        let view = TiledView {
            pass,
            set,
            lobe_horizons,
            tile_lists,
            _pool: pool,
            tiles,
            surfaces,
            size,
            found_before,
        };
        let (resources, frame) = self.tiled_run(&view);
        // SAFETY: The set is new, and the resources live until submissions were waited for.
        unsafe { view.pass.write_set(view.set, &resources) }?;
        view.pass.prepare(&frame)?;
        Ok(view)
    }

    /// As [`SceneRenderer::shade`], by tiles.
    pub fn shade_tiled(&mut self, view: &TiledView) -> Result<Option<Duration>, EngineError> {
        self.ensure_visible()?;
        let (_, frame) = self.tiled_run(view);
        view.found_before.take();
        // A tile shades at most the lights of its list, but for those that have more
        let lights = u64::from(frame.lights.light_count + frame.lights.shape_count).max(1);
        let most = self.most_pairs.saturating_mul(lights) / lights.min(view.tiles.capacity.max(1).into());
        let mut total = Some(Duration::ZERO);
        for (index, part) in frame.parts(most).enumerate() {
            // Each part's classes take the place of those before
            if index > 0 {
                view.found_before.replace(view.lists()?.classes);
            }
            let took = self.engine.host().try_submit_timed(|commands| {
                self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
                // SAFETY: The commands are being recorded outside a render pass; the set was written with
                // images of the frame's size, and submissions are waited for.
                unsafe { view.pass.record(commands, view.set, &part) }?;
                Ok::<_, EngineError>(())
            })?;
            total = total.zip(took).map(|(total, took)| total + took);
        }
        Ok(total)
    }

    /// What the pass of a view takes for a run.
    pub fn tiled_run(&self, view: &TiledView) -> (ShadeResources, ShadeFrame) {
        let buffer = |buffer: &Buffer| Some(Resource::buffer(buffer.handle()));
        let (lobe_horizons, tile_lists) = (buffer(&view.lobe_horizons), buffer(&view.tile_lists));
        let resources = ShadeResources { lobe_horizons, tile_lists, ..self.shade_resources(view.surfaces) };
        (resources, ShadeFrame { tile_lists, ..self.shade_frame() })
    }
}

impl Engine {
    /// A buffer with the device for the lists of tiles, without a tile at first.
    fn tile_lists(&self, memory: TileMemory) -> Result<Buffer, EngineError> {
        let name = "tile lists";
        self.check_storage(name, memory.size)?;
        let buffer = self.host().buffer(name, memory.size, memory.usage, Location::Device)?;
        self.host().submit(|commands| {
            let (device, raw) = (self.host().device(), buffer.handle());
            // SAFETY: The buffer is new, and the submission is waited for.
            unsafe { device.cmd_fill_buffer(commands, raw, 0, vk::WHOLE_SIZE, 0) };
        })?;
        Ok(buffer)
    }
}
