//! Every file of these tests is a module of theirs: one that no `mod` names is not compiled, and its tests do
//! not run.

use std::path::Path;

const MAIN: &str = include_str!("main.rs");

/// Which of the files no line `mod …;` names.
fn unnamed<'a>(main: &str, files: &'a [String]) -> Vec<&'a str> {
    let named = |file: &str| main.lines().any(|line| line == format!("mod {file};"));
    files.iter().map(String::as_str).filter(|file| *file != "main" && !named(file)).collect()
}

#[test]
fn every_file_is_a_module() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gpu");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = files.filter(|file| file.extension().is_some_and(|extension| extension == "rs"));
    let names: Vec<_> = sources.map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    assert!(names.len() > 30, "{names:?}");
    assert_eq!(unnamed(MAIN, &names), Vec::<&str>::new());
}

#[test]
fn a_file_that_is_no_module_is_found() {
    let names = ["main", "arcs", "forgotten"].map(str::to_owned);
    assert_eq!(unnamed("mod arcs;\n// mod forgotten;\n", &names), ["forgotten"]);
}
