//! Frames in parts, as drivers with a watchdog need them: the picture is that of the whole frame, to the bit.

use arealight_tests::frame::bits;
use arealight_tests::prelude::*;

/// No multiple of a workgroup's side: five rows of workgroups.
const SIZE: [u32; 2] = [61, 37];

/// What is recorded of a view, and what it leaves.
type Draw<'a> = &'a dyn Fn(&mut SceneRenderer<'_>, &SceneBuffers);

/// The picture that is drawn in submissions of at most `most_pairs`.
fn picture(engine: &TestEngine, scene: &Scene, most_pairs: u64, draw: Draw<'_>) -> Vec<[u32; 4]> {
    let camera = scene.camera(None, f64::from(SIZE[0]) / f64::from(SIZE[1])).unwrap();
    with_view(engine, scene, &scene.lights, (&camera, SIZE), |renderer, buffers| {
        renderer.split(most_pairs);
        draw(renderer, buffers);
        bits(renderer)
    })
}

/// Pairs of two rows of workgroups, and of less than one.
fn cuts(scene: &Scene) -> [u64; 2] {
    [u64::from(16 * SIZE[0]) * scene.lights.len() as u64, 1]
}

/// Checks that a picture is the same in parts; `other` is a picture that is not.
fn check(engine: &TestEngine, scene: &Scene, draw: Draw<'_>, other: Draw<'_>) {
    let whole = picture(engine, scene, u64::MAX, draw);
    for cut in cuts(scene) {
        assert!(picture(engine, scene, cut, draw) == whole, "in parts of {cut} the picture is another");
    }
    assert!(picture(engine, scene, u64::MAX, other) != whole, "the twin");
}

#[test]
fn a_frame_in_parts_is_the_same_picture() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("sweep.glb");
    let draw: Draw<'_> = &|renderer, _| {
        renderer.shade(scene.effects(), Quality::default()).unwrap();
    };
    check(&engine, &scene, draw, &|_, _| ());
}

#[test]
fn tiles_in_parts_are_the_same_picture_and_lists() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("shapes.glb");
    let options = ShadeOptions { surfaces: scene.effects(), ..ShadeOptions::default() };
    let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
    let counts = std::cell::RefCell::new(vec![]);
    let draw: Draw<'_> = &|renderer, _| {
        let view = renderer.tiled(options, tiles).unwrap();
        // The lists are of the last run alone
        for _ in 0..2 {
            renderer.shade_tiled(&view).unwrap();
        }
        counts.borrow_mut().push(view.counts(scene.lights.len()).unwrap());
    };
    check(&engine, &scene, draw, &|_, _| ());
    let counts = counts.into_inner();
    assert!(counts.iter().all(|found| *found == counts[0]), "{counts:?}");
    let tiles: u32 = counts[0].classes.iter().map(|(_, count)| count).sum();
    assert_eq!(tiles, 8 * 5);
}

#[test]
fn shadows_of_a_frame_in_parts_are_the_same_picture() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene("shadows.glb");
    let draw = |seed| {
        let surfaces = scene.effects();
        move |renderer: &mut SceneRenderer<'_>, buffers: &SceneBuffers| {
            let options = ShadeOptions { surfaces, shadow_rays: 1, ..ShadeOptions::default() };
            let with = (ShadowFilter::Gather, ShadowHistory::Off);
            let view = renderer.shadowed(buffers, options, with).unwrap();
            renderer.shade_shadowed(&view, seed).unwrap();
        }
    };
    check(&engine, &scene, &draw(3), &draw(4));
}

#[test]
fn parts_cover_a_frame_once() {
    let lights = LightSummary { light_count: 7, shape_count: 3, ..LightSummary::default() };
    let frame = ShadeFrame { size: [100, 61], lights, ..ShadeFrame::default() };
    let rows = |most| frame.parts(most).map(|part| part.rows.unwrap()).collect::<Vec<_>>();
    assert_eq!(rows(u64::MAX), [[0, 61]]);
    assert_eq!(rows(3 * 8000), [[0, 24], [24, 48], [48, 61]]);
    assert_eq!(rows(3 * 8000 - 1)[..2], [[0, 16], [16, 32]]);
    // A row of workgroups is the least
    assert_eq!(rows(0).len(), 8);
    // A part has parts
    let part = ShadeFrame { rows: Some([16, 40]), ..frame };
    let rows: Vec<_> = part.parts(2 * 8000).map(|part| part.rows.unwrap()).collect();
    assert_eq!(rows, [[16, 32], [32, 40]]);
    // Nothing is no work
    assert_eq!(ShadeFrame::default().parts(1).count(), 0);
}

#[test]
fn rows_that_cannot_be_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let frame = ShadeFrame { size: [8, 20], ..ShadeFrame::default() };
    let options = ShadeOptions { surfaces: Effects::DIFFUSE, ..ShadeOptions::default() };
    let pass = engine.pass(options).unwrap();
    let prepare = |rows| pass.prepare(&ShadeFrame { rows: Some(rows), ..frame });
    for wrong in [[0, 0], [8, 8], [0, 21], [4, 20], [0, 12], [16, 8], [u32::MAX - 7, u32::MAX]] {
        let Err(Error::InvalidArgument { field, .. }) = prepare(wrong) else { panic!("{wrong:?}") };
        assert_eq!(field, "rows", "{wrong:?}");
    }
    for right in [[0, 20], [0, 8], [8, 20], [16, 20]] {
        prepare(right).unwrap();
    }
}
