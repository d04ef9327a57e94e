//! A Monte Carlo reference whose own noise is known, and errors against it that are free of that noise.
//!
//! The reference is the mean of two independent halves A and B. Whatever a picture X is, (X - A) (X - B) has
//! the square of X's error as its expectation, for the halves' noise is independent: it's the square of the
//! difference from the mean less (A - B)² / 4, an estimate of the mean's variance. What is left of the noise
//! is an uncertainty: of normal noise, the product's variance is the expectation of ((X - (A + B) / 2) (A -
//! B))².

use glam::DVec3;

/// Two independent halves of a reference, row after row.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    halves: [Vec<DVec3>; 2],
}

/// A picture's error against a reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureError {
    /// Root of the mean square over the reference's mean, without what is the reference's noise.
    pub rmse: f64,
    /// What it lies within by 95 %, for the noise of the reference.
    pub range: [f64; 2],
    /// As it is without the correction.
    pub with_noise: f64,
    /// How many of the picture's pixels are NaN or infinite, judged or not; they are left out of the others.
    pub not_finite: usize,
}

impl Reference {
    /// Of two renderings of as many samples each, from different seeds.
    pub const fn new(halves: [Vec<DVec3>; 2]) -> Self {
        Self { halves }
    }

    /// The mean of both.
    pub fn mean(&self) -> Vec<DVec3> {
        let [a, b] = &self.halves;
        a.iter().zip(b).map(|(a, b)| (*a + *b) * 0.5).collect()
    }

    /// The error of a picture where `is_judged`, over as many pixels.
    pub fn error_of(&self, found: &[DVec3], is_judged: &[bool]) -> PictureError {
        let [a, b] = &self.halves;
        let (mut count, mut total, mut squares, mut products, mut variance) = (0.0_f64, 0.0, 0.0, 0.0, 0.0);
        let is_counted = |((found, _), is_judged): &((&DVec3, _), &bool)| **is_judged && found.is_finite();
        let pixels = found.iter().zip(a.iter().zip(b)).zip(is_judged);
        for ((found, (a, b)), _) in pixels.filter(is_counted) {
            let mean = (*a + *b) * 0.5;
            let off = *found - mean;
            count += 3.0;
            total += mean.element_sum();
            squares += off.length_squared();
            products += (*found - *a).dot(*found - *b);
            // Channels of a pixel share their samples, so their products are summed first
            variance += off.dot(*a - *b).powi(2);
        }
        let count = count.max(1.0);
        let mean = total / count;
        let error = |square: f64| (square / count).max(0.0).sqrt() / mean;
        // Two standard deviations
        let spread = 2.0 * variance.sqrt();
        PictureError {
            rmse: error(products),
            range: [error(products - spread), error(products + spread)],
            with_noise: error(squares),
            not_finite: found.iter().filter(|pixel| !pixel.is_finite()).count(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_oracle::stream::Stream;

    const PIXELS: usize = 4000;

    /// The root of the mean square of what [`picture`] errs by, over the truth's mean of 1.
    const ERROR: f64 = 0.03;

    /// Noise of about a standard deviation of 1, alike in all channels: a sum of twelve.
    fn normal(random: &mut Stream) -> f64 {
        (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
    }

    fn half(seed: u64) -> Vec<DVec3> {
        let mut random = Stream::new("reference", seed, 0);
        (0..PIXELS).map(|_| DVec3::splat(1.0 + 0.1 * normal(&mut random))).collect()
    }

    /// The truth, too bright and too dark by turns.
    fn picture() -> Vec<DVec3> {
        (0..PIXELS)
            .map(|i| DVec3::splat(if i.is_multiple_of(2) { 1.0 + ERROR } else { 1.0 - ERROR }))
            .collect()
    }

    #[test]
    fn the_references_noise_is_no_part_of_an_error() {
        let judged = vec![true; PIXELS];
        let error = |reference: Reference| reference.error_of(&picture(), &judged);
        let found = error(Reference::new([half(1), half(2)]));
        assert!(found.range[0] < ERROR && ERROR < found.range[1], "{found:?}");
        // A standard deviation of about .1 (.03 + .1) / sqrt(4000) of the square, which is 9e-4: 10 % of the
        // root
        assert!((found.rmse / ERROR - 1.0).abs() < 0.2, "{found:?}");
        assert!(found.range[1] - found.range[0] < 0.5 * ERROR, "{found:?}");
        // The twins: what isn't corrected has the noise in it, .1 / sqrt(2); nor does a half correct itself
        assert!((found.with_noise - (ERROR.powi(2) + 0.005).sqrt()).abs() < 0.005, "{found:?}");
        let same = error(Reference::new([half(1), half(1)]));
        assert!((same.rmse - (ERROR.powi(2) + 0.01).sqrt()).abs() < 0.01, "{same:?}");
    }

    #[test]
    fn nineteen_of_twenty_ranges_hold_the_error() {
        let judged = vec![true; PIXELS];
        let holds = |seed: u64| {
            let reference = Reference::new([half(10 + 2 * seed), half(11 + 2 * seed)]);
            let range = reference.error_of(&picture(), &judged).range;
            range[0] < ERROR && ERROR < range[1]
        };
        let held = (0..200).filter(|seed| holds(*seed)).count();
        // 190 or 191 are expected, of a standard deviation of 3
        assert!((180..200).contains(&held), "{held} of 200");
    }

    #[test]
    fn pixels_that_are_not_judged_do_not_count() {
        let reference = Reference::new([half(1), half(2)]);
        let judged: Vec<bool> = (0..PIXELS).map(|i| i < PIXELS / 2).collect();
        let mut wrong = picture();
        wrong[PIXELS / 2..].fill(DVec3::splat(1e9));
        assert_eq!(reference.error_of(&wrong, &judged), reference.error_of(&picture(), &judged));
        assert!(reference.error_of(&wrong, &[true; PIXELS]).rmse > 1e8);
        // What is no number is counted, and hides nothing
        let mut holes = picture();
        holes[PIXELS / 2..].fill(DVec3::NAN);
        let found = reference.error_of(&holes, &[true; PIXELS]);
        assert_eq!(found.not_finite, PIXELS / 2);
        assert_eq!(PictureError { not_finite: 0, ..found }, reference.error_of(&picture(), &judged));
    }
}
