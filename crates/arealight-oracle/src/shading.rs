//! A polygon light on a surface: the truth by cubature of the true BRDF, and the answer of the fitted table
//! in float64, the twin of the GLSL.

use crate::cubature::{Estimate, Region, Settings, distance_to_origin};
use crate::frame::SurfaceFrame;
use crate::ggx::Ggx;
use crate::polygon::{emitted, form_factor, transformed_form_factor};
use arealight::{LightTable, PolygonLight, Surface};
use glam::DVec3;
use std::f64::consts::PI;

/// A polygon light relative to a shading point, in float64 throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct RelativeLight {
    /// Vertices minus the shading point's position.
    pub vertices: Vec<DVec3>,
    /// Radiance, W/(m² sr).
    pub radiance: DVec3,
    /// Whether the back emits too.
    pub two_sided: bool,
}

impl RelativeLight {
    /// The light as seen from `position`.
    pub fn new(light: &PolygonLight, position: DVec3) -> Self {
        Self {
            vertices: light.vertices.iter().map(|v| *v - position).collect(),
            radiance: light.radiance.as_dvec3(),
            two_sided: light.two_sided,
        }
    }
}

/// The light of a surface, and how well it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Outgoing radiance, W/(m² sr).
    pub radiance: DVec3,
    /// The cubature's error estimate of it, far above the true error.
    pub error: DVec3,
    /// How often the BRDF was evaluated.
    pub evaluations: usize,
}

/// Outgoing radiance by adaptive cubature of the true BRDF: Lambert plus GGX with Schlick's Fresnel term.
///
/// `normal` and `view`, the direction to the viewer, have any length above zero; a view below the surface
/// counts as grazing.
pub fn truth(
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
    settings: &Settings,
) -> Truth {
    let frame = SurfaceFrame::new(normal, view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    let region = if light.two_sided || faces_origin(&vertices) {
        Region::polygon(&vertices).clipped(DVec3::Z)
    } else {
        Region::default()
    };
    let (view, lobe) = (frame.view(), Ggx { alpha: surface.alpha });
    // Integrate each lobe's weight of the light: cos / pi, f cos, and f cos (1 - cos theta_vh)^5
    let diffuse = if surface.diffuse_albedo == DVec3::ZERO {
        Estimate { value: [0.0], error: [0.0], evaluations: 0 }
    } else {
        region.integrate(settings, |_| true, |direction| [direction.z.max(0.0) / PI])
    };
    let grazing = DVec3::splat(surface.f90) - surface.f0;
    let glossy = if surface.f0 == DVec3::ZERO && surface.f90 == 0.0 {
        Estimate { value: [0.0; 2], error: [0.0; 2], evaluations: 0 }
    } else {
        lobe_integrals(lobe, view, &region, settings)
    };
    // Combine them, with the light's side
    let sum = |d: f64, g: [f64; 2]| {
        let lobes = surface.diffuse_albedo * d + surface.f0 * g[0] + grazing * g[1];
        light.radiance * lobes
    };
    let signed = sum(diffuse.value[0], glossy.value);
    let error = sum(diffuse.error[0], glossy.error).abs();
    let radiance = if light.two_sided { signed.abs() } else { signed.max(DVec3::ZERO) };
    Truth { radiance, error, evaluations: diffuse.evaluations + glossy.evaluations }
}

/// Whether the front of a polygon is on the origin's side of its plane.
fn faces_origin(vertices: &[DVec3]) -> bool {
    let Some(&anchor) = vertices.first() else { return false };
    let pairs = vertices[1..].windows(2);
    let area: DVec3 = pairs.map(|pair| (pair[0] - anchor).cross(pair[1] - anchor)).sum();
    area.dot(anchor) < 0.0
}

/// The integrals of `f cos` and of `f cos (1 - cos theta_vh)^5` over a region of the surface frame, for a GGX
/// lobe without Fresnel term. Over the hemisphere they are the lobe's albedo and its Schlick part.
///
/// `view` is a unit vector in the surface frame. The lobe is found however narrow it is, down to
/// [`arealight::MIN_ALPHA`].
pub fn lobe_integrals(lobe: Ggx, view: DVec3, region: &Region, settings: &Settings) -> Estimate<2> {
    let resolved = |triangle: &[DVec3; 3]| lobe_is_resolved(lobe, view, triangle);
    region.integrate(settings, resolved, |direction| {
        let value = lobe.evaluate(view, direction);
        [value, value * Ggx::schlick_weight(view, direction)]
    })
}

/// Whether a triangle is so small that the GGX lobe varies slowly over it: its image under the half vector
/// must not be larger than the scale on which D varies there, `alpha + sin theta_h`.
fn lobe_is_resolved(lobe: Ggx, view: DVec3, triangle: &[DVec3; 3]) -> bool {
    // Project the half vectors onto the surface: D is a function of their distance from the normal
    let halves = triangle.map(|p| (view + p.normalize_or_zero()).normalize_or_zero().with_z(0.0));
    let [a, b, c] = halves;
    let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
    // Near grazing the lobe narrows to a fan: the error estimate sees to what is finer than this
    let finest = 1e-2 * lobe.alpha * lobe.alpha;
    let [p, q, r] = triangle.map(DVec3::normalize_or_zero);
    let angle = p.distance(q).max(q.distance(r)).max(r.distance(p));
    angle < 0.5 && (size <= lobe.alpha + distance_to_origin(&halves) || angle < finest)
}

/// Outgoing radiance by the fitted table (Heitz et al. 2016), with Lambert's lobe exact: the float64 twin of
/// `arealight_polygon_radiance`.
///
/// `normal` and `view` have any length above zero; a view below the surface counts as grazing. The glossy
/// lobe is clipped at the horizon of cosine space only.
pub fn ltc(
    table: &LightTable,
    surface: &Surface,
    normal: DVec3,
    view: DVec3,
    light: &RelativeLight,
) -> DVec3 {
    let frame = SurfaceFrame::new(normal, view);
    let vertices: Vec<DVec3> = light.vertices.iter().map(|v| frame.to_surface(*v)).collect();
    // Look the lobe up
    let sample = table.lookup(surface.alpha.sqrt(), frame.cos_view());
    let specular = surface.f0 * sample.albedo + (DVec3::splat(surface.f90) - surface.f0) * sample.schlick;
    // Integrate the cosine and the transformed cosine
    let diffuse = emitted(form_factor(&vertices), light.two_sided);
    let glossy = emitted(transformed_form_factor(&sample.inverse, &vertices), light.two_sided);
    light.radiance * (surface.diffuse_albedo * diffuse + specular * glossy)
}
