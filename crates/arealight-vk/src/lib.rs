//! Records Arealight's passes into a command buffer of the host.
//!
//! The recorder owns nothing of the host's: it never submits, never waits, never allocates a descriptor pool,
//! and makes no barrier for a resource that the host owns. The host says where its G-buffer is, allocates the
//! descriptor sets and the memory, and finds Vulkan: [`ash`] is re-exported without its loader.
//!
//! # Start here
//! The repository's `docs/embed-rust.md` goes through each step, and `examples/rust` is a whole engine.
//! Vulkan 1.1 without any optional feature or extension is enough.
//!
//! With the feature `gpu-allocator`, [`AreaLights`] owns all that shading needs, and takes memory by that
//! crate:
//!
//! ```no_run
//! # #[cfg(feature = "gpu-allocator")]
//! # mod example {
//! use arealight_vk::{AreaLights, AreaLightsInfo, ShadeFrame, ShadeResources, arealight::Light, ash::vk};
//! use glam::DVec3;
//!
//! /// A frame of lights in the world, over a G-buffer whose positions are in the world too.
//! ///
//! /// # Safety
//! /// As [`AreaLights::shade`].
//! unsafe fn frame(area_lights: &mut AreaLights, commands: vk::CommandBuffer, place: usize, lights: &[Light],
//!     view: &ShadeFrame, images: &ShadeResources) -> Result<(), arealight_vk::Error> {
//!     unsafe { area_lights.shade(commands, place, lights, DVec3::ZERO, view, images) }
//! }
//! # }
//! ```
//!
//! Below it is the recorder, which owns nothing of the host's:
//!
//! | step | by |
//! |---|---|
//! | from your handles | [`Context::new`], [`Context::with_pipeline_cache`] |
//! | a pass for your G-buffer | [`ShadePass::new`]; for many lights with [`ShadePassInfo::tiles`] |
//! | the table, in memory of yours | [`arealight::LightTable::ggx`], [`TableImage`] |
//! | your images and buffers | [`ShadeResources`], [`ShadePass::write_set`] |
//! | your barriers | [`ShadePass::accesses`] |
//! | a frame | [`arealight::PackedLights`], [`ShadeFrame`], [`ShadePass::record`] |
//! | images on lights, shadows, fog | [`LightTextures`], [`ShadowPass`], [`MediumPass`] |
//!
//! Every `unsafe` function says what it trusts you with: that handles belong together, that they outlive what
//! is made of them, and that commands are being recorded.

#[cfg(feature = "gpu-allocator")]
mod area_lights;
mod context;
mod debug_names;
mod error;
mod formats;
mod frame;
mod image;
mod image_memory;
mod layouts;
mod light_textures;
mod limits;
mod medium;
#[cfg(feature = "gpu-allocator")]
mod memory;
mod module;
mod pass;
mod pipelines;
mod prune;
mod resource;
mod shade;
mod shadows;
mod table_image;
mod tiles;
mod view;
mod written_sets;

#[cfg(feature = "gpu-allocator")]
pub use area_lights::{AreaLights, AreaLightsInfo};
pub use arealight;
pub use ash;
pub use context::Context;
pub use error::Error;
pub use formats::ShadeFormats;
pub use frame::{ShadeFrame, StencilTest, Viewport};
#[cfg(feature = "gpu-allocator")]
pub use gpu_allocator;
pub use layouts::{Descriptors, filtered_image_sampler};
pub use light_textures::{LightTextures, TextureUpdate};
pub use medium::{MediumFrame, MediumPass, MediumPassInfo, MediumResources, MediumStage};
pub use pass::ComputePass;
pub use prune::{freeze, prune};
pub use resource::Resource;
pub use shade::{Bound, ResourceAccess, ShadePass, ShadePassInfo, ShadeResources};
pub use shadows::{
    BlockerResources, ShadowFrame, ShadowOptions, ShadowPass, ShadowPassInfo, ShadowResources, ShadowStage,
};
pub use table_image::{TableFormat, TableImage};
pub use tiles::TileMemory;

#[cfg(test)]
mod tests {
    use super::*;

    fn is_shared<T: Send + Sync>() {}

    #[test]
    fn threads_may_share_what_records() {
        is_shared::<Context>();
        is_shared::<ShadePass>();
        is_shared::<ShadowPass>();
        is_shared::<MediumPass>();
        is_shared::<TableImage>();
        is_shared::<LightTextures>();
        #[cfg(feature = "gpu-allocator")]
        is_shared::<AreaLights>();
    }
}
