//! What can be fitted: a BRDF as the fitter sees it, and GGX.

use arealight_oracle::ggx::Ggx;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

use crate::quadrature::gauss_legendre;

/// A BRDF of one parameter, its alpha, that reflects about the plane of incidence.
///
/// Directions are unit vectors in the surface frame (z is the normal). The view lies in the xz plane with
/// `x >= 0`. A BRDF comes in two parts, so that Schlick's Fresnel term can be put in afterwards:
/// `f0 * f + (1 - f0) * f * schlick`.
pub trait Brdf: Sync {
    /// What a table calls it, for example `ggx-correlated-smith`.
    fn name(&self) -> &str;

    /// `f cos theta_light` without a Fresnel term, 1/sr, for a light anywhere on the sphere.
    fn evaluate(&self, alpha: f64, view: DVec3, light: DVec3) -> f64;

    /// Schlick's weight `(1 - cos theta_vh)^5` of a pair of directions, or what this BRDF has for it, in
    /// [0, 1].
    fn schlick_weight(&self, view: DVec3, light: DVec3) -> f64 {
        Ggx::schlick_weight(view, light)
    }

    /// A light direction drawn for `u` in [0, 1)²; `u[1]` turns once around the lobe. It may lie below the
    /// surface.
    fn sample(&self, alpha: f64, view: DVec3, u: [f64; 2]) -> DVec3;

    /// The density of [`Brdf::sample`] in solid angle, 1/sr; zero below the surface.
    fn density(&self, alpha: f64, view: DVec3, light: DVec3) -> f64;

    /// The two albedos of an alpha and a view, which may lie in the surface, to about 1e-7.
    fn magnitude(&self, alpha: f64, cos_view: f64) -> Magnitude;

    /// Whether its albedos are smooth enough for a table towards the horizon with
    /// [`arealight::table::ggx_grazing_dip`] added.
    fn has_ggx_dip(&self) -> bool {
        false
    }
}

/// The integrals over the hemisphere that scale a lobe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnitude {
    /// Integral of `f cos`, in [0, 1].
    pub albedo: f64,
    /// Integral of `f cos (1 - cos theta_vh)^5`, in [0, albedo].
    pub schlick: f64,
}

impl Magnitude {
    /// The specular albedo at a reflectance `f0` at normal incidence (and 1 at grazing).
    pub fn at(self, f0: f64) -> f64 {
        f0 * self.albedo + (1.0 - f0) * self.schlick
    }
}

/// The unit view vector in the xz plane.
pub fn view_direction(cos_view: f64) -> DVec3 {
    let sin_view = ((1.0 - cos_view) * (1.0 + cos_view)).max(0.0).sqrt();
    DVec3::new(sin_view, 0.0, cos_view)
}

/// GGX with height-correlated Smith masking-shadowing.
#[derive(Debug, Clone, Copy, Default)]
pub struct GgxBrdf;

impl Brdf for GgxBrdf {
    fn name(&self) -> &'static str {
        "ggx-correlated-smith"
    }

    fn evaluate(&self, alpha: f64, view: DVec3, light: DVec3) -> f64 {
        Ggx { alpha }.evaluate(view, light)
    }

    fn sample(&self, alpha: f64, view: DVec3, u: [f64; 2]) -> DVec3 {
        Ggx { alpha }.sample(view, u)
    }

    fn density(&self, alpha: f64, view: DVec3, light: DVec3) -> f64 {
        Ggx { alpha }.density(view, light)
    }

    fn has_ggx_dip(&self) -> bool {
        true
    }

    fn magnitude(&self, alpha: f64, cos_view: f64) -> Magnitude {
        let lobe = Ggx { alpha };
        let view = view_direction(cos_view);
        half_vector_magnitude(alpha, view, |half, light| {
            let value = lobe.distribution(half) * lobe.visibility(view.z, light.z) * light.z;
            (value, (1.0 - view.dot(half).clamp(0.0, 1.0)).powi(5))
        })
    }
}

/// Integrates a BRDF's albedos over half vectors in polar coordinates, because there the horizon of the light
/// is a boundary in closed form, and a product of Gauss rules meets no kink: with the half vector at `theta`
/// and azimuth `phi`, `light.z = sin_view cos(phi) sin(2 theta) + cos_view cos(2 theta)`. For lobes about the
/// half vector that are about as wide as GGX of this alpha, and for smooth ones.
///
/// `evaluate` has the unit half vector and the direction of the light, and says `f cos theta_light` and
/// Schlick's weight ([`Brdf::schlick_weight`]); it is called 3,840 times. `view` is as for [`Brdf`].
pub fn half_vector_magnitude(
    alpha: f64,
    view: DVec3,
    evaluate: impl Fn(DVec3, DVec3) -> (f64, f64),
) -> Magnitude {
    let mut sum = Magnitude { albedo: 0.0, schlick: 0.0 };
    let radial: Vec<_> = crowded_at_zero::<RADIAL>(view.z.min(alpha)).collect();
    for (phi, weight_phi) in azimuths(view.z) {
        let (sin_phi, cos_phi) = phi.sin_cos();
        // Bound the polar angle by the horizon; tan theta = alpha tan psi spreads D evenly
        let theta_limit = 0.5 * view.z.atan2(-view.x * cos_phi);
        let psi_limit = theta_limit.sin().atan2(alpha * theta_limit.cos());
        for &(y, weight_psi) in &radial {
            let from_horizon = psi_limit * y;
            let psi = psi_limit - from_horizon;
            let slope = alpha * psi.tan();
            let cos_half = 1.0 / (1.0 + slope * slope).sqrt();
            let sin_half = slope * cos_half;
            let half = DVec3::new(sin_half * cos_phi, sin_half * sin_phi, cos_half);
            let cos_vh = view.dot(half);
            let light = half * (2.0 * cos_vh) - view;
            if light.z <= 0.0 {
                continue;
            }
            // d omega_half = cos_half³ slope d slope d phi, and d omega_light = 4 cos_vh d omega_half
            let slope_per_psi = alpha / psi.cos().powi(2);
            let solid_angle = 4.0 * cos_vh * cos_half.powi(3) * slope * slope_per_psi;
            let weight = weight_phi * weight_psi * psi_limit * solid_angle;
            let (value, schlick) = evaluate(half, light);
            sum.albedo += weight * value;
            sum.schlick += weight * value * schlick;
        }
    }
    sum
}

/// Nodes along the polar angle, and along either quarter of the azimuth.
const RADIAL: usize = 48;
const AZIMUTH: usize = 40;

/// Azimuths of one half with weights that count both. At the right angle the horizon of the light turns
/// within an angle of about `cos_view`.
fn azimuths(cos_view: f64) -> impl Iterator<Item = (f64, f64)> {
    crowded_at_zero::<AZIMUTH>(cos_view).flat_map(|(x, weight)| {
        let weight = 2.0 * FRAC_PI_2 * weight;
        [(FRAC_PI_2 * (1.0 - x), weight), (FRAC_PI_2 * (1.0 + x), weight)]
    })
}

/// Nodes and weights on [0, 1] for what varies within `width` of zero: Gauss's rule spread by a hyperbolic
/// sine.
fn crowded_at_zero<const N: usize>(width: f64) -> impl Iterator<Item = (f64, f64)> {
    let width = width.max(1e-4);
    let reach = (1.0 / width).asinh();
    gauss_legendre::<N>()
        .into_iter()
        .map(move |(x, weight)| (width * (reach * x).sinh(), weight * width * reach * (reach * x).cosh()))
}
