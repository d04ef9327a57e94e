//! Light linking: lights that shine on surfaces of some groups alone.

use arealight::plan::{ShadowFilter, ShadowHistory};
use arealight_engine::Reference;
use arealight_tests::floor::SIZE;
use arealight_tests::prelude::*;

fn linked(lobes: Effects) -> ShadeOptions {
    ShadeOptions { surfaces: lobes | Effects::LINKED, ..ShadeOptions::default() }
}

/// Whole tiles of one group, and others whose pixels are of several.
fn groups([x, y]: [u32; 2]) -> u8 {
    if x < 16 { 1 << (y / 8) } else { (x * 7 + y * 3) as u8 }
}

/// The lamps, each but the first in groups of its own.
fn linked_lamps() -> Vec<Light> {
    let mut lights = lamps();
    for (index, light) in lights.iter_mut().enumerate().skip(1) {
        light.links = 1 << index | 1 << (index / 2);
    }
    lights
}

fn shines(light: &Light, groups: u8) -> bool {
    light.links == 0 || light.links & groups != 0
}

#[test]
fn lights_shine_on_their_groups_alone() {
    let Some(engine) = TestEngine::new() else { return };
    let lights = linked_lamps();
    let floor = Floor::new(&engine, &lights);
    let stencils: Vec<u8> = pixels().map(groups).collect();
    let image = image(&engine, SIZE, vk::Format::R8_UINT, vk::ImageUsageFlags::SAMPLED, &stencils);
    let planes = floor.resources().planes.with(Plane::Stencil, Some(read(&image)));
    let resources = ShadeResources { planes, ..floor.resources() };
    let lobes = Effects::DIFFUSE | Effects::GLOSSY;
    for tiles in [false, true] {
        let found = floor.shade(linked(lobes), tiles, (&resources, &floor.frame(), Descriptors::Sets));
        let mut fewer = 0;
        for (pixel, found) in pixels().zip(found) {
            let expected = floor.expected(pixel, |index| shines(&lights[index], groups(pixel)));
            let error = (found.truncate().as_dvec3() - expected).abs().max_element();
            assert!(error < 1e-4, "{pixel:?}, tiles {tiles}: {found} is not {expected}");
            fewer += usize::from((floor.expected(pixel, |_| true) - expected).max_element() > 1e-3);
        }
        // The twin: all of the lights are more
        assert!(fewer > pixels().count() / 2, "{fewer}");
    }
    // Where surfaces have no groups every light shines on them, and no stencil is bound
    let plain = ShadeOptions { surfaces: lobes, ..ShadeOptions::default() };
    let found = floor.shade(plain, false, (&floor.resources(), &floor.frame(), Descriptors::Sets));
    for (pixel, found) in pixels().zip(found) {
        let error = (found.truncate().as_dvec3() - floor.expected(pixel, |_| true)).abs().max_element();
        assert!(error < 1e-4, "{pixel:?}: {found}");
    }
    // SAFETY: Nothing is recorded; the pass and the pool are dropped before the engine.
    unsafe {
        let pass = engine.pass(linked(lobes)).unwrap();
        let pool = engine.host().descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
        let set = pool.allocate(pass.set_layout()).unwrap();
        assert_eq!(field(&pass.write_set(set, &floor.resources()).unwrap_err()), "stencil");
    }
}

/// A floor in group 1 and a block on it in group 2, under a red lamp of the one and a green one of the other.
fn linked_scene() -> (Scene, Vec<Light>) {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mut triangles = vec![
        [at(-2.0, 0.0, 2.0), at(2.0, 0.0, 2.0), at(2.0, 0.0, -2.0)],
        [at(-2.0, 0.0, 2.0), at(2.0, 0.0, -2.0), at(-2.0, 0.0, -2.0)],
    ];
    triangles.extend(box_of(at(-0.4, 0.0, -0.4), at(0.4, 0.7, 0.4)));
    let mut scene = scene_of(&triangles, without_textures(lambert(0.8)));
    for (index, triangle) in scene.triangles.iter_mut().enumerate() {
        triangle.groups = if index < 2 { 1 } else { 2 };
    }
    let lamp = |x: f64, radiance: Vec3, links: u8| {
        let corners = [(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)];
        let shape = LightShape::Polygon(corners.map(|(u, v)| at(x + u, 1.5, v)).to_vec());
        Light { shape, radiance, links, ..Light::default() }
    };
    (scene, vec![lamp(-0.8, Vec3::X * 40.0, 1), lamp(0.8, Vec3::Y * 40.0, 2)])
}

#[test]
fn linked_lights_have_shadows_and_monte_carlo_has_them_too() {
    const SIDE: [u32; 2] = [32, 32];
    let Some(engine) = TestEngine::new() else { return };
    let (scene, lights) = linked_scene();
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
    let look = Camera::framing("", [DVec3::ZERO].into_iter().collect(), DVec3::NEG_Y, DVec3::Z, 1.0);
    let camera = Camera { position: DVec3::Y * 1.2, half_height: 1.6, ..look };
    let constants = buffers.constants(&camera, SIDE, Vec3::ZERO);
    let options = ShadeOptions { shadow_rays: 4, ..linked(Effects::DIFFUSE) };
    let seen = |rounds: u32, shade: &dyn Fn(&mut SceneRenderer<'_>)| {
        let mut renderer = SceneRenderer::new(&engine, &buffers, &lights, constants, SIDE).unwrap();
        shade(&mut renderer);
        let radiance = renderer.radiance().unwrap();
        radiance.iter().map(|pixel| pixel.truncate() / rounds as f32).collect::<Vec<Vec3>>()
    };
    let truth = seen(1, &|renderer| {
        let reference =
            Reference { samples: 1024, seed: 1, shadows: true, coupled: false, ..Reference::default() };
        renderer.reference(reference, |_| {}).unwrap();
    });
    let found = seen(16, &|renderer| {
        let view = renderer.shadowed(&buffers, options, (ShadowFilter::Off, ShadowHistory::Off)).unwrap();
        for seed in 0..16 {
            renderer.shade_shadowed(&view, seed).unwrap();
        }
    });
    let (mut of_floor, mut of_block, mut squares) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    for (found, truth) in found.iter().zip(&truth) {
        // A pixel is of the floor or of the block, which one lamp each shines on
        assert!(found.x == 0.0 || found.y == 0.0, "{found}");
        squares += f64::from((*found - *truth).length_squared());
        if found.y > 0.0 { of_block += *found } else { of_floor += *found }
    }
    let truth_sum: Vec3 = truth.iter().sum();
    let ratio = (of_floor + of_block).truncate() / truth_sum.truncate();
    // Several times the noise of 64 rays a pixel, and of Monte Carlo's samples
    let off = (squares * found.len() as f64).sqrt() / f64::from(truth_sum.element_sum());
    println!("mean {ratio}, pixels {off:.4}");
    assert!((ratio - 1.0).abs().max_element() < 0.01 && off < 0.1, "{ratio} {off}");
    // The block, which the red lamp doesn't shine on, hides it from the floor all the same
    let plain = seen(1, &|renderer| {
        renderer.shade(options.surfaces, options.quality).unwrap();
    });
    let dark = found.iter().zip(&plain).filter(|(found, plain)| plain.x > 0.05 && found.x < 0.5 * plain.x);
    let dark = dark.count();
    assert!((10..200).contains(&dark), "{dark} pixels are in its shadow");
}

#[test]
fn tiles_leave_out_lights_of_other_groups() {
    let Some(engine) = TestEngine::new() else { return };
    let (scene, mut lights) = linked_scene();
    let options = linked(Effects::DIFFUSE);
    let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
    let count = |lights: &[Light]| {
        let (_, counts) = reflected_by_tiles(&engine, &scene, lights, [64, 64], (options, tiles));
        counts.lights
    };
    let fewer = count(&lights);
    for light in &mut lights {
        light.links = 0;
    }
    let all = count(&lights);
    // Tiles of the floor alone have one of the two
    assert!(fewer < all * 3 / 4, "{fewer} of {all}");
}
