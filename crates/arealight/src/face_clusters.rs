//! Clusters of a mesh's faces: what many faces send from afar, without a look at each.
//!
//! From far away, along the unit vector `u`, faces with the area vectors `A` show `sum max(0, -A·u)`, half of
//! `-sum A·u + sum |A·u|`. A cluster keeps the sum of its area vectors and a quadratic form `Q` with
//! `sum |A·u|` near `sqrt(u·Q u)`: that is exact where all faces are in one plane, for long tubes and for
//! ellipsoids. Area that is projected onto a sphere keeps its ratio in every linear space, so that one form
//! serves every lobe. From a distance on that is kept with it, that errs by less than the error asked for.

use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// Rows of a cluster in the vertex buffer.
pub(crate) const ROWS: usize = 4;

/// The fewest faces that are worth a cluster: fewer cost as much as its rows.
const FEWEST: usize = 4;

/// What a cluster's distance is at most of its parent's: nearer to it, the parent serves.
const CLOSER: f64 = 0.75;

/// The least distance of a cluster, in its radii: the errors' series does for what is beyond.
const LEAST: f64 = 2.0;

/// What a turn of normals from one axis to its opposite counts when faces are sorted: so much of the mesh's
/// extent. The sides of a tube come apart where it is this long; without, those of six or eight sides stay
/// together, which show up to a twelfth more along their corners than a tube does.
const TURN: f64 = 1.0;

/// The faces of a mesh in clusters, and these in greater ones: see
/// [`LightShape::clustered`](crate::LightShape::clustered). Empty by default: then each face is looked at.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceClusters {
    pub(crate) error: f64,
    /// Each before those that are parts of it, by their first face.
    pub(crate) clusters: Vec<Cluster>,
}

/// Faces one after another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cluster {
    pub first: usize,
    pub end: usize,
    /// How many rows it has, with those of its faces and of the clusters in it.
    rows: usize,
    center: DVec3,
    /// The sum of the areas, and of the area vectors.
    area: f64,
    vector: DVec3,
    /// Of the sum of what both sides show.
    form: DMat3,
    /// About the center: all vertices are within.
    radius: f64,
    /// From here on it errs by less than asked for, in any space that is not longer than this one.
    distance: f64,
}

impl FaceClusters {
    /// How many rows they add.
    pub(crate) fn row_count(&self) -> usize {
        self.clusters.len() * ROWS
    }

    /// Their rows about `origin`, each cluster's with the index of its first face. None where there are fewer
    /// `faces` than they are of.
    pub(crate) fn rows(&self, faces: usize, origin: DVec3) -> Vec<(usize, [[f32; 4]; ROWS])> {
        if self.clusters.iter().any(|cluster| cluster.end > faces) {
            return vec![];
        }
        self.clusters.iter().map(|cluster| (cluster.first, cluster.rows(origin))).collect()
    }
}

impl Cluster {
    /// Its own rows, relative to `origin`.
    fn rows(&self, origin: DVec3) -> [[f32; 4]; ROWS] {
        let row = |vector: DVec3, number: f64| vector.as_vec3().extend(number as f32).to_array();
        // Of area 1, so that float32 holds its square for lights of any size
        let form = self.form * (1.0 / self.area.powi(2));
        [
            row(self.center - origin, -(self.rows as f64)),
            row(self.vector / self.area, self.distance),
            row(DVec3::new(form.x_axis.x, form.y_axis.y, form.z_axis.z), self.radius),
            row(2.0 * DVec3::new(form.x_axis.y, form.x_axis.z, form.y_axis.z), self.area),
        ]
    }
}

/// The directions that clusters are judged from: corners of an icosahedron and a dodecahedron, and their
/// weights, which sum to 1. Means over them are exact up to degree 9 (A. D. `McLaren` 1963).
static DIRECTIONS: LazyLock<[(DVec3, f64); 32]> = LazyLock::new(|| {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut directions = [(DVec3::ZERO, 0.0); 32];
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let icosahedron = (0..12).map(|i| {
        let (a, b) = signs[i % 4];
        let mut corner = DVec3::ZERO;
        corner[(i / 4 + 1) % 3] = a;
        corner[(i / 4 + 2) % 3] = b * golden;
        (corner, 5.0 / 168.0)
    });
    let dodecahedron = (0..20).map(|i| {
        let (a, b) = signs[i % 4];
        let mut corner = DVec3::new(a, b, 1.0);
        if i < 12 {
            corner = DVec3::ZERO;
            corner[(i / 4 + 1) % 3] = a * golden;
            corner[(i / 4 + 2) % 3] = b / golden;
        } else if i >= 16 {
            corner.z = -1.0;
        }
        (corner, 9.0 / 280.0)
    });
    for (place, (corner, weight)) in directions.iter_mut().zip(icosahedron.chain(dodecahedron)) {
        *place = (corner.normalize_or_zero(), weight);
    }
    directions
});

/// An outline of three vertices or more, and its area vector.
type Outline<'a> = (&'a [DVec3], DVec3);

struct Face {
    vector: DVec3,
    middle: DVec3,
    /// The mean of `x x^T` over it.
    squares: DMat3,
}

impl Face {
    fn new((outline, vector): Outline) -> Self {
        let normal = vector.normalize_or_zero();
        let (mut area, mut middle, mut squares) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for edge in outline.windows(2) {
            let corners = [outline[0], edge[0], edge[1]];
            let part = 0.5 * (edge[0] - corners[0]).cross(edge[1] - corners[0]).dot(normal);
            let sum: DVec3 = corners.iter().sum();
            let parts = corners.iter().map(|corner| square(*corner)).fold(square(sum), |a, b| a + b);
            area += part;
            middle += sum * (part / 3.0);
            squares += parts * (part / 12.0);
        }
        if area > 0.0 {
            Self { vector, middle: middle / area, squares: squares * (1.0 / area) }
        } else {
            Self { vector: DVec3::ZERO, middle: outline[0], squares: square(outline[0]) }
        }
    }
}

/// `a b^T`.
fn product(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn square(vector: DVec3) -> DMat3 {
    product(vector, vector)
}

/// What faces show along one direction, about the mesh's middle.
#[derive(Clone, Copy, Default)]
struct Shown {
    /// The sum of their areas as seen.
    area: f64,
    /// The sum of area as seen times place, and times its square.
    places: DVec3,
    squares: DMat3,
    /// Of those that face the direction, the sum of area vectors, and of these over places.
    vectors: DVec3,
    heights: f64,
}

/// What faces show along each direction.
struct Sums {
    area: f64,
    places: DVec3,
    vector: DVec3,
    shown: [Shown; 32],
}

impl Sums {
    fn new(face: &Face) -> Self {
        let area = face.vector.length();
        let shown = DIRECTIONS.map(|(direction, _)| {
            let area = -face.vector.dot(direction);
            let (vectors, heights) = (face.vector, face.vector.dot(face.middle));
            if area <= 0.0 {
                return Shown { squares: DMat3::ZERO, ..Shown::default() };
            }
            let (places, squares) = (face.middle * area, face.squares * area);
            Shown { area, places, squares, vectors, heights }
        });
        Self { area, places: face.middle * area, vector: face.vector, shown }
    }

    fn add(mut self, other: &Self) -> Self {
        self.area += other.area;
        self.places += other.places;
        self.vector += other.vector;
        for (sum, shown) in self.shown.iter_mut().zip(&other.shown) {
            sum.area += shown.area;
            sum.places += shown.places;
            sum.squares += shown.squares;
            sum.vectors += shown.vectors;
            sum.heights += shown.heights;
        }
        self
    }

    /// The form of what both sides show: its mean over directions and its part of degree two.
    fn form(&self) -> DMat3 {
        let (mut mean, mut second) = (0.0, DMat3::ZERO);
        for (shown, (direction, weight)) in self.shown.iter().zip(&*DIRECTIONS) {
            // Of both sides: those that face it, and those that don't
            let both = 2.0 * shown.area + self.vector.dot(*direction);
            mean += weight * both * both;
            second += square(*direction) * (weight * both * both);
        }
        let isotropic = DMat3::from_diagonal(DVec3::splat(mean));
        isotropic + (second - isotropic * (1.0 / 3.0)) * 7.5
    }

    /// From which distance on the cluster about `center` serves; infinite where it never does. What its form
    /// makes of the area that shows, and what its distance makes of that, may each be off by `error` of what
    /// it shows on average: both are the root of the mean square over directions.
    ///
    /// To second order in the distance: seen from `-p`, faces at `x` send `-A·(p + x) (p + x) / |p + x|^4`.
    fn distance(&self, center: DVec3, form: &DMat3, error: f64) -> f64 {
        let (mut area, mut first, mut second) = (0.0, 0.0, 0.0);
        for (shown, &(direction, weight)) in self.shown.iter().zip(&*DIRECTIONS) {
            let both = direction.dot(*form * direction).max(0.0).sqrt();
            let model = (0.5 * (both - self.vector.dot(direction))).max(0.0);
            let places = shown.places - center * shown.area;
            let heights = shown.heights - shown.vectors.dot(center);
            let outer = product(places, center);
            let squares = shown.squares - outer - outer.transpose() - square(center) * shown.area;
            let along = places.dot(direction);
            let across = (places - direction * along).length();
            let square_along = direction.dot(squares * direction);
            let square_across = squares.x_axis.x + squares.y_axis.y + squares.z_axis.z - square_along;
            // What moves along a lobe's axis, or may in a space of its
            let moved = (heights + 3.0 * along).abs() + 3.0 * across;
            area += weight * (model - shown.area).powi(2);
            first += weight * moved.powi(2);
            second += weight * (6.0 * square_along + 2.0 * square_across).powi(2);
        }
        let mean = 0.25 * self.area;
        let [area, first, second] = [area, first, second].map(|squares| squares.sqrt() / mean);
        if area < error {
            (first + (first * first + 4.0 * error * second).sqrt()) / (2.0 * error)
        } else {
            f64::INFINITY
        }
    }
}

/// Some faces, and how they split.
#[derive(Default)]
struct Node {
    parts: Option<[usize; 2]>,
    cluster: Option<Cluster>,
}

/// Sorts faces so that near ones lie together, and finds clusters of them: the order of the faces, and the
/// clusters.
pub(crate) fn clustered(outlines: &[Outline], error: f64) -> (Vec<usize>, FaceClusters) {
    let faces: Vec<Face> = outlines.iter().map(|outline| Face::new(*outline)).collect();
    let [low, high] = faces.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], face| {
        [low.min(face.middle), high.max(face.middle)]
    });
    let turn = 0.5 * TURN * (high - low).max_element();
    let keys = faces.iter().map(|face| [face.middle, face.vector.normalize_or_zero() * turn]).collect();
    let mut builder = Builder { outlines, faces, keys, error, nodes: vec![] };
    let mut order: Vec<usize> = (0..outlines.len()).collect();
    let mut clusters = FaceClusters { error, clusters: vec![] };
    if !order.is_empty() {
        let (root, _) = builder.node(&mut order, 0);
        builder.collect(root, f64::INFINITY, &mut clusters.clusters);
    }
    (order, clusters)
}

struct Builder<'a> {
    outlines: &'a [Outline<'a>],
    faces: Vec<Face>,
    /// What faces are sorted by: places, and normals on their scale.
    keys: Vec<[DVec3; 2]>,
    error: f64,
    nodes: Vec<Node>,
}

impl Builder<'_> {
    /// The node of the faces of `order`, which begin at `first` of all.
    fn node(&mut self, order: &mut [usize], first: usize) -> (usize, Sums) {
        let (parts, sums) = if let [face] = *order {
            (None, Sums::new(&self.faces[face]))
        } else {
            let middle = self.split(order);
            let (before, after) = order.split_at_mut(middle);
            let (left, left_sums) = self.node(before, first);
            let (right, right_sums) = self.node(after, first + middle);
            (Some([left, right]), left_sums.add(&right_sums))
        };
        let cluster = if order.len() < FEWEST { None } else { self.cluster(order, first, &sums) };
        self.nodes.push(Node { parts, cluster });
        (self.nodes.len() - 1, sums)
    }

    /// Sorts faces by halves along the widest axis, of places or normals; how many are in the first.
    fn split(&self, order: &mut [usize]) -> usize {
        let along = |axis: usize, face: usize| self.keys[face][axis / 3][axis % 3];
        let extent = |axis: usize| {
            let ends = order.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &face| {
                [low.min(along(axis, face)), high.max(along(axis, face))]
            });
            ends[1] - ends[0]
        };
        let axis = (0..6).max_by(|a, b| extent(*a).total_cmp(&extent(*b))).unwrap_or(0);
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&a, &b| {
            along(axis, a).total_cmp(&along(axis, b)).then(a.cmp(&b))
        });
        middle
    }

    fn cluster(&self, order: &[usize], first: usize, sums: &Sums) -> Option<Cluster> {
        let center = sums.places / sums.area;
        let form = sums.form();
        let vertices = order.iter().flat_map(|face| self.outlines[*face].0);
        let radius = vertices.map(|vertex| vertex.distance(center)).fold(0.0, f64::max);
        let distance = sums.distance(center, &form, self.error).max(LEAST * radius);
        (distance.is_finite() && radius > 0.0).then_some(Cluster {
            first,
            end: first + order.len(),
            rows: order.iter().map(|face| 1 + self.outlines[*face].0.len()).sum(),
            center,
            area: sums.area,
            vector: sums.vector,
            form,
            radius,
            distance,
        })
    }

    /// Adds the clusters of a node that serve from nearer than `distance`, each before its parts.
    fn collect(&mut self, node: usize, distance: f64, clusters: &mut Vec<Cluster>) {
        let Node { parts, cluster } = std::mem::take(&mut self.nodes[node]);
        let cluster = cluster.filter(|cluster| cluster.distance < CLOSER * distance);
        let (place, least) = (clusters.len(), cluster.as_ref().map_or(distance, |cluster| cluster.distance));
        let serves = cluster.is_some();
        clusters.extend(cluster);
        for part in parts.into_iter().flatten() {
            self.collect(part, least, clusters);
        }
        if serves {
            clusters[place].rows += ROWS * (clusters.len() - place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light_shape::area_of;
    use crate::{Light, LightShape, PackedLights};
    use glam::{DAffine3, DQuat};

    /// A closed cylinder of `sides` sides and `rings` rings of quads, of length and radius 1.
    fn cylinder(sides: usize, rings: usize) -> LightShape {
        let mut shape = LightShape::default();
        let at = |side: usize, ring: usize| {
            let turn = std::f64::consts::TAU * (side % sides) as f64 / sides as f64;
            DVec3::new(turn.cos(), turn.sin(), ring as f64 / rings as f64)
        };
        for (side, ring) in (0..sides).flat_map(|side| (0..rings).map(move |ring| (side, ring))) {
            let corners = [(side, ring), (side + 1, ring), (side + 1, ring + 1), (side, ring + 1)];
            shape.add_face(&corners.map(|(side, ring)| at(side, ring)));
        }
        shape
    }

    /// What a mesh shows along a direction from a cluster's rows, and by its faces.
    fn shown(cluster: &Cluster, shape: &LightShape, direction: DVec3) -> [f64; 2] {
        let both = direction.dot(cluster.form * direction).sqrt();
        let faces: Vec<f64> = shape.outlines().map(|face| area_of(face).dot(direction)).collect();
        let of = |range: std::ops::Range<usize>| faces[range].iter().map(|area| (-area).max(0.0)).sum();
        [0.5 * (both - cluster.vector.dot(direction)), of(cluster.first..cluster.end)]
    }

    #[test]
    fn a_form_is_exact_for_tubes_and_what_is_flat_and_off_for_boxes() {
        let tube = cylinder(64, 4).clustered(0.05);
        let [low, high] = [0.0, 1.0];
        let flat = |x: f64| [[x, low], [x + 1.0, low], [x + 1.0, high], [x, high]];
        let mut sign = LightShape::default();
        for x in [0.0, 1.0, 2.0, 5.0] {
            sign.add_face(&flat(x).map(|[x, y]| DVec3::new(x, y, 0.1 * x)));
        }
        let sign = sign.clustered(0.05);
        for (shape, most) in [(tube, 1e-3), (sign, 1e-12)] {
            let cluster = &shape.clusters().clusters[0];
            assert_eq!((cluster.first, cluster.end), (0, shape.faces().len()));
            for (direction, _) in &*DIRECTIONS {
                let [found, exact] = shown(cluster, &shape, *direction);
                assert!((found - exact).abs() < most, "{direction}: {found}, {exact}");
            }
        }
        // The twin: four sides have no such form, so that their cluster serves from nowhere
        let prism = cylinder(4, 8).clustered(0.05);
        assert!(prism.clusters().clusters.iter().all(|cluster| cluster.end - cluster.first < 32));
    }

    #[test]
    fn rows_of_clusters_count_what_is_in_them() {
        let light = Light { shape: cylinder(32, 32).clustered(0.05), ..Light::default() };
        let packed = PackedLights::new(&[light], DVec3::ZERO).unwrap();
        let rows = &packed.vertices;
        let (mut row, mut faces, mut ends) = (0, 0, vec![rows.len()]);
        while row < rows.len() {
            ends.retain(|end| *end > row);
            if rows[row][3] < 0.0 {
                let end = row + (-rows[row][3]) as usize;
                assert!(end <= ends[ends.len() - 1], "each is within the one before");
                ends.push(end);
                row += ROWS;
            } else {
                assert_eq!(rows[row][3], 4.0);
                (row, faces) = (row + 5, faces + 1);
            }
        }
        assert_eq!((row, faces), (rows.len(), 1024));
        assert_eq!(packed.vertex_rows(&packed.lights[0]).len(), 4096);
        assert!(rows.len() > 5 * 1024 + 100 * ROWS, "there are clusters");
    }

    #[test]
    fn clusters_follow_a_mesh_and_none_are_made_of_what_is_none() {
        let shape = cylinder(16, 16).clustered(0.05);
        let count = shape.clusters().clusters.len();
        let by = DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), DQuat::IDENTITY, DVec3::X);
        let (moved, cluster) = (shape.moved(&by), shape.clusters().clusters[0].clone());
        assert_eq!(moved.clusters().clusters.len(), count);
        let twice = &moved.clusters().clusters[0];
        assert!((twice.distance / cluster.distance - 2.0).abs() < 1e-9);
        // Vertices that change leave none behind
        let mut changed = shape.clone();
        assert_eq!(changed.vertices_mut().len(), 1024);
        assert_eq!(changed.clusters(), &FaceClusters::default());
        // What is no mesh, or none that can be shaded, stays as it is, to be refused by name
        let nan = LightShape::mesh(vec![DVec3::NAN; 32], vec![4; 8]);
        assert_eq!(nan.clone().clustered(0.05).vertices().len(), 32);
        for shape in
            [LightShape::mesh(vec![DVec3::ONE; 32], vec![4; 8]), LightShape::mesh(vec![], vec![1; 8])]
        {
            assert_eq!(shape.clone().clustered(0.05).clusters().clusters.len(), 0);
        }
        for error in [f64::NAN, -1.0, 0.0] {
            assert_eq!(cylinder(16, 16).clustered(error).clusters().clusters.len(), 0);
        }
    }
}
