//! `arealight eval`

use crate::failure::Failure;
use std::process::ExitCode;

/// Not written yet.
#[derive(clap::Args)]
pub struct Arguments {}

pub fn run(_arguments: &Arguments) -> Result<ExitCode, Failure> {
    Ok(ExitCode::SUCCESS)
}
