//! GGX with height-correlated Smith masking-shadowing, in float64, in the surface frame (z is the normal).
//!
//! Sources: Walter et al. 2007, *Microfacet Models for Refraction through Rough Surfaces* (D); Heitz 2014,
//! *Understanding the Masking-Shadowing Function* (G2); Heitz 2018, *Sampling the GGX Distribution of
//! Visible Normals* (sampling).

use crate::frame::SurfaceFrame;
use crate::material::Surface;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// An isotropic GGX lobe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ggx {
    /// alpha = roughness², above 0.
    pub alpha: f64,
}

impl Ggx {
    /// `f cos theta_light` without a Fresnel term, 1/sr. Zero where the view or the light is below the
    /// surface. Directions are unit vectors.
    pub fn evaluate(&self, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 || view.z < 0.0 {
            return 0.0;
        }
        let half = (view + light).normalize_or_zero();
        // f = D G2 / (4 cos_v cos_l); G2 / (4 cos_v cos_l) in a form without division by either cosine
        self.distribution(half) * self.visibility(view.z, light.z) * light.z
    }

    /// `cos theta_vh` of a pair of directions, in [0, 1].
    pub fn half_cosine(view: DVec3, light: DVec3) -> f64 {
        view.dot((view + light).normalize_or_zero()).clamp(0.0, 1.0)
    }

    /// Schlick's weight `(1 - cos theta_vh)^5` of a pair of directions.
    pub fn schlick_weight(view: DVec3, light: DVec3) -> f64 {
        (1.0 - Self::half_cosine(view, light)).powi(5)
    }

    /// The distribution of normals D, 1/sr.
    pub fn distribution(&self, half: DVec3) -> f64 {
        let a = self.alpha;
        // x² + y² + alpha² z², written so that nothing cancels near the normal
        let slope = (half.x * half.x + half.y * half.y) / (a * a) + half.z * half.z;
        1.0 / (PI * a * a * slope * slope)
    }

    /// `G2 / (4 cos_view cos_light)`, height-correlated; finite at grazing angles.
    pub fn visibility(&self, cos_view: f64, cos_light: f64) -> f64 {
        let a2 = self.alpha * self.alpha;
        let view = cos_light * (a2 + (1.0 - a2) * cos_view * cos_view).sqrt();
        let light = cos_view * (a2 + (1.0 - a2) * cos_light * cos_light).sqrt();
        0.5 / (view + light)
    }

    /// Draws a light direction from the distribution of visible normals: `u` in [0, 1)². The direction may
    /// lie below the surface, where [`Ggx::evaluate`] is zero.
    pub fn sample(&self, view: DVec3, u: [f64; 2]) -> DVec3 {
        let half = self.sample_visible_normal(view, u);
        (half * (2.0 * view.dot(half)) - view).normalize_or_zero()
    }

    /// The density of [`Ggx::sample`] in solid angle, 1/sr. Zero below the surface.
    pub fn density(&self, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 {
            return 0.0;
        }
        let half = (view + light).normalize_or_zero();
        self.visible_normal_density(view, half) / (4.0 * view.dot(half)).max(f64::MIN_POSITIVE)
    }

    /// Draws a half vector from the visible normals (Heitz 2018); `view` may be below the surface.
    pub(crate) fn sample_visible_normal(self, view: DVec3, u: [f64; 2]) -> DVec3 {
        let a = self.alpha;
        // Stretch the view so that the surface has alpha = 1
        let stretched = DVec3::new(a * view.x, a * view.y, view.z).normalize_or(DVec3::Z);
        let t1 = DVec3::new(-stretched.y, stretched.x, 0.0).normalize_or(DVec3::X);
        let t2 = stretched.cross(t1);
        // Sample the projected area of the hemisphere
        let r = u[0].sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * u[1]).sin_cos();
        let (p1, mut p2) = (r * cos_phi, r * sin_phi);
        let s = 0.5 * (1.0 + stretched.z);
        p2 = (1.0 - s) * (1.0 - p1 * p1).max(0.0).sqrt() + s * p2;
        let normal = t1 * p1 + t2 * p2 + stretched * (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
        // Take the stretch back
        DVec3::new(a * normal.x, a * normal.y, normal.z.max(0.0)).normalize_or(DVec3::Z)
    }

    fn visible_normal_density(self, view: DVec3, half: DVec3) -> f64 {
        let a2 = self.alpha * self.alpha;
        // D G1 <v, h> / cos_v, with G1 / cos_v = 2 / (cos_v + sqrt(alpha² + (1 - alpha²) cos_v²))
        let root = (a2 + (1.0 - a2) * view.z * view.z).sqrt();
        self.distribution(half) * 2.0 * view.dot(half).max(0.0) / (view.z + root)
    }
}

/// A GGX lobe of two alphas, height-correlated as [`Ggx`] is (Heitz 2014, appendix A).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnisotropicGgx {
    /// Unit, in the surface's plane of the surface frame: `alpha.x` runs along it.
    pub axis: DVec2,
    /// Alpha along the axis and across it, above 0.
    pub alpha: DVec2,
}

impl AnisotropicGgx {
    /// The lobe of a surface in its frame; `None` where it has one alpha.
    pub fn of(surface: &Surface, frame: &SurfaceFrame) -> Option<Self> {
        let anisotropy = surface.anisotropy.as_ref()?;
        let axis = frame.axis(anisotropy.tangent);
        Some(Self { axis, alpha: DVec2::new(anisotropy.alpha, surface.alpha) })
    }

    /// A vector of the surface frame, in the frame of the axis and the normal.
    pub fn to_axis(&self, vector: DVec3) -> DVec3 {
        let flat = DVec2::new(self.axis.x, -self.axis.y).rotate(vector.truncate());
        flat.extend(vector.z)
    }

    /// As [`Ggx::evaluate`].
    pub fn evaluate(&self, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 || view.z < 0.0 {
            return 0.0;
        }
        let half = self.to_axis((view + light).normalize_or_zero());
        let slope = (half.truncate() / self.alpha).length_squared() + half.z * half.z;
        let distribution = 1.0 / (PI * self.alpha.x * self.alpha.y * slope * slope);
        let stretched = |direction: DVec3| {
            let direction = self.to_axis(direction);
            (direction * self.alpha.extend(1.0)).length()
        };
        // f = D G2 / (4 cos_v cos_l); G2 / (4 cos_v cos_l) in a form without division by either cosine
        let visibility = 0.5 / (light.z * stretched(view) + view.z * stretched(light));
        distribution * visibility * light.z
    }
}
