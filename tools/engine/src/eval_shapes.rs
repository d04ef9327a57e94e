//! Shading points one by one under disks, spheres and tubes.

use crate::eval::{EvalPoint, LAYERS, POLYGONAL, answers_by, layer_effects, surface_case};
use crate::{Engine, EngineError};
use arealight::gpu::GpuShape;
use arealight::{Effects, PackedLights, Quality};
use arealight_tool_kernels::gpu::GpuCase;
use arealight_tool_kernels::plan;
use arealight_vk::Resource;
use glam::Vec3;

/// The kinds of lights that are no polygons, with the effect of each.
pub(crate) const KINDS: [(u32, Effects); 3] = [
    (GpuShape::DISK, Effects::ELLIPSE),
    (GpuShape::SPHERE, Effects::SPHERE),
    (GpuShape::TUBE, Effects::TUBE),
];

impl Engine {
    /// As [`Engine::eval`], by pipelines that take shapes of that kind or of [`GpuShape::ANY`].
    pub fn eval_shapes_as(
        &self,
        kind: u32,
        points: &[&EvalPoint],
        quality: Quality,
    ) -> Result<Vec<Vec3>, EngineError> {
        answers_by(
            points,
            |point| layer_effects(&point.surface),
            |layers, subset| self.eval_shapes_with(layers, kind, subset, quality),
        )
    }

    /// The radiance of points whose surfaces have these layers.
    pub(crate) fn eval_shapes_with(
        &self,
        layers: Effects,
        kind: u32,
        points: &[&EvalPoint],
        quality: Quality,
    ) -> Result<Vec<Vec3>, EngineError> {
        // Pack each light relative to its own point, so that no precision is lost far from the origin
        let mut shapes: Vec<GpuShape> = Vec::with_capacity(points.len());
        let mut cases: Vec<GpuCase> = Vec::with_capacity(points.len());
        for (index, point) in points.iter().enumerate() {
            let light = std::slice::from_ref(&point.light);
            self.check_layers(light)?;
            shapes.extend(PackedLights::new(light, point.position)?.shapes);
            cases.push(surface_case(&point.surface, point.normal, point.view, index as u32));
        }
        // Points under lights of one colour do not pay for images, nor those without layers for layers
        let textured = points.iter().any(|point| point.light.texture.is_some());
        let mut effects = (Effects::all() - POLYGONAL - LAYERS) | layers;
        effects.set(Effects::TEXTURED_ELLIPSE, textured);
        let dispatch = plan::eval_shapes(effects, quality, kind, 0);
        let shape_buffer = self.storage("shapes", &shapes)?;
        let shapes = Resource::buffer(shape_buffer.handle());
        self.dispatch_cases(dispatch.kernel, &dispatch.specialization, &cases, |cases, results| {
            vec![self.table(), shapes, cases, results, self.light_textures()]
        })
    }
}
