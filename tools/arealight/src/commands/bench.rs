//! `arealight bench`

mod stability;
mod textures;

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
    Textures(textures::Arguments),
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match &arguments.bench {
        Bench::Stability(arguments) => stability::run(arguments),
        Bench::Textures(arguments) => textures::run(arguments),
    }
}
