//! The G-buffer, drawn by wgpu alone.

use crate::{Gpu, Result};
use arealight_examples::picture::Picture;
use arealight_examples::scene::{Camera, Vertex};
use glam::{Mat4, Vec3, Vec4};
use std::mem::offset_of;
use wgpu::util::DeviceExt as _;

/// The formats of what the fragment shader writes: normal and roughness, base colour and metalness, radiance.
const COLORS: [wgpu::TextureFormat; 3] =
    [wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba32Float];
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The images, of one size, and the pipeline that draws them.
pub struct GBuffer {
    /// In the order of the fragment shader's outputs; the last is what the pass adds to.
    pub colors: [wgpu::Texture; 3],
    /// Reversed.
    pub depth: wgpu::Texture,
    /// In pixels.
    pub size: [u32; 2],
    pipeline: wgpu::RenderPipeline,
}

/// From positions relative to the camera to wgpu's clip space, in which y is up: the scene's camera is for
/// Vulkan's.
pub fn clip_from_view(camera: &Camera) -> Mat4 {
    Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * camera.clip_from_view
}

impl GBuffer {
    /// Makes images and pipeline.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let shaded = drawn | wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let [normal, base_color, radiance] = COLORS;
        let colors = [
            texture(gpu, size, normal, drawn),
            texture(gpu, size, base_color, drawn),
            texture(gpu, size, radiance, shaded),
        ];
        Self { colors, depth: texture(gpu, size, DEPTH, drawn), size, pipeline: pipeline(gpu) }
    }

    /// Records the drawing.
    pub fn record(&self, gpu: &Gpu, vertices: &[Vertex], camera: &Camera) -> wgpu::CommandBuffer {
        let filled = |usage, contents: &[u8]| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let mut constants = [0.0; 20];
        clip_from_view(camera).write_cols_to_slice(&mut constants);
        camera.position.write_to_slice(&mut constants[16..]);
        let constants = filled(wgpu::BufferUsages::UNIFORM, bytemuck::cast_slice(&constants));
        let buffer = filled(wgpu::BufferUsages::VERTEX, bytemuck::cast_slice(vertices));
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: constants.as_entire_binding() }],
        });

        let views = self.colors.each_ref().map(view);
        let attachments = views.each_ref().map(|view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        });
        let depth = view(&self.depth);
        let mut commands = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &attachments,
            // Far away is 0
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..vertices.len() as u32, 0..1);
        drop(pass);
        commands.finish()
    }

    /// The radiance, once all that was submitted is done.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn picture(&self, gpu: &Gpu) -> Result<Picture> {
        const ALIGNED: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;
        let [width, height] = self.size;
        let row = (width * size_of::<Vec4>() as u32).next_multiple_of(ALIGNED);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut commands = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        commands.copy_texture_to_buffer(
            self.colors[2].as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            extent(self.size),
        );
        gpu.queue.submit([commands.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver waits below
            let _ = sender.send(result);
        });
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv()??;
        let bytes = buffer.get_mapped_range(..)?;
        let rows = bytes.chunks_exact(row as usize);
        let pixels = rows
            .flat_map(|row| {
                bytemuck::pod_collect_to_vec::<u8, Vec4>(&row[..width as usize * size_of::<Vec4>()])
            })
            .collect();
        Ok(Picture { size: self.size, pixels })
    }
}

/// The view of a whole texture.
pub fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

fn texture(
    gpu: &Gpu,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(size),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::include_wgsl!("scene.wgsl"));
    let attribute = |shader_location, offset: usize, format| wgpu::VertexAttribute {
        format,
        offset: offset as u64,
        shader_location,
    };
    let (three, four) = (wgpu::VertexFormat::Float32x3, wgpu::VertexFormat::Float32x4);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &[
                    attribute(0, offset_of!(Vertex, position), three),
                    attribute(1, offset_of!(Vertex, normal), three),
                    attribute(2, offset_of!(Vertex, base_color), four),
                    attribute(3, offset_of!(Vertex, emission), four),
                ],
            })],
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &COLORS.map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    })
}
