//! Linearly transformed spherical distributions (Heitz et al. 2016, section 3): a distribution over
//! directions whose directions went through a matrix.
//!
//! With `D_o` the original distribution and `M` any invertible matrix,
//! ```text
//! w = M w_o / |M w_o|      D(w) = D_o(M^-1 w / |M^-1 w|) |det M^-1| / |M^-1 w|^3
//! ```
//! Its properties, each with the test that shows it:
//!
//! | property | test |
//! |---|---|
//! | the scale of M does not matter | `shape_is_invariant_under_scaling` |
//! | the median vector of `D_o` goes to that of `D` by M | `median_vector_is_transformed` |
//! | the integral over a region is that of `D_o` over the region transformed by M⁻¹ | `integral_over_a_region_is_kept` |
//! | it is normalised if `D_o` is | `norm_is_kept` |
//! | a rotation before an isotropic `D_o` changes nothing, one after M rotates `D` | `rotations_compose` |
//! | samples of `D_o` transformed by M are samples of `D` | `samples_follow_the_density` |

use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// A distribution over directions that can be evaluated and sampled; each integrates to one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Original {
    /// `max(0, cos) / pi` about z: a Lambert lobe.
    ClampedCosine,
    /// `1 / 4 pi` everywhere.
    UniformSphere,
    /// `1 / 2 pi` where z is not negative.
    UniformHemisphere,
}

impl Original {
    /// The density of a unit direction, 1/sr.
    pub fn evaluate(self, direction: DVec3) -> f64 {
        match self {
            Self::ClampedCosine => direction.z.max(0.0) / PI,
            Self::UniformSphere => 0.5 / TAU,
            Self::UniformHemisphere if direction.z < 0.0 => 0.0,
            Self::UniformHemisphere => 1.0 / TAU,
        }
    }

    /// Draws a unit direction; `u` in [0, 1)².
    pub fn sample(self, u: [f64; 2]) -> DVec3 {
        let z = match self {
            Self::ClampedCosine => (1.0 - u[0]).sqrt(),
            Self::UniformSphere => 1.0 - 2.0 * u[0],
            Self::UniformHemisphere => 1.0 - u[0],
        };
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = (TAU * u[1]).sin_cos();
        DVec3::new(radius * cos, radius * sin, z)
    }
}

/// A matrix that cannot be inverted makes no distribution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "matrix: its determinant is {determinant}; a linearly transformed distribution needs an invertible, \
    finite one"
)]
pub struct SingularMatrix {
    /// The determinant found.
    pub determinant: f64,
}

/// An original distribution seen through a matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransformedDistribution {
    original: Original,
    matrix: DMat3,
    inverse: DMat3,
    /// |det M⁻¹|
    volume: f64,
}

impl TransformedDistribution {
    /// The distribution of `M w_o` for `w_o` from `original`.
    ///
    /// # Errors
    /// [`SingularMatrix`] if M or its inverse is not finite.
    pub fn new(original: Original, matrix: DMat3) -> Result<Self, SingularMatrix> {
        // Shape invariance: bring the entries near one, so that the determinant stays in range
        let largest = matrix.to_cols_array().iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        let matrix = matrix * largest.recip();
        let determinant = matrix.determinant();
        let inverse = matrix.inverse();
        if determinant == 0.0 || !matrix.is_finite() || !inverse.is_finite() {
            return Err(SingularMatrix { determinant });
        }
        Ok(Self { original, matrix, inverse, volume: inverse.determinant().abs() })
    }

    /// The distribution whose inverse transform M⁻¹ is given, as a table stores it.
    ///
    /// # Errors
    /// [`SingularMatrix`] if M⁻¹ or its inverse is not finite.
    pub fn from_inverse(original: Original, inverse: DMat3) -> Result<Self, SingularMatrix> {
        let swapped = Self::new(original, inverse)?;
        let volume = swapped.matrix.determinant().abs();
        Ok(Self { original, matrix: swapped.inverse, inverse: swapped.matrix, volume })
    }

    /// M at some scale.
    pub fn matrix(&self) -> &DMat3 {
        &self.matrix
    }

    /// M⁻¹ at the scale that inverts [`Self::matrix`].
    pub fn inverse(&self) -> &DMat3 {
        &self.inverse
    }

    /// A direction of the original distribution as a direction of this one; both of unit length.
    pub fn transform(&self, original: DVec3) -> DVec3 {
        (self.matrix * original).normalize_or(DVec3::Z)
    }

    /// A direction of this distribution as a direction of the original one; both of unit length.
    pub fn transform_back(&self, direction: DVec3) -> DVec3 {
        (self.inverse * direction).normalize_or(DVec3::Z)
    }

    /// How much original solid angle a solid angle about `direction` holds: `|det M^-1| / |M^-1 w|^3`.
    pub fn jacobian(&self, direction: DVec3) -> f64 {
        let length = (self.inverse * direction).length();
        self.volume / (length * length * length)
    }

    /// The density of a unit direction, 1/sr. It is also the density of [`Self::sample`].
    pub fn evaluate(&self, direction: DVec3) -> f64 {
        self.original.evaluate(self.transform_back(direction)) * self.jacobian(direction)
    }

    /// Draws a unit direction; `u` in [0, 1)².
    pub fn sample(&self, u: [f64; 2]) -> DVec3 {
        self.transform(self.original.sample(u))
    }
}
