//! The Vulkan host of the tools, tests, benchmarks and examples: it finds Vulkan, picks a device, and owns
//! memory, submission, frames in flight and a window's images, so that the Arealight crates need not.
//!
//! ```no_run
//! use arealight_host::{Host, HostOptions, Validation};
//!
//! # fn main() -> Result<(), arealight_host::HostError> {
//! let host = Host::new(HostOptions { validation: Validation::Core, ..HostOptions::default() })?;
//! let numbers = host.storage_buffer("numbers", &[1.0_f32, 2.0])?;
//! host.submit(|commands| { /* record into `commands` */ })?;
//! let back: Vec<f32> = numbers.download()?;
//! # Ok(())
//! # }
//! ```
//!
//! A device needs Vulkan 1.1 and a queue that computes; no optional feature is enabled unless asked for.
//! Handles are plain `ash` ones. Everything made by a [`Host`] keeps it alive, so the order of drops is free;
//! nothing may be dropped while the GPU still uses it, which [`Host::submit`] assures by waiting.

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say

mod descriptors;
mod device;
mod error;
pub mod families;
mod frames;
mod image;
mod instance;
mod listing;
mod memory;
pub mod null_hardware;
mod submit;
mod swapchain;
pub mod testing;
mod validation;

pub use descriptors::{DescriptorPool, OwnSet};
pub use device::{Host, HostOptions};
pub use error::HostError;
pub use frames::{FRAMES_IN_FLIGHT, Frames, Semaphores};
pub use image::{Image, ImageDescription};
pub use listing::{DeviceKind, DeviceSummary, devices};
pub use memory::{Buffer, Location, Memory};
pub use submit::Usage;
pub use swapchain::Swapchain;
pub use validation::{Message, Severity, Validation};
