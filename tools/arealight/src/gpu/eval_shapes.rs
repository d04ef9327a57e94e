//! Reference cases of disks, spheres and cylinders on the GPU.

use super::eval::Images;
use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::Quality;
use arealight_cases::answers::Answer;
use arealight_cases::cases::ShapeCase;
use arealight_engine::{Engine, EvalPoint};
use glam::DVec3;
use std::path::Path;

/// One answer a case, by the GLSL library. `input` is the file of the cases, for errors.
pub fn answer(
    cases: &[ShapeCase],
    quality: Quality,
    engine: &mut LazyEngine<'_>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Without work no device is needed
    if cases.is_empty() {
        return Ok(Vec::new());
    }
    let mut images = Images::default();
    let points: Vec<EvalPoint> = cases.iter().map(|case| point(case, &mut images)).collect();
    let engine = engine.get()?;
    let eval = |engine: &Engine, points: &[EvalPoint]| engine.eval_shapes(points, quality);
    let radiance = images.answers(engine, &points, eval).map_err(|error| failure(error, input))?;
    let answers = cases.iter().zip(radiance);
    Ok(answers.map(|(case, radiance)| Answer::new(&case.name, radiance.as_dvec3())).collect())
}

/// A case's light is relative to its shading point already.
fn point(case: &ShapeCase, images: &mut Images) -> EvalPoint {
    let mut light = case.light.clone();
    if let Some(image) = &case.image {
        images.show(&mut light, image, vec![]);
    }
    EvalPoint { surface: case.surface, position: DVec3::ZERO, normal: case.normal, view: case.view, light }
}
