//! What any density of directions takes of a light.

use super::profiled::factor_in;
use super::shapes::LocalShape;
use super::{RelativeLight, Truth};
use crate::cubature::{Region, Settings, angles};
use crate::frame::SurfaceFrame;
use crate::polygon::emitted;
use arealight::Light;
use glam::DVec3;

/// Where light comes from that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Directions {
    /// From all around: a point of a medium.
    All,
    /// From above the frame's plane: a point of a surface.
    Above,
}

impl Directions {
    fn cut(self, region: &Region) -> Region {
        match self {
            Self::All => region.clone(),
            Self::Above => region.clipped(DVec3::Z),
        }
    }
}

/// The integral of a polygon's radiance, with what it shows, times `density`, a function of unit directions
/// in the frame, a steradian. A surface's is its BRDF times the cosine. By adaptive cubature: a narrow lobe
/// may be missed, unlike [`super::truth`]'s, whose lobes are known.
pub fn density_truth(
    frame: &SurfaceFrame,
    light: &RelativeLight,
    settings: &Settings,
    directions: Directions,
    density: impl Fn(DVec3) -> f64,
) -> Truth {
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    let image = light.image.as_ref().map(|image| image.in_frame(frame));
    let Some(bounds) = light.limits() else { return Truth::default() };
    let region = match &image {
        None => Region::polygon(&vertices),
        Some(image) => image.region(&vertices, settings.max_evaluations / super::EVALUATIONS_PER_TEXEL),
    };
    let region = bounds.iter().fold(region, |region, normal| region.clipped(frame.to_surface(*normal)));
    let azimuth = frame.to_surface(light.azimuth);
    let estimate = directions.cut(&region).integrate(settings, angles, |to| {
        let shown = image.as_ref().map_or(DVec3::ONE, |image| image.color(to));
        let factor = light.profile.as_ref().map_or(1.0, |profile| factor_in(profile, azimuth, &vertices, to));
        (shown * (factor * density(to))).to_array()
    });
    Truth {
        radiance: light.radiance * DVec3::from(estimate.value.map(|x| emitted(x, light.two_sided))),
        error: light.radiance * DVec3::from(estimate.error),
        evaluations: estimate.evaluations,
    }
}

/// What [`density_truth`] has, of a disk, sphere or tube without an image; None for polygons and meshes.
/// Silhouettes are drawn as in [`super::shape_truth`].
pub fn shape_density_truth(
    frame: &SurfaceFrame,
    light: &Light,
    settings: &Settings,
    directions: Directions,
    density: impl Fn(DVec3) -> f64,
) -> Option<Truth> {
    let seen = LocalShape::new(light, frame)?;
    Some(seen.refined_truth(light.radiance.as_dvec3(), |region| {
        let estimate = directions.cut(region).integrate(settings, angles, |to| [density(to)]);
        let [value, error] = [estimate.value, estimate.error].map(|x| DVec3::splat(x[0]));
        Truth { radiance: value, error, evaluations: estimate.evaluations }
    }))
}
