//! Polygons in the cosine space of a GGX lobe: the table's transforms are as anisotropic as their alpha is
//! low.

use super::super::HardCase;
use super::super::outline::{Place, plain};
use super::super::stream::Stream;
use super::horizon::upward;
use arealight::LightTable;
use glam::{DMat3, DVec3};

/// A polygon multiplied in float64, then rounded: what a perfect multiplication would hand on.
fn transformed(inverse: &DMat3, place: Place, outline: &[[f64; 2]]) -> HardCase {
    Place { origin: *inverse * place.origin, x: *inverse * place.x, y: *inverse * place.y }.polygon(outline)
}

/// The direction that a view reflects to, the view lying in the xz plane.
fn mirror(cos_view: f64) -> DVec3 {
    DVec3::new(-((1.0 - cos_view) * (1.0 + cos_view)).max(0.0).sqrt(), 0.0, cos_view)
}

/// A place about the mirror direction that the lobe of `alpha` sees: a few lobes wide, or much wider.
fn seen(stream: &mut Stream, mirror: DVec3, alpha: f64) -> Place {
    let spread = alpha * stream.power(-1.0, 3.0);
    let way = (mirror + stream.direction() * spread).normalize_or(mirror);
    let distance = stream.between(0.5, 4.0);
    let size = if stream.one_in(2) { stream.between(0.1, 2.0) } else { distance * spread };
    let normal = stream.direction();
    Place::across(stream, way * distance, normal, size)
}

pub fn low(stream: &mut Stream, table: &LightTable) -> HardCase {
    // Perceptual roughness 0.01 to 0.1
    let roughness = stream.power(-6.64, -3.32).clamp(0.01, 0.1);
    let cos_view = stream.between(0.02, 1.0);
    let place = seen(stream, mirror(cos_view), roughness * roughness);
    transformed(&table.lookup(roughness, cos_view).inverse, place, &plain(stream))
}

pub fn low_far(stream: &mut Stream, table: &LightTable) -> HardCase {
    let roughness = stream.power(-6.64, -3.32).clamp(0.01, 0.1);
    let cos_view = stream.between(0.02, 1.0);
    let (alpha, mirror) = (roughness * roughness, mirror(cos_view));
    let way = (mirror + stream.direction() * (alpha * stream.power(-1.0, 3.0))).normalize_or(mirror);
    let (normal, distance) = (stream.direction(), stream.power(4.0, 26.6));
    let place = Place::across(stream, way * distance, normal, 1.0);
    let inverse = table.lookup(roughness, cos_view).inverse;
    // Anchor and offsets go through the matrix apart
    Place { origin: inverse * place.origin, x: inverse * place.x, y: inverse * place.y }
        .anchored(&plain(stream))
}

pub fn grazing(stream: &mut Stream, table: &LightTable) -> HardCase {
    let roughness = stream.between(0.01, 1.0);
    // cos 88 degrees is 0.035
    let cos_view = if stream.one_in(8) { 0.0 } else { stream.power(-20.0, -4.85) };
    let alpha = roughness * roughness;
    let place = if stream.one_in(2) {
        seen(stream, mirror(cos_view), alpha)
    } else {
        let origin = upward(stream) * stream.between(0.5, 3.0);
        let (normal, size) = (stream.direction(), stream.power(-3.0, 2.0));
        Place::across(stream, origin, normal, size)
    };
    transformed(&table.lookup(roughness, cos_view).inverse, place, &plain(stream))
}
