//! A picture on the CPU.

use crate::Result;
use crate::draw::Users;
use crate::gpu::{Buffer, Frames, Gpu, Image};
use ash::vk;
use glam::{Vec3, Vec4};
use std::path::Path;

/// Radiance, row after row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear Rec. 709 radiance in xyz, W/(m² sr).
    pub pixels: Vec<Vec4>,
}

impl Picture {
    /// Red, green and blue as a screen takes them: brightness is compressed (Reinhard) and encoded as sRGB.
    /// `tone_map.comp` does so too.
    pub fn encoded(&self) -> Vec<u8> {
        let encode = |pixel: &Vec4| {
            let shown = pixel.truncate() / (Vec3::ONE + pixel.truncate());
            shown.to_array().map(|value| (255.0 * srgb(value) + 0.5) as u8)
        };
        self.pixels.iter().flat_map(encode).collect()
    }

    /// Writes a PNG of it [as a screen takes it](Self::encoded).
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        Ok(image::save_buffer(path, &self.encoded(), self.size[0], self.size[1], image::ColorType::Rgb8)?)
    }
}

fn srgb(linear: f32) -> f32 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Brings an image of `R32G32B32A32_SFLOAT` back.
pub struct Readback<'a> {
    gpu: &'a Gpu<'a>,
    buffer: Buffer<'a>,
    size: [u32; 2],
}

impl<'a> Readback<'a> {
    /// For images of `size` pixels.
    ///
    /// # Errors
    /// Where memory is out.
    pub fn new(gpu: &'a Gpu<'a>, size: [u32; 2]) -> Result<Self> {
        let bytes = size_of::<Vec4>() * size[0] as usize * size[1] as usize;
        Ok(Self { gpu, buffer: gpu.buffer(vk::BufferUsageFlags::TRANSFER_DST, bytes)?, size })
    }

    /// Copies an image that `writers` left in `layout`, and waits for that.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn read(
        &self,
        frames: &mut Frames<'_>,
        image: &Image<'_>,
        layout: vk::ImageLayout,
        writers: Users,
    ) -> Result<Picture> {
        let written = [vk::MemoryBarrier::default()
            .src_access_mask(writers.access)
            .dst_access_mask(vk::AccessFlags::TRANSFER_READ)];
        let copied = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ)];
        let copy = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(vk::Extent3D { width: self.size[0], height: self.size[1], depth: 1 });
        let (device, transfer) = (&self.gpu.device, vk::PipelineStageFlags::TRANSFER);
        let no_flags = vk::DependencyFlags::empty();
        frames.submit(|_, commands| {
            // SAFETY: the commands are being recorded; image and buffer live until the wait below.
            unsafe {
                device.cmd_pipeline_barrier(commands, writers.stages, transfer, no_flags, &written, &[], &[]);
                device.cmd_copy_image_to_buffer(commands, image.raw, layout, self.buffer.raw, &[copy]);
                let host = vk::PipelineStageFlags::HOST;
                device.cmd_pipeline_barrier(commands, transfer, host, no_flags, &copied, &[], &[]);
            }
            Ok(())
        })?;
        frames.wait()?;
        Ok(Picture { size: self.size, pixels: bytemuck::pod_collect_to_vec(self.buffer.read()) })
    }
}
