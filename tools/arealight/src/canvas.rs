//! A picture to draw on: filled shapes and text, in sRGB bytes.

#![expect(clippy::cast_possible_wrap, reason = "pictures are far smaller than 2^31 pixels")]

use crate::failure::Failure;
use crate::output;
use image::{ExtendedColorType, ImageEncoder, codecs::png};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use std::path::Path;

/// An sRGB colour.
pub type Colour = [u8; 3];

/// Where the text's place is within it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Left,
    Right,
}

/// The height of a line of text.
pub const LINE: i32 = 16;

/// A picture; what is drawn outside it is lost.
pub struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Canvas {
    /// An empty picture.
    pub fn new(width: u32, height: u32, colour: Colour) -> Self {
        Self { width, height, pixels: colour.repeat((width * height) as usize) }
    }

    /// A picture of bytes: red, green, blue, row after row from the top. What is missing is black.
    pub fn of_pixels(width: u32, height: u32, mut pixels: Vec<u8>) -> Self {
        pixels.resize(3 * width as usize * height as usize, 0);
        Self { width, height, pixels }
    }

    /// Blends `colour` over a pixel; `coverage` in [0, 1].
    pub fn blend(&mut self, x: i32, y: i32, colour: Colour, coverage: f64) {
        let is_inside = (0..self.width as i32).contains(&x) && (0..self.height as i32).contains(&y);
        if is_inside {
            let at = 3 * (y as usize * self.width as usize + x as usize);
            for (old, new) in self.pixels[at..at + 3].iter_mut().zip(colour) {
                let mixed = f64::from(*old) + (f64::from(new) - f64::from(*old)) * coverage.clamp(0.0, 1.0);
                *old = mixed.round() as u8;
            }
        }
    }

    /// Fills a rectangle with the colours of a function of the place within it, in pixels.
    pub fn rectangle(&mut self, corner: (i32, i32), size: (i32, i32), colour: impl Fn(i32, i32) -> Colour) {
        for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
            self.blend(corner.0 + x, corner.1 + y, colour(x, y), 1.0);
        }
    }

    /// Writes a line of text whose top is at `y`. A character that the font lacks becomes a question mark.
    pub fn text(&mut self, (x, y): (i32, i32), text: &str, align: Align, colour: Colour) {
        write_line(text, align, |along, down, coverage| {
            self.blend(x + along, y + down, colour, coverage);
        });
    }

    /// The picture in a larger size, by its nearest pixels.
    #[must_use]
    pub fn enlarged(self, [width, height]: [u32; 2]) -> Self {
        if self.size() == [width, height] {
            return self;
        }
        let nearest =
            |at: u32, from: u32, to: u32| (u64::from(at) * u64::from(from) / u64::from(to)) as usize;
        let rows = (0..height).map(|y| nearest(y, self.height, height) * self.width as usize);
        let places = rows.flat_map(|row| (0..width).map(move |x| row + nearest(x, self.width, width)));
        let pixels = places.flat_map(|place| [0, 1, 2].map(|channel| self.pixels[3 * place + channel]));
        Self { width, height, pixels: pixels.collect() }
    }

    /// Width and height.
    pub const fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The pixels' bytes: red, green, blue, row after row from the top.
    pub fn bytes(&self) -> &[u8] {
        &self.pixels
    }

    /// Writes a PNG.
    ///
    /// # Errors
    /// [`Failure::Output`] if the file cannot be written.
    pub fn save_png(&self, path: &Path) -> Result<(), Failure> {
        let mut bytes = Vec::new();
        png::PngEncoder::new_with_quality(&mut bytes, png::CompressionType::Best, png::FilterType::NoFilter)
            .write_image(&self.pixels, self.width, self.height, ExtendedColorType::Rgb8)
            .map_err(|error| Failure::output(path, error))?;
        output::write(path, &bytes)
    }
}

/// Calls `dot` with the pixels of a line of text: how far along the line and below its top, and the coverage.
fn write_line(text: &str, align: Align, mut dot: impl FnMut(i32, i32, f64)) {
    let advance = get_raster_width(FontWeight::Regular, RasterHeight::Size16) as i32;
    let width = advance * text.chars().count() as i32;
    let mut left = match align {
        Align::Left => 0,
        Align::Right => -width,
    };
    for character in text.chars() {
        let glyph = |c| get_raster(c, FontWeight::Regular, RasterHeight::Size16);
        if let Some(glyph) = glyph(character).or_else(|| glyph('?')) {
            for (down, row) in glyph.rows().enumerate() {
                for (along, coverage) in row.iter().enumerate() {
                    dot(left + along as i32, down as i32, f64::from(*coverage) / 255.0);
                }
            }
        }
        left += advance;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_comes_back_from_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut canvas = Canvas::new(40, 30, [255; 3]);
        canvas.rectangle((5, 5), (20, 20), |x, _| if x < 10 { [255, 0, 0] } else { [0, 0, 255] });
        canvas.save_png(&path).unwrap();
        let picture = image::open(&path).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (40, 30));
        assert_eq!(picture.get_pixel(12, 15).0, [255, 0, 0]);
        assert_eq!(picture.get_pixel(18, 15).0, [0, 0, 255]);
        assert_eq!(picture.get_pixel(38, 2).0, [255; 3]);
    }

    #[test]
    fn pixels_are_enlarged_to_blocks() {
        let small = Canvas::of_pixels(2, 1, vec![1, 2, 3, 4, 5, 6]);
        let large = small.enlarged([4, 2]);
        assert_eq!(large.size(), [4, 2]);
        assert_eq!(large.bytes()[..12], [1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6]);
        assert_eq!(large.bytes()[12..], large.bytes()[..12]);
    }

    #[test]
    fn what_is_outside_is_lost() {
        let mut canvas = Canvas::new(8, 8, [0; 3]);
        canvas.text((-100, 3), "outside", Align::Right, [255; 3]);
        canvas.rectangle((-2, -2), (4, 4), |_, _| [9; 3]);
        canvas.rectangle((6, 6), (5, 5), |_, _| [7; 3]);
        assert_eq!(canvas.pixels[..3], [9; 3]);
        assert_eq!(canvas.pixels[canvas.pixels.len() - 3..], [7; 3]);
    }

    #[test]
    fn text_is_as_wide_as_its_alignment_says() {
        let columns = |align| {
            let mut canvas = Canvas::new(60, 20, [0; 3]);
            canvas.text((30, 2), "75°\u{4e00}", align, [255; 3]);
            let lit = |x: &u32| (0..20).any(|y| canvas.pixels[3 * (y * 60 + *x as usize)] > 0);
            let all: Vec<u32> = (0..60).filter(lit).collect();
            (all[0], all[all.len() - 1])
        };
        assert!(columns(Align::Left).0 >= 30 && columns(Align::Right).1 < 30);
    }
}
