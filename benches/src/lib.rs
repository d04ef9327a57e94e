//! Cost, and the error at that cost.
//!
//! | module | holds |
//! |---|---|
//! | [`school`] | the yardsticks: how others compute a form factor |
//! | [`published`] | a table of the quality that others ship |
//! | [`method`] | the ways to compute a form factor: every quality level of the library, and the yardsticks |
//! | [`compiled`] | what a GPU's compiler makes of the kernels, on a machine without a GPU |
//! | [`model`] | which paths the waves of our scenes take, and what a frame of them costs by the compiler's numbers |
//! | [`ladder`] | the error and the time of every quality level, beside Monte Carlo |
//! | [`textures`] | the time of filtering a light's texture |
//! | [`footprints`] | the errors and the time of looking one up |
//! | [`kernel`] | the kernel that computes form factors of hard cases by one of them |
//! | [`stability`] | every family of hard cases through every method, judged |
//! | [`shapes`] | the kernel that evaluates disks, spheres and tubes |
//! | [`shape_stability`] | families of hard shapes on a device, judged |
//! | [`materials`] | the error of each material of a scene against the reference |
//! | [`shadows`] | how far a picture with shadows is from the reference |
//! | [`shadow_levels`] | the error and the time of every level of shadows |
//! | [`shadow_motion`] | the error of shadows in films, frame by frame |
//! | [`sections`] | the sections of documents that commands write |
//! | [`report`] | what came of it: as text, as Markdown |
//! | [`pictures`] | pictures as light textures of an engine |
//!
//! `arealight bench` is the way to run them.

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say

pub mod compiled;
pub mod footprints;
pub mod furnace;
pub mod kernel;
pub mod ladder;
pub mod many_lights;
pub mod materials;
pub mod method;
pub mod model;
pub mod pictures;
pub mod published;
pub mod report;
pub mod school;
pub mod sections;
pub mod shadow_levels;
pub mod shadow_motion;
pub mod shadows;
pub mod shape_stability;
pub mod shapes;
pub mod stability;
mod table;
pub mod textures;
