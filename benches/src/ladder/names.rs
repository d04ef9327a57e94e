//! The levels of a quality as words, for files.

use arealight::{Footprint, FormFactor, Horizon, Lobes, Quality, SpecularLobes};
use serde::{Deserialize, Serialize};

/// A [`Quality`] in words, those of the options of `arealight render`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LevelNames {
    /// `--form-factor`
    pub form_factor: String,
    /// `--horizon`
    pub horizon: String,
    /// `--specular-lobes`
    pub specular_lobes: String,
    /// `--lobes`
    pub lobes: String,
    /// `--footprint`
    pub footprint: String,
}

/// A name that no level has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field}: '{name}' is no level; there are {}", .known.join(", "))]
pub struct UnknownLevel {
    /// The field.
    pub field: &'static str,
    /// What it says.
    pub name: String,
    /// What it may say.
    pub known: Vec<&'static str>,
}

const FORM_FACTORS: [(&str, FormFactor); 2] =
    [("exact", FormFactor::Exact), ("difference", FormFactor::Difference)];
const HORIZONS: [(&str, Horizon); 2] = [("cosine", Horizon::Cosine), ("both", Horizon::Both)];
const SPECULAR_LOBES: [(&str, SpecularLobes); 3] =
    [("one", SpecularLobes::One), ("two", SpecularLobes::Two), ("half_vectors", SpecularLobes::HalfVectors)];
const LOBES: [(&str, Lobes); 2] = [("table", Lobes::Table), ("formula", Lobes::Formula)];
const FOOTPRINTS: [(&str, Footprint); 3] =
    [("round", Footprint::Round), ("ellipse", Footprint::Ellipse), ("split", Footprint::Split)];

impl From<Quality> for LevelNames {
    fn from(quality: Quality) -> Self {
        fn name<T: Copy + PartialEq>(names: &[(&str, T)], level: T) -> String {
            let known = names.iter().find(|(_, known)| *known == level);
            known.map_or_else(String::new, |(name, _)| (*name).to_owned())
        }
        Self {
            form_factor: name(&FORM_FACTORS, quality.form_factor),
            horizon: name(&HORIZONS, quality.horizon),
            specular_lobes: name(&SPECULAR_LOBES, quality.specular_lobes),
            lobes: name(&LOBES, quality.lobes),
            footprint: name(&FOOTPRINTS, quality.footprint),
        }
    }
}

impl LevelNames {
    /// The levels.
    ///
    /// # Errors
    /// [`UnknownLevel`] names the field.
    pub fn quality(&self) -> Result<Quality, UnknownLevel> {
        fn find<T: Copy>(
            names: &[(&'static str, T)],
            field: &'static str,
            name: &str,
        ) -> Result<T, UnknownLevel> {
            let known = || names.iter().map(|(known, _)| *known).collect();
            let found = names.iter().find(|(known, _)| *known == name).map(|(_, level)| *level);
            found.ok_or_else(|| UnknownLevel { field, name: name.to_owned(), known: known() })
        }
        Ok(Quality {
            form_factor: find(&FORM_FACTORS, "form_factor", &self.form_factor)?,
            horizon: find(&HORIZONS, "horizon", &self.horizon)?,
            specular_lobes: find(&SPECULAR_LOBES, "specular_lobes", &self.specular_lobes)?,
            lobes: find(&LOBES, "lobes", &self.lobes)?,
            footprint: find(&FOOTPRINTS, "footprint", &self.footprint)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_has_a_name_and_is_found_by_it() {
        for (_, form_factor) in FORM_FACTORS {
            for (_, horizon) in HORIZONS {
                for (_, footprint) in FOOTPRINTS {
                    let quality = Quality { form_factor, horizon, footprint, ..Quality::default() };
                    assert_eq!(LevelNames::from(quality).quality(), Ok(quality));
                }
            }
        }
        let wrong = LevelNames { lobes: "magic".into(), ..LevelNames::from(Quality::default()) };
        let error = wrong.quality().unwrap_err().to_string();
        assert_eq!(error, "lobes: 'magic' is no level; there are table, formula");
    }
}
