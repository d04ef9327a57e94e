//! Fits linearly transformed cosines to a BRDF, and makes a [`arealight::LightTable`].

pub mod brdf;
mod error;
mod fit;
pub mod lobe;
mod nodes;
mod quadrature;
pub mod report;
mod solve;

pub use brdf::{Brdf, GgxBrdf, Magnitude};
pub use error::FitError;
pub use fit::{Settings, fit};
pub use solve::Loss;
