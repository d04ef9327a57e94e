//! Ours, a yardstick with a table of published quality, and the truth, side by side or below each other, with
//! maps of the differences.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use crate::canvas::{Align, Canvas, Colour, LINE};
use crate::differences::{SCALE, color, difference_colors};
use crate::picture::{srgb_from_linear, tone_map};
use arealight_benches::ladder::{Picture, Pictures, percent};
use glam::DVec3;

const PAPER: Colour = [255, 255, 255];
const INK: Colour = [28, 36, 48];
const GAP: i32 = 8;

/// Parts that are wider than this many times their height stand below each other.
const WIDE: u32 = 3;

/// A part of a picture, to be drawn.
struct Panel {
    caption: String,
    pixels: Vec<Colour>,
}

/// Pixels of a part of a picture.
fn cropped<T: Copy>(pixels: &[T], width: u32, [x, y, w, h]: [u32; 4]) -> Vec<T> {
    let rows = pixels.chunks(width.max(1) as usize).skip(y as usize).take(h as usize);
    rows.flat_map(|row| row.iter().skip(x as usize).take(w as usize).copied()).collect()
}

/// What a screen shows of reflected radiance, and of the lights themselves.
pub fn shown(pictures: &Pictures, reflected: &[DVec3], crop: [u32; 4]) -> Vec<Colour> {
    let all = pictures.emitted.iter().zip(reflected).map(|(emitted, reflected)| *emitted + *reflected);
    let colors: Vec<Colour> =
        all.map(|radiance| tone_map(radiance.as_vec3()).to_array().map(srgb_from_linear)).collect();
    cropped(&colors, pictures.size[0], crop)
}

/// The map of a method's differences from the truth; lights themselves are left out.
fn map(pictures: &Pictures, reflected: &[DVec3], crop: [u32; 4]) -> Vec<Colour> {
    let surfaces = |radiance: &[DVec3]| -> Vec<DVec3> {
        let all = radiance.iter().zip(&pictures.emitted);
        all.map(|(radiance, emitted)| if *emitted == DVec3::ZERO { *radiance } else { DVec3::ZERO }).collect()
    };
    let colors = difference_colors(&surfaces(reflected), &surfaces(&pictures.reference));
    cropped(&colors, pictures.size[0], crop)
}

/// The name under which a document's reader knows a method.
fn caption(picture: &Picture) -> String {
    let name = match picture.name.split_once(", published") {
        None => "Arealight",
        Some(("clip by cases", _)) => "16 cases, published quality",
        Some(_) => "sphere, published quality",
    };
    format!("{name}: {}", percent(picture.error.rmse))
}

/// Draws the strip.
pub fn draw(pictures: &Pictures, crop: [u32; 4]) -> Canvas {
    let [.., width, height] = crop;
    let panel = |caption: String, pixels| Panel { caption, pixels };
    let truth =
        panel(format!("truth, {} samples", pictures.samples), shown(pictures, &pictures.reference, crop));
    let methods: Vec<(Panel, Panel)> = pictures
        .shown
        .iter()
        .map(|picture| {
            let map = panel("difference from the truth".to_owned(), map(pictures, &picture.reflected, crop));
            (panel(caption(picture), shown(pictures, &picture.reflected, crop)), map)
        })
        .collect();
    let below = width > WIDE * height;
    let places = if below { stacked(methods, truth) } else { columns(methods, truth) };

    let (columns, rows) = places
        .iter()
        .fold((0, 0), |(columns, rows), (column, row, _)| (columns.max(column + 1), rows.max(row + 1)));
    let (width, height) = (width as i32, height as i32);
    let step = (width + GAP, height + LINE + GAP);
    let scale_height = if below { LINE + GAP } else { 0 };
    let size = (columns * step.0 + GAP, rows * step.1 + GAP + scale_height);
    let mut canvas = Canvas::new(size.0 as u32, size.1 as u32, PAPER);
    for (column, row, panel) in &places {
        let corner = (GAP + column * step.0, GAP + row * step.1);
        canvas.text(corner, &panel.caption, Align::Left, INK);
        canvas.rectangle((corner.0, corner.1 + LINE), (width, height), |x, y| {
            panel.pixels.get((y * width + x) as usize).copied().unwrap_or(PAPER)
        });
    }
    // The scale of the maps: in the free place below the truth, or below all
    let left = if below { GAP } else { GAP + (columns - 1) * step.0 };
    scale(&mut canvas, (left, if below { size.1 - LINE - GAP / 2 } else { GAP + step.1 }), width, below);
    canvas
}

/// Pictures above their maps, the truth at the end of the first row.
fn columns(methods: Vec<(Panel, Panel)>, truth: Panel) -> Vec<(i32, i32, Panel)> {
    let end = methods.len() as i32;
    let pairs = (0..).zip(methods);
    let mut places: Vec<_> =
        pairs.flat_map(|(column, (picture, map))| [(column, 0, picture), (column, 1, map)]).collect();
    places.push((end, 0, truth));
    places
}

/// Each picture, the truth between them, above the maps.
fn stacked(methods: Vec<(Panel, Panel)>, truth: Panel) -> Vec<(i32, i32, Panel)> {
    let (pictures, maps): (Vec<_>, Vec<_>) = methods.into_iter().unzip();
    let names: Vec<String> = pictures.iter().map(|picture: &Panel| picture.caption.clone()).collect();
    let maps = maps.into_iter().zip(names).map(|(map, name)| {
        let name = name.split(':').next().unwrap_or_default().to_owned();
        Panel { caption: format!("{name}, {}", map.caption), ..map }
    });
    let mut rows = pictures;
    rows.insert(1.min(rows.len()), truth);
    rows.extend(maps);
    (0..).zip(rows).map(|(row, panel)| (0, row, panel)).collect()
}

/// The colours of the maps, named at both ends.
fn scale(canvas: &mut Canvas, (x, y): (i32, i32), width: i32, in_line: bool) {
    let [low, high] = SCALE;
    let (bar_x, bar_y, bar) = if in_line { (x + 90, y + 3, width / 3) } else { (x, y + LINE, width) };
    let at = |along: i32| 10_f64.powf(low.log10() + (high / low).log10() * f64::from(along) / f64::from(bar));
    canvas.rectangle((bar_x, bar_y), (bar, LINE - 6), |along, _| color(at(along)));
    let [low, high] = [percent(low), format!("{} of the mean", percent(high))];
    let (y, left, right) = if in_line { (y, x, bar_x + bar + 6) } else { (y + 2 * LINE, x, x + bar) };
    let align = if in_line { Align::Left } else { Align::Right };
    canvas.text((left, y), &low, Align::Left, INK);
    canvas.text((right, y), &high, align, INK);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_picture_is_its_rows_and_columns() {
        let pixels: Vec<u32> = (0..12).collect();
        assert_eq!(cropped(&pixels, 4, [1, 1, 2, 2]), [5, 6, 9, 10]);
    }

    #[test]
    fn what_is_wide_stands_below_each_other() {
        let panel = |caption: &str| Panel { caption: caption.to_owned(), pixels: vec![] };
        let methods = || vec![(panel("a: 1 %"), panel("map")), (panel("b: 2 %"), panel("map"))];
        let places = stacked(methods(), panel("truth"));
        let captions: Vec<&str> = places.iter().map(|(_, _, panel)| panel.caption.as_str()).collect();
        assert_eq!(captions, ["a: 1 %", "truth", "b: 2 %", "a, map", "b, map"]);
        assert_eq!(columns(methods(), panel("truth")).last().map(|(x, y, _)| (*x, *y)), Some((2, 0)));
    }
}
