//! From a budget to levels: what was measured on a device picks the quality there ([`Profile::within`]).

use arealight::Quality;

/// A quality with what it costs and errs on one device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileLevel {
    /// The levels.
    pub quality: Quality,
    /// Whether it was measured with textured lights ([`arealight::Effects::TEXTURED`]).
    pub textured: bool,
    /// The error: root of the mean square over the mean.
    pub error: f64,
    /// Milliseconds of a megapixel without lights.
    pub fixed: f64,
    /// Milliseconds that each light adds to a megapixel.
    pub per_light: f64,
}

impl ProfileLevel {
    /// Milliseconds that a frame takes.
    pub fn milliseconds(&self, frame: FrameLoad) -> f64 {
        frame.megapixels * (self.fixed + f64::from(frame.lights) * self.per_light)
    }
}

/// What was measured on a device: `arealight bench --save` writes it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// The device's name.
    pub device: String,
    /// Its quality levels.
    pub levels: Vec<ProfileLevel>,
}

/// What a pass has to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameLoad {
    /// Lights of the frame, which every pixel is shaded with.
    pub lights: u32,
    /// Pixels, in millions.
    pub megapixels: f64,
    /// Whether some light is textured.
    pub textured: bool,
}

/// What may not be exceeded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// Milliseconds of the pass.
    Milliseconds(f64),
    /// The error: root of the mean square over the mean.
    Error(f64),
}

/// A frame, and what may not be exceeded on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// The frame.
    pub frame: FrameLoad,
    /// The limit.
    pub limit: Limit,
}

/// Why no level was picked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BudgetError {
    /// A limit, or the frame's size, is no number above zero.
    #[error("{field}: {value} is not a number above 0")]
    NotPositive {
        /// What it is of.
        field: &'static str,
        /// What it is.
        value: f64,
    },
    /// Nothing was measured for such lights.
    #[error("the profile of '{device}' has no level for lights {}: measure it anew with `arealight bench \
    --save`", if *.textured { "that are textured" } else { "of one colour" })]
    NoLevel {
        /// The device.
        device: String,
        /// Whether some light is textured.
        textured: bool,
    },
    /// Even the fastest level takes longer.
    #[error(
        "no level takes at most {limit} ms on '{device}': the fastest takes {nearest:.3} ms ({quality:?}); \
        use fewer lights or pixels, \
         or allow {nearest:.3} ms"
    )]
    TooSlow {
        /// The device.
        device: String,
        /// The milliseconds allowed.
        limit: f64,
        /// Those of the fastest level.
        nearest: f64,
        /// The fastest level.
        quality: Box<Quality>,
    },
    /// Even the most accurate level errs more.
    #[error(
        "no level errs at most {limit} on '{device}': the most accurate errs {nearest:.5} ({quality:?}); \
        allow that, or use the \
         Monte Carlo reference"
    )]
    TooInaccurate {
        /// The device.
        device: String,
        /// The error allowed.
        limit: f64,
        /// That of the most accurate level.
        nearest: f64,
        /// The most accurate level.
        quality: Box<Quality>,
    },
}

/// Errors, or times, that are apart by no more than this factor count as equal: a level of the same error to
/// three digits must not be taken for its last one, at twice the time.
const EQUAL: f64 = 1.01;

impl Profile {
    /// Picks a level from what was measured on a device: the most accurate that takes no longer than allowed,
    /// or the fastest that errs no more than allowed. Of equals the faster, or the more accurate.
    ///
    /// Times are those of the profile's frame, scaled: they hold for the shade pass alone, for lights like
    /// the profile's, on the same device.
    ///
    /// # Errors
    /// [`BudgetError`] names the nearest level where none fits.
    pub fn within(&self, budget: Budget) -> Result<ProfileLevel, BudgetError> {
        let (Limit::Milliseconds(limit) | Limit::Error(limit)) = budget.limit;
        for (field, value) in [("limit", limit), ("megapixels", budget.frame.megapixels)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(BudgetError::NotPositive { field, value });
            }
        }
        // What is bounded first, then what is wanted
        let keys = |level: &ProfileLevel| {
            let milliseconds = level.milliseconds(budget.frame);
            match budget.limit {
                Limit::Milliseconds(_) => (milliseconds, level.error),
                Limit::Error(_) => (level.error, milliseconds),
            }
        };
        let measured = |level: &&ProfileLevel| {
            let (bounded, wanted) = keys(level);
            let is_known = |value: f64| value.is_finite() && value >= 0.0;
            level.textured == budget.frame.textured && is_known(bounded) && is_known(wanted)
        };
        let levels = || self.levels.iter().filter(measured);
        let allowed = || levels().filter(|level| keys(level).0 <= limit);
        if let Some(best) = allowed().map(|level| keys(level).1).min_by(f64::total_cmp) {
            let equal = allowed().filter(|level| keys(level).1 <= best * EQUAL);
            if let Some(best) = equal.min_by(|a, b| keys(a).0.total_cmp(&keys(b).0)) {
                return Ok(*best);
            }
        }
        let device = self.device.clone();
        let Some(nearest) = levels().min_by(|a, b| keys(a).0.total_cmp(&keys(b).0)) else {
            return Err(BudgetError::NoLevel { device, textured: budget.frame.textured });
        };
        let quality = Box::new(nearest.quality);
        let nearest = keys(nearest).0;
        Err(match budget.limit {
            Limit::Milliseconds(_) => BudgetError::TooSlow { device, limit, nearest, quality },
            Limit::Error(_) => BudgetError::TooInaccurate { device, limit, nearest, quality },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::{Footprint, FormFactor, Horizon, Lobes, SpecularLobes};

    const FORMULA: Quality = {
        let mut quality = EXACT;
        quality.lobes = Lobes::Formula;
        quality
    };
    const EXACT: Quality = Quality {
        form_factor: FormFactor::Exact,
        horizon: Horizon::Cosine,
        specular_lobes: SpecularLobes::One,
        lobes: Lobes::Table,
        footprint: Footprint::Round,
    };

    /// The formula has no table to read, and takes half as long for few lights.
    fn profile() -> Profile {
        let split = Quality { specular_lobes: SpecularLobes::Two, ..EXACT };
        let level = |quality, error, fixed, per_light| ProfileLevel {
            quality,
            textured: false,
            error,
            fixed,
            per_light,
        };
        Profile {
            device: "made up".into(),
            levels: vec![
                level(split, 0.01, 2.0, 3.0),
                level(EXACT, 0.02, 2.0, 2.0),
                level(FORMULA, 0.03, 1.0, 2.0),
                ProfileLevel { textured: true, ..level(EXACT, 0.05, 2.0, 4.0) },
            ],
        }
    }

    fn budget(lights: u32, limit: Limit) -> Budget {
        Budget { frame: FrameLoad { lights, megapixels: 0.5, textured: false }, limit }
    }

    #[test]
    fn the_most_accurate_level_that_is_fast_enough_is_picked() {
        let pick = |limit| profile().within(budget(10, Limit::Milliseconds(limit)));
        // 16, 11 and 10.5 ms
        assert_eq!(pick(16.0).unwrap().quality.specular_lobes, SpecularLobes::Two);
        assert_eq!(pick(15.99).unwrap().quality, EXACT);
        assert_eq!(pick(10.6).unwrap().quality, FORMULA);
        let error = pick(10.0).unwrap_err();
        assert!(matches!(&error, BudgetError::TooSlow { nearest, .. } if (*nearest - 10.5).abs() < 1e-12));
        assert!(error.to_string().contains("the fastest takes 10.500 ms"), "{error}");
        // Ten times as many lights take as much more
        let crowd = profile().within(budget(100, Limit::Milliseconds(16.0)));
        assert!(matches!(crowd, Err(BudgetError::TooSlow { .. })));
    }

    #[test]
    fn the_last_digit_of_an_error_is_not_paid_for() {
        let mut profile = profile();
        let dear = ProfileLevel { error: 0.01 * (1.0 - 1e-6), per_light: 7.0, ..profile.levels[0] };
        profile.levels.push(dear);
        let pick = |profile: &Profile| profile.within(budget(10, Limit::Milliseconds(1e3))).unwrap();
        assert_eq!(pick(&profile).per_light, 3.0);
        // What is better by more is
        profile.levels.last_mut().unwrap().error = 0.009;
        assert_eq!(pick(&profile).per_light, 7.0);
    }

    #[test]
    fn the_fastest_level_that_is_accurate_enough_is_picked() {
        let pick = |limit| profile().within(budget(1, Limit::Error(limit)));
        assert_eq!(pick(0.5).unwrap().quality, FORMULA);
        assert_eq!(pick(0.02).unwrap().quality, EXACT);
        assert_eq!(pick(0.015).unwrap().quality.specular_lobes, SpecularLobes::Two);
        let error = pick(0.001).unwrap_err();
        assert!(error.to_string().contains("the most accurate errs 0.01000"), "{error}");
    }

    #[test]
    fn lights_that_show_images_have_levels_of_their_own() {
        let mut load = budget(1, Limit::Error(0.05));
        load.frame.textured = true;
        assert_eq!(profile().within(load).unwrap().error, 0.05);
        let mut plain = profile();
        plain.levels.pop();
        let error = plain.within(load).unwrap_err();
        assert!(error.to_string().contains("no level for lights that are textured"), "{error}");
        assert!(matches!(
            Profile::default().within(budget(1, Limit::Error(0.1))),
            Err(BudgetError::NoLevel { .. })
        ));
    }

    #[test]
    fn what_is_no_budget_is_refused() {
        for limit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = profile().within(budget(1, Limit::Milliseconds(limit))).unwrap_err();
            assert!(matches!(error, BudgetError::NotPositive { field: "limit", .. }), "{error}");
        }
        let mut nowhere = budget(1, Limit::Error(0.1));
        nowhere.frame.megapixels = 0.0;
        assert!(matches!(
            profile().within(nowhere),
            Err(BudgetError::NotPositive { field: "megapixels", .. })
        ));
        // A level that was not measured is none
        let mut broken = profile();
        broken.levels.truncate(1);
        broken.levels[0].error = f64::NAN;
        let picked = broken.within(budget(1, Limit::Milliseconds(1e9)));
        assert!(matches!(picked, Err(BudgetError::NoLevel { .. })));
    }
}
