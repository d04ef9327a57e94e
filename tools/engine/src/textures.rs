//! The lights' textures of an engine.

use crate::host::Location;
use crate::texture_array::TextureArray;
use crate::{Engine, EngineError};
use arealight::pyramid::LAYERS;
use arealight::{Light, PyramidSize, TexturePart};
use arealight_vk::Resource;
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

/// Array layers of a light's image, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Of {
    /// Itself, and its mips.
    Image,
    /// A (`shaders/include/arealight/textures/footprint.glsl`).
    A,
    /// B along the image's rows.
    BRows,
    /// B along its columns.
    BColumns,
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
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Linear(texels) => texels.len(),
            Self::Srgb(texels) => texels.len(),
        }
    }

    /// Where they are, to find images that are the same: the first texel's address, and their size in bytes.
    pub(crate) fn address(&self) -> (*const u8, usize) {
        match self {
            Self::Linear(texels) => (texels.as_ptr().cast(), size_of_val(*texels)),
            Self::Srgb(texels) => (texels.as_ptr().cast(), size_of_val(*texels)),
        }
    }

    pub(crate) fn format(&self) -> vk::Format {
        match self {
            Self::Linear(_) => vk::Format::R32G32B32A32_SFLOAT,
            // Decoded by the kernel: devices may decode with an error of half a code, and software does
            Self::Srgb(_) => vk::Format::R8G8B8A8_UNORM,
        }
    }
}

impl Engine {
    /// Loads images as the lights' textures, a layer each in this order, in place of those there were; with
    /// no image there are none.
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
        let textures = TextureArray::new(&self.passes, size, images.len() as u32)?;
        textures.update(&textures.sources(images)?)?;
        self.textures = Some(textures);
        Ok(())
    }

    /// Loads another image into a layer; the others stay as they are.
    ///
    /// # Errors
    /// [`EngineError`] where there is no such layer, the image cannot be loaded, or memory is out.
    pub fn update_texture(&self, layer: u32, image: &SourceImage<'_>) -> Result<(), EngineError> {
        let (textures, _) = self.texture_level(layer, 0)?;
        textures.update(&[textures.source(layer, image)?])
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
    /// [`arealight::LightFault::NoTextureLayer`] names the first light whose is not.
    pub fn check_layers(&self, lights: &[Light]) -> Result<(), EngineError> {
        Ok(Light::check_texture_layers(lights, self.texture_layers())?)
    }

    /// A level of a layer, of the image or of what lobes see of it: [`PyramidSize::side`] texels a side, row
    /// after row.
    pub fn download_level(&self, layer: u32, of: Of, level: u32) -> Result<Vec<[f32; 4]>, EngineError> {
        let (textures, side) = self.texture_level(layer, level)?;
        let texels = (side * side) as usize;
        let bytes = (texels * size_of::<[half::f16; 4]>()) as u64;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let staging = self.host().buffer("light texture, read back", bytes, usage, Location::Readback)?;
        let subresource = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            mip_level: level,
            base_array_layer: LAYERS * layer + of as u32,
            layer_count: 1,
        };
        let region = vk::BufferImageCopy::default()
            .image_subresource(subresource)
            .image_extent(vk::Extent3D { width: side, height: side, depth: 1 });
        let (image, layout) = (textures.image().image(), vk::ImageLayout::GENERAL);
        self.host().submit(|commands| {
            let device = self.host().device();
            // SAFETY: The image has been cleared, so that it is in this layout; the buffer has the level's
            // size.
            unsafe { device.cmd_copy_image_to_buffer(commands, image, layout, staging.handle(), &[region]) };
        })?;
        let halves: Vec<[u16; 4]> = staging.download()?;
        let single = |texel: [u16; 4]| texel.map(|bits| half::f16::from_bits(bits).to_f32());
        Ok(halves.into_iter().map(single).collect())
    }

    /// The textures, and the side of a level of them.
    fn texture_level(&self, layer: u32, level: u32) -> Result<(&TextureArray, u32), EngineError> {
        let levels = self.texture_size().map_or(0, PyramidSize::levels);
        match &self.textures {
            Some(textures) if layer < textures.image().layers() && level < levels => {
                Ok((textures, textures.image().size().side(level)))
            }
            _ => Err(EngineError::NoTextureLevel { layer, level, layers: self.texture_layers(), levels }),
        }
    }
}
