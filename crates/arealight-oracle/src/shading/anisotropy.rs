//! The fitted lobes of an anisotropic GGX distribution, in float64: the twin of `lobes/anisotropy.glsl`.
//!
//! Microsurfaces are stretches of one another, so that the visible normals of an anisotropic lobe at a view
//! are those of an isotropic one at a stretched view (Heitz 2018). The matrix of the isotropic lobe, taken
//! there, is brought over by the linear map that takes the directions which nine of these normals reflect in
//! the one to those of the other, by least squares.

use super::fitted_sample;
use crate::ggx::AnisotropicGgx;
use arealight::table::mirror_frame;
use arealight::{LightTable, Quality, TableSample};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::FRAC_1_SQRT_2;

/// How much of the larger roughness the smaller one has at least: an aspect of alphas of 400.
const LEAST_ROUGHNESS_RATIO: f64 = 0.05;

/// How many of the visible normals are mapped onto each other.
const NORMALS: usize = 9;

/// How far from the middle of their disk the others are.
const NORMAL_RADIUS: f64 = 0.75;

/// The squared sine of a view at which the alpha of Schlick's albedo is half that of the view's azimuth.
const AZIMUTH_START: f64 = 0.02;

/// What the table or the formula makes of an anisotropic lobe, `view` being in the surface frame.
pub(super) fn sample(
    quality: Quality,
    table: &LightTable,
    lobe: &AnisotropicGgx,
    view: DVec3,
) -> TableSample {
    let lookup = |alpha: f64, cos_view: f64| fitted_sample(quality, table, alpha, cos_view);
    let most = lobe.alpha.max_element();
    let alpha = lobe.alpha.max(DVec2::splat(most * LEAST_ROUGHNESS_RATIO * LEAST_ROUGHNESS_RATIO));
    let ratio = alpha.min_element() / most;
    let seen = View { azimuth: DVec2::new(lobe.axis.x, -lobe.axis.y), sin: view.x, cos: view.z };
    // Matrices, from isotropic lobes between the two alphas
    let mean = most * ratio.sqrt();
    let mapped = |reference: f64| {
        let own = seen.stretched(alpha / reference);
        let scale = DMat3::from_diagonal(DVec3::new(mean, mean, 1.0));
        let map = scale * reflected_map(&seen, &own, alpha, reference, mean) * scale.inverse();
        let back = map * mirror_frame(seen.cos).transpose() * (mean / reference);
        let inverse = move |inverse: DMat3| inverse * mirror_frame(own.cos) * back;
        (lookup(reference, own.cos), inverse)
    };
    let (lobe, from_lobe) = mapped(most * ratio.sqrt().sqrt());
    let (schlick_lobe, from_schlick_lobe) = mapped(mean);
    // Two lobes come over by the same map
    let pairs = lobe.pairs.map(|(inverses, shares)| (inverses.map(from_lobe), shares));
    // Albedos, from the lobe of the mean square at the view that it sees, and from that of the view's azimuth
    let square = |weights: DVec2| ((weights * alpha * alpha).element_sum() / weights.element_sum()).sqrt();
    let root = square(DVec2::ONE);
    let albedo = lookup(root, seen.stretched(alpha / root).cos).albedo;
    let spread = seen.azimuth * seen.azimuth * (seen.sin * seen.sin) + DVec2::splat(0.5 * AZIMUTH_START);
    let schlick = lookup(square(spread), seen.cos).schlick.min(albedo);
    TableSample {
        inverse: from_lobe(lobe.inverse),
        schlick_inverse: from_schlick_lobe(schlick_lobe.schlick_inverse),
        albedo,
        schlick,
        pairs,
    }
}

/// A direction to the viewer, in the axes of a distribution: `(sin azimuth, cos)`.
#[derive(Debug, Clone, Copy)]
struct View {
    azimuth: DVec2,
    sin: f64,
    cos: f64,
}

impl View {
    /// The view of a surface whose axes are longer by this.
    fn stretched(&self, by: DVec2) -> Self {
        let flat = self.azimuth * by;
        let length = (self.sin * self.sin * flat.length_squared() + self.cos * self.cos).sqrt();
        Self {
            azimuth: flat.normalize_or(DVec2::X),
            sin: self.sin * flat.length() / length,
            cos: self.cos / length,
        }
    }

    /// The slopes of one of the visible normals of alpha 1: at (`across`, `along`) on the disk that they are
    /// seen on, seen from here.
    fn visible_slopes(&self, across: f64, along: f64) -> DVec2 {
        let share = 0.5 + 0.5 * self.cos;
        let along = (1.0 - share) * (1.0 - across * across).sqrt() + share * along;
        let out = (1.0 - across * across - along * along).max(0.0).sqrt();
        let flat = self.azimuth * (out * self.sin - along * self.cos) + self.azimuth.perp() * across;
        flat / (along * self.sin + out * self.cos).max(1e-4)
    }

    /// The direction that a surface of these slopes reflects, in the frame of the mirror direction: across it
    /// within the plane of incidence, and perpendicular to that, both over `scale`; and along it.
    fn reflected(&self, slopes: DVec2, scale: f64) -> DVec3 {
        let (along, across) = (self.azimuth.dot(slopes), self.azimuth.perp_dot(slopes));
        let weight = 2.0 / (1.0 + slopes.length_squared());
        DVec3::new(
            weight * (along - self.cos * self.sin * across * across) / scale,
            weight * (self.cos + self.sin * along) * across / scale,
            1.0 - weight * (along * along + self.cos * self.cos * across * across),
        )
    }
}

/// The map of directions that a surface of these alphas reflects to those of an isotropic one, whose view is
/// `own`, each in its mirror frame. Its determinant is above 0: the normals lie symmetrically about the plane
/// of incidence.
fn reflected_map(view: &View, own: &View, alpha: DVec2, reference: f64, scale: f64) -> DMat3 {
    let (mut both, mut rest) = (DMat3::ZERO, DMat3::ZERO);
    for (across, along) in (0..NORMALS).map(visible_normal) {
        // The visible normals of alpha 1 at a view that is stretched by both alphas
        let slopes = view.stretched(alpha).visible_slopes(across, along);
        let (given, isotropic) =
            (view.reflected(alpha * slopes, scale), own.reflected(reference * slopes, scale));
        both += outer(given, isotropic);
        rest += outer(isotropic - given, isotropic);
    }
    // Exactly one where the alphas are equal
    DMat3::IDENTITY + rest * both.inverse()
}

/// In the middle of the disk, and eight around it: fewer, or in squares, would turn with the view's azimuth,
/// so that what is reflected would jump at the normal.
fn visible_normal(index: usize) -> (f64, f64) {
    let (near, far) = (NORMAL_RADIUS * FRAC_1_SQRT_2, NORMAL_RADIUS);
    [
        (0.0, 0.0),
        (far, 0.0),
        (near, near),
        (0.0, far),
        (-near, near),
        (-far, 0.0),
        (-near, -near),
        (0.0, -far),
        (near, -near),
    ][index]
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
