//! Adaptive cubature of any integrand over a polygon, in solid angle: the method that does not know of the
//! closed forms, to check them with, and to integrate what has none.
//!
//! The polygon becomes a signed fan of triangles, so that concave outlines need no care. The caller says how
//! long the edges of a triangle are in units of the integrand's own scale; triangles are bisected until they
//! are small for their distance and no edge is longer than one such unit, so that a narrow lobe cannot fall
//! between the points of the rule. From there the triangle of the largest error is bisected, across its
//! longest edge in those units, until the sum of the errors is small.
//!
//! The error of a triangle is the difference between a rule of degree 8 and one of degree 5, an estimate of
//! the latter's error: the value is far better, unless the integrand has a feature that the caller's units do
//! not know of.

use crate::polygon::power_of_two_near;
use glam::DVec3;
use std::collections::{BinaryHeap, VecDeque};

mod rules;

pub(crate) use rules::{DEGREE_8, TrianglePoint};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The sum of the triangles' error estimates over the integral, for each component.
    pub relative_tolerance: f64,
    /// Evaluations of the integrand after which the result is returned as it is.
    pub max_evaluations: usize,
}

impl Default for Settings {
    /// Estimates of 1e-6, so errors of about 1e-8; at most four million evaluations.
    fn default() -> Self {
        Self { relative_tolerance: 1e-6, max_evaluations: 4_000_000 }
    }
}

/// An integral with its error estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<const N: usize> {
    /// The integral, a component.
    pub value: [f64; N],
    /// The sum of the triangles' error estimates: much larger than the true error, unless
    /// [`Settings::max_evaluations`] was reached.
    pub error: [f64; N],
    /// How often the integrand was evaluated.
    pub evaluations: usize,
}

impl<const N: usize> Default for Estimate<N> {
    /// The integral of nothing.
    fn default() -> Self {
        Self { value: [0.0; N], error: [0.0; N], evaluations: 0 }
    }
}

/// Signed triangles in space, as the origin sees them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Region {
    triangles: Vec<[DVec3; 3]>,
}

impl Region {
    /// The region of a planar polygon. It counts positively if its front, the right-hand side of its vertex
    /// order, faces the origin, else negatively.
    ///
    /// Fewer than three or non-finite vertices make an empty region.
    pub fn polygon(vertices: &[DVec3]) -> Self {
        let largest = vertices.iter().fold(0.0_f64, |m, v| m.max(v.abs().max_element()));
        if largest == 0.0 || !vertices.iter().all(|v| v.is_finite()) {
            return Self::default();
        }
        // Solid angle knows no scale; cubes of lengths must not overflow
        let scale = power_of_two_near(1.0 / largest);
        let pairs = vertices.get(1..).unwrap_or_default().windows(2);
        let triangle = |pair: &[DVec3]| [vertices[0], pair[0], pair[1]].map(|v| v * scale);
        Self { triangles: pairs.map(triangle).collect() }
    }

    /// Adds the region of a planar polygon, as [`Region::polygon`] makes it. Polygons that share an edge
    /// count it once.
    pub fn extend(&mut self, vertices: &[DVec3]) {
        self.triangles.extend(Self::polygon(vertices).triangles);
    }

    /// Every direction once: the faces of a box around the origin.
    pub fn sphere() -> Self {
        let mut triangles = Vec::new();
        for (axis, u, v) in
            [(DVec3::X, DVec3::Y, DVec3::Z), (DVec3::Y, DVec3::Z, DVec3::X), (DVec3::Z, DVec3::X, DVec3::Y)]
        {
            for sign in [-1.0, 1.0] {
                let corner = |a: f64, b: f64| axis * sign + u * a + v * (b * sign);
                let face = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
                triangles.extend(Self::polygon(&face).triangles);
            }
        }
        Self { triangles }
    }

    /// The directions with `normal · direction >= 0` of this region.
    #[must_use]
    pub fn clipped(&self, normal: DVec3) -> Self {
        let mut triangles = Vec::new();
        for triangle in &self.triangles {
            triangles.extend(Self::polygon(&clip_triangle(triangle, normal)).triangles);
        }
        Self { triangles }
    }

    /// The same region with every triangle cut along the plane `normal · p = 0`: a ridge of the integrand
    /// that lies there then runs along edges, and a few long triangles follow it instead of many small ones.
    #[must_use]
    pub fn cut(&self, normal: DVec3) -> Self {
        let [mut above, below] = [normal, -normal].map(|side| self.clipped(side));
        above.triangles.extend(below.triangles);
        above
    }

    /// Integrates `integrand`, a function of unit directions, over this region's solid angle.
    ///
    /// `lengths` gives the edges ab, bc and ca of a triangle in units of the scale on which the integrand
    /// varies there: [`angles`] for one that varies slowly over the sphere, `angles / width` for a lobe, and
    /// best a measure that follows the lobe's shape.
    pub fn integrate<const N: usize>(
        &self,
        settings: &Settings,
        lengths: impl Fn(&[DVec3; 3]) -> [f64; 3],
        integrand: impl Fn(DVec3) -> [f64; N],
    ) -> Estimate<N> {
        let triangles =
            split_until_resolved(&self.triangles, settings.max_evaluations / (2 * POINTS), &lengths);
        let pieces = triangles.into_iter().map(|triangle| Piece::new(triangle, &integrand)).collect();
        refine(pieces, settings, &lengths, &integrand)
    }
}

/// The chords between the directions of a triangle's corners, of the edges ab, bc and ca: about the angles
/// that they span.
pub fn angles(triangle: &[DVec3; 3]) -> [f64; 3] {
    edges(&triangle.map(DVec3::normalize_or_zero))
}

/// The lengths of the edges ab, bc and ca.
pub(crate) fn edges([a, b, c]: &[DVec3; 3]) -> [f64; 3] {
    [a.distance(*b), b.distance(*c), c.distance(*a)]
}

/// Evaluations a triangle: 16 and 7 points, the centroid is one of both.
const POINTS: usize = 22;

/// Bisections after which a triangle is taken as it is: 2^-60 of the polygon's size.
const MAX_DEPTH: usize = 120;

/// Bisects triangles until each is not larger than half its distance from the origin, and no edge is longer
/// than one by `lengths`; or until there are `max_triangles`.
fn split_until_resolved(
    triangles: &[[DVec3; 3]],
    max_triangles: usize,
    lengths: &impl Fn(&[DVec3; 3]) -> [f64; 3],
) -> Vec<[DVec3; 3]> {
    // A triangle whose plane holds the origin has no solid angle
    let seen = triangles.iter().filter(|triangle| volume(triangle) != 0.0);
    let mut queue: VecDeque<([DVec3; 3], usize)> = seen.map(|triangle| (*triangle, 0)).collect();
    let mut done = Vec::new();
    while let Some((triangle, depth)) = queue.pop_front() {
        // As long as it is large, look at its size; then at what the integrand sees
        let size = edges(&triangle);
        let large = longest(size) > 0.5 * distance_to_origin(&triangle);
        let measure = if large { size } else { lengths(&triangle) };
        let full = done.len() + queue.len() >= max_triangles;
        if depth >= MAX_DEPTH || full || (!large && longest(measure) <= 1.0) {
            done.push(triangle);
        } else {
            queue.extend(bisect(&triangle, measure).map(|half| (half, depth + 1)));
        }
    }
    done
}

/// Bisects the piece of the largest error until the sum of errors meets the tolerance.
fn refine<const N: usize>(
    pieces: Vec<Piece<N>>,
    settings: &Settings,
    lengths: &impl Fn(&[DVec3; 3]) -> [f64; 3],
    integrand: &impl Fn(DVec3) -> [f64; N],
) -> Estimate<N> {
    let mut evaluations = pieces.len() * POINTS;
    let (mut value, mut error) = totals(&pieces);
    // Errors of different components are compared as shares of the first estimate of each
    let share = value.map(|v| if v == 0.0 { 1.0 } else { 1.0 / v.abs() });
    let ranked = |piece: Piece<N>| {
        let priority = (0..N).map(|i| piece.error[i] * share[i]).fold(0.0, f64::max);
        Ranked { priority, piece }
    };
    let mut heap: BinaryHeap<Ranked<N>> = pieces.into_iter().map(ranked).collect();
    while evaluations < settings.max_evaluations
        && (0..N).any(|i| error[i] > settings.relative_tolerance * value[i].abs())
    {
        let Some(worst) = heap.pop() else { break };
        if worst.priority == 0.0 {
            heap.push(worst);
            break;
        }
        let triangle = &worst.piece.triangle;
        let halves = bisect(triangle, lengths(triangle)).map(|half| Piece::new(half, integrand));
        for i in 0..N {
            value[i] += halves[0].value[i] + halves[1].value[i] - worst.piece.value[i];
            error[i] += halves[0].error[i] + halves[1].error[i] - worst.piece.error[i];
        }
        heap.extend(halves.map(ranked));
        evaluations += 2 * POINTS;
    }
    // Sum again: the running sums have gathered rounding errors
    let pieces: Vec<Piece<N>> = heap.into_iter().map(|ranked| ranked.piece).collect();
    let (value, error) = totals(&pieces);
    Estimate { value, error, evaluations }
}

fn totals<const N: usize>(pieces: &[Piece<N>]) -> ([f64; N], [f64; N]) {
    let mut value = [0.0; N];
    let mut error = [0.0; N];
    for piece in pieces {
        for i in 0..N {
            value[i] += piece.value[i];
            error[i] += piece.error[i];
        }
    }
    (value, error)
}

/// A triangle with the integral over it.
struct Piece<const N: usize> {
    triangle: [DVec3; 3],
    value: [f64; N],
    error: [f64; N],
}

impl<const N: usize> Piece<N> {
    fn new(triangle: [DVec3; 3], integrand: &impl Fn(DVec3) -> [f64; N]) -> Self {
        // Solid angle of an element of area: -n·p / |p|³ dA, where -n·p dA is one number for the triangle
        let half_volume = 0.5 * volume(&triangle);
        let sample = |point: &TrianglePoint| {
            let p = point.interpolate(&triangle);
            let length = p.length();
            let density = half_volume / (length * length * length);
            integrand(p / length).map(|v| v * density)
        };
        let mut high = [0.0; N];
        let mut low = [0.0; N];
        let center = sample(&DEGREE_8[0]);
        for i in 0..N {
            high[i] += center[i] * DEGREE_8[0].weight;
            low[i] += center[i] * rules::DEGREE_5_CENTER;
        }
        for point in &DEGREE_8[1..] {
            let sampled = sample(point);
            (0..N).for_each(|i| high[i] += sampled[i] * point.weight);
        }
        for point in &rules::DEGREE_5 {
            let sampled = sample(point);
            (0..N).for_each(|i| low[i] += sampled[i] * point.weight);
        }
        let error = std::array::from_fn(|i| (high[i] - low[i]).abs());
        Self { triangle, value: high, error }
    }
}

/// A piece in the queue: the largest priority comes out first.
struct Ranked<const N: usize> {
    priority: f64,
    piece: Piece<N>,
}

impl<const N: usize> PartialEq for Ranked<N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<const N: usize> Eq for Ranked<N> {}

impl<const N: usize> PartialOrd for Ranked<N> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> Ord for Ranked<N> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.priority.total_cmp(&other.priority)
    }
}

/// Twice the area times the distance of the plane from the origin, positive if the front faces it.
fn volume([a, b, c]: &[DVec3; 3]) -> f64 {
    // The nearest corner is the pivot: it has the smallest rounding error
    let nearest =
        [a, b, c].into_iter().fold(a, |n, p| if p.length_squared() < n.length_squared() { p } else { n });
    -(*b - *a).cross(*c - *a).dot(*nearest)
}

fn longest(lengths: [f64; 3]) -> f64 {
    lengths[0].max(lengths[1]).max(lengths[2])
}

/// Halves a triangle at the middle of the edge of the largest measure. Orientation is kept.
fn bisect(triangle: &[DVec3; 3], measure: [f64; 3]) -> [[DVec3; 3]; 2] {
    let longest = (1..3).fold(0, |best, i| if measure[i] > measure[best] { i } else { best });
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(longest + i) % 3]);
    let middle = (a + b) * 0.5;
    [[a, middle, c], [middle, b, c]]
}

/// The part of a triangle with `normal · p >= 0`: none, three or four corners.
fn clip_triangle(triangle: &[DVec3; 3], normal: DVec3) -> Vec<DVec3> {
    let mut clipped = Vec::with_capacity(4);
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        let (height_a, height_b) = (normal.dot(a), normal.dot(b));
        if height_a >= 0.0 {
            clipped.push(a);
        }
        if height_a * height_b < 0.0 {
            let crossing = a.lerp(b, height_a / (height_a - height_b));
            // Land on the plane, also after rounding
            clipped.push(crossing - normal * (normal.dot(crossing) / normal.length_squared()));
        }
    }
    clipped
}

/// The distance from the origin to the nearest point of a triangle.
pub(crate) fn distance_to_origin(triangle: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *triangle;
    let normal = (b - a).cross(c - a);
    let inside = |p: DVec3, q: DVec3| normal.dot((q - p).cross(-p)) >= 0.0;
    if normal != DVec3::ZERO && inside(a, b) && inside(b, c) && inside(c, a) {
        return a.dot(normal).abs() / normal.length();
    }
    let to_edge = |p: DVec3, q: DVec3| {
        let along = q - p;
        let t = (-p.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p + along * t).length()
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_sphere_and_its_parts_have_their_solid_angles() {
        let settings = Settings::default();
        let angle = |region: &Region| region.integrate(&settings, angles, |_| [1.0]).value[0];
        // errors are far below the estimates that the tolerance of 1e-6 is for
        assert!((angle(&Region::sphere()) - 4.0 * PI).abs() < 1e-8);
        let lune = Region::sphere().clipped(DVec3::X).clipped(DVec3::new(-1.0, 1.0, 0.0));
        assert!((angle(&lune) - PI / 2.0).abs() < 1e-8);
        let octant = [DVec3::X, DVec3::Z, DVec3::Y];
        assert!((angle(&Region::polygon(&octant)) - PI / 2.0).abs() < 1e-8);
        let reversed = [DVec3::X, DVec3::Y, DVec3::Z];
        assert!((angle(&Region::polygon(&reversed)) + PI / 2.0).abs() < 1e-8);
    }

    #[test]
    fn a_lobe_is_missed_unless_the_caller_says_that_it_is_narrow() {
        // A lobe of a millionth of a radian, off every point of the unrefined rule
        let axis = DVec3::new(0.2, 0.3, 1.0).normalize_or(DVec3::Z);
        let width = 1e-6;
        let lobe = |w: DVec3| [(-(w - axis).length_squared() / (width * width)).exp() / (PI * width * width)];
        let square = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
        let region = Region::polygon(&square);
        let lengths = |t: &[DVec3; 3]| {
            let around = t.map(|p| p.normalize_or_zero() - axis);
            edges(&around).map(|length| length / (width + distance_to_origin(&around)))
        };
        let found = region.integrate(&Settings::default(), lengths, lobe).value[0];
        assert!((found - 1.0).abs() < 1e-7, "{found}");
        assert_eq!(region.integrate(&Settings::default(), angles, lobe).value[0], 0.0, "the twin");
    }

    #[test]
    fn the_limit_on_evaluations_holds_and_shows_in_the_error() {
        let settings = Settings { relative_tolerance: 1e-12, max_evaluations: 20_000 };
        let jump = |w: DVec3| [if w.x + 0.3 * w.y > 0.123 { 1.0 } else { 0.0 }];
        let estimate = Region::sphere().integrate(&settings, angles, jump);
        assert!(estimate.evaluations <= 20_000 + 2 * POINTS);
        assert!(estimate.error[0] > 1e-9 && (estimate.value[0] - 2.0 * PI).abs() < 1.0, "{estimate:?}");
        // An integrand that is resolved nowhere ends as well
        let estimate = Region::sphere().integrate(&settings, |_| [f64::INFINITY; 3], |_| [1.0]);
        assert!((estimate.value[0] - 4.0 * PI).abs() < 1e-4);
    }

    #[test]
    fn distances_to_a_triangle_are_right_at_faces_edges_and_corners() {
        let at = |x: f64, y: f64, z: f64| {
            [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| corner - DVec3::new(x, y, z))
        };
        for (point, distance) in [
            ([0.25, 0.25, 2.0], 2.0),
            ([0.5, -3.0, 0.0], 3.0),
            ([-3.0, -4.0, 0.0], 5.0),
            ([1.0, 1.0, 0.0], 0.5_f64.sqrt()),
            ([0.2, 0.3, 0.0], 0.0),
        ] {
            let [x, y, z] = point;
            assert!((distance_to_origin(&at(x, y, z)) - distance).abs() < 1e-15, "{point:?}");
        }
        assert_eq!(distance_to_origin(&[DVec3::X * 2.0; 3]), 2.0);
    }

    #[test]
    fn regions_of_any_size_have_their_solid_angle() {
        for exponent in [-300, -20, 0, 20, 300] {
            let scale = 10_f64.powi(exponent);
            let octant = [DVec3::X, DVec3::Z, DVec3::Y].map(|v| v * scale);
            let angle = Region::polygon(&octant).integrate(&Settings::default(), angles, |_| [1.0]).value[0];
            assert!((angle - PI / 2.0).abs() < 1e-8, "1e{exponent}: {angle}");
        }
        let bad = [DVec3::X, DVec3::NAN, DVec3::Y];
        assert_eq!(Region::polygon(&bad), Region::default());
    }
}
