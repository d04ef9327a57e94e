//! Lights in a medium: what a point of it scatters once.

use super::profiled::factor_in;
use super::shapes::LocalShape;
use super::{RelativeLight, Truth};
use crate::cubature::{Region, Settings, angles};
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
    over_polygon(view, light, settings, |mu| henyey_greenstein(g, mu))
}

/// What [`in_scattered_truth`] has, of a disk, sphere or tube without an image; None for polygons and meshes.
/// Silhouettes are drawn as in [`super::shape_truth`].
pub fn shape_in_scattered_truth(g: f64, view: DVec3, light: &Light, settings: &Settings) -> Option<Truth> {
    let frame = medium_frame(view);
    let seen = LocalShape::new(light, &frame)?;
    Some(seen.refined_truth(light.radiance.as_dvec3(), |region| {
        let estimate = region.integrate(settings, angles, |to| [henyey_greenstein(g, to.z)]);
        let [value, error] = [estimate.value, estimate.error].map(|x| DVec3::splat(x[0]));
        Truth { radiance: value, error, evaluations: estimate.evaluations }
    }))
}

/// The same as [`in_scattered_truth`] by [`PhaseFit::HG`], exactly integrated: the float64 twin of
/// `arealight_in_scattered`. `g` counts as in [`PhaseFit::lobes`].
pub fn in_scattered(g: f64, view: DVec3, light: &RelativeLight) -> DVec3 {
    let lobes = PhaseFit::HG.lobes(g);
    if light.image.is_some() || light.profile.is_some() {
        return over_polygon(view, light, &Settings::default(), |mu| lobes.density(mu)).radiance;
    }
    let frame = medium_frame(view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
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

/// A polygon, with what it shows, times a density of the cosine to where light goes on to.
fn over_polygon(
    view: DVec3,
    light: &RelativeLight,
    settings: &Settings,
    density: impl Fn(f64) -> f64,
) -> Truth {
    let frame = medium_frame(view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    let image = light.image.as_ref().map(|image| image.in_frame(&frame));
    let region = match &image {
        None => Region::polygon(&vertices),
        Some(image) => image.region(&vertices, settings.max_evaluations / super::EVALUATIONS_PER_TEXEL),
    };
    let estimate = region.integrate(settings, angles, |to| {
        let shown = image.as_ref().map_or(DVec3::ONE, |image| image.color(to));
        let factor = light.profile.as_ref().map_or(1.0, |profile| factor_in(profile, &vertices, to));
        (shown * (factor * density(to.z))).to_array()
    });
    Truth {
        radiance: light.radiance * DVec3::from(estimate.value.map(|x| emitted(x, light.two_sided))),
        error: light.radiance * DVec3::from(estimate.error),
        evaluations: estimate.evaluations,
    }
}
