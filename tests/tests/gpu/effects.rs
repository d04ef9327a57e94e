//! Effects are switches of what is computed, never of what comes out: one that no pixel uses changes no bit
//! of a picture, and the set of a scene shows what the set of all does.

use arealight::kernels::SHADE;
use arealight::plan::shade_specialization;
use arealight_tests::frame::bits;
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [64, 36];

/// The bits of a scene's picture, by the shade pass for these surfaces.
fn shade(engine: &TestEngine, scene: &Scene, surfaces: Effects, quality: Quality) -> Vec<[u32; 4]> {
    with_renderer(engine, scene, &scene.lights, SIZE, |renderer| {
        renderer.shade(surfaces, quality).unwrap();
        bits(renderer)
    })
}

/// The same by the kernel with the code of every one of the effects.
fn shade_by_all_of(engine: &TestEngine, scene: &Scene, effects: Effects, quality: Quality) -> Vec<[u32; 4]> {
    with_renderer(engine, scene, &scene.lights, SIZE, |renderer| {
        let options =
            ShadeOptions { surfaces: effects, quality, output: Output::Add, ..ShadeOptions::default() };
        let lights = LightSummary { effects, ..renderer.lights() };
        renderer.shade_by(&SHADE, &shade_specialization(options, lights)).unwrap();
        bits(renderer)
    })
}

/// How many pixels differ in any bit, and the largest difference of a channel, over the brightest channel.
fn difference(a: &[[u32; 4]], b: &[[u32; 4]]) -> (usize, f32) {
    let channels = || a.as_flattened().iter().zip(b.as_flattened());
    let numbers = || channels().map(|(a, b)| (f32::from_bits(*a), f32::from_bits(*b)));
    let brightest = numbers().fold(0.0, |most: f32, (a, _)| most.max(a));
    // NaN is the largest
    let larger = |most: f32, one: f32| if one <= most || most.is_nan() { most } else { one };
    let largest = numbers().map(|(a, b)| (a - b).abs()).fold(0.0, larger);
    (a.iter().zip(b).filter(|(a, b)| a != b).count(), largest / brightest)
}

/// Whether a [`difference`] is none: in no bit, or on devices that round in several ways no more than that.
fn is_none(engine: &TestEngine, (pixels, largest): (usize, f32)) -> bool {
    pixels == 0 || engine.rounding() > 0.0 && largest <= engine.rounding()
}

#[test]
fn the_documents_have_every_effect() {
    let table = include_str!("../../../docs/effects.md");
    for effect in Effects::all().iter() {
        assert!(table.contains(&format!("`{effect}`")), "{effect}");
    }
}

#[test]
fn an_effect_that_no_surface_needs_changes_no_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let required = scene.effects();
    let plain = Quality::default();
    let expected = shade(&engine, &scene, required, plain);
    let (pixels, largest) = difference(
        &expected,
        &shade(&engine, &scene, Effects::SURFACES - (Effects::MODEL - required), plain),
    );
    assert!(is_none(&engine, (pixels, largest)), "{pixels} pixels, {largest:e} at most");
    // The twin: one that pixels use changes most of them
    let (pixels, _) = difference(
        &shade(&engine, &scene, required, Quality::default()),
        &shade(&engine, &scene, required - Effects::GLOSSY, Quality::default()),
    );
    assert!(pixels > 1000, "{pixels}");
}

#[test]
fn code_that_no_light_needs_changes_no_bit() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let required = scene.effects();
    // Those of shapes have tests of their own, and pipelines that take long to make
    let unused = Effects::all() - Effects::SHAPES - Effects::MODEL - required;
    let plain = Quality::default();
    let dear = Quality {
        horizon: Horizon::Both,
        specular_lobes: SpecularLobes::Two,
        footprint: Footprint::Mips,
        ..Quality::default()
    };
    // Pipelines take their time: each effect once, and all but one of them at once on levels that bring code
    // of their own
    let mut sets: Vec<_> = unused.iter().map(|effect| (effect, plain)).collect();
    sets.push((unused - Effects::POLYGON, dear));
    sets.push((unused - Effects::POLYGON, Quality { specular_lobes: SpecularLobes::HalfVectors, ..dear }));
    let wrong = sets.into_iter().filter_map(|(added, quality)| {
        let (pixels, largest) = difference(
            &shade(&engine, &scene, required, quality),
            &shade_by_all_of(&engine, &scene, required | added, quality),
        );
        (!is_none(&engine, (pixels, largest)))
            .then(|| format!("{quality:?}, {added}: {pixels} pixels, {largest:e} at most"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn code_of_every_polygon_effect_shows_what_the_required_one_does() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("room.glb");
    let required = scene.effects();
    // With shapes too: shape_frames.rs
    let all = Effects::all() - Effects::SHAPES - (Effects::MODEL - required);
    assert!(required != all && required.contains(Effects::POLYGON | Effects::TWO_SIDED), "{required}");
    let quality = Quality::default();
    let (pixels, largest) = difference(
        &shade(&engine, &scene, required, quality),
        &shade_by_all_of(&engine, &scene, all, quality),
    );
    assert!(is_none(&engine, (pixels, largest)), "{pixels} pixels, {largest:e} at most");
}
