//! Outlines in the plane, within about a unit of the origin, and how they are put into space.

use super::HardCase;
use super::stream::Stream;
use glam::DVec3;

/// A plane outline.
pub type Outline = Vec<[f64; 2]>;

/// A rectangle of half sides up to 1, centred.
pub fn rectangle(stream: &mut Stream) -> Outline {
    let (a, b) = (stream.between(0.1, 1.0), stream.between(0.1, 1.0));
    vec![[-a, -b], [a, -b], [a, b], [-a, b]]
}

/// A convex polygon of 3 to 8 vertices on an ellipse.
pub fn convex(stream: &mut Stream) -> Outline {
    let count = 3 + stream.below(6);
    let squeeze = stream.between(0.2, 1.0);
    let mut points: Outline = (0..count).map(|_| stream.circle()).collect();
    points.sort_by(by_angle);
    points.iter().map(|[x, y]| [*x, *y * squeeze]).collect()
}

/// Counter-clockwise order about the origin, beginning at the negative x axis.
fn by_angle(a: &[f64; 2], b: &[f64; 2]) -> std::cmp::Ordering {
    let lower = |p: &[f64; 2]| p[1] >= 0.0;
    let side = b[0] * a[1] - b[1] * a[0];
    lower(a).cmp(&lower(b)).then(side.partial_cmp(&0.0).unwrap_or(std::cmp::Ordering::Equal))
}

/// A rectangle or a convex polygon.
pub fn plain(stream: &mut Stream) -> Outline {
    if stream.one_in(2) { rectangle(stream) } else { convex(stream) }
}

/// A star, an L, a U or a comb: all concave.
pub fn concave(stream: &mut Stream) -> Outline {
    match stream.below(4) {
        0 => star(stream),
        1 => {
            let (a, b) = (stream.between(-0.8, 0.8), stream.between(-0.8, 0.8));
            vec![[-1.0, -1.0], [1.0, -1.0], [1.0, b], [a, b], [a, 1.0], [-1.0, 1.0]]
        }
        2 => u(stream),
        _ => comb(stream),
    }
}

/// A star of 3 to 8 points.
pub fn star(stream: &mut Stream) -> Outline {
    let points = 2 * (3 + stream.below(6));
    let inner = stream.between(0.1, 0.6);
    let mut outline: Outline = (0..points).map(|_| stream.circle()).collect();
    outline.sort_by(by_angle);
    let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { inner };
    outline.iter().enumerate().map(|(i, p)| p.map(|c| c * radius(i))).collect()
}

/// A U whose gap holds the origin.
pub fn u(stream: &mut Stream) -> Outline {
    let (a, b) = (stream.between(0.1, 0.7), stream.between(0.1, 0.7));
    vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [a, 1.0], [a, -b], [-a, -b], [-a, 1.0], [-1.0, 1.0]]
}

/// A comb of 2 to 6 teeth that point up.
pub fn comb(stream: &mut Stream) -> Outline {
    let teeth = 2 + stream.below(5);
    let pitch = 2.0 / teeth as f64;
    let mut outline = vec![[-1.0, -1.0]];
    let mut root = -1.0;
    for tooth in (0..teeth).rev() {
        let left = -1.0 + pitch * tooth as f64;
        let right = left + pitch * stream.between(0.3, 0.7);
        outline.extend([[right, root], [right, 1.0], [left, 1.0]]);
        // The gap to the next tooth, unless this is the last
        root = stream.between(-0.9, 0.5);
        if tooth > 0 {
            outline.push([left, root]);
        }
    }
    outline
}

/// A regular polygon of 64 vertices whose radii differ by up to `rough`.
pub fn many(stream: &mut Stream, rough: f64) -> Outline {
    // Turn a vector by a sixty-fourth of a circle again and again: 1e-15 is lost, before the case is rounded
    const COSINE: f64 = 0.9951847266721969;
    const SINE: f64 = 0.0980171403295606;
    let mut turn = [1.0, 0.0];
    (0..64)
        .map(|_| {
            turn = [turn[0] * COSINE - turn[1] * SINE, turn[0] * SINE + turn[1] * COSINE];
            let radius = 1.0 - rough * stream.unit();
            turn.map(|c| c * radius)
        })
        .collect()
}

/// A place in space for an outline: its origin and the directions of its axes, with their lengths.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub origin: DVec3,
    pub x: DVec3,
    pub y: DVec3,
}

impl Place {
    /// An outline scaled by `size`, in the plane across `normal` through `origin`, turned at random.
    pub fn across(stream: &mut Stream, origin: DVec3, normal: DVec3, size: f64) -> Self {
        let (x, y) = normal.any_orthonormal_pair();
        let [cos, sin] = stream.circle();
        Self { origin, x: (x * cos + y * sin) * size, y: (y * cos - x * sin) * size }
    }

    /// A point of the outline's plane, relative to the origin of the place.
    pub fn offset(&self, point: [f64; 2]) -> DVec3 {
        self.x * point[0] + self.y * point[1]
    }

    /// The outline's vertices, rounded to float32.
    pub fn polygon(&self, outline: &[[f64; 2]]) -> HardCase {
        polygon(outline.iter().map(|point| self.origin + self.offset(*point)))
    }

    /// The same as offsets from the place's origin, which is the anchor; each part rounded by itself.
    pub fn anchored(&self, outline: &[[f64; 2]]) -> HardCase {
        let offsets = outline.iter().map(|point| self.offset(*point).as_vec3().to_array()).collect();
        HardCase { anchor: self.origin.as_vec3().to_array(), offsets, flat: true }
    }
}

/// A flat polygon of vertices, rounded to float32.
pub fn polygon(vertices: impl IntoIterator<Item = DVec3>) -> HardCase {
    let offsets = vertices.into_iter().map(|v| v.as_vec3().to_array()).collect();
    HardCase { anchor: [0.0; 3], offsets, flat: true }
}
