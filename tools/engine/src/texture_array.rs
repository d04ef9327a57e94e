//! Light textures on a host, with their memory and descriptor sets, and images to load into them.

use crate::host::Memory;
use crate::host::{DescriptorPool, Host, Image, ImageDescription, Usage};
use crate::{EngineError, Kept, Passes, SourceImage, SourceTexels};
use arealight::PyramidSize;
use arealight_vk::{LightTextures, Resource, TextureUpdate};
use ash::vk;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::rc::Rc;

/// Light textures with the memory that they lie in, and the descriptor sets of their levels.
pub struct TextureArray {
    allocated: Kept<Allocated>,
    level_sets: Vec<vk::DescriptorSet>,
    _pool: DescriptorPool,
    host: Host,
}

/// Dropped in this order: the image goes before its memory is given back.
struct Allocated {
    image: LightTextures,
    _memory: Memory,
}

/// An image on the device, and what it will replace.
pub struct TextureSource {
    update: TextureUpdate,
    // Go after the last submission that uses them was waited for
    _image: Rc<Image>,
    _pool: DescriptorPool,
}

impl TextureArray {
    /// Black textures.
    pub fn new(passes: &Passes, size: PyramidSize, layers: u32) -> Result<Self, EngineError> {
        let host = passes.host();
        // SAFETY: Dropped with this value, which holds the host and waits for its submissions.
        let mut image = unsafe { LightTextures::new(passes.context(), size, layers) }?;
        // SAFETY: Called once, with an allocator of the same device.
        let allocation = host.with_allocator(|allocator| unsafe { image.allocate(allocator) })?;
        let memory = Memory::new(host, allocation);
        let allocated = Kept::new(host, Allocated { image, _memory: memory });
        let image = &allocated.image;

        let pool = host.descriptor_pool(image.level_sets(), &image.level_pool_sizes())?;
        let set = |_| {
            // SAFETY: The layout is the textures', and alive.
            unsafe { pool.allocate(image.level_set_layout()) }
        };
        let level_sets = (0..image.level_sets()).map(set).collect::<Result<Vec<_>, _>>()?;
        // SAFETY: The sets are new.
        unsafe { image.write_level_sets(&level_sets) }?;
        // SAFETY: The textures have memory.
        host.submit(|commands| unsafe { image.record_clear(commands) })?;
        Ok(Self { allocated, level_sets, _pool: pool, host: host.clone() })
    }

    /// The recorder's textures.
    pub fn image(&self) -> &LightTextures {
        &self.allocated.image
    }

    /// Uploads an image that is to replace a layer.
    ///
    /// # Errors
    /// [`EngineError`] where the image has not the texels that it says, or memory is out.
    pub fn source(&self, layer: u32, image: &SourceImage<'_>) -> Result<TextureSource, EngineError> {
        self.source_of(layer, image, Rc::new(upload(&self.host, layer, image)?))
    }

    /// Uploads images that are to replace the first layers. Those that have the same texels, in the same
    /// memory, are uploaded once: a model's lights show hundreds of parts of one image.
    pub fn sources(&self, images: &[SourceImage<'_>]) -> Result<Vec<TextureSource>, EngineError> {
        let mut known: HashMap<_, Rc<Image>> = HashMap::new();
        let source = |(layer, image): (u32, &SourceImage<'_>)| {
            let uploaded = match known.entry((image.texels.address(), image.size)) {
                Entry::Occupied(entry) => entry.get().clone(),
                Entry::Vacant(entry) => entry.insert(Rc::new(upload(&self.host, layer, image)?)).clone(),
            };
            self.source_of(layer, image, uploaded)
        };
        (0..).zip(images).map(source).collect()
    }

    /// What loads a layer from an image on the device.
    fn source_of(
        &self,
        layer: u32,
        image: &SourceImage<'_>,
        uploaded: Rc<Image>,
    ) -> Result<TextureSource, EngineError> {
        let pool = self.host.descriptor_pool(1, &self.image().source_pool_sizes(1))?;
        // SAFETY: The layout is the textures', and alive.
        let source_set = unsafe { pool.allocate(self.image().source_set_layout()) }?;
        let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        let resource = Resource::SampledImage { view: uploaded.view(), layout };
        // SAFETY: The set is new, and the image was just uploaded.
        unsafe { self.image().write_source_set(source_set, resource) }?;
        let update = TextureUpdate {
            layer,
            source_set,
            source_size: image.size,
            part: image.part,
            decode_srgb: matches!(image.texels, SourceTexels::Srgb(_)),
        };
        Ok(TextureSource { update, _image: uploaded, _pool: pool })
    }

    /// Records that the sources replace their layers.
    ///
    /// # Errors
    /// [`EngineError`] where a layer is not there or given twice, or an image cannot be loaded.
    ///
    /// # Safety
    /// `commands` is being recorded for this host, outside a render pass; the sources, which are of this
    /// array, live until it was waited for.
    pub unsafe fn record(
        &self,
        commands: vk::CommandBuffer,
        sources: &[TextureSource],
    ) -> Result<(), EngineError> {
        let updates: Vec<_> = sources.iter().map(|source| source.update).collect();
        // SAFETY: The textures were cleared and the sets written; the rest is the caller's.
        unsafe { self.image().record_update(commands, &self.level_sets, &updates) }?;
        Ok(())
    }

    /// Replaces layers by sources of this array, and waits.
    ///
    /// # Errors
    /// As [`TextureArray::record`], and where the submission fails.
    pub(crate) fn update(&self, sources: &[TextureSource]) -> Result<(), EngineError> {
        // SAFETY: The submission is waited for; the engine passes sources of this array.
        self.host.try_submit(|commands| unsafe { self.record(commands, sources) })
    }
}

/// The image on the device, to be sampled.
fn upload(host: &Host, layer: u32, image: &SourceImage<'_>) -> Result<Image, EngineError> {
    let [width, height] = image.size;
    let given = image.texels.count();
    if given as u64 != u64::from(width) * u64::from(height) {
        return Err(EngineError::SourceTexels { layer, given, width, height });
    }
    let uploaded = host.image(&ImageDescription {
        name: "light texture, loaded",
        extent: image.size,
        layers: 1,
        format: image.texels.format(),
        usage: vk::ImageUsageFlags::SAMPLED,
    })?;
    match image.texels {
        SourceTexels::Linear(texels) => uploaded.upload(texels, Usage::COMPUTE_READ)?,
        SourceTexels::Srgb(texels) => uploaded.upload(texels, Usage::COMPUTE_READ)?,
    }
    Ok(uploaded)
}
