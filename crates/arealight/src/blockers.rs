//! What blocks light, as shadow rays on the GPU meet it: triangles, and a hierarchy of boxes around them.
//!
//! For hosts that have no acceleration structure of their own to answer a shadow ray with. The kernels'
//! `blockers.glsl` traverses it.

use crate::gpu::GpuBvhNode;
use glam::Vec3;
use std::ops::Range;

/// Triangles that block light from both sides, in a binary hierarchy of boxes. The root is node 0; nodes lie
/// in the order in which a ray comes to them, so that it goes on with the next one, or past all in a box that
/// it misses ([`GpuBvhNode::first`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Blockers {
    /// Never empty: without triangles it is one node of zeros, which a traversal passes by.
    pub nodes: Vec<GpuBvhNode>,
    /// In the order of the leaves, relative to the origin that the vertices were given in; w is zero, but of
    /// first vertices the bits of a number ([`Blockers::with_alpha`]). Empty without triangles; a descriptor
    /// wants a buffer all the same, of any content.
    pub triangles: Vec<[[f32; 4]; 3]>,
    /// For each of them its index in the list that was given.
    pub order: Vec<u32>,
    /// Nodes from the root to the deepest leaf; at most [`MAX_DEPTH`].
    pub max_depth: u32,
}

/// The deepest hierarchy, in nodes from the root to a leaf: a ray that ends in a leaf has been through so
/// many boxes.
pub const MAX_DEPTH: u32 = 32;

/// The most triangles: 3 GiB of records, near what devices bind.
pub const MAX_BLOCKERS: usize = 1 << 26;

/// The largest coordinate of a vertex: squared sizes of boxes stay far from infinity.
pub const MAX_COORDINATE: f32 = 1e16;

/// How many radii of a sphere or a tube its own triangles may be out without hiding its light: rays to it end
/// there. What is drawn of facets is not round.
pub const ROUND_MARGIN: f64 = 1.125;

/// Why triangles are refused as blockers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BlockerError {
    /// A coordinate is NaN, infinite or larger than [`MAX_COORDINATE`].
    #[error("triangles[{triangle}][{vertex}]: {position} relative to the origin is not within 1e16")]
    NotInRange {
        /// Index of the triangle.
        triangle: usize,
        /// Index of its vertex.
        vertex: usize,
        /// The vertex.
        position: Vec3,
    },
    /// More than [`MAX_BLOCKERS`].
    #[error("triangles: {count}, and at most {MAX_BLOCKERS} fit a buffer")]
    TooMany {
        /// How many were given.
        count: usize,
    },
}

impl Blockers {
    /// Builds the hierarchy of `triangles`, whose vertices are relative to the lights' origin
    /// ([`crate::PackedLights::new`]), in its unit of length. Their vertex order says nothing. Those without
    /// area block nothing.
    ///
    /// From the top: each node is split where the surface area heuristic is least, among 15 places along each
    /// axis (Wald 2007). Where that would become too deep, because triangles grow exponentially or are all
    /// the same, nodes are halved: time is `n log n` whatever the triangles are, a microsecond or two for
    /// each.
    ///
    /// # Errors
    /// [`BlockerError`] names the vertex, or says how many triangles there are.
    pub fn new(triangles: &[[Vec3; 3]]) -> Result<Self, BlockerError> {
        check(triangles)?;
        Ok(Self::no_deeper_than(MAX_DEPTH, triangles))
    }

    /// Gives triangles that are cut out or thin as a veil, by index in the list that was given, the number by
    /// which shadow rays ask the host what is there of them where they meet them. 0: all of it. A pass whose
    /// module has no such function of the host's (`AREALIGHT_HOST_ALPHA`) takes all of it to be there.
    #[must_use]
    pub fn with_alpha(mut self, number: impl Fn(u32) -> u32) -> Self {
        for (triangle, &index) in self.triangles.iter_mut().zip(&self.order) {
            triangle[0][3] = f32::from_bits(number(index));
        }
        self
    }

    fn no_deeper_than(limit: u32, triangles: &[[Vec3; 3]]) -> Self {
        let boxes: Vec<Box3> =
            triangles.iter().map(|[a, b, c]| [a.min(*b).min(*c), a.max(*b).max(*c)]).collect();
        let (nodes, order) = Builder::new(limit, &boxes).build();
        let record = |place: &u32| triangles[*place as usize].map(|vertex| vertex.extend(0.0).to_array());
        let max_depth = depth(&nodes);
        Self { triangles: order.iter().map(record).collect(), nodes, order, max_depth }
    }
}

fn check(triangles: &[[Vec3; 3]]) -> Result<(), BlockerError> {
    if triangles.len() > MAX_BLOCKERS {
        return Err(BlockerError::TooMany { count: triangles.len() });
    }
    for (triangle, vertices) in triangles.iter().enumerate() {
        // NaN is not within either
        let within = |vertex: &Vec3| vertex.abs().cmple(Vec3::splat(MAX_COORDINATE)).all();
        if let Some(vertex) = vertices.iter().position(|vertex| !within(vertex)) {
            return Err(BlockerError::NotInRange { triangle, vertex, position: vertices[vertex] });
        }
    }
    Ok(())
}

/// Nodes from the root to the deepest leaf.
fn depth(nodes: &[GpuBvhNode]) -> u32 {
    let mut deepest = 0;
    let mut stack = vec![(0_usize, 1_u32)];
    while let Some((index, depth)) = stack.pop() {
        deepest = deepest.max(depth);
        let node = nodes[index];
        if node.is_inner() {
            stack.extend([(index + 1, depth + 1), (nodes[index + 1].end(index + 1), depth + 1)]);
        }
    }
    deepest
}

/// A box: smallest and largest corner.
type Box3 = [Vec3; 2];

/// A box that holds nothing.
const NOTHING: Box3 = [Vec3::INFINITY, Vec3::NEG_INFINITY];

fn join(a: Box3, b: Box3) -> Box3 {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Half the surface of a box, in float64, where none overflows.
fn half_area([min, max]: Box3) -> f64 {
    let size = (max - min).as_dvec3();
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// The most triangles of a leaf.
const MAX_LEAF: usize = 4;

/// Places along an axis where a node may be split, and one.
const BINS: usize = 16;

/// The cost of a step down, in intersections of a triangle.
const STEP_COST: f64 = 1.0;

const EMPTY_NODE: GpuBvhNode = GpuBvhNode { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };

struct Builder<'a> {
    /// The greatest depth.
    limit: u32,
    boxes: &'a [Box3],
    /// Indices of boxes; of a leaf they are neighbours.
    order: Vec<u32>,
    nodes: Vec<GpuBvhNode>,
}

/// A part of the order that a node is to hold.
struct Task {
    range: Range<usize>,
    depth: u32,
}

impl<'a> Builder<'a> {
    fn new(limit: u32, boxes: &'a [Box3]) -> Self {
        Self { limit, boxes, order: (0..boxes.len() as u32).collect(), nodes: vec![] }
    }

    /// Nodes, and the order of the leaves' boxes.
    fn build(mut self) -> (Vec<GpuBvhNode>, Vec<u32>) {
        let mut tasks = vec![];
        if self.boxes.is_empty() {
            self.nodes.push(EMPTY_NODE);
        } else {
            tasks.push(Task { range: 0..self.order.len(), depth: 1 });
        }
        // A node's descendants are made right after it
        let mut inner = vec![];
        while let Some(Task { range, depth }) = tasks.pop() {
            let bounds = self.bounds(&range);
            let [min, max] = bounds.map(|corner| corner.to_array());
            let Some(middle) = self.split(&range, bounds, depth) else {
                let (first, count) = (range.start as u32, range.len() as u32);
                self.nodes.push(GpuBvhNode { min, first, max, count });
                continue;
            };
            inner.push(self.nodes.len());
            self.nodes.push(GpuBvhNode { min, first: 0, max, count: 0 });
            tasks.push(Task { range: range.start..middle, depth: depth + 1 });
            tasks.push(Task { range: middle..range.end, depth: depth + 1 });
        }
        // Children are before their parents here
        for node in inner.into_iter().rev() {
            let second = self.nodes[node + 1].end(node + 1);
            self.nodes[node].first = self.nodes[second].end(second) as u32;
        }
        (self.nodes, self.order)
    }

    /// Orders a range in two parts and gives where the second begins; none for a leaf.
    fn split(&mut self, range: &Range<usize>, bounds: Box3, depth: u32) -> Option<usize> {
        if range.len() == 1 || depth >= self.limit {
            return None;
        }
        let centers = self.order[range.clone()].iter().map(|i| [self.center(*i); 2]);
        let [low, high] = centers.fold(NOTHING, join);
        // Take the cheapest split, if it is cheaper than a leaf or a leaf would be too large
        let best = (0..3)
            .filter_map(|axis| self.cheapest(range, axis, low[axis], high[axis]))
            .min_by(|a, b| a.cost.total_cmp(&b.cost));
        let leaf_cost = range.len() as f64 * half_area(bounds);
        let small = range.len() <= MAX_LEAF;
        let worthwhile = |best: &Split| !small || best.cost + STEP_COST * half_area(bounds) < leaf_cost;
        let Some(Split { axis, bin, .. }) = best.filter(worthwhile) else {
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

    /// The split of least cost along an axis, between the centers' least and greatest coordinate.
    fn cheapest(&self, range: &Range<usize>, axis: usize, low: f32, high: f32) -> Option<Split> {
        if low >= high {
            return None;
        }
        let mut bins = [Bin { bounds: NOTHING, count: 0 }; BINS];
        for &i in &self.order[range.clone()] {
            bins[bin_of(self.center(i)[axis], low, high)]
                .add(Bin { bounds: self.boxes[i as usize], count: 1 });
        }
        // Sum from the end, then compare each place from the start
        let mut after = bins;
        for bin in (0..BINS - 1).rev() {
            after[bin].add(after[bin + 1]);
        }
        let mut before = Bin { bounds: NOTHING, count: 0 };
        let splits = (0..BINS - 1).filter_map(|bin| {
            before.add(bins[bin]);
            let rest = after[bin + 1];
            let both = before.count > 0 && rest.count > 0;
            both.then(|| Split { cost: before.cost() + rest.cost(), axis, bin })
        });
        splits.min_by(|a, b| a.cost.total_cmp(&b.cost))
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
        self.order[range.clone()].iter().map(|i| self.boxes[*i as usize]).fold(NOTHING, join)
    }
}

/// Where a node may be split: after a bin along an axis.
struct Split {
    cost: f64,
    axis: usize,
    bin: usize,
}

/// The boxes whose centers lie in a part of an axis.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box3,
    count: usize,
}

impl Bin {
    fn add(&mut self, other: Self) {
        *self = Self { bounds: join(self.bounds, other.bounds), count: self.count + other.count };
    }

    /// Expected intersections of triangles, for rays that would meet a box of half area 1 once.
    fn cost(&self) -> f64 {
        self.count as f64 * half_area(self.bounds)
    }
}

/// The bin of a center between `low` and `high`.
fn bin_of(center: f32, low: f32, high: f32) -> usize {
    (((center - low) / (high - low) * BINS as f32) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle whose bounds are those.
    fn triangle([min, max]: Box3) -> [Vec3; 3] {
        [min, max, min]
    }

    fn triangles(boxes: &[Box3]) -> Vec<[Vec3; 3]> {
        boxes.iter().copied().map(triangle).collect()
    }

    /// Every box is in the leaf that holds it, once, and every node in its parent.
    fn check_tree(blockers: &Blockers, boxes: &[Box3]) {
        let mut found = vec![0; boxes.len()];
        let mut stack = vec![(0_usize, [Vec3::NEG_INFINITY, Vec3::INFINITY])];
        while let Some((index, [low, high])) = stack.pop() {
            let node = blockers.nodes[index];
            let own = [Vec3::from_array(node.min), Vec3::from_array(node.max)];
            assert!(own[0].cmpge(low).all() && own[1].cmple(high).all(), "node {index} leaves its parent");
            if node.is_inner() {
                let second = blockers.nodes[index + 1].end(index + 1);
                assert!(second > index + 1, "a traversal ends");
                assert_eq!(
                    node.end(index),
                    blockers.nodes[second].end(second),
                    "node {index} ends with its children"
                );
                stack.extend([(index + 1, own), (second, own)]);
            }
            if index == 0 && !boxes.is_empty() {
                assert_eq!(node.end(0), blockers.nodes.len(), "the root holds every node");
            }
            for place in node.first..node.first + node.count {
                let held = blockers.order[place as usize] as usize;
                found[held] += 1;
                let [min, max] = boxes[held];
                assert!(min.cmpge(own[0]).all() && max.cmple(own[1]).all(), "box {held} leaves its leaf");
                let record = blockers.triangles[place as usize];
                assert_eq!(record, triangle([min, max]).map(|vertex| vertex.extend(0.0).to_array()));
            }
        }
        assert!(found.iter().all(|count| *count == 1));
        assert!(blockers.max_depth <= MAX_DEPTH, "depth {}", blockers.max_depth);
    }

    fn built(boxes: &[Box3]) -> Blockers {
        let blockers = Blockers::new(&triangles(boxes)).expect("they are in range");
        check_tree(&blockers, boxes);
        blockers
    }

    #[test]
    fn triangles_that_grow_exponentially_stay_shallow() {
        // Points along the axes, each half as far as the one before: a split takes few of them off
        let point = |i: u16| {
            let mut point = Vec3::ZERO;
            point[usize::from(i % 3)] = 1e16 * 0.5_f32.powf(f32::from(i) / 3.0);
            [point; 2]
        };
        let boxes: Vec<Box3> = (0..530).map(point).collect();
        // The twin: without the limit it is deeper
        let free = Blockers::no_deeper_than(u32::MAX, &triangles(&boxes));
        assert!(free.max_depth > MAX_DEPTH, "depth {}", free.max_depth);
        built(&boxes);
        for limit in [9, 12, 20] {
            assert!(Blockers::no_deeper_than(limit, &triangles(&boxes)).max_depth <= limit);
        }
    }

    #[test]
    fn equal_and_flat_triangles_are_held() {
        built(&vec![[Vec3::ONE, Vec3::splat(2.0)]; 50_000]);
        built(&vec![[Vec3::splat(3.0); 2]; 100]);
        built(&[[Vec3::splat(-1e16), Vec3::splat(1e16)], [Vec3::ZERO; 2], [Vec3::X, Vec3::X * 1e15]]);
    }

    #[test]
    fn triangles_that_are_cut_out_have_their_numbers() {
        let boxes: Vec<Box3> = (0..40).map(|i| [Vec3::X * (i * 7 % 40) as f32, Vec3::ONE]).collect();
        let number = |index: u32| if index.is_multiple_of(3) { u32::MAX - index } else { 0 };
        let cut = built(&boxes).with_alpha(number);
        let found = cut.triangles.iter().map(|[first, ..]| first[3].to_bits());
        assert!(found.eq(cut.order.iter().map(|index| number(*index))) && cut.order != [0; 40]);
        assert_eq!(cut.triangles.iter().flatten().filter(|vertex| vertex[3].to_bits() != 0).count(), 14);
    }

    #[test]
    fn few_triangles_are_a_leaf_or_nothing() {
        let none = Blockers::new(&[]).unwrap();
        assert_eq!((none.nodes, none.triangles, none.order), (vec![EMPTY_NODE], vec![], vec![]));
        for count in 1..10 {
            let boxes: Vec<Box3> = (0..count).map(|i| [Vec3::X * i as f32, Vec3::splat(i as f32)]).collect();
            built(&boxes);
        }
    }

    #[test]
    fn the_heuristic_parts_what_lies_apart() {
        // Two rows of triangles, far from each other: the first split is between them, however they are
        // listed
        let boxes: Vec<Box3> = (0..64)
            .map(|i| {
                let corner = Vec3::new((i / 2) as f32 * 0.1, if i % 2 == 0 { 0.0 } else { 50.0 }, 0.0);
                [corner, corner + 0.1]
            })
            .collect();
        let nodes = built(&boxes).nodes;
        let mut heights = [1, nodes[1].end(1)].map(|child| nodes[child].max[1].round());
        heights.sort_by(f32::total_cmp);
        assert_eq!(heights, [0.0, 50.0]);
    }

    #[test]
    fn what_is_no_position_is_named() {
        let good = [[Vec3::ZERO, Vec3::X, Vec3::Y]; 3];
        assert!(Blockers::new(&good).is_ok());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2e16, f32::MIN] {
            let mut triangles = good;
            triangles[2][1].z = bad;
            let error = Blockers::new(&triangles).unwrap_err();
            assert!(error.to_string().starts_with("triangles[2][1]: "), "{error}");
            assert!(matches!(error, BlockerError::NotInRange { triangle: 2, vertex: 1, .. }));
        }
    }
}
