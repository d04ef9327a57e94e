//! Shading points one by one, by the same GLSL as the shade pass.

use crate::{Engine, EngineError};
use arealight::gpu::{EvalConstants, GpuCase};
use arealight::kernels::EVAL;
use arealight::{Effects, PackedLights, PolygonLight, Quality, Surface, plan};
use arealight_vk::Resource;
use glam::{DVec3, Vec3};

/// A shading point with its one light.
#[derive(Debug, Clone, PartialEq)]
pub struct EvalPoint {
    /// The surface's lobes.
    pub surface: Surface,
    /// World position.
    pub position: DVec3,
    /// Normal, of any length.
    pub normal: DVec3,
    /// Direction to the viewer, of any length.
    pub view: DVec3,
    /// The light, in world positions.
    pub light: PolygonLight,
}

impl Engine {
    /// The radiance that each point sends to its viewer, W/(m² sr), as the shade pass computes it.
    ///
    /// # Errors
    /// [`EngineError`] names a light that cannot be shaded, or says why the device cannot do it.
    pub fn eval(&self, points: &[EvalPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        let mut radiance = vec![Vec3::ZERO; points.len()];
        // Points whose light needs no more than the convex quad get a pipeline that has no more
        let (quads, polygons): (Vec<usize>, Vec<usize>) =
            (0..points.len()).partition(|&index| points[index].light.is_convex_quad());
        for (indices, effects) in [(quads, Effects::all() - Effects::POLYGON), (polygons, Effects::all())] {
            if indices.is_empty() {
                continue;
            }
            let subset: Vec<&EvalPoint> = indices.iter().map(|&index| &points[index]).collect();
            let answers = self.eval_with(&subset, effects, quality)?;
            for (&index, answer) in indices.iter().zip(answers) {
                radiance[index] = answer;
            }
        }
        Ok(radiance)
    }

    /// As [`Engine::eval`], with a pipeline for one set of effects.
    fn eval_with(
        &self,
        points: &[&EvalPoint],
        effects: Effects,
        quality: Quality,
    ) -> Result<Vec<Vec3>, EngineError> {
        // Pack each light relative to its own point, so that no precision is lost far from the origin
        let mut lights = PackedLights::default();
        let mut cases = Vec::with_capacity(points.len());
        for &point in points {
            let packed = PackedLights::new(std::slice::from_ref(&point.light), point.position)?;
            cases.push(gpu_case(point, lights.lights.len() as u32));
            lights.append(packed)?;
        }

        // Each dispatch takes as many cases as the device has groups for
        let limit = self.host().properties().limits.max_compute_work_group_count[0];
        let chunk = (limit.min(1 << 16) * EVAL.local_size[0]) as usize;
        let light_buffer = self.storage("lights", &lights.lights)?;
        let vertex_buffer = self.storage("light vertices", &lights.vertices)?;
        let mut radiance = Vec::with_capacity(points.len());
        for cases in cases.chunks(chunk) {
            let case_buffer = self.storage("cases", cases)?;
            let results = self.storage("results", &vec![[0.0_f32; 4]; cases.len()])?;
            let resources = [
                self.table(),
                Resource::buffer(light_buffer.handle()),
                Resource::buffer(vertex_buffer.handle()),
                Resource::buffer(case_buffer.handle()),
                Resource::buffer(results.handle()),
                self.light_textures(),
            ];
            let case_count = cases.len() as u32;
            let dispatch = plan::eval(effects, quality, case_count);
            let pass = self.pass(dispatch.kernel, &dispatch.specialization, &resources)?;
            self.host().try_submit(|commands| {
                pass.record(commands, &EvalConstants { case_count }, [case_count, 1, 1])
            })?;
            let answers: Vec<[f32; 4]> = results.download()?;
            radiance.extend(answers.iter().map(|a| Vec3::new(a[0], a[1], a[2])));
        }
        Ok(radiance)
    }
}

/// A point as the eval kernel reads it, `light` being the index of its light.
pub fn gpu_case(point: &EvalPoint, light: u32) -> GpuCase {
    let surface = &point.surface;
    GpuCase {
        normal: rounded(point.normal),
        roughness: surface.alpha.sqrt() as f32,
        view: rounded(point.view),
        f90: surface.f90 as f32,
        diffuse_albedo: surface.diffuse_albedo.as_vec3().to_array(),
        light,
        f0: surface.f0.as_vec3().to_array(),
        reserved: 0,
    }
}

/// A direction of any length in float64, as a unit vector in float32, which has not the range for every length.
fn rounded(direction: DVec3) -> [f32; 3] {
    let largest = direction.abs().max_element();
    let scaled = if largest > 0.0 && largest.is_finite() { direction / largest } else { direction };
    scaled.normalize_or_zero().as_vec3().to_array()
}
