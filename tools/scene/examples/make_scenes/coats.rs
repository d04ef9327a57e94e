//! Spheres with a clear coat, and behind them the same without: metallic paint, plastic, hammered metal below
//! a smooth coat, and a coat that is uneven itself.

use crate::screen::texture;
use crate::shapes::{floor, panel, sphere};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Names, colours, metalness and roughness of what is below.
pub const BASES: [(&str, [f32; 3], f32, f32); 4] = [
    ("paint", [0.7, 0.03, 0.05], 1.0, 0.5),
    ("plastic", [0.03, 0.07, 0.2], 0.0, 0.6),
    ("hammered", [0.85, 0.6, 0.35], 1.0, 0.35),
    ("lacquer", [0.02, 0.18, 0.08], 0.0, 1.0),
];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    writer.use_extension("KHR_materials_clearcoat");
    let ground = writer.surface("floor", [0.2, 0.2, 0.2], 0.0, 0.6);
    writer.object("floor", &floor(40.0, 40.0, 1.0), ground, json!({}));
    let bumps = texture(&mut writer, "bumps", &bumps());
    let shape = writer.primitive(&sphere(0.9, 96, 48));
    for (column, (name, color, metalness, roughness)) in BASES.into_iter().enumerate() {
        for (row, coat) in [None, Some(coat(name, bumps))].into_iter().enumerate() {
            let name = format!("{name}{}", if coat.is_some() { ", coated" } else { "" });
            let material = writer.surface(&name, color, metalness, roughness);
            if name.starts_with("hammered") {
                writer.root["materials"][material]["normalTexture"] = json!({ "index": bumps });
            }
            if let Some(coat) = coat {
                writer.root["materials"][material]["extensions"] = json!({ "KHR_materials_clearcoat": coat });
            }
            let mesh = writer.mesh(&name, &shape, material);
            let (x, z) = (2.1 * (column as f64 - 1.5), 2.4 * (row as f64 - 0.5));
            writer.node(json!({ "name": name, "mesh": mesh, "translation": [x, 0.9, z] }));
        }
    }
    // Four strips above and behind the camera, whose reflections show the coats
    let lamp = writer.emitter("lamp", [9.0, 9.0, 9.0], false);
    for strip in 0..4 {
        let mut node = look_at([0.0, 5.5, 4.5 - 2.2 * f64::from(strip)], [0.0, 0.6, 0.0]);
        turn_around(&mut node);
        writer.object(&format!("strip {strip}"), &panel(8.0, 0.5), lamp, node);
    }
    writer.camera("front", [0.0, 5.6, 10.5], [0.0, 0.6, 0.0], 0.44, 16.0 / 9.0);
    writer.glb()
}

/// `KHR_materials_clearcoat` of what lies on a base.
fn coat(base: &str, bumps: usize) -> Value {
    let roughness = if base == "plastic" { 0.25 } else { 0.06 };
    let mut coat = json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": roughness });
    if base == "lacquer" {
        coat["clearcoatNormalTexture"] = json!({ "index": bumps, "scale": 0.4 });
    }
    coat
}

/// A normal map of rows of round bumps.
fn bumps() -> RgbImage {
    const SIZE: [u32; 2] = [256, 128];
    const COUNT: [f64; 2] = [16.0, 8.0];
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let [u, v] = [(x, 0), (y, 1)]
            .map(|(place, axis)| (f64::from(place) + 0.5) / f64::from(SIZE[axis]) * COUNT[axis] * TAU);
        let slope = glam::DVec3::new(-0.35 * u.cos() * v.sin(), 0.35 * u.sin() * v.cos(), 1.0);
        Rgb(slope.normalize_or(glam::DVec3::Z).to_array().map(|c| (127.5 + 127.5 * c).round() as u8))
    })
}
