//! The oracle and the hard cases against references.

mod anisotropy;
mod ellipse;
mod materials;
mod media;
mod reference;
