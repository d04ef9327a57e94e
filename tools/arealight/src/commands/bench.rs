//! `arealight bench`

mod stability;

use crate::failure::Failure;
use std::process::ExitCode;

/// Measure what a device makes of the library: its error.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    bench: Bench,
}

#[derive(clap::Subcommand)]
enum Bench {
    Stability(stability::Arguments),
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match &arguments.bench {
        Bench::Stability(arguments) => stability::run(arguments),
    }
}
