//! `arealight render`

use crate::failure::Failure;
use std::process::ExitCode;

/// Not written yet.
#[derive(clap::Args)]
pub struct Arguments {}

impl Arguments {
    pub fn default_scene() -> Self {
        Self {}
    }
}

pub fn run(_arguments: &Arguments) -> Result<ExitCode, Failure> {
    Ok(ExitCode::SUCCESS)
}
