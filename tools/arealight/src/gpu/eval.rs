//! Reference cases on the GPU.

use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::{Light, LightShape, LightTexture, Quality};
use arealight_cases::answers::Answer;
use arealight_cases::cases::SupportedCase;
use arealight_engine::{Engine, EngineError, EvalPoint};
use arealight_oracle::texture::Texture;
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

/// One answer a case, by the GLSL of the shade pass. A case whose light float32 cannot hold gets the reason;
/// the others are answered all the same. `input` is the file of the cases, for errors.
pub fn answer(
    cases: &[SupportedCase],
    quality: Quality,
    engine: &mut LazyEngine<'_>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Set aside the lights that cannot be shaded
    let mut images = Images::default();
    let points: Vec<_> = cases.iter().map(|case| point(case, &mut images)).collect();
    let checked: Vec<_> = points.iter().map(|point| point.light.validate()).collect();
    let shaded = points.into_iter().zip(&checked).filter(|(_, checked)| checked.is_ok());
    let shaded: Vec<EvalPoint> = shaded.map(|(point, _)| point).collect();
    // Without work no device is needed
    let radiance = if shaded.is_empty() {
        Vec::new()
    } else {
        let engine = engine.get()?;
        images.load(engine).map_err(|error| failure(error, input))?;
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
fn point(case: &SupportedCase, images: &mut Images) -> EvalPoint {
    let shown = case.light.image.as_ref().zip(case.texture.as_ref());
    EvalPoint {
        surface: case.surface,
        position: DVec3::ZERO,
        normal: case.normal,
        view: case.view,
        light: Light {
            name: case.name.clone(),
            shape: LightShape::Polygon(case.light.vertices.clone()),
            radiance: case.light.radiance.as_vec3(),
            two_sided: case.light.two_sided,
            texture: shown.map(|(image, texture)| LightTexture {
                layer: images.layer(&image.texture),
                uvs: texture.uv.clone(),
            }),
        },
    }
}

/// The images that lights show, a layer each.
#[derive(Default)]
pub struct Images {
    layers: Vec<Arc<Texture>>,
}

impl Images {
    /// The layer of an image.
    pub fn layer(&mut self, image: &Arc<Texture>) -> u32 {
        let known = self.layers.iter().position(|layer| Arc::ptr_eq(layer, image));
        known.unwrap_or_else(|| {
            self.layers.push(Arc::clone(image));
            self.layers.len() - 1
        }) as u32
    }

    /// Loads them, in place of those there were.
    pub fn load(&self, engine: &mut Engine) -> Result<(), EngineError> {
        arealight_benches::pictures::load(engine, &self.layers)
    }
}
