//! A frame on the device: a G-buffer under lights, shaded by any method.

use super::methods::{Method, SHADE_YARDSTICK};
use super::points::Point;
use crate::school::YardstickTable;
use crate::textures::{is_software, timed};
use arealight::gpu::ShadeConstants;
use arealight::kernels::{Binding, Kernel, SHADE};
use arealight::plan::{ShadeOptions, shade_specialization};
use arealight::{Light, LightSummary, PackedLights, Plane};
use arealight_engine::host::{Buffer, Usage};
use arealight_engine::{BoundSet, Engine, EngineError, GBuffer, SharedPass, UploadedTable, texel_of};
use arealight_tool_kernels::LightSampling;
use arealight_tool_kernels::gpu::ReferenceConstants;
use arealight_tool_kernels::kernels::REFERENCE;
use arealight_vk::{Resource, TableFormat};
use glam::{DVec3, Mat4, Vec3};
use half::f16;

/// A G-buffer of the points: a square patch of `side` pixels each, `columns` of them side by side.
pub fn g_buffer(
    engine: &Engine,
    points: &[Point],
    columns: usize,
    rows: usize,
    side: usize,
) -> Result<GBuffer, EngineError> {
    let (width, height) = (columns * side, rows * side);
    let g_buffer = GBuffer::new(engine, [width as u32, height as u32])?;
    let texels = |texel: &dyn Fn(&Point, [f32; 2]) -> [f32; 4]| -> Vec<[f32; 4]> {
        let pixel = |i: usize| {
            let (x, y) = (i % width, i / width);
            let place = [x % side, y % side].map(|at| (at as f32 + 0.5) / side as f32 - 0.5);
            texel(&points[(y / side * columns + x / side) % points.len()], place)
        };
        (0..width * height).map(pixel).collect()
    };
    for plane in Plane::ALL {
        let image = &g_buffer[plane];
        let of = texels(&|point, [x, y]| {
            if plane != Plane::Position {
                return texel_of(&point.material, point.normal, plane);
            }
            // A patch is a hundredth as large as it is far from the camera
            let (u, v) = point.normal.any_orthonormal_pair();
            let place = point.position + (u * x + v * y) * (0.01 * point.position.length());
            place.extend(1.0).to_array()
        });
        match plane {
            Plane::Stencil => image.upload(&vec![0_u32; width * height], Usage::COMPUTE_READ)?,
            Plane::Motion => image.upload(&of[..1], Usage::COMPUTE_READ)?,
            Plane::BaseColor => {
                let half: Vec<_> = of.iter().map(|texel| texel.map(f16::from_f32)).collect();
                image.upload(&half, Usage::COMPUTE_READ)?;
            }
            _ => image.upload(&of, Usage::COMPUTE_READ)?,
        }
    }
    // Nor is anything let through: Monte Carlo reads it of every surface
    g_buffer.transmitted.upload(&vec![[0_u16; 4]; width * height], Usage::COMPUTE_READ)?;
    Ok(g_buffer)
}

/// A G-buffer under lights.
pub struct Frame<'a> {
    engine: &'a Engine,
    g_buffer: &'a GBuffer,
    camera: Vec3,
    summary: LightSummary,
    lights: Buffer,
    vertices: Buffer,
    sampling: Buffer,
    triangles: Buffer,
    /// The table of yardsticks that don't have the engine's.
    published: UploadedTable,
}

/// A method ready to run on a frame.
pub struct Ready {
    pass: SharedPass,
    set: BoundSet,
    method: Method,
}

impl<'a> Frame<'a> {
    /// `origin` is what positions of the G-buffer are relative to, `camera` where the camera is from there.
    pub fn new(
        engine: &'a Engine,
        g_buffer: &'a GBuffer,
        lights: &[Light],
        origin: DVec3,
        camera: Vec3,
    ) -> Result<Self, EngineError> {
        let packed = PackedLights::new(lights, origin)?;
        engine.check_layers(lights)?;
        let sampling = LightSampling::new(lights, &packed);
        let host = engine.host();
        let frame = Self {
            engine,
            g_buffer,
            camera,
            summary: packed.summary(),
            lights: host.storage_buffer("lights", &packed.lights)?,
            vertices: host.storage_buffer("light vertices", &packed.vertices)?,
            sampling: host.storage_buffer("light sampling", &sampling.lights)?,
            triangles: host.storage_buffer("light triangles", &sampling.triangles)?,
            published: engine.upload_table(&crate::published::table(), TableFormat::default())?,
        };
        frame.clear()?;
        Ok(frame)
    }

    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        let [width, height] = self.size();
        (width * height) as usize
    }

    fn size(&self) -> [u32; 2] {
        self.g_buffer.radiance.extent()
    }

    /// Makes all radiance zero: Monte Carlo's samples are added to it.
    pub fn clear(&self) -> Result<(), EngineError> {
        Ok(self.g_buffer.radiance.upload(&vec![[0.0_f32; 4]; self.pixels()], Usage::COMPUTE_WRITE)?)
    }

    /// The kernel of a method's pipeline, and what it is specialised with.
    pub fn pipeline(&self, method: Method) -> (&'static Kernel, Vec<(u32, u32)>) {
        match method {
            Method::Level { effects, quality } => {
                let options = ShadeOptions { surfaces: effects, quality, ..ShadeOptions::default() };
                (&SHADE, shade_specialization(options, LightSummary { effects, ..self.summary }))
            }
            Method::Yardstick { effects, school, table: _ } => {
                (&SHADE_YARDSTICK, vec![(0, effects.bits()), (1, school as u32)])
            }
            Method::Samples { .. } => (&REFERENCE, vec![]),
        }
    }

    /// Makes a method's pipeline.
    pub fn ready(&self, method: Method) -> Result<Ready, EngineError> {
        let (kernel, specialization) = self.pipeline(method);
        let resources: Vec<Resource> =
            kernel.bindings().iter().map(|binding| self.resource(binding, method)).collect();
        let pass = self.engine.passes().pass(kernel, &specialization)?;
        // SAFETY: The frame and the engine outlive what is made of them here, and submissions are waited for.
        let set = unsafe { self.engine.passes().bind(&pass, &resources) }?;
        Ok(Ready { pass, set, method })
    }

    /// What a kernel's binding is for. Disks, spheres and tubes, of which there are none, have any buffer.
    fn resource(&self, binding: &Binding, method: Method) -> Resource {
        let has_published =
            matches!(method, Method::Yardstick { table: YardstickTable::PublishedQuality, .. });
        let buffer = |buffer: &Buffer| Resource::buffer(buffer.handle());
        if let Some(image) = self.g_buffer.bound_at(binding) {
            return image;
        }
        match binding.name {
            "table_image" if has_published => self.published.resource(),
            "table_image" => self.engine.table(),
            "light_textures" => self.engine.light_textures(),
            "light_vertices" => buffer(&self.vertices),
            "light_sampling" => buffer(&self.sampling),
            "light_triangles" => buffer(&self.triangles),
            _ => buffer(&self.lights),
        }
    }

    /// Runs a method with all lights, or with the first of them. Seconds of the device; see
    /// [`device_seconds`].
    pub fn run(&self, ready: &Ready, lights: u32, seed: u32) -> Result<f64, EngineError> {
        let light_count = lights.min(self.summary.light_count);
        let [width, height] = self.size();
        let items = [width, height, 1];
        let Method::Samples { count } = ready.method else {
            let constants = ShadeConstants {
                position_from_clip: Mat4::IDENTITY.to_cols_array_2d(),
                camera: self.camera.to_array(),
                light_count,
                shape_count: 0,
                quad_count: self.summary.quad_count.min(light_count),
                size: self.size(),
                ..ShadeConstants::default()
            };
            return device_seconds(self.engine, |commands| {
                // SAFETY: `commands` is being recorded, outside a render pass.
                unsafe { ready.set.record(&ready.pass, commands, &constants, items) }
            });
        };
        // A dispatch of Monte Carlo is kept far below what a driver bears
        let (mut seconds, mut first_sample) = (0.0, 0);
        while first_sample < count {
            let most = (1_u64 << 24) / (self.pixels() as u64 * u64::from(light_count)).max(1);
            let sample_count = (most.clamp(1, 1024) as u32).min(count - first_sample);
            let constants = ReferenceConstants {
                camera: self.camera.to_array(),
                light_count,
                first_sample,
                sample_count,
                weight: (f64::from(sample_count) / f64::from(count)) as f32,
                seed,
                shape_count: 0,
            };
            seconds += device_seconds(self.engine, |commands| {
                self.g_buffer.radiance.transition(commands, Usage::COMPUTE_WRITE, Usage::COMPUTE_WRITE);
                // SAFETY: As above.
                unsafe { ready.set.record(&ready.pass, commands, &constants, items) }
            })?;
            first_sample += sample_count;
        }
        Ok(seconds)
    }

    /// What a method makes of every pixel, row after row.
    pub fn shaded(&self, ready: &Ready, seed: u32) -> Result<Vec<DVec3>, EngineError> {
        self.clear()?;
        self.run(ready, u32::MAX, seed)?;
        let texels: Vec<[f32; 4]> = self.g_buffer.radiance.download(Usage::COMPUTE_WRITE)?;
        Ok(texels.into_iter().map(|[r, g, b, _]| DVec3::new(r.into(), g.into(), b.into())).collect())
    }
}

/// Seconds that the device takes. Of a GPU what its timestamps say; of a software device the processor time
/// of its threads over their number, which is what the clock would say if nobody else ran.
fn device_seconds(
    engine: &Engine,
    record: impl FnOnce(ash::vk::CommandBuffer) -> Result<(), EngineError>,
) -> Result<f64, EngineError> {
    let seconds = timed(engine.host(), record)?;
    Ok(if is_software(engine.host()) { seconds / processors() } else { seconds })
}

/// The processors that a software device uses.
pub fn processors() -> f64 {
    std::thread::available_parallelism().map_or(1.0, |count| count.get() as f64)
}
