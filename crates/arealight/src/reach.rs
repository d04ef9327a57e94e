//! How far a light is of any matter: what forward and clustered hosts sort lights by.

#[cfg(doc)]
use crate::LightTable;
use crate::light_shape::FLAT;
use crate::profile::angle_of;
use crate::{Light, LightShape, Profile};
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// The density a steradian of Lambert's lobe of albedo 1, where it is largest.
pub const DIFFUSE_DENSITY: f64 = 1.0 / PI;

/// How far from [`LightShape::center`] of its shape `light` may reflect a radiance above `threshold` in any
/// channel, in W/(m² sr), from surfaces whose lobes, times their albedos, are nowhere denser than `density` a
/// steradian: the sum of [`DIFFUSE_DENSITY`] and [`LightTable::lobe_density`] for opaque surfaces of at least
/// that roughness, [`DIFFUSE_DENSITY`] for surfaces without a specular lobe.
///
/// Infinite where nothing bounds it: of a textured light, whose image may be of any brightness, with a
/// threshold of zero, or for a light that is not finite. What several lights add up to may be more than the
/// threshold.
///
/// A light's solid angle is at most its area over the square of the distance to its nearest point, and what
/// is reflected at most radiance times density times that.
pub fn radius(light: &Light, threshold: f64, density: f64) -> f64 {
    if light.radiance == Vec3::ZERO {
        return 0.0;
    }
    let size = size_about(&light.shape);
    let brightest =
        if light.texture.is_some() { f64::INFINITY } else { f64::from(light.radiance.max_element()) };
    let brightest = brightest * light.profile.as_ref().map_or(1.0, Profile::greatest);
    let reflected = brightest.max(0.0) * density * most_area(&light.shape, size);
    let radius = size + (reflected / threshold).sqrt();
    if radius.is_finite() { radius } else { f64::INFINITY }
}

/// The corners of an axis-aligned box, in world positions, outside of which a surface reflects no more of the
/// light than outside of [`radius`]: the box of that sphere, or of the half in front of a flat one-sided
/// light. None is NaN; all are infinite where the radius is.
pub fn bounds(light: &Light, radius: f64) -> [DVec3; 2] {
    let (center, size) = (light.shape.center(), size_about(&light.shape));
    let shines_to_one_side = light.shape.is_flat() && !light.two_sided;
    let normal = light.shape.area_vector().normalize_or_zero();
    // Within its cone a profile's light goes no farther along an axis than the cone's direction next to it
    let end = light.profile.as_ref().map_or(FRAC_PI_2, |profile| angle_of(profile.end()));
    let along = |axis: f64| {
        if shines_to_one_side && light.profile.is_some() && normal != DVec3::ZERO {
            let beside = (angle_of(axis) - end).max(0.0);
            return radius * (beside.cos().max(0.0) + 1e-6) + (1.0 + FLAT) * size;
        }
        if !shines_to_one_side || axis >= 0.0 || normal == DVec3::ZERO {
            return radius;
        }
        // In the plane of the light, which is as flat as LightShape::is_flat says, and of a float32 normal
        radius * ((1.0 - axis * axis).max(0.0).sqrt() + 1e-6) + FLAT * size
    };
    [center - (-normal).map(along), center + normal.map(along)]
}

/// The radius of a sphere about the center that holds the light.
fn size_about(shape: &LightShape) -> f64 {
    match *shape {
        LightShape::Disk { axis_u, axis_v, .. } => axis_u.length().hypot(axis_v.length()),
        LightShape::Sphere { radius, .. } => radius,
        LightShape::Tube { p0, p1, radius, .. } => 0.5 * p0.distance(p1) + radius,
        LightShape::Polygon(_) | LightShape::Mesh { .. } => {
            let center = shape.center();
            shape.vertices().iter().map(|vertex| vertex.distance(center)).fold(0.0, f64::max)
        }
    }
}

/// The area of the triangles from the first vertex to each edge, which cover what an outline spans.
fn fan_area(outline: &[DVec3]) -> f64 {
    let Some((first, rest)) = outline.split_first() else { return 0.0 };
    rest.windows(2).map(|edge| 0.5 * (edge[0] - first).cross(edge[1] - first).length()).sum()
}

/// No point sees more of the light than this, in square units, from outside of the sphere that holds it: its
/// solid angle is at most that over the square of the distance to the nearest point.
fn most_area(shape: &LightShape, size: f64) -> f64 {
    match shape {
        LightShape::Disk { .. } => shape.area_vector().length(),
        // 2 (1 - cos a) <= tan(a)^2 <= r^2 / (D - r)^2 where sin a = r / D
        LightShape::Sphere { radius, .. } => PI * radius * radius,
        // Half of a capsule's surface
        LightShape::Tube { radius, .. } => 2.0 * PI * radius * size,
        LightShape::Polygon(_) if shape.is_flat() => shape.area_vector().length(),
        LightShape::Polygon(_) | LightShape::Mesh { .. } => shape.outlines().map(fan_area).sum(),
    }
}
