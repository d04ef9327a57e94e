//! The kernels that only the tools, tests and benchmarks dispatch. An engine brings a G-buffer of its own and
//! shades no lists of points, so that none of this is in the crates that it takes.
//!
//! | kernel | does |
//! |---|---|
//! | [`VISIBILITY`](kernels::VISIBILITY) | finds what a camera sees, and writes a G-buffer |
//! | [`REFERENCE`](kernels::REFERENCE) | integrates the true BRDF over the lights by Monte Carlo |
//! | [`REFERENCE_MEDIUM`](kernels::REFERENCE_MEDIUM) | puts a medium before a picture by Monte Carlo |
//! | [`EVAL`](kernels::EVAL), [`EVAL_SHAPES`](kernels::EVAL_SHAPES) | shade a list of points by the shade kernel's functions |
//! | [`EVAL_MEDIUM`](kernels::EVAL_MEDIUM) | the same for points in a medium |
//!
//! | module | holds |
//! |---|---|
//! | [`gpu`] | data laid out as they read it |
//! | [`kernels`] | the embedded SPIR-V with bindings, constants and group sizes |
//! | [`light_sampling`] | what the Monte Carlo reference needs of the lights |
//! | [`plan`] | how they are specialised and dispatched |

pub mod gpu;
pub mod kernels;
pub mod light_sampling;
pub mod plan;

pub use light_sampling::LightSampling;
