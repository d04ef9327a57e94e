//! Small images within a page: what methods make of a scene, and how far that is from the reference.

use crate::differences::difference_colors;
use crate::failure::Failure;
use crate::picture::{srgb_from_linear, tone_map};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DVec3, Vec3};
use image::{ExtendedColorType, ImageEncoder};
use std::path::Path;

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
