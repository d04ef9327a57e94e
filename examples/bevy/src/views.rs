//! What each camera needs in a frame, and the passes.

use crate::extract::ExtractedLights;
use crate::images::LightImages;
use crate::pipelines::{Needed, PLANES, Pipelines, RADIANCE};
use arealight::glam::DVec3;
use arealight::gpu::{GpuLight, GpuShape, ShadeConstants};
use arealight::{Light, PackedLights};
use bevy::camera::visibility::RenderLayers;
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::ecs::system::SystemParam;
use bevy::log::warn_once;
use bevy::math::{Mat4, UVec4};
use bevy::prelude::*;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::render_resource::{
    BindGroup, BindGroupEntries, Buffer, BufferInitDescriptor, BufferUsages, CachedComputePipelineId,
    ComputePassDescriptor, Extent3d, PipelineCache, RenderPassDescriptor, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView,
};
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::texture::TextureCache;
use bevy::render::view::{ExtractedView, ViewTarget};

/// What the passes of a camera bind in a frame.
#[derive(Component)]
pub(crate) struct ViewAreaLights {
    unpack: BindGroup,
    shade: BindGroup,
    add: BindGroup,
    kernel: CachedComputePipelineId,
    /// Of the G-buffer.
    size: Extent3d,
    /// Origin and size of what the camera draws of it.
    viewport: UVec4,
}

type View<'a> = (
    Entity,
    &'a ExtractedCamera,
    &'a ExtractedView,
    Option<&'a ViewPrepassTextures>,
    Option<&'a TemporalJitter>,
    Option<&'a RenderLayers>,
);

/// What bindings are made with.
#[derive(SystemParam)]
pub(crate) struct Gpu<'w> {
    device: Res<'w, RenderDevice>,
    cache: ResMut<'w, PipelineCache>,
    textures: ResMut<'w, TextureCache>,
    pipelines: ResMut<'w, Pipelines>,
    needed: ResMut<'w, Needed>,
    images: Res<'w, LightImages>,
}

/// Packs the lights of each camera, and binds what its passes read and write.
pub(crate) fn prepare(
    mut commands: Commands,
    views: Query<View, With<Camera3d>>,
    extracted: Res<ExtractedLights>,
    mut gpu: Gpu,
) {
    for (entity, camera, view, prepass, jitter, layers) in &views {
        commands.entity(entity).remove::<ViewAreaLights>();
        let lights = lights_of(&extracted, layers.unwrap_or_default(), camera.exposure);
        if lights.is_empty() || !is_able(camera) {
            continue;
        }
        let Some(g_buffer) = g_buffer(prepass) else { continue };
        let Some(packed) = packed(&lights, view) else { continue };
        let constants = constants(view, jitter, &packed);
        if let Some(bound) = gpu.bind(view, &packed, &constants, &g_buffer) {
            commands.entity(entity).insert(bound);
        }
    }
}

/// The lights that a camera sees the light of, exposed as it is.
fn lights_of(extracted: &ExtractedLights, layers: &RenderLayers, exposure: f32) -> Vec<Light> {
    let seen = extracted.lights.iter().filter(|(_, of)| of.intersects(layers));
    seen.map(|(light, _)| Light { radiance: light.radiance * exposure, ..light.clone() }).collect()
}

/// Whether radiance can be added to what a camera draws. A warning says what to do, once.
fn is_able(camera: &ExtractedCamera) -> bool {
    if !camera.hdr {
        warn_once!(
            "a camera shows no area lights: add Hdr to it, so that light is added before tone mapping"
        );
    }
    camera.hdr
}

/// What is read of Bevy: surfaces and depth, and their size. A warning says what to do without, once.
fn g_buffer(prepass: Option<&ViewPrepassTextures>) -> Option<(TextureView, TextureView, Extent3d)> {
    let found = prepass.and_then(|it| Some((it.deferred_view()?.clone(), it.depth_view()?.clone(), it.size)));
    if found.is_none() {
        warn_once!("a camera shows no area lights: add DepthPrepass and DeferredPrepass to it");
    }
    found
}

/// The lights relative to the camera. A warning names one that is too far from it, once.
fn packed(lights: &[Light], view: &ExtractedView) -> Option<PackedLights> {
    let origin = DVec3::from_array(view.world_from_view.translation().to_array().map(f64::from));
    PackedLights::new(lights, origin)
        .inspect_err(|error| warn_once!("a camera shows no area lights: {error}"))
        .ok()
}

/// What the kernel knows of a frame. The origin is the camera.
fn constants(view: &ExtractedView, jitter: Option<&TemporalJitter>, packed: &PackedLights) -> ShadeConstants {
    let UVec4 { x, y, z: width, w: height } = view.viewport;
    let mut clip_from_view = view.clip_from_view;
    if let Some(jitter) = jitter {
        jitter.jitter_projection(&mut clip_from_view, Vec2::new(width as f32, height as f32));
    }
    let mut turned = view.world_from_view.affine();
    turned.translation = default();
    // The kernel's clip space has y down
    let upright = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    let summary = packed.summary();
    ShadeConstants {
        position_from_clip: (Mat4::from(turned) * clip_from_view.inverse() * upright).to_cols_array_2d(),
        camera: if is_orthographic(view) { view.world_from_view.back().to_array() } else { [0.0; 3] },
        light_count: summary.light_count,
        shape_count: summary.shape_count,
        quad_count: summary.quad_count,
        size: [width, height],
        offset: [x, y],
        ..ShadeConstants::default()
    }
}

fn is_orthographic(view: &ExtractedView) -> bool {
    view.clip_from_view.w_axis.w == 1.0
}

impl Gpu<'_> {
    /// Binds what a camera's passes read and write. Nothing where no kernel can be made.
    fn bind(
        &mut self,
        view: &ExtractedView,
        packed: &PackedLights,
        constants: &ShadeConstants,
        (deferred, depth, size): &(TextureView, TextureView, Extent3d),
    ) -> Option<ViewAreaLights> {
        self.needed.effects |= packed.summary().effects;
        let kernel = self.pipelines.kernel(&mut self.cache, *self.needed, is_orthographic(view))?;
        let [normal, base_color, specular, coat] = PLANES.map(|format| self.image(format, *size));
        let radiance = self.image(RADIANCE, *size);
        let [lights, vertices, shapes] = [
            bytemuck::cast_slice(&or_zeros::<GpuLight>(&packed.lights)),
            bytemuck::cast_slice(&or_zeros::<[f32; 4]>(&packed.vertices)),
            bytemuck::cast_slice(&or_zeros::<GpuShape>(&packed.shapes)),
        ]
        .map(|bytes| self.buffer(bytes, BufferUsages::STORAGE));
        let constants = self.buffer(&padded(constants), BufferUsages::UNIFORM);

        let unpack = BindGroupEntries::sequential((deferred, &normal, &base_color, &specular, &coat));
        let shade = BindGroupEntries::with_indices((
            (0, &self.pipelines.table),
            (1, lights.as_entire_binding()),
            (2, vertices.as_entire_binding()),
            (3, depth),
            (4, &normal),
            (5, &base_color),
            (6, &specular),
            (7, &radiance),
            (8, &self.images.view),
            (9, shapes.as_entire_binding()),
            (11, &coat),
            (17, constants.as_entire_binding()),
            (18, &self.images.sampler),
        ));
        let group = |layout, entries: &[_]| {
            self.device.create_bind_group("arealight", &self.cache.get_bind_group_layout(layout), entries)
        };
        Some(ViewAreaLights {
            unpack: group(&self.pipelines.unpack_layout, &unpack),
            shade: group(&self.pipelines.shade_layout, &shade),
            add: group(&self.pipelines.add_layout, &BindGroupEntries::single(&radiance)),
            kernel,
            size: *size,
            viewport: view.viewport,
        })
    }

    /// An image that the passes of a camera hand on, of those that are kept from frame to frame.
    fn image(&mut self, format: TextureFormat, size: Extent3d) -> TextureView {
        let descriptor = TextureDescriptor {
            label: Some("arealight"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING,
            view_formats: &[],
        };
        self.textures.get(&self.device, descriptor).default_view
    }

    fn buffer(&self, contents: &[u8], usage: BufferUsages) -> Buffer {
        let label = Some("arealight");
        self.device.create_buffer_with_data(&BufferInitDescriptor { label, contents, usage })
    }
}

/// Records, or one of zeros: a binding is never empty.
fn or_zeros<T: bytemuck::Zeroable + Clone>(records: &[T]) -> Vec<T> {
    if records.is_empty() { vec![T::zeroed()] } else { records.to_vec() }
}

/// The constants as a uniform block, whose size is of whole rows.
fn padded(constants: &ShadeConstants) -> Vec<u8> {
    let mut bytes = bytemuck::bytes_of(constants).to_vec();
    bytes.resize(bytes.len().next_multiple_of(16), 0);
    bytes
}

/// Unpacks the G-buffer, shades it, and adds the radiance to the camera's picture. Nothing while a pipeline
/// is being compiled.
pub(crate) fn shade(
    view: ViewQuery<(&ViewAreaLights, &ViewTarget)>,
    pipelines: Res<Pipelines>,
    cache: Res<PipelineCache>,
    mut context: RenderContext,
) {
    let (bound, target) = view.into_inner();
    let UVec4 { x, y, z: width, w: height } = bound.viewport;
    let compute = |id| cache.get_compute_pipeline(id);
    let (Some(unpack), Some(kernel), Some(adder)) =
        (compute(pipelines.unpack), compute(bound.kernel), cache.get_render_pipeline(pipelines.add))
    else {
        return;
    };
    let label = Some("arealight");
    let descriptor = ComputePassDescriptor { label, timestamp_writes: None };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    let of_bevy = [bound.size.width, bound.size.height];
    for (pipeline, group, size) in [(unpack, &bound.unpack, of_bevy), (kernel, &bound.shade, [width, height])]
    {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &**group, &[]);
        pass.dispatch_workgroups(size[0].div_ceil(8), size[1].div_ceil(8), 1);
    }
    drop(pass);
    let mut pass = context.begin_tracked_render_pass(RenderPassDescriptor {
        label,
        color_attachments: &[Some(target.get_color_attachment())],
        ..default()
    });
    pass.set_scissor_rect(x, y, width, height);
    pass.set_render_pipeline(adder);
    pass.set_bind_group(0, &bound.add, &[]);
    pass.draw(0..3, 0..1);
}
