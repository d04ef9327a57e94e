//! Probes: quads on the sphere over which a lobe should have the right integral.
//!
//! A table is judged by its integrals over lights, not by its densities: energy that is missing in one
//! direction and in excess nearby hurts no light larger than that. So the fit compares integrals over many
//! quads, which cost little more than densities, because they share the same nodes.

use arealight::table::mirror_frame;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

use crate::lobe::Lobe;
use crate::nodes::Node;
use crate::random::Random;

/// How many quads a texel is probed with. Twice as many lower the error by 1 %.
const COUNT: usize = 256;

/// The largest half width, of a quad at distance 1.
const LARGEST: f64 = 3.0;

/// All texels are probed alike, so that neighbours differ by the BRDF alone.
const SEED: u64 = 7;

/// A convex spherical quad, by the inner sides of its planes through the centre, in the mirror frame.
struct Probe([DVec3; 4]);

/// Lays out the probes of a texel and returns, for each, its part of every node's weight, sr: a matrix of as
/// many columns as nodes.
pub fn probe_rows(guess: &Lobe, cos_view: f64, nodes: &[Node]) -> Vec<f32> {
    let layout = Layout {
        alpha: guess.alpha,
        to_mirror: mirror_frame(cos_view).transpose(),
        normals_from_lobe: guess.inverse().transpose(),
    };
    let mut random = Random::new(SEED);
    let mut rows = Vec::with_capacity(COUNT * nodes.len());
    for i in 0..COUNT {
        let probe = layout.probe(&mut random, i);
        rows.extend(nodes.iter().map(|node| {
            let is_inside = probe.0.iter().all(|plane| plane.dot(node.direction) >= 0.0);
            if is_inside { node.weight as f32 } else { 0.0 }
        }));
    }
    rows
}

/// What probes are laid out by.
struct Layout {
    alpha: f64,
    /// From the surface frame to the mirror frame.
    to_mirror: DMat3,
    /// Takes the normals of planes from the guess's cosine space to the mirror frame.
    normals_from_lobe: DMat3,
}

impl Layout {
    /// Of eight probes three lie about the mirror direction, two anywhere above the surface and two across
    /// its horizon on the far side, from half a lobe's width to large lights. One is laid out in the guess's
    /// cosine space, because lobes are much narrower across the plane of incidence than alpha at grazing
    /// views.
    fn probe(&self, random: &mut Random, i: usize) -> Probe {
        let is_in_lobe = i % 8 == 2;
        let smallest = if is_in_lobe { 0.1 } else { 0.5 * self.alpha.min(0.2) };
        let half_width = random.between(smallest.ln(), LARGEST.ln()).exp();
        let half_height = half_width * random.between(0.3, 1.0);
        let (direction, share, turn) = (random.direction(), random.unit(), TAU * random.unit());
        let centre = match i % 4 {
            _ if is_in_lobe => DVec3::Z + direction * share,
            0 | 2 => DVec3::Z + direction * (2.0 * self.alpha.min(0.5) + 0.7 * half_width) * share,
            1 => self.to_mirror * direction.with_z(direction.z.abs()),
            _ => {
                let phi = PI * (0.5 + share);
                self.to_mirror * DVec3::new(phi.cos(), phi.sin(), 0.5 * half_width * direction.z)
            }
        };
        let probe = Probe::about(centre, half_width, half_height, turn);
        if is_in_lobe { Probe(probe.0.map(|plane| self.normals_from_lobe * plane)) } else { probe }
    }
}

impl Probe {
    /// A rectangle at distance 1 in the direction of `centre`, turned about it.
    fn about(centre: DVec3, half_width: f64, half_height: f64, turn: f64) -> Self {
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
