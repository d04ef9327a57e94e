//! What the matrices of a table aim at.

use crate::brdf::Magnitude;

/// The reflectance for which the second matrix of [`Aim::ByF0`] is fitted instead of 0.
///
/// Seen from near the normal the lobe of Schlick's weight alone is a faint, hollow ring that no transformed
/// cosine follows: its entries run to 1e4 and jump from node to node. With this much of the other lobe in it
/// they stay below 10 and run smoothly into the other's, and the lobe moves only where it holds next to
/// nothing.
const SCHLICK_F0: f64 = 5e-4;

/// The lobes that are fitted, each scaled to integrate to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Aim {
    /// Two matrices: the lobe without Fresnel term, and that of Schlick's weight. A material has one between
    /// them.
    #[default]
    ByF0,
    /// One matrix for every reflectance: a blend of the lobes at some, pairs of a reflectance at normal
    /// incidence, in [0, 1], and its weight, above 0.
    ///
    /// A transformed cosine cannot follow both the lobe without Fresnel term (`f0 = 1`) and that of a
    /// dielectric, which leans towards grazing light. One reflectance alone fits just that material; a blend
    /// spreads the error.
    ///
    /// Each share is `weight * albedo(f0)^0.65`. An exponent of 1 would minimise the sum of the squared
    /// errors over albedo, one of 2 that of the squared errors themselves.
    Blend(Vec<(f64, f64)>),
}

impl Aim {
    /// One matrix for metals and common dielectrics: as good as the table published with Heitz et al. 2016
    /// for dielectrics, better for metals.
    pub fn one_for_all() -> Self {
        Self::Blend(vec![(0.04, 3.55), (1.0, 1.0)])
    }

    /// How many matrices it takes.
    pub fn matrices(&self) -> usize {
        match self {
            Self::ByF0 => 2,
            Self::Blend(_) => 1,
        }
    }

    /// How much of `f` and of `f * schlick` the lobe of each matrix holds: it is
    /// `f * (share[0] + share[1] * schlick)`, and integrates to 1.
    pub fn shares(&self, magnitude: Magnitude) -> Vec<[f64; 2]> {
        let of_reflectance = |f0: f64| [f0, 1.0 - f0].map(|part| part / magnitude.at(f0));
        match self {
            Self::ByF0 => vec![of_reflectance(1.0), of_reflectance(SCHLICK_F0)],
            Self::Blend(reflectances) => {
                let weights = reflectances.iter().map(|&(f0, weight)| weight * magnitude.at(f0).powf(0.65));
                let total: f64 = weights.clone().sum();
                let blend = reflectances.iter().zip(weights).fold([0.0; 2], |sum, (&(f0, _), weight)| {
                    let [lobe, schlick] = of_reflectance(f0).map(|part| part * weight / total);
                    [sum[0] + lobe, sum[1] + schlick]
                });
                vec![blend]
            }
        }
    }
}
