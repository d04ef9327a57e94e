//! Reference cases of disks, spheres and cylinders on the GPU.

use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::Quality;
use arealight_engine::ShapePoint;
use arealight_oracle::answers::Answer;
use arealight_oracle::cases::ShapeCase;
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
    let points: Vec<ShapePoint> = cases.iter().map(point).collect();
    let radiance = engine.get()?.eval_shapes(&points, quality).map_err(|error| failure(error, input))?;
    let answers = cases.iter().zip(radiance);
    Ok(answers.map(|(case, radiance)| Answer::new(&case.name, radiance.as_dvec3())).collect())
}

/// A case's light is relative to its shading point already.
fn point(case: &ShapeCase) -> ShapePoint {
    ShapePoint {
        surface: case.surface,
        position: DVec3::ZERO,
        normal: case.normal,
        view: case.view,
        light: case.light.clone(),
    }
}
