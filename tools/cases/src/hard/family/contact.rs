//! Polygons that the point is on, or nearly: on the surface, on an edge, in the plane.

use super::super::HardCase;
use super::super::outline::{self, Place, convex, plain, polygon};
use super::super::stream::Stream;
use super::horizon::level;
use arealight::LightTable;
use glam::DVec3;

/// A place whose plane passes the point at `gap`, and where the outline's point `at` is nearest.
fn passing(stream: &mut Stream, gap: f64, at: [f64; 2]) -> Place {
    let normal = stream.direction();
    let place = Place::across(stream, DVec3::ZERO, normal, 1.0);
    Place { origin: normal * gap - place.offset(at), ..place }
}

/// A point inside of a convex outline.
fn inside(stream: &mut Stream, outline: &[[f64; 2]]) -> [f64; 2] {
    let weights: Vec<f64> = outline.iter().map(|_| stream.between(0.05, 1.0)).collect();
    let total: f64 = weights.iter().sum();
    let mean = |axis: usize| outline.iter().zip(&weights).map(|(p, w)| p[axis] * w).sum::<f64>() / total;
    [mean(0), mean(1)]
}

/// A point outside of every outline.
fn outside(stream: &mut Stream) -> [f64; 2] {
    let distance = stream.between(1.5, 6.0);
    stream.circle().map(|c| c * distance)
}

pub fn edge_on(stream: &mut Stream, _: &LightTable) -> HardCase {
    let (gap, at) = (stream.power(-30.0, -10.0), outside(stream));
    let place = passing(stream, gap, at);
    place.polygon(&plain(stream))
}

pub fn plane_outside(stream: &mut Stream, _: &LightTable) -> HardCase {
    let at = outside(stream);
    passing(stream, 0.0, at).polygon(&plain(stream))
}

pub fn plane_inside(stream: &mut Stream, _: &LightTable) -> HardCase {
    let outline = plain(stream);
    let at = inside(stream, &outline);
    passing(stream, 0.0, at).polygon(&outline)
}

pub fn plane_concave(stream: &mut Stream, _: &LightTable) -> HardCase {
    // In the gap of a U, or anywhere about a star or comb; in a plane of any tilt, or as flat as rounding has
    // it
    let (outline, at) = match stream.below(3) {
        0 => (outline::u(stream), [0.0, stream.between(0.0, 0.9)]),
        1 => (outline::star(stream), stream.circle().map(|c| c * 0.9)),
        _ => (outline::comb(stream), [stream.between(-0.9, 0.9), stream.between(0.5, 1.2)]),
    };
    let gap = if stream.one_in(2) { 0.0 } else { stream.power(-30.0, -20.0) };
    passing(stream, gap, at).polygon(&outline)
}

pub fn interior(stream: &mut Stream, _: &LightTable) -> HardCase {
    let outline = plain(stream);
    let at = inside(stream, &outline);
    let gap = stream.power(-20.0, -10.0);
    passing(stream, gap, at).polygon(&outline)
}

/// The place at `part` of an outline's edge, or at its vertex for 0.
fn on_outline(stream: &mut Stream, outline: &[[f64; 2]], part: f64) -> [f64; 2] {
    let i = stream.below(outline.len());
    let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
    [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * part)
}

/// A place that passes the point at a distance of 1e-6 to 1e-3 in any direction from `at`.
fn around(stream: &mut Stream, at: [f64; 2]) -> Place {
    let place = passing(stream, 0.0, at);
    let gap = stream.direction() * stream.power(-20.0, -10.0);
    Place { origin: place.origin + gap, ..place }
}

pub fn edge(stream: &mut Stream, _: &LightTable) -> HardCase {
    let outline = if stream.one_in(4) { outline::concave(stream) } else { plain(stream) };
    let part = stream.between(0.1, 0.9);
    let at = on_outline(stream, &outline, part);
    around(stream, at).polygon(&outline)
}

pub fn vertex(stream: &mut Stream, _: &LightTable) -> HardCase {
    let outline = if stream.one_in(4) { outline::concave(stream) } else { plain(stream) };
    let at = on_outline(stream, &outline, 0.0);
    around(stream, at).polygon(&outline)
}

pub fn antipodal(stream: &mut Stream, _: &LightTable) -> HardCase {
    // Two ends opposite, of equal or different distance; the rest anywhere on one side of that line
    let way = if stream.one_in(4) { level(stream) } else { stream.direction() };
    let (near, far) = (stream.power(-3.0, 3.0), stream.power(-3.0, 3.0));
    let gap = if stream.one_in(4) { 0.0 } else { stream.power(-33.0, -20.0) };
    let miss = stream.direction() * gap;
    let (x, y) = way.any_orthonormal_pair();
    let [cos, sin] = stream.circle();
    let side = (x * cos + y * sin) * stream.power(-2.0, 2.0);
    let vertices = [
        miss - way * near,
        miss + way * far,
        miss + way * (far * stream.unit()) + side,
        miss - way * (near * stream.unit()) + side,
    ];
    let count = 3 + stream.below(2);
    polygon(vertices.into_iter().take(count))
}

pub fn huge(stream: &mut Stream, _: &LightTable) -> HardCase {
    let outline = convex(stream);
    let at = inside(stream, &outline);
    let size = stream.power(4.0, 23.0);
    let normal = stream.direction();
    let place = Place::across(stream, DVec3::ZERO, normal, size);
    Place { origin: normal - place.offset(at), ..place }.polygon(&outline)
}
