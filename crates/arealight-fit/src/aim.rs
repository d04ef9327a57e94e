//! What one matrix aims at, where one serves every Fresnel reflectance.

use crate::brdf::Magnitude;

/// The lobe that is fitted: a blend of the BRDF's lobes at some reflectances, each scaled to integrate to 1.
///
/// A transformed cosine cannot follow both the lobe without Fresnel term (`f0 = 1`) and that of a dielectric,
/// which leans towards grazing light. One reflectance alone fits just that material; a blend spreads the error.
///
/// Each share is `weight * albedo(f0)^0.65`. An exponent of 1 would minimise the sum of the squared errors
/// over albedo, one of 2 that of the squared errors themselves. Exponent and default weights were chosen by
/// [`crate::report`]: the mean error lies below that of the published table at every reflectance from 0.02 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Aim {
    /// Pairs of a reflectance at normal incidence, in [0, 1], and its weight, above 0.
    pub reflectances: Vec<(f64, f64)>,
}

impl Default for Aim {
    /// Metals and common dielectrics.
    fn default() -> Self {
        Self { reflectances: vec![(0.04, 3.55), (1.0, 1.0)] }
    }
}

impl Aim {
    /// How much of `f` and of `f * schlick` the blend holds: it is `f * (share[0] + share[1] * schlick)`,
    /// and integrates to 1.
    pub fn shares(&self, magnitude: Magnitude) -> [f64; 2] {
        let weight = |f0: f64, weight: f64| weight * magnitude.at(f0).powf(0.65);
        let total: f64 = self.reflectances.iter().map(|&(f0, w)| weight(f0, w)).sum();
        self.reflectances.iter().fold([0.0; 2], |shares, &(f0, w)| {
            let scale = weight(f0, w) / (total * magnitude.at(f0));
            [shares[0] + scale * f0, shares[1] + scale * (1.0 - f0)]
        })
    }
}
