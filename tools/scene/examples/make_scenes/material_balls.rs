//! A ball of each material that is supported, in four rows: what every surface has, layers, lobes of two
//! roughnesses, and thin films.

use crate::screen::texture;
use crate::shapes::{floor, panel, sphere};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// A ball: its name, base colour, metalness, roughness and extensions.
pub struct Ball {
    pub name: &'static str,
    pub color: [f32; 3],
    pub metalness: f32,
    pub roughness: f32,
    extensions: Value,
}

fn ball(name: &'static str, color: [f32; 3], metalness: f32, roughness: f32, extensions: Value) -> Ball {
    Ball { name, color, metalness, roughness, extensions }
}

/// The rows from the camera on. `spin` is a texture of directions about a ball's poles.
pub fn rows(spin: usize) -> [[Ball; 4]; 4] {
    let coat = |roughness: f32| json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": roughness });
    let sheen = json!({ "sheenColorFactor": [0.6, 0.6, 0.9], "sheenRoughnessFactor": 0.5 });
    let anisotropy = |strength: f64, rotation: f64| json!({ "anisotropyStrength": strength, "anisotropyRotation": rotation });
    let film = |ior: f64, thickness: f64| json!({ "iridescenceFactor": 1.0, "iridescenceIor": ior, "iridescenceThicknessMaximum": thickness });
    let spun = json!({ "anisotropyStrength": 0.8, "anisotropyTexture": { "index": spin } });
    let (gold, steel) = ([0.95, 0.7, 0.3], [0.6, 0.6, 0.62]);
    [
        [
            ball("plaster", [0.7, 0.68, 0.65], 0.0, 0.9, json!({})),
            ball("plastic", [0.05, 0.25, 0.5], 0.0, 0.35, json!({})),
            ball("gold", gold, 1.0, 0.25, json!({})),
            ball("rough steel", steel, 1.0, 0.6, json!({})),
        ],
        [
            ball(
                "coated paint",
                [0.6, 0.03, 0.04],
                0.6,
                0.5,
                json!({ "KHR_materials_clearcoat": coat(0.05) }),
            ),
            ball("satin coat", [0.03, 0.2, 0.08], 0.0, 0.8, json!({ "KHR_materials_clearcoat": coat(0.3) })),
            ball("velvet", [0.03, 0.02, 0.12], 0.0, 0.8, json!({ "KHR_materials_sheen": sheen })),
            ball(
                "coated cloth",
                [0.12, 0.05, 0.03],
                0.0,
                0.8,
                json!({ "KHR_materials_sheen": sheen, "KHR_materials_clearcoat": coat(0.15) }),
            ),
        ],
        [
            ball(
                "brushed along",
                steel,
                1.0,
                0.3,
                json!({ "KHR_materials_anisotropy": anisotropy(0.6, 0.0) }),
            ),
            ball(
                "brushed across",
                gold,
                1.0,
                0.3,
                json!({ "KHR_materials_anisotropy": anisotropy(0.6, TAU / 4.0) }),
            ),
            ball("spun", steel, 1.0, 0.35, json!({ "KHR_materials_anisotropy": spun })),
            ball(
                "satin",
                [0.5, 0.1, 0.2],
                0.0,
                0.3,
                json!({ "KHR_materials_anisotropy": anisotropy(0.7, 0.6) }),
            ),
        ],
        [
            ball(
                "oil",
                [0.02, 0.02, 0.02],
                0.0,
                0.15,
                json!({ "KHR_materials_iridescence": film(1.5, 480.0) }),
            ),
            ball("titanium", steel, 1.0, 0.3, json!({ "KHR_materials_iridescence": film(2.2, 210.0) })),
            ball(
                "nacre",
                [0.7, 0.66, 0.62],
                0.0,
                0.45,
                json!({ "KHR_materials_iridescence": film(1.6, 550.0) }),
            ),
            ball(
                "beetle",
                [0.1, 0.3, 0.15],
                1.0,
                0.5,
                json!({
                    "KHR_materials_iridescence": film(1.7, 320.0),
                    "KHR_materials_clearcoat": coat(0.1),
                }),
            ),
        ],
    ]
}

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    for extension in ["anisotropy", "clearcoat", "iridescence", "sheen"] {
        writer.use_extension(&format!("KHR_materials_{extension}"));
    }
    let ground = writer.surface("floor", [0.2, 0.2, 0.2], 0.0, 0.6);
    writer.object("floor", &floor(40.0, 40.0, 1.0), ground, json!({}));
    let spin = texture(&mut writer, "spin", &spin());
    let shape = writer.primitive(&sphere(0.9, 96, 48));
    for (row, balls) in rows(spin).into_iter().enumerate() {
        for (column, Ball { name, color, metalness, roughness, extensions }) in balls.into_iter().enumerate()
        {
            let material = writer.surface(name, color, metalness, roughness);
            writer.root["materials"][material]["extensions"] = extensions;
            let mesh = writer.mesh(name, &shape, material);
            let (x, z) = (2.1 * (column as f64 - 1.5), 2.6 * (1.5 - row as f64));
            writer.node(json!({ "name": name, "mesh": mesh, "translation": [x, 0.9, z] }));
        }
    }
    // Softboxes, as a photographer has them: above and behind the camera, at the side, and behind the balls
    let lamp = writer.emitter("lamp", [4.0, 4.0, 4.0], false);
    for (name, at, size) in [
        ("key", [-4.5, 7.0, 5.0], [5.0, 4.0]),
        ("side", [9.0, 4.0, 1.0], [3.0, 5.0]),
        ("rim", [0.0, 7.0, -8.0], [9.0, 3.0]),
    ] {
        let mut node = look_at(at, [0.0, 0.8, 0.0]);
        turn_around(&mut node);
        writer.object(name, &panel(size[0], size[1]), lamp, node);
    }
    writer.camera("front", [0.0, 9.8, 11.4], [0.0, 0.6, 0.1], 0.5, 16.0 / 9.0);
    writer.glb()
}

/// Directions that turn once as u goes around, and a strength that is less at the poles.
fn spin() -> RgbImage {
    RgbImage::from_fn(64, 32, |x, y| {
        let angle = TAU * (f64::from(x) + 0.5) / 64.0;
        let from_pole = ((f64::from(y) + 0.5) / 32.0 * TAU / 2.0).sin();
        let byte = |value: f64| (127.5 + 127.5 * value).round() as u8;
        Rgb([byte(angle.cos()), byte(angle.sin()), (255.0 * from_pole) as u8])
    })
}
