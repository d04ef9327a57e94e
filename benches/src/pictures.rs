//! Pictures of the oracle as the light textures of an engine.

use arealight::{PyramidSize, TexturePart};
use arealight_engine::{Engine, EngineError, SourceImage, SourceTexels};
use arealight_oracle::texture::Texture;
use glam::DVec3;
use std::sync::Arc;

/// Loads pictures, a layer each, in the size of the largest, with what the texels of each are divided by.
pub fn load(
    engine: &mut Engine,
    pictures: &[Arc<Texture>],
    divisor: impl Fn(&Texture) -> f32,
) -> Result<(), EngineError> {
    let side = |picture: &Arc<Texture>| picture.width().max(picture.height()) as u32;
    let size = PyramidSize::for_image(pictures.iter().map(side).max().unwrap_or(1), 1);
    let texel = |texel: &DVec3| texel.as_vec3().extend(1.0).to_array();
    let texels: Vec<Vec<[f32; 4]>> =
        pictures.iter().map(|picture| picture.texels().iter().map(texel).collect()).collect();
    let sources: Vec<SourceImage<'_>> = pictures
        .iter()
        .zip(&texels)
        .map(|(picture, texels)| SourceImage {
            texels: SourceTexels::Linear(texels),
            size: [picture.width() as u32, picture.height() as u32],
            part: TexturePart { divisor: divisor(picture), ..TexturePart::default() },
        })
        .collect();
    engine.load_textures(size, &sources)
}
