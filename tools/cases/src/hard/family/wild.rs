//! Polygons that nobody would draw.

use super::super::HardCase;
use super::super::outline::polygon;
use super::super::stream::{Stream, power_of_two};
use super::{contact, horizon};
use arealight::LightTable;

pub fn degenerate(stream: &mut Stream, table: &LightTable) -> HardCase {
    let mut case = horizon::crossing(stream, table);
    let vertices = &mut case.offsets;
    let i = stream.below(vertices.len());
    let next = (i + 1) % vertices.len();
    match stream.below(7) {
        // A vertex twice, or all of them
        0 => vertices.insert(i, vertices[i]),
        1 => *vertices = vertices.iter().flat_map(|v| [*v, *v]).collect(),
        // A vertex on an edge, as near as rounding lets it
        2 => {
            let part = stream.unit() as f32;
            let middle = [0, 1, 2].map(|c| vertices[i][c] + (vertices[next][c] - vertices[i][c]) * part);
            vertices.insert(i + 1, middle);
        }
        // A spike without width
        3 => {
            let tip = (stream.direction() * stream.power(-2.0, 4.0)).as_vec3().to_array();
            let root = vertices[i];
            vertices.splice(i..=i, [root, tip, root]);
        }
        // There and back: no area
        4 => vertices.extend(vertices.clone().into_iter().rev()),
        // All at one place
        5 => {
            let place = vertices[0];
            vertices.fill(place);
        }
        // At the point itself
        _ => vertices[i] = [0.0; 3],
    }
    HardCase { flat: false, ..case }
}

pub fn scaled(stream: &mut Stream, table: &LightTable) -> HardCase {
    let made = match stream.below(4) {
        0 => horizon::crossing(stream, table),
        1 => horizon::concave(stream, table),
        2 => contact::interior(stream, table),
        _ => super::far::above(stream, table),
    };
    // Exact: far from both ends of float32's range
    let exponent = stream.between(-40.0, 41.0).floor() as i32;
    let scale = power_of_two(exponent) as f32;
    let times = |v: [f32; 3]| v.map(|c| c * scale);
    HardCase { anchor: times(made.anchor), offsets: made.offsets.into_iter().map(times).collect(), ..made }
}

pub fn quads(stream: &mut Stream, _: &LightTable) -> HardCase {
    let case = polygon((0..4).map(|_| stream.direction() * stream.power(-3.0, 3.0)).collect::<Vec<_>>());
    HardCase { flat: false, ..case }
}

pub fn overflowing(stream: &mut Stream, table: &LightTable) -> HardCase {
    let mut case = horizon::crossing(stream, table);
    let largest = case.offsets.iter().flatten().fold(0.0_f32, |m, c| m.max(c.abs()));
    // Up to the largest finite number, or as far below as squares overflow
    let target = if stream.one_in(2) { f32::MAX } else { (stream.power(62.0, 127.9)) as f32 };
    for vertex in &mut case.offsets {
        *vertex = vertex.map(|c| (f64::from(c) / f64::from(largest) * f64::from(target)) as f32);
    }
    case
}

pub fn denormal(stream: &mut Stream, table: &LightTable) -> HardCase {
    let mut case = horizon::crossing(stream, table);
    let scale = stream.power(-148.0, -110.0);
    for vertex in &mut case.offsets {
        *vertex = vertex.map(|c| (f64::from(c) * scale) as f32);
    }
    case
}

/// A finite number of any bits.
fn any_finite(stream: &mut Stream) -> f32 {
    loop {
        let number = f32::from_bits(stream.bits());
        if number.is_finite() {
            return number;
        }
    }
}

pub fn bits(stream: &mut Stream, _: &LightTable) -> HardCase {
    let count = 3 + stream.below(6);
    let wild = stream.below(3);
    let number = |stream: &mut Stream| {
        // All of any size, or one in eight
        if wild == 0 || stream.one_in(8) { any_finite(stream) } else { stream.between(-1.0, 1.0) as f32 }
    };
    let anchor = if stream.one_in(2) { [0.0; 3] } else { [0; 3].map(|_| number(stream)) };
    let offsets = (0..count).map(|_| [0; 3].map(|_| number(stream))).collect();
    HardCase { anchor, offsets, flat: false }
}

pub fn not_finite(stream: &mut Stream, table: &LightTable) -> HardCase {
    const NUMBERS: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut case = match stream.below(3) {
        0 => horizon::crossing(stream, table),
        1 => horizon::above(stream, table),
        _ => super::far::above(stream, table),
    };
    // One component or a whole vertex, of one vertex or of all through the anchor
    let number = NUMBERS[stream.below(3)];
    let i = stream.below(case.offsets.len());
    match stream.below(4) {
        0 => case.offsets[i] = [number; 3],
        1 => case.anchor[stream.below(3)] = number,
        _ => case.offsets[i][stream.below(3)] = number,
    }
    case
}
