//! Probes: quads on the sphere over which a lobe should have the right integral.
//!
//! A table is judged by its integrals over lights, not by its densities: energy that is missing in one
//! direction and in excess nearby hurts no light larger than that. So the fit compares integrals over many
//! quads, which cost little more than densities, because they share the same nodes.

use arealight::table::mirror_frame;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

use crate::nodes::Node;
use crate::random::Random;

/// How many quads a texel is probed with. Twice as many lower the error by 1 %.
const COUNT: usize = 256;

/// All texels are probed alike, so that neighbours differ by the BRDF alone.
const SEED: u64 = 7;

/// A convex spherical quad, by the inner sides of its planes through the centre, in the mirror frame.
struct Probe([DVec3; 4]);

/// Lays out the probes of a texel and returns, for each, its part of every node's weight, sr: a matrix of as
/// many columns as nodes.
pub fn probe_rows(alpha: f64, cos_view: f64, nodes: &[Node]) -> Vec<f32> {
    let to_mirror = mirror_frame(cos_view).transpose();
    let mut random = Random::new(SEED);
    let mut rows = Vec::with_capacity(COUNT * nodes.len());
    for i in 0..COUNT {
        let probe = Probe::draw(&mut random, i, alpha, &to_mirror);
        rows.extend(nodes.iter().map(|node| {
            let is_inside = probe.0.iter().all(|plane| plane.dot(node.direction) >= 0.0);
            if is_inside { node.weight as f32 } else { 0.0 }
        }));
    }
    rows
}

impl Probe {
    /// Half of the probes lie about the mirror direction, a quarter anywhere above the surface, a quarter
    /// across its horizon on the far side; from half a lobe's width to large lights.
    fn draw(random: &mut Random, i: usize, alpha: f64, to_mirror: &DMat3) -> Self {
        let smallest = 0.5 * alpha.min(0.2);
        let half_width = random.between(smallest.ln(), 1.5_f64.ln()).exp();
        let half_height = half_width * random.between(0.3, 1.0);
        let (direction, share, turn) = (random.direction(), random.unit(), TAU * random.unit());
        let centre = match i % 4 {
            0 | 2 => DVec3::Z + direction * (2.0 * alpha.min(0.5) + 0.7 * half_width) * share,
            1 => *to_mirror * direction.with_z(direction.z.abs()),
            _ => {
                let phi = PI * (0.5 + share);
                *to_mirror * DVec3::new(phi.cos(), phi.sin(), 0.5 * half_width * direction.z)
            }
        };
        let centre = centre.normalize_or(DVec3::Z);
        // Lay the corners around the centre
        let (first, second) = centre.any_orthonormal_pair();
        let (sin, cos) = turn.sin_cos();
        let u = (first * cos + second * sin) * half_width;
        let v = (second * cos - first * sin) * half_height;
        let corners = [centre - u - v, centre + u - v, centre + u + v, centre - u + v];
        Self(std::array::from_fn(|k| {
            let plane = corners[k].cross(corners[(k + 1) % 4]);
            if plane.dot(centre) < 0.0 { -plane } else { plane }
        }))
    }
}
