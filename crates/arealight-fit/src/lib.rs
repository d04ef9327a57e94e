//! Fits linearly transformed cosines to a BRDF, and makes a [`arealight::LightTable`] of them.
//!
//! # Start here
//! ```no_run
//! use arealight_fit::{GgxBrdf, Settings, fit};
//!
//! // Your own BRDF: implement `Brdf`
//! let settings = Settings { size: 32, ..Settings::default() };
//! let table = fit(&GgxBrdf, &settings, &|done, steps| eprintln!("{done} of {steps}"))?;
//! assert_eq!(table.size(), 32);
//! # Ok::<(), arealight_fit::FitError>(())
//! ```
//!
//! Twenty seconds of two cores for 64 x 64 nodes; seven without pairs of lobes ([`Settings::pairs`]).
//! `arealight-table` writes it for engines; [`report`] says how good it is.
//!
//! # How a texel is fitted
//! A lobe has four degrees of freedom, the entries of a matrix texel (see [`arealight::table`]); its
//! magnitude is the BRDF's true albedo ([`Brdf::magnitude`]).
//! 1. *Nodes*: directions drawn half from the BRDF and half from a guess at the lobe, with the balance
//!    heuristic. The BRDF is evaluated once at each.
//! 2. *Probes*: 256 quads on the sphere, from half a lobe's width to large lights. The loss is the sum over
//!    them of the squared error of the lobe's integral, because that is what shading asks of a table. A node
//!    counts in every probe that it lies in. Each probe counts twice: with the lobe clipped at its own
//!    horizon, and at the surface's too, for both are used.
//! 3. *Steps*: damped Gauss-Newton with exact derivatives, some ten a texel.
//!
//! Each texel starts from its neighbour, and is held to it, weakly, in what the probes do not determine. So
//! the table is smooth and may be interpolated.
//!
//! # What is fitted Two lobes, with and without Schlick's weight, or one for every reflectance: see [`Aim`].
//! Beside them pairs of lobes that a surface has at once, for [`arealight::SpecularLobes::Two`]: their ten
//! numbers are fitted together. [`report`] measures a table at reflectances from 0.02 to 1, and the table
//! published with Heitz et al. 2016.
//!
//! # Without a table
//! [`formula`] fits polynomials to a table's entries, for those who have no sampler to spare.
//!
//! # In a medium
//! [`phase`] fits what stands for Henyey and Greenstein's phase function.
//!
//! # The same everywhere
//! The table does not depend on the number of threads, and all random numbers are fixed. Between machines
//! only the last bits of the system's sines, logarithms and powers can differ.

#![forbid(unsafe_code)]

mod aim;
mod albedos;
pub mod brdf;
mod error;
mod fit;
pub mod formula;
mod linear;
pub mod lobe;
mod nodes;
mod pairs;
pub mod phase;
mod probes;
mod quadrature;
mod random;
pub mod report;
mod solve;

pub use aim::Aim;
pub use brdf::{Brdf, GgxBrdf, Magnitude, half_vector_magnitude};
pub use error::FitError;
pub use fit::{Settings, fit, fit_at};
