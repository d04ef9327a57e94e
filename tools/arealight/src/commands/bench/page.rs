//! What the report shows: one page that needs nothing else.

use crate::differences::{self, difference_colors};
use crate::failure::Failure;
use crate::picture::{srgb_from_linear, tone_map};
use arealight_benches::ladder::{Ladder, Picture, Pictures};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DVec3, Vec3};
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};
use std::path::Path;

/// The numbers, the tables, and small images: what methods make of a scene, and how far that is from the
/// reference.
///
/// # Errors
/// [`Failure::Output`] where a picture cannot be encoded.
pub fn found(ladder: &Ladder, pictures: &Pictures) -> Result<Value, Failure> {
    // Strings and numbers, with strings for keys, always serialise
    let mut found = serde_json::to_value(ladder).unwrap_or_default();
    found["legend"] = ladder.legend().into();
    found["markdown"] = ladder.to_markdown().into();
    found["pictures"] = shown(pictures)?;
    Ok(found)
}

fn shown(pictures: &Pictures) -> Result<Value, Failure> {
    let Pictures { scene, lights, size, emitted, reference, samples, shown } = pictures;
    let whole = |reflected: &[DVec3]| {
        picture(*size, emitted.iter().zip(reflected).map(|(emitted, reflected)| *emitted + *reflected))
    };
    // A light itself does not matter for shading
    let without_lights = |radiance: &[DVec3]| -> Vec<DVec3> {
        let all = radiance.iter().zip(emitted);
        all.map(|(radiance, emitted)| if *emitted == DVec3::ZERO { *radiance } else { DVec3::ZERO }).collect()
    };
    let truth = without_lights(reference);
    let shown = shown.iter().map(|Picture { name, reflected, error, milliseconds }| {
        let colors = difference_colors(&without_lights(reflected), &truth);
        Ok(json!({
            "name": name,
            "image": whole(reflected)?,
            "map": address(*size, colors.as_flattened())?,
            "error": { "rmse": error.rmse, "range": error.range, "not_finite": error.not_finite },
            "milliseconds": milliseconds,
        }))
    });
    Ok(json!({
        "scene": scene,
        "lights": lights,
        "samples": samples,
        "scale": differences::SCALE,
        "gradient": differences::gradient(),
        "reference": whole(reference)?,
        "shown": shown.collect::<Result<Value, Failure>>()?,
    }))
}

/// Radiance as a picture: the address of a PNG that is all in the address.
fn picture(size: [u32; 2], pixels: impl Iterator<Item = DVec3>) -> Result<String, Failure> {
    let bytes = pixels.flat_map(|pixel| {
        let pixel: Vec3 = tone_map(pixel.as_vec3());
        pixel.to_array().map(srgb_from_linear)
    });
    address(size, &bytes.collect::<Vec<u8>>())
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
