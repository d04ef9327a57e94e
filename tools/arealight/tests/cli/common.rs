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

/// The part of the bytes of two pictures that differ visibly.
pub fn difference(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count() as f64 / a.len() as f64
}

/// Something where there is a device; none is asked for by the tests themselves.
pub fn device() -> Option<()> {
    device_with(Validation::Off).map(drop)
}
