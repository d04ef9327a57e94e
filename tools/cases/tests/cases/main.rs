//! The oracle and the hard cases against references.

mod anisotropy;
mod ellipse;
mod materials;
mod media;
mod reference;

/// A file of the reference.
fn read(file: &str) -> String {
    let path = format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
