//! The small engine that the tools, tests and benchmarks embed Arealight in: the first host of
//! [`arealight_vk`], and an example of one.
//!
//! [`host`] finds Vulkan and owns a device, memory and submission. [`Engine`] holds a device and the light
//! table on it. [`Engine::eval`] shades a list of points; [`SceneRenderer`] finds what a camera sees and
//! shades it, by the fitted lobes or by Monte Carlo.

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say

mod eval;
mod eval_medium;
mod eval_shapes;
mod g_buffer;

mod kept;

mod passes;
mod render;
mod scene_textures;
mod table;
mod texture_array;
mod textures;

pub use arealight_host as host;
pub use arealight_host::{Host, HostError, HostOptions, Validation};
pub use eval::{EvalPoint, gpu_case};
pub use eval_medium::MediumPoint;
pub use g_buffer::{GBuffer, texel_of};
pub use kept::Kept;
pub use passes::{BoundSet, ListPass, Passes, SharedPass};
pub use render::cells::Cells;
pub use render::fog::{Fog, FogView};
pub use render::shadowed::{BlockerBuffers, ShadowedView};
pub use render::tiled::{TileCounts, TileLists, TiledView};
pub use render::{Reference, SceneRenderer};
pub use texture_array::{TextureArray, TextureSource};
pub use textures::{Of, SourceImage, SourceTexels};

use crate::host::Buffer;
use arealight::kernels::Kernel;
use arealight::plan::ShadeOptions;
use arealight::table::LobeHorizon;
use arealight::{LightTable, SpecularLobes};
use arealight_vk::{Context, Resource, ShadePass, TableFormat};
use ash::vk;
use bytemuck::Pod;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::rc::Rc;
pub use table::UploadedTable;

/// A failure of the engine.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The device, its memory or a submission.
    #[error(transparent)]
    Host(#[from] HostError),
    /// The recorder.
    #[error(transparent)]
    Recorder(#[from] arealight_vk::Error),
    /// The scene does not fit the device's buffers.
    #[error(transparent)]
    Scene(#[from] arealight_scene::BufferError),
    /// A buffer is larger than the device binds.
    #[error("{name}: {bytes} bytes, but the device binds at most {limit} to a shader: use a smaller scene")]
    BufferTooLarge {
        /// What the buffer holds.
        name: &'static str,
        /// Its size.
        bytes: u64,
        /// The device's `maxStorageBufferRange`.
        limit: u64,
    },
    /// A level of the lights' textures is not there.
    #[error(
        "level {level} of texture layer {layer} is not there: there are {layers} layers of {levels} levels"
    )]
    NoTextureLevel {
        /// The layer that was asked for.
        layer: u32,
        /// The level that was asked for.
        level: u32,
        /// How many layers there are.
        layers: u32,
        /// How many levels each has.
        levels: u32,
    },
    /// An image has not as many texels as its size says.
    #[error("image of texture layer {layer}: {given} texels given for {width} x {height}")]
    SourceTexels {
        /// The layer that it was meant for.
        layer: u32,
        /// How many there are.
        given: usize,
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
    },
}

impl From<arealight::LightError> for EngineError {
    fn from(error: arealight::LightError) -> Self {
        Self::Recorder(error.into())
    }
}

/// A device with a light table, and the lights' textures.
pub struct Engine {
    // Dropped in this order: what is on the device goes before the device
    table: UploadedTable,
    light_table: LightTable,
    lobe_horizons: [OnceCell<Vec<LobeHorizon>>; 3],
    textures: Option<TextureArray>,
    shade_passes: RefCell<HashMap<ShadeOptions, Rc<Kept<ShadePass>>>>,
    passes: Passes,
}

impl Engine {
    /// Uploads `table` to the device of `host`.
    pub fn new(host: Host, table: &LightTable, format: TableFormat) -> Result<Self, EngineError> {
        let passes = Passes::new(host)?;
        let light_table = table.clone();
        let table = UploadedTable::new(passes.host(), passes.context(), table, format)?;
        let (lobe_horizons, shade_passes) = (Default::default(), RefCell::default());
        Ok(Self { table, light_table, lobe_horizons, textures: None, shade_passes, passes })
    }

    /// With modules handed to the driver as they are: [`Context::with_whole_modules`]. Before anything is
    /// shaded.
    #[must_use = "the engine is returned"]
    pub fn with_whole_modules(mut self) -> Self {
        self.passes = self.passes.with_whole_modules();
        self
    }

    /// The device.
    pub fn host(&self) -> &Host {
        self.passes.host()
    }

    /// The pipelines made so far, to make others.
    pub fn passes(&self) -> &Passes {
        &self.passes
    }

    /// The recorder's context, to make passes from.
    pub fn context(&self) -> &Context {
        self.passes.context()
    }

    /// The shade pass of these options; made once, and kept.
    pub fn shade_pass(&self, options: ShadeOptions) -> Result<Rc<Kept<ShadePass>>, EngineError> {
        let mut made = self.shade_passes.borrow_mut();
        match made.entry(options) {
            Entry::Occupied(found) => Ok(Rc::clone(found.get())),
            Entry::Vacant(place) => {
                // SAFETY: As in Passes::pass.
                let pass = unsafe { ShadePass::new(self.context(), options) }?;
                Ok(Rc::clone(place.insert(Rc::new(Kept::new(self.host(), pass)))))
            }
        }
    }

    /// The table's [`LightTable::lobe_horizons`].
    pub fn lobe_horizons(&self, lobes: SpecularLobes) -> &[LobeHorizon] {
        self.lobe_horizons[lobes as usize].get_or_init(|| self.light_table.lobe_horizons(lobes))
    }

    /// Nodes a side of the table.
    pub fn table_size(&self) -> u32 {
        self.light_table.size()
    }

    /// The light table, as a pass takes it.
    pub fn table(&self) -> Resource {
        self.table.resource()
    }

    /// Uploads another table, to be bound in place of the engine's.
    pub fn upload_table(
        &self,
        table: &LightTable,
        format: TableFormat,
    ) -> Result<UploadedTable, EngineError> {
        UploadedTable::new(self.host(), self.context(), table, format)
    }

    /// A storage buffer with the device that holds `items`; never empty, since a descriptor wants one.
    pub fn storage<T: Pod>(&self, name: &'static str, items: &[T]) -> Result<Buffer, EngineError> {
        self.check_storage(name, size_of_val(items) as u64)?;
        if items.is_empty() {
            return Ok(self.host().storage_buffer(name, &[T::zeroed()])?);
        }
        Ok(self.host().storage_buffer(name, items)?)
    }

    /// Refuses a storage buffer of so many bytes where the device has none as large.
    fn check_storage(&self, name: &'static str, bytes: u64) -> Result<(), EngineError> {
        let limit = self.host().properties().limits.max_storage_buffer_range.into();
        if bytes > limit {
            return Err(EngineError::BufferTooLarge { name, bytes, limit });
        }
        Ok(())
    }

    /// A pass of `kernel` with a descriptor set that points at `resources`.
    fn pass(
        &self,
        kernel: &'static Kernel,
        specialization: &[(u32, u32)],
        resources: &[Resource],
    ) -> Result<BoundPass, EngineError> {
        let pass = self.passes.pass(kernel, specialization)?;
        // SAFETY: Callers keep the resources until their submission was waited for.
        let set = unsafe { self.passes.bind(&pass, resources) }?;
        Ok(BoundPass { pass, set })
    }
}

/// A pass with the descriptor set of its only run.
struct BoundPass {
    pass: SharedPass,
    set: BoundSet,
}

impl BoundPass {
    /// Records the pass over `items`.
    fn record(
        &self,
        commands: vk::CommandBuffer,
        constants: &impl Pod,
        items: [u32; 3],
    ) -> Result<(), EngineError> {
        // SAFETY: `commands` is being recorded by Host::submit, outside a render pass; the set was written.
        unsafe { self.set.record(&self.pass, commands, constants, items) }
    }
}
