//! A map over roughness and view angle, with its axes.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::colour::{FAINT, INK};
use crate::canvas::{Align, Canvas, Colour, LINE};

/// The side of a map, in pixels.
pub const SIDE: i32 = 256;

/// From one map's corner to the next's: room for ticks, labels and a title.
pub const STRIDE: (i32, i32) = (SIDE + 72, SIDE + 94);

/// What a panel's sides stand for.
pub struct Axes {
    /// Roughnesses that are written, with their place from the left, 0 to 1.
    pub roughness: Vec<(f64, f64)>,
    /// View angles that are written, in degrees, with their place from the bottom, 0 to 1.
    pub view: Vec<(f64, f64)>,
}

impl Axes {
    /// Ticks of values at their places.
    pub fn new(roughness: &[f64], view: &[f64], place: impl Fn(f64, f64) -> (f64, f64)) -> Self {
        Self {
            roughness: roughness.iter().map(|&r| (r, place(r, 0.0).0)).collect(),
            view: view.iter().map(|&v| (v, place(0.0, v).1)).collect(),
        }
    }

    /// Draws a map whose top left corner is `corner`: the colours of a function of the place within it, (0,
    /// 0) at the bottom left to (1, 1), under two lines of text.
    pub fn draw(
        &self,
        canvas: &mut Canvas,
        corner: (i32, i32),
        [title, note]: [&str; 2],
        colour: impl Fn(f64, f64) -> Colour,
    ) {
        // Fill the frame, then the map within it
        let place = |pixel: i32| (f64::from(pixel) + 0.5) / f64::from(SIDE);
        canvas.rectangle((corner.0 - 1, corner.1 - 1), (SIDE + 2, SIDE + 2), |_, _| FAINT);
        canvas.rectangle(corner, (SIDE, SIDE), |x, y| colour(place(x), 1.0 - place(y)));

        // Mark the ticks
        let pixel = |share: f64| (share * f64::from(SIDE - 1)).round() as i32;
        let bottom = corner.1 + SIDE;
        for (value, share) in &self.roughness {
            let x = corner.0 + pixel(*share);
            canvas.rectangle((x, bottom), (1, 5), |_, _| FAINT);
            canvas.text((x, bottom + 5), &value.to_string(), Align::Centre, FAINT);
        }
        for (value, share) in &self.view {
            let y = bottom - 1 - pixel(*share);
            canvas.rectangle((corner.0 - 5, y), (5, 1), |_, _| FAINT);
            canvas.text((corner.0 - 7, y - LINE / 2), &format!("{value}°"), Align::Right, FAINT);
        }
        canvas.text((corner.0 + SIDE / 2, bottom + 5 + LINE), "roughness", Align::Centre, FAINT);
        let left = (corner.0 - 54, corner.1 + SIDE / 2);
        canvas.text_upwards(left, "view angle", Align::Centre, FAINT);
        canvas.text((corner.0, corner.1 - 2 * LINE - 4), title, Align::Left, INK);
        canvas.text((corner.0, corner.1 - LINE - 3), note, Align::Left, FAINT);
    }
}

/// The first map's corner.
pub const MARGIN: (i32, i32) = (64, 92);

/// The corner of the map in a column and a row.
pub fn corner(column: usize, row: usize) -> (i32, i32) {
    (MARGIN.0 + STRIDE.0 * column as i32, MARGIN.1 + STRIDE.1 * row as i32)
}

/// The size of a picture of so many maps.
pub fn size(columns: usize, rows: usize) -> (i32, i32) {
    let past = corner(columns, rows);
    (past.0 - 48, past.1 - 30)
}
