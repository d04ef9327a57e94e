//! Disks, spheres and tubes of every kind about a floor of four roughnesses: each lamp's mesh says what it
//! stands for.

use crate::shapes::{capsule, cylinder, disk, floor, panel, rounded_box, sphere};
use crate::writer::{Shape, Writer, look_at};
use serde_json::{Value, json};

/// The roughness of the floor's strips, from the left to the right.
pub const ROUGHNESS: [f64; 4] = [0.08, 0.2, 0.35, 0.6];

/// Width of a strip, and depth of all.
const STRIP: [f64; 2] = [2.4, 9.0];

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    ground(&mut writer);
    objects(&mut writer);
    lamps(&mut writer);
    key(&mut writer);
    writer.camera("front", [0.11, 2.5, 7.6], [0.05, 0.75, -0.4], 0.62, 16.0 / 9.0);
    writer.glb()
}

/// Dark strips of varnish, and a wall of plaster behind them.
fn ground(writer: &mut Writer) {
    for (strip, roughness) in ROUGHNESS.into_iter().enumerate() {
        let name = format!("varnish {roughness}");
        let material = writer.surface(&name, [0.06, 0.06, 0.065], 0.0, roughness as f32);
        let x = STRIP[0] * (strip as f64 - 1.5);
        writer.object(
            &name,
            &floor(STRIP[0], STRIP[1], 1.0).plain(),
            material,
            json!({ "translation": [x, 0, 0] }),
        );
    }
    let plaster = writer.surface("plaster", [0.55, 0.53, 0.5], 0.0, 0.9);
    let wall = panel(STRIP[0] * 4.0, 3.6).plain();
    writer.object("wall", &wall, plaster, json!({ "translation": [0, 1.8, -3.2] }));
}

fn objects(writer: &mut Writer) {
    let chrome = writer.surface("chrome", [0.9, 0.9, 0.92], 1.0, 0.08);
    let chalk = writer.surface("chalk", [0.75, 0.74, 0.7], 0.0, 0.95);
    let satin = writer.surface("satin", [0.85, 0.55, 0.35], 1.0, 0.35);
    let ball = sphere(0.42, 48, 28).plain();
    writer.object("chrome ball", &ball, chrome, json!({ "translation": [-0.55, 0.42, 0.9] }));
    writer.object("chalk ball", &ball, chalk, json!({ "translation": [0.75, 0.42, 0.2] }));
    let block = rounded_box([0.8, 0.8, 0.8], 0.08, 4).plain();
    let node = json!({ "translation": [-1.75, 0.4, -0.9], "rotation": [0, 0.25882, 0, 0.96593] });
    writer.object("satin block", &block, satin, node);
}

fn lamps(writer: &mut Writer) {
    let mut lamp =
        |name: &str, radiance: [f32; 3], two_sided: bool, mesh: Shape, said: Value, mut node: Value| {
            let material = writer.emitter(name, radiance, two_sided);
            node["extras"] = json!({ "arealight": said });
            writer.object(name, &mesh.plain(), material, node);
        };
    let turned_to_camera = 0.5_f64.sqrt();
    lamp(
        "globe",
        [4.2, 3.4, 2.2],
        false,
        sphere(0.5, 48, 28),
        json!({ "shape": "sphere", "radius": 0.5 }),
        json!({ "translation": [-3.3, 0.62, -0.6] }),
    );
    lamp(
        "bead",
        [1.0, 9.0, 6.0],
        false,
        sphere(0.09, 24, 14),
        json!({ "shape": "sphere", "radius": 0.09 }),
        json!({ "translation": [0.15, 0.09, 1.9] }),
    );
    // It faces the camera, and leans back by a quarter
    lamp(
        "dish",
        [1.2, 2.2, 4.4],
        true,
        disk(0.75, 64),
        json!({ "shape": "disk", "radius": 0.75 }),
        json!({ "translation": [3.3, 0.85, -1.1], "rotation": [0.57923, -0.30783, -0.23621, 0.71679] }),
    );
    // An ellipse half sunk in the floor
    lamp(
        "sunken shield",
        [4.0, 0.7, 0.5],
        true,
        disk(0.5, 64),
        json!({ "shape": "disk", "radius": 0.5 }),
        json!({ "translation": [1.75, 0.05, 1.35], "rotation": [turned_to_camera, 0, 0, turned_to_camera],
                "scale": [1.3, 1, 0.7] }),
    );
    lamp(
        "column",
        [3.0, 2.2, 1.4],
        false,
        cylinder(0.14, 1.5, 40),
        json!({ "shape": "cylinder", "radius": 0.14, "height": 1.5 }),
        json!({ "translation": [1.55, 0.78, -1.9] }),
    );
    lamp(
        "pill",
        [3.4, 1.0, 3.2],
        false,
        capsule(0.16, 0.7, 40, 10),
        json!({ "shape": "capsule", "radius": 0.16, "height": 0.7 }),
        json!({ "translation": [-2.25, 0.17, 1.5], "rotation": [0.34202, 0.34202, 0.61237, 0.61237] }),
    );
    // A neon tube, along the wall: Z takes Y to X
    lamp(
        "neon",
        [14.0, 3.0, 2.0],
        false,
        cylinder(0.012, 5.0, 16),
        json!({ "shape": "pipe", "radius": 0.012, "height": 5 }),
        json!({ "translation": [0, 2.55, -2.9], "rotation": [0, 0, turned_to_camera, turned_to_camera] }),
    );
}

/// A round soft box out of view.
fn key(writer: &mut Writer) {
    writer.use_extension("EXT_lights_area");
    writer.root["extensions"] = json!({ "EXT_lights_area": { "lights": [
        { "name": "key", "type": "disk", "color": [0.9, 0.95, 1.0], "intensity": 3000, "size": 2.2 }
    ] } });
    let mut node = look_at([2.2, 4.6, 3.6], [0.0, 0.3, 0.0]);
    node["name"] = json!("key");
    node["extensions"] = json!({ "EXT_lights_area": { "light": 0 } });
    writer.node(node);
}
