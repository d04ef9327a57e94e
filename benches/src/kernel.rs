//! The kernel `form_factor`: hard cases go in, the bits of their form factors come out.

use crate::BenchError;
use crate::method::Method;
use arealight::kernels::{Access, Binding, BindingKind, Kernel};
use arealight_engine::Kept;
use arealight_host::Host;
use arealight_oracle::hard::HardCase;
use arealight_vk::{ComputePass, Context, HostDevice, Resource};
use ash::vk;
use bytemuck::{Pod, Zeroable};

/// A polygon's record: anchor, and where its offsets are.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuHardPolygon {
    /// What the offsets start from.
    pub anchor: [f32; 3],
    /// Place of the first offset in the buffer of offsets.
    pub first_offset: u32,
    /// How many there are, at least 3.
    pub offset_count: u32,
    /// 0.
    pub reserved: [u32; 3],
}

/// Push constants.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct FormFactorConstants {
    polygon_count: u32,
}

const fn storage(name: &'static str, access: Access, content: &'static str) -> Binding {
    Binding { name, kind: BindingKind::StorageBuffer, access, content }
}

/// The id of the specialisation constant `METHOD`.
pub const METHOD: u32 = 0;

/// Form factors of a list of polygons by one method.
pub static FORM_FACTOR: Kernel = Kernel {
    name: "form_factor",
    spirv: include_bytes!("../spirv/form_factor.spv"),
    local_size: [64, 1, 1],
    push_constant_size: size_of::<FormFactorConstants>() as u32,
    bindings: &[
        storage("polygons", Access::Read, "GpuHardPolygon[]"),
        storage("offsets", Access::Read, "vec4[]: offset from the polygon's anchor, 0"),
        storage("results", Access::Write, "float[]: one form factor a polygon"),
    ],
    constants: &[METHOD],
};

/// The kernel on a device, once for each method.
pub struct FormFactorKernel {
    passes: Vec<Kept<ComputePass>>,
    host: Host,
}

impl FormFactorKernel {
    /// Makes the pipelines of `methods`.
    ///
    /// # Errors
    /// [`BenchError`] where the device is too old or out of memory.
    pub fn new(host: &Host, methods: &[&Method]) -> Result<Self, BenchError> {
        let handles = HostDevice {
            instance: host.instance(),
            physical_device: host.physical_device(),
            device: host.device(),
            pipeline_cache: vk::PipelineCache::null(),
        };
        // SAFETY: The handles belong together, and the passes, which go first, keep the host alive.
        let context = unsafe { Context::new(&handles) }?;
        let pass = |method: &&Method| {
            // SAFETY: Submissions are waited for, so that no use is pending when the pass is dropped; where one
            // timed out, it is leaked.
            let pass = unsafe { ComputePass::new(&context, &FORM_FACTOR, &[(METHOD, method.id)]) }?;
            Ok(Kept::new(host, pass))
        };
        let passes = methods.iter().map(pass).collect::<Result<_, BenchError>>()?;
        Ok(Self { passes, host: host.clone() })
    }

    /// The bits of each case's form factor, for each method in turn. Bits, since a conversion may hide a NaN.
    ///
    /// # Errors
    /// [`BenchError`] where the device fails or is out of memory.
    pub fn run(&self, cases: &[HardCase]) -> Result<Vec<Vec<u32>>, BenchError> {
        let (polygons, offsets) = pack(cases);
        let polygons = self.host.storage_buffer("polygons", &polygons)?;
        let offsets = self.host.storage_buffer("offsets", &offsets)?;
        let constants = FormFactorConstants { polygon_count: cases.len() as u32 };
        let run = |pass: &Kept<ComputePass>| {
            // What is not written stays NaN
            let results = self.host.storage_buffer("results", &vec![u32::MAX; cases.len()])?;
            let resources = [&polygons, &offsets, &results].map(|buffer| Resource::buffer(buffer.handle()));
            let pool = self.host.descriptor_pool(1, &pass.pool_sizes(1))?;
            // SAFETY: The layout is the pass's, and alive.
            let set = unsafe { pool.allocate(pass.set_layout()) }?;
            // SAFETY: The set is new; the buffers live until the submission below was waited for.
            unsafe { pass.write_set(set, &resources) }?;
            let groups = FORM_FACTOR.groups_for([constants.polygon_count, 1, 1]);
            self.host.try_submit(|commands| {
                // SAFETY: `commands` is being recorded, outside a render pass; the set was written.
                let recorded = unsafe { pass.record(commands, set, bytemuck::bytes_of(&constants), groups) };
                recorded.map_err(BenchError::from)
            })?;
            Ok(results.download()?)
        };
        self.passes.iter().map(run).collect()
    }
}

/// The cases as the kernel reads them.
fn pack(cases: &[HardCase]) -> (Vec<GpuHardPolygon>, Vec<[f32; 4]>) {
    let mut offsets = Vec::new();
    let polygon = |case: &HardCase| {
        let first_offset = offsets.len() as u32;
        offsets.extend(case.offsets.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]));
        let offset_count = case.offsets.len() as u32;
        GpuHardPolygon { anchor: case.anchor, first_offset, offset_count, reserved: [0; 3] }
    };
    let polygons = cases.iter().map(polygon).collect();
    (polygons, offsets)
}
