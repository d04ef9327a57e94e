//! Random quads, views and roughnesses on which a table is judged.

use glam::DVec3;
use std::f64::consts::PI;

use crate::random::Random;

/// Where the lights of a family lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// About the mirror direction of the view.
    Mirror,
    /// Anywhere above the surface.
    Random,
    /// Through the plane of the surface.
    Horizon,
}

impl Family {
    /// All of them, in the order in which they are drawn.
    pub const ALL: [Self; 3] = [Self::Mirror, Self::Random, Self::Horizon];
}

/// One case: a quad of unit radiance, a view and a roughness.
#[derive(Debug, Clone, PartialEq)]
pub struct Quad {
    /// Its family.
    pub family: Family,
    /// Of a report [0.1, 1], near a mirror [0.01, 0.15].
    pub roughness: f64,
    /// Of an angle in [0°, 89°].
    pub cos_view: f64,
    /// In the surface frame, relative to the shading point, its front towards it.
    pub vertices: [DVec3; 4],
}

/// Draws `count` quads, a third of each family. The same seed gives the same quads everywhere.
pub fn random_quads(count: usize, seed: u64) -> Vec<Quad> {
    let mut random = Random::new(seed);
    (0..count).map(|i| random_quad(&mut random, Family::ALL[i % 3])).collect()
}

/// Draws `count` quads for lobes that are nearly a mirror's: roughness 0.01 to 0.15, 1 to 30 lobe widths
/// (alpha) wide, near the mirror direction. The same seed gives the same quads everywhere.
pub fn near_mirror_quads(count: usize, seed: u64) -> Vec<Quad> {
    let mut random = Random::new(seed);
    (0..count).map(|_| near_mirror_quad(&mut random)).collect()
}

fn near_mirror_quad(random: &mut Random) -> Quad {
    let roughness = random.between(0.01_f64.ln(), 0.15_f64.ln()).exp();
    let theta = random.between(0.0, 89.0_f64.to_radians());
    let alpha = roughness * roughness;
    let half_width = 0.5 * alpha * random.between(0.0, 30.0_f64.ln()).exp();
    let half_height = half_width * random.between(0.3, 1.0);
    let mirror = DVec3::new(-theta.sin(), 0.0, theta.cos());
    let jitter = random.direction() * (half_width + alpha) * random.unit();
    let centre = (mirror + jitter).normalize_or(DVec3::Z);
    let tangent = centre.cross(random.direction()).normalize_or(centre.any_orthonormal_vector());
    let vertices = rectangle(centre, tangent * half_width, tangent.cross(centre) * half_height);
    Quad { family: Family::Mirror, roughness, cos_view: theta.cos(), vertices }
}

fn random_quad(random: &mut Random, family: Family) -> Quad {
    let roughness = random.between(0.1, 1.0);
    let theta = random.between(0.0, 89.0_f64.to_radians());
    // Choose a size, then a distance at which the quad keeps off the shading point
    let half_width = random.between(0.1_f64.ln(), 2.0_f64.ln()).exp();
    let half_height = half_width * random.between(0.3, 1.0);
    let distance = random.between(0.3, 2.0);
    let direction = match family {
        Family::Mirror => {
            let mirror = DVec3::new(-theta.sin(), 0.0, theta.cos());
            let spread = roughness * roughness;
            let jitter = random.direction() * spread * random.unit();
            let aimed = (mirror + jitter).normalize_or(DVec3::Z);
            aimed.with_z(aimed.z.abs())
        }
        Family::Random => {
            let direction = random.direction();
            direction.with_z(direction.z.abs())
        }
        Family::Horizon => {
            let phi = PI * random.between(0.5, 1.5);
            let height = 0.5 * random.between(-1.0, 1.0) * half_height.min(1.0);
            DVec3::new(phi.cos(), phi.sin(), height).normalize_or(DVec3::X)
        }
    };
    // Face the shading point, tilted at random by up to about 60°
    let normal = (-direction + 0.9 * random.direction() * random.unit()).normalize_or(DVec3::Z);
    let tangent = normal.cross(random.direction()).normalize_or(normal.any_orthonormal_vector());
    let (u, v) = (tangent * half_width, normal.cross(tangent) * half_height);
    let vertices = rectangle(direction * distance, u, v);
    Quad { family, roughness, cos_view: theta.cos(), vertices }
}

/// A rectangle from its centre and half axes, its front towards the shading point.
fn rectangle(centre: DVec3, u: DVec3, v: DVec3) -> [DVec3; 4] {
    let mut vertices = [centre - u - v, centre + u - v, centre + u + v, centre - u + v];
    // The front is the right-hand side of the vertex order
    if u.cross(v).dot(centre) > 0.0 {
        vertices.reverse();
    }
    vertices
}
