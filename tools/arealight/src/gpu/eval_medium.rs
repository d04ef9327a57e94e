//! Reference cases of media on the GPU.

use super::eval::Images;
use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::Quality;
use arealight_cases::answers::Answer;
use arealight_cases::cases::MediumCase;
use arealight_engine::{Engine, MediumPoint};
use glam::DVec3;
use std::path::Path;

/// One answer a case, by the GLSL library. `input` is the file of the cases, for errors.
pub fn answer(
    cases: &[MediumCase],
    quality: Quality,
    engine: &mut LazyEngine<'_>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Without work no device is needed
    if cases.is_empty() {
        return Ok(Vec::new());
    }
    let mut images = Images::default();
    let points: Vec<MediumPoint> = cases.iter().map(|case| point(case, &mut images)).collect();
    let engine = engine.get()?;
    let eval = |engine: &Engine, points: &[MediumPoint]| engine.eval_medium(points, quality);
    let radiance = images.answers(engine, &points, eval).map_err(|error| failure(error, input))?;
    let answers = cases.iter().zip(radiance);
    Ok(answers.map(|(case, radiance)| Answer::new(&case.name, radiance.as_dvec3())).collect())
}

/// A case's light is relative to its point already.
fn point(case: &MediumCase, images: &mut Images) -> MediumPoint {
    let mut light = case.light.clone();
    if let Some(image) = &case.image {
        let uvs = light.texture.take().map_or_else(Vec::new, |texture| texture.uvs);
        images.show(&mut light, image, uvs);
    }
    MediumPoint { anisotropy: case.anisotropy, position: DVec3::ZERO, view: case.view, light }
}
