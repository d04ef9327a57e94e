//! A shop: sixty panels in the ceiling above shelves of boxes and a polished floor.

use crate::shapes::{cuboid, floor, panel};
use crate::writer::Writer;
use serde_json::json;

const WIDTH: f64 = 12.0;
const DEPTH: f64 = 20.0;
const HEIGHT: f64 = 3.4;

/// Panels across the shop and along it.
pub const PANELS: [u32; 2] = [6, 10];

/// What stands on the shelves.
const COLORS: [[f32; 3]; 6] = [
    [0.62, 0.06, 0.05],
    [0.7, 0.5, 0.05],
    [0.06, 0.3, 0.12],
    [0.05, 0.14, 0.45],
    [0.75, 0.73, 0.7],
    [0.4, 0.1, 0.35],
];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    building(&mut writer);
    shelves(&mut writer);
    panels(&mut writer);
    writer.camera("entrance", [0.9, 1.7, 9.4], [-0.35, 1.2, 0.0], 0.78, 16.0 / 9.0);
    writer.glb()
}

fn building(writer: &mut Writer) {
    let tiles = writer.surface("polished floor", [0.36, 0.35, 0.34], 0.0, 0.22);
    let paint = writer.surface("paint", [0.6, 0.6, 0.58], 0.0, 0.8);
    writer.object("floor", &floor(WIDTH, DEPTH, 1.0).plain(), tiles, json!({}));
    let ceiling = json!({ "translation": [0, HEIGHT, 0], "rotation": [1, 0, 0, 0] });
    writer.object("ceiling", &floor(WIDTH, DEPTH, 1.0).plain(), paint, ceiling);
    let back = json!({ "translation": [0, HEIGHT * 0.5, -DEPTH * 0.5] });
    writer.object("back wall", &panel(WIDTH, HEIGHT).plain(), paint, back);
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    for (name, x, turn) in [("left wall", -0.5, quarter), ("right wall", 0.5, -quarter)] {
        let node = json!({ "translation": [x * WIDTH, HEIGHT * 0.5, 0], "rotation": [0, turn, 0, quarter] });
        writer.object(name, &panel(DEPTH, HEIGHT).plain(), paint, node);
    }
}

fn shelves(writer: &mut Writer) {
    let steel = writer.surface("steel", [0.6, 0.6, 0.62], 1.0, 0.3);
    let unit = writer.primitive(&cuboid([1.0; 3]).plain());
    let board = writer.mesh("board", &unit, steel);
    let goods: Vec<usize> = COLORS
        .iter()
        .enumerate()
        .map(|(i, color)| {
            let card = writer.surface(&format!("card {i}"), *color, 0.0, 0.45);
            writer.mesh("box", &unit, card)
        })
        .collect();
    // Four rows of three shelves, with boxes of three sizes
    for row in 0..4 {
        let x = 2.6 * (f64::from(row) - 1.5);
        for level in 0..3 {
            let y = 0.25 + 0.6 * f64::from(level);
            writer.node(json!({ "name": "board", "mesh": board, "translation": [x, y, -1.5],
                "scale": [0.7, 0.04, 13.0] }));
            for place in 0..16 {
                let kind = (place * 5 + level * 3 + row * 7) % 6;
                let height = [0.3, 0.42, 0.36][(place + level) as usize % 3];
                let z = 4.5 - 0.78 * f64::from(place);
                writer.node(json!({ "name": "box", "mesh": goods[kind as usize],
                    "translation": [x, y + 0.02 + 0.5 * height, z], "scale": [0.5, height, 0.55] }));
            }
        }
    }
}

fn panels(writer: &mut Writer) {
    let tube = writer.emitter("panel", [3.0, 3.0, 2.8], false);
    let shape = writer.primitive(&panel(1.1, 0.5).plain());
    let mesh = writer.mesh("panel", &shape, tube);
    let quarter = std::f64::consts::FRAC_1_SQRT_2;
    let [columns, rows] = PANELS;
    for i in 0..columns * rows {
        let (column, row) = (f64::from(i % columns), f64::from(i / columns));
        let x = (column + 0.5) * WIDTH / f64::from(columns) - 0.5 * WIDTH;
        let z = (row + 0.5) * DEPTH / f64::from(rows) - 0.5 * DEPTH;
        writer.node(json!({ "name": format!("panel {i}"), "mesh": mesh,
            "translation": [x, HEIGHT - 0.02, z], "rotation": [quarter, 0, 0, quarter] }));
    }
}
