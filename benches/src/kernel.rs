//! The kernel `form_factor`: hard cases go in, the bits of their form factors come out.

use crate::method::Method;
use arealight::kernels::Kernel;
use arealight_cases::hard::HardCase;
use arealight_engine::host::Host;
use arealight_engine::{EngineError, Passes};
use arealight_vk::Resource;
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

/// The id of the specialisation constant `METHOD`.
pub const METHOD: u32 = 0;

/// Form factors of a list of polygons by one method.
pub static FORM_FACTOR: Kernel = Kernel::new("form_factor", include_bytes!("../spirv/form_factor.spv"));

/// The kernel on a device, once for each method.
pub struct FormFactorKernel {
    methods: Vec<u32>,
    passes: Passes,
}

impl FormFactorKernel {
    /// Makes the pipelines of `methods`.
    pub fn new(host: &Host, methods: &[&Method]) -> Result<Self, EngineError> {
        let passes = Passes::new(host.clone())?;
        let methods: Vec<u32> = methods.iter().map(|method| method.id).collect();
        for method in &methods {
            passes.pass(&FORM_FACTOR, &[(METHOD, *method)])?;
        }
        Ok(Self { methods, passes })
    }

    /// The bits of each case's form factor, for each method in turn. Bits, since a conversion may hide a NaN.
    pub fn run(&self, cases: &[HardCase]) -> Result<Vec<Vec<u32>>, EngineError> {
        let (polygons, offsets) = pack(cases);
        let host = self.passes.host();
        let inputs = [host.storage_buffer("polygons", &polygons)?, host.storage_buffer("offsets", &offsets)?];
        let resources = [&inputs[0], &inputs[1]].map(|buffer| Resource::buffer(buffer.handle()));
        let constants = FormFactorConstants { polygon_count: cases.len() as u32 };
        let run = |method: &u32| {
            let kernel = (&FORM_FACTOR, &[(METHOD, *method)][..]);
            // SAFETY: The inputs live until this returns.
            let list = unsafe { self.passes.over_list(kernel, &resources, constants, cases.len()) }?;
            list.run()?;
            list.results()
        };
        self.methods.iter().map(run).collect()
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
