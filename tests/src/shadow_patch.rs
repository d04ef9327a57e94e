//! The shade pass and the shadow pass over an image whose pixels all see one shading point, each by rays of
//! its own.

use crate::TestEngine;
use crate::pass::{LightBuffers, image, planes, radiance, reads, store, stored_in, tile_buffers};
use arealight::plan::{ShadeOptions, ShadowFilter, TileOptions};
use arealight::{Blockers, Light, Plane};
use arealight_engine::host::{Buffer, Image, Usage};
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
    /// Set 1 of a module of the host's that says what blocks, or what is there of it.
    pub blocker_set: Option<vk::DescriptorSet>,
    /// Set 1 of one that says what part of a light arrives.
    pub visibility_set: Option<vk::DescriptorSet>,
}

/// A module of the host's, and the layout of set 1, which it reads.
pub type HostModule = (Vec<u32>, vk::DescriptorSetLayout);

impl<'a> PatchPasses<'a> {
    /// Makes them.
    pub fn new(engine: &'a TestEngine, options: ShadeOptions, filter: ShadowFilter) -> Self {
        Self::with(engine, options.into(), filter, None)
    }

    /// As [`PatchPasses::new`], with the lights of tiles.
    pub fn with_tiles(engine: &'a TestEngine, options: ShadeOptions) -> Self {
        let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
        let info = ShadePassInfo { tiles: Some(tiles), table_size: engine.table_size(), ..options.into() };
        Self::with(engine, info, ShadowFilter::Off, None)
    }

    /// As [`PatchPasses::new`], where a module of the host's says what blocks.
    pub fn with_blocker(engine: &'a TestEngine, options: ShadeOptions, blocker: HostModule) -> Self {
        Self::with(engine, options.into(), ShadowFilter::Off, Some(blocker))
    }

    /// As [`PatchPasses::new`], where a module of the host's says what part of each light arrives.
    pub fn with_visibility(
        engine: &'a TestEngine,
        options: ShadeOptions,
        (module, layout): HostModule,
    ) -> Self {
        let info = ShadePassInfo { module: Some(module), host_set: Some(layout), ..options.into() };
        Self::with(engine, info, ShadowFilter::Off, None)
    }

    fn with(
        engine: &'a TestEngine,
        info: ShadePassInfo,
        filter: ShadowFilter,
        blocker: Option<HostModule>,
    ) -> Self {
        let (options, shadows) = (info.options, ShadowOptions { filter, ..ShadowOptions::default() });
        let (module, host_set) = blocker.unzip();
        let shadow = ShadowPassInfo { options, shadows, module, host_set };
        // SAFETY: Host::submit waits, and the passes are dropped before the engine; the module is the test's,
        // whose layout outlives the pass.
        let shadow = unsafe { ShadowPass::new(engine.context(), shadow) }.unwrap();
        let shade = engine.pass(info).unwrap();
        Self { engine, shade, shadow, blocker_set: None, visibility_set: None }
    }
}

impl ShadowPatch {
    /// Runs both passes.
    pub fn run(&self, passes: &PatchPasses<'_>) -> PatchShadows {
        let PatchPasses { engine, shade, shadow: shadows, blocker_set, visibility_set } = passes;
        let host = engine.host();
        let blockers = Blockers::new(&self.blockers).unwrap().with_alpha(|index| index + 1);
        let images = planes(engine, [SIDE; 2], &|plane, _| match plane {
            Plane::Position => Some(Vec4::W),
            Plane::Stencil => None,
            _ => Some(Vec4::from_array(texel_of(&self.material, Vec3::Z, plane))),
        });
        let [unshadowed, shadowed] = [(); 2].map(|()| radiance(engine, [SIDE; 2], Vec4::NAN));
        let shadow = shadow_image(engine);
        let buffer = |buffer: &Buffer| Resource::buffer(buffer.handle());
        let lights = LightBuffers::new(engine, &self.lights, DVec3::ZERO);
        let nodes = host.storage_buffer("nodes", &blockers.nodes).unwrap();
        let triangles = host.storage_buffer("triangles", &blockers.triangles).unwrap();
        let picks = vec![0_u32; shade.picks_size([SIDE; 2]) as usize / 4];
        let picks = host.storage_buffer("picks", &picks).unwrap();
        let tiles = tile_buffers(engine, shade, [SIDE; 2]);
        let (tile_lists, lobe_horizons) =
            tiles.as_ref().map(|[lists, horizons]| (buffer(lists), buffer(horizons))).unzip();
        // SAFETY: Host::submit waits, and everything here is dropped before the engine.
        unsafe {
            let sizes = [shade.pool_sizes(1), shadows.pool_sizes(1)].concat();
            let pool = host.descriptor_pool(2, &sizes).unwrap();
            let sets =
                [shade.set_layout(), shadows.set_layout()].map(|layout| pool.allocate(layout).unwrap());
            let resources = ShadeResources {
                planes: reads(&images),
                radiance: store(&unshadowed),
                picks: Some(buffer(&picks)),
                lobe_horizons,
                tile_lists,
                ..lights.resources(engine)
            };
            shade.write_set(sets[0], &resources).unwrap();
            let of_shadows = ShadowResources {
                shadow: store(&shadow),
                radiance: Some(store(&shadowed)),
                history: None,
                blockers: Some(BlockerResources { nodes: buffer(&nodes), triangles: buffer(&triangles) }),
            };
            shadows.write_set(sets[1], &resources, &of_shadows).unwrap();
            let frame = ShadeFrame { tile_lists, ..lights.frame([SIDE; 2], self.view) };
            let bound = |set, own: &Option<_>| own.map_or(Bound::Set(set), |own| Bound::Sets([set, own]));
            let [of_shade, of_rays] = [bound(sets[0], visibility_set), bound(sets[1], blocker_set)];
            host.submit(|commands| shade.record(commands, of_shade, &frame).unwrap()).unwrap();
            let frame = ShadowFrame { shade: &frame, origin_shift: Vec3::ZERO };
            host.submit(|commands| shadows.record(commands, of_rays, &of_shadows, &frame).unwrap()).unwrap();
        }
        let colors = |image| stored_in(image).into_iter().map(Vec4::truncate).collect();
        let shadows: Vec<[u16; 4]> = shadow.download(Usage::COMPUTE_WRITE).unwrap();
        let number = |bits| f16::from_bits(bits).to_f32();
        PatchShadows {
            unshadowed: colors(&unshadowed),
            radiance: colors(&shadowed),
            shadows: shadows.into_iter().map(|texel| Vec4::from_array(texel.map(number))).collect(),
        }
    }
}

/// An image for what shadow passes find at each pixel.
pub fn shadow_image(engine: &TestEngine) -> Image {
    let texels = vec![[0_u16; 4]; (SIDE * SIDE) as usize];
    image(engine, [SIDE; 2], ShadowPass::SHADOW_FORMAT, vk::ImageUsageFlags::STORAGE, &texels)
}
