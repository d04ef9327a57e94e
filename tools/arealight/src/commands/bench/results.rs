//! `arealight bench results`

use super::write;
use crate::failure::Failure;
use arealight_benches::ladder::{Ladder, results};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Make the page of what was measured on devices: README.md of a folder, of the files in it that `arealight
/// bench --save` wrote.
#[derive(clap::Args)]
pub struct Arguments {
    /// The folder.
    #[arg(default_value = "docs/results")]
    folder: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let failed = |error: std::io::Error| Failure::input(&arguments.folder, error);
    let entries = std::fs::read_dir(&arguments.folder).map_err(failed)?;
    let mut files =
        entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<PathBuf>, _>>().map_err(failed)?;
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    if files.is_empty() {
        return Err(Failure::input(&arguments.folder, "has no file of `arealight bench --save`"));
    }
    let name = |file: &PathBuf| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let runs = files.iter().map(|file| Ok((name(file), read(file)?))).collect::<Result<Vec<_>, Failure>>()?;
    write(&arguments.folder.join("README.md"), &results(&runs))?;
    Ok(ExitCode::SUCCESS)
}

/// Reads what `arealight bench --save FILE` wrote.
fn read(path: &Path) -> Result<Ladder, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::input(path, error))?;
    serde_json::from_str(&text).map_err(|error| {
        Failure::input(path, format!("{error}; write one with `arealight bench --save {}`", path.display()))
    })
}
