//! Images on lights, as layers of one array image with mips, drawn anew each frame: an image may be loaded
//! again, or be drawn to.

use crate::extract::ExtractedLights;
use crate::pipelines::{DRAWN, Pipelines};
use arealight::pyramid::LAYERS;
use bevy::log::warn_once;
use bevy::prelude::*;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{
    AddressMode, BindGroupEntries, Extent3d, FilterMode, LoadOp, MipmapFilterMode, Operations, PipelineCache,
    RenderPassColorAttachment, RenderPassDescriptor, Sampler, SamplerDescriptor, StoreOp, Texture,
    TextureDescriptor, TextureDimension, TextureSampleType, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};
use bevy::render::renderer::{RenderContext, RenderDevice};
use bevy::render::texture::GpuImage;

/// Texels a side of an image on a light.
const SIDE: u32 = 256;
const MIPS: u32 = SIDE.ilog2() + 1;
/// The most images at once: WebGPU's layers of an array image.
pub(crate) const MOST_IMAGES: usize = 256 / LAYERS as usize;

/// The layers.
#[derive(Resource)]
pub(crate) struct LightImages {
    texture: Texture,
    /// All of them.
    pub view: TextureView,
    /// Trilinear, to the edge.
    pub sampler: Sampler,
}

impl LightImages {
    /// Black layers for so many images, from 0.
    pub fn new(device: &RenderDevice, images: u32) -> Self {
        let layers = LAYERS * images.next_power_of_two();
        let texture = device.create_texture(&TextureDescriptor {
            label: Some("arealight_images"),
            size: Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: layers },
            mip_level_count: MIPS,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: DRAWN,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let sampler = device.create_sampler(&SamplerDescriptor {
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            mipmap_filter: MipmapFilterMode::Linear,
            ..default()
        });
        Self { view: texture.create_view(&TextureViewDescriptor::default()), texture, sampler }
    }

    fn holds(&self, images: usize) -> bool {
        images as u32 * LAYERS <= self.texture.depth_or_array_layers()
    }

    /// A mip of an image's first layer.
    fn mip(&self, image: u32, mip: u32) -> TextureView {
        self.texture.create_view(&TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2),
            base_mip_level: mip,
            mip_level_count: Some(1),
            base_array_layer: image * LAYERS,
            array_layer_count: Some(1),
            ..default()
        })
    }
}

/// Makes room for the images of a frame.
pub(crate) fn prepare(
    lights: Res<ExtractedLights>,
    device: Res<RenderDevice>,
    mut images: ResMut<LightImages>,
) {
    if !images.holds(lights.images.len()) {
        *images = LightImages::new(&device, lights.images.len() as u32);
    }
}

/// Draws each image into its layer, and the mips, each from the one before.
pub(crate) fn draw(
    lights: Res<ExtractedLights>,
    loaded: Res<RenderAssets<GpuImage>>,
    images: Res<LightImages>,
    pipelines: Res<Pipelines>,
    cache: Res<PipelineCache>,
    mut context: RenderContext,
) {
    let Some(pipeline) = cache.get_render_pipeline(pipelines.shrink) else { return };
    for (image, id) in (0..).zip(&lights.images) {
        // What is not there yet is black
        let mut source = loaded.get(*id).filter(|it| is_shown(it)).map(|it| it.texture_view.clone());
        for mip in 0..MIPS {
            let target = images.mip(image, mip);
            let group = source.as_ref().map(|source| {
                let entries = BindGroupEntries::sequential((source, &images.sampler));
                let layout = cache.get_bind_group_layout(&pipelines.shrink_layout);
                context.render_device().create_bind_group("arealight_image", &layout, &entries)
            });
            let mut pass = context.begin_tracked_render_pass(RenderPassDescriptor {
                label: Some("arealight_image"),
                color_attachments: &[Some(RenderPassColorAttachment {
                    view: &target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Operations { load: LoadOp::Clear(default()), store: StoreOp::Store },
                })],
                ..default()
            });
            if let Some(group) = &group {
                pass.set_render_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
            }
            drop(pass);
            source = source.map(|_| target);
        }
    }
}

/// Whether an image can be drawn: a flat one, in a format that can be filtered. A warning says so, once.
fn is_shown(image: &GpuImage) -> bool {
    let descriptor = &image.texture_descriptor;
    let is_flat = descriptor.dimension == TextureDimension::D2 && descriptor.size.depth_or_array_layers == 1;
    let is_filtered =
        descriptor.format.sample_type(None, None) == Some(TextureSampleType::Float { filterable: true });
    if !(is_flat && is_filtered) {
        warn_once!(
            "an image on an area light is black: {:?} is not a flat image that can be filtered",
            descriptor
        );
    }
    is_flat && is_filtered
}
