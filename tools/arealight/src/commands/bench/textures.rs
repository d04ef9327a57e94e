//! `arealight bench textures`

use super::Ends;
use crate::failure::Failure;
use crate::progress;
use arealight_benches::footprints::{self, Options};
use std::process::ExitCode;

/// Check the error of every lookup of light textures.
///
/// Rectangles that show pictures are seen by surfaces of every roughness, on the device and through its
/// pyramid, by each level and by the filter of Heitz et al. 2016. Judged are the answers against the integral
/// of picture times lobe in float64: the root of their mean square error over the mean, the median of the
/// relative ones, and whether they are too bright on average. Times are of the same points in the same run.
///
/// Exit code 1 if a level misses its bar; what the article's filter does changes nothing.
#[derive(clap::Args)]
pub struct Arguments {
    /// Poses of each family; each is seen with every picture.
    #[arg(long, default_value_t = 600, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    poses: u32,
    /// Another seed makes other poses.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Rounds in which time is taken; with 0 it is not.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    rounds: u32,
    #[command(flatten)]
    ends: Ends,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let options =
        Options { poses: arguments.poses as usize, seed: arguments.seed, rounds: arguments.rounds as usize };
    let host = arguments.ends.host()?;

    let found = progress::of(options.steps(), "poses", |tell| {
        footprints::run(&host, &arealight::LightTable::ggx(), &options, tell)
    })?;

    arguments.ends.report(&found, &found.to_markdown(), &found.to_text())?;
    Ok(if found.shortfalls().next().is_some() { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}
