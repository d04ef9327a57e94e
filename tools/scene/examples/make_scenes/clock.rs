//! A station's clock that hangs over a floor which is a mirror on the left and rough on the right: a textured
//! disk, on both sides.

use crate::screen::{ground, texture};
use crate::shapes::{disk, panel};
use crate::writer::Writer;
use image::{Rgb, RgbImage};
use serde_json::json;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// The clock's radius.
pub const RADIUS: f64 = 0.9;

/// Texels a side of its face.
pub const SIDE: u32 = 256;

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::new();
    ground(&mut writer);
    let face = texture(&mut writer, "face", &face());
    let material = writer.emitter_of_image("face", [2.5, 2.5, 2.5], face, true);
    // It lies on its back, its top away: a quarter turn about X raises that
    let node = json!({
        "translation": [0, 1.05, -1.0],
        "rotation": [FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2],
        "extras": { "arealight": { "shape": "disk", "radius": RADIUS } },
    });
    writer.object("clock", &disk(RADIUS, 64).with_image_from_above(), material, node);
    let chalk = writer.surface("chalk", [0.8, 0.8, 0.8], 0.0, 0.9);
    writer.object("wall", &panel(7.0, 2.6), chalk, json!({ "translation": [0, 1.3, -3.0] }));
    writer.camera("platform", [-0.3, 1.8, 5.4], [0.0, 0.5, -1.0], 0.56, 16.0 / 9.0);
    writer.glb()
}

/// Twenty to two: a white dial within a red rim, black hours and hands.
fn face() -> RgbImage {
    let hands = [(TAU * (1.0 + 2.0 / 3.0) / 12.0, 0.5, 0.05), (TAU * 2.0 / 3.0, 0.78, 0.03)];
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        // From the middle to the right and up, the radius being one
        let place = |texel: u32| (f64::from(texel) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
        let (x, y) = (place(x), -place(y));
        let (radius, angle) = (x.hypot(y), x.atan2(y).rem_euclid(TAU));
        let to_hour = (angle + PI / 12.0).rem_euclid(PI / 6.0) - PI / 12.0;
        let is_hour = (0.72..0.88).contains(&radius) && (radius * to_hour).abs() < 0.03;
        let is_hand = hands.iter().any(|(at, length, width)| {
            let (sin, cos) = (angle - at).sin_cos();
            (-0.1..*length).contains(&(radius * cos)) && (radius * sin).abs() < *width
        });
        match radius {
            _ if is_hour || is_hand => Rgb([10, 10, 12]),
            radius if radius > 0.93 => Rgb([200, 30, 25]),
            _ => Rgb([240, 236, 225]),
        }
    })
}
