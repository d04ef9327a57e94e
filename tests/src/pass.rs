//! What a host has, as small as can be: lights in buffers, images, and a pass over them.

use crate::TestEngine;
use arealight::{Light, PackedLights, Plane, Planes};
use arealight_engine::host::{Buffer, Image, ImageDescription, Location, Usage};
use arealight_vk::{
    Bound, Descriptors, Error, Resource, ShadeFrame, ShadePass, ShadePassInfo, ShadeResources,
};
use ash::vk;
use glam::{DVec3, Vec3, Vec4};

impl TestEngine {
    /// A shade pass, or what is wrong with its options.
    pub fn pass(&self, info: impl Into<ShadePassInfo>) -> Result<ShadePass, Error> {
        // SAFETY: Tests wait for what they submit, and drop passes before the engine; modules are of kernels,
        // and what is none is refused.
        unsafe { ShadePass::new(self.context(), info) }
    }
}

/// The field that a host's mistake is in.
pub fn field(error: &Error) -> &'static str {
    match error {
        Error::InvalidArgument { field, .. } => field,
        other => panic!("{other} names no field"),
    }
}

/// Lights as a pass reads them.
pub struct LightBuffers {
    /// What was packed, in the order of the buffers.
    pub packed: PackedLights,
    buffers: [Buffer; 3],
}

impl LightBuffers {
    /// Lights about an origin.
    pub fn new(engine: &TestEngine, lights: &[Light], origin: DVec3) -> Self {
        let packed = PackedLights::new(lights, origin).unwrap();
        // At least a record: a set may have lights where a frame has none
        let buffer = |name, bytes: &[u8]| {
            let padded: Vec<u8> = bytes.iter().copied().chain([0; 64]).take(bytes.len().max(64)).collect();
            engine.host().storage_buffer(name, &padded).unwrap()
        };
        let buffers = [
            buffer("lights", bytemuck::cast_slice(&packed.lights)),
            buffer("vertices", bytemuck::cast_slice(&packed.vertices)),
            buffer("shapes", bytemuck::cast_slice(&packed.shapes)),
        ];
        Self { packed, buffers }
    }

    /// The engine's table and these lights, without planes and radiance.
    pub fn resources(&self, engine: &TestEngine) -> ShadeResources {
        let [lights, light_vertices, shapes] =
            self.buffers.each_ref().map(|buffer| Resource::buffer(buffer.handle()));
        ShadeResources {
            table: engine.table(),
            lights,
            light_vertices,
            shapes: Some(shapes),
            ..ShadeResources::default()
        }
    }

    /// A frame under them.
    pub fn frame(&self, size: [u32; 2], camera: Vec3) -> ShadeFrame {
        ShadeFrame { size, camera, lights: self.packed.summary(), ..ShadeFrame::default() }
    }
}

/// An image with these texels, to be read or stored to.
pub fn image<T: bytemuck::Pod>(
    engine: &TestEngine,
    extent: [u32; 2],
    format: vk::Format,
    usage: vk::ImageUsageFlags,
    texels: &[T],
) -> Image {
    let description = ImageDescription { name: "of a test", extent, layers: 1, format, usage };
    let image = engine.host().image(&description).unwrap();
    let stored = usage.contains(vk::ImageUsageFlags::STORAGE);
    image.upload(texels, if stored { Usage::COMPUTE_WRITE } else { Usage::COMPUTE_READ }).unwrap();
    image
}

/// The planes of a G-buffer of `extent`, of four floats a texel: what a function says of each.
pub fn planes(
    engine: &TestEngine,
    extent: [u32; 2],
    texel: &dyn Fn(Plane, [u32; 2]) -> Option<Vec4>,
) -> Planes<Option<Image>> {
    let (format, usage) = (vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED);
    Planes::from_fn(|plane| {
        let texels = texels(extent).map(|place| texel(plane, place).map(|texel| texel.to_array()));
        Some(image(engine, extent, format, usage, &texels.collect::<Option<Vec<_>>>()?))
    })
}

/// The places of the texels, in the order of an image.
pub fn texels(extent: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..extent[1]).flat_map(move |y| (0..extent[0]).map(move |x| [x, y]))
}

/// Planes as a pass reads them.
pub fn reads(planes: &Planes<Option<Image>>) -> Planes<Option<Resource>> {
    Planes::from_fn(|plane| planes[plane].as_ref().map(read))
}

/// An image of four floats a texel, to be stored to, all of which hold `before`.
pub fn radiance(engine: &TestEngine, extent: [u32; 2], before: Vec4) -> Image {
    let texels = vec![before.to_array(); (extent[0] * extent[1]) as usize];
    image(engine, extent, vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::STORAGE, &texels)
}

/// What a pass reads by texel.
pub fn read(image: &Image) -> Resource {
    Resource::SampledImage { view: image.view(), layout: Usage::COMPUTE_READ.layout }
}

/// What a pass stores to.
pub fn store(image: &Image) -> Resource {
    Resource::StorageImage { view: image.view() }
}

/// What a pass stored.
pub fn stored_in(image: &Image) -> Vec<Vec4> {
    let texels: Vec<[f32; 4]> = image.download(Usage::COMPUTE_WRITE).unwrap();
    texels.into_iter().map(Vec4::from_array).collect()
}

/// The lists of a pass with tiles, for images of `extent`, and the horizons of its lobes.
pub fn tile_buffers(engine: &TestEngine, pass: &ShadePass, extent: [u32; 2]) -> Option<[Buffer; 2]> {
    let lists = pass.tile_memory(extent)?;
    let horizons = engine.lobe_horizons(pass.options().quality.specular_lobes);
    Some([
        engine.host().buffer("lists", lists.size, lists.usage, Location::Device).unwrap(),
        engine.host().storage_buffer("horizons", horizons).unwrap(),
    ])
}

/// Records frames over images of `extent` one after the other, and waits; with lists for tiles where the pass
/// has them.
pub fn run(
    engine: &TestEngine,
    pass: &ShadePass,
    resources: &ShadeResources,
    extent: [u32; 2],
    frames: &[ShadeFrame],
    descriptors: Descriptors,
) {
    let host = engine.host();
    let lists = tile_buffers(engine, pass, extent);
    let [tile_lists, lobe_horizons] =
        [0, 1].map(|index: usize| lists.as_ref().map(|lists| Resource::buffer(lists[index].handle())));
    let resources = &ShadeResources { tile_lists, lobe_horizons, ..*resources };
    let has_set = descriptors != Descriptors::Pushed;
    let pool = has_set.then(|| host.descriptor_pool(1, &pass.pool_sizes(1)).unwrap());
    // SAFETY: The set is new, and Host::submit waits before anything of it goes.
    unsafe {
        let set = pool.as_ref().map(|pool| pool.allocate(pass.set_layout()).unwrap());
        let bound = set.map_or(Bound::Pushed { resources, host_set: None }, |set| {
            pass.write_set(set, resources).unwrap();
            Bound::Set(set)
        });
        for frame in frames {
            let frame = ShadeFrame { tile_lists, ..*frame };
            host.submit(|commands| pass.record(commands, bound, &frame).unwrap()).unwrap();
        }
    }
}
