//! The levels of a quality as words, for files.

use arealight::{Footprint, Horizon, Lobes, Quality, SpecularLobes};
use serde::{Deserialize, Serialize};

/// A [`Quality`] in words, those of the options of `arealight render`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LevelNames {
    /// `--horizon`
    pub horizon: String,
    /// `--specular-lobes`
    pub specular_lobes: String,
    /// `--lobes`
    pub lobes: String,
    /// `--footprint`
    pub footprint: String,
}

const HORIZONS: [(&str, Horizon); 2] = [("cosine", Horizon::Cosine), ("both", Horizon::Both)];
const SPECULAR_LOBES: [(&str, SpecularLobes); 3] =
    [("one", SpecularLobes::One), ("two", SpecularLobes::Two), ("half_vectors", SpecularLobes::HalfVectors)];
const LOBES: [(&str, Lobes); 2] = [("table", Lobes::Table), ("formula", Lobes::Formula)];
const FOOTPRINTS: [(&str, Footprint); 2] = [("kernel", Footprint::Kernel), ("mips", Footprint::Mips)];

impl From<Quality> for LevelNames {
    fn from(quality: Quality) -> Self {
        fn name<T: Copy + PartialEq>(names: &[(&str, T)], level: T) -> String {
            let known = names.iter().find(|(_, known)| *known == level);
            known.map_or_else(String::new, |(name, _)| (*name).to_owned())
        }
        Self {
            horizon: name(&HORIZONS, quality.horizon),
            specular_lobes: name(&SPECULAR_LOBES, quality.specular_lobes),
            lobes: name(&LOBES, quality.lobes),
            footprint: name(&FOOTPRINTS, quality.footprint),
        }
    }
}
