//! How an image on a light is stored: its mips, and what lobes of every width see of it.
//!
//! A light's image has four layers, one after the other, of one array image that all lights share, so that no
//! shader indexes an array of images: itself with plain mips, and A and B along its rows and columns, of
//! `shaders/include/arealight/textures/footprint.glsl`. In these the light fills the middle half of each
//! axis, and what is outside of it, to infinity, the quarters beside: level i is for points whose distance
//! from the light's plane is [`PyramidSize::height`].
//!
//! # Why so
//! - Three nodes a height: two err by a third more, six by a seventh less.
//! - Outside of the light both are smooth on the scale of the distance from it, so nodes go apart as they do:
//!   no level needs a margin, and levels are mips.
//! - All levels down to one texel: from afar the ratio is the image's mean.
//! - Level 0 of the image is sharp: a mirror shows it.

use crate::texture_error::{self, TextureError};

/// Layers of the array image that an image has.
pub const LAYERS: u32 = 4;

/// The height of level 0, in texels of the layer.
pub const FINEST_HEIGHT: f64 = 6.0;

/// The size of a light texture: as many texels wide as high, a power of two from [`PyramidSize::SMALLEST`]
/// to [`PyramidSize::LARGEST`].
///
/// Images of any other size and aspect are resampled when they are loaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PyramidSize {
    side: u32,
}

impl PyramidSize {
    /// The smallest side.
    pub const SMALLEST: u32 = texture_error::SMALLEST;
    /// The largest.
    pub const LARGEST: u32 = texture_error::LARGEST;

    /// A size, checked.
    ///
    /// # Errors
    /// [`TextureError::LayerSize`] where the side is not a power of two within the limits.
    pub fn new(side: u32) -> Result<Self, TextureError> {
        if side.is_power_of_two() && (Self::SMALLEST..=Self::LARGEST).contains(&side) {
            Ok(Self { side })
        } else {
            Err(TextureError::LayerSize { side })
        }
    }

    /// The size for an image: its longer side rounded up to what is allowed.
    pub fn for_image(width: u32, height: u32) -> Self {
        Self { side: width.max(height).clamp(Self::SMALLEST, Self::LARGEST).next_power_of_two() }
    }

    /// How many levels there are, level 0 included.
    pub fn levels(self) -> u32 {
        self.side.ilog2() + 1
    }

    /// Width and height of a level, in texels.
    pub fn side(self, level: u32) -> u32 {
        self.side.checked_shr(level).unwrap_or(0).max(1)
    }

    /// Texels of all levels of an image's layers: 16/3 of the image's.
    pub fn texels(self) -> u64 {
        u64::from(LAYERS) * (0..self.levels()).map(|level| u64::from(self.side(level)).pow(2)).sum::<u64>()
    }

    /// The distance from the light's plane that a level is for, in the light's longer side.
    pub fn height(self, level: u32) -> f64 {
        FINEST_HEIGHT * f64::from(level).exp2() / f64::from(self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_a_power_of_two_within_limits() {
        assert!(PyramidSize::new(256).is_ok());
        for side in [0, 32, 96, 8192] {
            let error = PyramidSize::new(side).unwrap_err();
            assert!(error.to_string().contains(&format!("{side} x {side}")), "{error}");
        }
        assert_eq!(PyramidSize::for_image(1920, 1080).side(0), 2048);
        assert_eq!(PyramidSize::for_image(1, 100_000).side(0), 4096);
    }

    #[test]
    fn levels_halve_down_to_a_texel() {
        let size = PyramidSize::new(256).unwrap();
        assert_eq!(size.levels(), 9);
        assert_eq!([0, 8, 40].map(|level| size.side(level)), [256, 1, 1]);
        // A geometric series
        let ratio = size.texels() as f64 / (256.0 * 256.0);
        assert!((ratio - 16.0 / 3.0).abs() < 1e-4, "{ratio}");
        assert_eq!([0, 8].map(|level| size.height(level)), [6.0 / 256.0, 6.0]);
    }
}
