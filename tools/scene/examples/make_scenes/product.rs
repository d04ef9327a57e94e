//! A product on a table: a bottle of lacquer, a tin of brushed metal and a box, under a softbox that fades
//! and two strips.

use crate::screen::texture;
use crate::shapes::{backdrop, panel, rounded_box, turned};
use crate::sweep::turn_around;
use crate::writer::{Shape, Writer, look_at};
use image::{Rgb, RgbImage};
use serde_json::json;
use std::f64::consts::FRAC_PI_2;

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    for extension in ["anisotropy", "clearcoat"] {
        writer.use_extension(&format!("KHR_materials_{extension}"));
    }
    let slate = writer.surface("slate", [0.09, 0.095, 0.1], 0.0, 0.3);
    writer.object("table", &backdrop([6.0, 4.0, 3.0], 0.8).plain(), slate, json!({}));
    bottle(&mut writer);
    tin(&mut writer);
    let card = writer.surface("card", [0.72, 0.66, 0.56], 0.0, 0.6);
    let node = json!({ "translation": [-0.5, 0.2, -0.12], "rotation": [0, 0.21644, 0, 0.9763] });
    writer.object("box", &rounded_box([0.3, 0.4, 0.3], 0.012, 2).plain(), card, node);
    lights(&mut writer);
    writer.camera("table", [0.0, 0.58, 2.3], [-0.01, 0.31, 0.0], 0.4, 16.0 / 9.0);
    writer.glb()
}

fn bottle(writer: &mut Writer) {
    let lacquer = writer.surface("red lacquer", [0.45, 0.02, 0.025], 0.2, 0.5);
    writer.root["materials"][lacquer]["extensions"] =
        json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.06 } });
    let outline = [
        [0.0, 0.0],
        [0.12, 0.0],
        [0.135, 0.006],
        [0.14, 0.02],
        [0.14, 0.3],
        [0.138, 0.34],
        [0.125, 0.38],
        [0.1, 0.415],
        [0.07, 0.445],
        [0.05, 0.475],
        [0.044, 0.51],
        [0.044, 0.56],
    ];
    writer.object("bottle", &turned(&outline, 72).plain(), lacquer, json!({}));
    let gold = writer.surface("gold cap", [1.0, 0.78, 0.42], 1.0, 0.16);
    let outline = [
        [0.05, 0.0],
        [0.052, 0.003],
        [0.052, 0.07],
        [0.05, 0.076],
        [0.046, 0.078],
        [0.046, 0.078],
        [0.0, 0.078],
    ];
    writer.object("cap", &turned(&outline, 48).plain(), gold, json!({ "translation": [0, 0.53, 0] }));
}

fn tin(writer: &mut Writer) {
    let steel = writer.surface("brushed steel", [0.62, 0.62, 0.64], 1.0, 0.32);
    writer.root["materials"][steel]["extensions"] = json!({ "KHR_materials_anisotropy": {
        "anisotropyStrength": 0.7, "anisotropyRotation": FRAC_PI_2 } });
    let outline = [
        [0.0, 0.0],
        [0.15, 0.0],
        [0.16, 0.008],
        [0.16, 0.2],
        [0.165, 0.205],
        [0.165, 0.235],
        [0.158, 0.243],
        [0.158, 0.243],
        [0.0, 0.246],
    ];
    // Texture coordinates run around the tin, as its brushing does: highlights are long across it
    let shape: Shape = turned(&outline, 72);
    writer.object("tin", &shape, steel, json!({ "translation": [0.46, 0, 0.08] }));
}

fn lights(writer: &mut Writer) {
    let fading = texture(writer, "fading softbox", &fading());
    let mut light = |name: &str, at: [f64; 3], size: [f64; 2], radiance: [f32; 3], image: Option<usize>| {
        let material = match image {
            Some(image) => writer.emitter_of_image(name, radiance, image, false),
            None => writer.emitter(name, radiance, false),
        };
        let shape = panel(size[0], size[1]);
        let shape = if image.is_some() { shape.with_image() } else { shape.plain() };
        let mut node = look_at(at, [0.0, 0.25, 0.0]);
        turn_around(&mut node);
        writer.object(name, &shape, material, node);
    };
    light("softbox", [-0.2, 2.1, 0.5], [1.6, 1.2], [6.0, 6.0, 6.0], Some(fading));
    light("left strip", [-1.5, 0.7, 0.9], [0.5, 1.3], [5.0, 5.4, 6.0], None);
    light("right strip", [1.6, 0.8, 0.9], [0.35, 1.2], [7.0, 6.2, 5.2], None);
}

/// Bright in the middle, dark at the edge: what a softbox shows of its bulb.
fn fading() -> RgbImage {
    RgbImage::from_fn(64, 64, |x, y| {
        let away = |i: u32| (f64::from(i) + 0.5) / 32.0 - 1.0;
        let (u, v) = (away(x), away(y));
        let level = (255.0 * (1.0 - 0.75 * (u * u + v * v).min(1.0)).powf(0.6)).round() as u8;
        Rgb([level; 3])
    })
}
