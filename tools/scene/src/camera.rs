//! Pinhole cameras.

use crate::Bounds;
use arealight_tool_kernels::gpu::VisibilityConstants;
use glam::{DVec3, Vec3};

/// A pinhole camera in the world.
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
    /// Half the image's height at distance 1: tan(yfov / 2).
    pub tan_half_height: f64,
    /// Width over height that the camera is made for. An image of another shape keeps the vertical field of
    /// view.
    pub aspect: Option<f64>,
}

/// tan(yfov / 2) of [`Camera::framing`]: 35 degrees.
const FRAMING_TAN_HALF_HEIGHT: f64 = 0.3153;

/// How much farther away than needed a framing camera stands.
const FRAMING_MARGIN: f64 = 1.05;

impl Camera {
    /// None if the field of view is not between 0 and pi. `forward` is unit and not along `up`.
    pub(crate) fn perspective(
        name: String,
        position: DVec3,
        forward: DVec3,
        up: DVec3,
        perspective: &gltf::json::camera::Perspective,
    ) -> Option<Self> {
        let tan_half_height = (f64::from(perspective.yfov) * 0.5).tan();
        let in_range = perspective.yfov > 0.0 && f64::from(perspective.yfov) < std::f64::consts::PI;
        let aspect = perspective.aspect_ratio.map(f64::from);
        let aspect = aspect.filter(|aspect| aspect.is_finite() && *aspect > 0.0);
        let looking = Self::looking(name, position, forward, up);
        (in_range && tan_half_height.is_finite()).then_some(Self { tan_half_height, aspect, ..looking })
    }

    /// A camera that looks along `forward` from where it just sees all of `bounds` in an image of `aspect`.
    pub fn framing(name: &str, bounds: Bounds, forward: DVec3, up: DVec3, aspect: f64) -> Self {
        let forward = forward.normalize_or(DVec3::NEG_Z);
        let mut camera = Self::looking(name.to_owned(), bounds.center(), forward, up);
        camera.aspect = Some(aspect);
        camera.tan_half_height = FRAMING_TAN_HALF_HEIGHT;
        // Step back until every corner of the box is between the image's edges
        let tan_half_width = camera.tan_half_height * aspect;
        let half = if bounds.is_empty() { DVec3::ONE } else { (bounds.max - bounds.min) * 0.5 };
        let mut distance = 0.0_f64;
        for corner in 0..8 {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = half * DVec3::new(sign(0), sign(1), sign(2));
            let across = (corner.dot(camera.right).abs() / tan_half_width)
                .max(corner.dot(camera.up).abs() / camera.tan_half_height);
            distance = distance.max(across - corner.dot(forward));
        }
        camera.position -= forward * (distance * FRAMING_MARGIN).max(1e-3);
        camera
    }

    /// Right-angled axes; `up` need not be at a right angle to `forward`.
    fn looking(name: String, position: DVec3, forward: DVec3, up: DVec3) -> Self {
        let right = forward.cross(up).normalize_or(forward.any_orthonormal_vector());
        let up = right.cross(forward);
        Self { name, position, forward, up, right, tan_half_height: 1.0, aspect: None }
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
            reserved0: 0,
            right: (self.right * (self.tan_half_height * aspect)).as_vec3().to_array(),
            reserved1: 0,
            up: (self.up * self.tan_half_height).as_vec3().to_array(),
            reserved2: 0,
            forward: self.forward.as_vec3().to_array(),
            reserved3: 0,
            background: background.to_array(),
            reserved4: 0,
        }
    }

    /// Unit direction of the ray through a point of the image: (-1, -1) is the lower left corner, (1, 1) the
    /// upper right one, of an image of `aspect`.
    pub fn direction(&self, [x, y]: [f64; 2], aspect: f64) -> DVec3 {
        let across = self.right * (self.tan_half_height * aspect * x) + self.up * (self.tan_half_height * y);
        (self.forward + across).normalize_or(self.forward)
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
            let depth = offset.dot(camera.forward) * camera.tan_half_height;
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
            let narrow = Camera { tan_half_height: camera.tan_half_height * 0.5, ..camera };
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
        let corner = camera.direction([1.0, -1.0], 2.0);
        assert!((corner - DVec3::new(2.0, -1.0, -1.0) / 6.0_f64.sqrt()).length() < 1e-15);
    }
}
