//! The numbers that a table holds, as maps: how smooth they are, for between nodes they are interpolated.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::channels::Channel;
use super::colour::{FAINT, INK, PAPER, viridis};
use super::panel::{self, Axes, MARGIN, SIDE};
use crate::canvas::{Align, Canvas, LINE};
use arealight::LightTable;

const COLUMNS: usize = 4;
const BAR: i32 = 12;

/// Draws the channels of a table, the two matrices a row each, then the albedos.
pub fn draw(table: &LightTable, channels: &[Channel]) -> Canvas {
    let rows = channels.len().div_ceil(COLUMNS);
    let (width, height) = panel::size(COLUMNS, rows);
    let mut canvas = Canvas::new(width as u32, height as u32, PAPER);
    let size = table.size();
    let title = format!(
        "{}, {size} x {size} nodes: what they hold, by roughness and view angle",
        table.description().brdf
    );
    canvas.text((MARGIN.0, 12), &title, Align::Left, INK);

    // Nodes are even in the roughness and in sqrt(1 - cos theta_view)
    let views = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0];
    let axes = Axes::new(&[0.0, 0.25, 0.5, 0.75, 1.0], &views, |roughness, view| {
        (roughness, (1.0 - view.to_radians().cos()).max(0.0).sqrt())
    });
    for (index, channel) in channels.iter().enumerate() {
        let corner = panel::corner(index % COLUMNS, index / COLUMNS);
        let title = format!("{} {}", channel.layer, channel.name);
        let note = format!("largest step {:.3}", channel.step.difference);
        let (least, range) = (channel.min, channel.max - channel.min);
        let share = |value: f32| f64::from(if range > 0.0 { (value - least) / range } else { 0.0 });
        axes.draw(&mut canvas, corner, [&title, &note], |x, y| {
            let node = |place: f64| ((place * f64::from(size)) as u32).min(size - 1);
            viridis(share(channel.at((node(x) as usize, node(y) as usize))))
        });
        draw_range(&mut canvas, corner, [channel.min, channel.max]);
    }
    // The albedos leave half of the last row
    draw_notes(&mut canvas, panel::corner(2, rows - 1));
    canvas
}

/// What the names mean.
fn draw_notes(canvas: &mut Canvas, corner: (i32, i32)) {
    const NOTES: [&str; 11] = [
        "the inverse matrix of a lobe, in the mirror frame:",
        "",
        "    |       q00   0        q02 |",
        "    |         0   1          0 |",
        "    | alpha q20   0  alpha q22 |",
        "",
        "albedo:  the integral of f cos over the hemisphere",
        "schlick: of f cos times Schlick's weight",
        "",
        "A step is between neighbouring nodes. Colours run",
        "from the least number to the greatest.",
    ];
    for (line, text) in NOTES.iter().enumerate() {
        canvas.text((corner.0, corner.1 + (LINE + 3) * line as i32), text, Align::Left, FAINT);
    }
}

/// The colours' scale, on the right above its panel.
fn draw_range(canvas: &mut Canvas, corner: (i32, i32), range: [f32; 2]) {
    const WIDTH: i32 = 96;
    let left = corner.0 + SIDE - WIDTH;
    let share = |x: i32| f64::from(x) / f64::from(WIDTH - 1);
    canvas.rectangle((left, corner.1 - BAR - 7), (WIDTH, BAR), |x, _| viridis(share(x)));
    canvas.text((left, corner.1 - BAR - 24), &short(range[0]), Align::Left, FAINT);
    canvas.text((left + WIDTH, corner.1 - BAR - 24), &short(range[1]), Align::Right, FAINT);
}

/// Three digits or so.
fn short(value: f32) -> String {
    let digits = if value.abs() >= 100.0 { 0 } else { 2 };
    let text = format!("{value:.digits$}");
    // A hair below zero is no -0.00
    if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) { "0".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, -0.001, -1.256, 12345.6].map(short), ["0", "0", "-1.26", "12346"]);
    }
}
