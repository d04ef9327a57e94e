//! Cargo, as a program that says what it knows of the workspace.

use crate::TaskError;
use serde::de::DeserializeOwned;
use std::path::Path;
use std::process::Command;

/// What cargo prints.
pub fn cargo(root: &Path, arguments: &[&str]) -> Result<String, TaskError> {
    let program = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let failed = |source| TaskError::Program { program: "cargo", package: "cargo", source };
    let output = Command::new(program).args(arguments).current_dir(root).output().map_err(failed)?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(TaskError::Cargo { arguments: arguments.join(" "), message })
}

/// The workspace's metadata, as far as `T` looks at it; `arguments` beside those that every use of it has.
pub fn metadata<T: DeserializeOwned>(root: &Path, arguments: &[&str]) -> Result<T, TaskError> {
    let text = cargo(root, &[&["metadata", "--format-version", "1", "--locked"], arguments].concat())?;
    serde_json::from_str(&text).map_err(TaskError::Metadata)
}
