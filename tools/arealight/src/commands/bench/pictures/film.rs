//! Lights that swing: ours beside the truth.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::strip::shown;
use crate::canvas::{Align, Canvas, Colour, LINE};
use crate::film::Palette;
use arealight_benches::ladder::{DEFAULT, Pictures};
use arealight_scene::Scene;
use gif::EncodingError;
use glam::DQuat;
use std::f64::consts::TAU;

const PAPER: Colour = [16, 18, 22];
const INK: Colour = [230, 233, 238];

/// Hundredths of a second that a frame is shown.
const DELAY: f64 = 7.0;

/// Scenes with the lights where they are in each frame: `degrees` to either side about the vertical through
/// the scene's middle, once to and fro.
pub fn swing(scene: &Scene, frames: u32, degrees: f64) -> Vec<Scene> {
    let middle = scene.bounds.center();
    let frame = |index: u32| {
        let angle = degrees.to_radians() * (TAU * f64::from(index) / f64::from(frames)).sin();
        let turn = DQuat::from_rotation_y(angle);
        let mut scene = scene.clone();
        for vertex in scene.lights.iter_mut().flat_map(|light| light.shape.vertices_mut()) {
            *vertex = middle + turn * (*vertex - middle);
        }
        scene
    };
    (0..frames).map(frame).collect()
}

/// A frame: ours beside the truth.
fn draw(pictures: &Pictures, [x, y, width, height]: [u32; 4]) -> Canvas {
    let mut canvas = Canvas::new(2 * width + 4, height + LINE as u32 + 2, PAPER);
    let ours = pictures.shown.iter().find(|picture| picture.name == DEFAULT);
    let reflected = ours.map_or(&[][..], |picture| &picture.reflected);
    let captions = ["Arealight".to_owned(), format!("truth, {} samples", pictures.samples)];
    let sides = [reflected, &pictures.reference];
    for ((left, caption), radiance) in [0, width as i32 + 4].into_iter().zip(captions).zip(sides) {
        let pixels = shown(pictures, radiance, [x, y, width, height]);
        canvas.text((left + 4, 1), &caption, Align::Left, INK);
        canvas.rectangle((left, LINE + 2), (width as i32, height as i32), |x, y| {
            pixels.get(y as usize * width as usize + x as usize).copied().unwrap_or(PAPER)
        });
    }
    canvas
}

/// The film as a GIF.
pub fn encode(pictures: &[Pictures], crop: [u32; 4]) -> Result<Vec<u8>, EncodingError> {
    let frames: Vec<Canvas> = pictures.iter().map(|pictures| draw(pictures, crop)).collect();
    crate::film::encode(&frames, DELAY, Palette { colors: 127, dither: 0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::{Light, LightShape};
    use glam::DVec3;

    #[test]
    fn lights_swing_to_both_sides_and_come_back() {
        let corners = [DVec3::new(1.0, 2.0, 0.0), DVec3::new(2.0, 2.0, 0.0), DVec3::new(1.0, 3.0, 0.0)];
        let shape = LightShape::Polygon(corners.to_vec());
        let scene = Scene { lights: vec![Light { shape, ..Light::default() }], ..Scene::default() };
        let z = |scene: &Scene| scene.lights[0].shape.vertices()[0].z - scene.bounds.center().z;
        let frames = swing(&scene, 4, 90.0);
        assert_eq!(frames.len(), 4);
        assert!(z(&frames[0]).abs() < 1e-12 && z(&frames[2]).abs() < 1e-12);
        assert!(z(&frames[1]) * z(&frames[3]) < 0.0);
    }
}
