//! Shading points one by one under disks, spheres and tubes.

use crate::eval::surface_case;
use crate::{Engine, EngineError};
use arealight::gpu::GpuShape;
use arealight::{Effects, Quality, ShapeKind, ShapeLight, Surface};
use arealight_tool_kernels::gpu::GpuCase;
use arealight_tool_kernels::plan;
use arealight_vk::Resource;
use glam::{DVec3, Vec3};

/// A shading point with its one light, which is no polygon.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapePoint {
    /// The surface's lobes.
    pub surface: Surface,
    /// World position.
    pub position: DVec3,
    /// Normal, of any length.
    pub normal: DVec3,
    /// Direction to the viewer, of any length.
    pub view: DVec3,
    /// The light, in world positions.
    pub light: ShapeLight,
}

impl Engine {
    /// The radiance that each point sends to its viewer, W/(m² sr), by the GLSL library.
    ///
    /// # Errors
    /// [`EngineError`] names a light that cannot be shaded, or says why the device cannot do it.
    pub fn eval_shapes(&self, points: &[ShapePoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        // A pipeline for each kind: what a driver compiles, and what lights cost, is of one kind only
        let mut radiance = vec![Vec3::ZERO; points.len()];
        for kind in [ShapeKind::Ellipse, ShapeKind::Sphere, ShapeKind::Tube] {
            let indices: Vec<usize> =
                (0..points.len()).filter(|&index| points[index].light.shape.kind() == kind).collect();
            let subset: Vec<&ShapePoint> = indices.iter().map(|&index| &points[index]).collect();
            for (&index, answer) in indices.iter().zip(self.eval_shapes_as(kind, &subset, quality)?) {
                radiance[index] = answer;
            }
        }
        Ok(radiance)
    }

    /// As [`Engine::eval_shapes`], by one pipeline, which takes shapes of that kind or of [`ShapeKind::Any`].
    ///
    /// # Errors
    /// As [`Engine::eval_shapes`].
    pub fn eval_shapes_as(
        &self,
        kind: ShapeKind,
        points: &[&ShapePoint],
        quality: Quality,
    ) -> Result<Vec<Vec3>, EngineError> {
        // Pack each light relative to its own point, so that no precision is lost far from the origin
        let mut shapes: Vec<GpuShape> = Vec::with_capacity(points.len());
        let mut cases: Vec<GpuCase> = Vec::with_capacity(points.len());
        for (index, point) in points.iter().enumerate() {
            point.light.check_texture_layer(self.texture_layers())?;
            shapes.push(point.light.pack(point.position)?);
            cases.push(surface_case(&point.surface, point.normal, point.view, index as u32));
        }
        if cases.is_empty() {
            return Ok(Vec::new());
        }

        // Points under lights of one colour do not pay for images
        let images = points.iter().any(|point| point.light.texture.is_some());
        let mut effects = Effects::all() - Effects::BEYOND_QUADS;
        effects.set(Effects::TEXTURED_ELLIPSE, images);
        let dispatch = plan::eval_shapes(effects, quality, kind, 0);
        let shape_buffer = self.storage("shapes", &shapes)?;
        let shapes = Resource::buffer(shape_buffer.handle());
        self.dispatch_cases(dispatch.kernel, &dispatch.specialization, &cases, |cases, results| {
            vec![self.table(), shapes, cases, results, self.light_textures()]
        })
    }
}
