//! Lights that swing: ours beside the truth, as an animated GIF of one palette.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::strip::shown;
use crate::commands::inspect::canvas::{Align, Canvas, Colour, LINE};
use arealight_benches::ladder::{DEFAULT, Pictures};
use arealight_scene::Scene;
use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use glam::DQuat;
use std::borrow::Cow;
use std::f64::consts::TAU;

const PAPER: Colour = [16, 18, 22];
const INK: Colour = [230, 233, 238];

/// Colours of the palette; one more says that a pixel is as it was.
const COLORS: usize = 127;

/// Hundredths of a second that a frame is shown.
const DELAY: u16 = 7;

/// Scenes with the lights where they are in each frame: `degrees` to either side about the vertical through the scene's middle, once
/// to and fro.
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

/// The film as a GIF. Pixels that stay as they were are transparent, which is what keeps the file small.
pub fn encode(pictures: &[Pictures], crop: [u32; 4]) -> Result<Vec<u8>, EncodingError> {
    let frames: Vec<Canvas> = pictures.iter().map(|pictures| draw(pictures, crop)).collect();
    let opaque = |frame: &Canvas| -> Vec<u8> {
        frame.bytes().chunks_exact(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect()
    };
    let pixels: Vec<u8> = frames.iter().flat_map(opaque).collect();
    let quantizer = NeuQuant::new(10, COLORS, &pixels);
    let mut palette = quantizer.color_map_rgb();
    palette.extend([0; 3]);

    let [width, height] = frames.first().map_or([0, 0], Canvas::size).map(|side| side as u16);
    let mut film = Vec::new();
    let mut encoder = Encoder::new(&mut film, width, height, &palette)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let unchanged = COLORS as u8;
    let mut before: Vec<u8> = vec![];
    for pixels in pixels.chunks(4 * usize::from(width) * usize::from(height)) {
        let indices: Vec<u8> = pixels.chunks_exact(4).map(|rgba| quantizer.index_of(rgba) as u8).collect();
        let previous = before.iter().map(Some).chain(std::iter::repeat(None));
        let changed: Vec<u8> = indices
            .iter()
            .zip(previous)
            .map(|(index, before)| if before == Some(index) { unchanged } else { *index })
            .collect();
        encoder.write_frame(&Frame {
            delay: DELAY,
            dispose: DisposalMethod::Keep,
            transparent: Some(unchanged),
            width,
            height,
            buffer: Cow::Owned(changed),
            ..Frame::default()
        })?;
        before = indices;
    }
    drop(encoder);
    Ok(film)
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
