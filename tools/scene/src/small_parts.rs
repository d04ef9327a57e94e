//! Surfaces of many textured parts, as those of scanned or sculpted models: their small parts show one colour
//! each. However faint, none is left out: of a point that touches it, it may be all the light.
//!
//! A flat part of a bent surface is a light with an image of its own. A model of 15,000 triangles has
//! thousands of them, each a few texels: what they show together is in their colours already.

use crate::bounds::Bounds;
use crate::images::Textures;
use crate::shown::{Shown, TexturedLight};
use arealight::Light;
use glam::DVec3;
use std::collections::BTreeMap;

/// A surface of more lit parts than these has its small parts simplified.
const MANY_PARTS: usize = 64;

/// A part is small below this share of its surface's diagonal, if it also has less than [`SMALL_FLUX`] of its
/// light.
const SMALL_DIAGONAL: f64 = 0.1;
const SMALL_FLUX: f64 = 0.01;

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

/// Gives small parts their mean colours: the indices of their lights, for each surface of many parts.
pub(crate) fn simplify(
    lights: &[Light],
    textures: &Textures,
    textured: &[TexturedLight],
    shown: &mut [Shown],
) -> Vec<Vec<usize>> {
    let mut surfaces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, light) in textured.iter().enumerate() {
        if !matches!(shown[index], Shown::Color(DVec3::ZERO)) {
            surfaces.entry(light.surface).or_default().push(index);
        }
    }
    surfaces.retain(|_, lit| lit.len() > MANY_PARTS);
    let of_surface = |lit: Vec<usize>| simplify_surface(lights, textures, textured, shown, &lit);
    surfaces.into_values().map(of_surface).collect()
}

fn simplify_surface(
    lights: &[Light],
    textures: &Textures,
    textured: &[TexturedLight],
    shown: &mut [Shown],
    lit: &[usize],
) -> Vec<usize> {
    let light = |index: usize| &lights[textured[index].owner];
    let diagonal = lit.iter().flat_map(|&index| light(index).shape.bounds()).collect::<Bounds>().diagonal();
    // Find out how much light each part has
    let part = |&index: &usize| {
        let color = shown[index].mean(textures);
        let [low, high] = light(index).shape.bounds();
        let radiance = (color * light(index).radiance.as_dvec3()).element_sum();
        let flux = radiance * light(index).shape.area_vector().length();
        Part { index, color, flux, diagonal: low.distance(high) }
    };
    let parts: Vec<Part> = lit.iter().map(part).collect();
    let total: f64 = parts.iter().map(|part| part.flux).sum();
    // Give small ones one colour
    let mut small = vec![];
    for part in parts {
        let is_image = shown[part.index].rectangle().is_some();
        if is_image && part.diagonal < SMALL_DIAGONAL * diagonal && part.flux < SMALL_FLUX * total {
            small.push(textured[part.index].owner);
            shown[part.index] = Shown::Color(part.color);
        }
    }
    small
}
