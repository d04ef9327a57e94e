//! The shade pass over a G-buffer of one pixel.

use crate::TestEngine;
use arealight::plan::{GBufferLayout, RadianceFormat, ShadeOptions};
use arealight::{Effects, Light, LightShape, PackedLights, Plane, Planes};
use arealight_engine::EvalPoint;
use arealight_engine::host::{Image, ImageDescription, Usage};
use arealight_oracle::material::{Material, Surface};
use arealight_vk::{Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources};
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
        let float = vk::Format::R32G32B32A32_SFLOAT;
        let planes = Planes::from_fn(|plane| match plane {
            Plane::Position => Some(position.to_array()),
            Plane::Normal => Some([0.0, 0.0, 2.0, 0.5]),
            Plane::BaseColor | Plane::Specular => Some([0.8, 0.6, 0.4, 0.25]),
            Plane::Stencil => None,
            _ => Some([0.0; 4]),
        });
        Self {
            engine,
            planes: Planes::from_fn(|plane| {
                planes[plane].map(|texel: [f32; 4]| sampled(engine, float, texel))
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
        Planes::from_fn(|plane| self.planes[plane].as_ref().map(read_image))
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
        let host = self.engine.host();
        let [radiance, glossy] = [(); 2].map(|()| stored(self.engine, options.format));
        let (kept, own);
        let pass: &ShadePass = if let Some(module) = &self.module {
            let info = ShadePassInfo { module: Some(module.clone()), ..options.into() };
            // SAFETY: Host::submit waits; the module is the test's.
            own = unsafe { ShadePass::new(self.engine.context(), info) }.unwrap();
            &own
        } else {
            kept = self.engine.shade_pass(options).unwrap();
            &kept
        };
        // SAFETY: Host::submit waits, and everything here is dropped before the engine.
        unsafe {
            let packed = PackedLights::new(lights, DVec3::ZERO).unwrap();
            let light_buffer = host.storage_buffer("lights", &packed.lights).unwrap();
            let vertex_buffer = host.storage_buffer("vertices", &packed.vertices).unwrap();
            let pool = host.descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
            let set = pool.allocate(pass.set_layout()).unwrap();
            let mut planes = self.planes();
            if options.from_depth {
                planes[Plane::Position] = Some(read_image(&self.depth));
            }
            let resources = ShadeResources {
                table: self.engine.table(),
                lights: Resource::buffer(light_buffer.handle()),
                light_vertices: Resource::buffer(vertex_buffer.handle()),
                planes,
                radiance: Resource::StorageImage { view: radiance.view() },
                glossy: Some(Resource::StorageImage { view: glossy.view() }),
                light_textures: Some(self.engine.light_textures()),
                ..ShadeResources::default()
            };
            pass.write_set(set, &resources).unwrap();
            let frame = ShadeFrame {
                size: [1, 1],
                camera,
                position_from_clip: matrix,
                lights: packed.summary(),
                ..ShadeFrame::default()
            };
            host.submit(|commands| pass.record(commands, set, &frame).unwrap()).unwrap();
        }
        [radiance, glossy].map(|image| read(&image, options.format))
    }
}

/// An image as a pass reads it.
fn read_image(image: &Image) -> Resource {
    Resource::SampledImage { view: image.view(), layout: Usage::COMPUTE_READ.layout }
}

fn image(engine: &TestEngine, format: vk::Format, usage: vk::ImageUsageFlags) -> Image {
    let description = ImageDescription { name: "one pixel", extent: [1, 1], layers: 1, format, usage };
    engine.host().image(&description).unwrap()
}

/// An image of one texel, to be read.
fn sampled<T: Pod>(engine: &TestEngine, format: vk::Format, texel: T) -> Image {
    let image = image(engine, format, vk::ImageUsageFlags::SAMPLED);
    image.upload(&[texel], Usage::COMPUTE_READ).unwrap();
    image
}

/// An image for radiance, which holds [`BEFORE`].
pub fn stored(engine: &TestEngine, format: RadianceFormat) -> Image {
    let before = BEFORE.to_array();
    match format {
        RadianceFormat::Rgba32Float => {
            let image = image(engine, vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::STORAGE);
            image.upload(&[before], Usage::COMPUTE_WRITE).unwrap();
            image
        }
        RadianceFormat::Rgba16Float => {
            let image = image(engine, vk::Format::R16G16B16A16_SFLOAT, vk::ImageUsageFlags::STORAGE);
            image
                .upload(&[before.map(|value| f16::from_f32(value).to_bits())], Usage::COMPUTE_WRITE)
                .unwrap();
            image
        }
    }
}

/// What a pass left in such an image.
pub fn read(image: &Image, format: RadianceFormat) -> Vec4 {
    match format {
        RadianceFormat::Rgba32Float => {
            let texels: Vec<[f32; 4]> = image.download(Usage::COMPUTE_WRITE).unwrap();
            Vec4::from_array(texels[0])
        }
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
