//! The pyramid of a light's texture: how large each level is, and how blurred.
//!
//! A light's texture is a layer of one array image that all lights share, so that no shader indexes an array
//! of images. Level 0 is the image itself, in linear light; each further level has half the texels a side and
//! about twice the blur, and is made from the one before with a separable Gaussian. Beyond its edge the image
//! is mirrored, so that every level has the image's mean. A blurred lookup is one trilinear fetch
//! ([`PyramidSize::level_of`]).
//!
//! # Why so
//! - Levels are twice apart: three times, as is common, doubles the error between them.
//! - The blur of a level is 0.85 of its texels: less, and bilinear lookup shows the texels; more, and the
//!   kernel needs more than six taps.
//! - Mirrored, not extended: a blur that extends the edge sees too much of it. At the widest blur a picture
//!   with a bright frame would be a fifth too bright, and a far light must show the image's mean. It also
//!   needs no margin, which would take half as many texels again.
//! - The last three levels are 2.29 times apart instead, so that the last, which is four texels a side, has
//!   [`WIDEST_BLUR`]: a level of two texels could not show a gradient. Footprints of far lights are a little
//!   wider, and are given this one.
//! - Level 0 is sharp: a mirror shows the image, and updating it costs one copy.
//! - Levels are mixed a little towards the sharper one ([`PyramidSize::level_of`]), which is nearer to a
//!   Gaussian than mixing by the logarithm of the blur.
//!
//! Tested against a direct Gaussian in float64 (`crates/arealight-oracle/tests`,
//! `tests/tests/gpu/pyramid.rs`).

use crate::texture_error::{self, TextureError};

/// The standard deviation of the last level, in texture coordinates: the square root of 1/8. Lookups that ask
/// for more get this.
pub const WIDEST_BLUR: f64 = 0.353_553_390_593_273_8;

/// The variance of a level's blur, in squares of its own texels, but for the last three.
const VARIANCE: f64 = 0.85 * 0.85;

/// The variance that bilinear lookup adds, in squares of a level's texels.
const TENT: f64 = 1.0 / 6.0;

/// How much larger `VARIANCE + TENT` is in each of the last three levels than in the one before: the cube
/// root of `2 / (VARIANCE + TENT)`, as the last has `(4 WIDEST_BLUR)^2 = 2`.
const WIDENING: f64 = 1.310_209_9;

/// Levels that are widened.
const WIDENED: u32 = 3;

/// How much the level's fraction is lowered in its middle, times four.
const EASE: f64 = 0.2;

/// The size of a light texture: as many texels wide as high, a power of two from [`PyramidSize::SMALLEST`]
/// to [`PyramidSize::LARGEST`].
///
/// Images of any other size and aspect are resampled when they are loaded, so that each is blurred down to
/// its mean along both sides, whatever the other layers show: a layer that is longer than wide in texels
/// would stop at the blur of its short side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PyramidSize {
    side: u32,
}

/// The most taps to a side that make a level from the one before it: [`PyramidSize::weights`].
pub const MOST_TAPS: usize = 6;

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
        self.side.ilog2() - 1
    }

    /// Width and height of a level, in texels.
    pub fn side(self, level: u32) -> u32 {
        self.side.checked_shr(level).unwrap_or(0).max(1)
    }

    /// Texels of all levels of a layer: 1.34 times the image's.
    pub fn texels(self) -> u64 {
        (0..self.levels()).map(|level| u64::from(self.side(level)).pow(2)).sum()
    }

    /// The variance of a level's blur, in squares of its own texels; zero for level 0.
    pub fn variance(self, level: u32) -> f64 {
        if level == 0 {
            return 0.0;
        }
        let widened = (level + 1 + WIDENED).saturating_sub(self.levels());
        (VARIANCE + TENT) * WIDENING.powi(widened.cast_signed()) - TENT
    }

    /// The blur of a bilinear lookup in a level beyond that of a bilinear lookup in level 0: a standard
    /// deviation in level 0's texels.
    pub fn blur(self, level: u32) -> f64 {
        let texel = f64::from(1u32 << level);
        ((self.variance(level) + if level == 0 { 0.0 } else { TENT }) * texel * texel
            - if level == 0 { 0.0 } else { TENT })
        .sqrt()
    }

    /// How `level`, from 1 on, is made from the level before. Half of a symmetric kernel, the innermost tap
    /// first: a texel is the sum of `weights[i]` times the texels at `i + 1/2` texels of the finer level to
    /// both sides of its centre. The whole kernel sums to one. Zero from [`PyramidSize::taps`] on.
    pub fn weights(self, level: u32) -> [f32; MOST_TAPS] {
        // The Gaussian whose samples have the variance to add
        let (added, taps) = (self.added_variance(level), self.taps(level));
        let (mut low, mut high) = (0.1, 1e4);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if discrete_variance(&gaussian(middle, taps)) < added {
                low = middle;
            } else {
                high = middle;
            }
        }
        gaussian(low, taps).map(|weight| weight as f32)
    }

    /// How many taps to a side `level`, from 1 on, is made with.
    pub fn taps(self, level: u32) -> u32 {
        // A kernel of n equal taps has the variance (n^2 - 1) / 12: leave room to a Gaussian's shape. Level
        // 1, which adds 2.89, would be all but a box of six: a checker's error there is 3.6 % with six taps,
        // 1.2 % with eight
        match self.added_variance(level) {
            ..=2.4 => 3,
            ..=3.6 => 4,
            ..=4.6 => 5,
            _ => MOST_TAPS as u32,
        }
    }

    /// What a level's variance is more than that of the level before, in squares of the finer level's texels.
    fn added_variance(self, level: u32) -> f64 {
        4.0 * self.variance(level) - self.variance(level.saturating_sub(1))
    }

    /// The level, between two, at which a trilinear lookup is blurred with a standard deviation of `blur`
    /// texels of level 0; from 0 to the last.
    pub fn level_of(self, blur: f64) -> f64 {
        let square = blur.max(0.0).powi(2);
        let last = f64::from(self.levels() - 1);
        // Regular levels: 4^level (VARIANCE + TENT) - TENT
        let octaves = 0.5 * ((square + TENT) / (VARIANCE + TENT)).log2();
        if octaves < 1.0 {
            // From sharp to the first, the sharper level's share falls faster than the variance rises
            let first = 4.0 * (VARIANCE + TENT) - TENT;
            return 3.0 * square / (first + 2.0 * square);
        }
        let widened = last - f64::from(WIDENED);
        let level = octaves.min(widened) + (octaves - widened).max(0.0) / (1.0 + 0.5 * WIDENING.log2());
        let level = level.min(last);
        let fraction = level.fract();
        level - EASE * fraction * (1.0 - fraction)
    }
}

/// Half of a normalised kernel of samples of a Gaussian of the variance `variance` at half texels.
fn gaussian(variance: f64, taps: u32) -> [f64; MOST_TAPS] {
    let sample = |i: usize| {
        let x = i as f64 + 0.5;
        if i < taps as usize { (-x * x / (2.0 * variance)).exp() } else { 0.0 }
    };
    let samples: [f64; MOST_TAPS] = std::array::from_fn(sample);
    let sum = 2.0 * samples.iter().sum::<f64>();
    samples.map(|sample| sample / sum)
}

/// The variance of a symmetric kernel, given its half.
fn discrete_variance(half: &[f64]) -> f64 {
    2.0 * half.iter().enumerate().map(|(i, weight)| weight * (i as f64 + 0.5).powi(2)).sum::<f64>()
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
    fn levels_halve_down_to_four_texels() {
        let size = PyramidSize::new(256).unwrap();
        assert_eq!(size.levels(), 7);
        assert_eq!([0, 6, 40].map(|level| size.side(level)), [256, 4, 1]);
        // A geometric series
        let ratio = size.texels() as f64 / (256.0 * 256.0);
        assert!(ratio < 1.334, "{ratio}");
    }

    #[test]
    fn the_last_level_has_the_widest_blur() {
        for side in [64, 256, 4096] {
            let size = PyramidSize::new(side).unwrap();
            let blur = size.blur(size.levels() - 1) / f64::from(side);
            assert!((blur - WIDEST_BLUR).abs() < 2e-4, "{side}: {blur}");
        }
    }

    #[test]
    fn kernels_add_up_to_the_blur_of_their_level() {
        let size = PyramidSize::new(256).unwrap();
        let mut variance = 0.0;
        for level in 1..size.levels() {
            let half = size.weights(level).map(f64::from);
            assert!((2.0 * half.iter().sum::<f64>() - 1.0).abs() < 1e-6, "level {level} keeps the mean");
            assert!(half.windows(2).all(|pair| pair[1] <= pair[0]), "level {level} falls to the sides");
            assert!(half[size.taps(level) as usize..].iter().all(|weight| *weight == 0.0));
            variance = (variance + discrete_variance(&half)) / 4.0;
            assert!((variance - size.variance(level)).abs() < 1e-6, "level {level}: {variance}");
        }
    }

    #[test]
    fn a_levels_own_blur_is_found_at_it() {
        let size = PyramidSize::new(512).unwrap();
        for level in 0..size.levels() {
            let found = size.level_of(size.blur(level));
            assert!((found - f64::from(level)).abs() < 1e-4, "level {level}: {found}");
        }
        assert_eq!(size.level_of(1e9), f64::from(size.levels() - 1), "clamped");
        // Rises without steps
        let levels: Vec<f64> = (0..4000).map(|i| size.level_of(f64::from(i) * 0.05)).collect();
        assert!(levels.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] < 0.06));
    }
}
