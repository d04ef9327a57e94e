//! Pictures as an animated GIF of one palette.

use crate::canvas::Canvas;
use crate::failure::Failure;
use crate::output;
use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;
use std::path::Path;

/// How a film's colours become few.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Palette {
    /// Colours, at most 255; one more says that a pixel is as it was.
    pub colors: u8,
    /// The most that a channel is raised or lowered by a fixed pattern of 4 x 4 pixels, so that gradients
    /// have no bands. What stays as it was stays so.
    pub dither: i32,
}

/// The order in which a pattern's pixels are raised (Bayer 1973).
const PATTERN: [[i32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// A frame's pixels, raised and lowered by the pattern, as the palette's chooser takes them.
fn dithered(frame: &Canvas, dither: i32) -> Vec<u8> {
    let width = frame.size()[0] as usize;
    let pixels = frame.bytes().chunks_exact(3).enumerate();
    let raised = pixels.flat_map(|(index, rgb)| {
        let by = (2 * PATTERN[index / width % 4][index % width % 4] - 15) * dither / 15;
        let channel = |value: u8| (i32::from(value) + by).clamp(0, 255) as u8;
        [channel(rgb[0]), channel(rgb[1]), channel(rgb[2]), 255]
    });
    raised.collect()
}

/// Whether a .gif is of more than 2 GiB of pictures, which are all kept until the last, twice.
pub fn is_too_large(size: [u32; 2], count: u32) -> bool {
    size.map(u64::from).iter().product::<u64>() * 8 * u64::from(count) > 1 << 31
}

/// Writes pictures of one size, so many a second, with the most colours that there are.
pub fn save(path: &Path, frames: &[Canvas], rate: u32) -> Result<(), Failure> {
    let film = encode(frames, 100.0 / f64::from(rate.max(1)), Palette { colors: 255, dither: 6 });
    output::write(path, &film.map_err(|error| Failure::output(path, error))?)
}

/// Pictures of one size, each shown for `delay` hundredths of a second in the mean, again and again. Pixels
/// that stay as they were are transparent, which is what keeps the file small.
///
/// # Errors
/// [`EncodingError`] where a side is above 65,535 pixels.
pub fn encode(frames: &[Canvas], delay: f64, palette: Palette) -> Result<Vec<u8>, EncodingError> {
    let Palette { colors, dither } = palette;
    let pixels: Vec<u8> = frames.iter().flat_map(|frame| dithered(frame, dither)).collect();
    let quantizer = NeuQuant::new(10, colors.into(), &pixels);
    let mut palette = quantizer.color_map_rgb();
    palette.extend([0; 3]);

    let [width, height] = frames.first().map_or([0, 0], Canvas::size).map(|side| side as u16);
    let mut film = Vec::new();
    let mut encoder = Encoder::new(&mut film, width, height, &palette)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut before: Vec<u8> = vec![];
    let until = |frame: i32| (delay * f64::from(frame)).round();
    for (pixels, shown) in pixels.chunks(4 * usize::from(width) * usize::from(height)).zip(0..) {
        let indices: Vec<u8> = pixels.chunks_exact(4).map(|rgba| quantizer.index_of(rgba) as u8).collect();
        let previous = before.iter().map(Some).chain(std::iter::repeat(None));
        let changed: Vec<u8> = indices
            .iter()
            .zip(previous)
            .map(|(index, before)| if before == Some(index) { colors } else { *index })
            .collect();
        encoder.write_frame(&Frame {
            delay: (until(shown + 1) - until(shown)).max(1.0) as u16,
            dispose: DisposalMethod::Keep,
            transparent: Some(colors),
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

    #[test]
    fn a_dithered_gradient_keeps_its_mean_and_what_is_still_stays_so() {
        // A gradient of 32 steps with 8 colours: without the pattern it has 8 bands
        let mut frame = Canvas::new(64, 16, [0; 3]);
        frame.rectangle((0, 0), (64, 16), |x, _| [(x / 2 * 4) as u8 + 60; 3]);
        let still = dithered(&frame, 12);
        assert_eq!(still, dithered(&frame, 12));
        let mean = |column: usize| {
            let sum: u32 =
                (0..16).flat_map(|y| [0, 1].map(|x| u32::from(still[4 * (y * 64 + column + x)]))).sum();
            f64::from(sum) / 32.0
        };
        for column in (0..64).step_by(4) {
            assert!((mean(column) - f64::from(column as u32 / 2 * 4 + 60)).abs() < 4.0, "{column}");
        }
        assert_ne!(still, dithered(&frame, 0));
        let film = encode(&[frame], 1.0, Palette { colors: 8, dither: 12 }).unwrap();
        assert_eq!(&film[..6], b"GIF89a");
    }
}
