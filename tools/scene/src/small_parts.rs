//! Surfaces of many textured parts, as those of scanned or sculpted models: their small parts show one colour each, and
//! the faintest are left out.
//!
//! A flat part of a bent surface is a light with an image of its own. A model of 15,000 triangles has thousands of
//! them, each a few texels: what they show together is in their colours already.

use crate::light_textures::TexturedLight;
use crate::shown::Shown;
use crate::{Bounds, Scene};
use glam::DVec3;
use std::collections::BTreeMap;

/// A surface of more lit parts than these has its small and faint parts simplified.
const MANY_PARTS: usize = 64;

/// A part is small below this share of its surface's diagonal, if it also has less than [`SMALL_FLUX`] of its light.
const SMALL_DIAGONAL: f64 = 0.1;
const SMALL_FLUX: f64 = 0.01;

/// So much of a surface's light is left out at most, of its faintest parts.
const FAINT_FLUX: f64 = 1e-3;

/// What was simplified of a surface, by indices of lights.
pub(crate) struct Simplified {
    /// Parts that show their mean colour.
    pub small: Vec<usize>,
    /// Parts that are left out.
    pub faint: Vec<usize>,
    /// How much of the surface's light those had, from 0 to 1.
    pub lost: f64,
}

/// A lit part of a surface.
struct Part {
    /// Index into the textured lights.
    index: usize,
    /// The mean linear colour that it shows.
    color: DVec3,
    /// Radiance by area.
    flux: f64,
    diagonal: f64,
}

/// Gives small parts their mean colours and faint ones black; says of which surfaces.
pub(crate) fn simplify(scene: &Scene, textured: &[TexturedLight], shown: &mut [Shown]) -> Vec<Simplified> {
    let mut surfaces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, light) in textured.iter().enumerate() {
        if !matches!(shown[index], Shown::Color(DVec3::ZERO)) {
            surfaces.entry(light.surface).or_default().push(index);
        }
    }
    surfaces.retain(|_, lit| lit.len() > MANY_PARTS);
    let of_surface = |lit: Vec<usize>| simplify_surface(scene, textured, shown, &lit);
    surfaces.into_values().map(of_surface).collect()
}

fn simplify_surface(
    scene: &Scene,
    textured: &[TexturedLight],
    shown: &mut [Shown],
    lit: &[usize],
) -> Simplified {
    let light = |index: usize| &scene.lights[textured[index].owner];
    let diagonal = lit.iter().flat_map(|&index| light(index).shape.bounds()).collect::<Bounds>().diagonal();
    // Find out how much light each part has
    let part = |&index: &usize| {
        let color = shown[index].mean(scene);
        let [low, high] = light(index).shape.bounds();
        let radiance = (color * light(index).radiance.as_dvec3()).element_sum();
        let flux = radiance * light(index).shape.area_vector().length();
        Part { index, color, flux, diagonal: low.distance(high) }
    };
    let mut parts: Vec<Part> = lit.iter().map(part).collect();
    let total: f64 = parts.iter().map(|part| part.flux).sum();
    parts.sort_by(|a, b| a.flux.total_cmp(&b.flux));
    // Leave the faintest out
    let (mut small, mut faint, mut lost) = (vec![], vec![], 0.0);
    for part in &parts {
        if lost + part.flux > FAINT_FLUX * total {
            break;
        }
        lost += part.flux;
        faint.push(textured[part.index].owner);
        shown[part.index] = Shown::Color(DVec3::ZERO);
    }
    // Give small ones one colour
    for part in &parts[faint.len()..] {
        let is_image = shown[part.index].rectangle().is_some();
        if is_image && part.diagonal < SMALL_DIAGONAL * diagonal && part.flux < SMALL_FLUX * total {
            small.push(textured[part.index].owner);
            shown[part.index] = Shown::Color(part.color);
        }
    }
    Simplified { small, faint, lost: if total > 0.0 { lost / total } else { 0.0 } }
}
