//! Small images within a page: what methods make of a scene, and how far that is from the reference.

use crate::failure::Failure;
use crate::picture::{srgb_from_linear, tone_map};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DVec3, Vec3};
use image::{ExtendedColorType, ImageEncoder};
use std::path::Path;

/// Colours of the map from the smallest difference to the largest, evenly spaced: dark blue, violet, red, orange, pale yellow.
const COLORS: [[u8; 3]; 6] =
    [[0, 0, 20], [50, 15, 110], [140, 35, 130], [220, 70, 85], [250, 150, 70], [252, 253, 190]];

/// Differences over the mean that the ends of the map stand for.
pub const SCALE: [f64; 2] = [1e-3, 1.0];

/// Steps of the map: its contours are legible, and noise below a step takes no bytes.
const STEPS: f64 = 18.0;

/// The colour of a difference over the mean.
pub fn color(difference: f64) -> [u8; 3] {
    // What is no number is as bad as can be
    let difference = if difference.is_nan() { SCALE[1] } else { difference.clamp(SCALE[0], SCALE[1]) };
    let [low, high] = SCALE.map(f64::log10);
    let place = ((difference.log10() - low) / (high - low)).clamp(0.0, 1.0);
    let place = (place * STEPS).round() / STEPS * (COLORS.len() - 1) as f64;
    let index = (place as usize).min(COLORS.len() - 2);
    let share = place - index as f64;
    std::array::from_fn(|i| {
        let [a, b] = [COLORS[index][i], COLORS[index + 1][i]].map(f64::from);
        (a + (b - a) * share).round() as u8
    })
}

/// The map's colours as a gradient of CSS.
pub fn gradient() -> String {
    let colors: Vec<String> = COLORS.iter().map(|[r, g, b]| format!("rgb({r} {g} {b})")).collect();
    format!("linear-gradient(to right, {})", colors.join(", "))
}

/// Radiance as a picture: the address of a PNG that is all in the address.
///
/// # Errors
/// [`Failure::Output`] where it cannot be encoded.
pub fn picture(size: [u32; 2], pixels: impl Iterator<Item = DVec3>) -> Result<String, Failure> {
    let bytes = pixels.flat_map(|pixel| {
        let pixel: Vec3 = tone_map(pixel.as_vec3());
        pixel.to_array().map(srgb_from_linear)
    });
    address(size, &bytes.collect::<Vec<u8>>())
}

/// Differences from a reference over its mean, in false colours.
///
/// # Errors
/// As [`picture`].
pub fn differences(size: [u32; 2], found: &[DVec3], reference: &[DVec3]) -> Result<String, Failure> {
    address(size, difference_colors(found, reference).as_flattened())
}

/// The colour of each pixel's difference from a reference over its mean.
pub fn difference_colors(found: &[DVec3], reference: &[DVec3]) -> Vec<[u8; 3]> {
    let mean =
        reference.iter().map(|pixel| pixel.element_sum()).sum::<f64>() / (3 * reference.len().max(1)) as f64;
    let pairs = found.iter().zip(reference);
    let color_of = |(found, expected): (&DVec3, &DVec3)| {
        let off = (*found - *expected).abs();
        color(if off.is_nan() { f64::NAN } else { off.max_element() / mean })
    };
    pairs.map(color_of).collect()
}

fn address(size: [u32; 2], rgb: &[u8]) -> Result<String, Failure> {
    let mut png = vec![];
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        &mut png,
        image::codecs::png::CompressionType::Best,
        image::codecs::png::FilterType::Adaptive,
    );
    encoder
        .write_image(rgb, size[0], size[1], ExtendedColorType::Rgb8)
        .map_err(|error| Failure::output(Path::new("picture of the report"), error))?;
    Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(&png)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_run_through_the_colours() {
        assert_eq!(color(0.0), COLORS[0]);
        assert_eq!(color(SCALE[0]), COLORS[0]);
        assert_eq!([color(1.0), color(7.0), color(f64::NAN)], [COLORS[5]; 3]);
        assert!(color(1e-1)[0] > color(1e-2)[0]);
    }
}
