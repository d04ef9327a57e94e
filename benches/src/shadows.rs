//! How far a picture with shadows is from the Monte Carlo reference: of each pixel the shadow, which is the
//! part of its unshadowed light that arrives, and the radiance.
//!
//! Pictures are rows of the radiance that surfaces reflect, without what the camera sees of lamps directly,
//! in W/(m² sr).

use crate::ladder::Errors;
use arealight_oracle::material::LUMINANCE;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Shadows closer than this to 0 or to 1 are no penumbra: there the noise of a reference of a thousand
/// samples is as large.
const EDGE: f64 = 0.02;

/// Pictures of different sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {given} pixels, and the others have {wanted}")]
pub struct SizeError {
    /// The picture.
    pub field: &'static str,
    /// How many pixels it has.
    pub given: usize,
    /// How many the others have.
    pub wanted: usize,
}

/// The part of a light that arrives, in luminance: 0 to 1, and none where there is no light, or what is given
/// is NaN or infinite.
///
/// `unshadowed` is of the same surface and the same method as `shadowed`. Of a reference it is best the
/// reference without shadows, of the same seed and as many samples: where nothing is blocked the two are
/// alike to the bit, and their quotient has no noise. With the fitted lobes' exact radiance in its place the
/// part has the fit's error, a few per cent for glossy surfaces, and all of the samples' noise.
pub fn part_that_arrives(shadowed: DVec3, unshadowed: DVec3) -> Option<f64> {
    let (shadowed, unshadowed) = (shadowed.dot(LUMINANCE), unshadowed.dot(LUMINANCE));
    let part = shadowed / unshadowed;
    (unshadowed > 0.0 && part.is_finite()).then(|| part.clamp(0.0, 1.0))
}

/// The part of the light that a method says arrives: any number, as methods with noise have, and 1 where it
/// knows of no light.
pub fn part_found(shadowed: DVec3, unshadowed: DVec3) -> f64 {
    let unshadowed = unshadowed.dot(LUMINANCE);
    if unshadowed == 0.0 { 1.0 } else { shadowed.dot(LUMINANCE) / unshadowed }
}

/// What is right of a picture with shadows.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadowTruth {
    /// Of each pixel [`part_that_arrives`].
    pub parts: Vec<Option<f64>>,
    /// The radiance with shadows.
    pub radiance: Vec<DVec3>,
}

impl ShadowTruth {
    /// Of a reference's picture with shadows, and one without: see [`part_that_arrives`].
    ///
    /// # Errors
    /// [`SizeError`] where they are not of one size.
    pub fn new(shadowed: Vec<DVec3>, unshadowed: &[DVec3]) -> Result<Self, SizeError> {
        check("unshadowed", unshadowed.len(), shadowed.len())?;
        let parts = shadowed.iter().zip(unshadowed).map(|(with, without)| part_that_arrives(*with, *without));
        Ok(Self { parts: parts.collect(), radiance: shadowed })
    }

    /// The share of the lit pixels that are in a penumbra.
    pub fn penumbra(&self) -> f64 {
        let lit = || self.parts.iter().flatten();
        lit().filter(|part| in_penumbra(**part)).count() as f64 / lit().count().max(1) as f64
    }

    /// The errors of a pass: of its shadows, one a pixel, read only where the truth has one, and of its
    /// radiance. Beside a second reference of another seed they are the noise of both: the root of 2 times
    /// that of one.
    ///
    /// # Errors
    /// [`SizeError`] where they are not as many as the truth's pixels.
    pub fn errors(&self, shadows: &[f64], radiance: &[DVec3]) -> Result<ShadowErrors, SizeError> {
        check("shadows", shadows.len(), self.parts.len())?;
        check("radiance", radiance.len(), self.parts.len())?;
        let (mut all, mut penumbra) = (Sum::default(), Sum::default());
        for (part, found) in self.parts.iter().zip(shadows) {
            let Some(part) = *part else { continue };
            all.add(found - part);
            if in_penumbra(part) {
                penumbra.add(found - part);
            }
        }
        let lit = self.parts.iter().zip(radiance.iter().zip(&self.radiance));
        let lit = lit.filter_map(|(part, pair)| part.map(|_| pair));
        Ok(ShadowErrors {
            lit: all.count,
            penumbra: penumbra.count,
            rmse: all.rms(),
            penumbra_rmse: penumbra.rms(),
            bias: all.mean(),
            not_finite: all.not_finite,
            radiance: Errors::of(lit),
        })
    }
}

/// The errors of a picture with shadows, over its lit pixels: those that have light without shadows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ShadowErrors {
    /// How many pixels are lit.
    pub lit: usize,
    /// How many of them are in a penumbra.
    pub penumbra: usize,
    /// Root of the mean square of the shadows' errors: times 100, per cent of the unshadowed light.
    pub rmse: f64,
    /// The same in penumbra alone.
    pub penumbra_rmse: f64,
    /// The mean of the shadows' errors: positive where too much arrives.
    pub bias: f64,
    /// Shadows that are NaN or infinite; they are left out of the others.
    pub not_finite: usize,
    /// Of the radiance, over the mean of the truth.
    pub radiance: Errors,
}

impl ShadowErrors {
    /// The errors without what of them is independent noise, such as the truth's: its squares are taken out
    /// of the means of squares. Other numbers stay.
    #[must_use]
    pub fn without(self, noise: &Self) -> Self {
        let rest = |error: f64, noise: f64| (error * error - noise * noise).max(0.0).sqrt();
        Self {
            rmse: rest(self.rmse, noise.rmse),
            penumbra_rmse: rest(self.penumbra_rmse, noise.penumbra_rmse),
            radiance: Errors { rmse: rest(self.radiance.rmse, noise.radiance.rmse), ..self.radiance },
            ..self
        }
    }

    /// A row of a Markdown table, by [`ShadowErrors::HEAD`]: shadows' errors times 100, and the radiance's in
    /// per cent of its mean.
    pub fn row(&self, name: &str) -> String {
        let [rmse, penumbra, bias, radiance] =
            [self.rmse, self.penumbra_rmse, self.bias, self.radiance.rmse].map(|error| 100.0 * error);
        format!("| {name} | {rmse:.2} | {penumbra:.2} | {bias:+.2} | {radiance:.1} |")
    }

    /// The head of a table of rows.
    pub const HEAD: &'static str = "| method | shadow, RMSE x 100 | in penumbra | mean error x 100 | \
    radiance, RMSE / mean % |\n\
         |---|---|---|---|---|";
}

fn in_penumbra(part: f64) -> bool {
    part > EDGE && part < 1.0 - EDGE
}

fn check(field: &'static str, given: usize, wanted: usize) -> Result<(), SizeError> {
    if given == wanted { Ok(()) } else { Err(SizeError { field, given, wanted }) }
}

/// Errors, summed.
#[derive(Default)]
struct Sum {
    count: usize,
    not_finite: usize,
    total: f64,
    square: f64,
}

impl Sum {
    fn add(&mut self, error: f64) {
        self.count += 1;
        if error.is_finite() {
            self.total += error;
            self.square += error * error;
        } else {
            self.not_finite += 1;
        }
    }

    fn finite(&self) -> f64 {
        (self.count - self.not_finite).max(1) as f64
    }

    fn mean(&self) -> f64 {
        self.total / self.finite()
    }

    fn rms(&self) -> f64 {
        (self.square / self.finite()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pixel without light, one in the dark, two in penumbra, and one in full light of 2.
    const PARTS: [Option<f64>; 5] = [None, Some(0.0), Some(0.25), Some(0.5), Some(1.0)];

    fn truth() -> ShadowTruth {
        let unshadowed = PARTS.map(|part| if part.is_some() { DVec3::splat(2.0) } else { DVec3::ZERO });
        let shadowed = PARTS.map(|part| DVec3::splat(2.0 * part.unwrap_or(0.0)));
        ShadowTruth::new(shadowed.to_vec(), &unshadowed).unwrap()
    }

    fn errors(shadows: [f64; 5]) -> ShadowErrors {
        let truth = truth();
        let radiance: Vec<DVec3> = shadows.iter().map(|part| DVec3::splat(2.0 * part)).collect();
        truth.errors(&shadows, &radiance).unwrap()
    }

    #[test]
    fn the_truth_is_the_part_of_the_light() {
        let truth = truth();
        assert_eq!(truth.parts, PARTS);
        assert_eq!(truth.penumbra(), 0.5);
        // In luminance; noise does not lead out of 0 to 1
        let part = part_that_arrives(DVec3::new(1.0, 0.0, 0.0), DVec3::ONE).unwrap();
        assert!((part - 0.2126).abs() < 1e-12);
        assert_eq!(part_that_arrives(DVec3::splat(1.1), DVec3::ONE), Some(1.0));
        for (shadowed, unshadowed) in
            [(DVec3::ONE, DVec3::ZERO), (DVec3::NAN, DVec3::ONE), (DVec3::ONE, DVec3::NAN)]
        {
            assert_eq!(part_that_arrives(shadowed, unshadowed), None);
        }
    }

    #[test]
    fn a_picture_that_is_right_has_no_error_and_one_that_is_not_has() {
        let right = errors([0.7, 0.0, 0.25, 0.5, 1.0]);
        assert_eq!((right.lit, right.penumbra, right.not_finite), (4, 2, 0));
        assert_eq!((right.rmse, right.penumbra_rmse, right.bias, right.radiance.rmse), (0.0, 0.0, 0.0, 0.0));
        // The twin: a tenth too much in one pixel of the penumbra, and none in the light
        let wrong = errors([0.7, 0.0, 0.35, 0.5, 0.0]);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(
            close(wrong.rmse, (1.01_f64 / 4.0).sqrt()) && close(wrong.penumbra_rmse, (0.01_f64 / 2.0).sqrt())
        );
        assert!(close(wrong.bias, -0.9 / 4.0));
        // Twice that in radiance, over a mean of 3.5 / 4
        assert!(close(wrong.radiance.rmse, 2.0 * wrong.rmse / 0.875), "{}", wrong.radiance.rmse);
        assert_eq!(wrong.row("x"), "| x | 50.25 | 7.07 | -22.50 | 114.9 |");
    }

    #[test]
    fn independent_noise_is_taken_out_of_the_squares() {
        let all = errors([0.7, 0.0, 0.30, 0.5, 0.95]);
        let noise = errors([0.7, 0.0, 0.28, 0.5, 1.0]);
        let rest = all.without(&noise);
        assert!((rest.rmse.powi(2) + noise.rmse.powi(2) - all.rmse.powi(2)).abs() < 1e-15);
        assert!((rest.penumbra_rmse - (0.0016_f64 / 2.0).sqrt()).abs() < 1e-12);
        assert!(rest.radiance.rmse < all.radiance.rmse && rest.bias == all.bias);
        // More noise than there is error leaves none
        assert_eq!(noise.without(&all).rmse, 0.0);
    }

    #[test]
    fn what_a_method_finds_may_be_any_number() {
        assert_eq!(part_found(DVec3::splat(3.0), DVec3::splat(2.0)), 1.5);
        assert_eq!(part_found(DVec3::ZERO, DVec3::ZERO), 1.0);
        assert!(part_found(DVec3::NAN, DVec3::ONE).is_nan());
    }

    #[test]
    fn without_shadows_the_error_is_what_is_hidden() {
        let off = errors([1.0; 5]);
        assert!((off.bias - (1.0 + 0.75 + 0.5) / 4.0).abs() < 1e-12 && off.rmse > 0.6);
    }

    #[test]
    fn what_is_not_finite_is_counted_and_left_out() {
        let holed = errors([0.7, f64::NAN, 0.25, 0.5, 1.0]);
        assert_eq!((holed.not_finite, holed.radiance.not_finite), (1, 1));
        assert_eq!((holed.rmse, holed.radiance.rmse), (0.0, 0.0));
        // Where there is no light nothing is read
        assert_eq!(errors([f64::NAN, 0.0, 0.25, 0.5, 1.0]).not_finite, 0);
    }

    #[test]
    fn pictures_of_different_sizes_are_refused() {
        let truth = truth();
        let error = truth.errors(&[1.0; 4], &[DVec3::ONE; 5]).unwrap_err();
        assert_eq!(error, SizeError { field: "shadows", given: 4, wanted: 5 });
        assert_eq!(truth.errors(&[1.0; 5], &[DVec3::ONE; 6]).unwrap_err().field, "radiance");
        assert_eq!(
            ShadowTruth::new(vec![DVec3::ONE], &[]).unwrap_err().to_string(),
            "unshadowed: 0 pixels, and the others have 1"
        );
    }
}
