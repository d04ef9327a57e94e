//! The eval kernel with any set of effects, on buffers that a test may change before they go to the device.

use crate::{Level, TestEngine};
use arealight::PackedLights;
use arealight::gpu::GpuLight;
use arealight::{Effects, Quality};
use arealight_cases::hard::HardCase;
use arealight_engine::{EvalPoint, gpu_case};
use arealight_tool_kernels::gpu::{EvalConstants, GpuCase};
use arealight_tool_kernels::kernels::EVAL;
use arealight_tool_kernels::plan;
use arealight_vk::Resource;
use glam::DVec3;

/// What the eval kernel reads: a case and a light for each shading point, the point being the lights' origin.
#[derive(Debug, Clone, Default)]
pub struct Cases {
    /// One light a case.
    pub lights: Vec<GpuLight>,
    /// The lights' vertices, relative to their centers.
    pub vertices: Vec<[f32; 4]>,
    /// The surfaces.
    pub cases: Vec<GpuCase>,
}

impl Cases {
    /// Packs shading points as the engine does.
    pub fn new(points: &[EvalPoint]) -> Self {
        let mut lights = PackedLights::default();
        let mut cases = Vec::with_capacity(points.len());
        for point in points {
            let packed = PackedLights::new(std::slice::from_ref(&point.light), point.position)
                .expect("the lights of tests can be shaded");
            cases.push(gpu_case(point, lights.lights.len() as u32));
            lights.append(packed).expect("tests have few lights");
        }
        Self { lights: lights.lights, vertices: lights.vertices, cases }
    }

    /// The vertices of a case's light as they were packed.
    pub fn outline(&self, case: usize) -> &[[f32; 4]] {
        let light = &self.lights[self.cases[case].light as usize];
        let first = light.first_vertex as usize;
        &self.vertices[first..first + light.vertex_count as usize]
    }

    /// A case's light as seen from the point, to the bit.
    pub fn polygon(&self, case: usize) -> HardCase {
        let anchor = self.lights[self.cases[case].light as usize].center;
        let offsets = self.outline(case).iter().map(|v| [v[0], v[1], v[2]]).collect();
        HardCase { anchor, offsets, flat: true }
    }

    /// The vertices of a case's light in float64.
    pub fn relative_vertices(&self, case: usize) -> Vec<DVec3> {
        let polygon = self.polygon(case);
        let anchor = DVec3::from_array(polygon.anchor.map(f64::from));
        polygon.offsets_exactly().into_iter().map(|o| anchor + DVec3::from_array(o)).collect()
    }
}

impl TestEngine {
    /// The bits of each case's answer: radiance in three channels, and zero.
    pub fn run(&self, given: &Cases, effects: Effects, quality: Quality) -> Vec<[u32; 4]> {
        let host = self.host();
        let dispatch = plan::eval(effects, quality, given.cases.len() as u32);
        let lights = host.storage_buffer("lights", &given.lights).expect("memory");
        let vertices = host.storage_buffer("vertices", &given.vertices).expect("memory");
        let cases = host.storage_buffer("cases", &given.cases).expect("memory");
        // What is not written stays NaN
        let unwritten = vec![[u32::MAX; 4]; given.cases.len()];
        let results = host.storage_buffer("results", &unwritten).expect("memory");
        let resources = [
            self.table(),
            Resource::buffer(lights.handle()),
            Resource::buffer(vertices.handle()),
            Resource::buffer(cases.handle()),
            Resource::buffer(results.handle()),
            self.light_textures(),
        ];
        let constants = EvalConstants { case_count: given.cases.len() as u32 };
        let pass = self.passes().pass(&EVAL, &dispatch.specialization).expect("a pipeline");
        // SAFETY: Host::submit waits, and everything here is dropped before the engine.
        unsafe {
            let pool = host.descriptor_pool(1, &pass.pool_sizes(1)).expect("a pool");
            let set = pool.allocate(pass.set_layout()).expect("a set");
            pass.write_set(set, &resources).expect("the resources fit");
            let bytes = bytemuck::bytes_of(&constants);
            host.submit(|commands| pass.record(commands, set, bytes, dispatch.groups).expect("it records"))
                .expect("it runs");
        }
        results.download().expect("the results come back")
    }

    /// Each case's first channel by a level, for a pass that has these lobes: a form factor where radiance
    /// and albedo are one.
    pub fn factors(&self, given: &Cases, lobes: Effects, level: Level) -> Vec<f64> {
        // Bits of NaN, infinity and negative numbers are all larger
        let largest = (1.0_f32 + 1e-6).to_bits();
        let answers = self.run(given, level.effects(lobes), level.quality);
        let factor = |(index, answer): (usize, &[u32; 4])| {
            assert!(answer[0] <= largest, "{level}, case {index}: {}", f32::from_bits(answer[0]));
            f32::from_bits(answer[0]).into()
        };
        answers.iter().enumerate().map(factor).collect()
    }
}
