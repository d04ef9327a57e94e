//! The hierarchy's closest hit against every triangle in turn.

use arealight_scene::rays::{self, Hit};
use arealight_scene::{Bounds, Scene, SceneBuffers, Triangle};
use arealight_tool_kernels::gpu::GpuMaterial;
use glam::{DVec3, Vec2, Vec3, Vec4};
use proptest::prelude::*;

fn scene_of(triangles: &[[DVec3; 3]], double_sided: bool) -> Scene {
    let writer = crate::panel_with(serde_json::json!({ "doubleSided": double_sided }));
    let mut scene = crate::load(writer);
    let triangle = |positions: &[DVec3; 3]| Triangle {
        positions: *positions,
        normals: [Vec3::Z; 3],
        uvs: [Vec2::ZERO; 3],
        tangents: [Vec4::ZERO; 3],
        colors: [Triangle::WHITE; 3],
        material: 0,
        groups: 0,
    };
    scene.triangles = triangles.iter().map(triangle).collect();
    scene
}

/// The closest of all triangles, one by one.
fn brute_force(buffers: &SceneBuffers, origin: DVec3, direction: DVec3) -> Option<Hit> {
    let double_sided = buffers.materials[0].flags & GpuMaterial::DOUBLE_SIDED != 0;
    let hits = buffers.triangles.iter().enumerate().filter_map(|(triangle, shape)| {
        let (distance, barycentric) = rays::intersect(shape, double_sided, origin, direction)?;
        Some(Hit { distance, triangle, barycentric })
    });
    hits.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

fn point(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rays_hit_what_brute_force_hits(
        corners in prop::collection::vec((point(10.0), point(1.5), point(1.5)), 1..300),
        rays in prop::collection::vec((point(14.0), point(1.0)), 20),
        double_sided in any::<bool>(),
        axis in 0..3_usize,
    ) {
        let triangles: Vec<[DVec3; 3]> = corners.iter().map(|(p, a, b)| [*p, *p + *a, *p + *b]).collect();
        let buffers = SceneBuffers::new(&scene_of(&triangles, double_sided), DVec3::ZERO).unwrap();
        prop_assert_eq!(buffers.triangles.len(), triangles.len());
        for (origin, towards) in rays {
            // Also straight along an axis, where the slabs of the other axes divide by zero
            let mut along = DVec3::ZERO;
            along[axis] = 1.0;
            for direction in [towards, along, -along] {
                let hit = buffers.closest_hit(origin, direction);
                let expected = brute_force(&buffers, origin, direction);
                // The same arithmetic on the same triangle: equal to the bit, unless two are equally near
                prop_assert_eq!(hit.map(|h| h.distance), expected.map(|h| h.distance));
            }
        }
    }
}

#[test]
fn brute_force_would_notice_a_missing_triangle() {
    let triangles =
        [[DVec3::ZERO, DVec3::X, DVec3::Y], [DVec3::NEG_Z, DVec3::X - DVec3::Z, DVec3::Y - DVec3::Z]];
    let mut buffers = SceneBuffers::new(&scene_of(&triangles, false), DVec3::ZERO).unwrap();
    let (origin, direction) = (DVec3::new(0.2, 0.2, 3.0), DVec3::NEG_Z);
    let hit = buffers.closest_hit(origin, direction).unwrap();
    assert_eq!((hit.distance, hit.barycentric), (3.0, [0.2, 0.2]));
    // The twin: without that triangle the traversal finds the next one
    buffers.triangles[hit.triangle].p1 = buffers.triangles[hit.triangle].p0;
    assert_eq!(buffers.closest_hit(origin, direction).unwrap().distance, 4.0);
}

#[test]
fn back_faces_are_seen_only_of_double_sided_materials() {
    let triangles = [[DVec3::ZERO, DVec3::X, DVec3::Y]];
    let (front, back) = (DVec3::new(0.2, 0.2, 1.0), DVec3::new(0.2, 0.2, -1.0));
    for double_sided in [false, true] {
        let buffers = SceneBuffers::new(&scene_of(&triangles, double_sided), DVec3::ZERO).unwrap();
        assert!(buffers.closest_hit(front, DVec3::NEG_Z).is_some());
        assert_eq!(buffers.closest_hit(back, DVec3::Z).is_some(), double_sided);
        assert_eq!(buffers.closest_hit(front, DVec3::Z), None, "nothing lies behind the ray");
    }
}

#[test]
fn positions_are_relative_to_the_origin() {
    let offset = DVec3::splat(1e7);
    let triangles = [[offset, offset + DVec3::X, offset + DVec3::Y]];
    let scene = scene_of(&triangles, false);
    let near = SceneBuffers::new(&scene, offset).unwrap();
    assert_eq!(near.triangles[0].p1, [1.0, 0.0, 0.0]);
    let hit = near.closest_hit(offset + DVec3::new(0.25, 0.25, 0.5), DVec3::NEG_Z).unwrap();
    assert_eq!(hit.distance, 0.5);
    let bounds: Bounds = triangles[0].into_iter().collect();
    assert_eq!(bounds.center() - offset, DVec3::new(0.5, 0.5, 0.0));
}

#[test]
fn texture_coordinates_and_normals_keep_their_places() {
    let mut scene = scene_of(&[[DVec3::ZERO, DVec3::X, DVec3::Y]], false);
    scene.triangles[0].uvs = [Vec2::new(1.0, 2.0), Vec2::new(3.0, 4.0), Vec2::new(5.0, 6.0)];
    scene.triangles[0].normals = [Vec3::X, Vec3::Y, Vec3::Z];
    let packed = SceneBuffers::new(&scene, DVec3::ZERO).unwrap().triangles[0];
    assert_eq!(
        [packed.u0, packed.v0, packed.u1, packed.v1, packed.u2, packed.v2],
        [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    );
    assert_eq!([packed.n0, packed.n1, packed.n2], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}
