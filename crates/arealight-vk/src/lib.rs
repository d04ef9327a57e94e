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
//! | step | by |
//! |---|---|
//! | from your handles | [`Context::new`], [`Context::with_pipeline_cache`] |
//! | a pass for your G-buffer | [`ShadePass::new`]; for many lights with [`ShadePassInfo::tiles`] |
//! | the table, in memory of yours | `arealight::LightTable::ggx`, [`TableImage`] |
//! | your images and buffers | [`ShadeResources`], [`ShadePass::write_set`] |
//! | your barriers | [`ShadePass::accesses`] |
//! | a frame | [`arealight::PackedLights`], [`ShadeFrame`], [`ShadePass::record`] |
//! | images on lights, shadows | [`LightTextures`], [`ShadowPass`] |
//!
//! The features: `gpu-allocator` lets the recorder take memory by that crate.
//!
//! Every `unsafe` function says what it trusts you with: that handles belong together, that they outlive what
//! is made of them, and that commands are being recorded.
//!
//! ```no_run
//! use arealight_vk::{ash, ash::vk, Context, ShadeFrame, ShadePass, ShadeResources, StencilTest};
//! use arealight::{plan::ShadeOptions, PackedLights};
//!
//! # unsafe fn frame(instance: &ash::Instance, physical_device: vk::PhysicalDevice, device: &ash::Device,
//! #     command_buffer: vk::CommandBuffer, set: vk::DescriptorSet, resources: &ShadeResources,
//! #     lights: &[arealight::Light], camera: glam::DVec3)
//! #     -> Result<(), arealight_vk::Error> {
//! // Once
//! let context = unsafe { Context::new(instance, physical_device, device) }?;
//! let shade = unsafe { ShadePass::new(&context, ShadeOptions::default()) }?;
//! // When lights change: pack them relative to an origin near the camera, and upload
//! let packed = PackedLights::new(lights, camera)?;
//! // Each frame
//! unsafe { shade.write_set(set, resources) }?;
//! let frame = ShadeFrame { size: [1920, 1080], lights: packed.summary(), ..ShadeFrame::default() };
//! unsafe { shade.record(command_buffer, set, &frame) }?;
//! # Ok(()) }
//! ```

mod context;
mod debug_names;
mod error;
mod formats;
mod frame;
mod layouts;
mod light_textures;
mod limits;
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

pub use arealight;
pub use ash;
pub use context::Context;
pub use error::Error;
pub use formats::ShadeFormats;
pub use frame::{ShadeFrame, StencilTest, Viewport};
pub use layouts::{Descriptors, filtered_image_sampler};
pub use light_textures::{LightTextures, TextureUpdate};
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
        is_shared::<TableImage>();
        is_shared::<LightTextures>();
    }
}
