//! Cases on the GPU.

use super::{LazyEngine, failure};
use crate::failure::Failure;
use crate::visible::Piece;
use arealight::{Light, LightShape, LightTexture, Quality, TexturePart};
use arealight_benches::pictures;
use arealight_cases::answers::Answer;
use arealight_cases::cases::SupportedCase;
use arealight_engine::{Engine, EngineError, EvalPoint, MediumPoint};
use arealight_oracle::texture::Texture;
use glam::{DVec2, DVec3, Vec3};
use std::path::Path;
use std::sync::Arc;

/// One answer a piece, by the GLSL library. A piece whose light float32 cannot hold gets the reason; the
/// others are answered all the same. `input` is the file of the cases, for errors.
pub fn answer(
    pieces: &[Piece<'_>],
    quality: Quality,
    engine: &mut LazyEngine<'_>,
    input: &Path,
) -> Result<Vec<Answer>, Failure> {
    // Set aside the lights that cannot be shaded
    let mut images = Images::default();
    let lights: Vec<Light> = pieces.iter().map(|piece| light(piece, &mut images)).collect();
    let checked: Vec<_> = lights.iter().map(Light::validate).collect();
    let shaded = pieces.iter().zip(lights).zip(&checked).filter(|(_, checked)| checked.is_ok());
    // A case's light is relative to its point already
    let (position, mut on_surfaces, mut in_media) = (DVec3::ZERO, vec![], vec![]);
    for ((Piece { case, .. }, light), _) in shaded {
        let &SupportedCase { surface, normal, view, medium, .. } = *case;
        match medium {
            None => on_surfaces.push(EvalPoint { surface, position, normal, view, light }),
            Some(anisotropy) => in_media.push(MediumPoint { anisotropy, position, view, light }),
        }
    }
    // Without work no device is needed
    let (mut of_surfaces, mut of_media) = (vec![].into_iter(), vec![].into_iter());
    if !on_surfaces.is_empty() || !in_media.is_empty() {
        let (engine, fail) = (engine.get()?, |error| failure(error, input));
        let eval = |engine: &Engine, points: &[EvalPoint]| engine.eval(points, quality);
        of_surfaces = images.answers(engine, on_surfaces, |it| &mut it.light, eval).map_err(fail)?;
        let eval = |engine: &Engine, points: &[MediumPoint]| engine.eval_medium(points, quality);
        of_media = images.answers(engine, in_media, |it| &mut it.light, eval).map_err(fail)?;
    }
    // Put the reasons in between
    let answer = |(Piece { case, .. }, checked): (&Piece<'_>, &Result<_, _>)| match checked {
        Err(error) => Answer::none(&case.name, format!("{error}")),
        Ok(()) => match if case.medium.is_none() { of_surfaces.next() } else { of_media.next() } {
            Some(radiance) => Answer::new(&case.name, radiance.as_dvec3()),
            None => Answer::none(&case.name, "the device gave no answer"),
        },
    };
    Ok(pieces.iter().zip(&checked).map(answer).collect())
}

/// What is seen of a piece's light.
fn light(piece: &Piece<'_>, images: &mut Images) -> Light {
    let mut light = piece.case.light.clone();
    let mut uvs = light.texture.take().map_or_else(Vec::new, |texture| texture.uvs);
    if let Some(part) = &piece.part {
        let coordinate = |vertex: &DVec3| part.image.as_ref().map(|image| image.map.coordinate(*vertex));
        uvs = part.vertices.iter().filter_map(coordinate).collect();
        light.shape = LightShape::Polygon(part.vertices.clone());
    }
    if let Some(image) = &piece.case.image {
        images.show(&mut light, image, uvs);
    }
    light
}

/// The images that lights show.
#[derive(Default)]
struct Images {
    known: Vec<(Arc<Texture>, TexturePart)>,
}

impl Images {
    /// Lets a light show an image, or its piece of it: its layer is its number among all.
    fn show(&mut self, light: &mut Light, image: &Arc<Texture>, mut uvs: Vec<DVec2>) {
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
    fn answers<P: Clone>(
        &self,
        engine: &mut Engine,
        mut points: Vec<P>,
        light: fn(&mut P) -> &mut Light,
        answer: impl Fn(&Engine, &[P]) -> Result<Vec<Vec3>, EngineError>,
    ) -> Result<std::vec::IntoIter<Vec3>, EngineError> {
        let mut answers = vec![Vec3::ZERO; points.len()];
        // Each is shown alone
        let shown = |point| light(point).texture.as_mut().map(|it| std::mem::take(&mut it.layer) as usize);
        let layers: Vec<Option<usize>> = points.iter_mut().map(shown).collect();
        for image in (0..self.known.len()).map(Some).chain([None]) {
            let indices: Vec<usize> = (0..points.len()).filter(|i| layers[*i] == image).collect();
            let shown: Vec<P> = indices.iter().map(|i| points[*i].clone()).collect();
            let (images, parts): (Vec<_>, Vec<_>) =
                image.map(|image| self.known[image].clone()).into_iter().unzip();
            pictures::load(engine, &images, |index| parts[index])?;
            for (index, radiance) in indices.into_iter().zip(answer(engine, &shown)?) {
                answers[index] = radiance;
            }
        }
        Ok(answers.into_iter())
    }
}
