//! Frames of a film: the part of the light that arrives in truth, and as it is found with one ray a pixel.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use crate::canvas::{Align, Canvas, Colour, LINE};
use crate::failure::Failure;
use crate::output;
use arealight_benches::shadow_motion::{Scheme, Still};
use std::path::Path;

const PAPER: Colour = [255, 255, 255];
const INK: Colour = [28, 36, 48];
/// Where there is no light.
const UNLIT: Colour = [44, 58, 92];
const GAP: i32 = 8;
/// Frames drawn.
const FRAMES: usize = 4;

/// Refuses a file that is no PNG, or cannot be written.
pub fn check(path: &Path) -> Result<(), Failure> {
    if path.extension().is_some_and(|ending| ending == "png") {
        return output::check(path, None);
    }
    let message = format!("{}: the file's name must end in .png", path.display());
    Err(Failure::Argument { argument: "--strip", message })
}

/// So many of the stills, at even distances.
fn chosen(stills: &[Still]) -> impl Iterator<Item = &Still> {
    let count = FRAMES.min(stills.len());
    (0..count).filter_map(move |place| stills.get(place * stills.len() / count))
}

/// Of each pixel the grey of the part that arrives.
fn greys(still: &Still, part: impl Fn(usize, f64) -> f64) -> Vec<Colour> {
    let pixels = still.truth.iter().enumerate();
    let grey = |part: f64| [(255.0 * part.clamp(0.0, 1.0)).round() as u8; 3];
    pixels.map(|(pixel, truth)| truth.map_or(UNLIT, |truth| grey(part(pixel, truth)))).collect()
}

/// Draws the strip, a frame a column, of stills of `width` x `height` pixels.
pub fn draw(stills: &[Still], [width, height]: [u32; 2]) -> Canvas {
    let (width, height) = (width as i32, height as i32);
    let step = (width + GAP, height + LINE + GAP);
    let rows: Vec<(String, Option<usize>)> = std::iter::once(("truth".to_owned(), None))
        .chain(Scheme::ALL.iter().enumerate().filter(|(_, scheme)| scheme.rays == 1).map(
            |(place, scheme)| {
                let history = if scheme.history { "with a history" } else { "without a history" };
                (format!("1 ray, filtered, {history}"), Some(place))
            },
        ))
        .collect();
    let columns = chosen(stills).count() as i32;
    let size = (columns * step.0 + GAP, rows.len() as i32 * step.1 + GAP);
    let mut canvas = Canvas::new(size.0 as u32, size.1 as u32, PAPER);
    for (column, still) in (0..).zip(chosen(stills)) {
        for (row, (name, scheme)) in (0..).zip(&rows) {
            let pixels = match scheme.and_then(|scheme| still.found.get(scheme)) {
                Some(found) => greys(still, |pixel, _| found.get(pixel).copied().unwrap_or(0.0)),
                None => greys(still, |_, truth| truth),
            };
            let corner = (GAP + column * step.0, GAP + row * step.1);
            let caption = format!("frame {}: {name}", still.frame);
            canvas.text(corner, &caption, Align::Left, INK);
            canvas.rectangle((corner.0, corner.1 + LINE), (width, height), |x, y| {
                pixels.get((y * width + x) as usize).copied().unwrap_or(PAPER)
            });
        }
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    fn still(frame: u32, found: f64) -> Still {
        let truth = vec![None, Some(0.25)];
        Still { scene: String::new(), frame, truth, found: vec![vec![found; 2]; Scheme::ALL.len()] }
    }

    #[test]
    fn four_frames_at_even_distances_are_drawn() {
        let stills: Vec<Still> = (0..15).map(|frame| still(frame, 0.0)).collect();
        assert_eq!(chosen(&stills).map(|still| still.frame).collect::<Vec<_>>(), [0, 3, 7, 11]);
        assert_eq!(chosen(&stills[..2]).count(), 2);
        assert_eq!(chosen(&[]).count(), 0);
    }

    #[test]
    fn the_truth_is_above_what_is_found() {
        let canvas = draw(&[still(5, 1.0)], [2, 1]);
        let [width, _] = canvas.size();
        let pixel = |x: i32, row: i32| -> [u8; 3] {
            let y = GAP + row * (1 + LINE + GAP) + LINE;
            let at = 3 * (y as usize * width as usize + (GAP + x) as usize);
            canvas.bytes()[at..at + 3].try_into().unwrap()
        };
        assert_eq!([pixel(0, 0), pixel(1, 0)], [UNLIT, [64; 3]]);
        assert_eq!([pixel(0, 1), pixel(1, 1)], [UNLIT, [255; 3]]);
    }

    #[test]
    fn a_strip_is_a_png() {
        assert!(check(Path::new("a.jpg")).is_err());
    }
}
