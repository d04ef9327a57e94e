//! Quality levels, as options of a command.

use crate::failure::Failure;
use arealight::{Footprint, FormFactor, Horizon, LightTable, Lobes, Quality, SpecularLobes};
use std::path::PathBuf;

/// How lights are integrated.
#[derive(clap::Args, Clone, Debug)]
pub struct QualityArguments {
    /// How edges of lights are integrated [default: exact for render, difference for eval]
    #[arg(long, value_enum, value_name = "HOW")]
    form_factor: Option<Edges>,
    /// Where lights are clipped
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = Clip::Cosine)]
    horizon: Clip,
    /// How the specular lobe is integrated [default: one for render, two for eval]
    #[arg(long, value_enum, value_name = "HOW")]
    specular_lobes: Option<Specular>,
    /// Where the glossy lobe comes from
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = Source::Table)]
    lobes: Source,
    /// How light textures are looked up [default: round for render, split for eval]
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

/// How the part of a texture that a lobe sees is looked up.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Lookup {
    /// One fetch with a round footprint
    Round,
    /// Four fetches along the footprint's longer axis
    Ellipse,
    /// The light in four by four parts, a form factor and two fetches each
    Split,
}

impl Default for QualityArguments {
    fn default() -> Self {
        Self {
            form_factor: None,
            horizon: Clip::Cosine,
            specular_lobes: None,
            lobes: Source::Table,
            footprint: None,
            table: None,
        }
    }
}

impl QualityArguments {
    /// The levels chosen, and those of `default` where none is.
    pub fn quality_or(&self, default: Quality) -> Quality {
        let form_factor = match self.form_factor {
            None => default.form_factor,
            Some(Edges::Exact) => FormFactor::Exact,
            Some(Edges::Difference) => FormFactor::Difference,
        };
        let horizon = match self.horizon {
            Clip::Cosine => Horizon::Cosine,
            Clip::Both => Horizon::Both,
        };
        let specular_lobes = self.specular_lobes.map_or(default.specular_lobes, SpecularLobes::from);
        let lobes = match self.lobes {
            Source::Table => Lobes::Table,
            Source::Formula => Lobes::Formula,
        };
        let footprint = match self.footprint {
            None => default.footprint,
            Some(Lookup::Round) => Footprint::Round,
            Some(Lookup::Ellipse) => Footprint::Ellipse,
            Some(Lookup::Split) => Footprint::Split,
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
