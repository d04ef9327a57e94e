//! The lights' textures on the device, with their memory and descriptor sets.

use crate::kept::Kept;
use crate::memory::Memory;
use crate::{Engine, EngineError};
use arealight::{PolygonLight, PyramidSize, TexturePart};
use arealight_host::{DescriptorPool, Host, Image, ImageDescription, Location, Usage};
use arealight_vk::{Context, LightTextures, Resource, TextureUpdate};
use ash::vk;

/// An image that becomes a light's texture. Rows from the top.
#[derive(Debug, Clone, Copy)]
pub struct SourceImage<'a> {
    /// The texels, row after row.
    pub texels: SourceTexels<'a>,
    /// Width and height in texels, each from 1 to 4096.
    pub size: [u32; 2],
    /// The part that is shown.
    pub part: TexturePart,
}

/// Texels of an image; alpha has no meaning.
#[derive(Debug, Clone, Copy)]
pub enum SourceTexels<'a> {
    /// Linear light.
    Linear(&'a [[f32; 4]]),
    /// sRGB of eight bits.
    Srgb(&'a [[u8; 4]]),
}

impl SourceTexels<'_> {
    fn count(&self) -> usize {
        match self {
            Self::Linear(texels) => texels.len(),
            Self::Srgb(texels) => texels.len(),
        }
    }

    fn format(&self) -> vk::Format {
        match self {
            Self::Linear(_) => vk::Format::R32G32B32A32_SFLOAT,
            // Decoded by the kernel: devices may decode with an error of half a code, and software does
            Self::Srgb(_) => vk::Format::R8G8B8A8_UNORM,
        }
    }
}

impl Engine {
    /// Loads images as the lights' textures, a layer each in this order, in place of those there were; with no image
    /// there are none.
    ///
    /// # Errors
    /// [`EngineError`] where an image cannot be loaded, or the device or its memory is too small.
    pub fn load_textures(
        &mut self,
        size: PyramidSize,
        images: &[SourceImage<'_>],
    ) -> Result<(), EngineError> {
        self.textures = None;
        if images.is_empty() {
            return Ok(());
        }
        let textures = UploadedTextures::new(self.host(), self.context(), size, images.len() as u32)?;
        textures.update(self.host(), &(0..).zip(images).collect::<Vec<_>>())?;
        self.textures = Some(textures);
        Ok(())
    }

    /// Loads another image into a layer; the others stay as they are.
    ///
    /// # Errors
    /// [`EngineError`] where there is no such layer, the image cannot be loaded, or memory is out.
    pub fn update_texture(&mut self, layer: u32, image: &SourceImage<'_>) -> Result<(), EngineError> {
        let (textures, _) = self.texture_level(layer, 0)?;
        textures.update(self.host(), &[(layer, image)])
    }

    /// The lights' textures, as a pass takes them; where there are none, an array image in their place.
    pub fn light_textures(&self) -> Resource {
        self.textures.as_ref().map_or_else(|| self.table.filtered(), |textures| textures.image().resource())
    }

    /// The size of the lights' textures, where there are any.
    pub fn texture_size(&self) -> Option<PyramidSize> {
        self.textures.as_ref().map(|textures| textures.image().size())
    }

    /// How many layers the lights' textures have.
    pub fn texture_layers(&self) -> u32 {
        self.textures.as_ref().map_or(0, |textures| textures.image().layers())
    }

    /// Checks that every light's texture is there.
    ///
    /// # Errors
    /// [`EngineError::NoTextureLayer`] names the first light whose is not.
    pub fn check_layers(&self, lights: &[PolygonLight]) -> Result<(), EngineError> {
        let layers = self.texture_layers();
        for light in lights {
            if let Some(texture) = light.texture.as_ref().filter(|texture| texture.layer >= layers) {
                let (light, layer) = (light.name.clone(), texture.layer);
                return Err(EngineError::NoTextureLayer { light, layer, layers });
            }
        }
        Ok(())
    }

    /// A level of a layer, margins included: [`PyramidSize::extent`] texels, row after row.
    ///
    /// # Errors
    /// [`EngineError::NoTextureLevel`] where it is not there; else memory is out.
    pub fn download_level(&self, layer: u32, level: u32) -> Result<Vec<[f32; 4]>, EngineError> {
        let (textures, [width, height]) = self.texture_level(layer, level)?;
        let texels = (width * height) as usize;
        let bytes = (texels * size_of::<[half::f16; 4]>()) as u64;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let staging = self.host().buffer("light texture, read back", bytes, usage, Location::Readback)?;
        let subresource = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            mip_level: level,
            base_array_layer: layer,
            layer_count: 1,
        };
        let region = vk::BufferImageCopy::default()
            .image_subresource(subresource)
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let (image, layout) = (textures.image().image(), vk::ImageLayout::GENERAL);
        self.host().submit(|commands| {
            let device = self.host().device();
            // SAFETY: The image has been cleared, so that it is in this layout; the buffer has the level's size.
            unsafe { device.cmd_copy_image_to_buffer(commands, image, layout, staging.handle(), &[region]) };
        })?;
        let halves: Vec<[u16; 4]> = staging.download()?;
        let single = |texel: [u16; 4]| texel.map(|bits| half::f16::from_bits(bits).to_f32());
        Ok(halves.into_iter().map(single).collect())
    }

    /// The textures, and the extent of a level of them.
    fn texture_level(&self, layer: u32, level: u32) -> Result<(&UploadedTextures, [u32; 2]), EngineError> {
        let levels = self.texture_size().map_or(0, PyramidSize::levels);
        match &self.textures {
            Some(textures) if layer < textures.image().layers() && level < levels => {
                Ok((textures, textures.image().size().extent(level)))
            }
            _ => Err(EngineError::NoTextureLevel { layer, level, layers: self.texture_layers(), levels }),
        }
    }
}

/// Light textures with the memory that they lie in, and the descriptor sets of their levels.
pub struct UploadedTextures {
    allocated: Kept<Allocated>,
    level_sets: Vec<vk::DescriptorSet>,
    _pool: DescriptorPool,
}

/// Dropped in this order: the image goes before its memory is given back.
struct Allocated {
    image: LightTextures,
    _memory: Memory,
}

impl UploadedTextures {
    /// Black textures.
    fn new(host: &Host, context: &Context, size: PyramidSize, layers: u32) -> Result<Self, EngineError> {
        // SAFETY: Dropped with this value, which holds the host and waits for its submissions.
        let mut image = unsafe { LightTextures::new(context, size, layers) }?;
        // SAFETY: Called once, with an allocator of the same device.
        let allocation = host.with_allocator(|allocator| unsafe { image.allocate(allocator) })?;
        let memory = Memory::new(host, allocation);
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
        let allocated = Kept::new(host, Allocated { image, _memory: memory });
        Ok(Self { allocated, level_sets, _pool: pool })
    }

    fn image(&self) -> &LightTextures {
        &self.allocated.image
    }

    /// Loads each image into its layer.
    fn update(&self, host: &Host, images: &[(u32, &SourceImage<'_>)]) -> Result<(), EngineError> {
        let count = images.len() as u32;
        let pool = host.descriptor_pool(count, &self.image().source_pool_sizes(count))?;
        // The images live until the submission was waited for
        let uploaded = images
            .iter()
            .map(|(layer, image)| upload(host, *layer, image))
            .collect::<Result<Vec<_>, EngineError>>()?;
        let mut updates = Vec::with_capacity(images.len());
        for ((layer, image), uploaded) in images.iter().zip(&uploaded) {
            // SAFETY: The layout is the textures', and alive.
            let source_set = unsafe { pool.allocate(self.image().source_set_layout()) }?;
            let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
            let source = Resource::SampledImage { view: uploaded.view(), layout };
            // SAFETY: The set is new, and the image was just uploaded.
            unsafe { self.image().write_source_set(source_set, source) }?;
            updates.push(TextureUpdate {
                layer: *layer,
                source_set,
                source_size: image.size,
                part: image.part,
                decode_srgb: matches!(image.texels, SourceTexels::Srgb(_)),
            });
        }
        host.try_submit(|commands| {
            // SAFETY: The textures were cleared, the sets written, and nothing else runs.
            unsafe { self.image().record_update(commands, &self.level_sets, &updates) }?;
            Ok(())
        })
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
