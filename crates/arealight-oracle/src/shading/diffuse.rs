//! A Lambert lobe below an interface, in float64: the truth, and its fitted lobe.

use super::{fitted_sample, hemisphere_albedo};
use crate::cubature::Settings;
use crate::frame::SurfaceFrame;
use crate::ggx::Ggx;
use crate::material::{Interface, Surface};
use arealight::{LightTable, Quality};
use glam::{DMat3, DVec3};

/// What the interface leaves of a Lambert lobe's light, from a direction of the surface frame: 1 without one. `by_albedo` is
/// what [`albedo_part`] says.
pub(super) fn part(interface: Option<Interface>, by_albedo: f64, view: DVec3, direction: DVec3) -> f64 {
    match interface {
        None => 1.0,
        Some(Interface { by_albedo: true, .. }) => by_albedo,
        Some(Interface { f0, f90, .. }) => 1.0 - f0 - (f90 - f0) * Ggx::schlick_weight(view, direction),
    }
}

/// What the true albedo of the surface's GGX lobe at a view leaves, where that is asked for; else 1.
pub(super) fn albedo_part(surface: &Surface, view: DVec3, settings: &Settings) -> f64 {
    match surface.interface {
        Some(Interface { f0, f90, by_albedo: true }) => {
            1.0 - hemisphere_albedo(surface.alpha, f0, f90, view, settings)
        }
        _ => 1.0,
    }
}

/// The lobe of a Lambert lobe below its interface, the twin of `arealight_coupled_diffuse_lobe`: M⁻¹ of the surface frame, whose
/// horizon is the surface's, and the part of the albedo.
pub(super) fn lobe(
    quality: Quality,
    table: &LightTable,
    surface: &Surface,
    frame: &SurfaceFrame,
) -> (DMat3, f64) {
    let Some(Interface { f0, f90, by_albedo }) = surface.interface else { return (DMat3::IDENTITY, 1.0) };
    if by_albedo {
        let sample = fitted_sample(quality, table, surface.alpha, frame.cos_view());
        return (DMat3::IDENTITY, 1.0 - (f0 * sample.albedo + (f90 - f0) * sample.schlick));
    }
    let x = 1.0 - frame.cos_view();
    let schlick = 8.19e-5 + x * (2.0063e-3 + x * (9.3423e-3 + x * (7.707e-3 + x * 9.0207e-3)));
    let varies = ((f90 - f0) / (1.0 - f0).max(1e-3)).clamp(-1.0, 1.0);
    let stretch = 1.0 + varies * x * x * (0.028841 + 0.011653 * x * x);
    let shear = -varies * x * x * (0.012844 + 0.013407 * x * x);
    let inverse = DMat3::from_cols(DVec3::X * stretch, DVec3::Y, DVec3::new(shear, 0.0, 1.0));
    (inverse, 1.0 - f0 - (f90 - f0) * schlick)
}
