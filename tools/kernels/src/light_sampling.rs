//! What the Monte Carlo reference needs to draw points of lights: triangles and their areas.

use crate::gpu::{GpuLightSampling, GpuLightTriangle};
use arealight::{Light, LightShape, PackedLights};
use glam::DVec3;

/// The buffers of the reference kernel beside the lights themselves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightSampling {
    /// One record a light, in the order of the packed lights.
    pub lights: Vec<GpuLightSampling>,
    /// The triangles of all lights. A light without area has none, and is passed over.
    pub triangles: Vec<GpuLightTriangle>,
}

/// Vertex indices of triangles that cover a polygon, or each face of a mesh, once, three a triangle, in its
/// orientation. Empty for a degenerate polygon, and for disks, spheres and tubes.
pub fn triangles(light: &Light) -> Vec<u32> {
    let mut indices = Vec::new();
    let mut first = 0;
    for outline in light.shape.outlines() {
        indices.extend(triangles_of(outline).into_iter().map(|index| first + index));
        first += outline.len() as u32;
    }
    indices
}

/// Indices of an outline's vertices: triangles that cover it once, in its orientation; three a triangle.
/// Empty for one without area.
pub fn triangles_of(outline: &[DVec3]) -> Vec<u32> {
    let normal = LightShape::Polygon(outline.to_vec()).area_vector().normalize_or_zero();
    if normal == DVec3::ZERO {
        return Vec::new();
    }
    // Project onto the outline's plane, so that its front is counter-clockwise in two dimensions
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let anchor = outline[0];
    let flat = outline.iter().map(|v| {
        let offset = *v - anchor;
        [offset.dot(tangent), offset.dot(bitangent)]
    });
    let mut indices: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut(flat, &[], &mut indices);
    // Turn each triangle the way of the outline
    for triangle in indices.chunks_exact_mut(3) {
        let [a, b, c] = [0, 1, 2].map(|i| outline[triangle[i] as usize]);
        if (b - a).cross(c - a).dot(normal) < 0.0 {
            triangle.swap(1, 2);
        }
    }
    indices
}

impl LightSampling {
    /// Triangulates `lights`, which were packed as `packed`.
    pub fn new(lights: &[Light], packed: &PackedLights) -> Self {
        let mut sampling = Self::default();
        for (index, record) in packed.order.iter().zip(&packed.lights) {
            let Some(light) = lights.get(*index as usize) else { continue };
            let light = &*light.outlined();
            let first_triangle = sampling.triangles.len() as u32;
            let indices = triangles(light);
            let rows = packed.vertex_rows(record);
            let areas = indices.chunks_exact(3).map(|triangle| {
                let [a, b, c] = [0, 1, 2].map(|corner| light.shape.vertices()[triangle[corner] as usize]);
                (b - a).cross(c - a).length() * 0.5
            });
            let total: f64 = areas.clone().sum();
            let mut before = 0.0;
            for (triangle, area) in indices.chunks_exact(3).zip(areas) {
                before += area;
                sampling.triangles.push(GpuLightTriangle {
                    vertices: [0, 1, 2].map(|corner| rows[triangle[corner] as usize]),
                    cumulative: (before / total) as f32,
                });
            }
            // The faces of a mesh have normals of their own
            let normal = if light.shape.is_mesh() {
                DVec3::ZERO
            } else {
                light.shape.area_vector().normalize_or_zero()
            };
            sampling.lights.push(GpuLightSampling {
                normal: normal.as_vec3().to_array(),
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
    use glam::Vec3;

    /// A concave quad in the plane z = 2, counter-clockwise from above.
    fn arrow() -> Light {
        let outline = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let vertices = outline.map(|[x, y]| DVec3::new(x, y, 2.0)).to_vec();
        Light { name: "arrow".into(), shape: LightShape::Polygon(vertices), ..Light::default() }
    }

    #[test]
    fn triangles_cover_a_concave_polygon_once() {
        let light = arrow();
        let area: DVec3 = triangles(&light)
            .chunks_exact(3)
            .map(|t| {
                let [a, b, c] = [0, 1, 2].map(|i| light.shape.vertices()[t[i] as usize]);
                let area = (b - a).cross(c - a) * 0.5;
                assert!(area.z > 0.0, "every triangle faces the light's front");
                area
            })
            .sum();
        assert!((area - light.shape.area_vector()).length() < 1e-12);
    }

    #[test]
    fn degenerate_polygons_have_no_triangles() {
        let mut light = arrow();
        light.shape = LightShape::Polygon(vec![DVec3::ONE; 4]);
        assert!(triangles(&light).is_empty());
    }

    #[test]
    fn cumulative_areas_end_at_one_and_degenerate_lights_have_no_triangles() {
        let light = |vertices: Vec<DVec3>| Light {
            radiance: Vec3::ONE,
            shape: LightShape::Polygon(vertices),
            ..Light::default()
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
