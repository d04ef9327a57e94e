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
        let images: Vec<SourceImage<'_>> =
            sources.iter().zip(&texels).map(|(source, texels)| texels.image(source)).collect();
        self.load_textures(size, &images)
    }

    /// Loads what the lights of a scene show again where it moves.
    ///
    /// # Errors
    /// As [`Engine::update_texture`].
    pub fn show_frames(&self, scene: &Scene) -> Result<(), EngineError> {
        for (layer, shown) in (0..).zip(&scene.light_textures) {
            let image = scene.textures[shown.texture as usize].image;
            if let (false, Some(source)) =
                (scene.images[image as usize].frames.is_empty(), scene.light_texture_source(layer as usize))
            {
                self.update_texture(layer, &Texels::new(&source).image(&source))?;
            }
        }
        Ok(())
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

    fn image(&self, source: &LightTextureSource<'_>) -> SourceImage<'_> {
        let texels = match self {
            Self::Srgb(texels) => SourceTexels::Srgb(texels),
            Self::Linear(texels) => SourceTexels::Linear(texels),
        };
        SourceImage { texels, size: [source.width, source.height], part: source.part }
    }
}
