//! Spheres from smooth to rough, and from dielectric to metal, under a rectangle.

use crate::shapes::{floor, panel, sphere};
use crate::writer::{Writer, look_at};
use serde_json::json;

pub const ROUGHNESS: [f32; 8] = [0.05, 0.12, 0.2, 0.3, 0.42, 0.56, 0.75, 1.0];
pub const METALNESS: [f32; 4] = [1.0, 0.67, 0.33, 0.0];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    // A floor that shows the light's shape, softened
    let ground = writer.surface("floor", [0.18, 0.18, 0.19], 0.0, 0.3);
    writer.object("floor", &floor(40.0, 40.0, 1.0), ground, json!({}));
    // A row of spheres for each metalness, the metals at the back; all share one shape
    let shape = writer.primitive(&sphere(0.44, 60, 34).plain());
    for (row, metalness) in METALNESS.into_iter().enumerate() {
        for (column, roughness) in ROUGHNESS.into_iter().enumerate() {
            let name = format!("roughness {roughness}, metalness {metalness}");
            let material = writer.surface(&name, [0.9, 0.46, 0.2], metalness, roughness);
            let mesh = writer.mesh(&name, &shape, material);
            let (x, z) = (column as f64 - 3.5, row as f64 * 1.3 - 1.95);
            writer.node(json!({ "name": name, "mesh": mesh, "translation": [x, 0.44, z] }));
        }
    }
    // One rectangle above them, out of view, tilted so that the spheres' near sides are lit
    let lamp = writer.emitter("lamp", [5.0, 5.0, 5.0], false);
    let mut node = look_at([0.0, 4.6, 2.4], [0.0, 0.4, 0.2]);
    // A panel faces +Z, a node looks along -Z: turn it by half a turn about its own Y
    turn_around(&mut node);
    writer.object("lamp", &panel(7.0, 2.4), lamp, node);
    writer.camera("front", [0.0, 7.6, 9.0], [0.0, 0.3, 0.05], 0.50, 16.0 / 9.0);
    writer.glb()
}

/// Turns a node of [`look_at`] so that its +Z points at the target.
pub fn turn_around(node: &mut serde_json::Value) {
    let rotation: Vec<f64> =
        node["rotation"].as_array().into_iter().flatten().filter_map(serde_json::Value::as_f64).collect();
    // q times a half turn about Y, (0, 1, 0, 0)
    node["rotation"] = json!([-rotation[2], rotation[3], rotation[0], -rotation[1]]);
}
