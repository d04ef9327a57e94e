//! Light that the specular lobe's facets reflect more than once, in float64: the twin of
//! `arealight_rescattered`.

use crate::material::Surface;
use arealight::TableSample;
use glam::DVec3;

/// What it adds to a surface's lobes.
pub(super) struct Rescattered {
    /// What the specular lobe is multiplied with, a channel.
    pub scale: DVec3,
    /// What is added to the diffuse lobe's albedo, a channel.
    pub diffuse: DVec3,
}

/// How much of what is missing has the specular lobe's shape; the rest is as light from a Lambert lobe.
const SPECULAR_PART: f64 = 0.4;

impl Rescattered {
    /// Of a surface whose lobe has this sample; nothing where it is left out.
    pub fn new(surface: &Surface, sample: &TableSample) -> Self {
        if !surface.multiple_scattering {
            return Self { scale: DVec3::ONE, diffuse: DVec3::ZERO };
        }
        let alpha = match surface.anisotropy {
            None => surface.alpha,
            Some(along) => (0.5 * (along.alpha * along.alpha + surface.alpha * surface.alpha)).sqrt(),
        };
        let albedo = sample.albedo.clamp(1e-3, 1.0);
        let roughness = alpha.sqrt();
        let missing = alpha
            * (-0.0064
                + roughness * (0.2948 + roughness * (3.1516 + roughness * (-4.5023 + roughness * 1.6532))));
        let missing = missing.clamp(0.0, 1.0);
        let fresnel = surface.f0 + (DVec3::splat(surface.f90) - surface.f0) / 21.0;
        let more = fresnel * fresnel * (1.0 - missing) / (DVec3::ONE - fresnel * missing);
        Self {
            scale: DVec3::ONE + SPECULAR_PART * (1.0 - albedo) / albedo * surface.f0,
            diffuse: (1.0 - SPECULAR_PART) * (1.0 - albedo) * more,
        }
    }
}
