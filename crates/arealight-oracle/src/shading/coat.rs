//! A clear coat above other lobes, in float64: its true BRDF, and its fitted lobe.

use super::{Truth, fitted_sample};
use crate::frame::SurfaceFrame;
use crate::material::{Coat, Surface};
use arealight::table::share_above_surface;
use arealight::{LightTable, Quality};
use glam::{DMat3, DVec3};

/// What a coated surface reflects: `uncoated` says what a surface without a coat does, with its normal and a direction to the viewer.
///
/// A coat is such a surface itself: GGX without Fresnel term, about its own normal. A view from below the base counts as grazing,
/// for the coat too.
pub(super) fn layered<E>(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    uncoated: impl Fn(&Surface, DVec3, DVec3) -> Result<Truth, E>,
) -> Result<Truth, E> {
    let below = uncoated(surface, normal, view)?;
    let Some(coat) = surface.coat else { return Ok(below) };
    let frame = SurfaceFrame::new(normal, view);
    let view = frame.from_surface(frame.view());
    let own_normal = coat.normal.unwrap_or_else(|| frame.from_surface(DVec3::Z));
    let lobe = Surface {
        diffuse_albedo: DVec3::ZERO,
        f0: DVec3::ONE,
        f90: 1.0,
        alpha: coat.alpha,
        coat: None,
        sheen: None,
    };
    let above = uncoated(&lobe, own_normal, view)?;
    let share = coat.share(SurfaceFrame::new(own_normal, view).cos_view());
    Ok(Truth {
        radiance: below.radiance.lerp(above.radiance, share),
        error: below.error.lerp(above.error, share),
        evaluations: below.evaluations + above.evaluations,
    })
}

/// The fitted lobe of a coat.
pub(super) struct CoatLobe {
    /// M⁻¹ of the base's surface frame.
    pub inverse: DMat3,
    /// The larger of its parts above the base's horizon and above its own.
    pub above_surface: f64,
    /// What it reflects of the light that it gets.
    pub albedo: f64,
    /// The part of the light that it gets.
    pub share: f64,
}

impl CoatLobe {
    /// The twin of `arealight_coat_layer`. `frame` is the base's.
    pub fn new(quality: Quality, table: &LightTable, coat: &Coat, frame: &SurfaceFrame) -> Self {
        let normal = coat.normal.map_or(DVec3::Z, |normal| frame.to_surface(normal));
        let own = SurfaceFrame::new(normal, frame.view());
        let sample = fitted_sample(quality, table, coat.alpha, own.cos_view());
        let to_own =
            DMat3::from_cols(own.to_surface(DVec3::X), own.to_surface(DVec3::Y), own.to_surface(DVec3::Z));
        let inverse = sample.inverse * to_own;
        Self {
            inverse,
            above_surface: share_above_surface(&sample.inverse).max(share_above_surface(&inverse)),
            albedo: sample.albedo,
            share: coat.share(own.cos_view()),
        }
    }
}
