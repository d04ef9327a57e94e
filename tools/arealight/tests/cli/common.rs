//! The program, run as a user runs it.

use arealight_engine::host::Validation;
use arealight_engine::host::testing::device_with;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// A file of the repository.
fn of_repository(path: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path).display().to_string()
}

/// A scene of ours.
pub fn scene(name: &str) -> String {
    of_repository(&format!("scenes/{name}"))
}

/// A file of the reference's.
pub fn reference(file: &str) -> String {
    of_repository(&format!("tests/data/reference/{file}"))
}

/// What a program said.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Runs the program in `folder`.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

/// What a run prints, which must succeed.
#[track_caller]
pub fn printed(output: &Output) -> String {
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// The JSON that a run prints, which must succeed.
#[track_caller]
pub fn json_of(output: &Output) -> Value {
    serde_json::from_str(&printed(output)).expect("it prints JSON")
}

/// Asserts that a run failed with `code` and all of `words` in its errors, without a panic.
#[track_caller]
pub fn refused(output: &Output, code: i32, words: &[&str]) {
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "it does not say '{word}': {said}");
    }
}

/// Runs the program in `folder`, which must fail.
#[track_caller]
pub fn refuse(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    println!("{arguments:?}");
    refused(&run(folder, arguments), code, words);
}

/// A picture that was written.
pub fn picture(folder: &Path, name: &str) -> image::RgbImage {
    image::open(folder.join(name)).unwrap().to_rgb8()
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
