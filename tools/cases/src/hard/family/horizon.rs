//! Polygons about the horizon.

use super::super::HardCase;
use super::super::outline::{self, Place, plain, polygon};
use super::super::stream::Stream;
use arealight::LightTable;
use glam::DVec3;

/// A direction above the horizon.
pub fn upward(stream: &mut Stream) -> DVec3 {
    let direction = stream.direction();
    direction.with_z(direction.z.abs().max(1e-3))
}

/// A direction along the horizon.
pub fn level(stream: &mut Stream) -> DVec3 {
    let [x, y] = stream.circle();
    DVec3::new(x, y, 0.0)
}

pub fn above(stream: &mut Stream, _: &LightTable) -> HardCase {
    let size = stream.power(-4.0, 0.0);
    let origin = upward(stream) * stream.between(1.0, 3.0);
    let normal = stream.direction();
    // Lift the whole of it
    let place = Place::across(stream, origin, normal, size);
    let outline = plain(stream);
    let lowest = outline.iter().map(|p| (origin + place.offset(*p)).z).fold(f64::INFINITY, f64::min);
    let lift = (stream.power(-6.0, 0.0) - lowest).max(0.0);
    Place { origin: origin + DVec3::Z * lift, ..place }.polygon(&outline)
}

pub fn crossing(stream: &mut Stream, _: &LightTable) -> HardCase {
    let size = stream.power(-3.0, 3.0);
    let origin =
        level(stream) * stream.between(0.3, 3.0) + DVec3::Z * (0.5 * size * stream.between(-1.0, 1.0));
    let normal = stream.direction();
    Place::across(stream, origin, normal, size).polygon(&plain(stream))
}

pub fn touching(stream: &mut Stream, _: &LightTable) -> HardCase {
    // An upright or leaning rectangle, the lower edge or corner of which nearly touches
    let size = stream.power(-3.0, 1.0);
    let along = level(stream);
    let lean = stream.direction();
    let up = (DVec3::Z + (lean - along * lean.dot(along)) * stream.unit()).with_z(1.0);
    let corner = stream.one_in(2);
    let along = if corner { (along + DVec3::Z * stream.between(0.1, 1.0)) * size } else { along * size };
    let gap = if stream.one_in(4) { 0.0 } else { stream.sign() * stream.power(-23.0, -10.0) };
    let start = level(stream) * stream.between(0.3, 3.0) + DVec3::Z * gap;
    let up = up * size * stream.between(0.2, 1.0);
    polygon([start, start + along, start + along + up, start + up])
}

pub fn lying(stream: &mut Stream, _: &LightTable) -> HardCase {
    let place = Place::across(stream, DVec3::ZERO, DVec3::Z, 1.0);
    let center = [stream.between(-3.0, 3.0), stream.between(-3.0, 3.0)];
    let noise = if stream.one_in(3) { 0.0 } else { stream.power(-27.0, -17.0) };
    let points = plain(stream);
    let vertices = points.iter().map(|p| {
        let flat = place.offset([p[0] + center[0], p[1] + center[1]]);
        flat.with_z(noise * stream.between(-1.0, 1.0))
    });
    let case = polygon(vertices.collect::<Vec<_>>());
    // Its noise is its shape
    HardCase { flat: noise == 0.0, ..case }
}

pub fn just_above(stream: &mut Stream, _: &LightTable) -> HardCase {
    let height = stream.power(-23.0, -7.0);
    let tilt = stream.direction() * (height * 0.3);
    let normal = (DVec3::Z + tilt.with_z(0.0)).normalize_or(DVec3::Z);
    let origin = level(stream) * stream.between(0.0, 3.0) + DVec3::Z * height;
    Place::across(stream, origin, normal, 1.0).polygon(&plain(stream))
}

pub fn sliver(stream: &mut Stream, _: &LightTable) -> HardCase {
    let width = stream.power(-23.0, -10.0);
    let start = level(stream) * stream.between(0.3, 2.0);
    let near_horizon = stream.one_in(2);
    let height = if near_horizon { stream.power(-23.0, -10.0) } else { stream.between(-0.5, 1.0) };
    let along = if near_horizon {
        level(stream) + DVec3::Z * (stream.between(-1.0, 1.0) * height)
    } else {
        stream.direction()
    };
    let across = stream.direction() * width;
    let start = start + DVec3::Z * height - along * stream.unit();
    polygon([start, start + along, start + along + across, start + across])
}

pub fn concave(stream: &mut Stream, _: &LightTable) -> HardCase {
    let size = stream.power(-2.0, 3.0);
    let origin = level(stream) * stream.between(0.5, 2.0) + DVec3::Z * (size * stream.between(-0.7, 0.7));
    let normal = if stream.one_in(2) { level(stream) } else { stream.direction() };
    let outline = outline::concave(stream);
    if stream.one_in(2) {
        return Place::across(stream, origin, normal, size).polygon(&outline);
    }
    // Upright, so that the horizon cuts teeth and bays alike
    let x = DVec3::Z.cross(normal).try_normalize().unwrap_or(DVec3::X) * size;
    Place { origin, x, y: DVec3::Z * (size * stream.sign()) }.polygon(&outline)
}

pub fn many(stream: &mut Stream, _: &LightTable) -> HardCase {
    let rough = if stream.one_in(2) { 0.0 } else { stream.between(0.0, 0.9) };
    let size = stream.power(-5.0, 3.0);
    let origin = stream.direction() * stream.between(0.5, 2.0);
    let normal = stream.direction();
    let origin = origin.with_z(origin.z.abs() - 0.3);
    let outline = outline::many(stream, rough);
    Place::across(stream, origin, normal, size).polygon(&outline)
}
