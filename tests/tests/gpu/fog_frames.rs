//! A medium before pictures: froxels against Monte Carlo.

use arealight::plan::{Output, ShadeOptions};
use arealight_engine::{Fog, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
use arealight_tests::TestEngine;
use arealight_tests::frame::scene;
use glam::{Vec3, Vec4};

const SIZE: [u32; 2] = [64, 36];
const FROXELS: [u32; 3] = [32, 18, 64];

const FOG: Fog = Fog { density: 0.15, albedo: Vec3::ONE, anisotropy: 0.5, farthest: 14.0 };

/// The picture of a scene's lamps, with what `act` adds before.
fn picture(
    engine: &TestEngine,
    scene: &Scene,
    act: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers),
) -> Vec<Vec4> {
    seen_from(engine, scene, 0.0, act)
}

/// The same by a camera that went so far ahead.
fn seen_from(
    engine: &TestEngine,
    scene: &Scene,
    ahead: f64,
    act: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers),
) -> Vec<Vec4> {
    let mut camera = scene.camera(None, 16.0 / 9.0).unwrap();
    camera.position += ahead * camera.forward;
    let buffers = SceneBuffers::new(scene, camera.position).unwrap();
    let constants = buffers.constants(&camera, SIZE, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, SIZE).unwrap();
    renderer.shade_as(ShadeOptions { output: Output::Add, ..ShadeOptions::default() }).unwrap();
    act(&mut renderer, &buffers);
    renderer.radiance().unwrap()
}

/// RMSE over mean of averages of 4 x 4 pixels, without those that show a lamp: averaging divides the
/// reference's noise by four.
fn difference(clear: &[Vec4], found: &[Vec4], truth: &[Vec4]) -> f32 {
    const SIDE: usize = 4;
    let width = SIZE[0] as usize;
    let of_block = |block: usize| {
        let (column, row) = (block % (width / SIDE) * SIDE, block / (width / SIDE) * SIDE);
        (0..SIDE * SIDE).map(move |pixel| (row + pixel / SIDE) * width + column + pixel % SIDE)
    };
    let (mut square, mut sum, mut count) = (0.0, 0.0, 0.0);
    for block in (0..clear.len() / (SIDE * SIDE)).filter(|block| of_block(*block).all(|at| clear[at].x < 4.0))
    {
        let mean = |picture: &[Vec4]| of_block(block).map(|at| picture[at].truncate()).sum::<Vec3>() / 16.0;
        square += (mean(found) - mean(truth)).length_squared();
        sum += mean(truth).element_sum();
        count += 3.0;
    }
    (square / count).sqrt() / (sum / count)
}

#[test]
fn froxels_are_near_to_monte_carlo() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    let clear = picture(&engine, &scene, |_, _| ());
    let fogged = |fog: Fog, shadows: bool| {
        picture(&engine, &scene, |r, s| _ = r.add_fog(s, &fog, FROXELS, (4, shadows, 1)).unwrap())
    };
    // The reference's noise at 256 samples is .013 and .02; a grid twice as fine still errs by .018 and .03
    for (shadows, bound) in [(false, 0.03), (true, 0.06)] {
        let truth =
            picture(&engine, &scene, |r, _| _ = r.fog_reference(&FOG, 256, (shadows, 0), |_| ()).unwrap());
        let error = difference(&clear, &fogged(FOG, shadows), &truth);
        // The twins: light that goes on the other way, and the other kind of shadows
        let turned = difference(&clear, &fogged(Fog { anisotropy: -0.5, ..FOG }, shadows), &truth);
        let other = difference(&clear, &fogged(FOG, !shadows), &truth);
        println!("shadows {shadows}: {error:.3}; turned {turned:.3}, other shadows {other:.3}");
        assert!(error < bound, "{error}");
        assert!(turned > 2.0 * bound && other > 2.0 * bound, "{turned}, {other}");
    }
}

#[test]
fn no_fog_changes_nothing_and_much_of_it_gives_numbers() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    let clear = picture(&engine, &scene, |_, _| ());
    let with =
        |fog: Fog| picture(&engine, &scene, |r, s| _ = r.add_fog(s, &fog, [5, 3, 7], (1, true, 0)).unwrap());
    assert_eq!(with(Fog { density: 0.0, ..FOG }), clear);
    for density in [1e-6, 1e3, 1e30] {
        for anisotropy in [0.0, 0.99, -0.99] {
            let found = with(Fog { density, anisotropy, ..FOG });
            assert!(found.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0), "{density}");
        }
    }
}

#[test]
fn slices_do_not_show_while_the_camera_moves() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("slats.glb");
    // A slice about the lamps is .3 long: steps through one
    for ahead in [0.0, 0.06, 0.12, 0.18, 0.24] {
        let with = |slices: u32| {
            let fog = |r: &mut SceneRenderer<'_>, s: &SceneBuffers| {
                _ = r.add_fog(s, &FOG, [FROXELS[0], FROXELS[1], slices], (1, false, 0)).unwrap();
            };
            seen_from(&engine, &scene, ahead, fog)
        };
        let clear = seen_from(&engine, &scene, ahead, |_, _| ());
        let fine = with(512);
        let [found, coarse] = [64, 8].map(|slices| difference(&clear, &with(slices), &fine));
        println!("{ahead}: {found:.4}; 8 slices {coarse:.4}");
        // Half a level of 255 where the mean is a level of 50; the twin, slices that do show
        assert!(found < 0.01 && coarse > 0.03, "{found}, {coarse}");
    }
}
