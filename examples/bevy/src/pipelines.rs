//! What the GPU runs, and its layouts.

use crate::images::LightImages;
use arealight::plan::{ShadeOptions, shade_specialization};
use arealight::table::LAYERS;
use arealight::{Effects, Footprint, LightSummary, LightTable, Quality};
use arealight_tool_kernels::kernels::SHADE_PORTABLE;
use arealight_vk::freeze;
use bevy::asset::uuid::Uuid;
use bevy::log::error;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::render_resource::binding_types::{
    sampler, storage_buffer_sized, texture_2d, texture_2d_array, texture_storage_2d, uniform_buffer_sized,
};
use bevy::render::render_resource::{
    BindGroupLayoutDescriptor, BindGroupLayoutEntries, BlendComponent, BlendFactor, BlendOperation,
    BlendState, CachedComputePipelineId, CachedRenderPipelineId, ColorTargetState, ColorWrites,
    ComputePipelineDescriptor, Extent3d, FragmentState, PipelineCache, RenderPipelineDescriptor,
    SamplerBindingType, ShaderStages, StorageTextureAccess, TextureDataOrder, TextureDescriptor,
    TextureDimension, TextureFormat, TextureSampleType, TextureUsages, TextureView, TextureViewDescriptor,
    VertexState,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::shader::Shader;
use std::marker::PhantomData;

/// The formats of what a G-buffer is unpacked to: normal and roughness, base colour and metalness,
/// reflectances, coat.
pub(crate) const PLANES: [TextureFormat; 4] = [
    TextureFormat::Rgba32Float,
    TextureFormat::Rgba16Float,
    TextureFormat::Rgba16Float,
    TextureFormat::Rgba16Float,
];
/// The format of radiance, before it is added.
pub(crate) const RADIANCE: TextureFormat = TextureFormat::Rgba32Float;

/// The format of what is drawn: pictures of cameras that are HDR, and images on lights.
pub(crate) const DRAWN: TextureFormat = TextureFormat::Rgba16Float;

/// What kernels are made with.
#[derive(Resource, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Needed {
    /// What surfaces have, and what any light so far had.
    pub effects: Effects,
    /// How exact they are.
    pub quality: Quality,
}

/// What the GPU runs.
#[derive(Resource)]
pub(crate) struct Pipelines {
    /// The light table, of six layers.
    pub table: TextureView,
    /// Layout of what the G-buffer is unpacked from and to.
    pub unpack_layout: BindGroupLayoutDescriptor,
    /// Layout of what the kernel binds, whatever its effects.
    pub shade_layout: BindGroupLayoutDescriptor,
    /// Layout of the radiance that is added.
    pub add_layout: BindGroupLayoutDescriptor,
    /// Unpacks the G-buffer.
    pub unpack: CachedComputePipelineId,
    /// Adds radiance to a picture.
    pub add: CachedRenderPipelineId,
    /// Layout of an image that is drawn into a smaller one.
    pub shrink_layout: BindGroupLayoutDescriptor,
    /// Draws it.
    pub shrink: CachedRenderPipelineId,
    kernels: HashMap<(Needed, bool), Option<CachedComputePipelineId>>,
}

/// Makes what does not depend on lights and cameras.
pub(crate) fn make(
    mut commands: Commands,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut cache: ResMut<PipelineCache>,
) {
    let bridge = shader_handle(u32::MAX, false);
    cache.set_shader(
        bridge.id(),
        Shader::from_wgsl(include_str!("bridge.wgsl"), "bevy_arealight/bridge.wgsl"),
    );
    let unpack_layout = unpack_layout();
    let unpack = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some("arealight_unpack".into()),
        layout: vec![unpack_layout.clone()],
        shader: bridge.clone(),
        entry_point: Some("unpack".into()),
        ..default()
    });
    let one = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    };
    let sum = Some(BlendState { color: one, alpha: one });
    let (add_layout, shrink_layout) = (add_layout(), shrink_layout());
    let add = cache.queue_render_pipeline(covering(&bridge, "add", &add_layout, sum));
    let shrink = cache.queue_render_pipeline(covering(&bridge, "shrink", &shrink_layout, None));
    commands.insert_resource(LightImages::new(&device, 0));
    commands.insert_resource(Pipelines {
        table: upload_table(&device, &queue),
        unpack_layout,
        shade_layout: shade_layout(),
        add_layout,
        unpack,
        add,
        shrink_layout,
        shrink,
        kernels: HashMap::default(),
    });
}

impl Pipelines {
    /// The kernel for a kind of camera; `None` where there is none, which is logged.
    pub fn kernel(
        &mut self,
        cache: &mut PipelineCache,
        needed: Needed,
        orthographic: bool,
    ) -> Option<CachedComputePipelineId> {
        *self.kernels.entry((needed, orthographic)).or_insert_with(|| {
            let effects = needed.effects;
            let Some(words) = kernel(needed, orthographic) else {
                error!("no kernel can be made for {effects}: a fault of Arealight");
                return None;
            };
            let shader = shader_handle(effects.bits(), orthographic);
            let bytes = bytemuck::cast_slice(&words).to_vec();
            cache.set_shader(
                shader.id(),
                Shader::from_spirv(bytes, format!("bevy_arealight/{}", shader.id())),
            );
            Some(cache.queue_compute_pipeline(ComputePipelineDescriptor {
                label: Some(format!("arealight: {effects}").into()),
                layout: vec![self.shade_layout.clone()],
                shader,
                entry_point: Some("main".into()),
                ..default()
            }))
        })
    }
}

/// A pipeline that draws every pixel by a function of the bridge's.
fn covering(
    bridge: &Handle<Shader>,
    function: &'static str,
    layout: &BindGroupLayoutDescriptor,
    blend: Option<BlendState>,
) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor {
        label: Some(format!("arealight_{function}").into()),
        layout: vec![layout.clone()],
        vertex: VertexState { shader: bridge.clone(), entry_point: Some("cover".into()), ..default() },
        fragment: Some(FragmentState {
            shader: bridge.clone(),
            entry_point: Some(function.into()),
            targets: vec![Some(ColorTargetState { format: DRAWN, blend, write_mask: ColorWrites::ALL })],
            ..default()
        }),
        ..default()
    }
}

/// A handle for a shader that is no asset.
fn shader_handle(bits: u32, orthographic: bool) -> Handle<Shader> {
    let number = 0xa4ea_1197_0000_4000_8000_0000_0000_0000 | u128::from(bits) << 1 | u128::from(orthographic);
    Handle::Uuid(Uuid::from_u128(number), PhantomData)
}

/// The kernel `shade` that every backend runs, as SPIR-V with these effects and no other.
fn kernel(Needed { effects, quality }: Needed, orthographic: bool) -> Option<Vec<u32>> {
    let options = ShadeOptions {
        surfaces: effects & Effects::SURFACES,
        quality: Quality { footprint: Footprint::Mips, ..quality },
        from_depth: true,
        orthographic,
        rectangle: true, // a camera's viewport
        ..ShadeOptions::default()
    };
    // Of the counts only whether there are quads is in the kernel: a frame says how many
    let lights = LightSummary { light_count: 1, quad_count: 1, effects, ..LightSummary::default() };
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(SHADE_PORTABLE);
    freeze(&words, &shade_specialization(options, lights))
}

fn upload_table(device: &RenderDevice, queue: &RenderQueue) -> TextureView {
    let table = LightTable::ggx();
    let size = Extent3d { width: table.size(), height: table.size(), depth_or_array_layers: LAYERS };
    let descriptor = TextureDescriptor {
        label: Some("arealight_table"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba32Float,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let texels = table.texels();
    let bytes = bytemuck::cast_slice(&texels);
    device
        .create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, bytes)
        .create_view(&TextureViewDescriptor::default())
}

/// What is read by texel.
const READ: TextureSampleType = TextureSampleType::Float { filterable: false };
/// What is read between texels.
const FILTERED: TextureSampleType = TextureSampleType::Float { filterable: true };

fn unpack_layout() -> BindGroupLayoutDescriptor {
    let written = PLANES.map(|format| texture_storage_2d(format, StorageTextureAccess::WriteOnly));
    let [normal, base_color, specular, coat] = written;
    let entries = (texture_2d(TextureSampleType::Uint), normal, base_color, specular, coat);
    let entries = BindGroupLayoutEntries::sequential(ShaderStages::COMPUTE, entries);
    BindGroupLayoutDescriptor::new("arealight_unpack", &entries)
}

/// By the numbers of `shaders/kernels/bindings.glsl`; a kernel may use fewer.
fn shade_layout() -> BindGroupLayoutDescriptor {
    let entries = (
        (0, texture_2d_array(READ)),                                        // table_image
        (1, storage_buffer_sized(false, None)),                             // lights
        (2, storage_buffer_sized(false, None)),                             // light_vertices
        (3, texture_2d(READ)),                                              // g_position: depth
        (4, texture_2d(READ)),                                              // g_normal
        (5, texture_2d(READ)),                                              // g_base_color
        (6, texture_2d(READ)),                                              // g_specular
        (7, texture_storage_2d(RADIANCE, StorageTextureAccess::WriteOnly)), // radiance_image
        (8, texture_2d_array(FILTERED)),                                    // light_images
        (9, storage_buffer_sized(false, None)),                             // shapes
        (11, texture_2d(READ)),                                             // g_coat
        (17, uniform_buffer_sized(false, None)),                            // constants
        (18, sampler(SamplerBindingType::Filtering)),                       // light_sampler
    );
    let entries = BindGroupLayoutEntries::with_indices(ShaderStages::COMPUTE, entries);
    BindGroupLayoutDescriptor::new("arealight_shade", &entries)
}

fn add_layout() -> BindGroupLayoutDescriptor {
    let entries = BindGroupLayoutEntries::sequential(ShaderStages::FRAGMENT, (texture_2d(READ),));
    BindGroupLayoutDescriptor::new("arealight_add", &entries)
}

fn shrink_layout() -> BindGroupLayoutDescriptor {
    let entries = (texture_2d(FILTERED), sampler(SamplerBindingType::Filtering));
    let entries = BindGroupLayoutEntries::sequential(ShaderStages::FRAGMENT, entries);
    BindGroupLayoutDescriptor::new("arealight_shrink", &entries)
}
