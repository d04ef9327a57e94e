//! Profiles that are not round: factors by azimuth, and the few harmonics of them that the GPU has.

use glam::DVec2;
use std::f64::consts::TAU;

/// Factors by the angle from the front and the azimuth about it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Azimuths {
    /// Degrees from the front, rising.
    angles: Vec<f64>,
    /// Of each angle the factors at azimuths that divide the circle evenly.
    factors: Vec<f64>,
    pub harmonics: Vec<Harmonics>,
}

/// Of the cosine and the sine of 1 to [`HARMONICS`] times the azimuth.
pub(crate) type Harmonics = [DVec2; HARMONICS];
pub(crate) const HARMONICS: usize = 6;
/// Their rows lie as the pieces of the profile do, between the axis and its end.
pub(crate) const PLACES: usize = 32;

impl Azimuths {
    /// None where the factors of each angle are all the same. `angle` tells the degrees of a place in [0, 1].
    pub fn new(angles: &[f64], factors: &[f64], angle: impl Fn(f64) -> f64) -> Option<Self> {
        let rows = factors.chunks(factors.len() / angles.len());
        if rows.into_iter().all(|row| row.iter().all(|factor| *factor == row[0])) {
            return None;
        }
        let mut made = Self { angles: angles.to_vec(), factors: factors.to_vec(), harmonics: Vec::new() };
        let rows = (0..=PLACES).map(|index| made.row(angle(index as f64 / PLACES as f64)));
        made.harmonics = rows.map(|row| harmonics(&row)).collect();
        Some(made)
    }

    /// Those of a mirror image, the azimuth counted from the other side.
    pub fn mirrored(&self) -> Self {
        let count = self.factors.len() / self.angles.len();
        // 180 degrees is at a factor or, of an odd number of them, between two
        let at = |row: &[f64], half: usize| 0.5 * (row[half / 2 % count] + row[half.div_ceil(2) % count]);
        let turned = |row: &[f64]| -> Vec<f64> { (0..2 * count).map(|k| at(row, 3 * count - k)).collect() };
        let factors = self.factors.chunks(count).flat_map(turned).collect();
        let mirror = |all: &Harmonics| {
            // cos and sin of m (180 degrees - azimuth)
            std::array::from_fn(|k| {
                all[k] * if k % 2 == 0 { DVec2::new(-1.0, 1.0) } else { DVec2::new(1.0, -1.0) }
            })
        };
        let harmonics = self.harmonics.iter().map(mirror).collect();
        Self { angles: self.angles.clone(), factors, harmonics }
    }

    /// The factors about the axis of the angles before and after one, degrees, and how far it is between.
    fn around(&self, degrees: f64) -> ([&[f64]; 2], f64) {
        let count = self.factors.len() / self.angles.len();
        let next = self.angles.partition_point(|angle| *angle < degrees).min(self.angles.len() - 1);
        let before = next.saturating_sub(1);
        let width = self.angles[next] - self.angles[before];
        let part = if width > 0.0 { ((degrees - self.angles[before]) / width).clamp(0.0, 1.0) } else { 1.0 };
        ([before, next].map(|row| &self.factors[row * count..][..count]), part)
    }

    /// The factors about the axis at an angle between the first and the last, degrees.
    fn row(&self, degrees: f64) -> Vec<f64> {
        let ([low, high], part) = self.around(degrees);
        low.iter().zip(high).map(|(low, high)| low + (high - low) * part).collect()
    }

    /// The factor in a direction: degrees, and radians about the axis.
    pub fn factor(&self, degrees: f64, azimuth: f64) -> f64 {
        let ([low, high], part) = self.around(degrees);
        let place = (azimuth / TAU).rem_euclid(1.0) * low.len() as f64;
        let columns = [place as usize % low.len(), (place as usize + 1) % low.len()];
        let [from, to] = columns.map(|column| low[column] + (high[column] - low[column]) * part);
        from + (to - from) * place.fract()
    }

    /// The greatest factor.
    pub fn greatest(&self) -> f64 {
        self.factors.iter().copied().fold(0.0, f64::max)
    }

    /// The factor about an azimuth in parts of the mean about the axis: `place` as the pieces have it, in
    /// [0, 1], `turn` the azimuth's cosine and sine, `gathered` whether it is at one azimuth, 1, or all
    /// around, 0. The twin of `arealight_profile_azimuth`.
    pub fn part(&self, place: f64, turn: DVec2, gathered: f64) -> f64 {
        let place = place.clamp(0.0, 1.0) * PLACES as f64;
        let row = (place as usize).min(PLACES - 1);
        let (mut power, mut damped, mut step, mut sum) = (turn, 1.0, gathered, 1.0);
        for (from, to) in self.harmonics[row].iter().zip(self.harmonics[row + 1]) {
            damped *= step;
            step *= gathered * gathered;
            sum += damped * from.lerp(to, place - row as f64).dot(power);
            power = power.rotate(turn);
        }
        sum.max(0.0)
    }
}

/// The harmonics of factors at azimuths that divide the circle evenly, linear between them.
fn harmonics(row: &[f64]) -> Harmonics {
    let step = TAU / row.len() as f64;
    let mean = row.iter().sum::<f64>() / row.len() as f64;
    std::array::from_fn(|k| {
        let turn = step * (k + 1) as f64;
        let at = |(index, factor): (usize, &f64)| DVec2::from_angle(turn * index as f64) * *factor;
        let sum: DVec2 = row.iter().enumerate().map(at).sum();
        let linear = ((0.5 * turn).sin() / (0.5 * turn)).powi(2);
        sum * (2.0 * linear / (row.len() as f64 * mean.max(1e-30)))
    })
}
