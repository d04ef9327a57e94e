//! Pictures of the oracle as the light textures of an engine.

use arealight::{PyramidSize, TexturePart};
use arealight_engine::{Engine, EngineError, SourceImage, SourceTexels};
use arealight_oracle::texture::Texture;
use glam::DVec3;
use std::sync::Arc;

/// Loads pictures, a layer each, in the size of the largest; `part` is told their numbers.
pub fn load(
    engine: &mut Engine,
    pictures: &[Arc<Texture>],
    part: impl Fn(usize) -> TexturePart,
) -> Result<(), EngineError> {
    let side = |picture: &Arc<Texture>| picture.width().max(picture.height()) as u32;
    let size = PyramidSize::for_image(pictures.iter().map(side).max().unwrap_or(1), 1);
    let texel = |texel: &DVec3| texel.as_vec3().extend(1.0).to_array();
    let texels: Vec<Vec<[f32; 4]>> =
        pictures.iter().map(|picture| picture.texels().iter().map(texel).collect()).collect();
    let sources: Vec<SourceImage<'_>> = pictures
        .iter()
        .zip(&texels)
        .enumerate()
        .map(|(index, (picture, texels))| SourceImage {
            texels: SourceTexels::Linear(texels),
            size: [picture.width() as u32, picture.height() as u32],
            part: part(index),
        })
        .collect();
    engine.load_textures(size, &sources)
}

/// How many times as wide as high lights are, about, that pictures are loaded for.
pub const ASPECTS: [f32; 4] = [1.1, 1.4, 1.75, 2.2];

/// Loads pictures, each for lights of every aspect.
pub fn load_by_aspect(
    engine: &mut Engine,
    pictures: &[Arc<Texture>],
    part: TexturePart,
) -> Result<(), EngineError> {
    let layers: Vec<_> = ASPECTS.iter().flat_map(|_| pictures.iter().cloned()).collect();
    load(engine, &layers, |layer| TexturePart { aspect: ASPECTS[layer / pictures.len()], ..part })
}

/// The layer of picture `picture`, of so many that [`load_by_aspect`] loaded, for a light of that aspect.
pub fn layer_of(picture: u32, pictures: u32, aspect: f64) -> u32 {
    let off = |known: f32| (f64::from(known) / aspect).ln().abs();
    let nearest = (0..).zip(ASPECTS).min_by(|one, other| off(one.1).total_cmp(&off(other.1)));
    picture + pictures * nearest.map_or(0, |(group, _)| group)
}
