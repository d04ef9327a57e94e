//! The fitter: its parts against independent methods, and its tables against bars.

mod albedo;
mod built_in;
mod formula;
mod lobe;
mod phase;
mod table;
