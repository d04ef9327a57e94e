//! What the Monte Carlo reference needs to draw points of lights: triangles and their areas.

use crate::gpu::{GpuLightSampling, GpuLightTriangle};
use crate::{PackedLights, PolygonLight};

/// The buffers of the reference kernel beside the lights themselves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightSampling {
    /// One record a light, in the order of the packed lights.
    pub lights: Vec<GpuLightSampling>,
    /// The triangles of all lights. A light without area has none, and is passed over.
    pub triangles: Vec<GpuLightTriangle>,
}

impl LightSampling {
    /// Triangulates `lights`, which were packed as `packed`.
    pub fn new(lights: &[PolygonLight], packed: &PackedLights) -> Self {
        let mut sampling = Self::default();
        for (index, record) in packed.order.iter().zip(&packed.lights) {
            let Some(light) = lights.get(*index as usize) else { continue };
            let first_triangle = sampling.triangles.len() as u32;
            let indices = light.triangles();
            let areas = indices.chunks_exact(3).map(|triangle| {
                let [a, b, c] = [0, 1, 2].map(|corner| light.vertices[triangle[corner] as usize]);
                (b - a).cross(c - a).length() * 0.5
            });
            let total: f64 = areas.clone().sum();
            let mut before = 0.0;
            for (triangle, area) in indices.chunks_exact(3).zip(areas) {
                before += area;
                sampling.triangles.push(GpuLightTriangle {
                    vertices: [0, 1, 2].map(|corner| record.first_vertex + triangle[corner]),
                    cumulative: (before / total) as f32,
                });
            }
            sampling.lights.push(GpuLightSampling {
                normal: light.area_vector().normalize_or_zero().as_vec3().to_array(),
                area: total as f32,
                first_triangle,
                triangle_count: sampling.triangles.len() as u32 - first_triangle,
                reserved: [0; 2],
            });
        }
        sampling
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    #[test]
    fn cumulative_areas_end_at_one_and_degenerate_lights_have_no_triangles() {
        let light = |vertices: Vec<DVec3>| PolygonLight {
            name: "light".into(),
            vertices,
            radiance: Vec3::ONE,
            ..PolygonLight::default()
        };
        let square = [DVec3::ZERO, DVec3::X, DVec3::ONE - DVec3::Z, DVec3::Y];
        let lights = [light(vec![DVec3::ONE; 3]), light(square.to_vec())];
        let packed = PackedLights::new(&lights, DVec3::ZERO).unwrap();
        let sampling = LightSampling::new(&lights, &packed);
        assert_eq!(sampling.lights[0].triangle_count, 0);
        assert_eq!(sampling.lights[1].triangle_count, 2);
        assert_eq!(sampling.lights[1].area, 1.0);
        assert_eq!(sampling.lights[1].normal, [0.0, 0.0, 1.0]);
        assert_eq!(sampling.triangles[1].cumulative, 1.0);
        assert!(sampling.triangles.iter().all(|t| t.vertices.iter().all(|&v| (3..7).contains(&v))));
    }
}
