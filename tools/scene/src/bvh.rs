//! The hierarchy of boxes around triangles that the visibility kernel walks, and a float64 twin of its walk.

use ::bvh::aabb::{Aabb, Bounded};
use ::bvh::bounding_hierarchy::BHShape;
use ::bvh::bvh::{Bvh as Tree, BvhNode as TreeNode};
use arealight_tool_kernels::gpu::{GpuBvhNode, GpuMaterial, GpuTriangle};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// The deepest hierarchy, in nodes from the root to a leaf: a walk with a stack of this many entries holds
/// it. The visibility kernel relies on it.
pub const MAX_DEPTH: u32 = 48;

/// The most triangles of a leaf.
const MAX_LEAF: usize = 4;

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
    /// Builds a hierarchy from the top by the crate `bvh`: each node is split where the surface area heuristic
    /// is least, among a few places (Wald 2007). Where that becomes too deep, because boxes grow
    /// exponentially, nodes are halved.
    pub fn build(boxes: &[Box3]) -> Self {
        Self::no_deeper_than(MAX_DEPTH, boxes)
    }

    fn no_deeper_than(limit: u32, boxes: &[Box3]) -> Self {
        let mut shapes: Vec<Shape> = boxes.iter().map(|bounds| Shape { bounds: *bounds, node: 0 }).collect();
        let tree = Tree::build(&mut shapes);
        // The tree's nodes are in the order of a walk: the boxes under each are neighbours
        let order = tree.nodes.iter().filter_map(|node| match node {
            TreeNode::Leaf { shape_index, .. } => Some(*shape_index as u32),
            TreeNode::Node { .. } => None,
        });
        let order = order.collect();
        let mut flattener = Flattener { limit, boxes, tree, order, nodes: Vec::new() };
        if !boxes.is_empty() {
            flattener.flatten();
        }
        Self::measured(flattener.nodes, flattener.order)
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

/// A box as the crate `bvh` wants it.
struct Shape {
    bounds: Box3,
    node: usize,
}

impl Bounded<f64, 3> for Shape {
    /// In float64, where the squared size of no box overflows. The crate panics on infinity and NaN: zero
    /// stands for them.
    fn aabb(&self) -> Aabb<f64, 3> {
        let finite = |x: f32| if x.is_finite() { f64::from(x) } else { 0.0 };
        let [min, max] = self.bounds.map(|corner| corner.to_array().map(finite).into());
        Aabb::with_bounds(min, max)
    }
}

impl BHShape<f64, 3> for Shape {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// Writes a tree as the kernel's nodes, of limited depth.
struct Flattener<'a> {
    /// The greatest depth.
    limit: u32,
    boxes: &'a [Box3],
    tree: Tree<f64, 3>,
    order: Vec<u32>,
    nodes: Vec<GpuBvhNode>,
}

/// A part of the order, with the node that is to hold it.
struct Task {
    node: usize,
    range: Range<usize>,
    depth: u32,
    /// The tree's node with the same boxes; none where the tree is not followed.
    branch: Option<usize>,
}

impl Flattener<'_> {
    fn flatten(&mut self) {
        let empty = GpuBvhNode { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };
        self.nodes.push(empty);
        let mut tasks = vec![Task { node: 0, range: 0..self.order.len(), depth: 1, branch: Some(0) }];
        while let Some(Task { node, range, depth, branch }) = tasks.pop() {
            // Bound the range
            let [min, max] = self.bounds(&range);
            self.nodes[node] = GpuBvhNode { min: min.to_array(), max: max.to_array(), ..empty };
            if range.len() <= MAX_LEAF {
                self.nodes[node].first = range.start as u32;
                self.nodes[node].count = range.len() as u32;
                continue;
            }
            // Split it as the tree does, or halve it
            let followed = branch.and_then(|branch| self.follow(branch, &range, depth));
            let (middle, [left, right]) = followed.unwrap_or_else(|| {
                let axis = (max - min).max_position();
                (self.halve(&range, axis), [None; 2])
            });
            let first = self.nodes.len();
            self.nodes[node].first = first as u32;
            self.nodes.extend([empty; 2]);
            let (depth, before, after) = (depth + 1, range.start..middle, middle..range.end);
            tasks.push(Task { node: first, range: before, depth, branch: left });
            tasks.push(Task { node: first + 1, range: after, depth, branch: right });
        }
    }

    /// Where the tree splits a range, and the branches of the parts. None if the larger part could not be
    /// halved down to leaves in the depth that is left.
    fn follow(&self, branch: usize, range: &Range<usize>, depth: u32) -> Option<(usize, [Option<usize>; 2])> {
        let TreeNode::Node { child_l_index: left, child_r_index: right, .. } = self.tree.nodes[branch] else {
            return None;
        };
        // The left branch lies before the right one and has a node less than two for each box
        let middle = range.start + (right - left).div_ceil(2);
        let larger = (middle - range.start).max(range.end - middle);
        let fits = larger.div_ceil(MAX_LEAF).next_power_of_two().ilog2() < self.limit - depth;
        fits.then_some((middle, [Some(left), Some(right)]))
    }

    /// Orders a range so that its first half has the smaller centers along an axis.
    fn halve(&mut self, range: &Range<usize>, axis: usize) -> usize {
        let (boxes, middle) = (self.boxes, range.len() / 2);
        let center = |i: &u32| boxes[*i as usize][0][axis] + boxes[*i as usize][1][axis];
        self.order[range.clone()].select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
        range.start + middle
    }

    fn bounds(&self, range: &Range<usize>) -> Box3 {
        let boxes = self.order[range.clone()].iter().map(|i| self.boxes[*i as usize]);
        boxes.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])])
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
        // Points along the axes, each half as far as the one before: a split takes few of them off
        let point = |i: u16| {
            let mut point = Vec3::ZERO;
            point[usize::from(i % 3)] = 1e16 * 0.5_f32.powf(f32::from(i) / 3.0);
            [point; 2]
        };
        let boxes: Vec<Box3> = (0..530).map(point).collect();
        // The twin: without the limit it is deeper than the kernel's stack
        let free = Bvh::no_deeper_than(u32::MAX, &boxes);
        assert!(free.max_depth > MAX_DEPTH, "depth {}", free.max_depth);
        let bvh = Bvh::build(&boxes);
        check(&bvh, &boxes);
        for limit in [9, 12, 20] {
            assert!(Bvh::no_deeper_than(limit, &boxes).max_depth <= limit);
        }
    }

    #[test]
    fn equal_and_flat_boxes_are_held() {
        let equal = vec![[Vec3::ONE, Vec3::splat(2.0)]; 50_000];
        check(&Bvh::build(&equal), &equal);
        let points = vec![[Vec3::splat(3.0); 2]; 100];
        check(&Bvh::build(&points), &points);
        let huge = vec![[Vec3::splat(-1e16), Vec3::splat(1e16)], [Vec3::ZERO; 2], [Vec3::X, Vec3::X * 1e15]];
        check(&Bvh::build(&huge), &huge);
    }

    #[test]
    fn coordinates_that_are_not_numbers_do_not_panic() {
        let odd = [0.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN];
        let corner = |i: usize| Vec3::new(odd[i % 7], odd[i / 7 % 7], odd[i / 49]);
        let boxes: Vec<Box3> = (0..343).map(|i| [corner(i), corner((i * 5 + 3) % 343)]).collect();
        let mut order = Bvh::build(&boxes).order;
        order.sort_unstable();
        assert!(order.into_iter().eq(0..343));
    }

    #[test]
    fn few_boxes_are_a_leaf_or_nothing() {
        assert_eq!(Bvh::build(&[]), Bvh::default());
        for count in 1..10 {
            let boxes: Vec<Box3> = (0..count).map(|i| [Vec3::X * i as f32, Vec3::splat(i as f32)]).collect();
            check(&Bvh::build(&boxes), &boxes);
        }
    }
}
