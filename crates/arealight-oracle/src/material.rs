//! Metallic-roughness materials, and the surface that a shading point sees.

use crate::thin_film::ThinFilm;
use glam::{DVec3, Vec3};

/// The parts of linear Rec. 709 channels in luminance.
pub const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// A metallic-roughness material with constant values, as glTF has it (with `KHR_materials_ior`,
/// `KHR_materials_specular`, `KHR_materials_clearcoat`, `KHR_materials_sheen` and
/// `KHR_materials_iridescence`). Textures belong to the scene that samples them.
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
    /// Reflectance of the dielectric at grazing incidence (the weight of `KHR_materials_specular`), in [0,
    /// 1].
    pub dielectric_f90: f32,
    /// Weight of a clear coat in [0, 1]; 0 for none ([`Effects::COAT`](arealight::Effects::COAT)).
    pub coat: f32,
    /// Perceptual roughness of the coat, in [0, 1].
    pub coat_roughness: f32,
    /// Linear Rec. 709 colour of sheen in [0, 1]; black for none
    /// ([`Effects::SHEEN`](arealight::Effects::SHEEN)).
    pub sheen_color: Vec3,
    /// Perceptual roughness of the sheen, in [0, 1].
    pub sheen_roughness: f32,
    /// A thin film on the surface, below sheen and the coat.
    pub film: Option<ThinFilm>,
    /// How much of a thin dielectric's diffuse light goes through it, in [0, 1]; 0 for none
    /// ([`Effects::TRANSMISSION`](arealight::Effects::TRANSMISSION)).
    pub transmission: f32,
    /// Linear Rec. 709 colour of that light in [0, 1].
    pub transmission_color: Vec3,
    /// How much of a thin dielectric is a pane, which lets light of the base colour through without diffusing
    /// it, in [0, 1]; 0 for none ([`Effects::GLASS`](arealight::Effects::GLASS)).
    pub glass: f32,
}

impl Default for Material {
    /// A white, rough dielectric of index 1.5, without a coat or sheen.
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metalness: 0.0,
            roughness: 1.0,
            dielectric_f0: Vec3::splat(0.04),
            dielectric_f90: 1.0,
            coat: 0.0,
            coat_roughness: 0.0,
            sheen_color: Vec3::ZERO,
            sheen_roughness: 0.0,
            film: None,
            transmission: 0.0,
            transmission_color: Vec3::ONE,
            glass: 0.0,
        }
    }
}

/// What the lobes need to know of a surface: a diffuse lobe and a GGX lobe, added or coupled, and a coat
/// above both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Lambert albedo in [0, 1]; the lobe is `albedo / pi`.
    pub diffuse_albedo: DVec3,
    /// Schlick's reflectance at normal incidence, a channel.
    pub f0: DVec3,
    /// Schlick's reflectance at grazing incidence.
    pub f90: f64,
    /// GGX alpha, not below [`arealight::MIN_ALPHA`].
    pub alpha: f64,
    /// Roughness of the diffuse lobe in [0, 1]: 0 is Lambert's, else EON of Portsmouth, Kutz and Hill 2025.
    pub diffuse_roughness: f64,
    /// What lies above the diffuse lobe; `None` where the two lobes are added.
    pub interface: Option<Interface>,
    /// What lies above both lobes.
    pub coat: Option<Coat>,
    /// What lies above both lobes and below the coat.
    pub sheen: Option<Sheen>,
    /// Whether light that the GGX lobe's facets reflect more than once is added
    /// ([`Effects::MULTIPLE_SCATTERING`](arealight::Effects::MULTIPLE_SCATTERING)); else it is lost.
    /// [`crate::microsurface`] has the truth, which [`crate::shading::truth`] leaves out.
    pub multiple_scattering: bool,
    /// A film that replaces the Fresnel term of the GGX lobe, and of the interface.
    pub film: Option<ThinFilm>,
    /// Where the GGX lobe is stretched along a tangent; [`Surface::alpha`] is that across it then.
    pub anisotropy: Option<Anisotropy>,
}

/// The tangent and the second alpha of a GGX distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropy {
    /// Any length and any angle to the surface, onto which it is projected; zero and one along the normal
    /// count as some direction of the surface.
    pub tangent: DVec3,
    /// GGX alpha along it, not below [`arealight::MIN_ALPHA`].
    pub alpha: f64,
}

impl Default for Surface {
    /// Black, with an alpha of 1.
    fn default() -> Self {
        Self {
            diffuse_albedo: DVec3::ZERO,
            f0: DVec3::ZERO,
            f90: 0.0,
            alpha: 1.0,
            diffuse_roughness: 0.0,
            multiple_scattering: false,
            interface: None,
            coat: None,
            sheen: None,
            film: None,
            anisotropy: None,
        }
    }
}

impl Surface {
    /// What the GGX lobe's facets reflect of light that comes in at this cosine: Schlick's term, or the
    /// film's.
    pub fn fresnel(&self, cosine: f64) -> DVec3 {
        match &self.film {
            None => self.f0 + (DVec3::splat(self.f90) - self.f0) * (1.0 - cosine).powi(5),
            Some(film) => film.reflectance(self.f0, self.f90, cosine),
        }
    }

    /// The same surface with Schlick's term in the place of a film, for a view at this cosine to its normal.
    #[must_use]
    pub fn without_film(self, cos_view: f64) -> Self {
        let Some(film) = &self.film else { return self };
        let at_facets = |f0, f90| film.as_schlick(f0, f90, cos_view, self.alpha.sqrt());
        let (f0, f90) = at_facets(self.f0, self.f90);
        let interface = self.interface.map(|interface| {
            let (f0, f90) = if interface.by_albedo {
                at_facets(DVec3::splat(interface.f0), interface.f90)
            } else {
                film.above_lambert(interface.f0, interface.f90, cos_view)
            };
            Interface { f0: f0.max_element(), f90, ..interface }
        });
        Self { f0, f90, interface, film: None, ..self }
    }
}

/// Sheen, as `KHR_materials_sheen` has it: the Charlie lobe ([`crate::sheen`]), added to what its albedo at
/// the view leaves of the lobes below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheen {
    /// In [0, 1], a channel.
    pub color: DVec3,
    /// Perceptual roughness in [0, 1]; below [`crate::sheen::MIN_ROUGHNESS`] it counts as that.
    pub roughness: f64,
}

impl Sheen {
    /// The part of the light that the lobes below get, in [0, 1], where a sheen of colour 1 has this albedo.
    pub fn left_below(&self, albedo: f64) -> f64 {
        (1.0 - self.color.max_element() * albedo).max(0.0)
    }
}

/// The interface that light crosses on its way to a Lambert lobe, which gets what Schlick's Fresnel term
/// leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interface {
    /// Reflectance at normal incidence, in [0, 1].
    pub f0: f64,
    /// Reflectance at grazing incidence, in [0, 1].
    pub f90: f64,
    /// Whether the lobe gets what the albedo of the GGX lobe leaves at the view, as in OpenPBR
    /// ([`Effects::COUPLED_BY_ALBEDO`](arealight::Effects::COUPLED_BY_ALBEDO)); else what the Fresnel term of
    /// the half vector leaves, as in glTF.
    pub by_albedo: bool,
}

/// A clear coat, as `KHR_materials_clearcoat` has it: a GGX lobe about a normal of its own, without a Fresnel
/// term. It reflects the part [`Coat::share`] of the light, which depends on the view alone; what is below
/// gets the rest. Or as OpenPBR has it, by its albedo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coat {
    /// How much of the surface it covers, in (0, 1].
    pub weight: f64,
    /// GGX alpha, not below [`arealight::MIN_ALPHA`].
    pub alpha: f64,
    /// Its normal, of any length above zero; `None` where it is the surface's.
    pub normal: Option<DVec3>,
    /// Whether it has Schlick's Fresnel term of the half vector, and what is below gets what its albedo at
    /// the view leaves ([`Effects::COAT_BY_ALBEDO`](arealight::Effects::COAT_BY_ALBEDO)).
    pub by_albedo: bool,
}

impl Coat {
    /// Reflectance at normal incidence: that of an index of refraction of 1.5.
    pub const F0: f64 = 0.04;

    /// The part of the light that it reflects instead of what is below, in [0, weight]: Schlick's term of the
    /// view. `cos_view` is the cosine between the coat's normal and the direction to the viewer; its sign
    /// does not count.
    pub fn share(&self, cos_view: f64) -> f64 {
        self.weight * (Self::F0 + (1.0 - Self::F0) * (1.0 - cos_view.abs()).powi(5))
    }
}

impl Material {
    /// The surface of this material: what `arealight_surface_from_metalness` does in GLSL.
    ///
    /// The Lambert albedo is `base_color (1 - metalness)`, less what is let through
    /// ([`Material::other_side`]); the lobes are added without Fresnel coupling, as in many real-time
    /// engines. The coat has the surface's normal.
    pub fn surface(&self) -> Surface {
        let metalness = f64::from(self.metalness);
        let base = self.base_color.as_dvec3();
        let alpha = |roughness: f32| (f64::from(roughness) * f64::from(roughness)).max(arealight::MIN_ALPHA);
        let weight = f64::from(self.coat);
        Surface {
            diffuse_albedo: base
                * ((1.0 - metalness) * (1.0 - f64::from(self.transmission)) * (1.0 - f64::from(self.glass))),
            f0: self.dielectric_f0.as_dvec3().lerp(base, metalness),
            f90: f64::from(self.dielectric_f90) * (1.0 - metalness) + metalness,
            alpha: alpha(self.roughness),
            diffuse_roughness: 0.0,
            multiple_scattering: false,
            interface: None,
            coat: (weight > 0.0).then(|| Coat {
                weight,
                alpha: alpha(self.coat_roughness),
                normal: None,
                by_albedo: false,
            }),
            sheen: (self.sheen_color != Vec3::ZERO).then(|| Sheen {
                color: self.sheen_color.as_dvec3(),
                roughness: f64::from(self.sheen_roughness),
            }),
            film: self.film,
            anisotropy: None,
        }
    }

    /// Its other side, for light that is let through: what a surface of the opposite normal, seen from the
    /// mirror image of the view, reflects. Of a pane that is the specular lobe, with what Schlick's term
    /// leaves in the place of the term (`KHR_materials_transmission`).
    pub fn other_side(&self) -> Surface {
        let dielectric = 1.0 - f64::from(self.metalness);
        let pane = self.base_color.as_dvec3() * (dielectric * f64::from(self.glass));
        let diffused = dielectric * f64::from(self.transmission) * (1.0 - f64::from(self.glass));
        let luminance = pane.dot(LUMINANCE);
        let Surface { interface, alpha, .. } = self.coupled_surface();
        Surface {
            diffuse_albedo: self.transmission_color.as_dvec3() * diffused,
            f0: pane * (1.0 - self.dielectric_f0.as_dvec3()),
            f90: luminance * (1.0 - f64::from(self.dielectric_f90)),
            alpha,
            interface,
            ..Surface::default()
        }
    }

    /// The same with the Lambert lobe coupled, as glTF has it.
    pub fn coupled_surface(&self) -> Surface {
        let f0 = f64::from(self.dielectric_f0.max_element());
        let interface = Interface { f0, f90: f64::from(self.dielectric_f90), by_albedo: false };
        Surface { interface: Some(interface), ..self.surface() }
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
        assert_eq!(mirror.surface().alpha, arealight::MIN_ALPHA);
    }

    #[test]
    fn a_coat_reflects_more_at_grazing_angles_and_never_more_than_its_weight() {
        assert_eq!(Material::default().surface().coat, None);
        let lacquer = Material { coat: 0.5, coat_roughness: 0.1, ..Material::default() };
        let coat = lacquer.surface().coat.unwrap();
        assert!((coat.alpha - 0.01).abs() < 1e-8);
        assert_eq!((coat.share(1.0), coat.share(0.0)), (0.5 * 0.04, 0.5));
        assert_eq!(coat.share(-0.3), coat.share(0.3));
    }
}
