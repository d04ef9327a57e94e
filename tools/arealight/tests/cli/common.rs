//! The program, run as a user runs it.

use arealight_engine::host::Validation;
use arealight_engine::host::testing::device_with;
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

/// Something where there is a device; none is asked for by the tests themselves.
pub fn device() -> Option<()> {
    device_with(Validation::Off).map(drop)
}
