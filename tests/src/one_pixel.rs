//! The shade pass over a G-buffer of one pixel.

use crate::TestEngine;
use crate::pass::{self, LightBuffers, image, planes, reads, run, store};
use arealight::plan::{GBufferLayout, RadianceFormat, ShadeOptions};
use arealight::{Effects, Light, LightShape, Plane, Planes};
use arealight_engine::EvalPoint;
use arealight_engine::host::{Image, Usage};
use arealight_oracle::material::{Material, Surface};
use arealight_vk::{Descriptors, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources};
use ash::vk;
use bytemuck::Pod;
use glam::{DVec3, Mat4, Vec3, Vec4};
use half::f16;

/// What is in the images for radiance before a pass.
pub const BEFORE: Vec4 = Vec4::new(0.25, 0.5, 1.0, 1.0);

/// Where surfaces of a [`OnePixel`] are seen from.
pub const CAMERA: Vec3 = Vec3::new(1.0, 0.5, 2.0);

/// Every layout of a G-buffer.
pub const LAYOUTS: [GBufferLayout; 4] =
    [GBufferLayout::Arealight, GBufferLayout::Unreal, GBufferLayout::Unity, GBufferLayout::Octahedral];

/// The material of a new [`OnePixel`], in our own layout.
pub fn material() -> Material {
    Material {
        base_color: Vec3::new(0.8, 0.6, 0.4),
        metalness: 0.25,
        roughness: 0.5,
        dielectric_f0: Vec3::new(0.8, 0.6, 0.4),
        dielectric_f90: 0.25,
        ..Material::default()
    }
}

/// A surface at a pixel's place under [`lamp`], without a G-buffer.
pub fn under_lamp(surface: Surface) -> EvalPoint {
    let view = CAMERA.as_dvec3();
    EvalPoint { surface, position: DVec3::ZERO, normal: DVec3::Z, view, light: lamp() }
}

/// One pixel that sees a point, through a G-buffer that the test makes itself.
pub struct OnePixel<'a> {
    engine: &'a TestEngine,
    /// By plane, but for depth and stencils.
    planes: Planes<Option<Image>>,
    depth: Image,
    /// Of a host that reads them in its own way.
    pub module: Option<Vec<u32>>,
}

impl<'a> OnePixel<'a> {
    /// A grey, half rough, a quarter metallic surface without a coat that looks up, at `position` (w = 0:
    /// none), and what the depth buffer says of it.
    pub fn new(engine: &'a TestEngine, position: Vec4, depth: f32) -> Self {
        Self {
            engine,
            planes: planes(engine, [1; 2], &|plane, _| match plane {
                Plane::Position => Some(position),
                Plane::Normal => Some(Vec4::new(0.0, 0.0, 2.0, 0.5)),
                Plane::BaseColor | Plane::Specular => Some(Vec4::new(0.8, 0.6, 0.4, 0.25)),
                Plane::Stencil => None,
                _ => Some(Vec4::ZERO),
            }),
            depth: sampled(engine, vk::Format::R32_SFLOAT, depth),
            module: None,
        }
    }

    /// Puts a texel into a plane.
    pub fn set<T: Pod>(&mut self, plane: Plane, format: vk::Format, texel: T) {
        self.planes[plane] = Some(sampled(self.engine, format, texel));
    }

    /// The planes that there are, as a pass reads them.
    pub fn planes(&self) -> Planes<Option<Resource>> {
        reads(&self.planes)
    }

    /// Under [`lamp`], of surfaces that need these effects beside both lobes and a reflectance of their own.
    pub fn shade_under_lamp(&self, layout: GBufferLayout, effects: Effects) -> Vec3 {
        let surfaces = Effects::DIFFUSE | Effects::GLOSSY | Effects::SPECULAR_INPUT | effects;
        let options = ShadeOptions { surfaces, g_buffer: layout, ..ShadeOptions::default() };
        self.shade(options, &[lamp()], CAMERA, None).truncate()
    }

    /// The one image of a pass that has one.
    pub fn shade(&self, options: ShadeOptions, lights: &[Light], camera: Vec3, matrix: Option<Mat4>) -> Vec4 {
        assert!(!options.separate_lobes);
        self.shade_images(options, lights, camera, matrix)[0]
    }

    /// The image of both lobes or of the diffuse one, and that of the glossy one, which held [`BEFORE`].
    pub fn shade_images(
        &self,
        options: ShadeOptions,
        lights: &[Light],
        camera: Vec3,
        matrix: Option<Mat4>,
    ) -> [Vec4; 2] {
        let [radiance, glossy] = [(); 2].map(|()| stored(self.engine, options.format));
        let (kept, own);
        let pass: &ShadePass = if let Some(module) = &self.module {
            let info = ShadePassInfo { module: Some(module.clone()), ..options.into() };
            own = self.engine.pass(info).unwrap();
            &own
        } else {
            kept = self.engine.shade_pass(options).unwrap();
            &kept
        };
        let lights = LightBuffers::new(self.engine, lights, DVec3::ZERO);
        let mut planes = self.planes();
        if options.from_depth {
            planes[Plane::Position] = Some(pass::read(&self.depth));
        }
        let resources = ShadeResources {
            planes,
            radiance: store(&radiance),
            glossy: Some(store(&glossy)),
            light_textures: Some(self.engine.light_textures()),
            ..lights.resources(self.engine)
        };
        let frame = ShadeFrame { position_from_clip: matrix, ..lights.frame([1; 2], camera) };
        run(self.engine, pass, &resources, [1; 2], &[frame], Descriptors::Sets);
        [radiance, glossy].map(|image| read(&image, options.format))
    }
}

/// An image of one texel, to be read.
fn sampled<T: Pod>(engine: &TestEngine, format: vk::Format, texel: T) -> Image {
    image(engine, [1; 2], format, vk::ImageUsageFlags::SAMPLED, &[texel])
}

/// An image for radiance, which holds [`BEFORE`].
pub fn stored(engine: &TestEngine, format: RadianceFormat) -> Image {
    match format {
        RadianceFormat::Rgba32Float => pass::radiance(engine, [1; 2], BEFORE),
        RadianceFormat::Rgba16Float => {
            let before = BEFORE.to_array().map(|value| f16::from_f32(value).to_bits());
            let (format, usage) = (vk::Format::R16G16B16A16_SFLOAT, vk::ImageUsageFlags::STORAGE);
            image(engine, [1; 2], format, usage, &[before])
        }
    }
}

/// What a pass left in such an image.
pub fn read(image: &Image, format: RadianceFormat) -> Vec4 {
    match format {
        RadianceFormat::Rgba32Float => pass::stored_in(image)[0],
        RadianceFormat::Rgba16Float => {
            let texels: Vec<[u16; 4]> = image.download(Usage::COMPUTE_WRITE).unwrap();
            Vec4::from_array(texels[0].map(|bits| f16::from_bits(bits).to_f32()))
        }
    }
}

/// A square over the pixel's point.
pub fn lamp() -> Light {
    let square = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    Light {
        name: "lamp".into(),
        radiance: Vec3::new(1.0, 2.0, 3.0),
        shape: LightShape::Polygon(square.iter().map(|&(x, y)| DVec3::new(x, y, 2.0)).collect()),
        ..Light::default()
    }
}
