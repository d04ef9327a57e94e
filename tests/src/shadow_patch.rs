//! The shade pass and the shadow pass over an image whose pixels all see one shading point, each by rays of
//! its own.

use crate::TestEngine;
use arealight::plan::{ShadeOptions, ShadowFilter, TileOptions};
use arealight::{Blockers, Light, PackedLights, Plane, Planes};
use arealight_engine::host::{Buffer, Image, ImageDescription, Location, Usage};
use arealight_engine::texel_of;
use arealight_oracle::material::Material;
use arealight_vk::{
    BlockerResources, Bound, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources, ShadowFrame,
    ShadowOptions, ShadowPass, ShadowPassInfo, ShadowResources,
};
use ash::vk;
use glam::{DVec3, Vec3, Vec4};
use half::f16;

/// Pixels to a side of the image.
pub const SIDE: u32 = 64;

/// A shading point at the origin, whose surface looks up along z, with its lights and what blocks them.
#[derive(Debug, Clone)]
pub struct ShadowPatch {
    /// The surface's material.
    pub material: Material,
    /// From the point to the camera.
    pub view: Vec3,
    /// What shines.
    pub lights: Vec<Light>,
    /// Triangles, whose numbers are 1, 2 and so on.
    pub blockers: Vec<[Vec3; 3]>,
}

/// What the passes found of a patch.
#[derive(Debug, Clone)]
pub struct PatchShadows {
    /// Of each pixel, radiance without shadows.
    pub unshadowed: Vec<Vec3>,
    /// And with them.
    pub radiance: Vec<Vec3>,
    /// What [`ShadowResources::shadow`] holds.
    pub shadows: Vec<Vec4>,
}

impl PatchShadows {
    /// The mean over all pixels of the part of the light that arrives.
    pub fn mean(&self) -> f64 {
        self.shadows.iter().map(|shadow| f64::from(shadow.x)).sum::<f64>() / self.shadows.len() as f64
    }
}

/// Both passes.
pub struct PatchPasses<'a> {
    engine: &'a TestEngine,
    shade: ShadePass,
    shadow: ShadowPass,
    options: ShadeOptions,
    /// Set 1 of a module of the host's that says what blocks, or what is there of it.
    pub blocker_set: Option<vk::DescriptorSet>,
    /// Set 1 of one that says what part of a light arrives.
    pub visibility_set: Option<vk::DescriptorSet>,
}

impl<'a> PatchPasses<'a> {
    /// Makes them.
    pub fn new(engine: &'a TestEngine, options: ShadeOptions, filter: ShadowFilter) -> Self {
        let shadows = ShadowOptions { filter, ..ShadowOptions::default() };
        // SAFETY: Host::submit waits, and the passes are dropped before the engine.
        unsafe {
            let shade = ShadePass::new(engine.context(), options).unwrap();
            let shadow =
                ShadowPass::new(engine.context(), ShadowPassInfo { options, shadows, ..Default::default() })
                    .unwrap();
            Self { engine, shade, shadow, options, blocker_set: None, visibility_set: None }
        }
    }

    /// As [`PatchPasses::new`], with the lights of tiles.
    pub fn with_tiles(engine: &'a TestEngine, options: ShadeOptions) -> Self {
        let passes = Self::new(engine, options, ShadowFilter::Off);
        let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
        let info = ShadePassInfo { tiles: Some(tiles), table_size: engine.table_size(), ..options.into() };
        // SAFETY: As above.
        let shade = unsafe { ShadePass::new(engine.context(), info) };
        Self { shade: shade.unwrap(), ..passes }
    }

    /// As [`PatchPasses::new`], where a module of the host's says what blocks, which reads set 1 of this
    /// layout.
    pub fn with_blocker(
        engine: &'a TestEngine,
        options: ShadeOptions,
        module: Vec<u32>,
        layout: vk::DescriptorSetLayout,
    ) -> Self {
        let shadows = ShadowOptions { filter: ShadowFilter::Off, ..ShadowOptions::default() };
        // SAFETY: As above; the module is the test's, and the layout outlives the pass.
        unsafe {
            let shade = ShadePass::new(engine.context(), options).unwrap();
            let info = ShadowPassInfo { options, shadows, module: Some(module), host_set: Some(layout) };
            let shadow = ShadowPass::new(engine.context(), info).unwrap();
            Self { engine, shade, shadow, options, blocker_set: None, visibility_set: None }
        }
    }
}

impl<'a> PatchPasses<'a> {
    /// As [`PatchPasses::new`], where a module of the host's says what part of each light arrives, which
    /// reads set 1 of this layout.
    pub fn with_visibility(
        engine: &'a TestEngine,
        options: ShadeOptions,
        module: Vec<u32>,
        layout: vk::DescriptorSetLayout,
    ) -> Self {
        let passes = Self::new(engine, options, ShadowFilter::Off);
        let info = ShadePassInfo { module: Some(module), host_set: Some(layout), ..options.into() };
        // SAFETY: As above.
        let shade = unsafe { ShadePass::new(engine.context(), info) };
        Self { shade: shade.unwrap(), ..passes }
    }
}

impl ShadowPatch {
    /// Runs both passes.
    pub fn run(&self, passes: &PatchPasses<'_>) -> PatchShadows {
        let PatchPasses { engine, shade, shadow: shadows, options, blocker_set, visibility_set } = passes;
        let host = engine.host();
        let packed = PackedLights::new(&self.lights, DVec3::ZERO).unwrap();
        let blockers = Blockers::new(&self.blockers).unwrap().with_alpha(|index| index + 1);
        let images = Planes::from_fn(|plane| match plane {
            Plane::Position => filled(engine, [0.0, 0.0, 0.0, 1.0]),
            _ => filled(engine, texel_of(&self.material, Vec3::Z, plane)),
        });
        let [radiance, shadowed] = [(); 2].map(|()| stored(engine, vk::Format::R32G32B32A32_SFLOAT));
        let shadow = stored(engine, ShadowPass::SHADOW_FORMAT);
        let read =
            |image: &Image| Resource::SampledImage { view: image.view(), layout: Usage::COMPUTE_READ.layout };
        let of = |image: &Image| Resource::StorageImage { view: image.view() };
        let buffer = |buffer: &Buffer| Resource::buffer(buffer.handle());
        let lights = host.storage_buffer("lights", &packed.lights).unwrap();
        let vertices = host.storage_buffer("vertices", &packed.vertices).unwrap();
        let shapes = host.storage_buffer("shapes", &packed.shapes).unwrap();
        let nodes = host.storage_buffer("nodes", &blockers.nodes).unwrap();
        let triangles = host.storage_buffer("triangles", &blockers.triangles).unwrap();
        let picks = vec![0_u32; shade.picks_size([SIDE; 2]) as usize / 4];
        let picks = host.storage_buffer("picks", &picks).unwrap();
        let tiles = shade.tile_memory([SIDE; 2]).map(|memory| {
            let lists = host.buffer("tile lists", memory.size, memory.usage, Location::Device).unwrap();
            (
                lists,
                host.storage_buffer("lobe horizons", engine.lobe_horizons(options.quality.specular_lobes))
                    .unwrap(),
            )
        });
        let (tile_lists, lobe_horizons) =
            tiles.as_ref().map(|(lists, horizons)| (buffer(lists), buffer(horizons))).unzip();
        // SAFETY: Host::submit waits, and everything here is dropped before the engine.
        unsafe {
            let sizes = [shade.pool_sizes(1), shadows.pool_sizes(1)].concat();
            let pool = host.descriptor_pool(2, &sizes).unwrap();
            let sets =
                [shade.set_layout(), shadows.set_layout()].map(|layout| pool.allocate(layout).unwrap());
            let resources = ShadeResources {
                table: engine.table(),
                lights: buffer(&lights),
                light_vertices: buffer(&vertices),
                shapes: Some(buffer(&shapes)),
                planes: Planes::from_fn(|plane| (plane != Plane::Stencil).then(|| read(&images[plane]))),
                radiance: of(&radiance),
                picks: Some(buffer(&picks)),
                lobe_horizons,
                tile_lists,
                ..ShadeResources::default()
            };
            shade.write_set(sets[0], &resources).unwrap();
            let of_shadows = ShadowResources {
                shadow: of(&shadow),
                radiance: Some(of(&shadowed)),
                history: None,
                blockers: Some(BlockerResources { nodes: buffer(&nodes), triangles: buffer(&triangles) }),
            };
            shadows.write_set(sets[1], &resources, &of_shadows).unwrap();
            let frame = ShadeFrame {
                size: [SIDE; 2],
                camera: self.view,
                lights: packed.summary(),
                tile_lists,
                ..ShadeFrame::default()
            };
            let bound = |set, own: &Option<_>| own.map_or(Bound::Set(set), |own| Bound::Sets([set, own]));
            let [of_shade, of_rays] = [bound(sets[0], visibility_set), bound(sets[1], blocker_set)];
            host.submit(|commands| shade.record(commands, of_shade, &frame).unwrap()).unwrap();
            let frame = ShadowFrame { shade: &frame, origin_shift: Vec3::ZERO };
            host.submit(|commands| shadows.record(commands, of_rays, &of_shadows, &frame).unwrap()).unwrap();
        }
        let pixels = |image: &Image| {
            let texels: Vec<[f32; 4]> = image.download(Usage::COMPUTE_WRITE).unwrap();
            texels.into_iter().map(|texel| Vec4::from_array(texel).truncate()).collect()
        };
        let shadows: Vec<[u16; 4]> = shadow.download(Usage::COMPUTE_WRITE).unwrap();
        let number = |bits| f16::from_bits(bits).to_f32();
        PatchShadows {
            unshadowed: pixels(&radiance),
            radiance: pixels(&shadowed),
            shadows: shadows.into_iter().map(|texel| Vec4::from_array(texel.map(number))).collect(),
        }
    }
}

fn image(engine: &TestEngine, format: vk::Format, usage: vk::ImageUsageFlags) -> Image {
    let description = ImageDescription { name: "patch", extent: [SIDE; 2], layers: 1, format, usage };
    engine.host().image(&description).unwrap()
}

/// An image of one colour, to be read.
pub fn filled(engine: &TestEngine, texel: [f32; 4]) -> Image {
    let image = image(engine, vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED);
    image.upload(&vec![texel; (SIDE * SIDE) as usize], Usage::COMPUTE_READ).unwrap();
    image
}

/// An image to be written.
pub fn stored(engine: &TestEngine, format: vk::Format) -> Image {
    let image = image(engine, format, vk::ImageUsageFlags::STORAGE);
    let host = engine.host();
    host.submit(|commands| image.transition(commands, Usage::UNDEFINED, Usage::COMPUTE_WRITE)).unwrap();
    image
}
