//! Pictures as an animated GIF of one palette.

use crate::canvas::Canvas;
use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;

/// Colours of the palette; one more says that a pixel is as it was.
const COLORS: usize = 127;

/// Pictures of one size, each shown for `delay` hundredths of a second, again and again. Pixels that stay as they were are transparent, which is
/// what keeps the file small.
///
/// # Errors
/// [`EncodingError`] where a side is above 65,535 pixels.
pub fn encode(frames: &[Canvas], delay: u16) -> Result<Vec<u8>, EncodingError> {
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
            delay,
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
