//! The frames of images that move: APNG and animated WebP.

use crate::document::Document;
use crate::error::SceneError;
use crate::scene::{Image, Scene};
use image::codecs::{png::PngDecoder, webp::WebPDecoder};
use image::{AnimationDecoder as _, Frames, ImageError, ImageFormat, Limits};
use std::io::Cursor;

/// Seconds that a frame is shown at least, also where the file has none.
const SHORTEST: f64 = 0.01;

/// The frames of an image whose first one is `still`, each until when it is shown; none where it does not
/// move. As much is decoded as the document may take.
pub(crate) fn frames(
    document: &Document,
    field: &str,
    (bytes, format, limits): (&[u8], ImageFormat, Limits),
    still: &Image,
) -> Result<Vec<(f64, Vec<u32>)>, SceneError> {
    let failed = |source| SceneError::Image { file: document.file.clone(), field: field.into(), source };
    let (mut shown, mut end) = (vec![], 0.0);
    let Some(frames) = decoded(bytes, format, limits).map_err(failed)? else { return Ok(shown) };
    for frame in frames {
        document.take(field, 4 * still.texels.len() as u64)?;
        let frame = frame.map_err(failed)?;
        let (milliseconds, parts) = frame.delay().numer_denom_ms();
        end += (f64::from(milliseconds) / f64::from(parts.max(1)) / 1e3).max(SHORTEST);
        let pixels = frame.into_buffer();
        if pixels.dimensions() != (still.width, still.height) {
            return Err(document.invalid(field, "its frames have not its size"));
        }
        shown.push((end, pixels.pixels().map(|p| u32::from_le_bytes(p.0)).collect()));
    }
    Ok(if shown.len() > 1 { shown } else { vec![] })
}

fn decoded(bytes: &[u8], format: ImageFormat, limits: Limits) -> Result<Option<Frames<'_>>, ImageError> {
    let bytes = Cursor::new(bytes);
    Ok(match format {
        ImageFormat::Png => {
            let decoder = PngDecoder::with_limits(bytes, limits)?;
            if decoder.is_apng()? { Some(decoder.apng()?.into_frames()) } else { None }
        }
        ImageFormat::WebP => {
            let decoder = WebPDecoder::new(bytes)?;
            decoder.has_animation().then(|| decoder.into_frames())
        }
        _ => None,
    })
}

impl Image {
    /// Which of its frames is shown at a time, in seconds: they repeat. None where it does not move.
    pub(crate) fn frame_at(&self, time: f64) -> Option<usize> {
        let (length, _) = self.frames.last()?;
        let time = time.rem_euclid(*length);
        Some(self.frames.iter().position(|(end, _)| time < *end).unwrap_or_default())
    }

    /// Shows the frame of a time.
    pub(crate) fn show(&mut self, time: f64) {
        if let Some(frame) = self.frame_at(time) {
            self.texels.clone_from(&self.frames[frame].1);
        }
    }
}

impl Scene {
    /// Which frame each of its images shows at a time, in seconds; none of those that do not move.
    pub fn frames_at(&self, time: f64) -> Vec<Option<usize>> {
        self.images.iter().map(|image| image.frame_at(time)).collect()
    }

    /// Whether an image moves.
    pub fn has_moving_images(&self) -> bool {
        self.images.iter().any(|image| !image.frames.is_empty())
    }

    /// Shows those frames.
    pub fn show_frames(&mut self, time: f64) {
        self.images.iter_mut().for_each(|image| image.show(time));
    }
}
