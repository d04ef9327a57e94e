//! Tiles of coated surfaces: a coat has a horizon of its own, and takes light from what is below.

use arealight_scene::{Image, SceneMaterial, Texture, Wrap};
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [61, 37];

/// What is reflected without tiles, and with; and how many lights all lists have.
pub fn pictures(
    engine: &TestEngine,
    scene: &Scene,
    lights: &[Light],
    (quality, cull_threshold): (Quality, f32),
) -> (Vec<Vec4>, Vec<Vec4>, u64) {
    let options = ShadeOptions { surfaces: scene.effects(), quality, ..ShadeOptions::default() };
    let tiles = TileOptions { cull_threshold, capacity: 1000, least_quads: 0 };
    let (tiled, counts) = reflected_by_tiles(engine, scene, lights, SIZE, (options, tiles));
    (reflected(engine, scene, lights, SIZE, options), tiled, counts.lights)
}

/// A square of half the width `size`, which faces both ways.
fn square(at: DVec3, along: DVec3, across: DVec3) -> Light {
    let corner = |(x, y): (f64, f64)| at + along * x + across * y;
    Light {
        name: format!("square at {at}"),
        shape: LightShape::Polygon([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec()),
        radiance: Vec3::new(1.0, 0.5, 0.25),
        two_sided: true,
        ..Light::default()
    }
}

/// The sweep with its surfaces bent towards `bend` in tangent space below coats of this weight that are not.
fn bent_sweep(bend: Vec3, weight: f32) -> Scene {
    let mut scene = scene("sweep.glb");
    let [x, y, z] = (bend.normalize_or(Vec3::Z) * 127.5 + 127.5).round().to_array().map(|c| c as u8);
    let texels = vec![u32::from_le_bytes([x, y, z, 255])];
    scene.images.push(Image { width: 1, height: 1, texels, ..Image::default() });
    let image = scene.images.len() as u32 - 1;
    scene.textures.push(Texture { image, srgb: false, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat });
    let texture = scene.textures.len() as u32 - 1;
    let coat = |material: &mut SceneMaterial| {
        material.normal_texture = Some(texture);
        (material.material.coat, material.material.coat_roughness) = (weight, 0.2);
        // Lambert's lobe alone: nothing of it is below its horizon
        (material.material.metalness, material.material.dielectric_f0) = (0.0, Vec3::ZERO);
        material.material.dielectric_f90 = 0.0;
    };
    scene.materials.iter_mut().for_each(coat);
    for triangle in &mut scene.triangles {
        triangle.tangents = [Vec3::X.extend(1.0); 3];
    }
    scene
}

/// How many pixels differ by more than each light's rounding.
fn different(a: &[Vec4], b: &[Vec4], lights: usize) -> usize {
    let bound = |pixel: &Vec4| f32::EPSILON * pixel.max_element() + 1e-6 * lights as f32;
    let apart = |(a, b): &(&Vec4, &Vec4)| {
        let apart = (**a - **b).abs().max_element();
        apart.is_nan() || apart > bound(a)
    };
    a.iter().zip(b).filter(apart).count()
}

#[test]
fn a_light_below_the_base_s_horizon_lights_the_coat() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = DVec3::ZERO;
    // Low lights on all sides of a floor whose base is bent by up to 75 degrees
    let lights: Vec<Light> = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z]
        .into_iter()
        .map(|side| square(floor + side * 7.0 + DVec3::Y * 0.8, side.cross(DVec3::Y) * 3.0, DVec3::Y * 0.7))
        .collect();
    for bend in [Vec3::new(3.0, 0.0, 1.0), Vec3::new(-1.0, 0.7, 1.0), Vec3::new(0.1, -3.5, 1.0)] {
        for horizon in [Horizon::Cosine, Horizon::Both] {
            let options = (Quality { horizon, ..Quality::default() }, 0.0);
            let (plain, tiled, listed) = pictures(&engine, &bent_sweep(bend, 1.0), &lights, options);
            assert_eq!(different(&plain, &tiled, lights.len()), 0, "{bend}, {horizon:?}");
            // The twin: tiles of the base alone leave out lights that light the coat where it isn't clipped
            // at the base's horizon
            let (bare, _, bare_listed) = pictures(&engine, &bent_sweep(bend, 0.0), &lights, options);
            println!("{bend}, {horizon:?}: {listed} with coats, {bare_listed} without");
            assert!(different(&plain, &bare, lights.len()) > 100, "{bend}, {horizon:?}");
            if horizon == Horizon::Cosine {
                assert!(bare_listed < listed, "{bend}: {bare_listed} and {listed}");
            }
        }
    }
}

#[test]
fn a_frame_of_coats_is_the_same_with_tiles() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("coats.glb");
    let center = scene.bounds.center();
    let (x, y, z) = (DVec3::X * 0.4, DVec3::Y * 0.4, DVec3::Z * 0.4);
    let mut lights = scene.lights.clone();
    for height in [-0.5, 0.0, 1e-6, 0.3, 1.0, 3.0] {
        let at = center.with_y(height);
        lights.extend([square(at, x, z), square(at + x * 5.0, x, y), square(at - x * 5.0, z * 5.0, y)]);
    }
    for horizon in [Horizon::Cosine, Horizon::Both] {
        let options = (Quality { horizon, ..Quality::default() }, 0.0);
        let (plain, tiled, listed) = pictures(&engine, &scene, &lights, options);
        // The scene's own lights have a radiance of 9
        assert_eq!(different(&plain, &tiled, 18 + 4 * 9), 0, "{horizon:?}");
        // The twin: without the last lights pictures differ
        let (fewer, ..) = pictures(&engine, &scene, &lights[..lights.len() - 3], options);
        assert!(listed > 0 && different(&plain, &fewer, 18 + 4 * 9) > 100, "{horizon:?}");
    }
}

#[test]
fn lights_that_are_culled_from_coats_contribute_less_than_the_threshold() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = scene("sweep.glb").bounds.center().with_y(0.0);
    let lights: Vec<Light> = (0..150)
        .map(|index| {
            let (column, row) = (f64::from(index % 15) - 7.0, f64::from(index / 15) - 4.5);
            let mut lamp = square(floor + DVec3::new(column, 1.2, row), DVec3::X * 0.05, DVec3::Z * 0.05);
            lamp.radiance *= if index % 7 == 0 { 20.0 } else { 0.02 };
            lamp
        })
        .collect();
    for (dielectric, roughness) in [(false, 0.4), (true, 0.2), (true, 0.7)] {
        let mut scene = scene("sweep.glb");
        for material in &mut scene.materials {
            (material.material.coat, material.material.coat_roughness) = (1.0, roughness);
            if dielectric {
                material.material.metalness = 0.0;
            }
        }
        let (plain, tiled, listed) = pictures(&engine, &scene, &lights, (Quality::default(), 0.05));
        let sum = |pixel: &Vec4| f64::from(pixel.truncate().element_sum());
        let lost = |all: &[Vec4], kept: &[Vec4]| {
            let pixels = all.iter().map(sum).zip(kept.iter().map(sum));
            pixels
                .map(|(all, kept)| (all - kept - 1e-5 * all - 1e-6).max(0.0) / kept.max(1e-9))
                .fold(0.0, f64::max)
        };
        let worst = lost(&plain, &tiled);
        println!("dielectric {dielectric}, coat {roughness}: {worst:.4} lost, {listed} lights in lists");
        assert!(worst <= 0.05, "{dielectric}, {roughness}: {worst}");
        if dielectric {
            assert!(listed * 10 < 9 * 150 * 8 * 5, "{dielectric}, {roughness}: {listed}");
        }
        // The twin: without a tenth of the lamps more is lost
        let (few, ..) = pictures(&engine, &scene, &lights[15..], (Quality::default(), 0.0));
        assert!(lost(&plain, &few) > 0.05, "{dielectric}, {roughness}");
    }
}
