//! A float64 twin of the visibility kernel's traversal of the hierarchy of boxes around triangles.

use arealight::gpu::GpuBvhNode;
use arealight_tool_kernels::gpu::{GpuMaterial, GpuTriangle};
use glam::{DVec3, Vec3};

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub distance: f64,
    /// Index of the triangle, in the order of the leaves.
    pub triangle: usize,
    /// Weights of the triangle's second and third vertex.
    pub barycentric: [f64; 2],
}

/// The closest hit along a ray: what the visibility kernel finds, in float64 and without alpha masks. Back
/// faces are passed through unless their material is double-sided. Positions are relative to the buffers'
/// origin.
pub fn closest_hit(
    nodes: &[GpuBvhNode],
    triangles: &[GpuTriangle],
    materials: &[GpuMaterial],
    origin: DVec3,
    direction: DVec3,
) -> Option<Hit> {
    let inverse = DVec3::ONE / direction;
    let mut closest: Option<Hit> = None;
    let mut index = 0;
    while let Some(node) = nodes.get(index) {
        let limit = closest.map_or(f64::INFINITY, |hit| hit.distance);
        if !enters(node, origin, inverse, limit) {
            index = node.end(index);
            continue;
        }
        index += 1;
        let leaf = triangles.iter().enumerate().skip(node.first as usize).take(node.count as usize);
        for (triangle, shape) in leaf {
            let double_sided = materials
                .get(shape.material as usize)
                .is_some_and(|m| m.flags & GpuMaterial::DOUBLE_SIDED != 0);
            let hit = intersect(shape, double_sided, origin, direction);
            if let Some((distance, barycentric)) = hit
                && distance < closest.map_or(f64::INFINITY, |hit| hit.distance)
            {
                closest = Some(Hit { distance, triangle, barycentric });
            }
        }
    }
    closest
}

/// Whether a ray meets a node's box before `limit`.
fn enters(node: &GpuBvhNode, origin: DVec3, inverse: DVec3, limit: f64) -> bool {
    let (mut near, mut far) = (0.0_f64, limit);
    for axis in 0..3 {
        // 0 × infinity on a face of the box is NaN, which min and max pass over
        let a = (f64::from(node.min[axis]) - origin[axis]) * inverse[axis];
        let b = (f64::from(node.max[axis]) - origin[axis]) * inverse[axis];
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    near <= far
}

/// Distance and weights where a ray meets a triangle's front, or either side of a double-sided one.
pub fn intersect(
    triangle: &GpuTriangle,
    double_sided: bool,
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, [f64; 2])> {
    let vertices = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from_array(p).as_dvec3());
    intersect_vertices(vertices, double_sided, origin, direction)
}

/// As [`intersect`], of a triangle by its vertices.
pub fn intersect_vertices(
    [p0, p1, p2]: [DVec3; 3],
    double_sided: bool,
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, [f64; 2])> {
    let (edge1, edge2) = (p1 - p0, p2 - p0);
    // Möller and Trumbore 1997; the determinant is positive where the ray comes from the front
    let across = direction.cross(edge2);
    let determinant = edge1.dot(across);
    if determinant == 0.0 || (determinant < 0.0 && !double_sided) {
        return None;
    }
    let offset = origin - p0;
    let u = offset.dot(across) / determinant;
    let side = offset.cross(edge1);
    let v = direction.dot(side) / determinant;
    let distance = edge2.dot(side) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some((distance, [u, v]))
}
