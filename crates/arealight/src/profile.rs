//! Emission profiles: how a light's radiance changes with the angle from its front.
//!
//! A profile is a factor of the radiance by the angle between the light's front normal and the direction from
//! the light to the surface: a spot's cone, the spread of a softbox behind a grid, the distribution of a
//! luminaire. On a flat light the points that send within an angle of the front are a disk about the foot of
//! the perpendicular from the surface to the light's plane. So between a few angles, the *levels*, what
//! arrives is a form factor of a part of the light, times the profile's mean there: docs/shaped-light.md.

use crate::azimuth::{Azimuths, Harmonics};
use crate::light_fault::LightFault;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A factor of a light's radiance by the angle from its front, and about it by the azimuth; 0 behind.
///
/// ```
/// use arealight::Profile;
/// // A spot: full to 18 degrees, nothing from 32 on
/// let spot = Profile::new(&[[0.0, 1.0], [18.0, 1.0], [32.0, 0.0]], 4)?;
/// assert!((spot.factor(25f64.to_radians().cos()) - 0.5).abs() < 1e-9);
/// # Ok::<(), arealight::LightFault>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Degrees and factor, the mean about the normal, the degrees rising.
    pairs: Vec<[f64; 2]>,
    /// Where it is not round about the normal.
    azimuths: Option<Azimuths>,
    /// From this cosine down the factor is 0.
    end: f64,
    /// Cosines between which a mean is taken, falling.
    levels: Vec<f64>,
    /// How much narrower its pieces are on the axis than if they were even.
    crowding: f64,
}

impl Profile {
    /// The most rows, and numbers in each.
    pub const MOST_ANGLES: usize = 2048;
    /// The most levels: with so many the means are the profile itself, for comparisons.
    pub const MAX_LEVELS: u32 = 180;
    /// Pieces that are linear in the squared sine, of which a profile is made on the GPU, from the axis to
    /// its end: even in the sine of the half angle, or up to 16 times narrower on the axis, for narrow beams.
    pub const PIECES: usize = 64;

    /// A profile of rows of degrees from the front normal, from 0 to 90, rising, and a factor, linear between
    /// them. Before the first row the factor is the first one's, after the last one 0.
    ///
    /// Where it is not round each row has several factors, as many as each other, at azimuths that divide the
    /// circle evenly and linear between them. Azimuth 0 is where the first edge of the light's outline goes,
    /// of a disk `axis_u`; from there they go on counter-clockwise as seen from behind, which of a lamp that
    /// hangs is from above. The GPU has six harmonics of them.
    ///
    /// `levels`: how many angles, from 1 to [`Profile::MAX_LEVELS`], divide it; they are placed by the
    /// profile's own curve. On the known cases 4 have an error of 1 % on Lambert surfaces and 3 % on glossy
    /// ones, RMSE over mean, 8 of .3 and 1 %; each costs where its edge crosses the light.
    ///
    /// # Errors
    /// [`LightFault::BadProfile`] says what is wrong.
    pub fn new<R: AsRef<[f64]>>(rows: &[R], levels: u32) -> Result<Self, LightFault> {
        let wrong = |reason: String| Err(LightFault::BadProfile { reason });
        let Some(count) = rows.first().map(|row| row.as_ref().len()) else {
            return wrong("no pair given: give degrees from the front normal and a factor".into());
        };
        if rows.len().max(count) > Self::MOST_ANGLES {
            let most = Self::MOST_ANGLES;
            return wrong(format!("{} rows of {count} numbers, at most {most} of each", rows.len()));
        }
        if !(1..=Self::MAX_LEVELS).contains(&levels) {
            return wrong(format!("levels: {levels} is not from 1 to {}", Self::MAX_LEVELS));
        }
        let (mut before, mut angles, mut factors) = (-1.0, vec![], vec![]);
        for (index, row) in rows.iter().enumerate() {
            let (row, numbers) = (row.as_ref(), row.as_ref().len());
            let (2.., true, [degrees, row @ ..]) = (count, numbers == count, row) else {
                let expected = count.max(2);
                return wrong(format!("pairs[{index}] has {numbers} numbers, where {expected} are"));
            };
            let degrees = *degrees;
            if !(0.0..=90.0).contains(&degrees) || degrees <= before {
                return wrong(format!("pairs[{index}]: {degrees} degrees: they rise from 0 to at most 90"));
            }
            if let Some(factor) = row.iter().find(|it| !(0.0..=f64::from(f32::MAX)).contains(*it)) {
                return wrong(format!("pairs[{index}]: a factor of {factor} is not finite and from 0 on"));
            }
            before = degrees;
            angles.push(degrees);
            factors.extend_from_slice(row);
        }
        let mean = |row: &[f64]| row.iter().sum::<f64>() / row.len() as f64;
        let pairs: Vec<[f64; 2]> =
            angles.iter().zip(factors.chunks(count - 1)).map(|(angle, row)| [*angle, mean(row)]).collect();
        let dark = pairs.iter().rposition(|[_, factor]| *factor > 0.0);
        let Some(last) = dark else {
            return wrong("every factor is 0: leave the light out".into());
        };
        let end = pairs.get(last + 1).unwrap_or(&pairs[last])[0].to_radians();
        if end == 0.0 {
            return wrong("it ends at 0 degrees: nothing is that narrow".into());
        }
        let end_cosine = end.cos().max(0.0);
        let mut profile = Self { pairs, azimuths: None, end: end_cosine, levels: Vec::new(), crowding: 1.0 };
        let angle = |place: f64| angle_of(1.0 - place * place / profile.piece_scale()).to_degrees();
        profile.azimuths = Azimuths::new(&angles, &factors, angle);
        let by = |crowding: f64| Self { crowding, ..profile.clone() }.pieces_error();
        let tried = [1.0, 2.0, 4.0, 8.0, 16.0].map(|crowding| (by(crowding), crowding));
        profile.crowding = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(1.0, |best| best.1);
        profile.levels = profile.placed_levels(end, levels as usize);
        Ok(profile)
    }

    /// The same on other levels, from 1 to [`Profile::MAX_LEVELS`].
    #[must_use]
    pub fn with_levels(&self, levels: u32) -> Self {
        let levels = levels.clamp(1, Self::MAX_LEVELS) as usize;
        Self { levels: self.placed_levels(angle_of(self.end), levels), ..self.clone() }
    }

    /// That of the same light in a mirror, whose azimuth 0 is where the mirror image of the first edge comes
    /// from.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { azimuths: self.azimuths.as_ref().map(Azimuths::mirrored), ..self.clone() }
    }

    /// The cone of a spot, as `KHR_lights_punctual` has it, for a flat light: with it the light's *intensity*
    /// is that on its axis up to the angle `inner`, and from there falls to 0 at `outer`, as the square of
    /// what is left of the cosine. In radians, 0 <= inner, outer <= pi / 2; with inner >= outer it ends at
    /// once.
    ///
    /// # Errors
    /// [`LightFault::BadProfile`] for other angles, and as [`Profile::new`].
    pub fn cone(inner: f64, outer: f64, levels: u32) -> Result<Self, LightFault> {
        if !(outer > 0.0 && outer <= FRAC_PI_2 + 1e-6 && inner >= 0.0) {
            let reason = format!("a cone of {inner} and {outer} rad: 0 <= inner, 0 < outer <= pi / 2");
            return Err(LightFault::BadProfile { reason });
        }
        // At a right angle nothing is seen of a flat light
        let inner = inner.min(outer * 0.999).min(1.55);
        let scale = 1.0 / (inner.cos() - outer.cos());
        let factor = |angle: f64| {
            let part = ((angle.cos() - outer.cos()) * scale).clamp(0.0, 1.0);
            part * part / angle.cos().max(1e-3)
        };
        let steps = |from: f64, to: f64| (0..24).map(move |i| from + (to - from) * f64::from(i) / 24.0);
        let inside = (inner > 0.0).then(|| steps(0.0, inner)).into_iter().flatten();
        let mut pairs: Vec<[f64; 2]> =
            inside.chain(steps(inner, outer)).map(|angle| [angle.to_degrees(), factor(angle)]).collect();
        pairs.push([outer.to_degrees().min(90.0), 0.0]);
        Self::new(&pairs, levels)
    }

    /// The spread of an area light as Cycles has it: behind slats that hide what goes more than half of
    /// `angle` aside, radians, up to pi. Its power is that of the light without.
    ///
    /// # Errors
    /// [`LightFault::BadProfile`] for other angles, and as [`Profile::new`].
    pub fn spread(angle: f64, levels: u32) -> Result<Self, LightFault> {
        if !(angle > 0.0 && angle <= PI + 1e-6) {
            let reason = format!("a spread of {angle} rad: above 0, up to pi");
            return Err(LightFault::BadProfile { reason });
        }
        let half = 0.5 * angle;
        if half > FRAC_PI_2 - 1e-4 {
            return Self::new(&[[0.0, 1.0], [90.0, 1.0]], levels);
        }
        // The tangents' difference over the half angle's: 3 / half^3 where those cancel
        let scale = if half > 0.05 { 1.0 / (half.tan() - half) } else { 3.0 / half.powi(3) };
        let at = |i: u32| half * f64::from(i) / 90.0;
        let pairs: Vec<[f64; 2]> =
            (0..=90).map(|i| [at(i).to_degrees(), ((half.tan() - at(i).tan()) * scale).max(0.0)]).collect();
        Self::new(&pairs, levels)
    }

    /// The factor in a direction: the cosine of its angle from the front normal, and the azimuth in radians.
    pub fn factor_toward(&self, cosine: f64, azimuth: f64) -> f64 {
        let Some(azimuths) = &self.azimuths else { return self.factor(cosine) };
        let last = self.pairs[self.pairs.len() - 1][0];
        let degrees = angle_of(cosine).to_degrees();
        if cosine <= 0.0 || degrees > last { 0.0 } else { azimuths.factor(degrees, azimuth) }
    }

    /// What the factor is about a direction, in parts of its mean about the normal, as the GPU has it: `turn`
    /// is the azimuth's cosine and sine, `gathered` 1 at that azimuth, less the more it is all around.
    pub fn azimuth_part(&self, cosine: f64, turn: DVec2, gathered: f64) -> f64 {
        self.azimuths.as_ref().map_or(1.0, |azimuths| azimuths.part(self.side(cosine), turn, gathered))
    }

    /// The harmonics of the azimuth, place by place; none where it is round.
    pub(crate) fn harmonics(&self) -> &[Harmonics] {
        self.azimuths.as_ref().map_or(&[], |azimuths| &azimuths.harmonics)
    }

    /// The factor at a cosine of the angle from the front normal, the mean about it.
    pub fn factor(&self, cosine: f64) -> f64 {
        let last = self.pairs[self.pairs.len() - 1];
        let degrees = angle_of(cosine).to_degrees();
        if cosine <= 0.0 || degrees > last[0] {
            return 0.0;
        }
        let next = self.pairs.partition_point(|pair| pair[0] < degrees);
        let [to, high] = self.pairs[next.min(self.pairs.len() - 1)];
        let [from, low] = self.pairs[next.saturating_sub(1)];
        if to > from { low + (high - low) * ((degrees - from) / (to - from)) } else { high }
    }

    /// The cosine of the angle from which on the factor is 0; 0 where nothing before 90 degrees is.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The greatest factor.
    pub fn greatest(&self) -> f64 {
        let means = self.pairs.iter().map(|pair| pair[1]).fold(0.0, f64::max);
        self.azimuths.as_ref().map_or(means, Azimuths::greatest)
    }

    /// What a flat light with it sends, in parts of what it would send without: the mean of the factor over
    /// the hemisphere, by the cosine.
    pub fn power(&self) -> f64 {
        // Between pairs the factor is linear in the angle: its integral times the sine of twice the angle
        let integral = |[from, to]: [[f64; 2]; 2]| {
            let slope = (to[1] - from[1]) / (to[0] - from[0]).to_radians();
            let at = |[degrees, factor]: [f64; 2]| {
                let (sine, cosine) = (2.0 * degrees.to_radians()).sin_cos();
                0.25 * slope * sine - 0.5 * factor * cosine
            };
            at(to) - at(from)
        };
        let first = self.pairs[0];
        let before = if first[0] > 0.0 { integral([[0.0, first[1]], first]) } else { 0.0 };
        before + self.pairs.windows(2).map(|pair| integral([pair[0], pair[1]])).sum::<f64>()
    }

    /// Cosines of the levels, falling.
    pub fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// What the squared sine is multiplied with to be 1 where it ends.
    pub fn scale(&self) -> f64 {
        1.0 / (1.0 - self.end * self.end)
    }

    /// What 1 less the cosine is multiplied with to be 1 where it ends.
    pub fn piece_scale(&self) -> f64 {
        1.0 / (1.0 - self.end)
    }

    /// Its places as the GPU has them, [`Profile::PIECES`] and one. x is how far each is from the axis, the
    /// squared sine, in parts of where the profile ends: what a surface opposite of the light gets goes with
    /// it. y is the factor, and z the factor's integral over x from 0.
    pub fn places(&self) -> Vec<DVec3> {
        let mut places: Vec<DVec3> = Vec::with_capacity(Self::PIECES + 1);
        for index in 0..=Self::PIECES {
            // Just within the end, where a profile may fall to 0 at once
            let place = (index as f64 / Self::PIECES as f64).min(1.0 - 1e-9);
            let side = place / (self.crowding - (self.crowding - 1.0) * place);
            let cosine = 1.0 - side * side / self.piece_scale();
            let (x, factor) = ((1.0 - cosine * cosine) * self.scale(), self.factor(cosine));
            let x = if index == Self::PIECES { 1.0 } else { x };
            let sum = places.last().map_or(0.0, |last| last.z + 0.5 * (factor + last.y) * (x - last.x));
            places.push(DVec3::new(x, factor, sum));
        }
        places
    }

    /// How much narrower pieces are on the axis than if they were even in the sine of the half angle.
    pub fn crowding(&self) -> f64 {
        self.crowding
    }

    /// The sum of squares of how much the pieces differ from the factors, over the squared sine.
    fn pieces_error(&self) -> f64 {
        const STEPS: usize = 1024;
        let places = self.places();
        let cosines = (0..STEPS).map(|step| {
            let side = (step as f64 + 0.5) / STEPS as f64;
            (1.0 - side * side / self.piece_scale(), side)
        });
        cosines
            .map(|(cosine, side)| (self.place(&places, cosine).y - self.factor(cosine)).powi(2) * side)
            .sum()
    }

    /// How far from the axis a cosine is: 0 on it, 1 where the profile ends.
    fn side(&self, cosine: f64) -> f64 {
        ((1.0 - cosine) * self.piece_scale()).max(0.0).sqrt()
    }

    /// The place of a cosine, from those of [`Profile::places`].
    pub fn place(&self, places: &[DVec3], cosine: f64) -> DVec3 {
        let x = (1.0 - cosine * cosine) * self.scale();
        let side = self.side(cosine);
        let piece = side * self.crowding / (1.0 + (self.crowding - 1.0) * side) * Self::PIECES as f64;
        let piece = (piece as usize).min(Self::PIECES - 1);
        let [from, to] = [places[piece], places[piece + 1]];
        if x >= 1.0 {
            return DVec3::new(x, 0.0, to.z);
        }
        let step = x - from.x;
        let factor = from.y + (to.y - from.y) / (to.x - from.x) * step;
        DVec3::new(x, factor, from.z + 0.5 * (from.y + factor) * step)
    }

    /// Cosines that divide the profile so that the means between them differ least from it, in the sum of
    /// squares over the squared sine: by dynamic programming over 180 angles up to `end`, and what is dark
    /// after it. The factors count by a power, found by search: most of what a narrow beam lights is beside
    /// it, where a difference is a large part of the little that arrives.
    fn placed_levels(&self, end: f64, count: usize) -> Vec<f64> {
        const STEPS: usize = 180;
        const POWER: f64 = 0.6;
        let mut cosines: Vec<f64> =
            (0..=STEPS).map(|step| (end * step as f64 / STEPS as f64).cos()).collect();
        if end < FRAC_PI_2 - 1e-9 {
            cosines.push(0.0);
        }
        // Sums of cosines, of factors and of their squares
        let mut sums = vec![[0.0; 3]];
        for pair in cosines.windows(2) {
            let width = pair[0] * pair[0] - pair[1] * pair[1];
            let last = sums[sums.len() - 1];
            let factor = self.factor(0.5 * (pair[0] + pair[1])).powf(POWER);
            let added = [width, factor * width, factor * factor * width];
            sums.push(std::array::from_fn(|i| last[i] + added[i]));
        }
        let spread = |from: usize, to: usize| {
            let [width, sum, squares] = [0, 1, 2].map(|i| sums[to][i] - sums[from][i]);
            squares - sum * sum / width.max(1e-300)
        };
        let last = cosines.len() - 1;
        let mut least = (0..=last).map(|to| (spread(0, to), vec![])).collect::<Vec<(f64, Vec<usize>)>>();
        for _ in 0..count {
            let better = |to: usize| {
                let by = |from: usize| least[from].0 + spread(from, to);
                let best = (1..to).min_by(|a, b| by(*a).total_cmp(&by(*b)));
                best.filter(|from| by(*from) < least[to].0 - 1e-12).map_or_else(
                    || least[to].clone(),
                    |from| (by(from), [&least[from].1[..], &[from]].concat()),
                )
            };
            least = (0..=last).map(better).collect();
        }
        least[last].1.iter().map(|index| cosines[*index]).collect()
    }
}

/// The angle of a cosine, in radians from 0 to pi; what is just outside of [-1, 1] is at its end.
pub(crate) fn angle_of(cosine: f64) -> f64 {
    (1.0 - cosine * cosine).max(0.0).sqrt().atan2(cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(pairs: &[[f64; 2]], levels: u32) -> Profile {
        Profile::new(pairs, levels).unwrap()
    }

    #[test]
    fn levels_are_where_the_profile_changes() {
        let spot = profile(&[[0.0, 1.0], [18.0, 1.0], [32.0, 0.0]], 4);
        let degrees: Vec<f64> = spot.levels().iter().map(|cosine| angle_of(*cosine).to_degrees()).collect();
        assert!(degrees.len() == 4 && degrees.iter().all(|d| (18.0..32.0).contains(d)), "{degrees:?}");
        // What changes once needs one level, however many are asked for
        let step = profile(&[[0.0, 1.0], [29.999, 1.0], [30.0, 0.0]], 8);
        assert_eq!(step.levels().len(), 1);
        assert!((angle_of(step.levels()[0]).to_degrees() - 30.0).abs() < 0.2);
        // And what never changes none
        assert!(profile(&[[0.0, 0.5], [90.0, 0.5]], 4).levels().is_empty());
    }

    #[test]
    fn places_are_the_pairs() {
        let batwing = profile(&[[0.0, 0.5], [40.0, 1.0], [70.0, 0.1], [90.0, 0.0]], 4);
        let places = batwing.places();
        for degrees in 0..90 {
            let cosine = f64::from(degrees).to_radians().cos();
            let found = batwing.place(&places, cosine).y;
            // The kink of the peak is cut off by what the factor changes within half of a piece, .7 degrees
            assert!((found - batwing.factor(cosine)).abs() < 1.5e-2, "{degrees}: {found}");
        }
        // A narrow beam beside spill has its pieces where it is
        let beam = profile(&[[0.0, 1.0], [1.0, 0.9], [3.0, 0.02], [90.0, 0.0]], 4);
        let error = |profile: &Profile| {
            let (places, cosines) = (profile.places(), (0..60).map(|i| f64::from(i).to_radians() * 0.1));
            let apart =
                |angle: f64| (profile.place(&places, angle.cos()).y - profile.factor(angle.cos())).abs();
            cosines.map(apart).fold(0.0, f64::max)
        };
        assert!(error(&beam) < 0.02, "{}", error(&beam));
        assert!(error(&Profile { crowding: 1.0, ..beam }) > 0.1, "the twin: pieces as wide as each other");
        // Power: of all of the hemisphere 1, of the inner half of the cosine 3/4
        assert!((profile(&[[0.0, 1.0], [90.0, 1.0]], 4).power() - 1.0).abs() < 1e-6);
        assert!((profile(&[[0.0, 1.0], [59.999, 1.0], [60.0, 0.0]], 4).power() - 0.75).abs() < 1e-4);
    }

    #[test]
    fn a_spread_keeps_the_power_and_a_cone_the_intensity() {
        for degrees in [1.0_f64, 10.0, 60.0, 120.0, 170.0, 180.0] {
            let spread = Profile::spread(degrees.to_radians(), 4).unwrap();
            let power = spread.power();
            assert!((power - 1.0).abs() < 5e-3, "{degrees}: {power}");
        }
        let cone = Profile::cone(0.3, 0.6, 4).unwrap();
        assert!((cone.factor(0.25_f64.cos()) * 0.25_f64.cos() - 1.0).abs() < 1e-3);
        let half = angle_of(0.5 * (0.3_f64.cos() + 0.6_f64.cos()));
        assert!((cone.factor(half.cos()) * half.cos() - 0.25).abs() < 2e-3);
        assert_eq!(cone.factor(0.61_f64.cos()), 0.0);
        // A quarter of the sphere's light of one candela is pi lumens; of a cone that ends at once all of it
        let sharp = Profile::cone(0.5, 0.5, 4).unwrap();
        let flux = std::f64::consts::TAU * (1.0 - 0.5_f64.cos());
        assert!((sharp.power() * PI / flux - 1.0).abs() < 5e-3, "{}", sharp.power() * PI / flux);
        for (inner, outer) in [(0.0, 0.0), (-1.0, 1.0), (0.0, 2.0), (f64::NAN, 1.0), (0.0, f64::NAN)] {
            assert!(Profile::cone(inner, outer, 4).is_err(), "{inner} {outer}");
        }
        // As a float32 has half of pi
        assert!(Profile::cone(0.0, f64::from(std::f32::consts::FRAC_PI_2), 4).is_ok());
        assert!(Profile::spread(0.0, 4).is_err() && Profile::spread(f64::NAN, 4).is_err());
    }

    #[test]
    fn few_azimuths_keep_their_shape() {
        let row = |degrees: f64| vec![degrees, 1.0, 0.2, 0.6, 0.2];
        let profile = Profile::new(&[row(0.0), row(80.0)], 4).unwrap();
        for azimuth in [0.0, 0.4, 0.5 * PI, 2.0, PI] {
            let part = profile.azimuth_part(0.9, DVec2::from_angle(azimuth), 1.0);
            // Six harmonics of the cosine's have .03 of it; none are .5
            let off = part * 0.5 - profile.factor_toward(0.9, azimuth);
            assert!(off.abs() < 0.05, "{azimuth}: {off}");
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (pairs, levels, expected) in [
            (&[] as &[[f64; 2]], 4, "no pair"),
            (&[[0.0, 1.0]], 4, "it ends at 0"),
            (&[[0.0, 1.0], [90.0, 0.0]], 0, "levels: 0"),
            (&[[0.0, 1.0], [90.0, 0.0]], 181, "levels: 181"),
            (&[[0.0, 1.0], [0.0, 1.0]], 4, "pairs[1]: 0 degrees"),
            (&[[0.0, 1.0], [91.0, 1.0]], 4, "pairs[1]: 91 degrees"),
            (&[[f64::NAN, 1.0]], 4, "pairs[0]: NaN degrees"),
            (&[[0.0, -1.0]], 4, "pairs[0]: a factor of -1"),
            (&[[0.0, f64::INFINITY]], 4, "pairs[0]: a factor of inf"),
            (&[[0.0, 0.0], [90.0, 0.0]], 4, "every factor is 0"),
        ] {
            let message = Profile::new(pairs, levels).unwrap_err().to_string();
            assert!(message.starts_with(&format!("profile: {expected}")), "{message}");
        }
        let rows = |rows: &[Vec<f64>]| Profile::new(rows, 4).unwrap_err().to_string();
        assert_eq!(rows(&[vec![0.0], vec![90.0]]), "profile: pairs[0] has 1 numbers, where 2 are");
        let uneven = rows(&[vec![0.0, 1.0, 2.0], vec![90.0, 1.0]]);
        assert_eq!(uneven, "profile: pairs[1] has 2 numbers, where 3 are");
        assert!(rows(&[vec![0.0; 4000]]).contains("4000 numbers, at most"));
    }
}
