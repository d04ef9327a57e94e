//! The form factor of a polygon's rounded numbers, taken as exact: clipped at the horizon and summed edge by
//! edge (Baum et al. 1989), in any type of [`Number`].

use super::double::Number;
use std::f64::consts::TAU;

/// A vector of numbers.
pub type Vector<T> = [T; 3];

/// What the edges of a polygon add up to.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeSum<T> {
    /// 2 pi times the signed form factor, which is positive where the front faces the origin.
    pub sum: T,
    /// The distance from the origin to the nearest of the clipped polygon's edges, those along the horizon
    /// included; infinite where nothing is above the horizon.
    pub nearest_edge: f64,
    /// How often the outline goes below the horizon.
    pub exits: usize,
}

impl<T: Number> EdgeSum<T> {
    /// The signed form factor, in [-1, 1] for a polygon that does not overlap itself.
    pub fn signed_form_factor(&self) -> f64 {
        self.sum.round() / TAU
    }
}

/// A vertex in two parts: as an offset from the anchor, and as a position. Edges are differences of offsets,
/// so that those of a small, far polygon keep their digits.
#[derive(Debug, Clone, Copy)]
struct Vertex<T> {
    offset: Vector<T>,
    position: Vector<T>,
}

fn map<T: Copy>(a: Vector<T>, b: Vector<T>, function: impl Fn(T, T) -> T) -> Vector<T> {
    [function(a[0], b[0]), function(a[1], b[1]), function(a[2], b[2])]
}

fn dot<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn absolute<T: Number>(a: T) -> T {
    if a < T::ZERO { -a } else { a }
}

/// The sums that become a [`EdgeSum`]; `nearest_square` is the nearest edge's squared distance.
struct Sums<T> {
    sum: T,
    nearest_square: f64,
}

impl<T: Number> Sums<T> {
    /// Adds the edge from `a` to `b`: its angle times the z component of its plane's unit normal.
    fn add_edge(&mut self, a: &Vertex<T>, b: &Vertex<T>) {
        let edge = map(b.offset, a.offset, |b, a| b - a);
        let (a_square, b_square) = (dot(a.position, a.position), dot(b.position, b.position));
        let near = if a_square < b_square { a.position } else { b.position };
        let normal = cross(near, edge);
        let length = dot(normal, normal).square_root();
        let square = dot(edge, edge).round();
        self.nearest_square =
            self.nearest_square.min(nearest_square(a_square, b_square, edge, a, length, square));
        if length.round() == 0.0 {
            return;
        }
        let angle = T::angle(length, dot(a.position, b.position));
        let term = angle * (normal[2] / length);
        self.sum = self.sum - term;
    }
}

/// The squared distance from the origin to an edge.
fn nearest_square<T: Number>(
    a_square: T,
    b_square: T,
    edge: Vector<T>,
    a: &Vertex<T>,
    normal: T,
    square: f64,
) -> f64 {
    let along = -dot(edge, a.position).round();
    if along > 0.0 && along < square {
        normal.round().powi(2) / square
    } else {
        a_square.round().min(b_square.round())
    }
}

/// Where the edge from `a` to `b` meets the horizon, one end being above it and the other not.
fn horizon_point<T: Number>(a: &Vertex<T>, b: &Vertex<T>) -> Vertex<T> {
    let (z_a, z_b) = (a.position[2], b.position[2]);
    let (near, far) = if absolute(z_a) < absolute(z_b) { (a, b) } else { (b, a) };
    let part = near.position[2] / (near.position[2] - far.position[2]);
    let to_far = map(far.offset, near.offset, |far, near| far - near);
    let step = [part * to_far[0], part * to_far[1], -near.position[2]];
    let mut position = map(near.position, step, |a, b| a + b);
    position[2] = T::ZERO;
    Vertex { offset: map(near.offset, step, |a, b| a + b), position }
}

/// Sums its edges of `anchor + offset`. What lies below z = 0 is clipped, a vertex at z = 0 counts as
/// below; the outline is closed along the horizon from where it goes down to where it next comes up.
pub fn sum_edges<T: Number>(anchor: [f64; 3], offsets: &[[f64; 3]]) -> EdgeSum<T> {
    let vertex = |offset: &[f64; 3]| Vertex {
        offset: offset.map(T::exact),
        position: [0, 1, 2].map(|i| T::sum(anchor[i], offset[i])),
    };
    let mut sums = Sums { sum: T::ZERO, nearest_square: f64::INFINITY };
    let (mut exit, mut first_entry, mut exits) = (None, None, 0);
    let mut previous = offsets.last().map(&vertex);
    for offset in offsets {
        let to = vertex(offset);
        let Some(from) = previous.replace(to) else { continue };
        let above = |vertex: &Vertex<T>| vertex.position[2] > T::ZERO;
        match (above(&from), above(&to)) {
            (false, false) => {}
            (true, true) => sums.add_edge(&from, &to),
            (true, false) => {
                let point = horizon_point(&from, &to);
                sums.add_edge(&from, &point);
                exit = Some(point);
                exits += 1;
            }
            (false, true) => {
                let point = horizon_point(&from, &to);
                match &exit {
                    Some(exit) => sums.add_edge(exit, &point),
                    None => first_entry = Some(point),
                }
                sums.add_edge(&point, &to);
            }
        }
    }
    if let (Some(exit), Some(entry)) = (&exit, &first_entry) {
        sums.add_edge(exit, entry);
    }
    EdgeSum { sum: sums.sum, nearest_edge: sums.nearest_square.sqrt(), exits }
}
