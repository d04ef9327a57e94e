//! Metallic-roughness materials, and the surface that a shading point sees.

use glam::{DVec3, Vec3};

/// A metallic-roughness material with constant values, as glTF has it (with `KHR_materials_ior` and
/// `KHR_materials_specular`). Textures belong to the scene that samples them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Linear Rec. 709 colour in [0, 1]: the Lambert albedo of a dielectric, F0 of a metal.
    pub base_color: Vec3,
    /// From 0 (dielectric) to 1 (metal).
    pub metalness: f32,
    /// Perceptual roughness in [0, 1]; `alpha = roughness²`.
    pub roughness: f32,
    /// Reflectance of the dielectric at normal incidence, a channel, in [0, 1].
    pub dielectric_f0: Vec3,
    /// Reflectance of the dielectric at grazing incidence (the weight of `KHR_materials_specular`), in [0, 1].
    pub dielectric_f90: f32,
}

impl Default for Material {
    /// A white, rough dielectric of index 1.5.
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metalness: 0.0,
            roughness: 1.0,
            dielectric_f0: Vec3::splat(0.04),
            dielectric_f90: 1.0,
        }
    }
}

/// What the two lobes need to know of a surface: a Lambert lobe and a GGX lobe, added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Lambert albedo in [0, 1]; the lobe is `albedo / pi`.
    pub diffuse_albedo: DVec3,
    /// Schlick's reflectance at normal incidence, a channel.
    pub f0: DVec3,
    /// Schlick's reflectance at grazing incidence.
    pub f90: f64,
    /// GGX alpha, not below [`crate::MIN_ALPHA`].
    pub alpha: f64,
}

impl Material {
    /// The surface of this material: what `arealight_surface_from_metalness` does in GLSL.
    ///
    /// The Lambert albedo is `base_color (1 - metalness)`; the lobes are added without Fresnel coupling, as
    /// in most real-time engines.
    pub fn surface(&self) -> Surface {
        let metalness = f64::from(self.metalness);
        let base = self.base_color.as_dvec3();
        let roughness = f64::from(self.roughness);
        Surface {
            diffuse_albedo: base * (1.0 - metalness),
            f0: self.dielectric_f0.as_dvec3().lerp(base, metalness),
            f90: f64::from(self.dielectric_f90) * (1.0 - metalness) + metalness,
            alpha: (roughness * roughness).max(crate::MIN_ALPHA),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metal_reflects_its_base_color_and_has_no_lambert_lobe() {
        let gold = Material { base_color: Vec3::new(1.0, 0.7, 0.3), metalness: 1.0, ..Material::default() };
        let surface = gold.surface();
        assert_eq!(surface.diffuse_albedo, DVec3::ZERO);
        assert!((surface.f0 - DVec3::new(1.0, 0.7, 0.3)).length() < 1e-6);
        assert_eq!(surface.f90, 1.0);
    }

    #[test]
    fn alpha_is_roughness_squared_and_bounded() {
        let material = Material { roughness: 0.5, ..Material::default() };
        assert_eq!(material.surface().alpha, 0.25);
        let mirror = Material { roughness: 0.0, ..Material::default() };
        assert_eq!(mirror.surface().alpha, crate::MIN_ALPHA);
    }
}
