//! Our own scenes, and frames of them.

use arealight::Light;
use arealight::plan::{ShadeOptions, TileOptions};
use arealight_engine::{Engine, SceneRenderer, TileCounts};
use arealight_scene::{Camera, Scene, SceneBuffers};
use glam::{Vec3, Vec4};
use std::path::Path;

/// The scene in the file of that name in `scenes`.
pub fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::load(path).expect("our own scenes load")
}

/// Hands on the view of a scene from its first camera, under `lights`.
pub fn with_renderer<T>(
    engine: &Engine,
    scene: &Scene,
    lights: &[Light],
    size: [u32; 2],
    act: impl FnOnce(&mut SceneRenderer<'_>) -> T,
) -> T {
    let camera = scene.camera(None, f64::from(size[0]) / f64::from(size[1])).expect("a camera");
    with_view(engine, scene, lights, (&camera, size), |renderer, _| act(renderer))
}

/// Hands on the view of a scene from a camera, under `lights`, and the scene's buffers.
pub fn with_view<T>(
    engine: &Engine,
    scene: &Scene,
    lights: &[Light],
    (camera, size): (&Camera, [u32; 2]),
    act: impl FnOnce(&mut SceneRenderer<'_>, &SceneBuffers) -> T,
) -> T {
    let buffers = SceneBuffers::new(scene, camera.position).expect("it fits");
    let constants = buffers.constants(camera, size, Vec3::ZERO);
    let renderer = SceneRenderer::new(engine, &buffers, lights, constants, size);
    act(&mut renderer.expect("a renderer"), &buffers)
}

/// The scene without what it emits, which would be rounded with what is reflected.
pub fn black(scene: &Scene) -> Scene {
    let mut black = scene.clone();
    black.materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
    black
}

/// What a scene reflects of `lights`.
pub fn reflected(
    engine: &Engine,
    scene: &Scene,
    lights: &[Light],
    size: [u32; 2],
    options: ShadeOptions,
) -> Vec<Vec4> {
    with_renderer(engine, &black(scene), lights, size, |renderer| {
        renderer.shade(options.surfaces, options.quality).unwrap();
        renderer.radiance().unwrap()
    })
}

/// The same by tiles, and what was found of these.
pub fn reflected_by_tiles(
    engine: &Engine,
    scene: &Scene,
    lights: &[Light],
    size: [u32; 2],
    (options, tiles): (ShadeOptions, TileOptions),
) -> (Vec<Vec4>, TileCounts) {
    with_renderer(engine, &black(scene), lights, size, |renderer| {
        let view = renderer.tiled(options, tiles).unwrap();
        renderer.shade_tiled(&view).unwrap();
        (renderer.radiance().unwrap(), view.counts(lights.len()).unwrap())
    })
}

/// The bits of the picture that was shaded.
pub fn bits(renderer: &mut SceneRenderer<'_>) -> Vec<[u32; 4]> {
    let texels = renderer.radiance().expect("the picture comes back");
    texels.into_iter().map(|texel: Vec4| texel.to_array().map(f32::to_bits)).collect()
}
