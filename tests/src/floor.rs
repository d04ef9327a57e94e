//! A floor under lights as a host has it: images of a G-buffer, buffers of lights, a pass, and what the
//! oracle says of each pixel.

use crate::TestEngine;
use crate::one_pixel::{BEFORE, lamp, material};
use crate::pass::{LightBuffers, planes, radiance, reads, run, store, stored_in, texels};
use arealight::plan::{ShadeOptions, TileOptions};
use arealight::{Light, LightShape, LightTable, Plane, Planes, Quality};
use arealight_engine::host::{Image, Usage};
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, shape_ltc_on, shape_seen_from};
use arealight_vk::{Descriptors, ShadeFrame, ShadePassInfo, ShadeResources};
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
    /// What was packed.
    pub lights: LightBuffers,
    /// What each light gives to each pixel by the oracle, when it was asked for first.
    radiance_of_lights: OnceLock<Vec<Vec<DVec3>>>,
    unpacked: Vec<Light>,
    planes: Planes<Option<Image>>,
    radiance: Image,
}

/// The places of the pixels, in the order of the images.
pub fn pixels() -> impl Iterator<Item = [u32; 2]> {
    texels(SIZE)
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
    /// Makes the images and buffers.
    pub fn new(engine: &'a TestEngine, lights: &[Light]) -> Self {
        let Material { base_color, roughness, metalness, .. } = floor_material();
        Self {
            engine,
            lights: LightBuffers::new(engine, lights, DVec3::ZERO),
            radiance_of_lights: OnceLock::new(),
            unpacked: lights.to_vec(),
            planes: planes(engine, SIZE, &|plane, pixel| match plane {
                Plane::Position => Some(position(pixel).extend(1.0)),
                Plane::Normal => Some(Vec3::Z.extend(roughness)),
                Plane::BaseColor => Some(base_color.extend(metalness)),
                _ => None,
            }),
            radiance: radiance(engine, SIZE, BEFORE),
        }
    }

    /// The whole picture.
    pub fn frame(&self) -> ShadeFrame {
        self.lights.frame(SIZE, CAMERA.as_vec3())
    }

    /// All of it, without tiles.
    pub fn resources(&self) -> ShadeResources {
        let (planes, radiance) = (reads(&self.planes), store(&self.radiance));
        ShadeResources { planes, radiance, ..self.lights.resources(self.engine) }
    }

    /// What the images of radiance hold after a frame by a new pass, over [`BEFORE`]. By a context with push
    /// descriptors they are pushed.
    pub fn shade(
        &self,
        options: ShadeOptions,
        tiles: bool,
        (resources, frame, descriptors): (&ShadeResources, &ShadeFrame, Descriptors),
    ) -> Vec<Vec4> {
        let every_frame = TileOptions { least_quads: 0, ..TileOptions::default() };
        let (tiles, table_size) = (tiles.then_some(every_frame), self.engine.table_size());
        let info = ShadePassInfo { tiles, table_size, descriptors, ..options.into() };
        let pass = self.engine.pass(info).unwrap();
        self.clear();
        run(self.engine, &pass, resources, SIZE, &[*frame], descriptors);
        stored_in(&self.radiance)
    }

    fn clear(&self) {
        self.radiance.upload(&vec![BEFORE.to_array(); pixels().count()], Usage::COMPUTE_WRITE).unwrap();
    }

    /// What the image of radiance holds after these commands, over [`BEFORE`].
    pub fn picture_after(&self, record: impl FnOnce(vk::CommandBuffer)) -> Vec<Vec4> {
        self.clear();
        self.engine.host().submit(record).unwrap();
        stored_in(&self.radiance)
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

/// From positions to a space with the eye at zero that looks along -z with y up.
pub fn looking_at_floor(eye: DVec3) -> DMat4 {
    let back = eye.normalize_or(DVec3::Z);
    let right = DVec3::Z.cross(back).normalize_or(DVec3::Z);
    let up = back.cross(right);
    DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), DVec4::W).transpose()
        * DMat4::from_translation(-eye)
}
