//! The values of the polygons nearby: how far a computed value is from all that moving each vertex by
//! [`MOVE`] of its distance can reach. That is the backward error: a result between the values of polygons
//! nearby is as good as the rounding of the vertices allows.
//!
//! Where the point lies on the polygon, its value jumps from one side's to the other's, and what is between
//! counts as reached: there no value is right.
//!
//! [`super::search`] looks for them.

use super::HardCase;
use super::edges::sum_edges;
use super::promise::MOVE;
use super::search::{Movable, Moves};
use glam::DVec3;

/// The values nearby one case.
#[derive(Debug)]
pub struct Nearby {
    vertices: Vec<DVec3>,
    radii: Vec<f64>,
    /// Values that differ by whole hemispheres are as good, see
    /// [`super::reference::Reference::with_closings`].
    ambiguous: bool,
}

impl Nearby {
    /// The polygons nearby a case, whose vertices must be finite.
    pub fn new(case: &HardCase, ambiguous: bool) -> Self {
        let anchor = DVec3::from_array(case.anchor.map(f64::from));
        let vertices: Vec<DVec3> =
            case.offsets_exactly().into_iter().map(|o| anchor + DVec3::from_array(o)).collect();
        // float64 rounds the vertices and the moves, by less than a millionth of them. A vertex at the point
        // itself is in no direction, and so in any
        let farthest = vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        let radius =
            |v: &DVec3| if *v == DVec3::ZERO { 1e-9 * farthest } else { v.length() * MOVE * (1.0 - 1e-6) };
        let radii = vertices.iter().map(radius).collect();
        Self { vertices, radii, ambiguous }
    }

    /// How many vertices the polygon has.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// An upper bound of the distance from `computed`, which is the absolute value of a signed form factor,
    /// to the interval of the values nearby. Stops searching at `enough`.
    pub fn distance(&self, computed: f64, enough: f64) -> f64 {
        super::search::distance(self, computed, enough)
    }
}

impl Movable for Nearby {
    const REFINEMENTS: i32 = 200;
    const STEPS: usize = 4;

    fn vectors(&self) -> usize {
        self.vertices.len()
    }

    /// The signed form factor of a polygon nearby, in float64: its error is 1e-16 over rho, and where rho is
    /// smaller than [`MOVE`], that of a polygon that is nearby too.
    fn value(&self, moves: &[DVec3]) -> f64 {
        let moved = self.vertices.iter().zip(&self.radii).zip(moves);
        let vertices: Vec<[f64; 3]> = moved.map(|((v, radius), m)| (*v + *m * *radius).to_array()).collect();
        sum_edges::<f64>([0.0; 3], &vertices).signed_form_factor().clamp(-1.0, 1.0)
    }

    /// Of the computed value of either sign.
    fn outside(&self, computed: f64, [low, high]: [f64; 2]) -> f64 {
        let shifts = if self.ambiguous { &[0.0, 1.0, -1.0][..] } else { &[0.0] };
        let outside = |signed: f64| (low - signed).max(signed - high).max(0.0);
        let distance = |shift: &f64| outside(computed + shift).min(outside(-computed + shift));
        shifts.iter().map(distance).fold(f64::INFINITY, f64::min)
    }

    /// Moves the whole polygon along axes and diagonals: what matters in contact.
    fn first_moves(&self) -> Vec<Moves> {
        let moves = |place| {
            let way = DVec3::from_array([place % 3, place / 3 % 3, place / 9].map(|c| f64::from(c) - 1.0));
            vec![way.try_normalize().unwrap_or_default(); self.vertices.len()]
        };
        (0..27).map(moves).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hard::reference::Reference;

    /// A square of side 2 at height `z` whose corner or inside is at (x, 0).
    fn square(x: f32, z: f32) -> HardCase {
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        let offsets = corners.map(|[a, b]| [a + x, b, z]).to_vec();
        HardCase { anchor: [0.0; 3], offsets, flat: true }
    }

    fn distance(case: &HardCase, computed: f64) -> f64 {
        Nearby::new(case, false).distance(computed, 1e-12)
    }

    #[test]
    fn far_from_contact_the_backward_error_is_about_the_forward_error() {
        let case = square(0.3, 1.0);
        let exact = Reference::new(&case).form_factor;
        // Moving the corners by 2.4e-7 moves the value by about as much
        assert!(distance(&case, exact + 1e-7) < 1e-9);
        let error = distance(&case, exact + 1e-5);
        assert!(error > 0.95e-5 && error < 1e-5, "{error:e}");
    }

    #[test]
    fn on_the_light_both_sides_values_are_nearby_and_those_between() {
        // In the plane of the horizon, but for a millionth of a millionth: 1 from below it, 0 from above
        let case = square(0.3, 1e-12);
        assert_eq!((Reference::new(&case).form_factor * 1e3).round(), 1e3);
        for value in [0.0, 0.5, 1.0] {
            assert!(distance(&case, value) < 1e-6, "{value}");
        }
        assert_eq!(distance(&case, f64::NAN), f64::INFINITY);
        // The twin: from a thousandth below, only 1 is nearby
        let case = square(0.3, 1e-3);
        assert!(distance(&case, 0.0) > 0.9);
    }

    #[test]
    fn on_an_edge_every_value_between_is_nearby() {
        // An upright square, one edge of which rises through the origin: it may pass on any side
        let offsets = vec![[-1.0, 0.0, -0.5], [1.0, 0.0, 0.5], [1.0, 0.0, 2.5], [-1.0, 0.0, 1.5]];
        let case = HardCase { anchor: [0.0; 3], offsets, flat: true };
        for value in [0.06, 0.2, 0.4, 0.49] {
            assert!(distance(&case, value) < 1e-6, "{value}: {:e}", distance(&case, value));
        }
        // The twin: no square in front of the whole sky
        assert!(distance(&case, 0.99) > 0.1);
    }
}
