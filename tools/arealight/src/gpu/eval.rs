//! Reference cases on the GPU.

use super::{engine, failure};
use crate::failure::Failure;
use arealight::{PolygonLight, Quality};
use arealight_engine::EvalPoint;
use arealight_oracle::cases::SupportedCase;
use glam::DVec3;
use std::path::Path;

/// The radiance of each case, by the GLSL of the shade pass.
pub fn answer(cases: &[SupportedCase], device: Option<&str>) -> Result<Vec<[f64; 3]>, Failure> {
    let points: Vec<_> = cases.iter().map(point).collect();
    let engine = engine(device, &arealight_table::ggx())?;
    let radiance =
        engine.eval(&points, Quality::default()).map_err(|error| failure(error, Path::new("cases")))?;
    Ok(radiance.into_iter().map(|r| r.as_dvec3().to_array()).collect())
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
        },
    }
}
