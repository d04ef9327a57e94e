//! Textures and their images.

use crate::load::Loader;
use crate::{Image, SceneError, Texture, Wrap};
use gltf::json;
use gltf::json::texture::WrappingMode;
use std::io::Cursor;

/// The widest and highest image that is decoded.
const MAX_SIDE: u32 = 16384;

/// The most texels a scene's images may have together: one gibibyte on the GPU.
const MAX_TEXELS: u64 = 1 << 28;

/// The scene's index of the file's texture `index`, read as sRGB or as it is.
pub(crate) fn resolve(loader: &mut Loader, index: usize, srgb: bool) -> Result<u32, SceneError> {
    let root = &loader.document.root;
    let texture = root.textures.get(index);
    let texture =
        texture.ok_or_else(|| loader.document.invalid(format!("textures[{index}]"), "does not exist"))?;
    let sampler = texture.sampler.and_then(|s| root.samplers.get(s.value()));
    let [wrap_u, wrap_v] = sampler.map_or([Wrap::Repeat; 2], |s| [wrap(s.wrap_s), wrap(s.wrap_t)]);
    let image = decoded(loader, texture.source.value())?;
    let texture = Texture { image, srgb, wrap_u, wrap_v };
    // Materials often share a texture
    let textures = &mut loader.scene.textures;
    let known = textures.iter().position(|t| *t == texture);
    Ok(known.unwrap_or_else(|| {
        textures.push(texture);
        textures.len() - 1
    }) as u32)
}

fn wrap(mode: json::validation::Checked<WrappingMode>) -> Wrap {
    match mode {
        json::validation::Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        json::validation::Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// The scene's index of the file's image `index`; decoded the first time.
fn decoded(loader: &mut Loader, index: usize) -> Result<u32, SceneError> {
    let field = format!("images[{index}]");
    let document = &loader.document;
    let entry = document.root.images.get(index);
    let entry = entry.ok_or_else(|| document.invalid(&field, "does not exist"))?;
    if let Some(known) = loader.images[index] {
        return Ok(known);
    }
    // Find the encoded bytes
    let bytes = match (&entry.uri, entry.buffer_view) {
        (Some(uri), _) => document.resource(&field, uri)?,
        (None, Some(view)) => document.view(view.value())?.0.to_vec(),
        (None, None) => return Err(document.invalid(field, "has neither a URI nor a buffer view")),
    };
    // Decode them by what they are, whatever the file calls them
    let failed = |source| SceneError::Image { file: document.file.clone(), field: field.clone(), source };
    let format = image::guess_format(&bytes).map_err(failed)?;
    if !matches!(format, image::ImageFormat::Png | image::ImageFormat::Jpeg) {
        return Err(document.invalid(field, format!("is {format:?}, must be PNG or JPEG")));
    }
    let mut reader = image::ImageReader::with_format(Cursor::new(&bytes), format);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_TEXELS * 8);
    reader.limits(limits);
    let pixels = reader.decode().map_err(failed)?.into_rgba8();
    let image = Image {
        name: entry.name.clone().unwrap_or(field),
        width: pixels.width(),
        height: pixels.height(),
        texels: pixels.pixels().map(|p| u32::from_le_bytes(p.0)).collect(),
    };
    let total = loader.scene.images.iter().chain([&image]).map(|i| i.texels.len() as u64).sum();
    if total > MAX_TEXELS {
        return Err(document.too_large("texels of all images", total, MAX_TEXELS));
    }
    let known = loader.scene.images.len() as u32;
    loader.scene.images.push(image);
    loader.images[index] = Some(known);
    Ok(known)
}

/// The mean of an sRGB image's linear colours.
pub(crate) fn linear_mean(image: &Image) -> glam::Vec3 {
    let linear: Vec<f64> = (0..=255_u8).map(|byte| srgb_to_linear(f64::from(byte) / 255.0)).collect();
    let sum = image.texels.iter().fold(glam::DVec3::ZERO, |sum, texel| {
        let [r, g, b, _] = texel.to_le_bytes().map(|byte| linear[usize::from(byte)]);
        sum + glam::DVec3::new(r, g, b)
    });
    (sum / image.texels.len().max(1) as f64).as_vec3()
}

/// The decoding of IEC 61966-2-1.
fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_of_linear_values() {
        let texels = vec![u32::from_le_bytes([255, 0, 0, 255]), u32::from_le_bytes([0, 188, 0, 255])];
        let image = Image { name: String::new(), width: 2, height: 1, texels };
        let mean = linear_mean(&image);
        // sRGB 188 of 255 is 0.503 linear; as encoded values the mean of green would be 0.37
        assert!((mean - glam::Vec3::new(0.5, 0.2514, 0.0)).length() < 1e-3, "{mean}");
    }
}
