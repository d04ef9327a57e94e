//! Arealight's recorder for hosts in C and C++.
//!
//! Start with the header, which is the manual of hosts, and with `examples/cpp` of the repository, an engine
//! of one file.
//!
//! `include/arealight.h` is made from this crate, and says all that a host must know; docs/embed-c.md goes
//! through it. Here is how it is done:
//!
//! | module | holds |
//! |---|---|
//! | [`types`] | what crosses the boundary: structs |
//! | [`constants`] | what numbers in them mean |
//! | [`area_lights`] | the facade, which owns what shading needs |
//! | [`device`] | from the host's handles to a table on its device |
//! | [`pass`] | the shade pass |
//! | [`lights`] | lights, packed for its frames |
//! | [`shadows`] | the shadow pass, and what blocks its rays |
//! | [`medium`] | the pass of a medium: fog, smoke, haze |
//! | [`textures`] | the images of textured lights |
//! | `arguments` | pointers of the host, checked as far as they can be |
//! | `failure` | results, messages, and panics that stay inside |
//! | `handles` | which objects are alive |
//! | `loader` | Vulkan's functions from the host's two |
//! | `options` | what a pass is to do, from the host's numbers |
//!
//! Nothing unwinds into the host; each function that can fail says by a result that it did, and
//! [`arealight_last_error`] why.

#![allow(clippy::doc_markdown, reason = "the comments become those of a C header, where backticks are noise")]

pub mod area_lights;
mod arguments;
pub mod constants;
pub mod device;
mod failure;
mod handles;
pub mod lights;
mod loader;
pub mod medium;
mod options;
pub mod pass;
pub mod shadows;
pub mod textures;
pub mod types;

pub use area_lights::*;
pub use constants::*;
pub use device::*;
pub use failure::{ArealightResult, arealight_last_error};
pub use lights::*;
pub use medium::*;
pub use pass::*;
pub use shadows::*;
pub use textures::*;
pub use types::*;

/// The version of structs and functions: of the header that a host was compiled with, and of the library that
/// it runs with. They must be equal; arealight_create refuses another. On ELF systems the shared library's
/// SONAME ends in it.
pub const AREALIGHT_ABI_VERSION: u32 = 2;

/// Several threads may use these at once, as the header says of functions that take them as const.
const _: fn() = || {
    fn shared<T: Sync + 'static>() {}
    shared::<Arealight>();
    shared::<ArealightAreaLights>();
    shared::<ArealightPass>();
    shared::<ArealightShadowPass>();
    shared::<ArealightMediumPass>();
    shared::<ArealightBlockers>();
    shared::<ArealightTextures>();
};

/// AREALIGHT_ABI_VERSION of the library, for those that load it at run time.
#[unsafe(no_mangle)]
pub extern "C" fn arealight_abi_version() -> u32 {
    AREALIGHT_ABI_VERSION
}
