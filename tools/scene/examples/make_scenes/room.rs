//! A room with polygon lights of many outlines: concave, two-sided, and through a platform.

use crate::shapes::{floor, panel, polygon, rounded_box, sphere, star, torus};
use crate::writer::Writer;
use serde_json::{Value, json};

const WIDTH: f64 = 6.0;
const HEIGHT: f64 = 3.2;
const DEPTH: f64 = 5.0;

/// How high the platform is that the sunken panel goes through.
pub const PLATFORM: f64 = 0.5;

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    walls(&mut writer);
    furniture(&mut writer);
    lights(&mut writer);
    writer.camera("door", [0.0, 1.65, 6.6], [0.0, 1.35, 0.0], 0.62, 16.0 / 9.0);
    writer.glb()
}

/// A rotation of `degrees` about an axis.
fn rotation(axis: usize, degrees: f64) -> [f64; 4] {
    let (sin, cos) = (degrees.to_radians() * 0.5).sin_cos();
    let round = |x: f64| (x * 1e6).round() / 1e6;
    let mut quaternion = [0.0, 0.0, 0.0, round(cos)];
    quaternion[axis] = round(sin);
    quaternion
}

fn walls(writer: &mut Writer) {
    let plaster = writer.surface("plaster", [0.72, 0.72, 0.7], 0.0, 0.8);
    let lacquer = writer.surface("lacquered floor", [0.2, 0.16, 0.14], 0.0, 0.22);
    let steel = writer.surface("brushed steel wall", [0.6, 0.6, 0.62], 1.0, 0.38);
    writer.object("floor", &floor(WIDTH, DEPTH, 1.0), lacquer, json!({}));
    let ceiling = json!({ "translation": [0, HEIGHT, 0], "rotation": rotation(0, 180.0) });
    writer.object("ceiling", &floor(WIDTH, DEPTH, 1.0), plaster, ceiling);
    let back = json!({ "translation": [0, HEIGHT * 0.5, -DEPTH * 0.5] });
    writer.object("back wall", &panel(WIDTH, HEIGHT), plaster, back);
    let side = |x: f64, degrees: f64| json!({ "translation": [x, HEIGHT * 0.5, 0], "rotation": rotation(1, degrees) });
    writer.object("left wall", &panel(DEPTH, HEIGHT), steel, side(-WIDTH * 0.5, 90.0));
    writer.object("right wall", &panel(DEPTH, HEIGHT), plaster, side(WIDTH * 0.5, -90.0));
}

fn furniture(writer: &mut Writer) {
    let stone = writer.surface("platform", [0.35, 0.36, 0.4], 0.0, 0.3);
    let node = json!({ "translation": [1.35, PLATFORM * 0.5, -1.1] });
    writer.object("platform", &rounded_box([2.2, PLATFORM, 1.8], 0.04, 3).plain(), stone, node);
    let pearl = writer.surface("pearl", [0.8, 0.78, 0.75], 0.0, 0.15);
    writer.object("pearl", &sphere(0.42, 48, 28).plain(), pearl, json!({ "translation": [-1.5, 0.62, 0.5] }));
    let copper = writer.surface("copper", [0.95, 0.55, 0.38], 1.0, 0.25);
    let node = json!({ "translation": [-0.15, 0.72, -0.2], "rotation": rotation(0, 62.0) });
    writer.object("ring", &torus(0.5, 0.17, 56, 22).plain(), copper, node);
}

fn lights(writer: &mut Writer) {
    let mut light = |name: &str, shape, radiance: [f32; 3], two_sided: bool, node: Value| {
        let material = writer.emitter(name, radiance, two_sided);
        writer.object(name, &shape, material, node);
    };
    // Eight vertices in the ceiling, facing down
    let node = json!({ "translation": [-0.4, HEIGHT - 0.01, 0.4], "rotation": rotation(0, 90.0) });
    light("octagon", star(8, 0.7, 1.0), [7.0, 6.4, 5.6], false, node);
    // Ten, concave, on the back wall
    let node = json!({ "translation": [-1.65, 2.1, -DEPTH * 0.5 + 0.02] });
    light("star", star(10, 0.62, 0.42), [5.0, 2.6, 0.25], false, node);
    // Seven, concave, on the right wall: an arrow to the door
    let arrow = [
        [-0.75, -0.14],
        [0.15, -0.14],
        [0.15, -0.42],
        [0.75, 0.0],
        [0.15, 0.42],
        [0.15, 0.14],
        [-0.75, 0.14],
    ];
    let node = json!({ "translation": [WIDTH * 0.5 - 0.02, 1.75, -0.5], "rotation": rotation(1, -90.0) });
    light("arrow", polygon(&arrow), [0.3, 1.9, 5.0], false, node);
    // Three, on the steel wall
    let node = json!({ "translation": [-WIDTH * 0.5 + 0.02, 1.6, -0.7], "rotation": rotation(1, 90.0) });
    light("triangle", star(3, 0.6, 1.0), [5.0, 0.45, 0.6], false, node);
    // Four, two-sided, hanging free
    let node = json!({ "translation": [-0.35, 1.95, -1.7], "rotation": rotation(1, 50.0) });
    light("two-sided panel", panel(0.3, 1.5), [0.4, 5.0, 1.8], true, node);
    // Five, through the platform's top: its lower part is below that surface's horizon
    let gable = [[-0.45, -0.45], [0.45, -0.45], [0.45, 0.5], [0.0, 0.8], [-0.45, 0.5]];
    let node = json!({ "translation": [1.45, PLATFORM, -1.35], "rotation": rotation(1, -18.0) });
    light("sunken panel", polygon(&gable), [3.4, 1.0, 4.4], false, node);
}
