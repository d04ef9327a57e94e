//! Records Arealight passes into a Vulkan command buffer of the host.
pub use ash;
