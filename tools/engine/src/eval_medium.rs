//! Points in a medium one by one.

use crate::eval::{POLYGONAL, rounded};
use crate::{Engine, EngineError};
use arealight::gpu::GpuShape;
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

impl AsRef<Light> for MediumPoint {
    fn as_ref(&self) -> &Light {
        &self.light
    }
}

impl AsMut<Light> for MediumPoint {
    fn as_mut(&mut self) -> &mut Light {
        &mut self.light
    }
}

impl MediumPoint {
    /// What the kernel's constants say of the light: its kind, and its effects among polygons' and images'.
    fn kind(&self) -> (u32, Effects) {
        let effects = self.light.effects();
        let kind = [
            (Effects::ELLIPSE, GpuShape::DISK),
            (Effects::SPHERE, GpuShape::SPHERE),
            (Effects::TUBE, GpuShape::TUBE),
        ];
        let kind = kind.into_iter().find(|(effect, _)| effects.contains(*effect));
        let of_lights = Effects::ELLIPSE | Effects::SPHERE | Effects::TUBE | Effects::TEXTURED_ELLIPSE;
        let counted = effects & (POLYGONAL | of_lights | Effects::TWO_SIDED);
        (kind.map_or(plan::POLYGONAL, |(_, kind)| kind), counted)
    }
}

impl Engine {
    /// The radiance that each point scatters towards its viewer, W/(m² sr) per unit of length, by the GLSL
    /// library.
    ///
    /// # Errors
    /// [`EngineError`] names a light that cannot be shaded, or says why the device cannot do it.
    pub fn eval_medium(&self, points: &[MediumPoint], quality: Quality) -> Result<Vec<Vec3>, EngineError> {
        // A pipeline for each kind, as surfaces have it
        let mut kinds: Vec<(u32, Effects)> = points.iter().map(MediumPoint::kind).collect();
        kinds.sort_by_key(|(kind, effects)| (*kind, effects.bits()));
        kinds.dedup();
        let mut radiance = vec![Vec3::ZERO; points.len()];
        for (kind, effects) in kinds {
            let of_kind = |index: &usize| points[*index].kind() == (kind, effects);
            let indices: Vec<usize> = (0..points.len()).filter(of_kind).collect();
            let subset: Vec<&MediumPoint> = indices.iter().map(|&index| &points[index]).collect();
            for (&index, answer) in indices.iter().zip(self.eval_medium_as(kind, effects, &subset, quality)?)
            {
                radiance[index] = answer;
            }
        }
        Ok(radiance)
    }

    fn eval_medium_as(
        &self,
        kind: u32,
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
        let dispatch = plan::eval_medium(effects, quality, kind, 0);
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
