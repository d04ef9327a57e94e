//! The hierarchy of boxes around triangles that the visibility kernel walks, and a float64 twin of its walk.

use arealight::gpu::{GpuBvhNode, GpuMaterial, GpuTriangle};
use glam::{DVec3, Vec3, Vec3A};
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// The deepest hierarchy, in nodes from the root to a leaf: a walk with a stack of this many entries holds
/// it. The visibility kernel relies on it.
pub const MAX_DEPTH: u32 = 48;

/// The most triangles of a leaf.
const MAX_LEAF: u32 = 4;

/// A binary hierarchy of boxes. The root is node 0; children of an inner node are neighbours.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bvh {
    /// Empty if there are no boxes.
    pub nodes: Vec<GpuBvhNode>,
    /// For each place of the leaves' order the box that is there.
    pub order: Vec<u32>,
    /// Nodes from the root to the deepest leaf; at most [`MAX_DEPTH`].
    pub max_depth: u32,
}

/// A box: smallest and largest corner, no coordinate beyond 1e16.
pub type Box3 = [Vec3; 2];

impl Bvh {
    /// Builds a hierarchy by locally ordered clustering; where that becomes too deep (boxes that grow
    /// exponentially, say), by halving the boxes along their longest extent.
    pub fn build(boxes: &[Box3]) -> Self {
        let clustered = Self::by_clustering(boxes);
        match clustered.max_depth {
            0..=MAX_DEPTH => clustered,
            _ => Self::by_halving(boxes),
        }
    }

    fn by_clustering(boxes: &[Box3]) -> Self {
        let boxes: Vec<_> = boxes
            .iter()
            .map(|[min, max]| obvhs::aabb::Aabb::new(Vec3A::from(*min), Vec3A::from(*max)))
            .collect();
        let indices = (0..boxes.len() as u32).collect();
        let mut builder = PlocBuilder::with_capacity(boxes.len());
        let mut bvh = builder.build(PlocSearchDistance::Medium, &boxes, indices, SortPrecision::U64, 3);
        // Move subtrees to where they cost less; a tree that is too deep is not kept anyway
        if bvh.max_depth <= obvhs::bvh2::DEFAULT_MAX_STACK_DEPTH {
            ReinsertionOptimizer::default().run(&mut bvh, 0.05, None);
            collapse(&mut bvh, MAX_LEAF, 1.0);
        }
        let nodes = bvh.nodes.iter().map(|node| GpuBvhNode {
            min: node.aabb().min.to_array(),
            first: node.first_index,
            max: node.aabb().max.to_array(),
            count: node.prim_count,
        });
        Self::measured(nodes.collect(), bvh.primitive_indices)
    }

    /// Depth is the logarithm of the count: at most 31 for 2^32 boxes.
    fn by_halving(boxes: &[Box3]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = vec![GpuBvhNode { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 }];
        let mut stack = vec![(0_usize, 0..order.len())];
        while let Some((node, range)) = stack.pop() {
            // Bound the range
            let [min, max] = range
                .clone()
                .map(|i| boxes[order[i] as usize])
                .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            let (first, count) = if range.len() <= MAX_LEAF as usize {
                (range.start as u32, range.len() as u32)
            } else {
                // Halve it by the middles along the longest extent
                let axis = (max - min).max_position();
                let middle = range.len() / 2;
                order[range.clone()].select_nth_unstable_by(middle, |a, b| {
                    let key = |i: &u32| boxes[*i as usize][0][axis] + boxes[*i as usize][1][axis];
                    key(a).total_cmp(&key(b))
                });
                let first = nodes.len();
                nodes.extend([nodes[0]; 2]);
                stack.push((first, range.start..range.start + middle));
                stack.push((first + 1, range.start + middle..range.end));
                (first as u32, 0)
            };
            nodes[node] = GpuBvhNode { min: min.to_array(), first, max: max.to_array(), count };
        }
        Self::measured(nodes, order)
    }

    fn measured(nodes: Vec<GpuBvhNode>, order: Vec<u32>) -> Self {
        let mut max_depth = 0;
        let mut stack = vec![(0_usize, 1_u32)];
        while let Some((node, depth)) = stack.pop() {
            let Some(node) = nodes.get(node) else { continue };
            max_depth = max_depth.max(depth);
            if node.count == 0 {
                stack.extend([(node.first as usize, depth + 1), (node.first as usize + 1, depth + 1)]);
            }
        }
        Self { nodes, order, max_depth }
    }
}

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
    let mut stack = vec![0];
    while let Some(index) = stack.pop() {
        let Some(node) = nodes.get(index) else { continue };
        let limit = closest.map_or(f64::INFINITY, |hit| hit.distance);
        if !enters(node, origin, inverse, limit) {
            continue;
        }
        let first = node.first as usize;
        if node.count == 0 {
            stack.extend([first, first + 1]);
        }
        let leaf = triangles.iter().enumerate().skip(first).take(node.count as usize);
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
    let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from_array(p).as_dvec3());
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every box is in the leaf that holds it, once, and every node in its parent.
    fn check(bvh: &Bvh, boxes: &[Box3]) {
        let mut found = vec![0; boxes.len()];
        let mut stack = vec![(0_usize, [Vec3::NEG_INFINITY, Vec3::INFINITY])];
        while let Some((index, [low, high])) = stack.pop() {
            let node = bvh.nodes[index];
            let own = [Vec3::from_array(node.min), Vec3::from_array(node.max)];
            assert!(own[0].cmpge(low).all() && own[1].cmple(high).all(), "node {index} leaves its parent");
            if node.count == 0 {
                stack.extend([(node.first as usize, own), (node.first as usize + 1, own)]);
            }
            for place in node.first..node.first + node.count {
                let held = bvh.order[place as usize] as usize;
                found[held] += 1;
                let [min, max] = boxes[held];
                assert!(min.cmpge(own[0]).all() && max.cmple(own[1]).all(), "box {held} leaves its leaf");
            }
        }
        assert!(found.iter().all(|count| *count == 1));
        assert!(bvh.max_depth <= MAX_DEPTH, "depth {}", bvh.max_depth);
    }

    #[test]
    fn boxes_that_grow_exponentially_stay_shallow() {
        let boxes: Vec<Box3> = (0..160).map(|i| [Vec3::ZERO, Vec3::splat(1.5_f32.powi(i - 80))]).collect();
        // The twin: clustering alone is deeper than the kernel's stack
        assert!(Bvh::by_clustering(&boxes).max_depth > MAX_DEPTH);
        check(&Bvh::build(&boxes), &boxes);
    }

    #[test]
    fn equal_and_flat_boxes_are_held() {
        let equal = vec![[Vec3::ONE, Vec3::splat(2.0)]; 5000];
        check(&Bvh::build(&equal), &equal);
        let points = vec![[Vec3::splat(3.0); 2]; 100];
        check(&Bvh::build(&points), &points);
        let huge = vec![[Vec3::splat(-1e16), Vec3::splat(1e16)], [Vec3::ZERO; 2], [Vec3::X, Vec3::X * 1e15]];
        check(&Bvh::build(&huge), &huge);
    }

    #[test]
    fn few_boxes_are_a_leaf_or_nothing() {
        assert_eq!(Bvh::build(&[]), Bvh::default());
        for count in 1..10 {
            let boxes: Vec<Box3> = (0..count).map(|i| [Vec3::X * i as f32, Vec3::splat(i as f32)]).collect();
            check(&Bvh::build(&boxes), &boxes);
            check(&Bvh::by_halving(&boxes), &boxes);
        }
    }
}
