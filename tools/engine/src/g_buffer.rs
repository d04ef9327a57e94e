//! The engine's own G-buffer, in the layout that the shade kernel reads.

use crate::host::{Image, ImageDescription, Usage};
use crate::{Engine, EngineError};
use arealight::kernels::{Binding, BindingKind};
use arealight::planes::{Plane, Texels};
use arealight_oracle::material::Material;
use arealight_vk::Resource;
use ash::vk;
use glam::{DVec4, Vec3, Vec4};
use std::ops::Index;

/// The images of a G-buffer and the radiance image, all of one size: `g_buffer[Plane::Coat]`.
pub struct GBuffer {
    /// By plane. In w of positions is one more than the triangle's index, exactly, and 0 where there is no
    /// surface. Motion, which no frame of ours has, is a texel.
    planes: Vec<Image>,
    /// Albedo of what is let through: the base colour of a pass with [`arealight::Effects::TRANSMISSION`].
    pub transmitted: Image,
    /// Radiance.
    pub radiance: Image,
}

impl Index<Plane> for GBuffer {
    type Output = Image;

    fn index(&self, plane: Plane) -> &Image {
        &self.planes[plane as usize]
    }
}

impl GBuffer {
    /// Makes the images; their contents are undefined.
    pub fn new(engine: &Engine, extent: [u32; 2]) -> Result<Self, EngineError> {
        let image = |name, format, extent| {
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
        let plane = |plane: Plane| match (plane, plane.texels()) {
            (Plane::BaseColor, _) => image(plane.name(), half, extent),
            (_, Texels::Integers) => image(plane.name(), vk::Format::R32_UINT, extent),
            (_, Texels::Offsets) => image(plane.name(), full, [1; 2]),
            _ => image(plane.name(), full, extent),
        };
        Ok(Self {
            planes: Plane::ALL.into_iter().map(plane).collect::<Result<_, _>>()?,
            transmitted: image("transmitted", half, extent)?,
            radiance: image("radiance", full, extent)?,
        })
    }

    /// The images that surfaces are written to and read from: all but radiance.
    pub fn surfaces(&self) -> impl Iterator<Item = &Image> {
        self.planes.iter().chain([&self.transmitted])
    }

    /// The image that a kernel calls so: a plane by its name, as it is read or with `out_`.
    fn image(&self, binding: &str) -> Option<&Image> {
        let name = binding.strip_prefix("out_").or_else(|| binding.strip_prefix("g_")).unwrap_or(binding);
        match name {
            "radiance" | "radiance_image" | "glossy_image" => Some(&self.radiance),
            "transmitted" => Some(&self.transmitted),
            _ => Plane::ALL.into_iter().find(|plane| plane.name() == name).map(|plane| &self[plane]),
        }
    }

    /// What a kernel reads or writes of it at a binding.
    pub fn bound_at(&self, binding: &Binding) -> Option<Resource> {
        let image = self.image(binding.name)?;
        Some(match binding.kind {
            BindingKind::StorageImage => Resource::StorageImage { view: image.view() },
            _ => read(image),
        })
    }

    /// A plane as a shading pass reads it.
    pub fn read(&self, plane: Plane) -> Resource {
        read(&self[plane])
    }

    /// Likewise, what is let through.
    pub fn read_transmitted(&self) -> Resource {
        read(&self.transmitted)
    }
}

/// What a plane holds of a material on a surface of this normal, in our own layout, without a normal of the
/// coat's; zeros where it holds nothing of materials.
pub fn texel_of(material: &Material, normal: Vec3, plane: Plane) -> [f32; 4] {
    let texel = match plane {
        Plane::Normal => normal.extend(material.roughness),
        Plane::BaseColor => material.base_color.extend(material.metalness),
        Plane::Specular => material.dielectric_f0.extend(material.dielectric_f90),
        Plane::Coat => Vec4::new(material.coat, material.coat_roughness, 0.0, 0.0),
        Plane::Sheen => material.sheen_color.extend(material.sheen_roughness),
        Plane::Film => material
            .film
            .map_or(Vec4::ZERO, |film| DVec4::new(film.weight, film.ior, film.thickness, 0.0).as_vec4()),
        _ => Vec4::ZERO,
    };
    texel.to_array()
}

fn read(image: &Image) -> Resource {
    Resource::SampledImage { view: image.view(), layout: Usage::COMPUTE_READ.layout }
}
