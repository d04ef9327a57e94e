//! A photographer's studio: a copper knot, a marble head and a vase before a backdrop, under three softboxes.

use crate::shapes::{backdrop, panel, rounded_box, sphere, torus_knot, turned};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use serde_json::json;

/// A panel of light that faces the middle of what is shown.
pub struct Softbox {
    pub name: &'static str,
    at: [f64; 3],
    size: [f64; 2],
    radiance: [f32; 3],
}

pub const SOFTBOXES: [Softbox; 3] = [
    Softbox { name: "key", at: [-2.6, 2.9, 2.4], size: [1.4, 1.8], radiance: [9.0, 8.4, 7.6] },
    Softbox { name: "fill", at: [3.6, 1.9, 2.2], size: [2.2, 2.2], radiance: [1.1, 1.3, 1.6] },
    Softbox { name: "rim", at: [1.9, 2.9, -1.5], size: [0.5, 1.9], radiance: [11.0, 11.6, 12.4] },
];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    let paper = writer.surface("paper", [0.42, 0.42, 0.44], 0.0, 0.85);
    writer.object("backdrop", &backdrop([12.0, 9.0, 5.0], 1.6).plain(), paper, json!({}));
    let oak = writer.surface("black oak", [0.035, 0.03, 0.028], 0.0, 0.28);
    let plinth = writer.primitive(&rounded_box([0.9, 0.5, 0.9], 0.02, 2).plain());
    let plinth = writer.mesh("plinth", &plinth, oak);
    for x in [-1.25, 0.0, 1.25] {
        writer.node(json!({ "name": "plinth", "mesh": plinth, "translation": [x, 0.25, 0] }));
    }
    let marble = writer.surface("marble", [0.78, 0.76, 0.72], 0.0, 0.25);
    writer.object("ball", &sphere(0.4, 48, 28).plain(), marble, json!({ "translation": [-1.25, 0.9, 0] }));
    let copper = writer.surface("copper", [0.95, 0.6, 0.44], 1.0, 0.22);
    let knot = torus_knot(2.0, 3.0, 0.42, 0.1, 160, 14).plain();
    writer.object("knot", &knot, copper, json!({ "translation": [0, 1.02, 0] }));
    let glaze = writer.surface("blue glaze", [0.03, 0.1, 0.28], 0.0, 0.18);
    writer.object("vase", &vase(), glaze, json!({ "translation": [1.25, 0.5, 0] }));
    for Softbox { name, at, size, radiance } in SOFTBOXES {
        let softbox = writer.emitter(name, radiance, false);
        let mut node = look_at(at, [0.0, 0.8, 0.0]);
        turn_around(&mut node);
        writer.object(name, &panel(size[0], size[1]).plain(), softbox, node);
    }
    writer.camera("front", [0.0, 1.45, 5.4], [0.0, 0.78, 0.0], 0.44, 16.0 / 9.0);
    writer.glb()
}

fn vase() -> crate::writer::Shape {
    let outline = [
        [0.17, 0.0],
        [0.2, 0.01],
        [0.27, 0.1],
        [0.32, 0.22],
        [0.33, 0.34],
        [0.29, 0.48],
        [0.2, 0.6],
        [0.13, 0.68],
        [0.1, 0.76],
        [0.11, 0.83],
        [0.14, 0.88],
        [0.13, 0.89],
        [0.11, 0.87],
        [0.09, 0.8],
    ];
    turned(&outline, 56).plain()
}
