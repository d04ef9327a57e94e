//! A picture that converges: the mean of independent ones, in two halves that tell its noise.

use crate::picture::{BLOCK, levels};
use glam::DVec3;

/// Sums of pictures.
pub struct Means {
    sums: [Vec<DVec3>; 2],
    samples: [u32; 2],
}

/// How far a picture is from one that converges to the truth, each a root of the mean square over the truth's
/// mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// What is left without the truth's own noise; none where so little is left that it may be chance.
    pub error: Option<f64>,
    /// The truth's noise.
    pub noise: f64,
}

/// An error is known from this part of the noise on.
const LEAST_PART: f64 = 0.2;

impl Means {
    /// Nothing is known yet of so many pixels.
    pub fn new(pixels: usize) -> Self {
        Self { sums: [vec![DVec3::ZERO; pixels], vec![DVec3::ZERO; pixels]], samples: [0; 2] }
    }

    /// Samples a pixel so far.
    pub fn samples(&self) -> u32 {
        self.samples.iter().sum()
    }

    /// Adds a picture of so many samples a pixel, to the half that has fewer.
    pub fn add(&mut self, radiance: &[DVec3], samples: u32) {
        let half = usize::from(self.samples[1] < self.samples[0]);
        for (sum, radiance) in self.sums[half].iter_mut().zip(radiance) {
            *sum += *radiance * f64::from(samples);
        }
        self.samples[half] += samples;
    }

    /// The mean; black where nothing is known.
    pub fn mean(&self) -> Vec<DVec3> {
        let scale = 1.0 / f64::from(self.samples().max(1));
        self.sums[0].iter().zip(&self.sums[1]).map(|(a, b)| (*a + *b) * scale).collect()
    }

    /// The noise of the mean as a screen shows it, in [`levels`], of pictures so many samples wide with
    /// `factor` x `factor` of them a pixel; none before both halves are there.
    pub fn noise(&self, width: usize, factor: usize, stops: f32) -> Option<f64> {
        let [a, b] = self.samples.map(f64::from);
        let [first, second] = [0, 1].map(|half| {
            let scale = 1.0 / f64::from(self.samples[half]);
            self.sums[half].iter().map(move |sum| *sum * scale)
        });
        let halves = first.zip(second.map(|second| [second; 2]));
        // The variance of the mean, by the difference of two independent means
        let part = (a * b).sqrt() / (a + b);
        (a * b > 0.0).then(|| part * levels(halves, width, BLOCK * factor, stops)[0])
    }

    /// How far a picture is, over the pixels that count; none before both halves are there, or where the
    /// truth is black.
    pub fn distance(&self, radiance: &[DVec3], counts: impl Fn(usize) -> bool) -> Option<Distance> {
        let [a, b] = self.samples.map(f64::from);
        if a == 0.0 || b == 0.0 {
            return None;
        }
        let (mut off, mut noise, mut mean, mut pixels) = (0.0, 0.0, 0.0, 0.0);
        for (index, found) in radiance.iter().enumerate().filter(|(index, _)| counts(*index)) {
            let halves = [self.sums[0][index] / a, self.sums[1][index] / b];
            let truth = (halves[0] * a + halves[1] * b) / (a + b);
            off += (*found - truth).length_squared();
            // The variance of the mean, by the difference of two independent means
            noise += (halves[0] - halves[1]).length_squared() * (a * b / (a + b).powi(2));
            mean += truth.element_sum();
            pixels += 1.0;
        }
        // Root mean squares of a channel
        let root = |sum: f64| (sum / (3.0 * pixels)).sqrt() / (mean / (3.0 * pixels));
        let (error, noise) = (root((off - noise).max(0.0)), root(noise));
        let known = error > LEAST_PART * noise || noise == 0.0;
        (error.is_finite() && noise.is_finite()).then_some(Distance { error: known.then_some(error), noise })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of mean 0 and variance 1/12.
    fn noise(seed: u64) -> f64 {
        let mixed = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((mixed ^ (mixed >> 29)) >> 11) as f64 / 2_f64.powi(53) - 0.5
    }

    #[test]
    fn the_noise_of_the_truth_is_not_taken_for_error() {
        const PIXELS: usize = 20_000;
        let mut truth = Means::new(PIXELS);
        let exact = vec![DVec3::splat(2.0); PIXELS];
        assert_eq!((truth.distance(&exact, |_| true), truth.noise(100, 1, 0.0)), (None, None));
        for step in 0..5 {
            let picture: Vec<DVec3> = (0..PIXELS as u64)
                .map(|pixel| DVec3::splat(2.0 + noise(pixel * 5 + step) / 2_f64.sqrt()))
                .collect();
            truth.add(&picture, 2);
        }
        assert_eq!(truth.samples(), 10);
        // On a screen the noise of what is white is none; four stops below, of means of 4 x 4 samples
        assert_eq!(truth.noise(100, 1, 4.0), Some(0.0));
        let noise = |factor| truth.noise(100, factor, -4.0).unwrap();
        assert!((noise(1) / noise(2) - 2.0).abs() < 0.2, "{} and {}", noise(1), noise(2));
        // Five pictures of a variance of 1/24 each
        let expected = (1.0_f64 / 24.0 / 5.0).sqrt() / 2.0;
        let found = truth.distance(&exact, |_| true).unwrap();
        assert!((found.noise / expected - 1.0).abs() < 0.05, "{found:?}");
        assert_eq!(found.error, None);
        // A picture that is off by a tenth, and the part of it that is not
        let off: Vec<DVec3> = (0..PIXELS).map(|i| DVec3::splat(if i % 2 == 0 { 2.2 } else { 2.0 })).collect();
        let found = truth.distance(&off, |index| index % 2 == 0).unwrap();
        assert!(found.error.is_some_and(|error| (error - 0.1).abs() < 2e-3), "{found:?}");
        assert_eq!(truth.distance(&off, |index| index % 2 == 1).unwrap().error, None);
    }
}
