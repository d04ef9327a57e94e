//! Neon letters and an arrow on a wall above a wet street: each stroke is a tube with round ends.

use crate::shapes::{capsule, cuboid, floor, panel, sphere};
use crate::writer::Writer;
use glam::{DQuat, DVec2, DVec3};
use image::{Rgb, RgbImage};
use serde_json::json;

/// The tubes' radius.
const RADIUS: f64 = 0.035;

/// From the wall to the middle of the tubes.
const OFF: f64 = 0.14;

/// Strokes of the word, each from one point to the other: letters are 0.7 wide and 1 high, 1 apart.
pub const STROKES: [[[f64; 2]; 2]; 15] = [
    // O
    [[0.0, 0.15], [0.0, 0.85]],
    [[0.12, 1.0], [0.53, 1.0]],
    [[0.65, 0.85], [0.65, 0.15]],
    [[0.53, 0.0], [0.12, 0.0]],
    // P
    [[1.0, 0.0], [1.0, 1.0]],
    [[1.12, 1.0], [1.5, 1.0]],
    [[1.6, 0.88], [1.6, 0.6]],
    [[1.5, 0.48], [1.12, 0.48]],
    // E
    [[2.0, 0.0], [2.0, 1.0]],
    [[2.12, 1.0], [2.6, 1.0]],
    [[2.12, 0.5], [2.5, 0.5]],
    [[2.12, 0.0], [2.6, 0.0]],
    // N
    [[3.0, 0.0], [3.0, 1.0]],
    [[3.08, 0.95], [3.57, 0.05]],
    [[3.65, 0.0], [3.65, 1.0]],
];

/// An arrow towards the door.
pub const ARROW: [[[f64; 2]; 2]; 3] =
    [[[0.0, -0.5], [3.5, -0.5]], [[3.65, -0.5], [3.3, -0.28]], [[3.65, -0.5], [3.3, -0.72]]];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    let bricks_image = writer.tiles("bricks", &bricks());
    let bricks = writer.surface("bricks", [1.0, 1.0, 1.0], 0.0, 0.8);
    writer.root["materials"][bricks]["pbrMetallicRoughness"]["baseColorTexture"] =
        json!({ "index": bricks_image });
    let mut wall = panel(12.0, 4.4);
    for uv in &mut wall.uvs {
        *uv = uv.map(|x| x / 1.1);
    }
    writer.object("wall", &wall, bricks, json!({ "translation": [0, 2.2, 0] }));
    street(&mut writer);
    sign(&mut writer, "letter", &STROKES, [16.0, 1.6, 3.4]);
    sign(&mut writer, "arrow", &ARROW, [1.2, 7.0, 15.0]);
    writer.camera("street", [-0.9, 1.1, 6.4], [0.1, 0.35, 0.0], 0.84, 16.0 / 9.0);
    writer.glb()
}

fn street(writer: &mut Writer) {
    let wetness = writer.tiles("puddles", &puddles());
    let asphalt = writer.surface("wet asphalt", [0.05, 0.052, 0.056], 0.0, 1.0);
    writer.root["materials"][asphalt]["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
        json!({ "index": wetness });
    writer.object("street", &floor(12.0, 12.0, 4.0), asphalt, json!({ "translation": [0, 0, 6.0] }));
    let steel = writer.surface("steel", [0.55, 0.55, 0.57], 1.0, 0.35);
    writer.object(
        "bin",
        &cuboid([0.6, 0.95, 0.5]).plain(),
        steel,
        json!({ "translation": [-2.6, 0.475, 0.6] }),
    );
    let rubber = writer.surface("rubber", [0.3, 0.3, 0.32], 0.0, 0.4);
    writer.object("ball", &sphere(0.3, 40, 24).plain(), rubber, json!({ "translation": [1.9, 0.3, 1.1] }));
}

fn sign(writer: &mut Writer, name: &str, strokes: &[[[f64; 2]; 2]], radiance: [f32; 3]) {
    let gas = writer.emitter(name, radiance, false);
    for [from, to] in strokes {
        let [from, to] = [from, to].map(|point| DVec2::from(*point) + DVec2::new(-1.82, 1.85));
        let along = to - from;
        let height = along.length();
        let turn = DQuat::from_rotation_arc(DVec3::Y, (along / height).extend(0.0));
        let round = |x: f64| (x * 1e6).round() / 1e6;
        let middle = ((from + to) * 0.5).extend(OFF).to_array().map(round);
        let node = json!({
            "translation": middle,
            "rotation": turn.to_array().map(round),
            "extras": { "arealight": { "shape": "capsule", "radius": RADIUS, "height": round(height) } },
        });
        writer.object(name, &capsule(RADIUS, height, 16, 4).plain(), gas, node);
    }
}

/// Rows of bricks with joints of mortar.
fn bricks() -> RgbImage {
    RgbImage::from_fn(128, 128, |x, y| {
        let row = y / 16;
        let x = (x + row % 2 * 21) % 128;
        if y % 16 < 2 || x % 42 < 2 {
            return Rgb([96, 92, 88]);
        }
        let tone = (row * 29 + x / 42 * 17) % 7 * 6;
        Rgb([138 + tone, 84 + tone / 2, 66 + tone / 2].map(|value| value as u8))
    })
}

/// Roughness in green: smooth puddles on rough asphalt.
fn puddles() -> RgbImage {
    const CENTERS: [[f64; 3]; 6] = [
        [0.2, 0.2, 0.27],
        [0.7, 0.35, 0.3],
        [0.45, 0.75, 0.33],
        [0.95, 0.8, 0.26],
        [0.1, 0.6, 0.2],
        [0.6, 0.05, 0.2],
    ];
    RgbImage::from_fn(96, 96, |x, y| {
        let at = DVec2::new(f64::from(x), f64::from(y)) / 96.0;
        let wetness = CENTERS.iter().map(|[u, v, radius]| {
            let away = (at - DVec2::new(*u, *v)).abs();
            let away = away.min(1.0 - away).length() / radius;
            1.0 - away * away
        });
        let wet = (wetness.fold(-1.0, f64::max) * 3.0 + 0.5).clamp(0.0, 1.0);
        Rgb([0, (115.0 - 78.0 * wet).round() as u8, 0])
    })
}
