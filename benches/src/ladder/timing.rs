//! Time: every method in turn, round after round, as ratios to the same yardstick in the same round.

use super::frame::{Frame, Ready};
use super::methods::Method;
use arealight_engine::EngineError;
use serde::{Deserialize, Serialize};

/// The value below which so large a part of values is.
pub(crate) fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (part * (sorted.len().max(1) - 1) as f64).round() as usize;
    sorted.get(index).copied().unwrap_or(f64::NAN)
}

/// A median with its quartiles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The median over the rounds.
    pub median: f64,
    /// The quartiles.
    pub quartiles: [f64; 2],
}

impl Spread {
    /// Of one value a round.
    pub fn of(values: &[f64]) -> Self {
        let quantile = |part| quantile(values, part);
        Self { median: quantile(0.5), quartiles: [quantile(0.25), quantile(0.75)] }
    }

    /// Of one value a round over another in the same round.
    pub fn of_ratios(values: &[f64], to: &[f64]) -> Self {
        Self::of(&values.iter().zip(to).map(|(value, to)| value / to).collect::<Vec<_>>())
    }

    /// "The median, and the quartiles", for a table.
    pub(crate) fn cells(&self) -> [String; 2] {
        let [low, high] = self.quartiles;
        [format!("{:.2}", self.median), format!("{low:.2} to {high:.2}")]
    }

    /// Multiplied.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { median: self.median * factor, quartiles: self.quartiles.map(|value| value * factor) }
    }
}

/// What a method costs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Milliseconds a light and a megapixel, all in: the frame's time over its lights and pixels.
    pub milliseconds: Spread,
    /// The ratio to the first yardstick over quads, in the same round.
    pub ratio: Spread,
    /// Of them, milliseconds that a megapixel costs with no light.
    pub fixed: f64,
    /// Milliseconds that each light adds to a megapixel.
    pub per_light: f64,
}

/// A method on a frame.
pub struct Entry<'a> {
    frame: &'a Frame<'a>,
    ready: Ready,
}

impl<'a> Entry<'a> {
    /// Makes the pipeline.
    pub fn new(frame: &'a Frame<'a>, method: Method) -> Result<Self, EngineError> {
        Ok(Self { frame, ready: frame.ready(method)? })
    }
}

/// What the runs of a method took, in seconds: with one light, and with all.
#[derive(Debug, Clone, PartialEq)]
pub struct Clock {
    pixels: usize,
    seconds: [Vec<f64>; 2],
}

/// The lights of the frames.
const ALL: u32 = super::points::LIGHTS as u32;

impl Clock {
    /// Adds the rounds of another.
    pub fn extend(&mut self, other: Self) {
        for (seconds, other) in self.seconds.iter_mut().zip(other.seconds) {
            seconds.extend(other);
        }
    }

    /// The time, as a ratio to a yardstick's.
    pub fn time(&self, yardstick: &Self) -> Time {
        let [one, all] = &self.seconds;
        let added: Vec<f64> =
            one.iter().zip(all).map(|(one, all)| (all - one) / f64::from(ALL - 1)).collect();
        let per_megapixel = 1e3 / (self.pixels as f64 * 1e-6);
        let milliseconds = Spread::of(all).times(per_megapixel);
        let per_light =
            (quantile(&added, 0.5) * per_megapixel).clamp(0.0, milliseconds.median / f64::from(ALL));
        Time {
            milliseconds: milliseconds.times(1.0 / f64::from(ALL)),
            ratio: self.ratio(yardstick),
            fixed: (milliseconds.median - per_light * f64::from(ALL)).max(0.0),
            per_light,
        }
    }

    /// The time with all lights over another's, round by round.
    pub fn ratio(&self, other: &Self) -> Spread {
        Spread::of_ratios(&self.seconds[1], &other.seconds[1])
    }
}

/// Runs every entry in turn: a round to warm up, then `rounds`. `progress` is told of each round.
pub fn measure(
    entries: &[Entry<'_>],
    rounds: usize,
    progress: &dyn Fn(u64),
) -> Result<Vec<Clock>, EngineError> {
    let clock = |entry: &Entry<'_>| Clock { pixels: entry.frame.pixels(), seconds: [vec![], vec![]] };
    let mut clocks: Vec<Clock> = entries.iter().map(clock).collect();
    for round in 0..=rounds {
        for (entry, clock) in entries.iter().zip(&mut clocks) {
            for (lights, seconds) in [1, ALL].into_iter().zip(&mut clock.seconds) {
                let took = entry.frame.run(&entry.ready, lights, round as u32)?;
                if round > 0 {
                    seconds.push(took);
                }
            }
        }
        progress(super::LONG);
    }
    Ok(clocks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_a_median_between_quartiles() {
        let spread = Spread::of(&[5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((spread.median, spread.quartiles), (3.0, [2.0, 4.0]));
        assert_eq!(spread.times(2.0).quartiles, [4.0, 8.0]);
    }

    #[test]
    fn a_light_is_told_from_the_frame() {
        // A megapixel: a millisecond, and two for each light
        let clock = Clock { pixels: 1_000_000, seconds: [vec![0.003; 3], vec![0.009; 3]] };
        let time = clock.time(&Clock { pixels: 1_000_000, seconds: [vec![0.001; 3], vec![0.018; 3]] });
        assert!((time.per_light - 2.0).abs() < 1e-9 && (time.fixed - 1.0).abs() < 1e-9, "{time:?}");
        assert!((time.milliseconds.median - 2.25).abs() < 1e-9 && (time.ratio.median - 0.5).abs() < 1e-9);
    }
}
