//! Quality levels, as options of a command.

use crate::failure::Failure;
use crate::output::keep;
use arealight::{Effects, Footprint, Horizon, Level, LightTable, Lobes, Quality, SpecularLobes};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;

/// A choice within a level: its word, what it is, and the choice.
type Choice<T> = (&'static str, &'static str, T);

const HORIZONS: [Choice<Horizon>; 2] = [
    (
        "cosine",
        "At the horizon of the lobe's cosine space; some light leaks in from below the surface",
        Horizon::Cosine,
    ),
    ("both", "At the surface's horizon as well: nothing leaks", Horizon::Both),
];
const SPECULAR_LOBES: [Choice<SpecularLobes>; 3] = [
    ("one", "By one transformed cosine: an integral a light", SpecularLobes::One),
    ("two", "By two: two integrals a light, at .6 to .8 times the error", SpecularLobes::Two),
    (
        "half-vectors",
        "GGX itself over half vectors of polygons and meshes: closest to lamps, and to brushed metals",
        SpecularLobes::HalfVectors,
    ),
];
/// Those that are fitted.
pub const FITTED_LOBES: [Choice<SpecularLobes>; 2] = [SPECULAR_LOBES[0], SPECULAR_LOBES[1]];
const LOBES: [Choice<Lobes>; 2] =
    [("table", "The table", Lobes::Table), ("formula", "Formulas, without a texture", Lobes::Formula)];
const FOOTPRINTS: [Choice<Footprint>; 2] = [
    ("kernel", "Three fetches of the image filtered by the lobe's own kernel", Footprint::Kernel),
    ("mips", "One fetch of plain mips, as in Heitz et al. 2016", Footprint::Mips),
];

/// Takes the words of choices, which help texts list.
pub fn word_of<T: Copy + Send + Sync>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T> {
    let words = choices.iter().map(|(word, what, _)| PossibleValue::new(*word).help(*what));
    PossibleValuesParser::new(words).map(|found| {
        let known = choices.iter().find(|(word, ..)| *word == found);
        known.expect("clap takes no other word").2
    })
}

/// How lights are integrated.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Quality")]
pub struct QualityArguments {
    /// The quality level; docs/cost.md says which to take [default: exact; of pictures of
    /// brushed metal, thin films or coats half-vectors]
    #[arg(long, value_name = "LEVEL", value_parser = level_parser())]
    level: Option<Level>,
    /// Within the level: where lights are clipped
    #[arg(long, value_name = "WHERE", value_parser = word_of(&HORIZONS))]
    horizon: Option<Horizon>,
    /// Within the level: how the specular lobe is integrated
    #[arg(long, value_name = "HOW", value_parser = word_of(&SPECULAR_LOBES))]
    specular_lobes: Option<SpecularLobes>,
    /// Within the level: where the glossy lobe comes from
    #[arg(long, value_name = "WHERE", value_parser = word_of(&LOBES))]
    lobes: Option<Lobes>,
    /// How light textures are looked up [default: kernel]
    #[arg(long, value_name = "HOW", value_parser = word_of(&FOOTPRINTS))]
    footprint: Option<Footprint>,
    /// A fitted table, of any format that `arealight table` writes; the built-in one if absent
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
}

/// The names of levels, with hyphens for spaces.
fn level_parser() -> impl TypedValueParser<Value = Level> {
    let word = |level: Level| level.name().replace(' ', "-");
    PossibleValuesParser::new(Level::ALL.map(word)).map(move |name| {
        let known = Level::ALL.into_iter().find(|level| word(*level) == name);
        known.expect("clap takes no other name")
    })
}

impl QualityArguments {
    /// The level chosen, or the default, with what was chosen within it.
    pub fn quality(&self) -> Quality {
        self.within(self.level.unwrap_or_default())
    }

    /// The level chosen, or the one that fits surfaces of these effects.
    pub fn level_of(&self, surfaces: Effects) -> Level {
        self.level.unwrap_or_else(|| Level::for_surfaces(surfaces))
    }

    /// A level with what was chosen within it.
    pub fn within(&self, level: Level) -> Quality {
        let default = level.quality();
        let lobes = self.lobes.unwrap_or(default.lobes);
        let specular_lobes = match self.specular_lobes.unwrap_or(default.specular_lobes) {
            SpecularLobes::Two if lobes == Lobes::Formula => SpecularLobes::One, // which it falls back to
            chosen => chosen,
        };
        Quality {
            horizon: self.horizon.unwrap_or(default.horizon),
            specular_lobes,
            lobes,
            footprint: self.footprint.unwrap_or(default.footprint),
        }
    }

    /// The table chosen.
    ///
    /// # Errors
    /// A file that cannot be read, or holds no table.
    pub fn table(&self) -> Result<LightTable, Failure> {
        match &self.table {
            None => Ok(LightTable::ggx()),
            Some(path) => {
                keep(path);
                let table = arealight_table::load(path).map_err(|error| Failure::input(path, error))?;
                if table.pairs().is_none() && self.quality().specular_lobes == SpecularLobes::Two {
                    return Err(Failure::input(path, "the table has no pairs of lobes: choose one"));
                }
                Ok(table)
            }
        }
    }
}

/// The level that is a quality.
pub fn name_of(quality: Quality) -> &'static str {
    let level = Level::ALL.into_iter().find(|level| level.quality() == quality);
    level.map_or("of these options", Level::name)
}

/// What a level chooses, by the names of its options.
pub fn said(quality: Quality) -> serde_json::Value {
    fn word<T: PartialEq>(choices: &[Choice<T>], chosen: &T) -> &'static str {
        choices.iter().find(|(.., choice)| choice == chosen).map_or("", |(word, ..)| *word)
    }
    serde_json::json!({
        "horizon": word(&HORIZONS, &quality.horizon),
        "specular_lobes": word(&SPECULAR_LOBES, &quality.specular_lobes),
        "lobes": word(&LOBES, &quality.lobes),
        "footprint": word(&FOOTPRINTS, &quality.footprint),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        quality: QualityArguments,
    }

    fn chosen(words: &[&str]) -> Option<Quality> {
        let command = Command::try_parse_from([&["command"], words].concat()).ok()?;
        Some(command.quality.quality())
    }

    #[test]
    fn a_level_is_the_default_of_what_is_chosen_within_it() {
        assert_eq!(chosen(&[]), Some(Quality::default()));
        for level in Level::ALL {
            assert_eq!(chosen(&["--level", &level.name().replace(' ', "-")]), Some(level.quality()));
        }
        let narrower = Quality { horizon: Horizon::Cosine, ..Level::Finest.quality() };
        assert_eq!(chosen(&["--level", "finest", "--horizon", "cosine"]), Some(narrower));
        assert_ne!(narrower, Level::Finest.quality());
        assert_eq!(chosen(&["--level", "best"]), None);
        // Scenes choose where nobody does
        let of = |words: &[&str], surfaces| {
            let command = Command::try_parse_from([&["command"], words].concat()).expect("a level");
            command.quality.level_of(surfaces)
        };
        for surfaces in [Effects::ANISOTROPY, Effects::THIN_FILM, Effects::COAT] {
            assert_eq!(of(&[], surfaces | Effects::GLOSSY), Level::HalfVectors);
            assert_eq!(of(&["--level", "formula"], surfaces), Level::Formula);
        }
        assert_eq!(of(&[], Effects::GLOSSY | Effects::SHEEN), Level::Exact);
    }

    #[test]
    fn what_is_said_of_a_level_chooses_it() {
        for level in Level::ALL.map(Level::quality) {
            let said = said(level);
            let words = said.as_object().unwrap().iter();
            let words: Vec<String> = words
                .flat_map(|(option, value)| {
                    [format!("--{}", option.replace('_', "-")), value.as_str().unwrap().to_owned()]
                })
                .collect();
            assert_eq!(chosen(&words.iter().map(String::as_str).collect::<Vec<_>>()), Some(level), "{said}");
        }
    }

    #[test]
    fn no_two_levels_are_the_same() {
        for (i, level) in Level::ALL.into_iter().enumerate() {
            assert_eq!(level as usize, i);
            for other in &Level::ALL[..i] {
                assert_ne!(level.quality(), other.quality(), "{}", level.name());
            }
        }
    }
}
