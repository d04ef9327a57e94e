//! Which part of an image becomes a layer of the light textures, and how it is sampled.

use crate::gpu::TextureLoadConstants;
use crate::pyramid::PyramidSize;
use crate::texture_error::{self, TextureError};
use crate::{Light, LightShape};
use glam::{DVec2, IVec2};

/// What texture coordinates beyond 0 to 1 read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image again, every other one mirrored.
    Mirror,
    /// The image's edge.
    Clamp,
}

/// The part of an image that a layer shows: the whole, a piece, or many repeats.
///
/// It is resampled to the layer's size by a tent two texels wide, of the image's or of the layer's, whichever
/// are larger: a copy where they are equal, bilinear where the layer has more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexturePart {
    /// The texture coordinates of the image that the layer shows at (0, 0), the outer corner of its first
    /// texel.
    pub low: DVec2,
    /// What is added to them at (1, 1). Positive.
    pub size: DVec2,
    /// What the image is beyond 0 to 1, along u and v.
    pub wrap: [Wrap; 2],
    /// What texels are divided by, where they are brighter or dimmer than half floats hold well (6e-5 to
    /// 65,504): [`TexturePart::divisor_of`]. The radiance of the lights that show the layer is to be
    /// multiplied by it. From 1e-30 to 1e30.
    pub divisor: f32,
    /// How many times as wide as high the light is that shows the layer, as texture coordinates run over it:
    /// what is seen of it is blurred evenly on the light. From 1/1024 to 1024.
    pub aspect: f32,
    /// A disk or ellipse shows it, which touches the layer's edges: what is beyond counts nothing.
    pub is_ellipse: bool,
}

impl Default for TexturePart {
    /// The whole image.
    fn default() -> Self {
        Self {
            low: DVec2::ZERO,
            size: DVec2::ONE,
            wrap: [Wrap::Clamp; 2],
            divisor: 1.0,
            aspect: 1.0,
            is_ellipse: false,
        }
    }
}

/// Nearer to a whole texel than this is on it.
const WHOLE: f64 = 1e-6;

impl TexturePart {
    /// The largest width and height of an image.
    pub const LARGEST_SOURCE: u32 = texture_error::LARGEST_SOURCE;
    /// The most repeats that `low` may be away.
    pub const FARTHEST: f64 = texture_error::FARTHEST;
    /// The most texels of the image, repeats included, that a part may cover along an axis.
    pub const MOST_TEXELS: f64 = texture_error::MOST_TEXELS;

    /// A divisor for an image whose brightest channel is this: it makes the most of half floats, which then
    /// hold texels of a billionth of the brightest to a thousandth. 1 for what is no brightness.
    pub fn divisor_of(brightest: f32) -> f32 {
        let divisor = brightest / 32768.0;
        if texture_error::DIVISORS.contains(&divisor) { divisor } else { 1.0 }
    }

    /// The same for a light that shows it: its aspect, and whether it is an ellipse. The part as it was where
    /// the light shows nothing.
    #[must_use]
    pub fn shown_by(self, light: &Light) -> Self {
        let map = light.texture.as_ref().and_then(|texture| texture.map(&light.shape).ok());
        let Some(map) = map.filter(|map| map.aspect().is_finite()) else { return self };
        let (least, most) = (*texture_error::ASPECTS.start(), *texture_error::ASPECTS.end());
        let is_ellipse = matches!(light.shape, LightShape::Disk { .. });
        Self { aspect: (map.aspect() as f32).clamp(least, most), is_ellipse, ..self }
    }

    /// The push constants that load the part of an image of `source` texels into `layer` of textures of
    /// `size`. `decode` tells that the image holds sRGB in a format that does not decode by itself.
    ///
    /// # Errors
    /// [`TextureError`] where the image or the part is empty, too large, or not a number.
    pub fn load_constants(
        &self,
        source: [u32; 2],
        size: PyramidSize,
        layer: u32,
        decode: bool,
    ) -> Result<TextureLoadConstants, TextureError> {
        let [width, height] = source;
        if !source.iter().all(|side| (1..=Self::LARGEST_SOURCE).contains(side)) {
            return Err(TextureError::Source { width, height });
        }
        if !(self.low.is_finite() && self.low.abs().max_element() <= Self::FARTHEST) {
            return Err(TextureError::Low { low: self.low });
        }
        let texels = DVec2::new(width.into(), height.into());
        let covered = self.size * texels;
        if !(covered.is_finite() && covered.min_element() > 0.0 && covered.max_element() <= Self::MOST_TEXELS)
        {
            return Err(TextureError::Size { size: self.size, width, height });
        }
        if !texture_error::DIVISORS.contains(&self.divisor) {
            return Err(TextureError::Divisor { divisor: self.divisor });
        }
        if !texture_error::ASPECTS.contains(&self.aspect) {
            return Err(TextureError::Aspect { aspect: self.aspect });
        }

        // From one texel of the layer to the next, and the first, from the middle of texel 0
        let stride = covered / f64::from(size.side(0));
        let mut first = self.low * texels + 0.5 * stride - 0.5;
        // A repeated image begins within its first repeat, so that the kernel's numbers are small
        for axis in 0..2 {
            let period = match self.wrap[axis] {
                Wrap::Clamp => continue,
                Wrap::Repeat => texels[axis],
                Wrap::Mirror => 2.0 * texels[axis],
            };
            first[axis] = first[axis].rem_euclid(period);
        }
        let clamp = [TextureLoadConstants::CLAMP_U, TextureLoadConstants::CLAMP_V];
        let mirror = [TextureLoadConstants::MIRROR_U, TextureLoadConstants::MIRROR_V];
        let wrap = [0, 1].map(|axis| match self.wrap[axis] {
            Wrap::Clamp => clamp[axis],
            Wrap::Repeat => 0,
            Wrap::Mirror => mirror[axis],
        });
        let srgb = if decode { TextureLoadConstants::SRGB } else { 0 };
        // What rounds to a whole texel is one, so that a copy is told by it
        let nearest = first.round();
        first = DVec2::select((first - nearest).abs().cmplt(DVec2::splat(WHOLE)), nearest, first);
        let first_texel: IVec2 = first.floor().as_ivec2();
        Ok(TextureLoadConstants {
            first_texel: first_texel.to_array(),
            first_offset: (first - first.floor()).as_vec2().to_array(),
            stride: stride.as_vec2().to_array(),
            flags: srgb | wrap[0] | wrap[1],
            layer,
            factor: self.divisor.recip(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constants(part: TexturePart, source: [u32; 2]) -> Result<TextureLoadConstants, TextureError> {
        part.load_constants(source, PyramidSize::new(128).unwrap(), 3, false)
    }

    #[test]
    fn an_image_of_the_layers_size_is_copied() {
        let whole = constants(TexturePart::default(), [128, 128]).unwrap();
        assert_eq!((whole.first_texel, whole.first_offset, whole.stride), ([0, 0], [0.0, 0.0], [1.0, 1.0]));
        assert_eq!(
            (whole.layer, whole.flags),
            (3, TextureLoadConstants::CLAMP_U | TextureLoadConstants::CLAMP_V)
        );
        // So is a piece of that size, whatever the whole
        let low = DVec2::new(22.0 / 300.0, 5.0 / 177.0);
        let size = DVec2::new(128.0 / 300.0, 128.0 / 177.0);
        let piece = constants(TexturePart { low, size, ..TexturePart::default() }, [300, 177]).unwrap();
        assert_eq!((piece.first_texel, piece.first_offset, piece.stride), ([22, 5], [0.0, 0.0], [1.0, 1.0]));
        let larger = constants(TexturePart::default(), [100, 128]).unwrap();
        assert_eq!(larger.steps(), TextureLoadConstants::RESAMPLE);
    }

    #[test]
    fn a_repeated_image_is_read_from_its_first_repeat_on() {
        for (wrap, repeats) in [(Wrap::Repeat, 1), (Wrap::Mirror, 2)] {
            for (low, size, source) in
                [(-0.5, 1.0, 7), (-4096.0, 3.0, 100), (17.3, 16384.0, 1), (0.0, 0.01, 4096)]
            {
                let (low, size) = (DVec2::splat(low), DVec2::splat(size));
                let part = TexturePart { low, size, wrap: [wrap; 2], ..TexturePart::default() };
                let found = constants(part, [source; 2]).unwrap();
                // A whole period where the first texel is rounded to it
                let within = 0..=source.cast_signed() * repeats;
                assert!(found.first_texel.iter().all(|texel| within.contains(texel)), "{found:?}");
            }
        }
    }

    #[test]
    fn every_brightness_has_a_divisor() {
        for brightest in [1e-20, 1e-6, 1.0, 65504.0, 1e6, 1e30, f32::MAX, 0.0, -1.0, f32::NAN, f32::INFINITY]
        {
            let divisor = TexturePart::divisor_of(brightest);
            assert!(divisor == 1.0 || (brightest / divisor - 32768.0).abs() < 1.0, "{brightest}: {divisor}");
            assert!(constants(TexturePart { divisor, ..TexturePart::default() }, [4, 4]).is_ok());
        }
    }

    #[test]
    fn what_cannot_be_loaded_is_named() {
        let part = TexturePart::default();
        assert_eq!(constants(part, [0, 4]), Err(TextureError::Source { width: 0, height: 4 }));
        assert_eq!(constants(part, [4, 4097]), Err(TextureError::Source { width: 4, height: 4097 }));
        for low in [DVec2::new(0.0, f64::NAN), DVec2::new(1e9, 0.0), DVec2::splat(f64::INFINITY)] {
            let error = constants(TexturePart { low, ..part }, [4, 4]);
            assert!(matches!(error, Err(TextureError::Low { .. })), "{error:?}");
        }
        for size in [DVec2::ZERO, DVec2::new(1.0, -1.0), DVec2::new(f64::NAN, 1.0), DVec2::splat(5000.0)] {
            let error = constants(TexturePart { size, ..part }, [4, 4]).unwrap_err();
            assert!(error.to_string().contains("of 4 x 4 texels"), "{error}");
        }
        for divisor in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e31] {
            let error = constants(TexturePart { divisor, ..part }, [4, 4]).unwrap_err();
            assert!(error.to_string().starts_with("divisor: "), "{error}");
        }
        for aspect in [0.0, -1.0, f32::NAN, f32::INFINITY, 1025.0] {
            let error = constants(TexturePart { aspect, ..part }, [4, 4]).unwrap_err();
            assert!(error.to_string().starts_with("aspect: "), "{error}");
        }
    }
}
