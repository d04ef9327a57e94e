//! Blockers along rays, found in a hierarchy on the GPU, against every triangle in turn in float64; and what
//! blocks in a scene.

use arealight::Blockers;
use arealight_engine::host::Buffer;
use arealight_oracle::visibility::is_hidden;
use arealight_scene::{Image, Texture, Wrap};
use arealight_tests::kernel::{BLOCKERS, SCENE_BLOCKERS};
use arealight_tests::prelude::*;
use glam::Vec2;

type Triangle = [Vec3; 3];

/// A ray up to a distance. What it is compared at is its float32 numbers.
#[derive(Clone, Copy)]
struct Ray {
    origin: Vec3,
    direction: Vec3,
    distance: f32,
}

impl Ray {
    fn new(origin: DVec3, direction: DVec3, distance: f64) -> Self {
        Self { origin: origin.as_vec3(), direction: direction.as_vec3(), distance: distance as f32 }
    }

    /// The distances, below the ray's, of all triangles that it meets, if `margin` is added to each on all
    /// sides (or taken off).
    fn met(&self, triangles: &[Triangle], margin: f64) -> Vec<f64> {
        let (origin, direction) = (self.origin.as_dvec3(), self.direction.as_dvec3());
        let meet = |[a, b, c]: &Triangle| {
            let [a, b, c] = [a, b, c].map(|vertex| vertex.as_dvec3() - origin);
            let normal = (b - a).cross(c - a);
            let distance = normal.dot(a) / normal.dot(direction);
            let place = direction * distance;
            // Distances inside of the edges
            let inside = [(a, b), (b, c), (c, a)]
                .map(|(p, q)| (q - p).cross(place - p).dot(normal) / (normal.length() * (q - p).length()));
            let within = inside.iter().all(|inside| *inside >= -margin);
            (within && distance > -margin && distance < f64::from(self.distance) + margin).then_some(distance)
        };
        triangles.iter().filter_map(meet).collect()
    }
}

/// Rays as a kernel reads them.
fn upload(engine: &TestEngine, rays: &[Ray]) -> Buffer {
    let record =
        |ray: &Ray| [ray.origin.extend(0.0), ray.direction.extend(ray.distance)].map(|row| row.to_array());
    engine.host().storage_buffer("rays", &rays.iter().map(record).collect::<Vec<_>>()).unwrap()
}

/// The kernel's distances.
fn hits(engine: &TestEngine, blockers: &Blockers, rays: &[Ray]) -> Vec<f64> {
    let host = engine.host();
    let nodes = host.storage_buffer("nodes", &blockers.nodes).unwrap();
    let nothing = [[0.0_f32; 4]; 3];
    let triangles = if blockers.triangles.is_empty() { &[nothing][..] } else { &blockers.triangles };
    let triangles = host.storage_buffer("triangles", triangles).unwrap();
    let given = upload(engine, rays);
    let inputs = [&nodes, &triangles, &given].map(|buffer| Resource::buffer(buffer.handle()));
    let found: Vec<f32> = engine.dispatch(&BLOCKERS, &[], &inputs, rays.len());
    found.into_iter().map(f64::from).collect()
}

/// How many rays are told wrongly: not free where they must be, free where they may not, or blocked where
/// nothing is.
fn wrong(rays: &[Ray], found: &[f64], triangles: &[Triangle], margin: f64) -> usize {
    let is_wrong = |(ray, found): &(&Ray, &f64)| {
        if **found == f64::from(ray.distance) {
            return !ray.met(triangles, -margin).is_empty();
        }
        !ray.met(triangles, margin).iter().any(|distance| (distance - **found).abs() <= margin)
    };
    rays.iter().zip(found).filter(is_wrong).count()
}

/// Rays within a box about zero: some straight along an axis.
fn rays(random: &mut Random, count: usize, extent: f64) -> Vec<Ray> {
    let ray = |i: usize| {
        let direction = if i.is_multiple_of(4) { DVec3::AXES[i / 4 % 3] } else { random.direction() };
        Ray::new(random.direction() * extent, direction, random.between(0.1, 2.0) * extent)
    };
    (0..count).map(ray).collect()
}

/// Triangles of many sizes about zero.
fn crowd(random: &mut Random, count: usize, extent: f64) -> Vec<Triangle> {
    let triangle = |_| {
        let (middle, size) =
            (random.direction() * random.between(0.0, extent), random.between(0.01, 0.2) * extent);
        [0, 1, 2].map(|_| (middle + random.direction() * size).as_vec3())
    };
    (0..count).map(triangle).collect()
}

/// The 12 triangles of boxes whose sides are along the axes.
fn boxes(random: &mut Random, count: usize, extent: f64) -> Vec<Triangle> {
    let mut triangles = vec![];
    for _ in 0..count {
        let (middle, half) = (random.direction() * extent, random.between(0.02, 0.2) * extent);
        for axis in 0..6 {
            let (w, sign) = (DVec3::AXES[axis % 3] * half, if axis < 3 { 1.0 } else { -1.0 });
            let (u, v) = (DVec3::AXES[(axis + 1) % 3] * half, DVec3::AXES[(axis + 2) % 3] * half);
            let corner = |a: f64, b: f64| (middle + w * sign + u * a + v * b).as_vec3();
            triangles.push([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)]);
            triangles.push([corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
        }
    }
    triangles
}

#[test]
fn a_walk_finds_a_blocker_where_one_is() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(20);
    for (triangles, extent) in [
        (crowd(&mut random, 3000, 1.0), 1.0),
        (crowd(&mut random, 200, 300.0), 300.0),
        (boxes(&mut random, 200, 10.0), 10.0),
        (crowd(&mut random, 1, 1.0), 1.0),
    ] {
        let blockers = Blockers::new(&triangles).unwrap();
        let rays = rays(&mut random, 1000, extent);
        let found = hits(&engine, &blockers, &rays);
        // Float32 in coordinates up to twice the extent, over cosines down to about a hundredth
        let margin = 1e-5 * extent;
        assert_eq!(wrong(&rays, &found, &triangles, margin), 0, "{} triangles", triangles.len());
        let blocked =
            rays.iter().zip(&found).filter(|(ray, found)| **found < f64::from(ray.distance)).count();
        assert!(triangles.len() == 1 || (30..970).contains(&blocked), "{blocked} rays of 1000 are blocked");
        // The twin: without half of the triangles, or as far away as they block, it is wrong
        let half = &triangles[triangles.len() / 2..];
        let fewer = hits(&engine, &Blockers::new(half).unwrap(), &rays);
        assert!(triangles.len() == 1 || wrong(&rays, &fewer, &triangles, margin) > 10);
        assert!(triangles.len() == 1 || wrong(&rays, &found, half, margin) > 10);
    }
}

#[test]
fn a_walk_agrees_with_the_oracle_s_visibility() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(21);
    let triangles = crowd(&mut random, 300, 1.0);
    let rays = rays(&mut random, 1000, 1.0);
    let found = hits(&engine, &Blockers::new(&triangles).unwrap(), &rays);
    let agrees = |(ray, found): &(&Ray, &f64)| {
        let origin = ray.origin.as_dvec3();
        let seen: Vec<_> = triangles.iter().map(|t| t.map(|vertex| vertex.as_dvec3() - origin)).collect();
        let target = ray.direction.as_dvec3() * f64::from(ray.distance);
        is_hidden(target, &seen) == (**found < f64::from(ray.distance))
    };
    // All but those that graze an edge: about 1e-6 of the rays
    assert_eq!(rays.iter().zip(&found).filter(agrees).count(), rays.len());
}

#[test]
fn both_faces_block_and_nothing_behind_or_beyond() {
    let Some(engine) = TestEngine::new() else { return };
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let at = |height: f64, down: f64, distance: f64| {
        Ray::new(DVec3::new(0.2, 0.2, height), DVec3::Z * -down, distance)
    };
    let rays =
        [at(1.0, 1.0, 2.0), at(-1.0, -1.0, 2.0), at(1.0, -1.0, 2.0), at(1.0, 1.0, 0.9), at(0.0, 1.0, 5.0)];
    let blockers = Blockers::new(&[triangle]).unwrap();
    assert_eq!(hits(&engine, &blockers, &rays), [1.0, 1.0, 2.0, f64::from(0.9_f32), 5.0]);
    // Without triangles all rays are free, also through zero
    let none = Blockers::new(&[]).unwrap();
    assert_eq!(hits(&engine, &none, &rays), [2.0, 2.0, 2.0, f64::from(0.9_f32), 5.0]);
}

/// The distances that the scene's own bridge gives.
fn hit_in_scene(engine: &TestEngine, scene: &Scene, rays: &[Ray]) -> Vec<f64> {
    let host = engine.host();
    let buffers = SceneBuffers::new(scene, DVec3::ZERO).unwrap();
    let given = [
        host.storage_buffer("nodes", &buffers.nodes).unwrap(),
        host.storage_buffer("triangles", &buffers.triangles).unwrap(),
        host.storage_buffer("materials", &buffers.materials).unwrap(),
        host.storage_buffer("textures", &buffers.textures).unwrap(),
        host.storage_buffer("texels", &buffers.texels).unwrap(),
        upload(engine, rays),
    ];
    let inputs = given.each_ref().map(|buffer| Resource::buffer(buffer.handle()));
    let found: Vec<f32> = engine.dispatch(&SCENE_BLOCKERS, &[], &inputs, rays.len());
    found.into_iter().map(f64::from).collect()
}

/// Three triangles above each other, and an image of two texels whose left one is transparent.
fn masked_scene() -> Scene {
    let at = |z: f64| [DVec3::Z * z, DVec3::new(4.0, 0.0, z), DVec3::new(0.0, 4.0, z)];
    let mut scene = scene_of(&[at(1.0), at(2.0), at(3.0)], without_textures(lambert(0.5)));
    let image = Image { width: 2, height: 1, texels: vec![0x00ff_ffff, 0xffff_ffff], ..Image::default() };
    scene.images.push(image);
    scene.textures.push(Texture { image: 0, srgb: true, wrap_u: Wrap::Clamp, wrap_v: Wrap::Clamp });
    scene
}

#[test]
fn a_scene_blocks_but_where_it_is_masked_out() {
    let Some(engine) = TestEngine::new() else { return };
    let mut scene = masked_scene();
    let mut ray = Ray::new(DVec3::new(1.0, 1.0, 0.0), DVec3::Z, 10.0);
    let hit = |scene: &Scene, ray: Ray| hit_in_scene(&engine, scene, &[ray])[0];
    // Any of the three; from below they show their back, which is not seen
    scene.materials[0].double_sided = false;
    assert!([1.0, 2.0, 3.0].contains(&hit(&scene, ray)));
    scene.triangles.swap_remove(0);
    scene.triangles.swap_remove(0);
    // What is at the light does not, nor is there anything before 1.9
    for (distance, expected) in [(2.0, 2.0), (2.0003, 2.0003), (2.001, 2.0), (1.9, 1.9)] {
        ray.distance = distance as f32;
        assert_eq!(hit(&scene, ray), f64::from(expected as f32), "{distance}");
    }
    // A mask whose left texel is transparent
    let masked = |cutoff, blended| {
        let mut scene = scene.clone();
        scene.triangles[0].uvs = [Vec2::ZERO, Vec2::X * 4.0, Vec2::ZERO];
        scene.materials[0].base_color_texture = Some(0);
        scene.materials[0].alpha_cutoff = cutoff;
        scene.materials[0].blended = blended;
        scene
    };
    for (x, cutoff, blended, expected) in [
        (0.2, Some(0.5), false, 10.0),
        (0.8, Some(0.5), false, 2.0),
        (0.2, None, false, 2.0),
        (0.2, None, true, 10.0),
        (0.8, None, true, 2.0),
    ] {
        let ray = Ray::new(DVec3::new(x, 1.0, 0.0), DVec3::Z, 10.0);
        assert_eq!(hit(&masked(cutoff, blended), ray), expected, "{x} {cutoff:?} {blended}");
    }
}
