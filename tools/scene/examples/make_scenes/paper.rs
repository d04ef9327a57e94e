//! A paper screen with a lamp behind it and a vase between the two, and leaves in the light of a window: thin
//! surfaces that let light through.

use crate::shapes::{cuboid, floor, panel, polygon, sphere, turned};
use crate::sweep::turn_around;
use crate::writer::{Shape, Writer, look_at};
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    let boards = writer.surface("boards", [0.16, 0.1, 0.06], 0.0, 0.35);
    writer.object("floor", &floor(16.0, 12.0, 1.0).plain(), boards, json!({}));
    screen(&mut writer);
    let glaze = writer.surface("glaze", [0.04, 0.12, 0.2], 0.0, 0.2);
    writer.object("vase", &vase(), glaze, json!({ "translation": [-0.55, 0.0, -0.35] }));
    let clay = writer.surface("clay", [0.5, 0.22, 0.14], 0.0, 0.6);
    writer.object("ball", &sphere(0.32, 48, 28).plain(), clay, json!({ "translation": [1.0, 0.32, 1.1] }));
    leaves(&mut writer);
    // A lamp behind the screen, a window behind the leaves, and a little light from the front
    let glow = writer.emitter("lamp", [28.0, 19.0, 10.0], false);
    let said = json!({ "arealight": { "shape": "sphere", "radius": 0.18 } });
    let node = json!({ "translation": [-0.15, 1.15, -1.7], "extras": said });
    writer.object("lamp", &sphere(0.18, 32, 18).plain(), glow, node);
    for (name, radiance, at, target) in [
        ("window", [3.5, 4.0, 5.0], [-4.2, 2.4, -1.8], [-1.5, 0.7, 0.6]),
        ("front", [0.6, 0.8, 1.1], [3.5, 3.2, 4.0], [0.0, 0.6, 0.0]),
    ] {
        let light = writer.emitter(name, radiance, false);
        let mut node = look_at(at, target);
        turn_around(&mut node);
        writer.object(name, &panel(2.0, 1.4).plain(), light, node);
    }
    writer.camera("front", [0.5, 1.5, 5.2], [0.1, 0.85, 0.0], 0.46, 16.0 / 9.0);
    writer.glb()
}

/// A material that lets light through.
fn thin(writer: &mut Writer, name: &str, color: [f32; 3], transmission: &Value) -> usize {
    writer.use_extension("KHR_materials_diffuse_transmission");
    let material = writer.surface(name, color, 0.0, 0.7);
    writer.root["materials"][material]["doubleSided"] = json!(true);
    writer.root["materials"][material]["extensions"] =
        json!({ "KHR_materials_diffuse_transmission": transmission });
    material
}

/// Two leaves of paper between laths.
fn screen(writer: &mut Writer) {
    let said =
        json!({ "diffuseTransmissionFactor": 0.55, "diffuseTransmissionColorFactor": [0.95, 0.88, 0.74] });
    let paper = thin(writer, "paper", [0.85, 0.82, 0.75], &said);
    let wood = writer.surface("lath", [0.06, 0.03, 0.02], 0.0, 0.4);
    for x in [-0.8, 0.8] {
        writer.object("paper", &panel(1.6, 1.76).plain(), paper, json!({ "translation": [x, 0.95, 0] }));
        for lath in [-0.78, -0.26, 0.26, 0.78] {
            let node = json!({ "translation": [x + lath, 0.95, 0.025] });
            writer.object("lath", &cuboid([0.035, 1.8, 0.035]).plain(), wood, node);
        }
    }
    for y in [0.08, 0.52, 0.95, 1.38, 1.82] {
        let node = json!({ "translation": [0, y, 0.025] });
        writer.object("lath", &cuboid([3.2, 0.035, 0.035]).plain(), wood, node);
    }
}

/// Leaves whose veins let less through than what is between them.
fn leaves(writer: &mut Writer) {
    let mut png = std::io::Cursor::new(Vec::new());
    veins().write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    let image = writer.texture("veins", png.get_ref());
    let said = json!({ "diffuseTransmissionFactor": 0.8, "diffuseTransmissionTexture": { "index": image },
        "diffuseTransmissionColorFactor": [0.6, 0.6, 0.6], "diffuseTransmissionColorTexture": { "index": image } });
    let leaf = thin(writer, "leaf", [0.08, 0.2, 0.03], &said);
    // Pointed at both ends
    let side = |i: u32| (f64::from(i) / 12.0, 0.2 * (std::f64::consts::PI * f64::from(i) / 12.0).sin());
    let right = (0..12).map(side).map(|(t, width)| [width, 0.7 * t - 0.35]);
    let left = (1..=12).rev().map(side).map(|(t, width)| [-width, 0.7 * t - 0.35]);
    let outline: Vec<[f64; 2]> = right.chain(left).collect();
    for (at, turn) in [([-1.75, 0.42, 0.75], 0.5), ([-1.25, 0.5, 0.8], -0.4), ([-1.5, 0.85, 0.7], 0.1)] {
        let lean = glam::DQuat::from_rotation_z(turn) * glam::DQuat::from_rotation_x(-0.2);
        let node = json!({ "translation": at, "rotation": lean.to_array() });
        writer.object("leaf", &polygon(&outline).with_image(), leaf, node);
    }
}

fn veins() -> RgbaImage {
    RgbaImage::from_fn(64, 64, |x, y| {
        let (across, along) = ((f64::from(x) - 31.5).abs() / 32.0, f64::from(y) / 64.0);
        let is_vein = across < 0.05 || (along * 7.0 + across * 2.5).fract() < 0.18;
        if is_vein { Rgba([110, 150, 60, 130]) } else { Rgba([130, 190, 60, 255]) }
    })
}

fn vase() -> Shape {
    let outline =
        [[0.16, 0.0], [0.27, 0.12], [0.3, 0.3], [0.24, 0.55], [0.12, 0.75], [0.11, 0.88], [0.15, 0.98]];
    turned(&outline, 48).plain()
}
