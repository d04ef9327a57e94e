//! The clear coat of a case.

use super::CaseError;
use super::fields::Fields;
use arealight::MIN_ALPHA;
use arealight_oracle::material::Coat;
use glam::DVec3;

/// A coat above other lobes.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseCoat {
    /// How much of the surface it covers, in [0, 1].
    pub weight: f64,
    /// GGX alpha, in (0, 1].
    pub alpha: f64,
    /// Its reflectance at normal incidence, in [0, 1].
    pub f0: f64,
    /// Its normal, not zero, of any length; `None` for the surface's.
    pub normal: Option<DVec3>,
    /// Whether it is weighted by its albedo at the view, Fresnel term included; else by Schlick's term of the
    /// view, as in glTF.
    pub by_albedo: bool,
}

impl CaseCoat {
    pub(super) fn read(fields: &Fields) -> Result<Self, CaseError> {
        let by_albedo = match fields.text("layering")? {
            "gltf" => false,
            "albedo" => true,
            other => {
                let message = format!("\"{other}\" is not known; \"gltf\" and \"albedo\" are");
                return Err(fields.error("layering", &message));
            }
        };
        Ok(Self {
            weight: fields.share("coat_weight")?,
            alpha: fields.alpha("coat_alpha")?,
            f0: fields.share("coat_F0")?,
            normal: fields.optional("coat_normal", Fields::direction)?,
            by_albedo,
        })
    }

    /// The coat as the library has it, or why it cannot be.
    pub(super) fn supported(&self) -> Result<Coat, String> {
        let Self { weight, alpha, f0, normal, by_albedo } = *self;
        if f0 != Coat::F0 {
            return Err(format!("coat_F0 {f0} is not supported; {} is", Coat::F0));
        }
        if alpha < MIN_ALPHA {
            return Err(format!("coat_alpha {alpha} is below {MIN_ALPHA}, the smallest that is shaded"));
        }
        Ok(Coat { weight, alpha, normal, by_albedo })
    }
}
