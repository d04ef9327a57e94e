//! What a lookup answers, and the lobes that a reflectance has of it.

use super::DIELECTRIC_F0;
use crate::SpecularLobes;
use glam::{DMat3, DVec3};

/// One lookup: the lobes of a roughness and a view angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableSample {
    /// M⁻¹ of the lobe without Fresnel term: directions of the surface frame (view in the xz plane, x not
    /// negative) into cosine space.
    pub inverse: DMat3,
    /// M⁻¹ of the lobe of Schlick's weight; the same as `inverse` in a table of one matrix.
    pub schlick_inverse: DMat3,
    /// Integral of `f cos` over the hemisphere, in [0, 1].
    pub albedo: f64,
    /// Integral of `f cos (1 - cos theta_vh)^5` over the hemisphere, in [0, 1].
    pub schlick: f64,
    /// M⁻¹ of the first and of the second of two lobes, as `inverse`, and the second one's share of the
    /// energy, in [0, 1], at a reflectance of 1 and at one of [`DIELECTRIC_F0`]. None of a table without
    /// [`super::LobePairs`].
    pub pairs: Option<([DMat3; 2], [f64; 2])>,
}

impl TableSample {
    /// The specular albedo at a reflectance of `f0` at normal and `f90` at grazing incidence.
    pub fn specular_albedo(&self, f0: f64, f90: f64) -> f64 {
        f0 * self.albedo + (f90 - f0) * self.schlick
    }

    /// M⁻¹ of one lobe for a reflectance, [`SpecularLobes::One`]: between the two by their shares of the
    /// specular albedo. Since M⁻¹ is linear in the texel, texels may be interpolated instead.
    pub fn inverse_by_f0(&self, f0: f64, f90: f64) -> DMat3 {
        self.inverse + (self.schlick_inverse - self.inverse) * self.schlick_share(f0, f90)
    }

    /// The lobes of a surface: M⁻¹ of each, and what it reflects of light from everywhere, a channel. The
    /// second reflects nothing where there is one.
    pub fn lobes(&self, lobes: SpecularLobes, f0: DVec3, f90: f64) -> [(DMat3, DVec3); 2] {
        let channels = |of: &dyn Fn(f64) -> f64| DVec3::from_array(f0.to_array().map(of));
        let albedo = channels(&|f0| self.specular_albedo(f0, f90));
        match (lobes, self.pairs) {
            (SpecularLobes::Two, Some((inverses, shares))) => {
                let second = channels(&|f0| self.second_albedo(shares, f0, f90)).clamp(DVec3::ZERO, albedo);
                [(inverses[0], albedo - second), (inverses[1], second)]
            }
            _ => [(self.inverse_by_f0(f0.element_sum() / 3.0, f90), albedo), (DMat3::IDENTITY, DVec3::ZERO)],
        }
    }

    /// What the second of two lobes reflects: the reflectance is so much of 1's and so much of
    /// [`DIELECTRIC_F0`]'s.
    fn second_albedo(&self, [of_metal, of_dielectric]: [f64; 2], f0: f64, f90: f64) -> f64 {
        let dielectric = (f90 - f0) / (1.0 - DIELECTRIC_F0);
        let metal = f0 - DIELECTRIC_F0 * dielectric;
        let dielectric_albedo = self.specular_albedo(DIELECTRIC_F0, 1.0);
        metal * self.albedo * of_metal + dielectric * dielectric_albedo * of_dielectric
    }

    /// The part of the specular albedo that is due to Schlick's weight, in [0, 1]; 0 where nothing is
    /// reflected or `f90` is below `f0`.
    pub fn schlick_share(&self, f0: f64, f90: f64) -> f64 {
        let (lobe, schlick) = (f0 * self.albedo, (f90 - f0) * self.schlick);
        if schlick > 0.0 && lobe >= 0.0 { schlick / (lobe + schlick) } else { 0.0 }
    }
}
