//! The shortest way from Vulkan's handles to a shaded frame. [`deferred`](crate::deferred) has every step.

use crate::Result;
use arealight::glam::DVec3;
use arealight::plan::ShadeOptions;
use arealight::{Light, PackedLights};
use arealight_vk::ash::{self, vk};
use arealight_vk::{Context, ShadeFrame, ShadePass, ShadeResources};

/// Handles of a host that has a G-buffer, the table's image and a descriptor set.
pub struct Host<'a> {
    /// The instance's functions.
    pub instance: &'a ash::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device's functions.
    pub device: &'a ash::Device,
    /// Being recorded, outside a render pass.
    pub command_buffer: vk::CommandBuffer,
    /// Of the pass's layout.
    pub set: vk::DescriptorSet,
    /// The images and buffers that the set points at.
    pub resources: ShadeResources,
    /// Width and height of the G-buffer.
    pub size: [u32; 2],
}

/// Records a frame of `lights`, whose arrays `upload` brings into the buffers of the resources. The pass
/// lives until the frame is done.
///
/// # Errors
/// Whatever is wrong with a handle, a light or a resource, by name.
///
/// # Safety
/// The handles belong together and outlive the returned pass, which outlives the commands' execution.
#[expect(
    clippy::undocumented_unsafe_blocks,
    reason = "all of them trust the caller with what the section above says"
)]
pub unsafe fn record(
    host: &Host<'_>,
    lights: &[Light],
    camera: DVec3,
    upload: impl Fn(&PackedLights),
) -> Result<ShadePass> {
    let Host { instance, physical_device, device, command_buffer, set, resources, size } = host;
    // doc: record
    let context = unsafe { Context::new(instance, *physical_device, device) }?;
    let shade = unsafe { ShadePass::new(&context, ShadeOptions::default()) }?;
    let packed = PackedLights::new(lights, camera)?; // checks each light, and names the one that is wrong
    upload(&packed); // its arrays, into your buffers
    let frame = ShadeFrame { size: *size, lights: packed.summary(), ..ShadeFrame::default() };
    unsafe { shade.write_set(*set, resources) }?; // your descriptor set, images and buffers
    unsafe { shade.record(*command_buffer, *set, &frame) }?; // between your barriers: see shade.accesses()
    // doc end
    Ok(shade)
}
