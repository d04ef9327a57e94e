//! A host that draws by wgpu and shades by Arealight's recorder, in a command buffer of wgpu's, on the same
//! queue.
//!
//! [`g_buffer`] is wgpu alone. [`shading`] is what meets Vulkan: handles of wgpu-hal go to `arealight-vk` as
//! they are, and wgpu is told what it cannot see. docs/embed-wgpu.md explains it.

pub mod g_buffer;
pub mod shading;

use arealight_examples::picture::Picture;
use arealight_examples::scene;
use g_buffer::GBuffer;
use shading::Shading;

/// What can fail; an engine would have a type of its own.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A device of wgpu's, on Vulkan.
pub struct Gpu {
    /// The instance, which goes last.
    pub instance: wgpu::Instance,
    /// The device's adapter.
    pub adapter: wgpu::Adapter,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// The first adapter, with nothing optional enabled.
    ///
    /// # Errors
    /// Where there is none.
    pub fn new() -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
        });
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        Ok(Self { instance, adapter, device, queue })
    }
}

/// Draws and shades the scene as it is after `seconds`.
///
/// # Errors
/// Where the device refuses.
pub fn draw(gpu: &Gpu, size: [u32; 2], seconds: f64) -> Result<Picture> {
    let g_buffer = GBuffer::new(gpu, size);
    let shading = Shading::new(gpu, &g_buffer)?;

    // doc: frame
    // wgpu's commands and ours in encoders of their own, submitted in order
    let drawn = g_buffer.record(gpu, &scene::vertices(seconds), &scene::camera(size));
    let handed_over = shading.hand_over(gpu, &g_buffer);
    let shaded = shading.record(gpu, &g_buffer, &scene::lights(seconds))?;
    gpu.queue.submit([drawn, handed_over, shaded]);
    // doc end
    g_buffer.picture(gpu)
}
