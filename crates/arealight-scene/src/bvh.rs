//! The hierarchy of boxes around triangles that the visibility kernel walks, and a float64 twin of its walk.

use arealight::gpu::{GpuBvhNode, GpuMaterial, GpuTriangle};
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
    /// Builds a hierarchy from the top: each node is split where the surface area heuristic is least, among
    /// a few places along each axis (Wald 2007). Where that would become too deep, because boxes grow
    /// exponentially or are all the same, nodes are halved: time is `n log n` whatever the boxes are.
    pub fn build(boxes: &[Box3]) -> Self {
        Self::no_deeper_than(MAX_DEPTH, boxes)
    }

    fn no_deeper_than(limit: u32, boxes: &[Box3]) -> Self {
        let order = (0..boxes.len() as u32).collect();
        let mut builder = Builder { limit, boxes, order, nodes: Vec::new() };
        if !boxes.is_empty() {
            builder.build();
        }
        Self::measured(builder.nodes, builder.order)
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

/// Places along an axis where a node may be split, and one.
const BINS: usize = 16;

/// What a step down costs, in intersections of a triangle.
const STEP_COST: f64 = 1.0;

struct Builder<'a> {
    /// The greatest depth.
    limit: u32,
    boxes: &'a [Box3],
    order: Vec<u32>,
    nodes: Vec<GpuBvhNode>,
}

/// A part of the order, with the node that is to hold it.
struct Task {
    node: usize,
    range: Range<usize>,
    depth: u32,
}

impl Builder<'_> {
    fn build(&mut self) {
        let empty = GpuBvhNode { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };
        self.nodes.push(empty);
        let mut tasks = vec![Task { node: 0, range: 0..self.order.len(), depth: 1 }];
        while let Some(Task { node, range, depth }) = tasks.pop() {
            let [min, max] = self.bounds(&range);
            self.nodes[node] = GpuBvhNode { min: min.to_array(), max: max.to_array(), ..empty };
            let Some(middle) = self.split(&range, [min, max], depth) else {
                self.nodes[node].first = range.start as u32;
                self.nodes[node].count = range.len() as u32;
                continue;
            };
            let first = self.nodes.len();
            self.nodes[node].first = first as u32;
            self.nodes.extend([empty; 2]);
            tasks.push(Task { node: first, range: range.start..middle, depth: depth + 1 });
            tasks.push(Task { node: first + 1, range: middle..range.end, depth: depth + 1 });
        }
    }

    /// Orders a range in two parts and gives where the second begins; none for a leaf.
    fn split(&mut self, range: &Range<usize>, bounds: Box3, depth: u32) -> Option<usize> {
        if range.len() == 1 || depth >= self.limit {
            return None;
        }
        let centers = self.order[range.clone()].iter().map(|i| self.center(*i));
        let [low, high] =
            centers.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], c| [low.min(c), high.max(c)]);
        // Take the cheapest split, if it is cheaper than a leaf or a leaf would be too large
        let best = (0..3)
            .filter_map(|axis| self.cheapest(range, axis, low[axis], high[axis]))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let leaf_cost = range.len() as f64 * half_area(bounds);
        let small = range.len() <= MAX_LEAF;
        let Some((_, axis, bin)) =
            best.filter(|(cost, ..)| !small || cost + STEP_COST * half_area(bounds) < leaf_cost)
        else {
            return if small { None } else { Some(self.halve(range, (high - low).max_position())) };
        };
        let mut middle = range.start;
        for i in range.clone() {
            if bin_of(self.center(self.order[i])[axis], low[axis], high[axis]) <= bin {
                self.order.swap(i, middle);
                middle += 1;
            }
        }
        // Halve instead if the larger part could not be halved down to leaves in the depth that is left
        let larger = (middle - range.start).max(range.end - middle);
        let fits = larger.div_ceil(MAX_LEAF).next_power_of_two().ilog2() < self.limit - depth;
        Some(if fits { middle } else { self.halve(range, axis) })
    }

    /// The least cost of a split along an axis, with the axis and the last bin of the first part.
    fn cheapest(
        &self,
        range: &Range<usize>,
        axis: usize,
        low: f32,
        high: f32,
    ) -> Option<(f64, usize, usize)> {
        if low >= high {
            return None;
        }
        let empty = ([Vec3::INFINITY, Vec3::NEG_INFINITY], 0_usize);
        let join = |(a, n): (Box3, usize), (b, m): (Box3, usize)| ([a[0].min(b[0]), a[1].max(b[1])], n + m);
        let mut bins = [empty; BINS];
        for &i in &self.order[range.clone()] {
            let bin = &mut bins[bin_of(self.center(i)[axis], low, high)];
            *bin = join(*bin, (self.boxes[i as usize], 1));
        }
        // Sum from the end, then compare each place from the start
        let mut after = [empty; BINS];
        for bin in (0..BINS - 1).rev() {
            after[bin] = join(after[bin + 1], bins[bin + 1]);
        }
        let cost = |(bounds, count): (Box3, usize)| count as f64 * half_area(bounds);
        let mut before = empty;
        let costs = (0..BINS - 1).filter_map(|bin| {
            before = join(before, bins[bin]);
            let both = before.1 > 0 && after[bin].1 > 0;
            both.then(|| (cost(before) + cost(after[bin]), axis, bin))
        });
        costs.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Orders a range so that its first half has the smaller centers along an axis.
    fn halve(&mut self, range: &Range<usize>, axis: usize) -> usize {
        let (boxes, middle) = (self.boxes, range.len() / 2);
        let center = |i: &u32| boxes[*i as usize][0][axis] + boxes[*i as usize][1][axis];
        self.order[range.clone()].select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
        range.start + middle
    }

    fn center(&self, index: u32) -> Vec3 {
        let [min, max] = self.boxes[index as usize];
        (min + max) * 0.5
    }

    fn bounds(&self, range: &Range<usize>) -> Box3 {
        let boxes = self.order[range.clone()].iter().map(|i| self.boxes[*i as usize]);
        boxes.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// The bin of a center between `low` and `high`.
fn bin_of(center: f32, low: f32, high: f32) -> usize {
    (((center - low) / (high - low) * BINS as f32) as usize).min(BINS - 1)
}

/// Half the surface of a box.
fn half_area([min, max]: Box3) -> f64 {
    let size = (max - min).as_dvec3();
    size.x * size.y + size.y * size.z + size.z * size.x
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
    fn few_boxes_are_a_leaf_or_nothing() {
        assert_eq!(Bvh::build(&[]), Bvh::default());
        for count in 1..10 {
            let boxes: Vec<Box3> = (0..count).map(|i| [Vec3::X * i as f32, Vec3::splat(i as f32)]).collect();
            check(&Bvh::build(&boxes), &boxes);
        }
    }
}
