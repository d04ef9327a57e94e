//! Henyey and Greenstein's phase function, and the sum of distributions with closed forms that stands for it.
//!
//! A point in a medium is a surface without a horizon. About the direction in which light goes on to the
//! viewer the phase function is
//!
//! ```text
//! p(mu; g)  ~  u / (4 pi)  +  sum of w_k D(+mu; s_k)  -  |w_b| D(-mu; s_b),    u = 1 - sum of all w
//! ```
//!
//! of the uniform distribution, whose integral is a light's solid angle, one or two clamped cosines that are
//! narrowed by `diag(s, s, 1)`, and one backwards, whose weight is negative. All three integrals over a light
//! are closed forms, or as good as those of surfaces. At g = 0 nothing but u = 1 is left.
//!
//! # Accuracy
//! The integral over the sphere of the difference, of phase functions that integrate to 1: [`PhaseFit::HG`]
//! has .0008 at |g| = .1, .006 at .3, .009 at .5, .006 at .7, .005 at .8, .01 at .9, .03 at .95: half of
//! it is the most that any light is off, of its radiance.

use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// The largest size of g that is shaded; a larger one counts as this.
pub const MAX_ANISOTROPY: f64 = 0.95;

/// Henyey and Greenstein's phase function, 1/sr, of the cosine `mu` between the directions before and after;
/// it integrates to 1 over the sphere. `g`, the mean cosine, is in (-1, 1).
pub fn henyey_greenstein(g: f64, mu: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * mu).powf(1.5))
}

/// The density of a clamped cosine under `diag(stretch, stretch, 1)`, 1/sr, at the cosine `mu` to its axis.
pub fn stretched_cosine(stretch: f64, mu: f64) -> f64 {
    let square = (1.0 - mu * mu) / (stretch * stretch) + mu * mu;
    mu.max(0.0) / (PI * stretch * stretch * square * square)
}

/// The coefficients of a phase function's lobes. `arealight_fit::phase` makes them, [`PhaseFit::HG`] is built
/// in.
#[derive(Debug, Clone, PartialEq)]
pub struct PhaseFit {
    /// From this |g| on there is a second lobe forwards, and the second piece holds.
    pub knee: f64,
    /// Below the knee, in powers of |g|; above it, in those of |g| - knee.
    pub pieces: [PhasePiece; 2],
}

/// Polynomials of the three lobes: the first forwards, the second and narrower, the one backwards; a power a
/// row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhasePiece {
    /// What the cosines are stretched by across their axes.
    pub stretch: [[f64; 3]; 4],
    /// Their weights.
    pub weight: [[f64; 3]; 5],
}

/// The lobes of one g, of either sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseLobes {
    /// The weight of the uniform part.
    pub uniform: f64,
    /// Of each lobe.
    pub stretch: [f64; 3],
    /// Of each lobe; the last one's axis is the opposite.
    pub weight: [f64; 3],
    /// The axis is where light goes on to, or its opposite.
    pub turned: bool,
}

impl PhaseFit {
    /// Henyey and Greenstein's.
    #[rustfmt::skip] // As `arealight fit --phase` prints it
    pub const HG: Self = PhaseFit {
        knee: 0.6,
        pieces: [
            PhasePiece {
                stretch: [
                    [0.998048, 0.3, 1.00083],
                    [-0.375246, 0.0, 0.410717],
                    [-0.716996, 0.0, -0.664347],
                    [0.105049, 0.0, 0.440699],
                ],
                weight: [
                    [0.0, 0.0, 0.0],
                    [0.732296, 0.0, -0.767405],
                    [1.6591, 0.0, 1.64278],
                    [-1.72435, 0.0, -0.750854],
                    [0.156885, 0.0, -0.285696],
                ],
            },
            PhasePiece {
                stretch: [
                    [0.537472, 0.358721, 1.10329],
                    [-0.811065, 0.00573923, 0.13935],
                    [3.63719, -3.96415, -1.54567],
                    [-10.3322, 4.43207, 5.53119],
                ],
                weight: [
                    [0.684526, 0.0, -0.0682529],
                    [0.378191, 0.697644, 0.206883],
                    [-30.9886, 30.2938, 0.0260293],
                    [138.699, -139.395, -0.791751],
                    [-183.978, 185.452, 1.15065],
                ],
            },
        ],
    };

    /// The lobes of a g; of one outside of ±[`MAX_ANISOTROPY`] those there, of NaN those of 0.
    pub fn lobes(&self, g: f64) -> PhaseLobes {
        let size = if g.is_nan() { 0.0 } else { g.abs().min(MAX_ANISOTROPY) };
        let above = size > self.knee;
        let x = if above { size - self.knee } else { size };
        let piece = &self.pieces[usize::from(above)];
        let weight = polynomial(&piece.weight, x);
        PhaseLobes {
            uniform: 1.0 - weight.iter().sum::<f64>(),
            stretch: polynomial(&piece.stretch, x),
            weight,
            turned: g < 0.0,
        }
    }
}

fn polynomial<const N: usize>(rows: &[[f64; 3]; N], x: f64) -> [f64; 3] {
    rows.iter().rev().fold([0.0; 3], |sum, row| std::array::from_fn(|k| sum[k] * x + row[k]))
}

impl PhaseLobes {
    /// What stands for the phase function, 1/sr.
    pub fn density(&self, mu: f64) -> f64 {
        let mu = if self.turned { -mu } else { mu };
        let lobes = (0..3).map(|k| self.weight[k] * stretched_cosine(self.stretch[k], [mu, mu, -mu][k]));
        self.uniform / (4.0 * PI) + lobes.sum::<f64>()
    }

    /// The sum over a light, z being where light goes on to, whose solid angle and whose form factor in a
    /// linear space are given.
    pub(crate) fn sum(&self, solid_angle: f64, form_factor: impl Fn(&DMat3) -> f64) -> f64 {
        let lobe = |k: usize| {
            let (across, along) = (1.0 / self.stretch[k], if (k == 2) == self.turned { 1.0 } else { -1.0 });
            // Turned about x, not mirrored
            let space = DMat3::from_diagonal(DVec3::new(across, along * across, along));
            if self.weight[k] == 0.0 { 0.0 } else { self.weight[k] * form_factor(&space) }
        };
        (self.uniform * solid_angle / (4.0 * PI) + (0..3).map(lobe).sum::<f64>()).max(0.0)
    }
}
