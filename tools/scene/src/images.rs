//! Textures and their images.

use crate::document::Document;
use crate::error::SceneError;
use crate::moving;
use crate::scene::{Image, Texture, Wrap};
use glam::{DVec2, DVec3};
use gltf::json;
use gltf::json::texture::WrappingMode;
use image::{DynamicImage, ImageDecoder as _};
use std::io::Cursor;
use std::sync::LazyLock;

/// The widest and highest image that is decoded.
const MAX_SIDE: u32 = 16384;

/// The most texels a scene's images may have in all: one gibibyte.
const MAX_TEXELS: u64 = 1 << 28;

/// A scene's textures, and the images that they are of.
#[derive(Default)]
pub(crate) struct Textures {
    /// [`crate::Scene::textures`].
    pub textures: Vec<Texture>,
    /// [`crate::Scene::images`].
    pub images: Vec<Image>,
}

impl Textures {
    /// A texture, and the image that it reads.
    pub fn get(&self, texture: u32) -> (&Image, Texture) {
        let texture = self.textures[texture as usize];
        (&self.images[texture.image as usize], texture)
    }
}

/// Reads those of a file's textures that are used.
pub(crate) struct TextureReader<'a> {
    document: &'a Document,
    /// Those read so far.
    pub read: Textures,
    /// The scene's index of each of the file's images that has been used.
    images: Vec<Option<u32>>,
}

impl<'a> TextureReader<'a> {
    pub fn new(document: &'a Document) -> Self {
        Self { document, read: Textures::default(), images: vec![None; document.root.images.len()] }
    }

    /// The scene's index of the file's texture `index`, read as sRGB or as it is.
    pub fn texture(&mut self, index: usize, srgb: bool) -> Result<u32, SceneError> {
        let root = &self.document.root;
        let texture = root.textures.get(index);
        let missing = || self.document.invalid(format!("textures[{index}]"), "does not exist");
        let texture = texture.ok_or_else(missing)?;
        let sampler = texture.sampler.and_then(|s| root.samplers.get(s.value()));
        let [wrap_u, wrap_v] = sampler.map_or([Wrap::Repeat; 2], |s| [wrap(s.wrap_s), wrap(s.wrap_t)]);
        let image = self.image(texture.source.value())?;
        let texture = Texture { image, srgb, wrap_u, wrap_v };
        // Materials often share a texture
        let textures = &mut self.read.textures;
        let known = textures.iter().position(|t| *t == texture);
        Ok(known.unwrap_or_else(|| {
            textures.push(texture);
            textures.len() - 1
        }) as u32)
    }

    /// The scene's index of the file's image `index`; decoded the first time.
    fn image(&mut self, index: usize) -> Result<u32, SceneError> {
        if let Some(Some(known)) = self.images.get(index) {
            return Ok(*known);
        }
        let others = self.read.images.iter().map(|image| image.texels.len() as u64).sum();
        self.read.images.push(decode(self.document, index, others)?);
        let known = self.read.images.len() as u32 - 1;
        self.images[index] = Some(known);
        Ok(known)
    }
}

fn wrap(mode: json::validation::Checked<WrappingMode>) -> Wrap {
    match mode {
        json::validation::Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        json::validation::Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// The file's image `index`, where a scene has `others` texels already.
fn decode(document: &Document, index: usize, others: u64) -> Result<Image, SceneError> {
    let field = format!("images[{index}]");
    let entry = document.root.images.get(index);
    let entry = entry.ok_or_else(|| document.invalid(&field, "does not exist"))?;
    // Find the encoded bytes
    let bytes = match (&entry.uri, entry.buffer_view) {
        (Some(uri), _) => document.resource(&field, uri)?,
        (None, Some(view)) => document.view(view.value())?.0.to_vec(),
        (None, None) => return Err(document.invalid(field, "has neither a URI nor a buffer view")),
    };
    // Decode them by what they are, whatever the file calls them
    let failed = |source| SceneError::Image { file: document.file.clone(), field: field.clone(), source };
    let format = image::guess_format(&bytes).map_err(failed)?;
    if !matches!(format, image::ImageFormat::Png | image::ImageFormat::Jpeg | image::ImageFormat::WebP) {
        return Err(document.invalid(field, format!("is {format:?}, must be PNG, JPEG or WebP")));
    }
    let mut reader = image::ImageReader::with_format(Cursor::new(&bytes), format);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(document.budget.left());
    reader.limits(limits.clone());
    let decoder = reader.into_decoder().map_err(failed)?;
    // Refuse more than a scene may have by what the header says, before memory is taken
    let (width, height) = decoder.dimensions();
    let total = others + u64::from(width) * u64::from(height);
    if total > MAX_TEXELS {
        return Err(document.too_large("texels of all images", total, MAX_TEXELS));
    }
    // Twice while it is decoded
    let size = 4 * (total - others);
    document.take(&field, 2 * size)?;
    let pixels = DynamicImage::from_decoder(decoder).map_err(failed)?.into_rgba8();
    let mut image = Image {
        name: entry.name.clone().unwrap_or_else(|| field.clone()),
        width: pixels.width(),
        height: pixels.height(),
        texels: pixels.pixels().map(|p| u32::from_le_bytes(p.0)).collect(),
        frames: vec![],
    };
    image.frames = moving::frames(document, &field, (&bytes, format, limits), &image)?;
    image.show(document.time);
    document.budget.give(size);
    Ok(image)
}

/// The mean of an sRGB image's linear colours.
pub(crate) fn linear_mean(image: &Image) -> DVec3 {
    let linear = decoded(true);
    let sum = image.texels.iter().fold(DVec3::ZERO, |sum, texel| {
        let [r, g, b, _] = texel.to_le_bytes().map(|byte| linear[usize::from(byte)]);
        sum + DVec3::new(r, g, b)
    });
    sum / image.texels.len().max(1) as f64
}

/// What each byte of a channel is.
fn decoded(srgb: bool) -> [f64; 256] {
    std::array::from_fn(|byte| {
        let value = byte as f64 / 255.0;
        if srgb { srgb_to_linear(value) } else { value }
    })
}

/// The bytes of sRGB that linear light is nearest to, in steps of a 65535th.
static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    (0..=u16::MAX).map(|step| (linear_to_srgb(f64::from(step) / 65535.0) * 255.0).round() as u8).collect()
});

/// The image with half the texels a side, rounded down but not to zero; each is the mean of linear light, and
/// of alpha, over two by two.
pub(crate) fn halved(image: &Image, srgb: bool) -> Image {
    let linear = decoded(srgb);
    let encode = |linear: f64| {
        let byte = |value: f64| (value * 255.0).round() as u8;
        if srgb { ENCODED[(linear * 65535.0).round() as usize] } else { byte(linear) }
    };
    halved_by(image, |texels| {
        let texels = texels.map(u32::to_le_bytes);
        let color = |channel: usize| {
            encode(texels.iter().map(|texel| linear[usize::from(texel[channel])]).sum::<f64>() / 4.0)
        };
        let alpha = texels.iter().map(|texel| u32::from(texel[3])).sum::<u32>().div_ceil(4) as u8;
        u32::from_le_bytes([color(0), color(1), color(2), alpha])
    })
}

/// The same by any mean of two by two texels.
pub(crate) fn halved_by(image: &Image, mean: impl Fn([u32; 4]) -> u32) -> Image {
    let [width, height] = [image.width, image.height].map(|side| (side / 2).max(1));
    let near = |x: u32, y: u32| {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
            let (x, y) = ((2 * x + dx).min(image.width - 1), (2 * y + dy).min(image.height - 1));
            image.texels[y as usize * image.width as usize + x as usize]
        })
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(near(x, y)));
    let (name, texels) = (format!("{}, smaller", image.name), texels.collect());
    Image { name, width, height, texels, frames: vec![] }
}

/// The linear colour of `image`, read by `texture`, at finite coordinates; bilinear, decoded before it is
/// filtered.
pub(crate) fn sample(image: &Image, texture: Texture, uv: DVec2) -> DVec3 {
    let size = DVec2::new(f64::from(image.width), f64::from(image.height));
    let position = uv * size - 0.5;
    let (node, weight) = (position.floor(), position - position.floor());
    let texel = |x: f64, y: f64| {
        let x = wrapped(node.x + x, image.width, texture.wrap_u);
        let y = wrapped(node.y + y, image.height, texture.wrap_v);
        let bytes = image.texels[y * image.width as usize + x].to_le_bytes();
        let [r, g, b, _] = bytes.map(|byte| f64::from(byte) / 255.0);
        let decode = |x: f64| if texture.srgb { srgb_to_linear(x) } else { x };
        DVec3::new(decode(r), decode(g), decode(b))
    };
    let top = texel(0.0, 0.0).lerp(texel(1.0, 0.0), weight.x);
    let bottom = texel(0.0, 1.0).lerp(texel(1.0, 1.0), weight.x);
    top.lerp(bottom, weight.y)
}

/// The texel that is read at a whole number, which may be outside of the image.
fn wrapped(texel: f64, side: u32, wrap: Wrap) -> usize {
    let (side, last) = (f64::from(side), f64::from(side - 1));
    let inside = match wrap {
        Wrap::Clamp => texel,
        Wrap::Repeat => texel.rem_euclid(side),
        Wrap::Mirror => {
            let along = texel.rem_euclid(2.0 * side);
            along.min(2.0 * side - 1.0 - along)
        }
    };
    inside.clamp(0.0, last) as usize
}

/// The decoding of IEC 61966-2-1.
fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The encoding of IEC 61966-2-1.
fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_of_linear_values() {
        let texels = vec![u32::from_le_bytes([255, 0, 0, 255]), u32::from_le_bytes([0, 188, 0, 255])];
        let image = Image { width: 2, height: 1, texels, ..Image::default() };
        let mean = linear_mean(&image);
        // sRGB 188 of 255 is 0.503 linear; as encoded values the mean of green would be 0.37
        assert!((mean - DVec3::new(0.5, 0.2514, 0.0)).length() < 1e-3, "{mean}");
    }

    #[test]
    fn half_an_image_keeps_its_light() {
        let texel = |v: u8, a: u8| u32::from_le_bytes([v, 0, 255, a]);
        // Two by two and a column more, which is left out
        let texels = vec![texel(255, 0), texel(0, 4), texel(9, 9), texel(0, 8), texel(255, 0), texel(9, 9)];
        let image = Image { width: 3, height: 2, texels, ..Image::default() };
        let small = halved(&image, true);
        assert_eq!((small.width, small.height, &small.texels[..]), (1, 1, &[texel(188, 3)][..]));
        // The twin: of values that are not sRGB, and of what is one texel already
        assert_eq!(halved(&image, false).texels, [texel(128, 3)]);
        assert_eq!(halved(&small, true).texels, small.texels);
    }

    #[test]
    fn samples_wrap_and_are_bilinear() {
        // Texels of 0, 0.2, 0.4, 0.6 side by side, not sRGB
        let texels = [0_u8, 51, 102, 153].map(|v| u32::from_le_bytes([v, 0, 0, 255])).to_vec();
        let image = Image { width: 4, height: 1, texels, ..Image::default() };
        let at = |wrap, u: f64| {
            let texture = Texture { image: 0, srgb: false, wrap_u: wrap, wrap_v: Wrap::Repeat };
            (sample(&image, texture, DVec2::new(u, 0.3)).x * 1e6).round() / 1e6
        };
        assert_eq!([0.125, 0.25, 0.375].map(|u| at(Wrap::Repeat, u)), [0.0, 0.1, 0.2]);
        // At the left edge: between the last and the first, of the first, of the first and its mirror image
        let edge = |wrap| [0.0, -0.125, 1.125, -1.0e6].map(|u| at(wrap, u));
        assert_eq!(edge(Wrap::Repeat), [0.3, 0.6, 0.0, 0.3]);
        assert_eq!(edge(Wrap::Clamp), [0.0, 0.0, 0.6, 0.0]);
        assert_eq!(edge(Wrap::Mirror), [0.0, 0.0, 0.6, 0.0]);
        assert_eq!([-0.375, 1.375, 2.125].map(|u| at(Wrap::Mirror, u)), [0.2, 0.4, 0.0]);
    }
}
