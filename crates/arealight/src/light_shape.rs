//! The shapes of lights: polygons, meshes, disks, spheres and tubes.

use crate::FaceClusters;
use glam::{DAffine3, DVec3};
use std::f64::consts::PI;

/// How far a vertex of a flat polygon may be off its plane, as a part of its size.
pub(crate) const FLAT: f64 = 1e-4;

/// The shape of a light, in world positions in the scene's unit of length.
#[derive(Debug, Clone, PartialEq)]
pub enum LightShape {
    /// A flat polygon of three vertices or more, convex or concave, whose edges do not cross. Holes are cut
    /// by [`Light::cut_holes`](crate::Light::cut_holes). Seen from the front, the
    /// vertices run counter-clockwise.
    Polygon(Vec<DVec3>),
    /// Several flat faces, each an outline as a polygon's: see [`crate::mesh`].
    Mesh {
        /// The vertices of all faces, one face after another.
        vertices: Vec<DVec3>,
        /// How many of the vertices each face has; one face alone is a polygon.
        faces: Vec<u32>,
        /// None, or as [`LightShape::clustered`] made them for these faces as they are.
        clusters: FaceClusters,
    },
    /// A flat disk or ellipse: `center + cos(t) axis_u + sin(t) axis_v` is its outline. A disk has
    /// perpendicular axes of one length; any two axes that are not parallel will do. The front is the side of
    /// `axis_u × axis_v`.
    Disk {
        /// The middle.
        center: DVec3,
        /// A half axis.
        axis_u: DVec3,
        /// The half axis that is conjugate to it.
        axis_v: DVec3,
    },
    /// A sphere, which emits outwards.
    Sphere {
        /// The middle.
        center: DVec3,
        /// Above zero.
        radius: f64,
    },
    /// A cylinder or capsule, which emits outwards.
    Tube {
        /// Where the axis begins.
        p0: DVec3,
        /// Where it ends: another point.
        p1: DVec3,
        /// Above zero.
        radius: f64,
        /// What its ends are.
        ends: TubeEnds,
    },
}

impl Default for LightShape {
    /// A polygon without vertices, which is refused when it is packed.
    fn default() -> Self {
        Self::Polygon(Vec::new())
    }
}

/// What the ends of a tube are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum TubeEnds {
    /// The lateral surface alone shines; through the ends a black inside is seen.
    #[default]
    Open = 0,
    /// Flat caps shine too.
    Flat = 1,
    /// Half spheres about both ends of the axis: a capsule.
    Round = 2,
}

impl LightShape {
    /// The vertices of a polygon or mesh; none of other shapes.
    pub fn vertices(&self) -> &[DVec3] {
        match self {
            Self::Polygon(vertices) | Self::Mesh { vertices, .. } => vertices,
            _ => &[],
        }
    }

    /// The direction of the first edge of an outline that has a length, of a disk `axis_u`: where the azimuth
    /// of a [`Profile`](crate::Profile) begins. Zero of other shapes.
    pub fn first_edge(&self) -> DVec3 {
        if let Self::Disk { axis_u, .. } = self {
            return axis_u.normalize_or_zero();
        }
        let edges = self.vertices().windows(2).map(|pair| (pair[1] - pair[0]).normalize_or_zero());
        edges.into_iter().find(|edge| *edge != DVec3::ZERO).unwrap_or(DVec3::ZERO)
    }

    /// As [`LightShape::vertices`], to be moved. A mesh has no clusters then.
    pub fn vertices_mut(&mut self) -> &mut [DVec3] {
        if let Self::Mesh { clusters, .. } = self {
            *clusters = FaceClusters::default();
        }
        match self {
            Self::Polygon(vertices) | Self::Mesh { vertices, .. } => vertices,
            _ => &mut [],
        }
    }

    /// The shape moved by a transform of any kind, a node's say. Its front stays on its outside where that
    /// mirrors. What is round stays so: a sphere keeps what its volume becomes, a tube that and its length.
    /// Where nothing is left of it, what comes back is refused when it is packed.
    #[must_use]
    pub fn moved(&self, by: &DAffine3) -> Self {
        let volume = by.matrix3.determinant();
        let mirrored = volume < 0.0;
        let point = |place: DVec3| by.transform_point3(place);
        let vector = |axis: DVec3| by.transform_vector3(axis);
        let turn = |outline: &mut [DVec3]| {
            for vertex in outline.iter_mut() {
                *vertex = point(*vertex);
            }
            if mirrored {
                // The first edge stays the first, the other way
                outline.reverse();
                outline.rotate_right(outline.len().min(2));
            }
        };
        let mut shape = self.clone();
        match &mut shape {
            Self::Polygon(vertices) => turn(vertices),
            Self::Mesh { vertices, faces, .. } => {
                let mut rest = vertices.as_mut_slice();
                for face in faces {
                    // Faces of more vertices than there are: the light is refused for that
                    let Some((outline, after)) = rest.split_at_mut_checked(*face as usize) else { break };
                    turn(outline);
                    rest = after;
                }
            }
            Self::Disk { center, axis_u, axis_v } => {
                let side = if mirrored { -1.0 } else { 1.0 };
                (*center, *axis_u, *axis_v) = (point(*center), vector(*axis_u) * side, vector(*axis_v));
            }
            Self::Sphere { center, radius } => {
                (*center, *radius) = (point(*center), *radius * volume.abs().cbrt());
            }
            Self::Tube { p0, p1, radius, .. } => {
                let longer = vector(*p1 - *p0).length() / (*p1 - *p0).length();
                (*p0, *p1) = (point(*p0), point(*p1));
                *radius *= (volume.abs() / longer).sqrt();
            }
        }
        let error = shape.clusters().error;
        shape.clustered(error)
    }

    /// Whether it is a polygon or a mesh.
    pub fn is_polygonal(&self) -> bool {
        matches!(self, Self::Polygon(_) | Self::Mesh { .. })
    }

    /// Area times normal, of a polygon by Newell's sum over its vertices: its direction is the front, its
    /// length the area (unit of length squared). Zero for a degenerate polygon. Of a mesh the sum over its
    /// faces; zero for what is closed, as spheres and tubes.
    pub fn area_vector(&self) -> DVec3 {
        match self {
            Self::Disk { axis_u, axis_v, .. } => axis_u.cross(*axis_v) * PI,
            _ => self.outlines().map(area_of).sum(),
        }
    }

    /// The middle of the area; of the vertices' box for a degenerate polygon. Zero without finite vertices.
    pub fn center(&self) -> DVec3 {
        match *self {
            Self::Polygon(_) | Self::Mesh { .. } => self.polygonal_center(),
            Self::Disk { center, .. } | Self::Sphere { center, .. } => center,
            Self::Tube { p0, p1, .. } => p0 * 0.5 + p1 * 0.5,
        }
    }

    fn polygonal_center(&self) -> DVec3 {
        let vertices = self.vertices();
        if vertices.is_empty() || !vertices.iter().all(|vertex| vertex.is_finite()) {
            return DVec3::ZERO;
        }
        let [low, high] = self.bounds();
        let middle = (low + high) * 0.5;
        // Weigh the triangles of a fan about a vertex of each face, which is in its plane, by their signed
        // areas
        let (mut area, mut moment) = (0.0, DVec3::ZERO);
        let apex = vertices[0];
        for outline in self.outlines() {
            let normal = area_of(outline).normalize_or_zero();
            let start = outline.first().copied().unwrap_or_default();
            let next = outline.iter().cycle().skip(1);
            for (a, b) in outline.iter().zip(next) {
                let (a, b) = (*a - start, *b - start);
                let weight = a.cross(b).dot(normal);
                area += weight;
                moment += (a + b + (start - apex) * 3.0) * (weight / 3.0);
            }
        }
        let center = if area > 0.0 { apex + moment / area } else { middle };
        // Rounding has its way with slivers; their middle stays within their box
        if center.is_finite() { center.clamp(low, high) } else { middle }
    }

    /// The smallest and the largest corner of a box along the axes that holds it; an infinite box without
    /// vertices.
    pub fn bounds(&self) -> [DVec3; 2] {
        match *self {
            Self::Polygon(_) | Self::Mesh { .. } => self
                .vertices()
                .iter()
                .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)]),
            Self::Disk { center, axis_u, axis_v } => {
                // Along each axis an outline reaches as far as the root of the sum of both half axes' squares
                // there
                let reach = (axis_u * axis_u + axis_v * axis_v).map(f64::sqrt);
                [center - reach, center + reach]
            }
            Self::Sphere { center, radius } => [center - radius, center + radius],
            Self::Tube { p0, p1, radius, .. } => [p0.min(p1) - radius, p0.max(p1) + radius],
        }
    }

    /// Whether it is a polygon that is convex and flat, both to a ten-thousandth of its size, and has at most
    /// four vertices: what is shaded without [`Effects::POLYGON`](crate::Effects::POLYGON), as if its
    /// vertices were moved by that much.
    pub fn is_convex_quad(&self) -> bool {
        self.vertices().len() <= 4 && self.is_convex()
    }

    /// Whether it is a polygon that is convex and flat, both to a ten-thousandth of its size.
    pub fn is_convex(&self) -> bool {
        let vertices = self.vertices();
        if vertices.len() < 3 || self.is_mesh() {
            return false;
        }
        let normal = self.area_vector().normalize_or_zero();
        // Every corner turns the outline's way, or not at all
        let count = vertices.len();
        let convex = (0..count).all(|i| {
            let [a, b, c] = [i, i + 1, i + 2].map(|j| vertices[j % count]);
            (b - a).cross(c - b).dot(normal) >= -FLAT * (b - a).length() * (c - b).length()
        });
        convex && self.is_flat()
    }

    /// Whether every vertex lies in one plane, to a ten-thousandth of the outline's size, and every face of a
    /// mesh faces one way. So does a disk; spheres and tubes are not flat.
    pub fn is_flat(&self) -> bool {
        if !self.is_polygonal() {
            return matches!(self, Self::Disk { .. });
        }
        let normal = self.area_vector().normalize_or_zero();
        if self.is_mesh() && !self.outlines().all(|outline| area_of(outline).dot(normal) > 0.0) {
            return false;
        }
        let center = self.center();
        let size = self.vertices().iter().map(|v| v.distance(center)).fold(0.0, f64::max);
        self.vertices().iter().all(|v| (*v - center).dot(normal).abs() <= FLAT * size)
    }
}

/// Area times normal of an outline, by Newell's sum over the vertices.
pub(crate) fn area_of(outline: &[DVec3]) -> DVec3 {
    let anchor = outline.first().copied().unwrap_or_default();
    let offsets = outline.iter().map(|v| *v - anchor);
    let next = outline.iter().cycle().skip(1).map(|v| *v - anchor);
    offsets.zip(next).map(|(a, b)| a.cross(b)).sum::<DVec3>() * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{GpuLight, GpuShape};
    use crate::light::tests::arrow;
    use crate::{Effects, Light, LightTexture};
    use glam::Vec3;

    fn light(shape: LightShape) -> Light {
        Light { name: "lamp".into(), radiance: Vec3::ONE, shape, ..Light::default() }
    }

    fn disk(center: DVec3, axis_u: DVec3, axis_v: DVec3) -> Light {
        light(LightShape::Disk { center, axis_u, axis_v })
    }

    fn tube(p0: DVec3, p1: DVec3, radius: f64) -> Light {
        light(LightShape::Tube { p0, p1, radius, ends: TubeEnds::Round })
    }

    fn layer(layer: u32) -> LightTexture {
        LightTexture { layer, uvs: vec![] }
    }

    #[test]
    fn the_front_is_the_right_hand_side() {
        assert_eq!(arrow().shape.area_vector(), DVec3::new(0.0, 0.0, 1.0));
        let area = disk(DVec3::ONE, DVec3::X * 2.0, DVec3::Y).shape.area_vector();
        assert_eq!(area, DVec3::Z * (2.0 * PI));
    }

    #[test]
    fn the_center_of_a_tilted_polygon_is_in_its_plane() {
        // The middle of its box is not
        let shape = LightShape::Polygon(vec![DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0]);
        assert!((shape.center() - DVec3::new(1.0, 2.0, 3.0) / 3.0).length() < 1e-15);
        assert_eq!(tube(DVec3::ZERO, DVec3::X, 1.0).shape.center(), DVec3::X * 0.5);
    }

    #[test]
    fn only_polygons_have_vertices_and_may_be_quads() {
        let quad = LightShape::Polygon(vec![DVec3::ZERO, DVec3::X, DVec3::Y]);
        assert!(quad.is_polygonal() && quad.is_flat() && quad.is_convex_quad());
        let sphere = LightShape::Sphere { center: DVec3::ZERO, radius: 1.0 };
        let disk = disk(DVec3::ZERO, DVec3::X, DVec3::Y).shape;
        for (shape, flat) in [(sphere, false), (disk, true)] {
            assert!(!shape.is_polygonal() && !shape.is_convex_quad() && shape.vertices().is_empty());
            assert_eq!(shape.is_flat(), flat);
        }
        assert!(!LightShape::default().is_convex_quad(), "no vertex");
    }

    #[test]
    fn shapes_are_packed_about_the_origin_in_float64() {
        let origin = DVec3::new(1e7, -2e7, 3e7);
        let packed = |light: Light| light.pack_shape(origin).unwrap();
        let near = DVec3::new(0.125, 0.25, 0.5);
        let found = packed(Light {
            two_sided: true,
            ..disk(origin + near, DVec3::new(0.0, 3.0, 0.0), DVec3::new(4.0, 0.0, 0.0))
        });
        assert_eq!((found.center, found.kind, found.flags), ([0.125, 0.25, 0.5], 0, GpuShape::TWO_SIDED));
        assert_eq!((found.axis_u, found.axis_v), ([0.0, 3.0, 0.0], [4.0, 0.0, 0.0]));
        assert!(found.radius >= 4.0 && found.radius < 4.00001, "{}", found.radius);
        assert_eq!(found.detail, GpuLight::NO_TEXTURE);
        let found = packed(light(LightShape::Sphere { center: origin + near, radius: 0.75 }));
        assert_eq!((found.center, found.radius, found.kind, found.flags), ([0.125, 0.25, 0.5], 0.75, 1, 0));
        let found = packed(tube(origin, origin + near, 0.75));
        assert_eq!((found.center, found.axis_u), ([0.0625, 0.125, 0.25], [0.0625, 0.125, 0.25]));
        assert_eq!((found.kind, found.detail), (2, TubeEnds::Round as u32));
    }

    #[test]
    fn the_radius_holds_ellipses_of_axes_that_are_not_perpendicular() {
        // A disk's axes, sheared: the longest vector of the outline, by search
        let (u, v) = (DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.75, 1.0, 0.25));
        let longest = (0..10_000)
            .map(|i| (f64::from(i) * 1e-3).sin_cos())
            .map(|(sin, cos)| (u * cos + v * sin).length())
            .fold(0.0, f64::max);
        let found = f64::from(disk(DVec3::ZERO, u, v).pack_shape(DVec3::ZERO).unwrap().radius);
        assert!((found - longest).abs() < 1e-6, "{found}, {longest}");
    }

    #[test]
    fn boxes_hold_their_shapes() {
        let (center, u, v) = (DVec3::X, DVec3::new(3.0, 0.0, 0.0), DVec3::new(4.0, 1.0, 0.0));
        let ellipse = LightShape::Disk { center, axis_u: u, axis_v: v };
        assert_eq!(ellipse.bounds(), [DVec3::new(-4.0, -1.0, 0.0), DVec3::new(6.0, 1.0, 0.0)]);
        let tube = LightShape::Tube { p0: DVec3::Y, p1: DVec3::ZERO, radius: 0.5, ends: TubeEnds::Round };
        assert_eq!(tube.bounds(), [DVec3::splat(-0.5), DVec3::new(0.5, 1.5, 0.5)]);
        assert_eq!(LightShape::Sphere { center, radius: 1.0 }.bounds()[0], DVec3::new(0.0, -1.0, -1.0));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let (nan, huge) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::new(0.0, 0.0, 1e39));
        let (x, y, zero) = (DVec3::X, DVec3::Y, DVec3::ZERO);
        let sphere = |radius: f64| light(LightShape::Sphere { center: x, radius });
        let shown = Light { texture: Some(layer(0)), ..sphere(1.0) };
        let dark = Light { radiance: Vec3::new(0.0, -1.0, 0.0), ..sphere(1.0) };
        for (light, expected) in [
            (disk(nan, x, y), "center: [0, NaN, 0] is not a finite"),
            (disk(huge, x, y), "center: "),
            (disk(x, nan, y), "axis_u: "),
            (disk(x, y, huge), "axis_v: "),
            (disk(x, zero, y), "axis_u and axis_v: [0, 0, 0] and [0, 1, 0] span no ellipse"),
            (disk(x, y, y * -2.0), "axis_u and axis_v: "),
            (disk(x, y * 1e-60, x), "axis_u and axis_v: "),
            (light(LightShape::Sphere { center: nan, radius: 1.0 }), "center: "),
            (sphere(0.0), "radius: 0 must be above zero"),
            (sphere(-1.0), "radius: -1 "),
            (sphere(f64::NAN), "radius: NaN "),
            (sphere(1e39), "radius: "),
            (sphere(1e-50), "radius: "),
            (tube(nan, x, 1.0), "p0: "),
            (tube(x, huge, 1.0), "p1: "),
            (tube(x, x, 1.0), "p0 and p1: [1, 0, 0] is both ends of the axis"),
            (tube(x, y, -1.0), "radius: -1 "),
            (shown, "texture: only polygons and disks are textured"),
            (dark, "radiance: [0, -1, 0] must be finite and not negative"),
        ] {
            let message = light.validate().unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}\nnot {expected}");
        }
        // The twins: the same, as they should be
        let shown = Light { texture: Some(layer(0)), ..disk(x, x, y) };
        for light in [disk(x, x, y), shown, sphere(1.0), tube(x, y, 1.0)] {
            light.validate().unwrap();
        }
    }

    #[test]
    fn a_textured_disk_has_its_layer() {
        let plain = disk(DVec3::ZERO, DVec3::X, DVec3::Y);
        let shown = Light { texture: Some(layer(7)), ..plain.clone() };
        assert_eq!(shown.pack_shape(DVec3::ZERO).unwrap().detail, 7);
        assert_eq!(shown.effects(), Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE);
        assert_eq!(plain.effects(), Effects::ELLIPSE);
        assert_eq!(plain.check_texture_layer(0), Ok(()));
        assert_eq!(shown.check_texture_layer(8), Ok(()));
        let message = shown.check_texture_layer(7).unwrap_err().to_string();
        assert_eq!(message, "texture: layer 7 is not there: there are 7");
    }

    #[test]
    fn an_origin_far_away_is_refused_too() {
        let message =
            disk(DVec3::X * 3e38, DVec3::X, DVec3::Y).pack_shape(DVec3::X * -3e38).unwrap_err().to_string();
        assert!(message.starts_with("center: "), "{message}");
    }
}
