//! A light with a profile: its rings between levels, each with the profile's mean over it.

use crate::polygon::{clip_by, transformed_form_factor, vector_form_factor};
use arealight::Profile;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;

/// Corners of the polygon that stands for a level's disk, of its area: what they differ in is 1e-4 of what it
/// sends.
const CORNERS: u32 = 256;

/// What a transformed cosine gets through a profile, signed. `vertices` are what is seen of the light,
/// convex, `visible` what counts of that, both from the shading point. The float64 twin of
/// `lights/shaped.glsl`, but for its disks, which are finer here.
/// `azimuth` is where the profile's begins.
pub(super) fn profiled(
    (profile, azimuth): (&Profile, DVec3),
    vertices: &[DVec3],
    visible: &[DVec3],
    inverse: &DMat3,
) -> f64 {
    let Some(normal) = normal_of(vertices) else { return 0.0 };
    let foot = normal * normal.dot(vertices[0]);
    let height = foot.length_squared();
    let (nearest, farthest) = range(vertices, normal, foot);
    let places = profile.places();
    let place_at = |side: f64| profile.place(&places, (height / (side + height).max(1e-300)).sqrt());
    let (low, high) = (place_at(nearest), place_at(farthest));
    if low.x >= 1.0 {
        return 0.0;
    }
    let (back, determinant) = (inverse.inverse(), inverse.determinant().abs());
    let toward = (vertices.iter().sum::<DVec3>() / vertices.len() as f64 - foot).normalize_or_zero();
    let apart = |vertex: &DVec3| 1.0 - (vertex - foot).normalize_or_zero().dot(toward);
    let wide = vertices.iter().map(apart).fold(0.0, f64::max);
    // A ring's mean of the profile, about the mean direction of what the lobe sees of it
    let mean = |from: DVec3, to: DVec3, vector: DVec3| {
        let axis = vector.normalize_or_zero();
        let cosine = (1.0 - vector.length()).max(0.0).sqrt();
        let round = cosine + cosine * cosine;
        let seen = 3.0 * round * axis.z * axis + DVec3::Z * (2.0 - round);
        let direction = back * seen;
        let (mut low, mut high, mut about) = (from, to, 1.0);
        if direction != DVec3::ZERO && direction.is_finite() {
            let half_tangent = |square: f64| square.sqrt() / (1.0 + (1.0 - square).sqrt());
            let [first, last] =
                [from, to].map(|place| half_tangent((place.x / profile.scale()).clamp(0.0, 1.0)));
            let cosine = normal.dot(direction) / direction.length();
            let apart = half_tangent((1.0 - cosine * cosine).max(0.0));
            let middle = apart.clamp(first, last.max(first));
            let shrunk = (seen.length() / direction.length()).powi(3) / determinant;
            let width = shrunk.sqrt() * (0.25 + 0.25 * middle * middle);
            let ends = [(middle - width).max(first), (middle + width).min(last)];
            let narrow = 0.5 * (1.0 - width / (last - first).max(1e-30)).max(0.0);
            let ends = [
                ends[0] + narrow * (middle + width - ends[1]),
                ends[1] + narrow * (middle - width - ends[0]),
            ];
            let at = |tangent: f64| profile.place(&places, cosine_of(tangent));
            low = if ends[0] > first { at(ends[0]) } else { from };
            high = if ends[1] < last { at(ends[1]) } else { to };
            let sine = 2.0 * middle / (1.0 + middle * middle);
            let (widest, seen) = (0.2 * wide, 0.25 * shrunk / (sine * sine).max(1e-30));
            let near = (apart / middle.max(1e-30)).min(1.0);
            let gathered = (-widest * seen / (widest + seen)).exp() * near;
            let turn = turn_of(normal, azimuth, direction);
            about = profile.azimuth_part(cosine_of(0.5 * (ends[0] + ends[1])), turn, gathered);
        }
        let range = high.x - low.x;
        about * if range > 1e-3 { (high.z - low.z) / range } else { 0.5 * (low.y + high.y) }
    };
    let factor = |part: &[DVec3]| transformed_form_factor(inverse, part);
    let vector = |part: &[DVec3]| {
        let transformed: Vec<DVec3> = part.iter().map(|vertex| *inverse * *vertex).collect();
        vector_form_factor(&transformed)
    };
    let (mut sum, mut from) = (0.0, low);
    let mut within = (0.0, DVec3::ZERO);
    for cosine in profile.levels() {
        let square = height * (1.0 - cosine * cosine) / (cosine * cosine);
        if square <= nearest || square >= farthest {
            continue;
        }
        let to = profile.place(&places, *cosine);
        let part = in_disk(visible, normal, foot, square);
        let part = (factor(&part), vector(&part));
        sum += mean(from, to, part.1 - within.1) * (part.0 - within.0);
        (within, from) = (part, to);
    }
    sum + mean(from, high, vector(visible) - within.1) * (factor(visible) - within.0)
}

/// The factor of the profile in a direction, on the side that the light is seen from.
pub(super) fn factor_in(profile: &Profile, azimuth: DVec3, vertices: &[DVec3], direction: DVec3) -> f64 {
    normal_of(vertices).map_or(0.0, |normal| {
        let cosine = normal.dot(direction) / direction.length();
        profile.factor_toward(cosine.abs(), turn_of(normal, azimuth, direction).to_angle())
    })
}

/// Cosine and sine of the azimuth at which a light sends what comes from a direction: counter-clockwise seen
/// from behind.
fn turn_of(normal: DVec3, azimuth: DVec3, direction: DVec3) -> DVec2 {
    -DVec2::new(azimuth.dot(direction), azimuth.cross(normal).dot(direction)).normalize_or(DVec2::NEG_X)
}

/// The cosine of an angle by the tangent of its half.
fn cosine_of(tangent: f64) -> f64 {
    (1.0 - tangent * tangent) / (1.0 + tangent * tangent)
}

pub(super) fn normal_of(vertices: &[DVec3]) -> Option<DVec3> {
    let anchor = *vertices.first()?;
    let pairs = vertices[1..].windows(2);
    pairs.map(|pair| (pair[0] - anchor).cross(pair[1] - anchor)).sum::<DVec3>().try_normalize()
}

/// The squared distances of the nearest and the farthest point of a convex outline from a foot in its plane.
fn range(vertices: &[DVec3], normal: DVec3, foot: DVec3) -> (f64, f64) {
    let (mut nearest, mut farthest, mut is_within) = (f64::INFINITY, 0.0_f64, true);
    for (a, b) in vertices.iter().zip(vertices.iter().cycle().skip(1)) {
        let (a, b) = (*a - foot, *b - foot);
        let along = b - a;
        let part = (-a.dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        nearest = nearest.min((a + along * part).length_squared());
        farthest = farthest.max(b.length_squared());
        // Where an outline was cut twice at one place, the way between is rounding
        is_within &= normal.dot(a.cross(b)) >= -1e-12 * a.length() * b.length();
    }
    (if is_within { 0.0 } else { nearest }, farthest)
}

/// What of a convex outline is within a disk of its plane about a point, of this squared radius.
fn in_disk(outline: &[DVec3], normal: DVec3, center: DVec3, square: f64) -> Vec<DVec3> {
    let (u, v) = normal.any_orthonormal_pair();
    let step = TAU / f64::from(CORNERS);
    // Of a regular polygon of the disk's area: the distance of its sides
    let side = (square * step / step.sin()).sqrt() * (0.5 * step).cos();
    let mut left = outline.to_vec();
    for corner in 0..CORNERS {
        let (sin, cos) = (f64::from(corner) * step).sin_cos();
        let out = u * cos + v * sin;
        left = clip_by(left, |point| side - out.dot(point - center));
    }
    left
}
