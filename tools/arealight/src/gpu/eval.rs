//! Reference cases on the GPU.

use super::{engine, failure};
use crate::failure::Failure;
use arealight::{LightTable, PolygonLight, Quality};
use arealight_engine::EvalPoint;
use arealight_oracle::answers::Answer;
use arealight_oracle::cases::SupportedCase;
use glam::DVec3;
use std::path::Path;

/// One answer a case, by the GLSL of the shade pass with `table`. A case whose light float32 cannot hold gets the reason;
/// the others are answered all the same. `input` is the file of the cases, for errors.
pub fn answer(
    cases: &[SupportedCase],
    quality: Quality,
    table: &LightTable,
    device: Option<&str>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Set aside the lights that cannot be shaded
    let points: Vec<_> = cases.iter().map(point).collect();
    let checked: Vec<_> = points.iter().map(|point| point.light.validate()).collect();
    let shaded = points.into_iter().zip(&checked).filter(|(_, checked)| checked.is_ok());
    let shaded: Vec<EvalPoint> = shaded.map(|(point, _)| point).collect();
    // Without work no device is needed
    let radiance = if shaded.is_empty() {
        Vec::new()
    } else {
        let engine = engine(device, table)?;
        engine.eval(&shaded, quality).map_err(|error| failure(error, input))?
    };
    // Put the reasons in between
    let mut radiance = radiance.into_iter();
    let answer = |(case, checked): (&SupportedCase, &Result<_, _>)| match checked {
        Err(error) => Answer::none(&case.name, format!("{error}")),
        Ok(()) => match radiance.next() {
            Some(radiance) => Answer::new(&case.name, radiance.as_dvec3()),
            None => Answer::none(&case.name, "the device gave no answer"),
        },
    };
    Ok(cases.iter().zip(&checked).map(answer).collect())
}

/// A case's light is relative to its shading point already.
fn point(case: &SupportedCase) -> EvalPoint {
    EvalPoint {
        surface: case.surface,
        position: DVec3::ZERO,
        normal: case.normal,
        view: case.view,
        light: PolygonLight {
            name: case.name.clone(),
            vertices: case.light.vertices.clone(),
            radiance: case.light.radiance.as_vec3(),
            two_sided: case.light.two_sided,
            texture: None,
        },
    }
}
