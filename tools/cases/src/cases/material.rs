//! What the surface of a case is made of.

use super::CaseError;
use super::coat::CaseCoat;
use super::fields::Fields;
use arealight::MIN_ALPHA;
use arealight_oracle::material::{Anisotropy, Interface, Sheen, Surface};
use arealight_oracle::sheen::MIN_ROUGHNESS;
use arealight_oracle::thin_film::ThinFilm;
use glam::{DVec2, DVec3};

/// What the surface of a case is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum CaseMaterial {
    /// A Lambert lobe, or a rough one.
    Diffuse {
        /// Albedo, not negative; of a rough lobe at most 1.
        albedo: DVec3,
        /// Roughness of EON in [0, 1]; 0 is Lambert's lobe.
        roughness: f64,
    },
    /// A GGX lobe, and perhaps a Lambert lobe added to it.
    Ggx {
        /// Alpha along the tangent and across it, in (0, 1]; equal for an isotropic lobe.
        alpha: DVec2,
        /// Schlick's reflectance at normal incidence; `None` for no Fresnel term, F = 1.
        f0: Option<DVec3>,
        /// Albedo of the Lambert lobe.
        albedo: Option<DVec3>,
        /// Whether the Lambert lobe gets what the GGX lobe's Fresnel term leaves, as in glTF.
        coupled: bool,
        /// What lies above both.
        coat: Option<CaseCoat>,
        /// What lies above both, below the coat.
        sheen: Option<Sheen>,
        /// What replaces the Fresnel term.
        film: Option<ThinFilm>,
    },
    /// Sheen above nothing.
    Sheen(Sheen),
    /// No surface, but a point of a medium.
    Medium {
        /// Henyey and Greenstein's g, in (-1, 1).
        anisotropy: f64,
    },
}

impl CaseMaterial {
    pub(super) fn read(fields: &Fields) -> Result<Self, CaseError> {
        match fields.optional("bsdf", Fields::text)?.unwrap_or("ggx") {
            "diffuse" => Ok(Self::Diffuse { albedo: fields.color("albedo", f64::INFINITY)?, roughness: 0.0 }),
            "eon" => Ok(Self::Diffuse {
                albedo: fields.color("albedo", 1.0)?,
                roughness: fields.share("diffuse_roughness")?,
            }),
            "sheen" => Ok(Self::Sheen(read_sheen(fields)?)),
            "medium" => {
                let anisotropy = fields.number("g")?;
                if anisotropy.abs() >= 1.0 {
                    return Err(fields.error("g", &format!("{anisotropy} must be between -1 and 1")));
                }
                Ok(Self::Medium { anisotropy })
            }
            bsdf @ ("ggx" | "coat" | "sheen_over") => {
                let alpha = if fields.has("alpha_x") || fields.has("alpha_y") {
                    if fields.has("alpha") {
                        return Err(fields.error("alpha", "give either alpha, or alpha_x and alpha_y"));
                    }
                    DVec2::new(fields.alpha("alpha_x")?, fields.alpha("alpha_y")?)
                } else {
                    DVec2::splat(fields.alpha("alpha")?)
                };
                if let Some(masking) = fields.optional("G", Fields::text)?
                    && masking != "correlated"
                {
                    return Err(fields.error("G", &format!("\"{masking}\" is not known; \"correlated\" is")));
                }
                let f0 = fields.optional("F0", |f, field| f.color(field, 1.0))?;
                let albedo = fields.optional("albedo", |f, field| f.color(field, f64::INFINITY))?;
                let coupled = match fields.optional("coupling", Fields::text)? {
                    None => false,
                    Some("gltf") => true,
                    Some(other) => {
                        return Err(
                            fields.error("coupling", &format!("\"{other}\" is not known; \"gltf\" is"))
                        );
                    }
                };
                let coat = if bsdf == "coat" { Some(CaseCoat::read(fields)?) } else { None };
                let sheen = if bsdf == "sheen_over" { Some(read_sheen(fields)?) } else { None };
                let film = if fields.has("film_thickness") { Some(read_film(fields)?) } else { None };
                Ok(Self::Ggx { alpha, f0, albedo, coupled, coat, sheen, film })
            }
            other => {
                let known = "\"ggx\", \"coat\", \"sheen\", \"sheen_over\", \"diffuse\", \"eon\" and \
                    \"medium\" are";
                Err(fields.error("bsdf", &format!("\"{other}\" is not known; {known}")))
            }
        }
    }

    /// The surface as the library has it, or why it cannot be; `tangent` is what `alpha_x` runs along.
    pub(super) fn surface(&self, tangent: Option<DVec3>) -> Result<Surface, String> {
        match self {
            Self::Sheen(sheen) | Self::Ggx { sheen: Some(sheen), .. } if sheen.roughness < MIN_ROUGHNESS => {
                let roughness = sheen.roughness;
                Err(format!(
                    "sheen_roughness {roughness} is below {MIN_ROUGHNESS}, the smallest that is shaded"
                ))
            }
            Self::Medium { .. } => Err("the point is in a medium, on no surface".into()),
            Self::Sheen(sheen) => Ok(Surface { sheen: Some(*sheen), ..Surface::default() }),
            &Self::Diffuse { albedo: diffuse_albedo, roughness: diffuse_roughness } => {
                Ok(Surface { diffuse_albedo, diffuse_roughness, ..Surface::default() })
            }
            Self::Ggx { alpha, .. } if alpha.min_element() < MIN_ALPHA => {
                let least = alpha.min_element();
                Err(format!("alpha {least} is below {MIN_ALPHA}, the smallest that is shaded"))
            }
            Self::Ggx { alpha, .. } if alpha.x != alpha.y && tangent.is_none() => {
                Err("alpha_x and alpha_y differ, and there is no tangent".into())
            }
            Self::Ggx { alpha, f0, albedo, coat, sheen, coupled, film } => Ok(Surface {
                diffuse_albedo: albedo.unwrap_or(DVec3::ZERO),
                f0: f0.unwrap_or(DVec3::ONE),
                f90: 1.0,
                alpha: alpha.y,
                diffuse_roughness: 0.0,
                multiple_scattering: false,
                interface: coupled.then(|| interface(f0.unwrap_or(DVec3::ONE))),
                coat: coat.as_ref().map(CaseCoat::supported).transpose()?,
                sheen: *sheen,
                film: *film,
                anisotropy: tangent
                    .filter(|_| alpha.x != alpha.y)
                    .map(|tangent| Anisotropy { tangent, alpha: alpha.x }),
            }),
        }
    }
}

fn read_sheen(fields: &Fields) -> Result<Sheen, CaseError> {
    Ok(Sheen { color: fields.color("sheen_color", 1.0)?, roughness: fields.alpha("sheen_roughness")? })
}

fn read_film(fields: &Fields) -> Result<ThinFilm, CaseError> {
    let weight = fields.optional("film_weight", Fields::share)?.unwrap_or(1.0);
    let ior = fields.length("film_ior")?;
    if ior < 1.0 {
        return Err(fields.error("film_ior", &format!("{ior} must be at least 1")));
    }
    Ok(ThinFilm { weight, ior, thickness: fields.length("film_thickness")? })
}

/// The interface of a surface whose Lambert lobe is coupled as glTF has it.
fn interface(f0: DVec3) -> Interface {
    Interface { f0: f0.max_element(), f90: 1.0, by_albedo: false }
}
