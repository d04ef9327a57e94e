//! Two small engines that embed Arealight, on a host that knows nothing of it (`tools/host`: a device,
//! memory, frames in flight, a window's images):
//!
//! - [`deferred`] draws a G-buffer, and has it shaded by `AreaLights` (`arealight-vk`); [`recorded`] is the
//!   same engine by the recorder, which owns nothing;
//! - [`forward`] includes the GLSL library in its fragment shader, and needs the recorder for the table's
//!   image alone.
//!
//! ```sh
//! cargo run --release -p arealight-examples --bin deferred -- deferred.png
//! cargo run --release -p arealight-examples --bin forward -- forward.png
//! ```
//!
//! The deferred one has a window too, with the feature `window`:
//!
//! ```sh
//! cargo run --release -p arealight-examples --features window --bin deferred
//! ```
//!
//! Both make the same picture. What is theirs alone is in [`deferred`], [`recorded`] and [`forward`]; how
//! they draw triangles is in [`draw`].

#![allow(clippy::missing_errors_doc, clippy::missing_panics_doc)] // what the types say

pub mod command_line;
pub mod deferred;
pub mod draw;
pub mod forward;
pub mod g_buffer;
pub mod picture;
pub mod recorded;
pub mod scene;
pub mod tone_map;
#[cfg(feature = "window")]
pub mod window;

/// What can fail; an engine would have a type of its own.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A host that draws and computes, by Vulkan 1.1 as every device has it: nothing optional is enabled.
pub fn host_options() -> arealight_host::HostOptions {
    let queue = ash::vk::QueueFlags::GRAPHICS | ash::vk::QueueFlags::COMPUTE;
    let newest_version = ash::vk::API_VERSION_1_1;
    arealight_host::HostOptions { queue, newest_version, ..arealight_host::HostOptions::default() }
}
