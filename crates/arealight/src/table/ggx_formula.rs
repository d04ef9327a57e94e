//! GGX without a table: polynomials for the matrices, rational functions for the albedos.
//!
//! In the mirror frame the entries are smooth enough for a cubic in alpha and the view's cosine. The coefficients are
//! those of a weighted linear least squares on a fitted table of 64² nodes, where each texel's four entries are weighted
//! by the curvature of the fit's own loss about it: what the integrals hardly depend on is free to be wrong. That makes
//! the difference: with equal weights a cubic errs ten times as much as the table, with these 1.3 times.
//!
//! Mean error over the fit's report, by F0 in one integral: 5.6e-4 at F0 = 0.02, 6.6e-4 at 0.04, 2.8e-3 at 1. The
//! albedos are within 0.02 at roughness 0.1 to 1 (2.5e-3 on average), or at grazing views 0.06.

use super::{TableSample, inverse_from_texel};

/// Looks GGX's lobes up by formula: what [`super::LightTable::lookup`] answers, with the same ranges. The twin of
/// `arealight_ggx_formula`.
pub fn ggx_formula(roughness: f64, cos_view: f64) -> TableSample {
    let roughness = roughness.clamp(crate::MIN_ALPHA.sqrt(), 1.0).max(crate::MIN_ALPHA.sqrt());
    let alpha = roughness * roughness;
    // Exactly at the horizon a lobe degenerates
    let cos_view = cos_view.clamp(MIN_COS_VIEW, 1.0).max(MIN_COS_VIEW);
    let inverse = |coefficients: &[[f64; 4]; 10]| {
        let texel: [f64; 4] = std::array::from_fn(|i| cubic(&coefficients.map(|c| c[i]), alpha, cos_view));
        // The second entry vanishes with alpha
        inverse_from_texel([texel[0], alpha * texel[1], texel[2], texel[3]], alpha, cos_view)
    };
    let albedo = albedo(alpha, cos_view);
    TableSample {
        inverse: inverse(&LOBE),
        schlick_inverse: inverse(&SCHLICK_LOBE),
        albedo,
        schlick: schlick(roughness, cos_view).clamp(0.0, albedo),
    }
}

/// The smallest cosine of a view, 0.06 degrees above the horizon.
const MIN_COS_VIEW: f64 = 1e-3;

/// The albedo is a smooth function less a dip where the cosine of the view is about alpha, which depends on their ratio
/// alone when both are small.
fn albedo(alpha: f64, cos_view: f64) -> f64 {
    let x = cos_view / alpha;
    let dip = DIP[0] * x / (1.0 + x * (DIP[1] + x * (DIP[2] + x * DIP[3])));
    let below = quadratic(&ALBEDO_DENOMINATOR, alpha, cos_view);
    (cubic(&ALBEDO, alpha, cos_view) / below - dip).clamp(0.0, 1.0)
}

fn schlick(roughness: f64, cos_view: f64) -> f64 {
    let above = quadratic(&SCHLICK, roughness, cos_view);
    (1.0 - cos_view).powi(4) * above / quadratic(&SCHLICK_DENOMINATOR, roughness, cos_view)
}

/// `1, y, y², y³, x, xy, xy², x², x²y, x³`, by Horner's rule in y, then in x.
fn cubic(c: &[f64; 10], x: f64, y: f64) -> f64 {
    let row0 = c[0] + y * (c[1] + y * (c[2] + y * c[3]));
    let row1 = c[4] + y * (c[5] + y * c[6]);
    let row2 = c[7] + y * c[8];
    row0 + x * (row1 + x * (row2 + x * c[9]))
}

/// `1, y, y², x, xy, x²`.
fn quadratic(c: &[f64; 6], x: f64, y: f64) -> f64 {
    c[0] + y * (c[1] + y * c[2]) + x * (c[3] + y * c[4] + x * c[5])
}

/// `q00`, `q02 / alpha`, `q20` and `q22` of the lobe without Fresnel term, a row for each monomial of [`cubic`] in alpha
/// and the view's cosine.
const LOBE: [[f64; 4]; 10] = [
    [0.000208185, -0.000357268, 0.847603, 0.000442197],
    [0.863343, 0.300362, -0.568083, 1.86426],
    [0.267836, -0.547272, 1.64022, 0.175268],
    [-0.125489, 0.238821, -2.02371, -0.0343593],
    [1.13592, -3.57427, 2.77632, 1.20391],
    [-0.751959, 2.55084, -3.0032, -0.778451],
    [-0.594391, 1.33803, 0.830453, -0.206423],
    [-0.413304, 1.88106, -1.68195, -2.25337],
    [1.18472, -3.26917, 1.76513, 9.12659e-06],
    [-0.848915, 0.893267, -0.418137, 1.08725],
];

/// The same of the lobe of Schlick's weight.
const SCHLICK_LOBE: [[f64; 4]; 10] = [
    [-0.000251015, 0.000154419, 0.483564, -0.000145279],
    [0.994205, -0.0572778, -1.52605, 1.90477],
    [-0.806275, 2.13348, 2.37127, -1.14068],
    [0.231446, -2.52845, -1.90898, 0.861577],
    [0.887256, -2.40694, -0.612362, 1.2002],
    [-1.05736, 6.46723, 0.541213, -4.04298],
    [-1.64997, 0.308933, -1.87343, 1.60517],
    [4.01902, 2.15639, 2.01293, -0.809703],
    [1.83948, -6.27037, 2.37346, 2.40874],
    [-3.97768, 0.0164601, -1.68578, -0.0870311],
];

/// Of the ratio of the view's cosine and alpha.
const DIP: [f64; 4] = [0.221894, 0.634493, 0.0981867, 0.312601];

/// In alpha and the view's cosine.
const ALBEDO: [f64; 10] =
    [1.00785, 0.764216, -0.921387, -0.0527046, -2.10146, 1.06593, 0.562891, 1.87547, -1.26255, -0.209049];
const ALBEDO_DENOMINATOR: [f64; 6] = [1.0, 0.785297, -0.982744, -1.96326, 1.3694, 1.55049];

/// In roughness and the view's cosine.
const SCHLICK: [f64; 6] = [0.962838, -0.317412, 2.36461, -0.979833, -1.17303, 0.467225];
const SCHLICK_DENOMINATOR: [f64; 6] = [1.0, -0.527734, 9.63047, -0.452232, -12.5225, 9.19475];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lobe_is_one_at_every_reflectance() {
        for i in 0..=200 {
            for j in 0..=400 {
                // Dense towards the horizon, where lobes degenerate
                let (roughness, cos_view) = (f64::from(i) / 200.0, (f64::from(j) / 400.0).powi(2));
                let sample = ggx_formula(roughness, cos_view);
                for f0 in [0.0, 0.02, 0.1, 0.5, 1.0] {
                    let inverse = sample.inverse_by_f0(f0, 1.0);
                    assert!(inverse.determinant() > 0.0, "{roughness} {cos_view} {f0}: {sample:?}");
                }
                assert!((0.2..=1.0).contains(&sample.albedo), "{roughness} {cos_view}: {sample:?}");
                assert!(
                    (0.0..=sample.albedo).contains(&sample.schlick),
                    "{roughness} {cos_view}: {sample:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_outside_is_clamped() {
        assert_eq!(ggx_formula(7.0, 2.0), ggx_formula(1.0, 1.0));
        assert_eq!(ggx_formula(0.5, -1.0), ggx_formula(0.5, 0.0));
        assert!(ggx_formula(f64::NAN, f64::NAN).inverse.is_finite());
    }
}
