//! The integral of an image times a linearly transformed cosine over a polygon.
//!
//! Between the texels' centres an image is bilinear, and away from the shading point so is nearly everything
//! else: every such piece is halved until it is small for its distance, and integrated by a rule that is
//! exact for polynomials. What a horizon or the outline cuts becomes triangles.

use super::shown::{ShownImage, box_coordinate, clip, for_each_piece, point, transformed};
use crate::cubature::DEGREE_8;
use arealight::TextureMap;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// The signed integral of a linearly transformed cosine times the image over a planar polygon, a channel.
/// With a white image it is [`crate::polygon::transformed_form_factor`].
///
/// `inverse` is M⁻¹; `vertices` and the image are in the surface frame. It is clipped at the horizon of
/// cosine space, and with `both_horizons` at the surface's too. Non-finite input and an image without area
/// give zero.
///
/// The error is below 1e-5 of the integral of a white image as bright as the brightest texel, and mostly
/// 1e-7.
pub fn transformed_image_integral(
    inverse: &DMat3,
    vertices: &[DVec3],
    image: &ShownImage,
    both_horizons: bool,
) -> DVec3 {
    let outline: Vec<DVec2> = vertices.iter().map(|vertex| box_coordinate(&image.map, *vertex)).collect();
    let lobe = ImagePlane::new(transformed(&image.map, inverse));
    if !outline.iter().all(|place| place.is_finite()) || !lobe.density(DVec2::ZERO).is_finite() {
        return DVec3::ZERO;
    }
    // Heights above the horizons as functions of box coordinates
    let mut horizons = vec![heights(&lobe.map)];
    if both_horizons {
        horizons.push(heights(&image.map));
    }
    let mut sum = DVec3::ZERO;
    let mut cut = Vec::new();
    for_each_piece(image, &outline, |piece, part, sign| {
        cut.clear();
        cut.extend_from_slice(part);
        for horizon in &horizons {
            clip(&mut cut, *horizon);
        }
        let color = |place| piece.color(place);
        let whole = piece.corners();
        if cut == whole {
            sum += lobe.rectangle(piece.low, piece.high, &color, DEPTH) * sign;
        } else if cut.len() >= 3 {
            for pair in cut[1..].windows(2) {
                let triangle = [cut[0], pair[0], pair[1]].map(|place| place.extend(0.0));
                sum += lobe.triangle(&triangle, &color, DEPTH) * sign;
            }
        }
    });
    let mirrored = if inverse.determinant() < 0.0 { -1.0 } else { 1.0 };
    if sum.is_finite() { sum * mirrored } else { DVec3::ZERO }
}

/// Halvings after which a piece is taken as it is, fifty of each axis.
const DEPTH: u32 = 100;

/// A piece is small if its diagonal is at most this share of its distance: the rule of four points then has
/// an error of 1e-4 of the piece, and few pieces are that near.
const SMALL_RECTANGLE: f64 = 0.2;

/// The same for triangles, with a rule of degree 8.
const SMALL_TRIANGLE: f64 = 0.5;

/// Where Gauss's rule of two points looks on [-1, 1].
const GAUSS_2: f64 = 0.5773502691896258;

/// z over box coordinates.
fn heights(map: &TextureMap) -> DVec3 {
    DVec3::new(map.axis_u.z, map.axis_v.z, map.corner.z)
}

/// A plane as the cosine lobe about z sees it from the origin.
struct ImagePlane {
    map: TextureMap,
    /// -n·p / pi, the same for every point.
    factor: f64,
}

impl ImagePlane {
    fn new(map: TextureMap) -> Self {
        Self { map, factor: -map.axis_u.cross(map.axis_v).dot(map.corner) / PI }
    }

    /// The cosine over pi times solid angle, an area in box coordinates.
    fn density(&self, place: DVec2) -> f64 {
        let p = point(&self.map, place);
        let squared = p.length_squared();
        if squared > 0.0 { self.factor * p.z.max(0.0) / (squared * squared) } else { 0.0 }
    }

    fn rectangle(&self, low: DVec2, high: DVec2, color: &impl Fn(DVec2) -> DVec3, depth: u32) -> DVec3 {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let (u, v) = (self.map.axis_u * half.x, self.map.axis_v * half.y);
        let radius = (u + v).length().max((u - v).length());
        let distance = point(&self.map, middle).length();
        if 2.0 * radius > SMALL_RECTANGLE * distance && depth > 0 {
            // Halve the longer side
            let across = if u.length_squared() > v.length_squared() { DVec2::X } else { DVec2::Y };
            let (first, second) = (high - half * across, low + half * across);
            return self.rectangle(low, first, color, depth - 1)
                + self.rectangle(second, high, color, depth - 1);
        }
        // Gauss's rule of two points on each axis
        let signs = [(-GAUSS_2, -GAUSS_2), (GAUSS_2, -GAUSS_2), (-GAUSS_2, GAUSS_2), (GAUSS_2, GAUSS_2)];
        let sample = |(x, y): (f64, f64)| {
            let place = middle + half * DVec2::new(x, y);
            color(place) * self.density(place)
        };
        signs.map(sample).iter().sum::<DVec3>() * (half.x * half.y)
    }

    /// Corners with z = 0.
    fn triangle(&self, corners: &[DVec3; 3], color: &impl Fn(DVec2) -> DVec3, depth: u32) -> DVec3 {
        let points = corners.map(|corner| point(&self.map, corner.truncate()));
        let sides = [0, 1, 2].map(|i| points[i].distance(points[(i + 1) % 3]));
        let longest = (1..3).fold(0, |best, i| if sides[i] > sides[best] { i } else { best });
        let distance = points.iter().map(|p| p.length()).fold(f64::INFINITY, f64::min);
        if sides[longest] > SMALL_TRIANGLE * distance && depth > 0 {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
            let middle = (a + b) * 0.5;
            return self.triangle(&[a, middle, c], color, depth - 1)
                + self.triangle(&[middle, b, c], color, depth - 1);
        }
        let [a, b, c] = corners.map(DVec3::truncate);
        let area = 0.5 * (b - a).perp_dot(c - a).abs();
        let sample = |rule: &crate::cubature::TrianglePoint| {
            let place = rule.interpolate(corners).truncate();
            color(place) * (rule.weight * self.density(place))
        };
        DEGREE_8.iter().map(sample).sum::<DVec3>() * area
    }
}
