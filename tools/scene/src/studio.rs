//! A photographer's light for models that bring none: three softboxes around what is shown, placed as the
//! camera sees it, in a dim tent, which metals show where they show no softbox.

use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::scene::{NO_LIGHTS, Scene, SceneLamp};
use arealight::{Light, LightFault, LightShape};
use glam::{DVec3, Vec3};

/// A rectangle that faces what is shown.
struct Softbox {
    name: &'static str,
    /// Degrees about the vertical, from where the camera is to the right.
    azimuth: f64,
    /// Degrees above the horizon.
    elevation: f64,
    /// Width and height over the distance to what it faces.
    size: [f64; 2],
    radiance: Vec3,
}

/// Of these a white sheet that faces the camera has a radiance of about one.
const SOFTBOXES: [Softbox; 3] = [
    Softbox {
        name: "studio key",
        azimuth: -45.0,
        elevation: 40.0,
        size: [0.7, 0.8],
        radiance: Vec3::new(9.6, 9.0, 8.3),
    },
    Softbox {
        name: "studio fill",
        azimuth: 60.0,
        elevation: 25.0,
        size: [0.8, 0.8],
        radiance: Vec3::new(1.65, 1.9, 2.2),
    },
    Softbox {
        name: "studio rim",
        azimuth: 155.0,
        elevation: 55.0,
        size: [0.8, 0.4],
        radiance: Vec3::new(12.0, 12.6, 13.5),
    },
];

/// What the tent sends, dim beside the softboxes.
const TENT: Vec3 = Vec3::splat(0.15);

/// How far from the middle of the scene the softboxes are, in halves of its diagonal: beyond 1 they are
/// outside of all that is there.
const DISTANCE: f64 = 2.2;

/// How much of the way from a camera within the scene to the edge of it: the walls of a room are there.
const WITHIN: f64 = 0.6;

impl Scene {
    /// Adds three softboxes, one-sided rectangles that are not drawn: a key from the camera's left, a fill
    /// from its right, and a rim from behind, each facing the middle of [`Scene::bounds`], outside of them,
    /// in a dim tent of three triangles; or within, where the camera is, facing what is before it, without
    /// the tent. A scene without any extent stays as it is.
    ///
    /// # Errors
    /// [`LightFault`] where the scene is so large, or so far from the origin, that they cannot be shaded.
    pub fn add_studio(&mut self, camera: &Camera) -> Result<(), LightFault> {
        if self.bounds.is_empty() {
            return Ok(());
        }
        let lights = rig(self.bounds, camera);
        lights.iter().try_for_each(Light::validate)?;
        let first = self.lights.len();
        let boxes = first + SOFTBOXES.len();
        self.lights.extend(lights);
        self.lamps.extend(SceneLamp::bare(first..boxes));
        if boxes < self.lights.len() {
            self.lamps.push(SceneLamp { triangles: 0..0, lights: boxes..self.lights.len() });
        }
        self.warnings.retain(|warning| warning.text != NO_LIGHTS);
        Ok(())
    }
}

/// The softboxes about a box, as a camera sees it, then the tent's sides.
fn rig(bounds: Bounds, camera: &Camera) -> Vec<Light> {
    let camera = camera.clone().pinhole(bounds.center());
    let [right, up, back] = frame(&camera);
    let is_within = bounds.min.cmplt(camera.position).all() && bounds.max.cmpgt(camera.position).all();
    let focus = if is_within {
        camera.position + camera.forward * (WITHIN * way_out(bounds, camera.position, camera.forward))
    } else {
        bounds.center()
    };
    let place = |softbox: &Softbox| {
        let ((sin, cos), (height, across)) =
            (softbox.azimuth.to_radians().sin_cos(), softbox.elevation.to_radians().sin_cos());
        let direction = (back * cos + right * sin) * across + up * height;
        if is_within {
            camera.position + direction * (WITHIN * way_out(bounds, camera.position, direction))
        } else {
            focus + direction * (DISTANCE * 0.5 * bounds.diagonal().max(1e-3))
        }
    };
    let boxes = SOFTBOXES.iter().map(|softbox| facing(softbox, place(softbox), focus, up));
    let tent =
        if is_within { Vec::new() } else { tent(bounds.center(), bounds.diagonal().max(1e-3), right, up) };
    boxes.chain(tent).collect()
}

/// Three triangles that lean together above a place, of so large a radius and height, open below.
fn tent(center: DVec3, radius: f64, right: DVec3, up: DVec3) -> Vec<Light> {
    let back = right.cross(up);
    // Beyond the softboxes, and from as far below as they are above: a floor's edge is before it
    let foot = |turn: f64| {
        let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
        center + (right * sin + back * cos) * (6.0 * radius) - up * radius
    };
    let side = |first: f64| Light {
        name: "studio tent".to_owned(),
        radiance: TENT,
        shape: LightShape::Polygon(vec![foot(first), center + up * (4.0 * radius), foot(first + 1.0 / 3.0)]),
        ..Light::default()
    };
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(side).to_vec()
}

/// To the right of a camera, up, and back from it, over the ground.
fn frame(camera: &Camera) -> [DVec3; 3] {
    let over_ground = |direction: DVec3| DVec3::new(direction.x, 0.0, direction.z);
    // Seen from above, what is below in the picture is nearer; seen from below, what is above
    let vertical = camera.up * camera.forward.y.signum();
    let back = over_ground(-camera.forward);
    let back = if back.length() > 1e-3 { back } else { over_ground(vertical) }.normalize_or(DVec3::Z);
    [DVec3::Y.cross(back), DVec3::Y, back]
}

/// How far it is from a point in a box to its edge.
fn way_out(bounds: Bounds, from: DVec3, direction: DVec3) -> f64 {
    let edge = DVec3::select(direction.cmpge(DVec3::ZERO), bounds.max, bounds.min);
    // Along an axis that the direction does not have, the edge is infinitely far; never is 0 divided by 0,
    // for the point is within
    ((edge - from) / direction).abs().min_element()
}

fn facing(softbox: &Softbox, center: DVec3, focus: DVec3, up: DVec3) -> Light {
    let distance = center.distance(focus);
    let front = (focus - center).normalize_or(DVec3::NEG_Y);
    let right = front.cross(up).normalize_or(front.any_orthonormal_vector());
    let [width, height] = softbox.size.map(|size| 0.5 * size * distance);
    let (right, up) = (right * width, right.cross(front) * height);
    let corners = [-right - up, up - right, right + up, right - up].map(|corner| center + corner);
    let shape = LightShape::Polygon(corners.to_vec());
    Light { name: softbox.name.to_owned(), radiance: softbox.radiance, shape, ..Light::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_oracle::polygon::form_factor;

    const BOX: Bounds = Bounds { min: DVec3::new(4.0, 0.0, -3.0), max: DVec3::new(6.0, 1.0, -2.0) };

    fn scene(bounds: Bounds) -> Scene {
        Scene { bounds, ..Scene::default() }
    }

    /// A point's middle, and whether the light's front is there.
    fn center_and_front(light: &Light) -> (DVec3, DVec3) {
        let vertices = light.shape.vertices();
        let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        (center, (vertices[1] - vertices[0]).cross(vertices[2] - vertices[1]).normalize_or_zero())
    }

    #[test]
    fn softboxes_stand_around_what_is_shown_as_the_camera_sees_it() {
        for forward in [DVec3::NEG_Z, DVec3::new(1.0, -0.4, 0.3), DVec3::Y, DVec3::NEG_Y] {
            let mut scene = scene(BOX);
            let camera = Camera::framing("", BOX, forward, DVec3::Y, 1.5);
            scene.add_studio(&camera).unwrap();
            assert_eq!((scene.lights.len(), scene.lamps.len()), (6, 4));
            let radius = 0.5 * BOX.diagonal();
            for light in &scene.lights[..3] {
                let (center, front) = center_and_front(light);
                assert!(
                    front.dot((BOX.center() - center).normalize_or_zero()) > 0.999_999,
                    "{forward}: {}",
                    light.name
                );
                assert!(
                    !light.two_sided
                        && light.shape.vertices().iter().all(|v| v.distance(BOX.center()) > radius)
                );
                assert!(center.y > BOX.center().y, "{forward}: above");
            }
            let across: Vec<f64> = scene.lights[..3]
                .iter()
                .map(|light| (center_and_front(light).0 - BOX.center()).dot(camera.right))
                .collect();
            assert!(
                across[0] < 0.0 && across[1] > 0.0,
                "{forward}: the key is left, the fill right: {across:?}"
            );
        }
    }

    #[test]
    fn a_white_sheet_that_faces_the_camera_has_a_radiance_of_about_one() {
        let mut scene = scene(BOX);
        let camera = Camera::framing("", BOX, DVec3::NEG_Z, DVec3::Y, 1.5);
        scene.add_studio(&camera).unwrap();
        let local = |vertex: &DVec3| {
            let offset = *vertex - BOX.center();
            DVec3::new(offset.dot(camera.right), offset.dot(camera.up), -offset.dot(camera.forward))
        };
        let of_light = |light: &Light| {
            let vertices: Vec<DVec3> = light.shape.vertices().iter().map(local).collect();
            form_factor(&vertices).max(0.0) * f64::from(light.radiance.y)
        };
        let parts: Vec<f64> = scene.lights[..3].iter().map(of_light).collect();
        assert!((parts.iter().sum::<f64>() - 1.0).abs() < 0.15, "{parts:?}");
        assert!(
            parts[0] > 3.0 * parts[1] && parts[2] == 0.0,
            "the key is the brightest, the rim behind: {parts:?}"
        );
    }

    #[test]
    fn above_the_horizon_there_is_one_side_of_the_tent_in_each_direction() {
        let mut scene = scene(BOX);
        scene.add_studio(&Camera::framing("", BOX, DVec3::new(1.0, -0.4, 0.3), DVec3::Y, 1.5)).unwrap();
        let seen = |direction: DVec3| {
            let before = |light: &&Light| {
                let [a, b, c] = [0, 1, 2].map(|corner| light.shape.vertices()[corner] - BOX.center());
                // Its front is a side's inside: its edges run clockwise about a ray from within
                [a.cross(b), b.cross(c), c.cross(a)].iter().all(|edge| edge.dot(direction) < 0.0)
            };
            scene.lights[3..].iter().filter(before).count()
        };
        for turn in 0..360 {
            let (sin, cos) = (f64::from(turn) + 0.5).to_radians().sin_cos();
            for height in [0.0, 0.3, 2.0] {
                assert_eq!(seen(DVec3::new(sin, height, cos)), 1, "{turn} {height}");
            }
            assert_eq!(seen(DVec3::new(sin, -0.5, cos)), 0, "{turn}: open below");
        }
    }

    #[test]
    fn in_a_room_they_are_within_and_face_what_is_before_the_camera() {
        let room = Bounds { min: DVec3::new(-3.0, 0.0, -4.0), max: DVec3::new(3.0, 2.6, 4.0) };
        let camera = Camera::looking(String::new(), DVec3::new(1.0, 1.5, 3.0), DVec3::NEG_Z, DVec3::Y);
        let mut within = scene(room);
        within.add_studio(&camera).unwrap();
        assert_eq!(within.lights.len(), 3, "no tent");
        let focus = DVec3::new(1.0, 1.5, 3.0 - 0.6 * 7.0);
        for light in &within.lights {
            let (center, front) = center_and_front(light);
            assert!(room.min.cmplt(center).all() && room.max.cmpgt(center).all(), "{}: {center}", light.name);
            assert!(front.dot((focus - center).normalize_or_zero()) > 0.999_999, "{}", light.name);
        }
        // The twin: from outside they are not
        let outside = Camera { position: DVec3::new(1.0, 1.5, 9.0), ..camera };
        let mut around = scene(room);
        around.add_studio(&outside).unwrap();
        assert!(
            around.lights[..3].iter().all(|light| center_and_front(light).0.distance(room.center()) > 5.0)
        );
    }

    #[test]
    fn sizes_of_any_kind_are_lit_or_refused() {
        let camera = Camera::framing("", BOX, DVec3::NEG_Z, DVec3::Y, 1.5);
        let mut nothing = scene(Bounds::default());
        nothing.add_studio(&camera).unwrap();
        assert!(nothing.lights.is_empty());
        for point in [DVec3::ZERO, DVec3::splat(7.0), DVec3::splat(1e15)] {
            let mut one = scene(Bounds { min: point, max: point });
            assert!(one.add_studio(&camera).is_err() || one.lights.len() == 6, "{point}");
        }
    }
}
