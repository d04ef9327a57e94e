//! `arealight bench compare`

use crate::failure::Failure;
use crate::output::print;
use arealight_benches::ladder::{Ladder, compare};
use std::path::{Path, PathBuf};
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
    let found = compare(&read(&arguments.first)?, &read(&arguments.second)?);
    print(&found.to_text())?;
    Ok(if found.apart.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Reads what `arealight bench --save FILE` wrote.
pub(super) fn read(path: &Path) -> Result<Ladder, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::input(path, error))?;
    serde_json::from_str(&text).map_err(|error| {
        Failure::input(path, format!("{error}; write one with `arealight bench --save {}`", path.display()))
    })
}
