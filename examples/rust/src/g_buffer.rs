//! The deferred engine's G-buffer, and the drawing into it.

use crate::Result;
use crate::draw::{Draw, DrawOptions, Users, image};
use arealight::Plane;
use arealight_host::{Host, Image};
use arealight_vk::ShadeFormats;
use ash::vk;

/// The images: depth, and what the fragment shader writes. The drawing is dropped before them.
pub struct GBuffer {
    /// Draws the scene into the images.
    pub draw: Draw,
    /// Reversed.
    pub depth: Image,
    /// As [`arealight::plan::GBufferLayout::Arealight`] says.
    pub normal_roughness: Image,
    /// Likewise.
    pub base_color_metalness: Image,
    /// What is emitted, and then what the pass adds.
    pub radiance: Image,
    /// Of all images, in pixels.
    pub size: [u32; 2],
    /// In which stages, and how, the images are used between one drawing and the next.
    pub users: (vk::PipelineStageFlags, vk::AccessFlags),
}

impl GBuffer {
    // doc: formats
    /// The images' formats; what the pass does not read needs none.
    pub fn formats() -> ShadeFormats {
        ShadeFormats {
            planes: [
                (Plane::Position, vk::Format::D32_SFLOAT),
                (Plane::Normal, vk::Format::R16G16B16A16_SFLOAT),
                (Plane::BaseColor, vk::Format::R8G8B8A8_UNORM),
            ]
            .into(),
            radiance: vk::Format::R32G32B32A32_SFLOAT,
        }
    }
    // doc end

    /// Makes the images and the drawing; between one and the next the images are used in these stages, with
    /// this access, and copied from.
    ///
    /// # Errors
    /// Where memory is out, or the device has no such images.
    pub fn new(
        host: &Host,
        size: [u32; 2],
        users: (vk::PipelineStageFlags, vk::AccessFlags),
    ) -> Result<Self> {
        // doc: g_buffer
        let formats = Self::formats();
        let (color, sampled) = (vk::ImageUsageFlags::COLOR_ATTACHMENT, vk::ImageUsageFlags::SAMPLED);
        let depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | sampled;
        let radiance = color | vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC;
        let depth = image(host, "depth", formats.planes[Plane::Position], size, depth)?;
        let normal_roughness =
            image(host, "normal roughness", formats.planes[Plane::Normal], size, color | sampled)?;
        let base_color_metalness =
            image(host, "base color metalness", formats.planes[Plane::BaseColor], size, color | sampled)?;
        let radiance = image(host, "radiance", formats.radiance, size, radiance)?;
        // doc end
        let read_only = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        let colors = [
            (&normal_roughness, read_only),
            (&base_color_metalness, read_only),
            (&radiance, vk::ImageLayout::GENERAL), // as the pass wants it
        ];
        let options = DrawOptions {
            colors: &colors,
            depth: &depth,
            size,
            fragment: include_bytes!("../spirv/g_buffer.frag.spv"),
            set_layout: None,
            users: Users { stages: users.0, access: users.1 } | Users::TRANSFER_READ,
        };
        // SAFETY: the images are dropped after the drawing; owners wait for pending work first.
        let draw = unsafe { Draw::new(host, &options) }?;
        Ok(Self { draw, depth, normal_roughness, base_color_metalness, radiance, size, users })
    }
}
