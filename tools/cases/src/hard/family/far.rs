//! Small and far polygons, as an anchor and offsets: their vertices have no digits left for their shape.

use super::super::HardCase;
use super::super::outline::{self, Outline, Place, plain};
use super::super::stream::Stream;
use super::horizon::{level, upward};
use arealight::LightTable;
use glam::DVec3;

/// Any outline, from a vertex of its own one time in two, as a host that anchors at the first vertex has it.
fn outline_of(stream: &mut Stream) -> Outline {
    let outline = if stream.one_in(4) { outline::concave(stream) } else { plain(stream) };
    if stream.one_in(2) {
        return outline;
    }
    let first = outline[0];
    outline.iter().map(|p| [p[0] - first[0], p[1] - first[1]]).collect()
}

/// An outline of unit size across `normal`, as far away as `origin` says.
fn anchored(stream: &mut Stream, origin: DVec3, normal: DVec3) -> HardCase {
    let outline = outline_of(stream);
    Place::across(stream, origin, normal, 1.0).anchored(&outline)
}

pub fn above(stream: &mut Stream, _: &LightTable) -> HardCase {
    let distance = stream.power(0.0, 26.6);
    let way = upward(stream);
    let normal = stream.direction();
    let origin = (way * distance).with_z((way.z * distance).max(2.1));
    anchored(stream, origin, normal)
}

pub fn crossing(stream: &mut Stream, _: &LightTable) -> HardCase {
    let distance = stream.power(0.5, 26.6);
    let origin = level(stream) * distance + DVec3::Z * stream.between(-1.0, 1.0);
    let normal = stream.direction();
    anchored(stream, origin, normal)
}

pub fn grazing(stream: &mut Stream, _: &LightTable) -> HardCase {
    let distance = stream.power(2.0, 26.6);
    let origin = level(stream) * distance + DVec3::Z * (distance * stream.power(-23.0, -7.0));
    let normal = stream.direction();
    anchored(stream, origin, normal)
}

pub fn edge_on(stream: &mut Stream, _: &LightTable) -> HardCase {
    let distance = stream.power(2.0, 26.6);
    let way = upward(stream);
    // The plane holds the point, exactly or nearly
    let (across, _) = way.any_orthonormal_pair();
    let tilt = if stream.one_in(2) { 0.0 } else { stream.power(-24.0, -8.0) };
    let normal = (across + way * tilt).normalize_or(across);
    anchored(stream, way * distance, normal)
}
