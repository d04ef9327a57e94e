//! Cases to test and measure area lights with: files of shading points with their answers, and families of
//! hard cases, made from a name and a number.
//!
//! | module | holds |
//! |---|---|
//! | [`cases`] | files of shading points |
//! | [`images`] | textures beside a file of shading points |
//! | [`answers`] | files of answers and of known radiance |
//! | [`measure`] | how far answers lie from the truth |
//! | [`hard`] | polygons and ellipses that break form factors in float32, with their truth |

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say
#![forbid(unsafe_code)]

pub mod answers;
pub mod cases;
pub mod hard;
pub mod images;
pub mod measure;
