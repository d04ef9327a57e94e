//! `arealight bench compare`

use crate::budget::read_profile;
use crate::failure::Failure;
use crate::output::print;
use arealight_benches::ladder::compare;
use std::path::PathBuf;
use std::process::ExitCode;

/// Compare two runs of `arealight bench --save`.
///
/// Two errors agree where they are the same to the digits that are shown, two times where their quartiles
/// overlap. Printed are the numbers that do not agree. Exit code 1 where there are any.
#[derive(clap::Args)]
pub struct Arguments {
    /// What one run wrote.
    first: PathBuf,
    /// What another wrote.
    second: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let found = compare(&read_profile(&arguments.first)?, &read_profile(&arguments.second)?);
    print(&found.to_text())?;
    Ok(if found.apart.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
