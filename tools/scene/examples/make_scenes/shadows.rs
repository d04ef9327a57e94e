//! Blockers of many sizes and heights under one rectangle: shadows that are hard where things touch the
//! floor, and wide above it.

use crate::shapes::{cuboid, cylinder, floor, panel, sphere};
use crate::writer::Writer;
use serde_json::json;

/// What the floor is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Floor {
    /// Lambert's lobe alone.
    Matt,
    /// GGX alone, of [`ROUGHNESS`].
    Glossy,
}

/// The roughness of the glossy floor.
pub const ROUGHNESS: f32 = 0.3;

/// Width and depth of the light.
pub const LIGHT: [f64; 2] = [1.6, 0.9];

pub fn glb(kind: Floor) -> Vec<u8> {
    let mut writer = Writer::new();
    let grey = writer.matt("grey", [0.8; 3]);
    let ground = match kind {
        Floor::Matt => grey,
        Floor::Glossy => writer.surface("glossy floor", [0.8; 3], 1.0, ROUGHNESS),
    };
    writer.object("floor", &floor(6.0, 6.0, 1.0).plain(), ground, json!({}));
    blockers(&mut writer, grey);
    // It faces down
    let lamp = writer.emitter("lamp", [7.0, 7.0, 7.0], false);
    let down = 0.5_f64.sqrt();
    let node = json!({ "translation": [0, 2.4, -0.6], "rotation": [down, 0, 0, down] });
    writer.object("lamp", &panel(LIGHT[0], LIGHT[1]).plain(), lamp, node);
    writer.camera("front", [0.2, 4.4, 3.1], [0.03, 0.0, 0.08], 0.64, 1.0);
    writer.glb()
}

fn blockers(writer: &mut Writer, material: usize) {
    let block = cuboid([0.5, 0.5, 0.5]).plain();
    let turned = json!({ "translation": [-1.05, 0.25, 0.25], "rotation": [0, 0.25882, 0, 0.96593] });
    writer.object("block", &block, material, turned);
    let tower = cuboid([0.3, 0.8, 0.3]).plain();
    writer.object("tower", &tower, material, json!({ "translation": [-0.45, 0.4, -0.8] }));
    // A shelf that hangs free: all of its shadow is penumbra
    let shelf = cuboid([0.7, 0.03, 0.45]).plain();
    let node = json!({ "translation": [-0.15, 0.65, 0.35], "rotation": [0, 0.17365, 0, 0.98481] });
    writer.object("shelf", &shelf, material, node);
    let slat = writer.primitive(&cuboid([0.05, 0.02, 0.9]).plain());
    let slat = writer.mesh("slat", &slat, material);
    for i in 0..7 {
        let place = [0.55 + 0.14 * f64::from(i), 0.3, -0.55];
        writer.node(json!({ "name": format!("slat {i}"), "mesh": slat, "translation": place }));
    }
    let pole = cylinder(0.03, 1.1, 24).plain();
    writer.object("pole", &pole, material, json!({ "translation": [0.45, 0.55, 0.45] }));
    let ball = sphere(0.25, 40, 24).plain();
    writer.object("ball", &ball, material, json!({ "translation": [1.15, 0.25, 0.55] }));
}
