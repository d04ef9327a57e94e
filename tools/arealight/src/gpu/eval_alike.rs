//! Reference cases on the GPU whose lights are checked already: shapes, and media.

use super::eval::Images;
use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::{Light, Quality};
use arealight_cases::answers::Answer;
use arealight_cases::cases::{MediumCase, ShapeCase};
use arealight_engine::{Engine, EngineError, EvalPoint, MediumPoint};
use glam::{DVec3, Vec3};
use std::path::Path;

/// One answer a case, by the GLSL library. `input` is the file of the cases, for errors.
pub fn answer<C: Case>(
    cases: &[C],
    quality: Quality,
    engine: &mut LazyEngine<'_>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Without work no device is needed
    if cases.is_empty() {
        return Ok(Vec::new());
    }
    let mut images = Images::default();
    let points: Vec<C::Point> = cases.iter().map(|case| case.point(&mut images)).collect();
    let eval = |engine: &Engine, points: &[C::Point]| C::eval(engine, points, quality);
    let radiance = images.answers(engine.get()?, &points, eval).map_err(|error| failure(error, input))?;
    let answers = cases.iter().zip(radiance);
    Ok(answers.map(|(case, radiance)| Answer::new(case.name(), radiance.as_dvec3())).collect())
}

/// A case, whose light is relative to its point already.
pub trait Case {
    type Point: AsRef<Light> + AsMut<Light> + Clone;
    fn name(&self) -> &str;
    fn point(&self, images: &mut Images) -> Self::Point;
    fn eval(engine: &Engine, points: &[Self::Point], quality: Quality) -> Result<Vec<Vec3>, EngineError>;
}

impl Case for ShapeCase {
    type Point = EvalPoint;

    fn name(&self) -> &str {
        &self.name
    }

    fn point(&self, images: &mut Images) -> EvalPoint {
        let mut light = self.light.clone();
        if let Some(image) = &self.image {
            images.show(&mut light, image, vec![]);
        }
        let (surface, normal, view) = (self.surface, self.normal, self.view);
        EvalPoint { surface, position: DVec3::ZERO, normal, view, light }
    }

    fn eval(engine: &Engine, points: &[EvalPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        engine.eval_shapes(points, quality)
    }
}

impl Case for MediumCase {
    type Point = MediumPoint;

    fn name(&self) -> &str {
        &self.name
    }

    fn point(&self, images: &mut Images) -> MediumPoint {
        let mut light = self.light.clone();
        if let Some(image) = &self.image {
            let uvs = light.texture.take().map_or_else(Vec::new, |texture| texture.uvs);
            images.show(&mut light, image, uvs);
        }
        MediumPoint { anisotropy: self.anisotropy, position: DVec3::ZERO, view: self.view, light }
    }

    fn eval(engine: &Engine, points: &[MediumPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        engine.eval_medium(points, quality)
    }
}
