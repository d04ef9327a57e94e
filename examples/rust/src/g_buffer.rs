//! The deferred engine's G-buffer.

use crate::Result;
use crate::draw::{Draw, DrawOptions, Users};
use crate::gpu::{Gpu, Image};
use arealight_vk::ShadeFormats;
use ash::vk;

/// The images: depth, and what the fragment shader writes.
pub struct GBuffer<'a> {
    /// Reversed.
    pub depth: Image<'a>,
    /// As [`arealight::plan::GBufferLayout::Arealight`] says.
    pub normal_roughness: Image<'a>,
    /// Likewise.
    pub base_color_metalness: Image<'a>,
    /// What is emitted, and then what the pass adds.
    pub radiance: Image<'a>,
}

impl<'a> GBuffer<'a> {
    /// Makes the images.
    ///
    /// # Errors
    /// Where memory is out, or the device has no such images.
    pub fn new(gpu: &'a Gpu<'a>, size: [u32; 2]) -> Result<Self> {
        // doc: g_buffer
        let (color, sampled) = (vk::ImageUsageFlags::COLOR_ATTACHMENT, vk::ImageUsageFlags::SAMPLED);
        let depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | sampled;
        let radiance = color | vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC;
        Ok(Self {
            depth: gpu.image(vk::Format::D32_SFLOAT, size, depth)?,
            normal_roughness: gpu.image(vk::Format::R16G16B16A16_SFLOAT, size, color | sampled)?,
            base_color_metalness: gpu.image(vk::Format::R8G8B8A8_UNORM, size, color | sampled)?,
            radiance: gpu.image(vk::Format::R32G32B32A32_SFLOAT, size, radiance)?,
        })
        // doc end
    }

    /// What views do not tell the pass.
    pub fn formats(&self) -> ShadeFormats {
        ShadeFormats {
            position: self.depth.format,
            normal: self.normal_roughness.format,
            base_color: self.base_color_metalness.format,
            specular: vk::Format::UNDEFINED,
            coat: vk::Format::UNDEFINED,
            radiance: self.radiance.format,
        }
    }

    /// The drawing into these images.
    ///
    /// # Safety
    /// As [`Draw::new`].
    ///
    /// # Errors
    /// As [`Draw::new`].
    pub unsafe fn make_draw(&self, gpu: &'a Gpu<'a>, size: [u32; 2], users: Users) -> Result<Draw<'a>> {
        let read_only = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        let colors = [
            (&self.normal_roughness, read_only),
            (&self.base_color_metalness, read_only),
            (&self.radiance, vk::ImageLayout::GENERAL), // as the pass wants it
        ];
        let options = DrawOptions {
            colors: &colors,
            depth: &self.depth,
            size,
            fragment: include_bytes!("../spirv/g_buffer.frag.spv"),
            set_layout: None,
            users,
        };
        // SAFETY: the same contract.
        unsafe { Draw::new(gpu, &options) }
    }
}
