//! The clamped cosine integrated over a sphere, and the disk that looks the same as one.
//!
//! The twin of `shaders/include/arealight/sphere.glsl`. Sources: the closed form of a spherical source that
//! crosses the horizon is Snyder's (1996), rearranged so that nothing cancels; a sphere's silhouette is a
//! disk, which a linear transform makes an ellipse.

use crate::ellipse::{self, Ellipse};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// A sphere as seen from the origin, in a space whose z axis is the normal. It shines outwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// The center, from the shading point.
    pub center: DVec3,
    /// Positive.
    pub radius: f64,
}

impl Sphere {
    /// Whether the origin is in the sphere or on it.
    pub fn is_inside(&self) -> bool {
        self.center.length() <= self.radius
    }

    /// The disk inside the sphere that covers the same directions, its front to the origin; `None` from
    /// inside.
    pub fn silhouette(&self) -> Option<Ellipse> {
        let distance = self.center.length();
        if self.is_inside() {
            return None;
        }
        let axis = self.center / distance;
        let cosine = ((distance - self.radius) * (distance + self.radius)).sqrt() / distance;
        // Where the cone of tangents meets the sphere, brought to the sphere's radius
        Some(Ellipse::disk(self.center * cosine, -axis, self.radius))
    }
}

/// The integral of the clamped cosine `max(0, cos) / pi` over a sphere, in [0, 1]; from inside 0, as it
/// shines outwards.
///
/// Relative error 1e-14 where the sphere's center is above the horizon.
pub fn form_factor(sphere: &Sphere) -> f64 {
    let distance = sphere.center.length();
    if sphere.is_inside() {
        return 0.0;
    }
    let sine = sphere.radius / distance;
    let cosine = ((distance - sphere.radius) * (distance + sphere.radius)).sqrt() / distance;
    let z = sphere.center.z / distance;
    if z >= sine {
        return sine * sine * z;
    }
    if z <= -sine {
        return 0.0;
    }
    let q = ((sine - z) * (sine + z)).sqrt();
    let across = q * q + cosine * cosine;
    let angle = q.atan2(cosine);
    let segment = if angle < 0.05 {
        let square = (2.0 * angle).powi(2);
        (2.0 * angle).powi(3) / 12.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
    } else {
        angle - q * cosine / across
    };
    (sine * sine * z * q.atan2(-cosine * z) + segment + q * cosine * z * z / across) / PI
}

/// The integral of a linearly transformed cosine over a sphere, in [0, 1]; from inside 0. `inverse` takes
/// directions of the surface frame into cosine space. Only the horizon of cosine space is clipped.
pub fn transformed_form_factor(inverse: &DMat3, sphere: &Sphere) -> f64 {
    // A transform that mirrors shows the silhouette's back
    sphere.silhouette().map_or(0.0, |disk| ellipse::form_factor(&disk.transformed(inverse)).abs())
}
