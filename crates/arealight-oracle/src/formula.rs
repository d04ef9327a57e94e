//! A BRDF without a table: polynomials for the matrices, rational functions for the albedos.
//!
//! In the mirror frame the entries are smooth enough for a cubic in alpha and the view's cosine. The
//! coefficients are those of a weighted linear least squares on a fitted table, where each texel's four
//! entries are weighted by the curvature of the fit's own loss about it: what the integrals hardly depend on
//! is free to be wrong. That makes the difference: with equal weights a cubic has five times the table's
//! error, with these 1.3 times.
//!
//! Mean error of [`Formula::GGX`] over the fit's report: 5.5e-4 at F0 = 0.02, 6.6e-4 at 0.04, 2.85e-3 at
//! 1. The albedo is within 0.014 of the truth, that of Schlick's weight within 0.05 (2e-3 on average).

use arealight::table::{TableSample, clamped_cosine, clamped_roughness, inverse_from_texel};

/// The coefficients of a BRDF's lobes and albedos. `arealight-fit` makes them, [`Formula::GGX`] is built in.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    /// `q00`, `q02 / alpha`, `q20` and `q22` of the lobe without Fresnel term, see [`arealight::table`]: a
    /// row for each monomial `1, y, y², y³, x, xy, xy², x², x²y, x³` of `x = alpha` and the view's cosine
    /// `y`.
    pub lobe: [[f64; 4]; 10],
    /// The same of the lobe of Schlick's weight.
    pub schlick_lobe: [[f64; 4]; 10],
    /// What the albedo of narrow lobes lacks where the view grazes, by `x = cos_view / alpha`:
    /// `d0 x / (1 + d1 x + d2 x² + d3 x³)`.
    pub dip: [f64; 4],
    /// Albedo and dip together, in the monomials of `lobe`, above ...
    pub albedo: [f64; 10],
    /// ... `1, y, y², x, xy, x²` of the same x and y.
    pub albedo_denominator: [f64; 6],
    /// The albedo of Schlick's weight over `(1 - y)⁴`: `1, y, y², x, xy, x²` of `x = roughness` and the
    /// view's cosine y, above ...
    pub schlick: [f64; 6],
    /// ... the same monomials.
    pub schlick_denominator: [f64; 6],
}

/// The smallest cosine of a view that a formula is asked for, 0.06 degrees above the horizon: exactly on it a
/// lobe degenerates.
pub const MIN_COS_VIEW: f64 = 1e-3;

/// Looks GGX's lobes up by [`Formula::GGX`]. The twin of `arealight_formula_sample`.
pub fn ggx_formula(roughness: f64, cos_view: f64) -> TableSample {
    Formula::GGX.lookup(roughness, cos_view)
}

impl Formula {
    /// Looks the lobes up: what [`arealight::LightTable::lookup`] answers, with the same ranges.
    ///
    /// Entries and albedos of a view below [`MIN_COS_VIEW`] are those at it; the mirror frame is the view's
    /// own.
    pub fn lookup(&self, roughness: f64, cos_view: f64) -> TableSample {
        let (roughness, cos_view) = (clamped_roughness(roughness), clamped_cosine(cos_view));
        let (alpha, cosine) = (roughness * roughness, cos_view.max(MIN_COS_VIEW));
        let inverse = |coefficients: &[[f64; 4]; 10]| {
            let texel: [f64; 4] = std::array::from_fn(|i| cubic(&coefficients.map(|c| c[i]), alpha, cosine));
            // The second entry vanishes with alpha
            let texel = [texel[0], alpha * texel[1], texel[2], texel[3]];
            inverse_from_texel(texel, alpha, cos_view)
        };
        let albedo = self.albedo(alpha, cosine);
        TableSample {
            inverse: inverse(&self.lobe),
            schlick_inverse: inverse(&self.schlick_lobe),
            albedo,
            schlick: self.schlick(roughness, cosine).clamp(0.0, albedo),
            pairs: None,
        }
    }

    /// The albedo is a smooth function less a dip where the cosine of the view is about alpha, which depends
    /// on their ratio alone when both are small.
    fn albedo(&self, alpha: f64, cos_view: f64) -> f64 {
        let below = quadratic(&self.albedo_denominator, alpha, cos_view);
        (cubic(&self.albedo, alpha, cos_view) / below - self.albedo_dip(alpha, cos_view)).clamp(0.0, 1.0)
    }

    /// See [`Formula::dip`], the field.
    pub fn albedo_dip(&self, alpha: f64, cos_view: f64) -> f64 {
        let [d0, d1, d2, d3] = self.dip;
        let x = cos_view / alpha;
        d0 * x / (1.0 + x * (d1 + x * (d2 + x * d3)))
    }

    fn schlick(&self, roughness: f64, cos_view: f64) -> f64 {
        let above = quadratic(&self.schlick, roughness, cos_view);
        let below = quadratic(&self.schlick_denominator, roughness, cos_view);
        (1.0 - cos_view).powi(4) * above / below
    }
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

impl Formula {
    /// GGX, of the built-in table.
    #[rustfmt::skip] // As `arealight fit --formula` prints it
    pub const GGX: Self = Formula {
        lobe: [
            [0.000106325, -0.000173203, 0.798099, 0.000232858],
            [0.888402, 0.222552, -0.393555, 1.87183],
            [0.220809, -0.397026, 1.45862, 0.185503],
            [-0.103141, 0.163481, -1.9671, -0.0510923],
            [1.09508, -3.4479, 2.86341, 1.2254],
            [-0.733183, 2.53892, -3.27869, -0.885117],
            [-0.576453, 1.27706, 1.01414, -0.134502],
            [-0.337482, 1.59226, -1.65787, -2.2709],
            [1.13581, -3.18903, 1.80408, 0.0346131],
            [-0.881539, 1.05982, -0.469445, 1.09021],
        ],
        schlick_lobe: [
            [-0.000282478, 0.000141569, 0.467144, -0.000226082],
            [1.04274, -0.0829637, -1.34949, 1.93784],
            [-1.06173, 1.99868, 2.24879, -1.23212],
            [0.492686, -2.4267, -1.84783, 0.938178],
            [0.884266, -2.44054, -0.974075, 1.39883],
            [-0.897777, 7.21233, 0.0692134, -4.4182],
            [-2.02054, 0.36344, -2.2511, 1.74401],
            [4.58582, 1.83591, 3.41195, -1.20383],
            [1.97124, -7.14248, 3.25115, 2.74964],
            [-4.64039, 0.445416, -2.83275, 0.110711],
        ],
        dip: [0.221252, 0.616968, 0.113125, 0.307204],
        albedo: [1.00702, 0.796598, -0.91299, -0.0582205, -2.09435, 1.09497, 0.552113, 1.85779, -1.29729,
            -0.188006],
        albedo_denominator: [1.0, 0.825253, -0.988757, -1.97244, 1.39829, 1.56562],
        schlick: [0.952818, -0.163929, 2.15186, -1.16622, -1.24023, 0.645299],
        schlick_denominator: [1.0, -0.356565, 8.81801, -0.653119, -11.4369, 8.4293],
    };
}

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
