//! Lamps that are picked and moved: their lights, and the triangles that look like them.

use super::look::Range;
use arealight::{Light, LightShape, Profile};
use arealight_scene::rays::intersect_vertices;
use arealight_scene::{Camera, Scene};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// How near to the middle of a lamp that no mesh is a click picks it, in heights of the picture.
const NEAR: f64 = 0.03;

/// The lamp that is seen in a direction from the camera, and how far along the view; `heights` is the
/// direction's place in heights of the picture from the middle, to the right and down.
pub fn pick(scene: &Scene, camera: &Camera, heights: [f64; 2]) -> Option<(usize, f64)> {
    let tan = 2.0 * camera.half_height;
    let direction = camera.forward + (camera.right * heights[0] - camera.up * heights[1]) * tan;
    // The first triangle along the ray, in lengths along the view
    let mut first: Option<(usize, f64)> = None;
    for (index, triangle) in scene.triangles.iter().enumerate() {
        let two_sided = scene.materials.get(triangle.material as usize).is_some_and(|m| m.double_sided);
        if let Some((distance, _)) =
            intersect_vertices(triangle.positions, two_sided, camera.position, direction)
            && first.is_none_or(|(_, nearest)| distance < nearest)
        {
            first = Some((index, distance));
        }
    }
    // A lamp without triangles, where nothing hides its middle
    let bare = scene.lamps.iter().enumerate().filter(|(_, lamp)| lamp.triangles.is_empty());
    let seen_near = bare.filter_map(|(index, lamp)| {
        let to = scene.lights.get(lamp.lights.start)?.shape.center() - camera.position;
        let depth = to.dot(camera.forward);
        let at = [to.dot(camera.right), -to.dot(camera.up)].map(|side| side / (depth * tan));
        let off = (at[0] - heights[0]).hypot(at[1] - heights[1]);
        let is_hidden = first.is_some_and(|(_, distance)| distance < depth);
        (depth > 0.0 && off < NEAR && !is_hidden).then_some((index, depth))
    });
    if let Some(found) = seen_near.min_by(|a, b| a.1.total_cmp(&b.1)) {
        return Some(found);
    }
    let (triangle, distance) = first?;
    let lamp = scene.lamps.iter().position(|lamp| lamp.triangles.contains(&triangle))?;
    Some((lamp, distance))
}

/// What a person has made of a lamp.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    pub is_on: bool,
    /// In the world.
    pub offset: DVec3,
    /// Degrees about the vertical, and then about the horizontal that is across its front.
    pub turn: [f64; 2],
    /// A factor.
    pub size: f64,
    /// Of its radiance, a factor of 2 each.
    pub stops: f64,
    /// What its radiance is multiplied with, linear.
    pub color: [f32; 3],
    /// Degrees from its front, beyond which it does not shine; 90 is as it was.
    pub beam: f64,
    /// Bits of [`Light::links`] to flip.
    pub links: u8,
}

/// The widest beam.
const WHOLE: f64 = 90.0;
/// A beam begins to fade at this part of its angle.
const INNER: f64 = 0.6;
/// Levels of a beam's profile: 3 % of the mean off at most (docs/shaped-light.md).
const LEVELS: u32 = 4;

impl Edit {
    /// A lamp as it was.
    pub const NONE: Self = Self {
        is_on: true,
        offset: DVec3::ZERO,
        turn: [0.0; 2],
        size: 1.0,
        stops: 0.0,
        color: [1.0; 3],
        beam: WHOLE,
        links: 0,
    };

    pub const STOPS: RangeInclusive<f64> = -8.0..=8.0;
    pub const SIZE: RangeInclusive<f64> = 0.1..=10.0;
    pub const BEAM: RangeInclusive<f64> = 3.0..=WHOLE;
    pub const TURN: [RangeInclusive<f64>; 2] = [-180.0..=180.0, -90.0..=90.0];
    pub const OFFSET: RangeInclusive<f64> = -1e9..=1e9;

    /// What each number may be.
    pub fn ranges(&self) -> Vec<Range> {
        let [turn, tilt] = Self::TURN;
        let mut ranges = vec![
            ("stops", self.stops, Self::STOPS),
            ("size", self.size, Self::SIZE),
            ("beam", self.beam, Self::BEAM),
            ("turn[0]", self.turn[0], turn),
            ("turn[1]", self.turn[1], tilt),
        ];
        ranges.extend(self.offset.to_array().map(|side| ("offset", side, Self::OFFSET)));
        ranges.extend(self.color.map(|channel| ("color", channel.into(), 0.0..=1.0)));
        ranges
    }

    /// Moves it, as far as it may be.
    pub fn move_by(&mut self, by: DVec3) {
        let (low, high) = (DVec3::splat(*Self::OFFSET.start()), DVec3::splat(*Self::OFFSET.end()));
        self.offset = (self.offset + by).clamp(low, high);
    }

    /// A light of this beam; as it is where the light has no front that is one, as spheres, or is bent.
    fn shaped(&self, light: Light) -> Light {
        let beam = self.beam.to_radians();
        let is_narrow = self.beam < WHOLE;
        let profile = is_narrow.then(|| Profile::cone(INNER * beam, beam, LEVELS).ok()).flatten();
        let shaped = Light { profile: profile.or_else(|| light.profile.clone()), ..light.clone() };
        if shaped.validate().is_ok() { shaped } else { light }
    }

    /// What the lamp's radiance is multiplied with.
    fn factor(&self) -> Vec3 {
        if self.is_on { Vec3::from(self.color) * self.stops.exp2() as f32 } else { Vec3::ZERO }
    }

    /// Turns and grows about the middle of a light, and moves.
    fn transform(&self, light: &Light) -> DAffine3 {
        let middle = light.shape.center();
        let front = match light.shape {
            LightShape::Tube { p0, p1, .. } => DVec3::Y.cross(p1 - p0),
            _ => light.shape.area_vector(),
        };
        let across = DVec3::Y.cross(front).try_normalize().unwrap_or(DVec3::X);
        let [turn, tilt] = self.turn.map(f64::to_radians);
        DAffine3::from_translation(middle + self.offset)
            * DAffine3::from_quat(DQuat::from_rotation_y(turn) * DQuat::from_axis_angle(across, tilt))
            * DAffine3::from_scale(DVec3::splat(self.size))
            * DAffine3::from_translation(-middle)
    }
}

/// Makes of each lamp of a scene what a person wants.
pub fn edit(scene: &mut Scene, edits: &[Edit]) {
    for (lamp, edit) in scene.lamps.clone().iter().zip(edits).filter(|(_, edit)| **edit != Edit::NONE) {
        let lights = scene.lights.get_mut(lamp.lights.clone()).unwrap_or_default();
        let transform = lights.first().map_or(DAffine3::IDENTITY, |light| edit.transform(light));
        let factor = edit.factor();
        for light in lights {
            let (radiance, links) = (light.radiance * factor, light.links ^ edit.links);
            *light = edit.shaped(Light { radiance, links, ..light.moved(&transform) });
        }
        let mut bright: Option<(u32, u32)> = None;
        for triangle in scene.triangles.get_mut(lamp.triangles.clone()).into_iter().flatten() {
            triangle.positions = triangle.positions.map(|place| transform.transform_point3(place));
            let turned = |it: Vec3| transform.transform_vector3(it.as_dvec3()).normalize_or_zero().as_vec3();
            triangle.normals = triangle.normals.map(turned);
            triangle.tangents = triangle.tangents.map(|it| turned(it.truncate()).extend(it.w));
            // What it looks like is its material's, which others may have too
            let (_, own) = bright.filter(|(of, _)| *of == triangle.material).unwrap_or_else(|| {
                let mut material = scene.materials[triangle.material as usize].clone();
                material.emission *= factor;
                scene.materials.push(material);
                (triangle.material, scene.materials.len() as u32 - 1)
            });
            bright = Some((triangle.material, own));
            triangle.material = own;
        }
    }
}

/// Where a lamp is seen: the box about it, from its upper left corner to its lower right one, in heights of
/// the picture from the middle. None where a part of it is not in front of the camera.
pub fn seen(scene: &Scene, camera: &Camera, lamp: usize) -> Option<[[f64; 2]; 2]> {
    let lights = scene.lights.get(scene.lamps.get(lamp)?.lights.clone())?;
    let mut box_seen = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in lights.iter().flat_map(|light| extremes(&light.shape, camera)) {
        let to = point - camera.position;
        let depth = 2.0 * camera.half_height * to.dot(camera.forward);
        if depth <= 0.0 {
            return None;
        }
        for (axis, side) in [to.dot(camera.right), -to.dot(camera.up)].into_iter().enumerate() {
            box_seen[0][axis] = box_seen[0][axis].min(side / depth);
            box_seen[1][axis] = box_seen[1][axis].max(side / depth);
        }
    }
    (box_seen[0][0] <= box_seen[1][0]).then_some(box_seen)
}

/// Points about a shape, between which it is seen.
fn extremes(shape: &LightShape, camera: &Camera) -> Vec<DVec3> {
    let round = |center: DVec3, radius: f64| {
        [camera.right, -camera.right, camera.up, -camera.up].map(|axis| center + axis * radius)
    };
    match shape {
        LightShape::Disk { center, axis_u, axis_v } => {
            let angles = (0..16).map(|i| f64::from(i) * TAU / 16.0);
            angles.map(|angle| *center + *axis_u * angle.cos() + *axis_v * angle.sin()).collect()
        }
        LightShape::Sphere { center, radius } => round(*center, *radius).to_vec(),
        LightShape::Tube { p0, p1, radius, .. } => [round(*p0, *radius), round(*p1, *radius)].concat(),
        shape => shape.vertices().to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_scene::Triangle;
    use std::path::Path;

    fn room() -> Scene {
        Scene::from_bytes(include_bytes!("../../../../scenes/room.glb"), "room").unwrap()
    }

    /// Where a point is in the picture, in heights from the middle.
    fn place(camera: &Camera, point: DVec3) -> [f64; 2] {
        let to = point - camera.position;
        let depth = 2.0 * camera.half_height * to.dot(camera.forward);
        [to.dot(camera.right) / depth, -to.dot(camera.up) / depth]
    }

    #[test]
    fn a_lamp_is_picked_where_it_is_seen() {
        let scene = room();
        assert!(scene.lamps.len() > 2);
        for (index, lamp) in scene.lamps.iter().enumerate() {
            // Just in front of one of its triangles nothing hides it
            let [a, b, c] = scene.triangles[lamp.triangles.start].positions;
            let (middle, front) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize_or_zero());
            let right = front.any_orthonormal_vector();
            let before = Camera {
                position: middle + front * 1e-3,
                forward: -front,
                right,
                up: front.cross(right),
                ..scene.camera(None, 1.5).unwrap()
            };
            let (found, distance) = pick(&scene, &before, [0.0, 0.0]).unwrap();
            assert_eq!(found, index);
            assert!((distance - 1e-3).abs() < 1e-9);
            // The twin: the other way there is none, or another
            let away = Camera { forward: front, right: -before.right, ..before };
            assert_ne!(pick(&scene, &away, [0.0, 0.0]).map(|(lamp, _)| lamp), Some(index));
        }
    }

    #[test]
    fn a_light_without_a_mesh_is_picked_by_its_middle() {
        let mut scene = room();
        let camera = scene.camera(None, 1.5).unwrap();
        scene.triangles.clear();
        scene.lamps.truncate(1);
        scene.lamps[0].triangles = 0..0;
        let center = scene.lights[scene.lamps[0].lights.start].shape.center();
        let at = place(&camera, center);
        let depth = (center - camera.position).dot(camera.forward);
        assert!(depth > 0.0);
        assert_eq!(pick(&scene, &camera, at).map(|(lamp, _)| lamp), Some(0));
        assert_eq!(pick(&scene, &camera, [at[0] + 0.1, at[1]]), None);
    }

    /// Every kind of light, turned, grown, dimmed and moved.
    #[test]
    fn lamps_change_with_what_they_look_like() {
        for file in ["room", "shapes", "set"] {
            let path = format!("{}/../../scenes/{file}.glb", env!("CARGO_MANIFEST_DIR"));
            let before = Scene::load(Path::new(&path)).unwrap();
            let mut after = before.clone();
            let (turn, color) = ([90.0, 10.0], [1.0, 0.5, 0.0]);
            let one = Edit { turn, size: 2.0, stops: -1.0, color, links: 5, ..Edit::NONE };
            let edits: Vec<Edit> = (0..before.lamps.len())
                .map(|i| Edit { offset: DVec3::new(0.0, i as f64, -0.5), is_on: i != 1, ..one })
                .collect();
            edit(&mut after, &edits);
            for (index, (lamp, edited)) in before.lamps.iter().zip(&edits).enumerate() {
                let factor = if index == 1 { Vec3::ZERO } else { Vec3::new(0.5, 0.25, 0.0) };
                let first = lamp.lights.start;
                let middles = [&before, &after].map(|scene| scene.lights[first].shape.center());
                assert!((middles[1] - middles[0] - edited.offset).length() < 1e-9, "{file} {index}");
                for light in lamp.lights.clone() {
                    let [was, is] = [&before, &after].map(|scene| &scene.lights[light]);
                    assert_eq!((is.radiance, is.links), (was.radiance * factor, was.links ^ 5));
                    assert!(is.validate().is_ok());
                }
                for triangle in lamp.triangles.clone() {
                    let [was, is] = [&before, &after].map(|scene| scene.triangles[triangle]);
                    let [far, near] = [is.positions[2] - middles[1], was.positions[2] - middles[0]];
                    assert!((far.length() - 2.0 * near.length()).abs() < 1e-6, "{file} {index}");
                    let emission =
                        |scene: &Scene, of: Triangle| scene.materials[of.material as usize].emission;
                    assert_eq!(emission(&after, is), emission(&before, was) * factor);
                }
            }
            let still = |scene: &Scene| {
                let still = (0..scene.triangles.len()).filter(|index| !scene.is_lamp(*index));
                still.map(|index| scene.triangles[index]).collect::<Vec<_>>()
            };
            assert_eq!(still(&before), still(&after));
            // As they were: nothing is changed
            let mut same = before.clone();
            edit(&mut same, &vec![Edit::NONE; before.lamps.len()]);
            assert_eq!((same.lights, same.triangles), (before.lights, before.triangles));
        }
    }

    #[test]
    fn a_flat_lamp_has_a_beam() {
        let mut scene = Scene::from_bytes(include_bytes!("../../../../scenes/shapes.glb"), "shapes").unwrap();
        let before = scene.lights.clone();
        let edits = vec![Edit { beam: 30.0, ..Edit::NONE }; scene.lamps.len()];
        edit(&mut scene, &edits);
        let shaped = scene.lights.iter().filter(|light| light.profile.is_some()).count();
        // Not spheres and tubes, which shine all around
        assert!(shaped > 0 && shaped < scene.lights.len());
        for (was, is) in before.iter().zip(&scene.lights) {
            assert!(is.validate().is_ok() && was.profile.is_none());
            assert_eq!(Light { profile: None, ..is.clone() }, *was);
        }
        let mut whole = scene.clone();
        edit(&mut whole, &vec![Edit { stops: 1.0, ..Edit::NONE }; scene.lamps.len()]);
        assert_eq!(whole.lights.iter().filter(|light| light.profile.is_some()).count(), shaped);
    }

    #[test]
    fn the_box_about_a_lamp_holds_it() {
        let scene = room();
        let camera = scene.camera(None, 1.5).unwrap();
        let seen_lamps = (0..scene.lamps.len()).filter_map(|lamp| Some((lamp, seen(&scene, &camera, lamp)?)));
        let mut count = 0;
        for (lamp, [low, high]) in seen_lamps {
            let at = place(&camera, scene.lights[scene.lamps[lamp].lights.start].shape.center());
            assert!((0..2).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]), "{lamp}");
            count += 1;
        }
        assert!(count > 1);
        let behind = Camera { forward: -camera.forward, ..camera };
        assert!((0..scene.lamps.len()).any(|lamp| seen(&scene, &behind, lamp).is_none()));
    }
}
