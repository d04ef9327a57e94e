//! Our own scenes, and frames of them.

use arealight::Light;
use arealight_engine::{Engine, SceneRenderer};
use arealight_scene::{Scene, SceneBuffers};
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
    let buffers = SceneBuffers::new(scene, camera.position).expect("our own scenes fit");
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    act(&mut SceneRenderer::new(engine, &buffers, lights, constants, size).expect("a renderer"))
}

/// The bits of the picture that was shaded.
pub fn bits(renderer: &mut SceneRenderer<'_>) -> Vec<[u32; 4]> {
    let texels = renderer.radiance().expect("the picture comes back");
    texels.into_iter().map(|texel: Vec4| texel.to_array().map(f32::to_bits)).collect()
}
