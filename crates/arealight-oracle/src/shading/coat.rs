//! A clear coat above other lobes, in float64: its true BRDF, and its fitted lobe.

use super::half_vectors::HalfVectors;
use super::{Truth, fitted_sample, hemisphere_albedo};
use crate::cubature::Settings;
use crate::frame::SurfaceFrame;
use crate::ggx::Ggx;
use crate::material::{Coat, Surface};
use arealight::table::share_above_surface;
use arealight::{LightTable, Quality, SpecularLobes};
use glam::{DMat3, DVec3};

/// What a coated surface reflects: `uncoated` says what a surface without a coat does, with its normal and a
/// direction to the viewer.
///
/// A coat is such a surface itself: GGX about its own normal, without Fresnel term where it isn't by albedo.
/// A view from below the base counts as grazing, for the coat too.
pub(super) fn layered<E>(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    settings: &Settings,
    uncoated: impl Fn(&Surface, DVec3, DVec3) -> Result<Truth, E>,
) -> Result<Truth, E> {
    let below = uncoated(surface, normal, view)?;
    let Some(coat) = surface.coat else { return Ok(below) };
    let frame = SurfaceFrame::new(normal, view);
    let view = frame.from_surface(frame.view());
    let own_normal = coat.normal.unwrap_or_else(|| frame.from_surface(DVec3::Z));
    let own_view = SurfaceFrame::new(own_normal, view);
    // What the coat's lobe counts, and what it takes from those below
    let (f0, weight, share) = if coat.by_albedo {
        let fresnel = |cosine: f64| Coat::F0 + (1.0 - Coat::F0) * (1.0 - cosine).powi(5);
        let albedo = hemisphere_albedo(Ggx { alpha: coat.alpha }, own_view.view(), settings, fresnel);
        (Coat::F0, coat.weight, coat.weight * albedo)
    } else {
        let share = coat.share(own_view.cos_view());
        (1.0, share, share)
    };
    let lobe = Surface { f0: DVec3::splat(f0), f90: 1.0, alpha: coat.alpha, ..Surface::default() };
    let above = uncoated(&lobe, own_normal, view)?;
    Ok(Truth {
        radiance: below.radiance * (1.0 - share) + above.radiance * weight,
        error: below.error * (1.0 - share) + above.error * weight,
        evaluations: below.evaluations + above.evaluations,
    })
}

/// The fitted lobe of a coat.
pub(super) struct CoatLobe {
    /// M⁻¹ of the base's surface frame.
    pub inverse: DMat3,
    /// The larger of its parts above the base's horizon and above its own.
    pub above_surface: f64,
    /// What it reflects of the light.
    pub albedo: f64,
    /// The part of the light that it takes from what is below.
    pub share: f64,
    /// The same lobe by [`SpecularLobes::HalfVectors`]; none on other levels.
    pub half_vectors: Option<HalfVectors>,
}

impl CoatLobe {
    /// The twin of `arealight_coat_layer`. `frame` is the base's.
    pub fn new(quality: Quality, table: &LightTable, coat: &Coat, frame: &SurfaceFrame) -> Self {
        let normal = coat.normal.map_or(DVec3::Z, |normal| frame.to_surface(normal));
        let own = SurfaceFrame::new(normal, frame.view());
        let sample = fitted_sample(quality, table, coat.alpha, own.cos_view());
        let to_own =
            DMat3::from_cols(own.to_surface(DVec3::X), own.to_surface(DVec3::Y), own.to_surface(DVec3::Z));
        let (in_own, albedo, share, reflectances) = if coat.by_albedo {
            let albedo = coat.weight * (Coat::F0 * sample.albedo + (1.0 - Coat::F0) * sample.schlick);
            (sample.inverse_by_f0(Coat::F0, 1.0), albedo, albedo, [coat.weight * Coat::F0, coat.weight])
        } else {
            let share = coat.share(own.cos_view());
            (sample.inverse, share * sample.albedo, share, [share; 2])
        };
        let inverse = in_own * to_own;
        let above_surface = share_above_surface(&in_own).max(share_above_surface(&inverse));
        let half_vectors = (quality.specular_lobes == SpecularLobes::HalfVectors)
            .then(|| HalfVectors::of_coat(quality, table, coat.alpha, reflectances, (&own, to_own)));
        Self { inverse, above_surface, albedo, share, half_vectors }
    }
}
