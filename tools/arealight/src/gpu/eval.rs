//! Reference cases on the GPU.

use super::{LazyEngine, failure};
use crate::failure::Failure;
use arealight::{Light, LightShape, LightTexture, Quality, TexturePart};
use arealight_benches::pictures;
use arealight_cases::answers::Answer;
use arealight_cases::cases::SupportedCase;
use arealight_engine::{Engine, EngineError, EvalPoint};
use arealight_oracle::texture::Texture;
use glam::{DVec2, DVec3, Vec3};
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
        let eval = |engine: &Engine, points: &[EvalPoint]| engine.eval(points, quality);
        images.answers(engine, &shaded, eval).map_err(|error| failure(error, input))?
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
    let mut light = Light {
        name: case.name.clone(),
        shape: LightShape::Polygon(case.light.vertices.clone()),
        radiance: case.light.radiance.as_vec3(),
        two_sided: case.light.two_sided,
        profile: case.light.profile.clone(),
        opening: case.light.opening,
        ..Light::default()
    };
    if let Some(image) = &case.light.image {
        let uvs = case.light.vertices.iter().map(|vertex| image.map.coordinate(*vertex)).collect();
        images.show(&mut light, &image.texture, uvs);
    }
    EvalPoint { surface: case.surface, position: DVec3::ZERO, normal: case.normal, view: case.view, light }
}

/// The images that lights show.
#[derive(Default)]
pub struct Images {
    known: Vec<(Arc<Texture>, TexturePart)>,
}

impl Images {
    /// Lets a light show an image, or its piece of it: its layer is its number among all.
    pub fn show(&mut self, light: &mut Light, image: &Arc<Texture>, mut uvs: Vec<DVec2>) {
        // Rounded, so that what is seen of all of it is all
        let even = |uv: DVec2| (uv * 1048576.0).round() / 1048576.0;
        let low = even(uvs.iter().copied().fold(DVec2::INFINITY, DVec2::min));
        let high = even(uvs.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max));
        let divisor = TexturePart::divisor_of(image.brightest() as f32);
        let mut part = TexturePart { divisor, ..TexturePart::default() };
        if low.min_element() >= 0.0 && high.max_element() <= 1.0 && (high - low).min_element() > 0.0 {
            (part.low, part.size) = (low, high - low);
            uvs = uvs.into_iter().map(|uv| (uv - low) / (high - low)).collect();
        }
        light.texture = Some(LightTexture { layer: 0, uvs });
        part = part.shown_by(light);
        // To a 64th of an octave, so that many lights don't need many
        part.aspect = ((64.0 * part.aspect.log2()).round() / 64.0).exp2();
        let known = self.known.iter().position(|known| Arc::ptr_eq(&known.0, image) && known.1 == part);
        let layer = known.unwrap_or_else(|| {
            self.known.push((Arc::clone(image), part));
            self.known.len() - 1
        }) as u32;
        light.texture.iter_mut().for_each(|texture| texture.layer = layer);
        light.radiance *= divisor;
    }

    /// The answers of points, in their order, an image at a time: none depends on the others.
    pub fn answers<P: AsRef<Light> + AsMut<Light> + Clone>(
        &self,
        engine: &mut Engine,
        points: &[P],
        answer: impl Fn(&Engine, &[P]) -> Result<Vec<Vec3>, EngineError>,
    ) -> Result<Vec<Vec3>, EngineError> {
        let mut answers = vec![Vec3::ZERO; points.len()];
        let layer = |point: &P| point.as_ref().texture.as_ref().map(|texture| texture.layer as usize);
        for image in (0..self.known.len()).map(Some).chain([None]) {
            let indices: Vec<usize> = (0..points.len()).filter(|i| layer(&points[*i]) == image).collect();
            let mut shown: Vec<P> = indices.iter().map(|i| points[*i].clone()).collect();
            for texture in shown.iter_mut().filter_map(|point| point.as_mut().texture.as_mut()) {
                texture.layer = 0;
            }
            let (images, parts): (Vec<_>, Vec<_>) =
                image.map(|image| self.known[image].clone()).into_iter().unzip();
            pictures::load(engine, &images, |index| parts[index])?;
            for (index, radiance) in indices.into_iter().zip(answer(engine, &shown)?) {
                answers[index] = radiance;
            }
        }
        Ok(answers)
    }
}
