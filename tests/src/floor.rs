//! A floor under lights as a host has it: images of a G-buffer, buffers of lights, a pass, and what the
//! oracle says of each pixel.

use crate::TestEngine;
use crate::one_pixel::{BEFORE, lamp, material};
use arealight::plan::{ShadeOptions, TileOptions};
use arealight::{Light, LightShape, LightTable, PackedLights, Plane, Quality, SpecularLobes};
use arealight_engine::host::{Buffer, Image, ImageDescription, Location, Usage};
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, shape_ltc_on, shape_seen_from};
use arealight_vk::{Bound, Descriptors, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources};
use ash::vk;
use glam::{DMat4, DVec3, DVec4, Vec3, Vec4};
use std::sync::OnceLock;

/// Pixels of the images: no whole number of tiles.
pub const SIZE: [u32; 2] = [37, 21];

/// Where the camera is.
pub const CAMERA: DVec3 = DVec3::new(0.5, -4.0, 3.0);

/// A floor in z = 0, of which each pixel sees a place, and lights over it.
pub struct Floor<'a> {
    engine: &'a TestEngine,
    /// What was packed, in the order of the buffers.
    pub lights: PackedLights,
    /// What each light gives to each pixel by the oracle, when it was asked for first.
    radiance_of_lights: OnceLock<Vec<Vec<DVec3>>>,
    unpacked: Vec<Light>,
    position: Image,
    normal: Image,
    color: Image,
    radiance: Image,
    buffers: [Buffer; 3],
    horizons: Buffer,
}

/// The places of the pixels, in the order of the images.
pub fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

/// The place of the floor that a pixel sees.
pub fn position([x, y]: [u32; 2]) -> Vec3 {
    Vec3::new(x as f32 * 0.2 - 3.7, 2.5 - y as f32 * 0.2, 0.0)
}

/// The floor's material: the kernel's own reflectance of dielectrics.
pub fn floor_material() -> Material {
    Material { dielectric_f0: Vec3::splat(0.04), dielectric_f90: 1.0, ..material() }
}

/// A lamp over the floor's middle, and smaller ones about it, of which every second is a sphere.
pub fn lamps() -> Vec<Light> {
    let LightShape::Polygon(square) = lamp().shape else { unreachable!("a polygon") };
    let mut lights = vec![lamp()];
    for index in 0..6 {
        let middle = DVec3::new(f64::from(index) - 2.5, if index % 2 == 0 { 1.5 } else { -1.0 }, 0.0);
        let shape = if index % 2 == 0 {
            LightShape::Sphere { center: middle + DVec3::Z, radius: 0.3 }
        } else {
            LightShape::Polygon(square.iter().map(|vertex| *vertex * 0.3 + middle).collect())
        };
        let radiance = Vec3::new(2.0, 1.0 + index as f32, 3.0);
        lights.push(Light { radiance, shape, ..lamp() });
    }
    lights
}

impl<'a> Floor<'a> {
    /// The images and buffers; the device is held to be enough.
    pub fn new(engine: &'a TestEngine, lights: &[Light]) -> Self {
        let (sampled, float) = (vk::ImageUsageFlags::SAMPLED, vk::Format::R32G32B32A32_SFLOAT);
        let texels: Vec<_> = pixels().map(|pixel| position(pixel).extend(1.0).to_array()).collect();
        let Material { base_color, roughness, metalness, .. } = floor_material();
        let packed = PackedLights::new(lights, DVec3::ZERO).unwrap();
        let host = engine.host();
        let bytes = |bytes: &[u8], name| {
            let padded: Vec<_> = bytes.iter().copied().chain([0; 64]).take(bytes.len().max(64)).collect();
            host.storage_buffer(name, &padded).unwrap()
        };
        let buffers = [
            bytes(bytemuck::cast_slice(&packed.lights), "lights"),
            bytes(bytemuck::cast_slice(&packed.vertices), "vertices"),
            bytes(bytemuck::cast_slice(&packed.shapes), "shapes"),
        ];
        let horizons = LightTable::ggx().lobe_horizons(SpecularLobes::default());
        Self {
            engine,
            lights: packed,
            radiance_of_lights: OnceLock::new(),
            unpacked: lights.to_vec(),
            position: image(engine, SIZE, float, sampled, &texels),
            normal: image(engine, SIZE, float, sampled, &vec![[0.0, 0.0, 1.0, roughness]; texels.len()]),
            color: image(
                engine,
                SIZE,
                float,
                sampled,
                &vec![base_color.extend(metalness).to_array(); texels.len()],
            ),
            radiance: image(engine, SIZE, float, vk::ImageUsageFlags::STORAGE, &vec![BEFORE; texels.len()]),
            buffers,
            horizons: host.storage_buffer("horizons", &horizons).unwrap(),
        }
    }

    /// The whole picture.
    pub fn frame(&self) -> ShadeFrame {
        ShadeFrame {
            size: SIZE,
            camera: CAMERA.as_vec3(),
            lights: self.lights.summary(),
            ..ShadeFrame::default()
        }
    }

    /// All of it, without tiles.
    pub fn resources(&self) -> ShadeResources {
        let [lights, vertices, shapes] =
            [0, 1, 2].map(|index: usize| Resource::buffer(self.buffers[index].handle()));
        ShadeResources {
            table: self.engine.table(),
            lights,
            light_vertices: vertices,
            shapes: Some(shapes),
            planes: [
                (Plane::Position, read(&self.position)),
                (Plane::Normal, read(&self.normal)),
                (Plane::BaseColor, read(&self.color)),
            ]
            .into(),
            radiance: Resource::StorageImage { view: self.radiance.view() },
            ..ShadeResources::default()
        }
    }

    /// What the images of radiance hold after a frame by a new pass, over [`BEFORE`]. By a context with push
    /// descriptors they are pushed.
    pub fn shade(
        &self,
        options: ShadeOptions,
        tiles: bool,
        (resources, frame, descriptors): (&ShadeResources, &ShadeFrame, Descriptors),
    ) -> Vec<Vec4> {
        let (host, table) = (self.engine.host(), LightTable::ggx());
        let every_frame = TileOptions { least_quads: 0, ..TileOptions::default() };
        // SAFETY: Host::submit waits, and everything here is dropped before the engine.
        unsafe {
            let (tiled, table_size) = (tiles.then_some(every_frame), table.size());
            let info = ShadePassInfo { tiles: tiled, table_size, descriptors, ..options.into() };
            let pass = ShadePass::new(self.engine.context(), info).unwrap();
            let lists = pass
                .tile_memory(SIZE)
                .map(|lists| host.buffer("lists", lists.size, lists.usage, Location::Device).unwrap());
            let tile_lists = lists.as_ref().map(|lists| Resource::buffer(lists.handle()));
            let lobe_horizons = tiles.then(|| Resource::buffer(self.horizons.handle()));
            let resources = ShadeResources { tile_lists, lobe_horizons, ..*resources };
            let frame = ShadeFrame { tile_lists, ..*frame };
            if descriptors == Descriptors::Pushed {
                let bound = Bound::Pushed { resources: &resources, host_set: None };
                self.picture_after(|commands| pass.record(commands, bound, &frame).unwrap())
            } else {
                let pool = host.descriptor_pool(1, &pass.pool_sizes(1)).unwrap();
                let set = pool.allocate(pass.set_layout()).unwrap();
                pass.write_set(set, &resources).unwrap();
                self.picture_after(|commands| pass.record(commands, set, &frame).unwrap())
            }
        }
    }

    /// What the image of radiance holds after these commands, over [`BEFORE`].
    pub fn picture_after(&self, record: impl FnOnce(vk::CommandBuffer)) -> Vec<Vec4> {
        self.radiance.upload(&vec![BEFORE.to_array(); pixels().count()], Usage::COMPUTE_WRITE).unwrap();
        self.engine.host().submit(record).unwrap();
        let found: Vec<[f32; 4]> = self.radiance.download(Usage::COMPUTE_WRITE).unwrap();
        found.into_iter().map(Vec4::from_array).collect()
    }

    /// The radiance of a pixel by the oracle, from these of its lights.
    pub fn expected(&self, pixel: [u32; 2], lights: impl Fn(usize) -> bool) -> DVec3 {
        let all = self.radiance_of_lights.get_or_init(|| {
            let (table, surface) = (LightTable::ggx(), floor_material().surface());
            let one = |pixel, light| one_light(&table, &surface, DVec3::Z, position(pixel).as_dvec3(), light);
            self.unpacked.iter().map(|light| pixels().map(|pixel| one(pixel, light)).collect()).collect()
        });
        let place = (pixel[1] * SIZE[0] + pixel[0]) as usize;
        all.iter().enumerate().filter(|(index, _)| lights(*index)).map(|(_, pixels)| pixels[place]).sum()
    }
}

/// What a light gives to the camera from a place, by the oracle.
pub fn one_light(
    table: &LightTable,
    surface: &Surface,
    normal: DVec3,
    position: DVec3,
    light: &Light,
) -> DVec3 {
    let view = CAMERA - position;
    let shape = shape_seen_from(light, position);
    shape_ltc_on(Quality::default(), table, surface, normal, view, &shape)
        .unwrap_or_else(|| ltc(table, surface, normal, view, &RelativeLight::new(light, position)))
}

/// An image of `extent` with these texels, to be read or stored to.
pub fn image<T: bytemuck::Pod>(
    engine: &TestEngine,
    extent: [u32; 2],
    format: vk::Format,
    usage: vk::ImageUsageFlags,
    texels: &[T],
) -> Image {
    let description = ImageDescription { name: "floor", extent, layers: 1, format, usage };
    let image = engine.host().image(&description).unwrap();
    let stored = usage.contains(vk::ImageUsageFlags::STORAGE);
    image.upload(texels, if stored { Usage::COMPUTE_WRITE } else { Usage::COMPUTE_READ }).unwrap();
    image
}

/// From positions to a space with the eye at zero that looks along -z with y up.
pub fn looking_at_floor(eye: DVec3) -> DMat4 {
    let back = eye.normalize_or(DVec3::Z);
    let right = DVec3::Z.cross(back).normalize_or(DVec3::Z);
    let up = back.cross(right);
    DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), DVec4::W).transpose()
        * DMat4::from_translation(-eye)
}

/// What a pass reads by texel.
pub fn read(image: &Image) -> Resource {
    Resource::SampledImage { view: image.view(), layout: Usage::COMPUTE_READ.layout }
}
