//! Spheres of cloth, in two rows: below without sheen, above with it, from satin to velvet; one's colour and
//! one's roughness are textures.

use crate::shapes::{floor, panel, sphere};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};

/// Names, base colours, sheen colours and sheen roughness.
pub const CLOTHS: [(&str, [f32; 3], [f32; 3], f32); 4] = [
    ("satin", [0.35, 0.04, 0.05], [0.8, 0.5, 0.5], 0.3),
    ("velvet", [0.02, 0.03, 0.15], [0.5, 0.6, 1.0], 0.6),
    ("striped", [0.05, 0.05, 0.05], [1.0, 1.0, 1.0], 0.5),
    ("brushed", [0.05, 0.2, 0.08], [0.9, 0.9, 0.6], 1.0),
];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    writer.use_extension("KHR_materials_sheen");
    let ground = writer.surface("floor", [0.2, 0.2, 0.2], 0.0, 0.6);
    writer.object("floor", &floor(40.0, 40.0, 1.0), ground, json!({}));
    let stripes = texture(&mut writer, "stripes", &stripes());
    let shape = writer.primitive(&sphere(0.9, 96, 48));
    for (column, cloth) in CLOTHS.into_iter().enumerate() {
        let (name, color, ..) = cloth;
        for (row, sheen) in [None, Some(sheen(cloth, stripes))].into_iter().enumerate() {
            let name = format!("{name}{}", if sheen.is_some() { ", sheen" } else { "" });
            let material = writer.surface(&name, color, 0.0, 0.8);
            if let Some(sheen) = sheen {
                writer.root["materials"][material]["extensions"] = json!({ "KHR_materials_sheen": sheen });
            }
            let mesh = writer.mesh(&name, &shape, material);
            let (x, z) = (2.1 * (column as f64 - 1.5), 2.4 * (row as f64 - 0.5));
            writer.node(json!({ "name": name, "mesh": mesh, "translation": [x, 0.9, z] }));
        }
    }
    // One lamp above and behind the camera, one behind the spheres, whose light grazes them
    let lamp = writer.emitter("lamp", [24.0, 24.0, 24.0], false);
    for (name, at) in [("key", [-3.0, 5.5, 5.0]), ("rim", [2.0, 3.0, -5.0])] {
        let mut node = look_at(at, [0.0, 0.8, 0.0]);
        turn_around(&mut node);
        writer.object(name, &panel(3.0, 1.5), lamp, node);
    }
    writer.camera("front", [0.0, 5.6, 10.5], [0.0, 0.6, 0.0], 0.44, 16.0 / 9.0);
    writer.glb()
}

/// `KHR_materials_sheen` of a cloth.
fn sheen((name, _, color, roughness): (&str, [f32; 3], [f32; 3], f32), stripes: usize) -> Value {
    let mut sheen = json!({ "sheenColorFactor": color, "sheenRoughnessFactor": roughness });
    match name {
        "striped" => sheen["sheenColorTexture"] = json!({ "index": stripes }),
        "brushed" => sheen["sheenRoughnessTexture"] = json!({ "index": stripes }),
        _ => {}
    }
    sheen
}

/// Stripes of colours, and of roughness in alpha.
fn stripes() -> RgbaImage {
    RgbaImage::from_fn(64, 8, |x, _| match x / 8 % 4 {
        0 => Rgba([230, 40, 40, 255]),
        1 => Rgba([0, 0, 0, 64]),
        2 => Rgba([240, 220, 120, 160]),
        _ => Rgba([60, 90, 230, 110]),
    })
}

fn texture(writer: &mut Writer, name: &str, image: &RgbaImage) -> usize {
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    writer.texture(name, png.get_ref())
}
