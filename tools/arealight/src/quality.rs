//! Quality levels, as options of a command.

use crate::failure::Failure;
use arealight::{Effects, Footprint, FormFactor, Horizon, Level, LightTable, Lobes, Quality, SpecularLobes};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;

/// How lights are integrated.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Quality")]
pub struct QualityArguments {
    /// The quality level; docs/cost.md says which to take [default: exact, and of scenes
    /// with brushed metal, thin films or coats half-vectors]
    #[arg(long, value_name = "LEVEL", value_parser = level_parser())]
    level: Option<Level>,
    /// Within the level: how edges of lights are integrated
    #[arg(long, value_enum, value_name = "HOW")]
    form_factor: Option<Edges>,
    /// Within the level: where lights are clipped
    #[arg(long, value_enum, value_name = "WHERE")]
    horizon: Option<Clip>,
    /// Within the level: how the specular lobe is integrated
    #[arg(long, value_enum, value_name = "HOW")]
    specular_lobes: Option<Specular>,
    /// Within the level: where the glossy lobe comes from
    #[arg(long, value_enum, value_name = "WHERE")]
    lobes: Option<Source>,
    /// How light textures are looked up [default: kernel]
    #[arg(long, value_enum, value_name = "HOW")]
    footprint: Option<Lookup>,
    /// A fitted table, of any format that `arealight table` writes; the built-in one if absent
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
}

/// How edges are integrated.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Edges {
    /// float32's own precision, absolute: 1e-6
    Exact,
    /// As exact, and as precise relative to lights that look small
    Difference,
}

/// Where polygons are clipped.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Clip {
    /// At the horizon of the lobe's cosine space; some light leaks in from below the surface
    Cosine,
    /// At the surface's horizon as well: nothing leaks
    Both,
}

/// Where lobes come from.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Source {
    /// The table
    Table,
    /// Formulas, without a texture
    Formula,
}

/// How specular lobes are integrated.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Specular {
    /// By one transformed cosine: an integral a light
    One,
    /// By two: two integrals a light, at .6 to .8 times the error
    Two,
    /// GGX itself over half vectors of polygons and meshes: closest to lamps, and to brushed metals
    HalfVectors,
}

impl From<Specular> for SpecularLobes {
    fn from(specular: Specular) -> Self {
        match specular {
            Specular::One => Self::One,
            Specular::Two => Self::Two,
            Specular::HalfVectors => Self::HalfVectors,
        }
    }
}

/// How many lobes are integrated.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum LobeCount {
    /// One integral a light
    One,
    /// Two integrals a light, at .6 to .8 times the error
    Two,
}

impl From<LobeCount> for SpecularLobes {
    fn from(count: LobeCount) -> Self {
        match count {
            LobeCount::One => Self::One,
            LobeCount::Two => Self::Two,
        }
    }
}

/// The level to take for surfaces of these effects (docs/cost.md): of brushed metal, thin films or coats half
/// vectors.
pub fn level_for(surfaces: Effects) -> Level {
    let bent = Effects::ANISOTROPY | Effects::THIN_FILM | Effects::COAT;
    if surfaces.intersects(bent) { Level::HalfVectors } else { Level::default() }
}

/// How the part of a texture that a lobe sees is looked up.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Lookup {
    /// Three fetches of the image filtered by the lobe's own kernel
    Kernel,
    /// One fetch of plain mips, as in Heitz et al. 2016
    Mips,
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
        self.level.unwrap_or_else(|| level_for(surfaces))
    }

    /// A level with what was chosen within it.
    pub fn within(&self, level: Level) -> Quality {
        let default = level.quality();
        let form_factor = match self.form_factor {
            None => default.form_factor,
            Some(Edges::Exact) => FormFactor::Exact,
            Some(Edges::Difference) => FormFactor::Difference,
        };
        let horizon = match self.horizon {
            None => default.horizon,
            Some(Clip::Cosine) => Horizon::Cosine,
            Some(Clip::Both) => Horizon::Both,
        };
        let specular_lobes = self.specular_lobes.map_or(default.specular_lobes, SpecularLobes::from);
        let lobes = match self.lobes {
            None => default.lobes,
            Some(Source::Table) => Lobes::Table,
            Some(Source::Formula) => Lobes::Formula,
        };
        let footprint = match self.footprint {
            None => default.footprint,
            Some(Lookup::Kernel) => Footprint::Kernel,
            Some(Lookup::Mips) => Footprint::Mips,
        };
        Quality { form_factor, horizon, specular_lobes, lobes, footprint }
    }

    /// The table chosen.
    ///
    /// # Errors
    /// A file that cannot be read, or holds no table.
    pub fn table(&self) -> Result<LightTable, Failure> {
        match &self.table {
            None => Ok(LightTable::ggx()),
            Some(path) => arealight_table::load(path).map_err(|error| Failure::input(path, error)),
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
    let Quality { form_factor, horizon, specular_lobes, lobes, footprint } = quality;
    let specular_lobes = match specular_lobes {
        SpecularLobes::HalfVectors => "half-vectors".to_owned(),
        fitted => word(fitted),
    };
    serde_json::json!({
        "form_factor": word(form_factor),
        "horizon": word(horizon),
        "specular_lobes": specular_lobes,
        "lobes": word(lobes),
        "footprint": word(footprint),
    })
}

fn word(choice: impl std::fmt::Debug) -> String {
    format!("{choice:?}").to_lowercase()
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
