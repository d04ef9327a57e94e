//! The light textures of a scene.

use crate::{Engine, EngineError, SourceImage, SourceTexels};
use arealight_scene::{LightTextureSource, Scene};

impl Engine {
    /// Loads what the lights of `scene` show, at most `largest` texels a side; nothing where no light is
    /// textured.
    ///
    /// # Errors
    /// [`EngineError`] where an image cannot be loaded, or the device or its memory is too small.
    pub fn load_scene_textures(&mut self, scene: &Scene, largest: u32) -> Result<(), EngineError> {
        let Some(size) = scene.light_texture_size(largest) else {
            return Ok(());
        };
        let layers = 0..scene.light_textures.len();
        let sources: Vec<LightTextureSource<'_>> =
            layers.filter_map(|layer| scene.light_texture_source(layer)).collect();
        let texels: Vec<Texels<'_>> = sources.iter().map(Texels::new).collect();
        let images: Vec<SourceImage<'_>> = sources
            .iter()
            .zip(&texels)
            .map(|(source, texels)| SourceImage {
                texels: texels.borrow(),
                size: [source.width, source.height],
                part: source.part,
            })
            .collect();
        self.load_textures(size, &images)
    }
}

/// Texels as the loader takes them.
enum Texels<'a> {
    Srgb(&'a [[u8; 4]]),
    Linear(Vec<[f32; 4]>),
}

impl<'a> Texels<'a> {
    fn new(source: &LightTextureSource<'a>) -> Self {
        let bytes: &[[u8; 4]] = bytemuck::cast_slice(source.texels);
        if source.srgb {
            return Self::Srgb(bytes);
        }
        Self::Linear(bytes.iter().map(|texel| texel.map(|channel| f32::from(channel) / 255.0)).collect())
    }

    fn borrow(&self) -> SourceTexels<'_> {
        match self {
            Self::Srgb(texels) => SourceTexels::Srgb(texels),
            Self::Linear(texels) => SourceTexels::Linear(texels),
        }
    }
}
