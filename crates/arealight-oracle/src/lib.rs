//! Float64 truth for area lights, for tests, fitting and benchmarks.
pub mod ggx;
