//! Random walks on a GGX microsurface: what its facets reflect once, and what they reflect more than once.
//!
//! Source: Heitz, Hanika, d'Eon and Dachsbacher 2016, *Multiple-Scattering Microfacet BSDFs with the Smith
//! Model*.

use crate::ggx::Ggx;
use glam::DVec3;

/// A walk ends after so many reflections: what is left then is below 1e-6 of what came.
const MOST_REFLECTIONS: u32 = 64;

/// A rough surface of facets with Schlick's Fresnel term.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microsurface {
    /// The distribution of the facets' normals.
    pub ggx: Ggx,
    /// Reflectance at normal incidence, a channel.
    pub f0: DVec3,
    /// Reflectance at grazing incidence.
    pub f90: f64,
}

/// Where a walk has left the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    /// Unit, of the surface frame, above the surface.
    pub direction: DVec3,
    /// What is left of the light, a channel.
    pub weight: DVec3,
    /// How many facets reflected it, at least 1.
    pub reflections: u32,
}

impl Microsurface {
    /// A walk from the viewer: `view` is a unit vector of the surface frame, above the surface; `random`
    /// gives numbers in [0, 1). The mean of `weight` times a light's radiance towards the surface from
    /// `direction` is the radiance that the surface sends to the viewer. `None` where the walk did not come
    /// out again.
    pub fn walk(&self, view: DVec3, mut random: impl FnMut() -> f64) -> Option<Walk> {
        // Heights are uniform in [-1, 1]: what a walk finds does not depend on their distribution
        let mut height = 1.0;
        let mut direction = -view;
        let mut weight = DVec3::ONE;
        for reflections in 0..MOST_REFLECTIONS {
            match self.next_height(direction, height, random()) {
                None => return (reflections > 0).then_some(Walk { direction, weight, reflections }),
                Some(next) => height = next,
            }
            // A facet that is seen from where the light came
            let towards = -direction;
            let half = self.ggx.sample_visible_normal(towards, [random(), random()]);
            let cosine = towards.dot(half).clamp(0.0, 1.0);
            direction = (half * (2.0 * towards.dot(half)) - towards).normalize_or_zero();
            weight *= self.f0 + (DVec3::splat(self.f90) - self.f0) * (1.0 - cosine).powi(5);
        }
        None
    }

    /// The height at which a ray of this direction from a height meets a facet next; `None` where it leaves
    /// the surface.
    fn next_height(&self, direction: DVec3, height: f64, u: f64) -> Option<f64> {
        if direction.z > 0.999_999 {
            return None;
        }
        let below = 0.5 * (height + 1.0);
        if direction.z < -0.999_999 {
            return Some(2.0 * u * below - 1.0);
        }
        if direction.z.abs() < 1e-6 {
            return Some(height);
        }
        let lambda = self.lambda(direction);
        let escapes = below.powf(lambda);
        let meets = direction.z < 0.0 || u <= 1.0 - escapes;
        meets.then(|| (2.0 * below / (1.0 - u).powf(1.0 / lambda) - 1.0).clamp(-1.0, 1.0))
    }

    /// Smith's Λ, below 0 for directions into the surface.
    fn lambda(&self, direction: DVec3) -> f64 {
        let slope = self.ggx.alpha * direction.truncate().length() / direction.z;
        0.5 * (slope.signum() * (1.0 + slope * slope).sqrt() - 1.0)
    }
}
