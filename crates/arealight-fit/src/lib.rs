//! Fits linearly transformed cosines to a BRDF, and makes a [`arealight::LightTable`].

mod aim;
pub mod brdf;
mod error;
mod fit;
pub mod lobe;
mod nodes;
mod probes;
mod quadrature;
mod random;
pub mod report;
mod solve;

pub use aim::Aim;
pub use brdf::{Brdf, GgxBrdf, Magnitude};
pub use error::FitError;
pub use fit::{Settings, fit};
