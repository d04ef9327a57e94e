//! A hundred small rectangles of many sizes, heights and colours above a floor with boxes, of satin or of
//! metal: of some lights of many the shadow matters.

use crate::shapes::{cuboid, floor, panel};
use crate::sweep::turn_around;
use crate::writer::{Writer, look_at};
use serde_json::json;

/// Lamps along each side of the floor.
pub const ROWS: u32 = 10;

/// How many boxes stand on the floor.
pub const BOXES: u32 = 18;

/// What all surfaces are of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    Satin,
    Metal,
}

impl Surface {
    pub fn roughness(self) -> f32 {
        match self {
            Self::Satin => 0.5,
            Self::Metal => 0.3,
        }
    }
}

/// Width and depth of the floor.
const SIDE: f64 = 10.0;

/// What the lamps shine with: warm, white, cold, and a few colours.
const RADIANCE: [[f32; 3]; 8] = [
    [9.0, 6.3, 3.8],
    [7.0, 6.4, 5.5],
    [5.0, 5.0, 5.0],
    [4.2, 5.0, 6.4],
    [12.0, 7.0, 3.0],
    [7.0, 1.2, 0.8],
    [0.8, 5.0, 2.2],
    [1.0, 2.0, 8.0],
];

pub fn glb(surface: Surface) -> Vec<u8> {
    let mut writer = Writer::new();
    let (name, metalness) = match surface {
        Surface::Satin => ("satin", 0.0),
        Surface::Metal => ("metal", 1.0),
    };
    let material = writer.surface(name, [0.55, 0.54, 0.52], metalness, surface.roughness());
    writer.object("floor", &floor(SIDE, SIDE, 1.0).plain(), material, json!({}));
    let mut random = Random(1);
    boxes(&mut writer, material, &mut random);
    lamps(&mut writer, &mut random);
    writer.camera("above", [0.0, 6.2, 8.2], [0.0, 0.0, 0.45], 0.72, 16.0 / 9.0);
    writer.glb()
}

fn boxes(writer: &mut Writer, material: usize, random: &mut Random) {
    let shape = writer.primitive(&cuboid([1.0; 3]).plain());
    let mesh = writer.mesh("box", &shape, material);
    // Six by three cells, each with a box somewhere in it
    for i in 0..BOXES {
        let (width, depth) = (random.between(0.25, 0.8), random.between(0.25, 0.8));
        let height = random.between(0.3, 1.2);
        let place = |cell: u32, cells: u32, random: &mut Random| {
            let free = SIDE / f64::from(cells) - 1.2;
            rounded(
                (f64::from(cell) + 0.5) * SIDE / f64::from(cells) - SIDE * 0.5
                    + random.between(-0.5, 0.5) * free,
            )
        };
        let (x, z) = (place(i % 6, 6, random), place(i / 6, 3, random));
        writer.node(json!({ "name": format!("box {i}"), "mesh": mesh,
            "translation": [x, rounded(height * 0.5), z], "scale": [width, height, depth] }));
    }
}

fn lamps(writer: &mut Writer, random: &mut Random) {
    let shape = writer.primitive(&panel(1.0, 1.0).plain());
    let meshes: Vec<usize> = RADIANCE
        .iter()
        .enumerate()
        .map(|(i, radiance)| {
            let name = format!("lamp of colour {i}");
            let material = writer.emitter(&name, *radiance, false);
            writer.mesh(&name, &shape, material)
        })
        .collect();
    let cell = SIDE / f64::from(ROWS);
    for i in 0..ROWS * ROWS {
        let mut along = |place: u32| (f64::from(place) + random.between(0.1, 0.9)) * cell - SIDE * 0.5;
        let (x, z) = (along(i % ROWS), along(i / ROWS));
        let (y, lean) = (random.between(1.45, 2.8), random.between(-0.8, 0.8));
        let target = [x + lean, 0.0, z + random.between(-0.8, 0.8)];
        let mut node = look_at([rounded(x), y, rounded(z)], target.map(rounded));
        // A panel faces +Z, a node looks along -Z
        turn_around(&mut node);
        node["name"] = json!(format!("lamp {i}"));
        node["mesh"] = json!(meshes[random.below(RADIANCE.len())]);
        node["scale"] = json!([random.between(0.12, 0.5), random.between(0.12, 0.5), 1]);
        writer.node(node);
    }
}

fn rounded(x: f64) -> f64 {
    (x * 1e3).round() / 1e3
}

/// Numbers that are the same on every machine (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// Of three decimals.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        rounded(low + (high - low) * self.next() as f64 / (1_u64 << 31) as f64)
    }
}
