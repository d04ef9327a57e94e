//! The rungs of the quality ladder, as options of a command.

use arealight::{FormFactor, Horizon, Quality};

/// How lights are integrated.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct QualityArguments {
    /// How edges of lights are integrated
    #[arg(long, value_enum, value_name = "RUNG", default_value_t = Rung::Exact)]
    form_factor: Rung,
    /// Where lights are clipped
    #[arg(long, value_enum, value_name = "WHERE", default_value_t = Clip::Cosine)]
    horizon: Clip,
    /// Take far lights from their centre alone where that is within 1e-4, relative
    #[arg(long)]
    one_point: bool,
}

/// The rungs of the form factor.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Rung {
    /// float32's own precision, absolute: 1e-6
    Exact,
    /// 2.7e-5 of each edge's share, fewer instructions
    Fast,
    /// As exact, and as precise relative to lights that look small
    ExactDifference,
    /// As fast, with an error that shrinks with the light
    FastDifference,
}

/// Where polygons are clipped. The bare rung is left out: whether it is right depends on the pixel.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Clip {
    /// At the horizon of the lobe's cosine space; some light leaks in from below the surface
    Cosine,
    /// At the surface's horizon as well: nothing leaks
    Both,
}

impl Default for QualityArguments {
    fn default() -> Self {
        Self { form_factor: Rung::Exact, horizon: Clip::Cosine, one_point: false }
    }
}

impl QualityArguments {
    /// The rungs chosen.
    pub fn quality(self) -> Quality {
        let form_factor = match self.form_factor {
            Rung::Exact => FormFactor::Exact,
            Rung::Fast => FormFactor::Fast,
            Rung::ExactDifference => FormFactor::ExactDifference,
            Rung::FastDifference => FormFactor::FastDifference,
        };
        let horizon = match self.horizon {
            Clip::Cosine => Horizon::Cosine,
            Clip::Both => Horizon::Both,
        };
        Quality { form_factor, horizon, one_point: self.one_point }
    }
}
