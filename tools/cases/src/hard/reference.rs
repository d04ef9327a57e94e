//! The truth about one hard case, and how near to contact it is.

use super::HardCase;
use super::double::Double;
use super::edges::sum_edges;
use super::promise::{MOVE, SMALL};
use glam::DVec3;
use std::f64::consts::PI;

/// What the small lights' promise is a millionth of, over what moving a vertex of four units in the last
/// place does.
const PER_AREA: f64 = MOVE / 1e-6;

/// A case's form factor in 106 bits, and what bounds are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// What the polygon sends from either side, in [0, 1].
    pub form_factor: f64,
    /// The distance to the polygon as a part of that to its farthest vertex, in [0, 1].
    pub rho: f64,
    /// The distance to the polygon.
    pub distance: f64,
    /// The polygon's area.
    pub area: f64,
    /// area / (pi distance²) of a light that is small, see [`SMALL`]. Of a sliver,
    /// the area that four units in the last place of its offsets are a millionth of: no better is its area
    /// known.
    pub small_light_unit: Option<f64>,
    /// How many times as far as its farthest vertex is from its anchor the polygon is.
    pub extents_away: f64,
    /// Whether every vertex is above the horizon.
    pub is_above: bool,
}

impl Reference {
    /// Sums its edges in 106 bits. Vertices must be finite.
    pub fn new(case: &HardCase) -> Self {
        Self::with_closings(case).0
    }

    /// As [`Reference::new`], and the form factors that are as right: those of the polygon whose parts below
    /// the horizon are closed the other way around. An outline that is not flat and goes below more than once
    /// bounds regions that differ by whole hemispheres, and no edge tells which is meant. Flat ones are flat
    /// but for their rounding, which matters where the point lies in their plane.
    pub fn with_closings(case: &HardCase) -> (Self, Vec<f64>) {
        let (anchor, offsets) = (case.anchor.map(f64::from), case.offsets_exactly());
        let edges = sum_edges::<Double>(anchor, &offsets);
        let offsets: Vec<DVec3> = offsets.iter().map(|offset| DVec3::from_array(*offset)).collect();
        let anchor = DVec3::from_array(anchor);

        // Newell's normal: its length is twice the area
        let next = |i: usize| offsets[(i + 1) % offsets.len()];
        let pivot = offsets.first().copied().unwrap_or_default();
        let doubled: DVec3 = (0..offsets.len()).map(|i| (offsets[i] - pivot).cross(next(i) - pivot)).sum();

        // The nearest point is inside of the outline, on it, or where it was clipped
        let mut distance = f64::INFINITY;
        for (i, offset) in offsets.iter().enumerate() {
            distance = distance.min(distance_to_segment(anchor + *offset, next(i) - *offset));
        }
        if let Some(normal) = doubled.try_normalize()
            && winds_around(&offsets, anchor, normal)
        {
            let plane = offsets.iter().map(|o| normal.dot(anchor + *o).abs()).fold(f64::INFINITY, f64::min);
            distance = distance.min(plane);
        }
        if !case.flat {
            distance = distance.min(edges.nearest_edge);
        }

        let farthest = offsets.iter().map(|o| (anchor + *o).length()).fold(0.0, f64::max);
        let extent = offsets.iter().map(|o| o.length()).fold(0.0, f64::max);
        let area = 0.5 * doubled.length();
        // A vertex of four units in the last place moves the area by so much along each edge
        let perimeter: f64 = (0..offsets.len()).map(|i| (next(i) - offsets[i]).length()).sum();
        let small_area = area.max(PER_AREA * extent * perimeter);
        let signed = edges.signed_form_factor();
        let in_plane = edges.nearest_edge < 4.0 * MOVE * farthest;
        let ambiguous = edges.exits > 1 && (!case.flat || in_plane);
        let closings = if ambiguous { other_closings(signed) } else { Vec::new() };
        let reference = Self {
            form_factor: signed.abs().min(1.0),
            rho: if farthest > 0.0 { distance / farthest } else { 0.0 },
            distance,
            area,
            small_light_unit: (extent < SMALL * farthest).then(|| small_area / (PI * distance * distance)),
            extents_away: distance / extent,
            is_above: offsets.iter().all(|offset| (anchor + *offset).z > 0.0),
        };
        (reference, closings)
    }
}

/// The form factors that differ by whole hemispheres from `signed`.
fn other_closings(signed: f64) -> Vec<f64> {
    let shifted = [signed + 1.0, signed - 1.0];
    shifted.into_iter().map(f64::abs).filter(|value| *value <= 1.0).collect()
}

/// The distance from the origin to the segment from `start` along `edge`.
fn distance_to_segment(start: DVec3, edge: DVec3) -> f64 {
    let square = edge.length_squared();
    if square == 0.0 {
        return start.length();
    }
    let part = (-start.dot(edge) / square).clamp(0.0, 1.0);
    if part > 0.0 && part < 1.0 {
        // The height of the triangle: its error is relative to the nearer end
        let end = start + edge;
        let near = if start.length_squared() < end.length_squared() { start } else { end };
        near.cross(edge).length() / square.sqrt()
    } else if part == 0.0 {
        start.length()
    } else {
        (start + edge).length()
    }
}

/// Whether the outline winds around the origin's projection along `normal`.
fn winds_around(offsets: &[DVec3], anchor: DVec3, normal: DVec3) -> bool {
    let (x, y) = normal.any_orthonormal_pair();
    let flat: Vec<[f64; 2]> = offsets.iter().map(|o| [x.dot(anchor + *o), y.dot(anchor + *o)]).collect();
    // Count the crossings of a ray along x, up and down
    let mut winding = 0;
    for (i, a) in flat.iter().enumerate() {
        let b = flat[(i + 1) % flat.len()];
        let side = a[0] * b[1] - a[1] * b[0];
        if a[1] <= 0.0 && b[1] > 0.0 && side > 0.0 {
            winding += 1;
        } else if a[1] > 0.0 && b[1] <= 0.0 && side < 0.0 {
            winding -= 1;
        }
    }
    winding != 0
}
