//! `arealight bench furnace`

use super::Ends;
use crate::failure::Failure;
use crate::progress;
use arealight_benches::furnace::{self, Options};
use arealight_benches::sections::Markers;
use std::process::ExitCode;

/// Measure what each quality level loses and gains of light from everywhere, on surfaces that reflect all of
/// it.
///
/// The white furnace: GGX of F0 = 1, every roughness, views to 89.9 degrees, below a light that fills the
/// hemisphere. What a level finds is held against the lobe's true albedo.
#[derive(clap::Args)]
pub struct Arguments {
    /// Roughnesses, and as many views.
    #[arg(long, default_value_t = Options::default().steps,
        value_parser = clap::value_parser!(u32).range(2..=1000))]
    steps: u32,
    #[command(flatten)]
    ends: Ends,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Arguments { steps, ends } = arguments;
    let host = ends.host()?;
    let found = progress::of(furnace::levels().len() as u64, "levels", |tell| {
        furnace::run(&host, &arealight::LightTable::ggx(), &Options { steps: *steps }, tell)
    })?;

    let section =
        found.to_markdown(&format!("arealight bench furnace --steps {steps} --markdown docs/stability.md"));
    ends.section(&found, Markers::FURNACE, &section, &found.to_text())?;
    Ok(ExitCode::SUCCESS)
}
