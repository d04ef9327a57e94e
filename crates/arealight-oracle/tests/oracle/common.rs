//! What the tests draw their inputs from.

use arealight_oracle::cubature::angles;
use arealight_oracle::shading::RelativeLight;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A unit direction.
pub fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, 0.0..TAU).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    })
}

/// A rotation.
pub fn rotation() -> impl Strategy<Value = DMat3> {
    (direction(), 0.0..TAU).prop_map(|(axis, angle)| DMat3::from_axis_angle(axis, angle))
}

/// An invertible matrix that stretches by at most six and may mirror.
pub fn matrix() -> impl Strategy<Value = DMat3> {
    (rotation(), rotation(), -0.9..0.9_f64, -0.9..0.9_f64, any::<bool>()).prop_map(|(u, v, a, b, mirror)| {
        let c = if mirror { -1.0 } else { 1.0 };
        u * DMat3::from_diagonal(DVec3::new(a.exp(), b.exp(), c)) * v
    })
}

/// A polygon that is star-shaped about a point, so most are concave.
#[derive(Debug, Clone)]
pub struct Star {
    /// The point.
    pub center: DVec3,
    /// The vertices.
    pub vertices: Vec<DVec3>,
}

impl Star {
    /// The same polygon with each vertex moved towards the center by its own factor.
    pub fn shrunk(&self, factors: &[f64]) -> Vec<DVec3> {
        self.vertices.iter().zip(factors).map(|(v, f)| self.center.lerp(*v, *f)).collect()
    }

    /// Distance from the origin over the largest vertex distance: small values are near contact.
    pub fn relative_distance(&self) -> f64 {
        let largest = self.vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        let pairs = self.vertices.iter().zip(self.vertices.iter().cycle().skip(1));
        let nearest =
            pairs.map(|(a, b)| distance_to_triangle([self.center, *a, *b])).fold(f64::INFINITY, f64::min);
        nearest / largest
    }
}

/// A star of up to ten vertices, of size one, its center within `reach` of the origin in each coordinate.
pub fn star(reach: f64) -> impl Strategy<Value = Star> {
    let center = prop::array::uniform3(-reach..reach).prop_map(DVec3::from_array);
    // Neighbours are less than half a turn apart, also in a triangle
    let outline = prop::collection::vec((0.2..1.0_f64, 0.0..0.45_f64), 3..10);
    (center, rotation(), outline).prop_map(|(center, rotation, outline)| {
        let step = TAU / outline.len() as f64;
        let vertex = |(i, (radius, shift)): (usize, &(f64, f64))| {
            let (sin, cos) = ((i as f64 + shift) * step).sin_cos();
            center + rotation * DVec3::new(radius * cos, radius * sin, 0.0)
        };
        Star { center, vertices: outline.iter().enumerate().map(vertex).collect() }
    })
}

/// The inside of a box around the origin: six quadrilaterals that face it.
pub fn box_around(low: DVec3, high: DVec3) -> Vec<[DVec3; 4]> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, corners) in [(low, [0, 1, 3, 2]), (high, [0, 2, 3, 1])] {
            faces.push(corners.map(|corner: usize| {
                let mut p = DVec3::ZERO;
                p[axis] = side[axis];
                p[u] = if corner & 1 == 0 { low[u] } else { high[u] };
                p[v] = if corner & 2 == 0 { low[v] } else { high[v] };
                p
            }));
        }
    }
    faces
}

/// The answer to light of unit radiance from every direction: the sum over the faces of a box about the
/// point.
pub fn from_everywhere(answer: impl FnMut(&RelativeLight) -> DVec3) -> DVec3 {
    let faces = box_around(DVec3::new(-1.0, -2.0, -0.5), DVec3::new(3.0, 0.7, 1.5)).into_iter();
    let light = |face: [DVec3; 4]| RelativeLight {
        vertices: face.to_vec(),
        radiance: DVec3::ONE,
        two_sided: false,
        ..RelativeLight::default()
    };
    let lights: Vec<RelativeLight> = faces.map(light).collect();
    lights.iter().map(answer).sum()
}

/// Well spread points of the unit square (Roberts 2018, from the plastic number).
pub fn square_points(count: usize) -> impl Iterator<Item = [f64; 2]> {
    const PLASTIC: f64 = 1.324717957244746;
    (1..=count).map(|i| {
        let i = i as f64;
        [(0.5 + i / PLASTIC).fract(), (0.5 + i / (PLASTIC * PLASTIC)).fract()]
    })
}

/// The edges of a triangle as seen through a matrix, in units of 0.3: resolves a lobe that is wide on the far
/// side of the matrix.
pub fn lengths_through(matrix: &DMat3, triangle: &[DVec3; 3]) -> [f64; 3] {
    angles(&triangle.map(|p| *matrix * p)).map(|angle| angle / 0.3)
}

/// A unit view direction in the surface frame, at `theta` from the normal.
pub fn view_at(theta: f64) -> DVec3 {
    DVec3::new(theta.sin(), 0.0, theta.cos().max(0.0))
}

/// The angle of a cosine spread evenly over the hemisphere.
pub fn view_angle() -> impl Strategy<Value = f64> {
    0.0..PI / 2.0
}

fn distance_to_triangle([a, b, c]: [DVec3; 3]) -> f64 {
    // Minimise over a fine grid of barycentric coordinates, and from there by halving steps
    let point = |u: f64, v: f64| (a + (b - a) * u + (c - a) * v).length();
    let (mut u, mut v) = (0.25, 0.25);
    let mut step = 0.25;
    while step > 1e-9 {
        let neighbours = [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step), (step, -step), (-step, step)];
        let inside = |(du, dv): &(f64, f64)| u + du >= 0.0 && v + dv >= 0.0 && u + du + v + dv <= 1.0;
        let best =
            neighbours.into_iter().filter(inside).map(|(du, dv)| (point(u + du, v + dv), u + du, v + dv));
        match best.min_by(|x, y| x.0.total_cmp(&y.0)) {
            Some((distance, nu, nv)) if distance < point(u, v) => (u, v) = (nu, nv),
            _ => step *= 0.5,
        }
    }
    point(u, v)
}
