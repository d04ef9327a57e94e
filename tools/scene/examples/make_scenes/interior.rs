//! A living room: light through a window, a globe under the ceiling, a lamp with a round shade, a sofa on a
//! rug.

use crate::shapes::{cylinder, floor, panel, rounded_box, sphere, turned};
use crate::writer::{Writer, look_at};
use image::{Rgb, RgbImage};
use serde_json::json;

const WIDTH: f64 = 6.4;
const HEIGHT: f64 = 2.8;
const DEPTH: f64 = 5.2;
const HALF_TURN: f64 = std::f64::consts::FRAC_1_SQRT_2;

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    writer.use_extension("KHR_materials_sheen");
    walls(&mut writer);
    sofa(&mut writer);
    table(&mut writer);
    lights(&mut writer);
    writer.camera("door", [2.3, 1.5, 4.6], [-0.45, 0.85, -0.7], 0.72, 16.0 / 9.0);
    writer.glb()
}

fn walls(writer: &mut Writer) {
    let boards = writer.tiles("boards", &boards());
    let wood = writer.surface("oak boards", [1.0, 1.0, 1.0], 0.0, 0.32);
    writer.root["materials"][wood]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": boards });
    let plaster = writer.surface("plaster", [0.7, 0.68, 0.64], 0.0, 0.9);
    let paint = writer.surface("green paint", [0.16, 0.24, 0.2], 0.0, 0.55);
    writer.object("floor", &floor(WIDTH, 2.0 * DEPTH, 1.6), wood, json!({}));
    let ceiling = json!({ "translation": [0, HEIGHT, 0], "rotation": [1, 0, 0, 0] });
    writer.object("ceiling", &floor(WIDTH, DEPTH, 1.0).plain(), plaster, ceiling);
    let back = json!({ "translation": [0, HEIGHT * 0.5, -DEPTH * 0.5] });
    writer.object("back wall", &panel(WIDTH, HEIGHT).plain(), paint, back);
    let side = |x: f64, turn: f64| json!({ "translation": [x, HEIGHT * 0.5, 0], "rotation": [0, turn, 0, HALF_TURN] });
    writer.object("left wall", &panel(DEPTH, HEIGHT).plain(), plaster, side(-0.5 * WIDTH, HALF_TURN));
    writer.object("right wall", &panel(DEPTH, HEIGHT).plain(), plaster, side(0.5 * WIDTH, -HALF_TURN));
}

fn sofa(writer: &mut Writer) {
    let wool = writer.surface("wool", [0.1, 0.13, 0.2], 0.0, 0.85);
    writer.root["materials"][wool]["extensions"] = json!({ "KHR_materials_sheen": {
        "sheenColorFactor": [0.25, 0.27, 0.32], "sheenRoughnessFactor": 0.5 } });
    let rug = writer.surface("rug", [0.42, 0.22, 0.14], 0.0, 0.95);
    writer.object(
        "rug",
        &rounded_box([3.2, 0.03, 2.0], 0.014, 1).plain(),
        rug,
        json!({ "translation": [-0.5, 0.015, -0.4] }),
    );
    for (name, size, at) in [
        ("seat", [1.9, 0.34, 0.85], [-0.6, 0.33, -1.75]),
        ("back", [1.9, 0.62, 0.24], [-0.6, 0.6, -2.2]),
        ("left arm", [0.24, 0.58, 0.95], [-1.6, 0.33, -1.8]),
        ("right arm", [0.24, 0.58, 0.95], [0.4, 0.33, -1.8]),
    ] {
        writer.object(name, &rounded_box(size, 0.09, 3).plain(), wool, json!({ "translation": at }));
    }
    let mustard = writer.surface("mustard cushion", [0.6, 0.36, 0.06], 0.0, 0.8);
    let node = json!({ "translation": [-1.15, 0.68, -1.9], "rotation": [-0.17365, 0, 0, 0.98481] });
    writer.object("cushion", &rounded_box([0.48, 0.42, 0.16], 0.07, 3).plain(), mustard, node);
}

fn table(writer: &mut Writer) {
    let lacquer = writer.surface("lacquer", [0.05, 0.045, 0.04], 0.0, 0.12);
    let brass = writer.surface("brass", [0.9, 0.7, 0.38], 1.0, 0.25);
    let china = writer.surface("china", [0.8, 0.8, 0.78], 0.0, 0.2);
    writer.object(
        "table top",
        &cylinder(0.55, 0.04, 56).plain(),
        lacquer,
        json!({ "translation": [-0.45, 0.42, -0.35] }),
    );
    writer.object(
        "table foot",
        &cylinder(0.05, 0.4, 24).plain(),
        brass,
        json!({ "translation": [-0.45, 0.2, -0.35] }),
    );
    let bowl =
        [[0.06, 0.0], [0.12, 0.03], [0.17, 0.08], [0.2, 0.14], [0.19, 0.145], [0.15, 0.08], [0.0, 0.05]];
    writer.object("bowl", &turned(&bowl, 40).plain(), china, json!({ "translation": [-0.6, 0.44, -0.4] }));
    writer.object(
        "ball",
        &sphere(0.09, 32, 18).plain(),
        brass,
        json!({ "translation": [-0.22, 0.53, -0.25] }),
    );
    // The standing lamp below its shade
    writer.object(
        "lamp foot",
        &cylinder(0.16, 0.03, 40).plain(),
        brass,
        json!({ "translation": [1.35, 0.015, -2.0] }),
    );
    writer.object(
        "lamp pole",
        &cylinder(0.015, 1.4, 16).plain(),
        brass,
        json!({ "translation": [1.35, 0.7, -2.0] }),
    );
}

fn lights(writer: &mut Writer) {
    // Two panes in the left wall
    let day = writer.emitter("window", [3.4, 4.1, 5.2], false);
    for z in [-0.75, 0.55] {
        let node =
            json!({ "translation": [-0.5 * WIDTH + 0.02, 1.5, z], "rotation": [0, HALF_TURN, 0, HALF_TURN] });
        writer.object("window", &panel(1.15, 1.6).plain(), day, node);
    }
    let globe = writer.emitter("globe", [7.0, 5.6, 4.0], false);
    let node = json!({ "translation": [-0.4, 2.3, -0.5], "extras": { "arealight": { "shape": "sphere", "radius": 0.16 } } });
    writer.object("globe", &sphere(0.16, 40, 24).plain(), globe, node);
    let shade = writer.emitter("lamp shade", [6.0, 3.6, 1.7], false);
    let said = json!({ "shape": "cylinder", "radius": 0.17, "height": 0.34 });
    let node = json!({ "translation": [1.35, 1.55, -2.0], "extras": { "arealight": said } });
    writer.object("lamp shade", &cylinder(0.17, 0.34, 48).plain(), shade, node);
    // A picture light above the sofa, which looks down along the wall
    let strip = writer.emitter("picture light", [9.0, 7.6, 5.6], false);
    let mut node = look_at([-0.6, 2.25, -2.35], [-0.6, 1.3, -2.6]);
    crate::sweep::turn_around(&mut node);
    writer.object("picture light", &panel(0.8, 0.06).plain(), strip, node);
    let canvas = writer.surface("canvas", [0.62, 0.3, 0.16], 0.0, 0.7);
    let node = json!({ "translation": [-0.6, 1.62, -0.5 * DEPTH + 0.03] });
    writer.object("canvas", &rounded_box([1.2, 0.8, 0.05], 0.01, 1).plain(), canvas, node);
}

/// Boards of browns that differ, with dark joints.
fn boards() -> RgbImage {
    RgbImage::from_fn(128, 128, |x, y| {
        let (board, across) = (y / 16, y % 16);
        let start = board * 53 % 128;
        let is_joint = across == 0 || (x + start) % 128 == 0;
        let tone = (board * 37 + (x + start) / 128 * 23) % 8;
        let grain = (x / 5 + y * 3) % 4;
        let level = if is_joint { 40 } else { 112 + 5 * tone + 3 * grain };
        Rgb([level, level * 3 / 4, level / 2].map(|value| value as u8))
    })
}
