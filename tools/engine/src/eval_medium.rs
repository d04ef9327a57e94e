//! Points in a medium one by one.

use crate::eval::{POLYGONAL, answers_by, rounded};
use crate::{Engine, EngineError};
use arealight::{Effects, Light, PackedLights, Quality};
use arealight_tool_kernels::gpu::GpuMediumCase;
use arealight_tool_kernels::plan;
use arealight_vk::Resource;
use glam::{DVec3, Vec3};

/// A point in a medium of scattering coefficient 1, with its one light.
#[derive(Debug, Clone, PartialEq)]
pub struct MediumPoint {
    /// Henyey and Greenstein's g.
    pub anisotropy: f64,
    /// World position.
    pub position: DVec3,
    /// Direction to the viewer, of any length.
    pub view: DVec3,
    /// The light, in world positions.
    pub light: Light,
}

/// What a pipeline has of the lights' effects.
const OF_LIGHTS: Effects = POLYGONAL
    .union(Effects::AZIMUTH)
    .union(Effects::ELLIPSE)
    .union(Effects::SPHERE)
    .union(Effects::TUBE)
    .union(Effects::TEXTURED_ELLIPSE)
    .union(Effects::TWO_SIDED);

impl Engine {
    /// The radiance that each point scatters towards its viewer, W/(m² sr) per unit of length, by the GLSL
    /// library.
    ///
    /// # Errors
    /// [`EngineError`] names a light that cannot be shaded, or says why the device cannot do it.
    pub fn eval_medium(&self, points: &[MediumPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        let needed = |point: &MediumPoint| point.light.effects() & OF_LIGHTS;
        answers_by(&points.iter().collect::<Vec<_>>(), needed, |needed, subset| {
            self.eval_medium_as(needed, subset, quality)
        })
    }

    fn eval_medium_as(
        &self,
        effects: Effects,
        points: &[&MediumPoint],
        quality: Quality,
    ) -> Result<Vec<Vec3>, EngineError> {
        // Pack each light relative to its own point, so that no precision is lost far from the origin
        let mut lights = PackedLights::default();
        let mut cases = Vec::with_capacity(points.len());
        for point in points {
            let light = std::slice::from_ref(&point.light);
            self.check_layers(light)?;
            lights.append(PackedLights::new(light, point.position)?)?;
            cases.push(GpuMediumCase { view: rounded(point.view), anisotropy: point.anisotropy as f32 });
        }
        let dispatch = plan::eval_medium(effects, quality, 0);
        let buffers = [
            self.storage("lights", &lights.lights)?,
            self.storage("light vertices", &lights.vertices)?,
            self.storage("shapes", &lights.shapes)?,
        ];
        let [lights, vertices, shapes] = buffers.each_ref().map(|buffer| Resource::buffer(buffer.handle()));
        self.dispatch_cases(dispatch.kernel, &dispatch.specialization, &cases, |cases, results| {
            vec![lights, vertices, shapes, cases, results, self.light_textures()]
        })
    }
}
