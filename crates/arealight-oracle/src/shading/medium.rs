//! Lights in a medium: what a point of it scatters once.

use super::density::{Directions, density_truth, shape_density_truth};
use super::shapes::LocalShape;
use super::{RelativeLight, Truth};
use crate::cubature::Settings;
use crate::frame::SurfaceFrame;
use crate::phase::{PhaseFit, henyey_greenstein};
use crate::polygon::{emitted, solid_angle, transformed_form_factor};
use arealight::Light;
use glam::{DMat3, DVec3};

/// The frame of a medium's point, whose z is where light goes on to: minus the direction to the viewer.
fn medium_frame(view: DVec3) -> SurfaceFrame {
    SurfaceFrame::new(-view, view.any_orthogonal_vector())
}

/// The radiance that a point of a medium scatters towards the viewer once, by adaptive cubature of the true
/// phase function: W/(m² sr) per unit of length, for a scattering coefficient of 1 and a light that nothing
/// dims. `view`, the direction to the viewer, has any length above zero; `g` is in (-1, 1).
pub fn in_scattered_truth(g: f64, view: DVec3, light: &RelativeLight, settings: &Settings) -> Truth {
    density_truth(&medium_frame(view), light, settings, Directions::All, |to| henyey_greenstein(g, to.z))
}

/// What [`in_scattered_truth`] has, of a disk, sphere or tube without an image; None for polygons and meshes.
/// Silhouettes are drawn as in [`super::shape_truth`].
pub fn shape_in_scattered_truth(g: f64, view: DVec3, light: &Light, settings: &Settings) -> Option<Truth> {
    shape_density_truth(&medium_frame(view), light, settings, Directions::All, |to| {
        henyey_greenstein(g, to.z)
    })
}

/// The same as [`in_scattered_truth`] by [`PhaseFit::HG`], exactly integrated: the float64 twin of
/// `arealight_in_scattered`. `g` counts as in [`PhaseFit::lobes`].
pub fn in_scattered(g: f64, view: DVec3, light: &RelativeLight) -> DVec3 {
    let (lobes, frame) = (PhaseFit::HG.lobes(g), medium_frame(view));
    if light.image.is_some() || light.profile.is_some() {
        let density = |to: DVec3| lobes.density(to.z);
        return density_truth(&frame, light, &Settings::default(), Directions::All, density).radiance;
    }
    let vertices = light.seen(&frame);
    let covered = emitted(solid_angle(&vertices), light.two_sided);
    let form_factor = |space: &DMat3| emitted(transformed_form_factor(space, &vertices), light.two_sided);
    light.radiance * lobes.sum(covered, form_factor)
}

/// The same of a disk, sphere or tube without an image; None for polygons and meshes.
pub fn shape_in_scattered(g: f64, view: DVec3, light: &Light) -> Option<DVec3> {
    let seen = LocalShape::new(light, &medium_frame(view))?;
    let sum = PhaseFit::HG.lobes(g).sum(seen.solid_angle(), |space| seen.form_factor(space));
    Some(light.radiance.as_dvec3() * sum)
}
