//! Openings that lights are seen through: windows, the doors of lamps, the cells of grids.
//!
//! An opening lies in an opaque plane with all of the light on one side. From a point on the other side the
//! light's outline is clipped by the opening's, exactly, for every lobe: docs/shaped-light.md.

use crate::LightShape;
use crate::light_fault::LightFault;
use glam::{DAffine3, DVec3};
use std::f64::consts::FRAC_PI_2;

/// A parallelogram in an opaque plane, through which a light on one side of it is seen from the other.
///
/// ```
/// use arealight::{Light, LightShape, Opening, glam::dvec3};
/// let corners = [(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1)].map(|(x, y)| dvec3(x, y, 0.0));
/// let lamp = LightShape::Polygon(corners.to_vec());
/// // Doors of 15 cm at its four sides, opened by 30 degrees
/// let opening = Opening::doors(&lamp, 0.15, 30_f64.to_radians())?;
/// assert!((opening.axis_u.length() - 0.275).abs() < 1e-12);
/// let light = Light { shape: lamp, opening: Some(opening), ..Light::default() };
/// light.validate()?;
/// # Ok::<(), arealight::LightFault>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Opening {
    /// Its middle, in world positions.
    pub center: DVec3,
    /// A half axis: from the middle to the middle of a side.
    pub axis_u: DVec3,
    /// The other one.
    pub axis_v: DVec3,
    /// Whether the light is in a housing that the opening is the only way out of, as between a lamp's doors:
    /// points on the light's side of the plane see nothing of it then. Else they see all of it, as those
    /// outside of a window see the sky.
    pub housed: bool,
}

impl Opening {
    /// The end of doors of a length, hinged at the four sides of a light and each opened outwards by an angle
    /// from the light's normal, radians, from 0 to below pi / 2. Their corners are closed, too.
    ///
    /// # Errors
    /// [`LightFault::BadOpening`] for a light that is neither a parallelogram nor a disk, which gets the
    /// square about it, and for other lengths and angles.
    pub fn doors(shape: &LightShape, length: f64, angle: f64) -> Result<Self, LightFault> {
        if !(length > 0.0 && length.is_finite() && (0.0..FRAC_PI_2 - 1e-3).contains(&angle)) {
            return Err(bad(format!("doors of {length} opened by {angle} rad: above 0, from 0 to 1.569")));
        }
        let (u, v) = half_axes(shape)?;
        let (sin, cos) = angle.sin_cos();
        let normal = shape.area_vector().normalize_or_zero();
        // A door goes out across its hinge
        let (across_v, across_u) = (v.cross(normal).normalize_or_zero(), normal.cross(u).normalize_or_zero());
        let grown = |axis: DVec3, across: DVec3| {
            let reach = axis.dot(across);
            axis * ((reach + length * sin) / reach)
        };
        Ok(Self {
            center: shape.center() + normal * (length * cos),
            axis_u: grown(u, across_v),
            axis_v: grown(v, across_u),
            housed: true,
        })
    }

    /// The opening moved by a transform.
    #[must_use]
    pub fn moved(self, by: &DAffine3) -> Self {
        Self {
            center: by.transform_point3(self.center),
            axis_u: by.transform_vector3(self.axis_u),
            axis_v: by.transform_vector3(self.axis_v),
            ..self
        }
    }

    /// Checks it, for a light of this shape.
    pub(crate) fn check(&self, shape: &LightShape) -> Result<(), LightFault> {
        for (field, value) in [("center", self.center), ("axis_u", self.axis_u), ("axis_v", self.axis_v)] {
            if !value.as_vec3().is_finite() {
                return Err(bad(format!("{field}: {value} is not finite")));
            }
        }
        let normal = self.axis_u.normalize_or_zero().cross(self.axis_v.normalize_or_zero());
        if normal.length() < 1e-6 {
            return Err(bad(format!("axis_u and axis_v: {} and {} span no area", self.axis_u, self.axis_v)));
        }
        let heights = shape.vertices().iter().map(|vertex| (*vertex - self.center).dot(normal));
        let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        // A light in the opening's plane is all of it to one side, to rounding
        let size = shape.vertices().iter().map(|vertex| vertex.distance(self.center)).fold(0.0, f64::max);
        if low.abs().min(high) > 1e-6 * size {
            return Err(bad("the light lies on both sides of its plane: cut it in two".into()));
        }
        Ok(())
    }

    /// What the GPU reads, relative to `origin`: `lights/opening.glsl` has the rows.
    pub(crate) fn rows(&self, vertices: &[DVec3], origin: DVec3) -> [[f32; 4]; 8] {
        let middle = self.center - origin;
        let normal = self.axis_u.cross(self.axis_v).normalize_or_zero();
        // u x v points to the light
        let side = vertices.iter().map(|vertex| (*vertex - self.center).dot(normal)).sum::<f64>();
        let (u, v) = if side < 0.0 { (-self.axis_u, self.axis_v) } else { (self.axis_u, self.axis_v) };
        let to_light = u.cross(v).normalize_or_zero();
        let row = |vector: DVec3, number: f64| vector.as_vec3().extend(number as f32).to_array();
        let plane = |normal: DVec3, through: DVec3| row(normal, normal.dot(through));
        // Beyond the plane through a side and the light's vertex that is farthest inwards, nothing is seen
        let by_side = |side: DVec3, along: DVec3| {
            let inwards = (middle - side).normalize_or_zero();
            let from_side = |vertex: &DVec3| *vertex - origin - side;
            let mut found = to_light;
            for vertex in vertices.iter().map(from_side).filter(|vertex| *vertex != DVec3::ZERO) {
                let normal = along.cross(vertex).normalize_or_zero();
                let normal = if normal.dot(inwards) < 0.0 { -normal } else { normal };
                // Of a vertex in the opening's plane, that plane
                let normal = if normal.dot(inwards) < 1e-6 { -to_light } else { normal };
                found = if found.dot(vertex) > 0.0 { normal } else { found };
            }
            plane(found, side)
        };
        [
            row(middle, if self.housed { 1.0 } else { 0.0 }),
            row(u, 0.0),
            row(v, 0.0),
            plane(-to_light, middle),
            by_side(middle + u, v),
            by_side(middle - u, v),
            by_side(middle + v, u),
            by_side(middle - v, u),
        ]
    }
}

/// The half axes of a parallelogram or disk, counter-clockwise seen from its front.
pub(crate) fn half_axes(shape: &LightShape) -> Result<(DVec3, DVec3), LightFault> {
    match shape {
        LightShape::Disk { axis_u, axis_v, .. } => Ok((*axis_u, *axis_v)),
        LightShape::Polygon(vertices) => {
            let [a, b, c, d] = vertices[..] else { return Err(no_parallelogram()) };
            let size = (c - a).length().max((d - b).length());
            if !((a + c) - (b + d)).length().le(&(1e-4 * size)) || !(b - a).cross(d - a).is_finite() {
                return Err(no_parallelogram());
            }
            Ok((0.5 * (b - a), 0.5 * (d - a)))
        }
        _ => Err(no_parallelogram()),
    }
}

pub(crate) fn no_parallelogram() -> LightFault {
    bad("doors and grids are of parallelograms, doors of disks, too".into())
}

pub(crate) fn bad(reason: String) -> LightFault {
    LightFault::BadOpening { reason }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::gpu::GpuLight;
    use crate::{Light, PackedLights};
    use glam::{Vec3, dvec3};

    pub(crate) fn lamp() -> Light {
        let corners = [(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1)].map(|(x, y)| dvec3(x, y, 5.0));
        Light { radiance: Vec3::ONE, shape: LightShape::Polygon(corners.to_vec()), ..Light::default() }
    }

    #[test]
    fn doors_end_where_they_reach() {
        let doors = Opening::doors(&lamp().shape, 0.5, 30_f64.to_radians()).unwrap();
        assert!((doors.center - dvec3(0.0, 0.0, 5.0 + 0.5 * 0.75_f64.sqrt())).length() < 1e-12);
        assert!((doors.axis_u - dvec3(0.45, 0.0, 0.0)).length() < 1e-12, "{doors:?}");
        assert!((doors.axis_v - dvec3(0.0, 0.35, 0.0)).length() < 1e-12, "{doors:?}");
        // Of a slanted parallelogram the doors are as far from their hinges, across them
        let slanted = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (1.0, 1.0)].map(|(x, y)| dvec3(x, y, 0.0));
        let doors = Opening::doors(&LightShape::Polygon(slanted.to_vec()), 1.0, 30_f64.to_radians()).unwrap();
        let height = |axis: DVec3, other: DVec3| axis.cross(other.normalize_or_zero()).length();
        assert!((height(doors.axis_v, doors.axis_u) - 1.0).abs() < 1e-12);
        assert!((height(doors.axis_u, doors.axis_v) - 0.5 * 2.0 / 2_f64.sqrt() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn planes_hold_what_the_light_reaches() {
        let doors = Opening::doors(&lamp().shape, 0.5, 0.1).unwrap();
        let light = Light { opening: Some(doors), ..lamp() };
        let packed = PackedLights::new(&[light], DVec3::ZERO).unwrap();
        let record = packed.lights[0];
        assert_eq!(record.flags & GpuLight::SHAPED, GpuLight::OPENING);
        let rows = &packed.vertices[record.shaping as usize..];
        let is_reached =
            |point: Vec3| rows[3..8].iter().all(|plane| Vec3::from_slice(plane).dot(point) - plane[3] > 0.0);
        // Through the opening from the light's opposite side; half a millimetre makes the difference
        let end = doors.center + doors.axis_u;
        let along = end - dvec3(-0.2, 0.0, 5.0);
        for (shift, expected) in [(-5e-4, true), (5e-4, false)] {
            assert_eq!(is_reached((end + along + dvec3(shift, 0.0, 0.0)).as_vec3()), expected);
        }
        // And not behind the doors' end
        assert!(!is_reached(Vec3::new(0.0, 0.0, 5.2)));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let light = |opening| Light { opening: Some(opening), ..lamp() };
        let good = Opening::doors(&lamp().shape, 0.5, 0.1).unwrap();
        light(good).validate().unwrap();
        for (opening, expected) in [
            (Opening { center: DVec3::NAN, ..good }, "opening: center"),
            (Opening { axis_v: good.axis_u, ..good }, "opening: axis_u and axis_v"),
            (Opening { axis_v: DVec3::ZERO, ..good }, "opening: axis_u and axis_v"),
            (Opening { axis_u: DVec3::Z, center: DVec3::ZERO, ..good }, "opening: the light lies on both"),
        ] {
            let text = light(opening).validate().unwrap_err().to_string();
            assert!(text.starts_with(expected), "{text}");
        }
        let sphere = LightShape::Sphere { center: DVec3::ZERO, radius: 1.0 };
        let ball = Light { shape: sphere.clone(), ..light(good) };
        assert!(ball.validate().unwrap_err().to_string().starts_with("profile or opening: of a mesh"));
        for (length, angle) in [(0.0, 0.1), (f64::NAN, 0.1), (1.0, -0.1), (1.0, 1.6), (1.0, f64::NAN)] {
            assert!(Opening::doors(&lamp().shape, length, angle).is_err(), "{length} {angle}");
        }
        assert!(Opening::doors(&sphere, 1.0, 0.1).is_err());
        for (columns, rows, depth) in [(0, 1, 0.1), (1, 0, 0.1), (100, 100, 0.1), (2, 2, 0.0)] {
            assert!(lamp().behind_grid(columns, rows, depth).is_err(), "{columns} {rows} {depth}");
        }
        assert!(ball.behind_grid(2, 2, 0.1).is_err());
    }
}
