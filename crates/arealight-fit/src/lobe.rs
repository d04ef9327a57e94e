//! The lobe being fitted: a linearly transformed cosine in the mirror frame, with its derivatives.

use arealight::table::mirror_frame;
use glam::{DMat3, DVec3};
use std::f64::consts::FRAC_1_PI;

/// A linearly transformed cosine, by the four entries that a table's matrix texel holds (see
/// [`arealight::table`]) and the alpha that scales the last row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// `(q00, q02, q20, q22)`.
    pub texel: [f64; 4],
    /// The alpha of the last row, above 0.
    pub alpha: f64,
}

impl Lobe {
    /// M⁻¹ from the mirror frame into cosine space.
    pub fn inverse(&self) -> DMat3 {
        let [q00, q02, q20, q22] = self.texel;
        DMat3::from_cols(
            DVec3::new(q00, 0.0, self.alpha * q20),
            DVec3::Y,
            DVec3::new(q02, 0.0, self.alpha * q22),
        )
    }

    /// The determinant of M⁻¹; a lobe needs it above 0.
    pub fn determinant(&self) -> f64 {
        let [q00, q02, q20, q22] = self.texel;
        self.alpha * (q00 * q22 - q02 * q20)
    }

    /// Whether M⁻¹ keeps its axes' senses and can be inverted, also after its entries are rounded to float32.
    pub fn is_valid(&self) -> bool {
        let [q00, q02, q20, q22] = self.texel;
        let is_finite = self.texel.iter().all(|q| q.is_finite());
        is_finite && q00 > 0.0 && q22 > 0.0 && q00 * q22 - q02 * q20 > 1e-4 * q00 * q22
    }

    /// This lobe as it becomes when the view's cosine changes by a factor: a narrow one follows it in width
    /// across the plane of incidence, one that is wide at that angle much less.
    #[must_use]
    pub fn narrowed(&self, cos_view: f64, new_cos_view: f64) -> Self {
        let factor = new_cos_view.hypot(self.alpha) / cos_view.hypot(self.alpha);
        let [q00, q02, q20, q22] = self.texel;
        Self { texel: [q00 * factor, q02 * factor, q20, q22 * factor], ..*self }
    }

    /// The density of the lobe in a direction of the mirror frame, 1/sr; it integrates to 1.
    pub fn density(&self, direction: DVec3) -> f64 {
        let [q00, q02, q20, q22] = self.texel;
        let x = q00 * direction.x + q02 * direction.z;
        let z = self.alpha * (q20 * direction.x + q22 * direction.z);
        let square = x * x + direction.y * direction.y + z * z;
        FRAC_1_PI * self.determinant() * z.max(0.0) / (square * square)
    }

    /// The density and its derivatives by the four entries.
    ///
    /// From `ln D = ln det + ln z - 2 ln |w|²`, `w = M⁻¹ direction`.
    pub fn density_and_gradient(&self, direction: DVec3) -> (f64, [f64; 4]) {
        let [q00, q02, q20, q22] = self.texel;
        let a = self.alpha;
        let x = q00 * direction.x + q02 * direction.z;
        let z = a * (q20 * direction.x + q22 * direction.z);
        if z <= 0.0 {
            return (0.0, [0.0; 4]);
        }
        let square = x * x + direction.y * direction.y + z * z;
        let determinant = q00 * q22 - q02 * q20;
        let density = FRAC_1_PI * a * determinant * z / (square * square);
        let by_x = -4.0 * x / square;
        let by_z = a * (1.0 / z - 4.0 * z / square);
        let gradient = [
            density * (q22 / determinant + by_x * direction.x),
            density * (by_x * direction.z - q20 / determinant),
            density * (by_z * direction.x - q02 / determinant),
            density * (q00 / determinant + by_z * direction.z),
        ];
        (density, gradient)
    }

    /// The part of the lobe's energy above the surface, and its derivatives by the four entries; `normal` is
    /// the surface's, in the mirror frame. The twin of [`arealight::table::share_above_surface`].
    ///
    /// In cosine space the surface's normal is `n = M^T normal`, and the share `(1 + n.z / |n|) / 2`.
    pub fn share_above(&self, normal: DVec3) -> (f64, [f64; 4]) {
        let [q00, q02, q20, q22] = self.texel;
        let a = self.alpha;
        let x = a * (q22 * normal.x - q20 * normal.z);
        let z = q00 * normal.z - q02 * normal.x;
        let length = x.hypot(z);
        // d (z / length) = x (x dz - z dx) / length³
        let slope = 0.5 * x / length.powi(3);
        let gradient = [x * normal.z, -x * normal.x, a * z * normal.z, -a * z * normal.x];
        (0.5 + 0.5 * z / length, gradient.map(|part| slope * part))
    }

    /// A direction of the mirror frame drawn from the lobe, for `u` in [0, 1)².
    pub fn sample(&self, u: [f64; 2]) -> DVec3 {
        let radius = u[0].sqrt();
        let (sin_phi, cos_phi) = (std::f64::consts::TAU * u[1]).sin_cos();
        let cosine = DVec3::new(radius * cos_phi, radius * sin_phi, (1.0 - u[0]).max(0.0).sqrt());
        (self.inverse().inverse() * cosine).normalize_or(DVec3::Z)
    }
}

/// A direction of the surface frame, in the mirror frame of a view.
pub fn to_mirror_frame(cos_view: f64, direction: DVec3) -> DVec3 {
    mirror_frame(cos_view).transpose() * direction
}
