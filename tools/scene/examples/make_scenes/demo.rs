//! The scene that shows it all in one picture: a dark studio, a floor of tiles worn to different degrees, a
//! neon sign of concave letters, soft boxes, metals and dielectrics.

use crate::shapes::{floor, panel, plate, polygon, rounded_box, sphere, torus_knot};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use serde_json::{Value, json};

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    ground(&mut writer);
    objects(&mut writer);
    sign(&mut writer);
    soft_boxes(&mut writer);
    writer.camera("hero", [0.15, 1.4, 7.4], [0.0, 0.95, 0.0], 0.56, 16.0 / 9.0);
    writer.glb()
}

/// Texels of a side of the floor's texture, and tiles of a side.
const TEXELS: u32 = 256;
const TILES: u32 = 4;

/// A dark floor whose roughness varies: polished tiles among worn ones, brushed one way or the other, with
/// rough joints.
fn ground(writer: &mut Writer) {
    let mut pixels = image::RgbImage::new(TEXELS, TEXELS);
    for (x, y, pixel) in pixels.enumerate_pixels_mut() {
        *pixel = image::Rgb([255, roughness(x, y), 0]);
    }
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    let texture = writer.texture("worn tiles", png.get_ref());
    let material = writer.push(
        "materials",
        json!({ "name": "worn tiles",
                "pbrMetallicRoughness": { "baseColorFactor": [0.035, 0.036, 0.042, 1], "metallicFactor": 0,
                    "metallicRoughnessTexture": { "index": texture } } }),
    );
    writer.object("floor", &floor(36.0, 36.0, 4.8), material, json!({}));
}

fn roughness(x: u32, y: u32) -> u8 {
    let size = TEXELS / TILES;
    let (column, row) = (x / size, y / size);
    let tile = hash(column, row, 7);
    // How worn the tile is as a whole
    let worn = 0.08 + 0.34 * f64::from(tile % 997) / 996.0;
    // Wear in soft spots, and brush marks along or across
    let spots = smooth_noise(x, y, 32, 11) * 0.6 + smooth_noise(x, y, 8, 12) * 0.4;
    let along = if tile & 1 == 0 { smooth_noise(x, y * 16, 64, 13) } else { smooth_noise(x * 16, y, 64, 14) };
    let value = worn + 0.16 * (spots - 0.5) + 0.06 * (along - 0.5);
    let joint = x.is_multiple_of(size) || y.is_multiple_of(size);
    let value = if joint { 0.8 } else { value.clamp(0.045, 0.7) };
    // Quantised: it compresses better, and nobody sees it
    ((value * 85.0).round() * 3.0) as u8
}

/// Integer hash of a lattice point.
fn hash(x: u32, y: u32, seed: u32) -> u32 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ h >> 15).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ h >> 12).wrapping_mul(0x297A_2D39);
    h ^ h >> 15
}

/// Value noise in [0, 1] with a lattice of `cell` texels that repeats with the texture.
fn smooth_noise(x: u32, y: u32, cell: u32, seed: u32) -> f64 {
    let (column, row) = (x / cell, y / cell);
    let fade = |t: f64| t * t * (3.0 - 2.0 * t);
    let (s, t) = (fade(f64::from(x % cell) / f64::from(cell)), fade(f64::from(y % cell) / f64::from(cell)));
    let wrap = TEXELS / cell.min(TEXELS);
    let value = |c: u32, r: u32| {
        // The stretched axis of brush marks does not repeat; it is random anyway
        let (c, r) = if x < TEXELS && y < TEXELS { (c % wrap, r % wrap) } else { (c, r) };
        f64::from(hash(c, r, seed)) / f64::from(u32::MAX)
    };
    let lower = value(column, row) * (1.0 - s) + value(column + 1, row) * s;
    let upper = value(column, row + 1) * (1.0 - s) + value(column + 1, row + 1) * s;
    lower * (1.0 - t) + upper * t
}

fn objects(writer: &mut Writer) {
    // On the left a golden knot hovers above a black plinth
    let plinth = writer.surface("plinth", [0.02, 0.02, 0.022], 0.0, 0.12);
    let shape = plate(0.9, 0.2, 0.05, 72).plain();
    writer.object("plinth", &shape, plinth, json!({ "translation": [-2.4, 0, 0.1] }));
    let gold = writer.surface("gold", [1.0, 0.72, 0.3], 1.0, 0.22);
    let shape = torus_knot(2.0, 3.0, 0.72, 0.155, 160, 16).plain();
    let node = json!({ "translation": [-2.4, 1.2, 0.1], "rotation": [0, 0.17365, 0, 0.98481] });
    writer.object("knot", &shape, gold, node);
    // On the right a satin block
    let satin = writer.surface("blue satin", [0.25, 0.42, 0.85], 1.0, 0.36);
    let shape = rounded_box([0.95, 1.35, 0.95], 0.12, 5).plain();
    let node = json!({ "translation": [2.45, 0.72, -0.35], "rotation": [0, -0.13917, 0, 0.99027] });
    writer.object("block", &shape, satin, node);
    // Balls of one shape: a glaze with an index of refraction above glass, chrome, chalk
    writer.use_extension("KHR_materials_ior");
    let glaze = writer.push(
        "materials",
        json!({ "name": "red glaze",
                "pbrMetallicRoughness": { "baseColorFactor": [0.55, 0.015, 0.02, 1], "metallicFactor": 0,
                    "roughnessFactor": 0.1 },
                "extensions": { "KHR_materials_ior": { "ior": 1.7 } } }),
    );
    let chrome = writer.surface("chrome", [0.9, 0.9, 0.92], 1.0, 0.06);
    let chalk = writer.surface("chalk", [0.75, 0.74, 0.7], 0.0, 0.95);
    let shape = writer.primitive(&sphere(1.0, 56, 34).plain());
    let balls = [
        ("glazed ball", glaze, 0.46, [1.62, 0.5, 1.15]),
        ("chrome ball", chrome, 0.2, [-0.98, 0.22, 1.9]),
        ("chalk ball", chalk, 0.2, [0.86, 0.22, 2.05]),
    ];
    for (name, material, radius, place) in balls {
        let mesh = writer.mesh(name, &shape, material);
        let scale = [radius, radius, radius];
        writer.node(json!({ "name": name, "mesh": mesh, "translation": place, "scale": scale }));
    }
}

/// L, T and C of concave outlines, above the floor at the back.
fn sign(writer: &mut Writer) {
    let l = [[0.0, 0.0], [0.95, 0.0], [0.95, 0.3], [0.3, 0.3], [0.3, 1.5], [0.0, 1.5]];
    let t = [[0.4, 0.0], [0.7, 0.0], [0.7, 1.2], [1.1, 1.2], [1.1, 1.5], [0.0, 1.5], [0.0, 1.2], [0.4, 1.2]];
    let mut letter = |name: &str, outline: &[[f64; 2]], x: f64, radiance: [f32; 3]| {
        let neon = writer.emitter(name, radiance, true);
        writer.object(name, &polygon(outline), neon, json!({ "translation": [x, 0.8, -2.6] }));
    };
    letter("letter L", &l, -1.95, [4.2, 0.5, 0.12]);
    letter("letter T", &t, -0.55, [3.2, 2.8, 2.3]);
    letter("letter C", &letter_c(), 0.9, [0.12, 0.95, 4.6]);
}

/// A round C: an arc of 270 degrees, as high as the other letters.
fn letter_c() -> Vec<[f64; 2]> {
    let steps = 20;
    let on_arc = |radius: f64, i: i32| {
        let (sin, cos) = (45.0 + 270.0 * f64::from(i) / f64::from(steps)).to_radians().sin_cos();
        [0.7 + radius * cos, 0.75 + radius * sin]
    };
    let outer = (0..=steps).map(|i| on_arc(0.75, i));
    outer.chain((0..=steps).rev().map(|i| on_arc(0.45, i))).collect()
}

fn soft_boxes(writer: &mut Writer) {
    // Strips at both sides, in view
    let mut strip = |name: &str, eye: [f64; 3], target: [f64; 3], size: [f64; 2], radiance: [f32; 3]| {
        let mut node = look_at(eye, target);
        turn_around(&mut node);
        let material = writer.emitter(name, radiance, false);
        writer.object(name, &panel(size[0], size[1]), material, node);
    };
    strip("cool strip", [-4.2, 1.65, -1.6], [-0.6, 1.2, 0.6], [0.4, 2.9], [1.2, 2.0, 3.6]);
    strip("warm strip", [4.2, 1.65, -1.6], [0.6, 1.2, 0.6], [0.4, 2.9], [3.8, 2.0, 0.95]);
    // Key and fill are out of view: they have no geometry, so they are area lights of the extension
    writer.use_extension("EXT_lights_area");
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [
        { "name": "key", "type": "rect", "color": [1.0, 0.95, 0.88], "intensity": 3400, "size": 1.8,
          "rect": { "aspect": 2.4 } },
        { "name": "fill", "type": "rect", "color": [0.82, 0.9, 1.0], "intensity": 800, "size": 3.2,
          "rect": { "aspect": 1.8 } }
    ] } });
    let places = [("key", [-0.8, 4.8, 1.6], [0.0, 0.7, 0.2]), ("fill", [2.5, 4.2, 7.5], [0.0, 0.8, 0.0])];
    for (light, (name, eye, target)) in places.into_iter().enumerate() {
        let mut node: Value = look_at(eye, target);
        node["name"] = json!(name);
        node["extensions"] = json!({ "EXT_lights_area": { "light": light } });
        writer.node(node);
    }
}
