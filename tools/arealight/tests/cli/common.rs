//! The program, run as a user runs it.

use std::path::Path;
use std::process::{Command, Output};

/// Runs the program in `folder`.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}
