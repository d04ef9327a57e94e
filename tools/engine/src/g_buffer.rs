//! The engine's own G-buffer, in the layout that the shade kernel reads.

use crate::host::{Image, ImageDescription, Usage};
use crate::{Engine, EngineError};
use arealight_vk::Resource;
use ash::vk;

/// The images of a G-buffer and the radiance image, all of one size.
pub struct GBuffer {
    /// Position relative to the origin; w is one more than the triangle's index, exactly, and 0 where there
    /// is no surface.
    pub position: Image,
    /// Normal and roughness.
    pub normal: Image,
    /// Base colour and metalness.
    pub base_color: Image,
    /// Dielectric reflectance.
    pub specular: Image,
    /// Weight, roughness and normal of coats.
    pub coat: Image,
    /// Colour and roughness of sheen.
    pub sheen: Image,
    /// Tangent, roughness along it, and roughness of the diffuse lobe.
    pub anisotropy: Image,
    /// Thin films, above the reflectances in the other images.
    pub film: Image,
    /// Bound where a kernel has a place for stencils that no frame of ours has. Its contents are undefined.
    pub stencil: Image,
    /// Albedo of what is let through: the base colour of a pass with [`arealight::Effects::TRANSMISSION`].
    pub transmitted: Image,
    /// Radiance.
    pub radiance: Image,
}

impl GBuffer {
    /// Makes the images; their contents are undefined.
    ///
    /// # Errors
    /// [`EngineError::Host`] where the device has no such images or no memory for them.
    pub fn new(engine: &Engine, extent: [u32; 2]) -> Result<Self, EngineError> {
        let image = |name, format| {
            engine.host().image(&ImageDescription {
                name,
                extent,
                layers: 1,
                format,
                usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED,
            })
        };
        // Normals in float32: in float16 a mirror shows their steps. Reflectances too, so that the usual one
        // is what the shade kernel takes without reading it
        let (full, half) = (vk::Format::R32G32B32A32_SFLOAT, vk::Format::R16G16B16A16_SFLOAT);
        Ok(Self {
            position: image("position", full)?,
            normal: image("normal", full)?,
            base_color: image("base colour", half)?,
            specular: image("specular", full)?,
            coat: image("coat", full)?,
            sheen: image("sheen", full)?,
            anisotropy: image("anisotropy", full)?,
            film: image("thin film", full)?,
            stencil: image("stencil", vk::Format::R32_UINT)?,
            transmitted: image("transmitted", half)?,
            radiance: image("radiance", full)?,
        })
    }

    /// The images that describe surfaces, in the order of the bindings; those of coats, sheen, anisotropy,
    /// films and transmission are the last.
    pub fn surfaces(&self) -> [&Image; 9] {
        let Self {
            position, normal, base_color, specular, coat, sheen, anisotropy, film, transmitted, ..
        } = self;
        [position, normal, base_color, specular, coat, sheen, anisotropy, film, transmitted]
    }

    /// What stands for the stencils of a kernel that may read some.
    pub fn no_stencil(&self) -> Resource {
        Resource::SampledImage { view: self.stencil.view(), layout: Usage::COMPUTE_READ.layout }
    }

    /// The surface images as a shading pass reads them.
    pub fn sampled(&self) -> [Resource; 9] {
        let layout = Usage::COMPUTE_READ.layout;
        self.surfaces().map(|image| Resource::SampledImage { view: image.view(), layout })
    }
}
