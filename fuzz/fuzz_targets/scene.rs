//! Any bytes as a glTF file: a scene whose lights are valid and whose buffers can be traced, or an error.
#![no_main]

mod memory;

use arealight_scene::{Scene, SceneBuffers};
use glam::DVec3;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let read = || Scene::from_bytes(bytes, "any");
    let Ok(scene) = memory::follows(bytes.len(), read) else { return };
    for light in &scene.lights {
        light.validate().expect("a scene's lights are valid");
    }
    arealight::PackedLights::new(&scene.lights, DVec3::ZERO).expect("valid lights can be packed");
    let camera = scene.camera(None, 1.5).expect("there is always a camera");
    assert!(camera.position.is_finite() && camera.forward.is_finite());
    let buffers = SceneBuffers::new(&scene, DVec3::ZERO).expect("a scene fits");
    let _ = buffers.closest_hit(camera.position, camera.forward);
});
