//! The levels of a light's texture side by side, magnified to one size.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use super::colour::{FAINT, INK, PAPER};
use super::pyramid::{Level, Pyramid};
use crate::canvas::{Align, Canvas, LINE};
use crate::picture::srgb_from_linear;
use glam::DVec3;

/// The longer side of a level, in pixels.
const SIDE: u32 = 320;

const COLUMNS: usize = 3;
const BORDER: i32 = 24;
const TOP: i32 = 76;

/// Draws all levels.
pub fn draw(pyramid: &Pyramid) -> Canvas {
    // All levels have the same shape
    let [width, height] = pyramid.size.extent(0);
    let longest = width.max(height);
    let side = |texels: u32| (texels * SIDE / longest).max(1) as i32;
    let cell = (side(width), side(height));
    let stride = (cell.0 + BORDER, cell.1 + BORDER + 2 * LINE + 8);
    let rows = pyramid.levels.len().div_ceil(COLUMNS) as i32;
    // Room for the title, whatever the shape
    let across = (BORDER + COLUMNS as i32 * stride.0).max(640);
    let mut canvas = Canvas::new(across as u32, (TOP + rows * stride.1) as u32, PAPER);
    let (exposure, note) = exposure(&pyramid.levels[0]);
    canvas.text((BORDER, 10), &shortened(&pyramid.name, (across - 2 * BORDER) / 8), Align::Left, INK);
    let notes = format!("{width} x {height} texels{note}");
    canvas.text((BORDER, 10 + LINE + 3), &notes, Align::Left, FAINT);

    for (number, level) in pyramid.levels.iter().enumerate() {
        let corner = (
            BORDER + stride.0 * (number % COLUMNS) as i32,
            TOP + 2 * LINE + stride.1 * (number / COLUMNS) as i32 - LINE,
        );
        let title = format!("level {number}: {} x {}", level.extent[0], level.extent[1]);
        let blur = match number {
            0 => "sharp".to_owned(),
            _ => format!("blur {:.1} texels, {:.2} %", level.blur, 100.0 * pyramid.share(level)),
        };
        canvas.text((corner.0, corner.1 - 2 * LINE - 1), &title, Align::Left, INK);
        canvas.text((corner.0, corner.1 - LINE - 2), &blur, Align::Left, FAINT);
        canvas.rectangle(corner, cell, |x, y| {
            let color = pixel(level, [x, y], cell) * exposure;
            color.to_array().map(|channel| srgb_from_linear(channel as f32))
        });
    }
    canvas
}

/// What a picture's pixel shows: the texel, or the mean of the texels that it covers.
fn pixel(level: &Level, [x, y]: [i32; 2], cell: (i32, i32)) -> DVec3 {
    let texels = |pixel: i32, pixels: i32, extent: u32| {
        let first = pixel as u32 * extent / pixels as u32;
        let past = (pixel as u32 + 1) * extent / pixels as u32;
        first..past.max(first + 1)
    };
    let (columns, rows) = (texels(x, cell.0, level.extent[0]), texels(y, cell.1, level.extent[1]));
    let count = (columns.len() * rows.len()) as f64;
    rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| level.texel(x, y)).sum::<DVec3>()
        / count
}

/// What makes the brightest texel white, and what to say of it; images within what a screen shows stay as
/// they are.
fn exposure(level: &Level) -> (f64, String) {
    let texels = level.texels.iter();
    let peak = texels.flat_map(|texel| &texel[..3]).fold(0.0_f32, |peak, channel| peak.max(*channel));
    if peak <= 1.0 {
        return (1.0, String::new());
    }
    (1.0 / f64::from(peak), format!("; white is {peak:.3}"))
}

/// The end of a text that is longer than `limit` characters.
fn shortened(text: &str, limit: i32) -> String {
    let (count, limit) = (text.chars().count(), limit.max(4) as usize);
    if count <= limit {
        return text.to_owned();
    }
    text.chars().skip(count - (limit - 3)).fold("...".to_owned(), |mut text, c| {
        text.push(c);
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::pyramid::PyramidSize;

    /// A pyramid whose level `i` is all `(i + 1) / 8`, and twice that in its first texel.
    fn pyramid() -> Pyramid {
        let size = PyramidSize::new(128, 64).unwrap();
        let level = |level: u32| {
            let extent = size.extent(level);
            let gray = (level + 1) as f32 / 8.0;
            let mut texels = vec![[gray; 4]; (extent[0] * extent[1]) as usize];
            texels[0] = [2.0 * gray; 4];
            Level { extent, blur: size.blur(level), texels }
        };
        Pyramid { name: "gray".into(), size, levels: (0..size.levels()).map(level).collect() }
    }

    #[test]
    fn levels_are_drawn_at_one_size_in_their_order() {
        let pyramid = pyramid();
        assert_eq!(pyramid.levels.len(), 5);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        draw(&pyramid).save_png(&path).unwrap();
        let picture = image::open(&path).unwrap().to_rgb8();
        // 320 by 160 each, three in a row
        let stride = (320 + BORDER, 160 + BORDER + 2 * LINE + 8);
        assert_eq!(picture.dimensions(), ((BORDER + 3 * stride.0) as u32, (TOP + 2 * stride.1) as u32));
        for (number, level) in (0..).zip(&pyramid.levels) {
            let middle = (BORDER + 160 + stride.0 * (number % 3), TOP + LINE + 80 + stride.1 * (number / 3));
            let expected = srgb_from_linear(level.texels[1][0]);
            assert_eq!(picture.get_pixel(middle.0 as u32, middle.1 as u32).0, [expected; 3], "{number}");
        }
    }

    #[test]
    fn pixels_are_texels_or_their_means() {
        let levels = pyramid().levels;
        // Level 0 has 128 by 64 texels: a pixel of 64 by 32 is the mean of four
        assert_eq!(pixel(&levels[0], [0, 0], (64, 32)), DVec3::splat(0.125 * 1.25));
        assert_eq!(pixel(&levels[0], [1, 0], (64, 32)), DVec3::splat(0.125));
        // Level 4 has 8 by 4: a texel is 40 pixels of 320
        assert_eq!(pixel(&levels[4], [39, 39], (320, 160)), DVec3::splat(1.25));
        assert_eq!(pixel(&levels[4], [40, 39], (320, 160)), DVec3::splat(0.625));
    }

    #[test]
    fn bright_images_are_exposed_to_their_peak() {
        let mut level = pyramid().levels.remove(0);
        assert_eq!(exposure(&level), (1.0, String::new()));
        level.texels[7] = [0.5, 16.0, 0.5, 99.0];
        assert_eq!(exposure(&level), (1.0 / 16.0, "; white is 16.000".to_owned()));
    }

    #[test]
    fn long_names_keep_their_end() {
        assert_eq!(shortened("scenes/screen.glb", 12), "...creen.glb");
        assert_eq!(shortened("a.png", 12), "a.png");
    }
}
