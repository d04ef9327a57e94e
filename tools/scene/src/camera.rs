//! Cameras: pinholes, and orthographic ones.

use crate::bounds::{Bounds, MAX_COORDINATE};
use arealight_tool_kernels::gpu::VisibilityConstants;
use glam::{DVec3, Vec3};

/// A camera in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The node's name, else the camera's, else a number.
    pub name: String,
    /// Where it is.
    pub position: DVec3,
    /// Unit viewing direction.
    pub forward: DVec3,
    /// Unit, upwards in the image.
    pub up: DVec3,
    /// Unit, to the right in the image: `forward × up`.
    pub right: DVec3,
    /// Whether lines of sight are parallel; else all go through `position`.
    pub orthographic: bool,
    /// Half the image's height: at distance 1, tan(yfov / 2), or of an orthographic camera at any distance.
    pub half_height: f64,
    /// Width over height that the camera is made for. An image of another shape keeps the vertical field of
    /// view.
    pub aspect: Option<f64>,
}

/// tan(yfov / 2) of [`Camera::framing`]: 35 degrees.
const FRAMING_HALF_HEIGHT: f64 = 0.3153;

/// How much farther away than needed a framing camera stands.
const FRAMING_MARGIN: f64 = 1.05;

impl Camera {
    /// None if the field of view is not between 0 and pi.
    pub(crate) fn perspective(self, perspective: &gltf::json::camera::Perspective) -> Option<Self> {
        let half_height = (f64::from(perspective.yfov) * 0.5).tan();
        let in_range = perspective.yfov > 0.0 && f64::from(perspective.yfov) < std::f64::consts::PI;
        let aspect = perspective.aspect_ratio.map(f64::from);
        let aspect = aspect.filter(|aspect| aspect.is_finite() && *aspect > 0.0);
        (in_range && half_height.is_finite()).then_some(Self { half_height, aspect, ..self })
    }

    /// None if the image has no width or no height, or either is beyond [`MAX_COORDINATE`].
    pub(crate) fn orthographic(self, orthographic: &gltf::json::camera::Orthographic) -> Option<Self> {
        let [width, half_height] = [orthographic.xmag, orthographic.ymag].map(f64::from);
        let aspect = Some(width / half_height);
        let in_range = |size: f64| size > 0.0 && size <= MAX_COORDINATE;
        (in_range(width) && in_range(half_height)).then_some(Self {
            orthographic: true,
            half_height,
            aspect,
            ..self
        })
    }

    /// A camera that looks along `forward` from where it just sees all of `bounds` in an image of `aspect`.
    pub fn framing(name: &str, bounds: Bounds, forward: DVec3, up: DVec3, aspect: f64) -> Self {
        let forward = forward.normalize_or(DVec3::NEG_Z);
        let mut camera = Self::looking(name.to_owned(), bounds.center(), forward, up);
        camera.aspect = Some(aspect);
        camera.half_height = FRAMING_HALF_HEIGHT;
        // Step back until every corner of the box is between the image's edges
        let tan_half_width = camera.half_height * aspect;
        let half = if bounds.is_empty() { DVec3::ONE } else { (bounds.max - bounds.min) * 0.5 };
        let mut distance = 0.0_f64;
        for corner in 0..8 {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = half * DVec3::new(sign(0), sign(1), sign(2));
            let across = (corner.dot(camera.right).abs() / tan_half_width)
                .max(corner.dot(camera.up).abs() / camera.half_height);
            distance = distance.max(across - corner.dot(forward));
        }
        camera.position -= forward * if distance > 0.0 { distance * FRAMING_MARGIN } else { 1e-3 };
        camera
    }

    /// A pinhole of a field of view of a right angle. `forward` is unit; `up` need not be at a right angle to
    /// it.
    pub(crate) fn looking(name: String, position: DVec3, forward: DVec3, up: DVec3) -> Self {
        let right = forward.cross(up).normalize_or(forward.any_orthonormal_vector());
        let up = right.cross(forward);
        Self { name, position, forward, up, right, orthographic: false, half_height: 1.0, aspect: None }
    }

    /// Push constants of the visibility kernel for an image of `width` × `height` pixels, relative to
    /// `origin`. `background` is the radiance where nothing is hit.
    pub fn constants(
        &self,
        [width, height]: [u32; 2],
        origin: DVec3,
        background: Vec3,
    ) -> VisibilityConstants {
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        VisibilityConstants {
            camera: (self.position - origin).as_vec3().to_array(),
            orthographic: self.orthographic.into(),
            right: (self.right * (self.half_height * aspect)).as_vec3().to_array(),
            supersample: 1,
            up: (self.up * self.half_height).as_vec3().to_array(),
            first_row: 0,
            forward: (self.forward * self.distance()).as_vec3().to_array(),
            reserved3: 0,
            background: background.to_array(),
            reserved4: 0,
        }
    }

    /// How far away a pinhole camera with the field of view of [`Camera::framing`] is that sees as much as an
    /// orthographic one; of a pinhole 1.
    fn distance(&self) -> f64 {
        if self.orthographic { self.half_height / FRAMING_HALF_HEIGHT } else { 1.0 }
    }

    /// A pinhole camera that sees as much at `point`, for what knows of no other.
    #[must_use]
    pub fn pinhole(self, point: DVec3) -> Self {
        if !self.orthographic {
            return self;
        }
        let ahead = (point - self.position).dot(self.forward) - self.distance();
        let position = self.position + self.forward * ahead;
        Self { position, orthographic: false, half_height: FRAMING_HALF_HEIGHT, ..self }
    }

    /// Where the ray through a point of the image starts, and its unit direction: (-1, -1) is the lower left
    /// corner, (1, 1) the upper right one, of an image of `aspect`.
    pub fn ray(&self, [x, y]: [f64; 2], aspect: f64) -> [DVec3; 2] {
        let across = self.right * (self.half_height * aspect * x) + self.up * (self.half_height * y);
        if self.orthographic {
            return [self.position + across, self.forward];
        }
        [self.position, (self.forward + across).normalize_or(self.forward)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(bounds: Bounds) -> impl Iterator<Item = DVec3> {
        (0..8).map(move |i| {
            let pick = |bit: usize| if i >> bit & 1 == 1 { bounds.max } else { bounds.min };
            DVec3::new(pick(0).x, pick(1).y, pick(2).z)
        })
    }

    /// The largest |x| or |y| of the box's corners in the image, 1 at its edge.
    fn reach(camera: &Camera, bounds: Bounds, aspect: f64) -> f64 {
        let across = corners(bounds).map(|corner| {
            let offset = corner - camera.position;
            let depth = offset.dot(camera.forward) * camera.half_height;
            assert!(depth > 0.0, "the corner is in front of the camera");
            (offset.dot(camera.up).abs() / depth).max(offset.dot(camera.right).abs() / depth / aspect)
        });
        across.fold(0.0, f64::max)
    }

    #[test]
    fn framing_sees_everything_and_fills_the_image() {
        for (size, aspect) in [(DVec3::ONE, 1.0), (DVec3::new(10.0, 0.1, 3.0), 2.0), (DVec3::Y * 4.0, 0.5)] {
            let bounds = Bounds { min: DVec3::splat(7.0), max: DVec3::splat(7.0) + size };
            let camera = Camera::framing("", bounds, DVec3::new(-0.45, -0.35, -1.0), DVec3::Y, aspect);
            let reach = reach(&camera, bounds, aspect);
            assert!(reach < 1.0 && reach > 0.8, "{size} at {aspect}: reaches {reach}");
            // The twin: half the field of view cannot hold it
            let narrow = Camera { half_height: camera.half_height * 0.5, ..camera };
            assert!(self::reach(&narrow, bounds, aspect) > 1.0);
        }
    }

    #[test]
    fn framing_survives_an_empty_scene_and_a_view_along_up() {
        let camera = Camera::framing("", Bounds::default(), DVec3::NEG_Y, DVec3::Y, 1.0);
        assert!(camera.position.is_finite() && (camera.right.length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn constants_reach_the_edges_of_the_image() {
        let camera = Camera::looking(String::new(), DVec3::new(1e7, 0.0, 0.5), DVec3::NEG_Z, DVec3::Y);
        let constants = camera.constants([200, 100], DVec3::X * 1e7, Vec3::ZERO);
        assert_eq!(constants.camera, [0.0, 0.0, 0.5]);
        assert_eq!((constants.right, constants.up), ([2.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
        assert_eq!(constants.forward, [0.0, 0.0, -1.0]);
        let [start, corner] = camera.ray([1.0, -1.0], 2.0);
        assert!((corner - DVec3::new(2.0, -1.0, -1.0) / 6.0_f64.sqrt()).length() < 1e-15);
        assert_eq!(start, camera.position);
    }

    #[test]
    fn a_pinhole_sees_as_much_as_an_orthographic_camera_where_it_is_asked_to() {
        let camera = Camera::looking(String::new(), DVec3::X, DVec3::NEG_Z, DVec3::Y);
        let parallel = Camera { orthographic: true, half_height: 3.0, ..camera.clone() };
        let at = |camera: &Camera, depth: f64| {
            let [start, direction] = camera.ray([0.5, -1.0], 2.0);
            start + direction * ((depth - start.z) / direction.z)
        };
        let pinhole = parallel.clone().pinhole(DVec3::new(9.0, 9.0, -20.0));
        assert!(at(&pinhole, -20.0).distance(at(&parallel, -20.0)) < 1e-12);
        assert!((at(&parallel, -20.0) - DVec3::new(4.0, -3.0, -20.0)).length() < 1e-12);
        // The twin: elsewhere it does not
        assert!(at(&pinhole, -21.0).distance(at(&parallel, -21.0)) > 0.1);
        assert_eq!(camera.clone().pinhole(DVec3::ZERO), camera);
    }
}
