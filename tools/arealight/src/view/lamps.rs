//! Lamps that are picked and moved: their lights, and the triangles that look like them.

use arealight::LightShape;
use arealight_scene::rays::intersect_vertices;
use arealight_scene::{Camera, Scene};
use glam::DVec3;

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

/// Moves each lamp of a scene by an offset of its own.
pub fn shift(scene: &mut Scene, offsets: &[DVec3]) {
    for (lamp, offset) in scene.lamps.clone().iter().zip(offsets) {
        if *offset == DVec3::ZERO {
            continue;
        }
        for light in scene.lights.get_mut(lamp.lights.clone()).into_iter().flatten() {
            match &mut light.shape {
                LightShape::Polygon(vertices) | LightShape::Mesh { vertices, .. } => {
                    for vertex in vertices {
                        *vertex += *offset;
                    }
                }
                LightShape::Disk { center, .. } | LightShape::Sphere { center, .. } => *center += *offset,
                LightShape::Tube { p0, p1, .. } => {
                    *p0 += *offset;
                    *p1 += *offset;
                }
            }
        }
        for triangle in scene.triangles.get_mut(lamp.triangles.clone()).into_iter().flatten() {
            triangle.positions.iter_mut().for_each(|position| *position += *offset);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn lamps_move_with_what_they_look_like() {
        let before = room();
        let mut after = before.clone();
        let offsets: Vec<DVec3> = (0..before.lamps.len()).map(|i| DVec3::new(0.0, i as f64, -0.5)).collect();
        shift(&mut after, &offsets);
        for (lamp, offset) in before.lamps.iter().zip(offsets) {
            for light in lamp.lights.clone() {
                let [was, is] = [&before, &after].map(|scene| scene.lights[light].shape.center());
                assert!((is - was - offset).length() < 1e-9);
            }
            for triangle in lamp.triangles.clone() {
                let [was, is] = [&before, &after].map(|scene| scene.triangles[triangle].positions[2]);
                assert!((is - was - offset).length() < 1e-9);
            }
        }
        let still = |scene: &Scene| scene.triangles.iter().filter(|t| !t.lamp).copied().collect::<Vec<_>>();
        assert_eq!(still(&before), still(&after));
    }
}
