//! A frame as a person sees it: the picture, tone-mapped, and what there is to say of it.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::state::{KEYS, Mode, Partner, State};
use super::viewer::{Cost, Shown};
use crate::canvas::{Align, Canvas, Colour, LINE};
use crate::differences::{SCALE, color, difference_colors};
use crate::means::Distance;
use crate::picture::{srgb_from_linear, tone_map};
use glam::DVec3;
use std::time::Duration;

const INK: Colour = [240, 242, 246];
const SHADE: Colour = [12, 14, 18];

/// How dark the ground of text is.
const COVER: f64 = 0.66;

/// The width of a character.
const CHARACTER: i32 = 8;

/// What is left free about text.
const MARGIN: i32 = 6;

/// Draws a frame.
pub fn paint(state: &State, shown: &Shown<'_>) -> Canvas {
    let pixels = match (state.mode, &shown.other) {
        (Mode::Error, Some(truth)) => error_map(shown, truth),
        (Mode::Wipe(_), Some(other)) => wiped(state, shown, other),
        _ => colors(shown.ours, state.exposure),
    };
    let [width, height] = shown.size;
    let mut canvas = Canvas::of_pixels(width, height, pixels.into_flattened());
    let (width, height) = (width as i32, height as i32);
    if let Mode::Wipe(partner) = state.mode {
        let line = (state.divider * f64::from(width)).round() as i32;
        canvas.rectangle((line - 1, 0), (2, height), |_, _| INK);
        let other = match (partner, shown.truth) {
            (Partner::Yardstick, _) => shown.yardstick.to_owned(),
            (Partner::Truth, Some((samples, _))) => format!("truth, {samples} samples"),
            (Partner::Truth, None) => "truth".to_owned(),
        };
        label(&mut canvas, (line - MARGIN, MARGIN), &["Arealight".to_owned()], Align::Right);
        label(&mut canvas, (line + MARGIN, MARGIN), &[other], Align::Left);
    }
    if state.mode == Mode::Error {
        scale(&mut canvas, width);
    }
    let said = status(state, shown);
    let top = height - MARGIN - LINE * said.len() as i32;
    label(&mut canvas, (MARGIN, top), &said, Align::Left);
    if !shown.costs.is_empty() {
        label(&mut canvas, (width - MARGIN, MARGIN), &cost_lines(&shown.costs), Align::Right);
    }
    if state.help {
        let line = |(keys, what): &(&str, &str)| format!("{keys:<10} {what}");
        let mut lines: Vec<String> = KEYS.iter().map(line).collect();
        lines.push("drag a lamp to move it; the wheel moves it farther".to_owned());
        lines.push("drag with the second button to slide the view".to_owned());
        label(&mut canvas, (MARGIN, MARGIN), &lines, Align::Left);
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

/// The colours of the map of errors, named at both ends.
fn scale(canvas: &mut Canvas, width: i32) {
    const BAR: i32 = 160;
    let [low, high] = SCALE;
    let left = width - MARGIN - BAR;
    canvas.rectangle((left, MARGIN), (BAR, 10), |x, _| {
        color(10_f64.powf(low.log10() + (high / low).log10() * f64::from(x) / f64::from(BAR)))
    });
    let name = ["difference, 0.1 % to 100 % of the mean".to_owned()];
    label(canvas, (width - MARGIN, MARGIN + 12), &name, Align::Right);
}

/// What there is to say of a picture, in lines.
fn status(state: &State, shown: &Shown<'_>) -> Vec<String> {
    let level = state.level.name();
    let shadows = if state.has_shadows() { "with shadows" } else { "without shadows" };
    let roughness =
        state.roughness.map_or_else(String::new, |roughness| format!(", roughness {roughness:.2}"));
    let fog = state.fog().map_or_else(String::new, |fog| format!(", fog {:.3}", fog.density));
    let mut lines = vec![format!("{level}, {shadows}{fog}{roughness}, exposure {:+.1}", state.exposure)];
    if shown.times.iter().any(Option::is_some) {
        let [visibility, shading] = shown.times.map(milliseconds);
        lines.push(format!("shading {shading}, visibility {visibility}"));
    }
    lines.push(format!("effects: {}", shown.effects));
    if let Some((samples, distance)) = shown.truth {
        let off = distance.map_or_else(|| "error not known yet".to_owned(), error);
        lines.push(format!("{off}; {samples} samples of the truth"));
    }
    if !state.help {
        lines.push("h: help".to_owned());
    }
    lines
}

/// An error beside the noise of the truth that it is of.
fn error(distance: Distance) -> String {
    format!("error {}, the truth's noise {:.1} %", percent(Some(distance)), distance.noise * 100.0)
}

/// An error as far as it is known.
fn percent(distance: Option<Distance>) -> String {
    match distance {
        None => "-".to_owned(),
        Some(Distance { error: None, .. }) => "in noise".to_owned(),
        Some(Distance { error: Some(error), .. }) => format!("{:.1} %", error * 100.0),
    }
}

/// A table of what levels and effects cost.
fn cost_lines(costs: &[Cost]) -> Vec<String> {
    let width = costs.iter().map(|cost| cost.name.len()).max().unwrap_or(0);
    let mut lines = vec![format!("{:width$}  {:>9}  {:>8}", "", "shading", "error")];
    lines.extend(costs.iter().map(|Cost { name, milliseconds, distance }| {
        let time = milliseconds.map_or_else(|| "-".to_owned(), |time| format!("{time:.1} ms"));
        format!("{name:width$}  {time:>9}  {:>8}", percent(*distance))
    }));
    lines
}

fn milliseconds(time: Option<Duration>) -> String {
    time.map_or_else(|| "time not known".to_owned(), |time| format!("{:.1} ms", time.as_secs_f64() * 1e3))
}

/// Lines of text on a dark ground; aligned to the right, `corner` is the upper right one.
fn label(canvas: &mut Canvas, corner: (i32, i32), lines: &[String], align: Align) {
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0) as i32 * CHARACTER;
    let left = if align == Align::Right { corner.0 - longest } else { corner.0 };
    for y in corner.1 - 2..corner.1 + LINE * lines.len() as i32 + 2 {
        (left - 4..left + longest + 4).for_each(|x| canvas.blend(x, y, SHADE, COVER));
    }
    for (row, line) in (0..).zip(lines) {
        canvas.text((left, corner.1 + LINE * row), line, Align::Left, INK);
    }
}

#[cfg(test)]
mod tests {
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
        painted_in(state, other, [None, Some(Duration::from_millis(3))])
    }

    fn painted_in(state: &State, other: Option<DVec3>, times: [Option<Duration>; 2]) -> Canvas {
        let pixels = (SIZE[0] * SIZE[1]) as usize;
        let (ours, emission) = (vec![DVec3::splat(0.2); pixels], vec![DVec3::ZERO; pixels]);
        paint(
            state,
            &Shown {
                size: SIZE,
                ours: &ours,
                other: other.map(|radiance| vec![radiance; pixels]),
                emission: &emission,
                times,
                effects: Effects::DIFFUSE,
                truth: Some((4, None)),
                yardstick: "yardstick",
                costs: vec![],
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

    #[test]
    fn what_is_said_is_legible_on_any_ground() {
        let mut state = state();
        let plain = painted(&state, None);
        state.help = true;
        let help = painted(&state, None);
        // The upper left corner is covered, and has letters on it
        let part = |canvas: &Canvas| -> Vec<u8> {
            (8..100).flat_map(|y| canvas.bytes()[3 * (y * 400 + 8)..3 * (y * 400 + 200)].to_vec()).collect()
        };
        assert!(part(&plain).windows(2).all(|pair| pair[0] == pair[1]));
        let covered = part(&help);
        assert!(covered.iter().any(|byte| *byte > 200) && covered.iter().any(|byte| *byte < 80));
    }

    /// What is recorded shows no times, and is the same on a busy machine.
    #[test]
    fn a_frame_without_times_says_nothing_of_them() {
        let state = state();
        let said = |times| painted_in(&state, None, times).bytes().to_vec();
        let [fast, slow] = [3, 4].map(|time| [None, Some(Duration::from_millis(time))]);
        assert_ne!(said(fast), said(slow));
        assert_ne!(said(fast), said([None; 2]));
    }

    #[test]
    fn costs_are_a_table() {
        let distance = Some(Distance { error: Some(0.0213), noise: 0.01 });
        let costs = [
            Cost { name: "exact".to_owned(), milliseconds: Some(12.345), distance },
            Cost { name: "without coat".to_owned(), milliseconds: None, distance: None },
        ];
        let lines = cost_lines(&costs);
        assert_eq!(lines[1], "exact           12.3 ms     2.1 %");
        assert_eq!(lines[2], "without coat          -         -");
        assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    }
}
