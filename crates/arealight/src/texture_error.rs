//! What light textures may not be, and the limits that say so.

use glam::DVec2;

/// The side of a light texture: the least and the most.
pub(crate) const SMALLEST: u32 = 64;
pub(crate) const LARGEST: u32 = 4096;
/// Of an image that is loaded, and of the part of it that is read.
pub(crate) const LARGEST_SOURCE: u32 = 4096;
pub(crate) const FARTHEST: f64 = 4096.0;
pub(crate) const MOST_TEXELS: f64 = 16384.0;
/// What texels are divided by: its reciprocal is a number, too.
pub(crate) const DIVISORS: std::ops::RangeInclusive<f32> = 1e-30..=1e30;

/// How many times as wide as high a light is.
pub(crate) const ASPECTS: std::ops::RangeInclusive<f32> = 1.0 / 1024.0..=1024.0;

/// Why light textures cannot be made, or a part of an image not be loaded into one.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A size that no light texture has.
    #[error(
        "light texture size {side} x {side}: a side must be a power of two from {} to {}",
        SMALLEST,
        LARGEST
    )]
    LayerSize {
        /// The side given.
        side: u32,
    },
    /// Texels cannot be divided by it.
    #[error("divisor: {divisor} must be from {} to {}", DIVISORS.start(), DIVISORS.end())]
    Divisor {
        /// The divisor given.
        divisor: f32,
    },
    /// No light is so long.
    #[error("aspect: {aspect} must be from 1/1024 to 1024")]
    Aspect {
        /// The aspect given.
        aspect: f32,
    },
    /// The image has no texels, or too many.
    #[error("source of {width} x {height} texels: each must be from 1 to {}; scale it down", LARGEST_SOURCE)]
    Source {
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
    },
    /// The part begins nowhere, or too far away to be resolved.
    #[error("low: {low} must be within {} repeats of the image", FARTHEST)]
    Low {
        /// The coordinates given.
        low: DVec2,
    },
    /// The part is empty, or so many repeats that reading it would take seconds.
    #[error(
        "size: {size} of {width} x {height} texels must be positive and cover at most {} texels a side; load \
        fewer repeats",
        MOST_TEXELS
    )]
    Size {
        /// The size given.
        size: DVec2,
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
    },
}
