//! A television at the back of a floor that is a mirror on the left and rough on the right, a sign that shows
//! its image on both sides, and a lamp without one.

use crate::shapes::{floor, panel, polygon, rounded_box, sphere};
use crate::test_card;
use crate::writer::{Writer, look_at};
use image::{Rgb, RgbImage};
use serde_json::json;
use std::f64::consts::FRAC_1_SQRT_2;

/// Width and depth of the floor.
const FLOOR: [f64; 2] = [7.0, 6.0];

/// Width, height and height above the floor of the television's picture.
const SCREEN: [f64; 3] = [3.84, 2.16, 0.1];

/// The floor's roughness below the left and the right end of the television; beyond it is the same.
pub const ROUGHNESS: [f64; 2] = [0.03, 0.85];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    ground(&mut writer);
    television(&mut writer);
    sign(&mut writer);
    lamp(&mut writer);
    // White to its right, and in front of it
    let chalk = writer.surface("chalk", [0.8, 0.8, 0.8], 0.0, 0.9);
    let node =
        json!({ "translation": [FLOOR[0] * 0.5, 1.1, 0], "rotation": [0, -FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2] });
    writer.object("wall", &panel(FLOOR[1], 2.2), chalk, node);
    let ball = sphere(0.3, 48, 28).plain();
    writer.object("ball", &ball, chalk, json!({ "translation": [-2.55, 0.3, -1.55] }));
    writer.camera("seat", [-0.3, 2.0, 6.4], [0.05, 0.55, -1.0], 0.56, 16.0 / 9.0);
    writer.glb()
}

/// A dark metal floor whose roughness rises from the left to the right, without steps and slowly at first.
pub fn ground(writer: &mut Writer) {
    let ramp = RgbImage::from_fn(64, 1, |x, _| {
        let share = (f64::from(x) + 0.5) / 64.0;
        let roughness = ROUGHNESS[0] + (ROUGHNESS[1] - ROUGHNESS[0]) * share * share;
        Rgb([255, (roughness * 255.0).round() as u8, 255])
    });
    let ramp = texture(writer, "roughness", &ramp);
    let material = writer.push(
        "materials",
        json!({ "name": "swept floor",
                "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.6, 0.62, 1], "metallicFactor": 0.8,
                    "metallicRoughnessTexture": { "index": ramp } } }),
    );
    let mut shape = floor(FLOOR[0], FLOOR[1], 1.0);
    for (uv, position) in shape.uvs.iter_mut().zip(&shape.positions) {
        *uv = [position[0] / SCREEN[0] as f32 + 0.5, 0.5];
    }
    writer.object("floor", &shape, material, json!({}));
}

fn television(writer: &mut Writer) {
    let [width, height, bottom] = SCREEN;
    let card = texture(writer, "test card", &test_card::card());
    let material = writer.emitter_of_image("test card", [1.6, 1.6, 1.6], card, false);
    let z = -FLOOR[1] * 0.5 + 0.25;
    let node = json!({ "translation": [0, bottom + height * 0.5, z] });
    writer.object("television", &panel(width, height).with_image(), material, node);
    let plastic = writer.surface("case", [0.02, 0.02, 0.022], 0.0, 0.3);
    let case = rounded_box([width + 0.12, height + 0.12, 0.1], 0.03, 3).plain();
    let node = json!({ "translation": [0, bottom + height * 0.5, z - 0.06] });
    writer.object("case", &case, plastic, node);
}

/// An arrow that hangs free; its back shows it mirrored.
fn sign(writer: &mut Writer) {
    let image = texture(writer, "sign", &test_card::sign());
    let material = writer.emitter_of_image("sign", [2.5, 2.5, 2.5], image, true);
    let outline = [[-0.6, -0.3], [0.3, -0.3], [0.6, 0.0], [0.3, 0.3], [-0.6, 0.3]];
    let shape = polygon(&outline).with_image();
    let node = json!({ "translation": [2.3, 0.95, 0.4], "rotation": [0, -0.300_706, 0, 0.953_717] });
    writer.object("sign", &shape, material, node);
}

fn lamp(writer: &mut Writer) {
    let material = writer.emitter("lamp", [4.2, 2.5, 1.1], false);
    let mut node = look_at([-3.1, 1.0, -0.6], [0.2, 0.6, 1.2]);
    crate::sweep::turn_around(&mut node);
    writer.object("lamp", &panel(0.35, 1.5), material, node);
}

/// A texture that does not repeat.
pub fn texture(writer: &mut Writer, name: &str, image: &RgbImage) -> usize {
    let texture = writer.tiles(name, image);
    let sampler = writer.push("samplers", json!({ "wrapS": 33071, "wrapT": 33071 }));
    writer.root["textures"][texture]["sampler"] = json!(sampler);
    texture
}
