//! Light textures with their memory and descriptor sets.

use super::place::{descriptor_sets, place_of};
use crate::context::Context;
use crate::error::Error;
use crate::light_textures::{LightTextures, TextureUpdate};
use crate::memory::{Memory, SharedAllocator};
use crate::resource::Resource;
use arealight::{Light, PyramidSize};
use ash::vk;

/// The light textures of [`super::AreaLights`].
pub(super) struct Textures {
    layers: LightTextures,
    _memory: Memory,
    context: Context,
    level_pool: vk::DescriptorPool,
    level_sets: Vec<vk::DescriptorSet>,
    /// Of each place, the pools of the sets that its frame's updates read images by.
    source_pools: Vec<SourcePools>,
    cleared: Cleared,
}

#[derive(Default, Clone)]
struct SourcePools {
    pools: Vec<vk::DescriptorPool>,
    /// The next update is of another frame.
    is_done: bool,
}

/// Whether the layers were made black, which comes before all else.
#[derive(PartialEq)]
enum Cleared {
    Not,
    /// By commands that may yet be thrown away.
    Recorded,
    Done,
}

impl Textures {
    /// # Safety
    /// It is dropped when no pending work uses it, before the device.
    pub(super) unsafe fn new(
        context: &Context,
        allocator: &SharedAllocator,
        (size, count): (PyramidSize, u32),
        frames: usize,
    ) -> Result<Self, Error> {
        // SAFETY: the same contract; the allocator is the device's.
        unsafe {
            let mut layers = LightTextures::new(context, size, count)?;
            let memory = allocator.keep(layers.allocate(&mut allocator.lock())?);
            // From here on dropping it destroys what it has
            let mut made = Self {
                layers,
                _memory: memory,
                context: context.clone(),
                level_pool: vk::DescriptorPool::null(),
                level_sets: vec![],
                source_pools: vec![SourcePools::default(); frames],
                cleared: Cleared::Not,
            };
            let (sizes, layout) = (made.layers.level_pool_sizes(), made.layers.level_set_layout());
            let layouts = vec![layout; made.layers.level_sets() as usize];
            (made.level_pool, made.level_sets) = descriptor_sets(context, &sizes, &layouts)?;
            made.layers.write_level_sets(&made.level_sets)?;
            Ok(made)
        }
    }

    pub(super) fn resource(&self) -> Resource {
        self.layers.resource()
    }

    pub(super) fn check_lights(&self, lights: &[Light]) -> Result<(), Error> {
        self.layers.check_lights(lights)
    }

    /// Records that the layers become black, the first time.
    ///
    /// # Safety
    /// As [`LightTextures::record_clear`].
    pub(super) unsafe fn clear_once(&mut self, command_buffer: vk::CommandBuffer) {
        if self.cleared == Cleared::Not {
            // SAFETY: the same contract.
            unsafe { self.layers.record_clear(command_buffer) };
            self.cleared = Cleared::Recorded;
        }
    }

    /// The commands of the frame at a place are whole, or will be thrown away.
    pub(super) fn settle(&mut self, place: usize, is_whole: bool) {
        if let Some(sources) = self.source_pools.get_mut(place) {
            sources.is_done = true;
        }
        if self.cleared == Cleared::Recorded {
            self.cleared = if is_whole { Cleared::Done } else { Cleared::Not };
        }
    }

    /// # Safety
    /// As [`super::AreaLights::load_textures`].
    pub(super) unsafe fn load(
        &mut self,
        command_buffer: vk::CommandBuffer,
        place: usize,
        updates: &[(Resource, TextureUpdate)],
    ) -> Result<(), Error> {
        let sources = place_of(&mut self.source_pools, place)?;
        if std::mem::take(&mut sources.is_done) {
            for pool in sources.pools.drain(..) {
                // SAFETY: the frame before at this place is done.
                unsafe { self.context.device.destroy_descriptor_pool(pool, None) };
            }
        }
        let mut wanted: Vec<_> = updates.iter().map(|(_, update)| *update).collect();
        self.layers.check_updates(&wanted)?;
        if wanted.is_empty() {
            return Ok(());
        }
        let layouts = vec![self.layers.source_set_layout(); updates.len()];
        let (pool, sets) =
            descriptor_sets(&self.context, &self.layers.source_pool_sizes(layouts.len() as u32), &layouts)?;
        sources.pools.push(pool);
        // SAFETY: the same contract.
        unsafe {
            for ((set, (source, _)), update) in sets.into_iter().zip(updates).zip(&mut wanted) {
                self.layers.write_source_set(set, *source)?;
                update.source_set = set;
            }
            self.clear_once(command_buffer);
            self.layers.record_update(command_buffer, &self.level_sets, &wanted)
        }
    }
}

impl Drop for Textures {
    fn drop(&mut self) {
        // SAFETY: by the contract of Textures::new; null pools are ignored.
        unsafe {
            let sources = self.source_pools.iter().flat_map(|sources| &sources.pools);
            for pool in sources.chain([&self.level_pool]) {
                self.context.device.destroy_descriptor_pool(*pool, None);
            }
        }
    }
}
