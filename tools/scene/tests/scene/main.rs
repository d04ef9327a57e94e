//! Scenes from files made here, good and bad, and the project's own.

mod allocations;
mod animations;
mod closed_lights;
mod compressed_views;
mod draco;
mod errors;
mod extensions;
mod geometry;
mod hostile;
mod ies_lights;
mod lights;
mod materials;
mod moving_images;
mod own_scenes;
mod placed_meshes;
mod punctual_lights;
mod rays;
mod shape_lights;
mod shapes;
mod tangents;
mod textured_lights;
mod vertex_colors;
mod writer;

use arealight_scene::Scene;
use serde_json::{Value, json};
use writer::Writer;

/// The scene that a writer holds; it must load.
fn load(writer: Writer) -> Scene {
    Scene::from_bytes(&writer.glb(), "test.glb").unwrap()
}

/// The text of the error that a writer's file gives.
fn error(writer: Writer) -> String {
    Scene::from_bytes(&writer.glb(), "test.glb").unwrap_err().to_string()
}

/// A scene's warnings as text, without those that a scene has no lights or no triangles.
fn warnings(scene: &Scene) -> Vec<String> {
    let own = scene.warnings.iter().filter(|warning| warning.place != "scene");
    own.map(ToString::to_string).collect()
}

fn notes(scene: &Scene) -> Vec<String> {
    scene.notes.iter().map(ToString::to_string).collect()
}

/// A writer with one panel of 2 by 1 on a node "node", of a material made from `material`.
fn panel_with(material: Value) -> Writer {
    let mut writer = Writer::new();
    let material = writer.push("materials", material);
    writer.object("panel", &shapes::panel(2.0, 1.0), material, json!({}));
    writer
}

/// A writer with one emissive shape of radiance (3, 2, 1).
fn emitter_with(shape: &writer::Shape, node: Value) -> Writer {
    let mut writer = Writer::new();
    let material = writer.emitter("glow", [3.0, 2.0, 1.0], false);
    writer.object("lamp", shape, material, node);
    writer
}
