//! The picture of a frame, tone-mapped.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::state::{Mode, State};
use super::viewer::Shown;
use crate::canvas::{Canvas, Colour};
use crate::differences::{SCALE, color, difference_colors};
use crate::picture::{srgb_from_linear, tone_map};
use glam::DVec3;

/// The colours of a wipe's line.
const INK: Colour = [240, 242, 246];

/// How wide and high the bar of the map of errors is, and how far from the lower right corner.
pub const BAR: [i32; 3] = [160, 10, 8];

/// Draws the picture, a wipe, or the map of errors.
pub fn paint(state: &State, shown: &Shown<'_>) -> Canvas {
    let pixels = match (state.mode, &shown.other) {
        (Mode::Error, Some(truth)) => error_map(shown, truth),
        (Mode::Wipe(_), Some(other)) => wiped(state, shown, other),
        _ => colors(shown.ours, state.exposure),
    };
    let [width, height] = shown.size;
    let mut canvas = Canvas::of_pixels(width, height, pixels.into_flattened());
    let (width, height) = (width as i32, height as i32);
    if let Mode::Wipe(_) = state.mode {
        let line = (state.divider * f64::from(width)).round() as i32;
        canvas.rectangle((line - 1, 0), (2, height), |_, _| INK);
    }
    if state.mode == Mode::Error {
        let ([low, high], [long, thick, margin]) = (SCALE, BAR);
        canvas.rectangle((width - margin - long, height - margin - thick), (long, thick), |x, _| {
            color(10_f64.powf(low.log10() + (high / low).log10() * f64::from(x) / f64::from(long)))
        });
    }
    canvas
}

/// What a screen shows of radiance.
fn colors(radiance: &[DVec3], stops: f32) -> Vec<Colour> {
    let scale = stops.exp2();
    radiance.iter().map(|pixel| tone_map(pixel.as_vec3() * scale).to_array().map(srgb_from_linear)).collect()
}

/// Ours to the left of the line, the other to the right.
fn wiped(state: &State, shown: &Shown<'_>, other: &[DVec3]) -> Vec<Colour> {
    let width = shown.size[0] as usize;
    let line = (state.divider * width as f64).round() as usize;
    let pairs = shown.ours.iter().zip(other).enumerate();
    let chosen: Vec<DVec3> =
        pairs.map(|(i, (ours, other))| if i % width < line { *ours } else { *other }).collect();
    colors(&chosen, state.exposure)
}

/// The difference from the truth in false colours; lamps are left out.
fn error_map(shown: &Shown<'_>, truth: &[DVec3]) -> Vec<Colour> {
    let surfaces = |radiance: &[DVec3]| -> Vec<DVec3> {
        let all = radiance.iter().zip(shown.emission);
        all.map(|(radiance, emission)| if *emission == DVec3::ZERO { *radiance } else { DVec3::ZERO })
            .collect()
    };
    difference_colors(&surfaces(shown.ours), &surfaces(truth))
}

#[cfg(test)]
mod tests {
    use super::super::state::Partner;
    use super::*;
    use arealight::Effects;
    use arealight_scene::{Camera, Scene};

    const SIZE: [u32; 2] = [400, 200];

    fn state() -> State {
        let scene = Scene::from_bytes(include_bytes!("../../../../scenes/demo.glb"), "demo").unwrap();
        let camera: Camera = scene.camera(None, 2.0).unwrap();
        State::new(&scene, &camera, 0.0, true)
    }

    fn painted(state: &State, other: Option<DVec3>) -> Canvas {
        let pixels = (SIZE[0] * SIZE[1]) as usize;
        let (ours, emission) = (vec![DVec3::splat(0.2); pixels], vec![DVec3::ZERO; pixels]);
        paint(
            state,
            &Shown {
                scene: &Scene::default(),
                size: SIZE,
                ours: &ours,
                other: other.map(|radiance| vec![radiance; pixels]),
                emission: &emission,
                times: [None; 2],
                effects: Effects::DIFFUSE,
                truth: Some((4, None)),
                yardstick: "yardstick",
                costs: vec![],
                measured: [0, 9],
            },
        )
    }

    /// The colour at a part of the width, in the middle of the height.
    fn at(canvas: &Canvas, part: f64) -> [u8; 3] {
        let place = 3 * (SIZE[1] as usize / 2 * SIZE[0] as usize + (part * f64::from(SIZE[0])) as usize);
        canvas.bytes()[place..place + 3].try_into().unwrap()
    }

    #[test]
    fn a_wipe_is_ours_to_the_left_and_the_other_to_the_right() {
        let other = Some(DVec3::new(0.5, 0.1, 0.1));
        let mut state = state();
        let plain = painted(&state, None);
        (state.mode, state.divider) = (Mode::Wipe(Partner::Truth), 0.25);
        let wiped = painted(&state, other);
        assert_eq!(at(&wiped, 0.1), at(&plain, 0.1));
        assert_ne!(at(&wiped, 0.6), at(&plain, 0.6));
        assert_eq!(at(&wiped, 0.25), INK);
        state.divider = 0.8;
        assert_eq!(at(&painted(&state, other), 0.6), at(&plain, 0.6));
    }

    #[test]
    fn a_map_of_errors_is_dark_where_there_is_none() {
        let mut state = state();
        state.mode = Mode::Error;
        assert_eq!(at(&painted(&state, Some(DVec3::splat(0.2))), 0.5), color(0.0));
        let off = at(&painted(&state, Some(DVec3::splat(0.1))), 0.5);
        assert_eq!(off, color(1.0));
    }
}
