//! The quadrature of one texel: fixed nodes at which the BRDF is evaluated once.

use glam::DVec3;

use crate::brdf::{Brdf, view_direction};
use crate::lobe::Lobe;
use arealight::table::mirror_frame;

/// Nodes of one technique: `RADIAL * AZIMUTH` directions.
const RADIAL: usize = 20;
const AZIMUTH: usize = 24;

/// One direction of the upper half `y >= 0`, which stands for both.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// In the mirror frame.
    pub direction: DVec3,
    /// Solid angle that it stands for, sr.
    pub weight: f64,
    /// `f cos`, 1/sr.
    pub value: f64,
    /// `f cos` times Schlick's weight, 1/sr.
    pub schlick: f64,
}

/// The nodes of a texel: those above the surface, then those below.
pub struct Nodes {
    /// All of them.
    pub all: Vec<Node>,
    /// How many of them lie above the surface.
    pub above: usize,
}

/// What is fitted at one node of the table.
pub struct Texel<'a> {
    /// The BRDF.
    pub brdf: &'a dyn Brdf,
    /// Its alpha.
    pub alpha: f64,
    /// The view.
    pub cos_view: f64,
}

impl Texel<'_> {
    /// Lays nodes over the sphere: half of them drawn from the BRDF, half from `guess`, weighted by the
    /// balance heuristic, so that both a peak that the guess misses and energy that the guess puts where the
    /// BRDF has none are seen. Directions of no usable value are left out.
    pub fn nodes(&self, guess: &Lobe) -> Nodes {
        let view = view_direction(self.cos_view);
        let to_surface = mirror_frame(self.cos_view);
        let to_mirror = to_surface.transpose();
        let mut all = Vec::with_capacity(2 * RADIAL * AZIMUTH);
        let mut below = Vec::new();
        for i in 0..RADIAL {
            // Crowd nodes at the centre and at the rim of the unit square's first axis
            let t = (i as f64 + 0.5) / RADIAL as f64;
            let u0 = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            let crowding = 30.0 * t * t * (1.0 - t) * (1.0 - t) / (RADIAL * AZIMUTH) as f64;
            for j in 0..AZIMUTH {
                // A quarter step off, so that mirrored about the plane of incidence nodes interleave
                let u1 = (j as f64 + 0.25) / AZIMUTH as f64;
                let of_brdf = self.brdf.sample(self.alpha, view, [u0, u1]);
                let of_guess = to_surface * guess.sample([u0, u1]);
                for (light, is_of_brdf) in [(of_brdf, true), (of_guess, false)] {
                    // Below the surface the density of the BRDF's samples is zero by definition
                    if is_of_brdf && light.z <= 0.0 {
                        continue;
                    }
                    let direction = to_mirror * light;
                    let density = self.brdf.density(self.alpha, view, light) + guess.density(direction);
                    let value = self.brdf.evaluate(self.alpha, view, light);
                    let weight = crowding / density;
                    if weight.is_finite() && weight > 0.0 && value.is_finite() && value >= 0.0 {
                        let schlick = value * self.brdf.schlick_weight(view, light);
                        let half_space = if light.z > 0.0 { &mut all } else { &mut below };
                        half_space.push(Node { direction, weight, value, schlick });
                    }
                }
            }
        }
        let above = all.len();
        all.append(&mut below);
        Nodes { all, above }
    }
}
