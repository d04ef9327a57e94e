//! A camera that goes round a point.

use super::look::Range;
use arealight_scene::{Bounds, Camera};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Radians to the poles, where there is no up any more.
const MOST_PITCH: f64 = FRAC_PI_2 - 1e-3;

/// Radians that a drag over the picture's height turns.
const TURN: f64 = 2.5;

/// How much nearer a step of the wheel goes.
const STEP: f64 = 0.9;

/// A camera that looks at a point from a distance; up is where y points to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// What it looks at, in the world.
    pub center: DVec3,
    /// From there, above zero.
    pub distance: f64,
    /// Radians about the y axis; 0 looks along -z.
    pub yaw: f64,
    /// Radians above the horizon that the camera is.
    pub pitch: f64,
    /// tan(yfov / 2).
    pub tan_half_height: f64,
}

impl Orbit {
    /// Where `camera` is, about the point in front of it that is nearest to the middle of the scene. What it
    /// has of a roll is lost.
    pub fn new(camera: &Camera, bounds: Bounds) -> Self {
        let ahead = (bounds.center() - camera.position).dot(camera.forward);
        let distance = ahead.max(0.05 * bounds.diagonal()).max(1e-3);
        let back = -camera.forward;
        Self {
            center: camera.position + camera.forward * distance,
            distance,
            yaw: back.x.atan2(back.z),
            pitch: back.y.atan2(back.x.hypot(back.z)).clamp(-MOST_PITCH, MOST_PITCH),
            tan_half_height: camera.half_height,
        }
    }

    /// What each number may be.
    pub fn ranges(&self) -> Vec<Range> {
        let above_zero = f64::MIN_POSITIVE..=1e30;
        let mut ranges = vec![
            ("distance", self.distance, above_zero.clone()),
            ("yaw", self.yaw, -TAU..=TAU),
            ("pitch", self.pitch, -MOST_PITCH..=MOST_PITCH),
            ("tan_half_height", self.tan_half_height, above_zero),
        ];
        ranges.extend(self.center.to_array().map(|side| ("center", side, -1e30..=1e30)));
        ranges
    }

    /// Turns by a drag, in heights of the picture: what is seen follows the pointer.
    pub fn turn(&mut self, [right, down]: [f64; 2]) {
        self.yaw = (self.yaw - right * TURN) % TAU;
        self.pitch = (self.pitch + down * TURN).clamp(-MOST_PITCH, MOST_PITCH);
    }

    /// Goes nearer by steps of a wheel; farther where they are negative.
    pub fn approach(&mut self, steps: f64) {
        let factor = STEP.powf(steps.clamp(-100.0, 100.0));
        self.distance = (self.distance * factor).clamp(1e-6, 1e12);
    }

    /// Moves sideways by a drag, in heights of the picture: what is at the center's distance follows the
    /// pointer.
    pub fn slide(&mut self, drag: [f64; 2]) {
        self.center -= self.offset(drag, self.distance);
    }

    /// What a drag, in heights of the picture, is in the world, at a distance along the view.
    pub fn offset(&self, [right, down]: [f64; 2], distance: f64) -> DVec3 {
        let camera = self.camera();
        (camera.right * right - camera.up * down) * (2.0 * self.tan_half_height * distance)
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (self.yaw.sin_cos(), self.pitch.sin_cos());
        let back = DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let right = DVec3::new(cos_yaw, 0.0, -sin_yaw);
        Camera {
            name: "orbit".to_owned(),
            position: self.center + back * self.distance,
            forward: -back,
            up: back.cross(right),
            right,
            orthographic: false,
            half_height: self.tan_half_height,
            aspect: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene_camera() -> Camera {
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::new(2.0, 1.0, 1.0) };
        Camera::framing("c", bounds, DVec3::new(-0.45, -0.35, -1.0), DVec3::Y, 1.5)
    }

    #[test]
    fn it_begins_as_the_scene_s_camera() {
        let camera = scene_camera();
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::new(2.0, 1.0, 1.0) };
        let orbit = Orbit::new(&camera, bounds).camera();
        for (found, expected) in [
            (orbit.position, camera.position),
            (orbit.forward, camera.forward),
            (orbit.up, camera.up),
            (orbit.right, camera.right),
        ] {
            assert!((found - expected).length() < 1e-12, "{found}, not {expected}");
        }
    }

    #[test]
    fn it_turns_about_its_center_and_stays_upright() {
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        let mut orbit = Orbit::new(&scene_camera(), bounds);
        let (center, distance) = (orbit.center, orbit.distance);
        for drag in [[0.3, 0.1], [-2.0, 5.0], [0.1, -20.0]] {
            orbit.turn(drag);
            let camera = orbit.camera();
            assert!((camera.position.distance(center) - distance).abs() < 1e-9);
            assert!(camera.up.y > 0.0 && (camera.forward.cross(camera.up) - camera.right).length() < 1e-12);
        }
        orbit.approach(1.0);
        assert!(orbit.distance < distance);
        orbit.approach(-1.0);
        assert!((orbit.distance - distance).abs() < 1e-9);
    }

    #[test]
    fn what_is_dragged_follows_the_pointer() {
        let mut orbit = Orbit::new(&scene_camera(), Bounds::default());
        let before = orbit.camera();
        let point = orbit.center;
        orbit.slide([0.25, 0.1]);
        let after = orbit.camera();
        let seen = |camera: &Camera| {
            let to = point - camera.position;
            let depth = to.dot(camera.forward) * 2.0 * camera.half_height;
            [to.dot(camera.right) / depth, -to.dot(camera.up) / depth]
        };
        let (before, after) = (seen(&before), seen(&after));
        assert!((after[0] - before[0] - 0.25).abs() < 1e-9 && (after[1] - before[1] - 0.1).abs() < 1e-9);
    }
}
