//! The values of the polygons nearby: how far a computed value is from all that moving each vertex by
//! [`MOVE`] of its distance can reach. That is the backward error: a result that is some polygon's nearby is as
//! good as the rounding of the vertices allows.
//!
//! The set is searched, not known: every value that counts belongs to a polygon that was evaluated. A search
//! that is too weak overstates the error and never understates it.

use super::HardCase;
use super::promise::MOVE;
use super::stream::Stream;
use super::walk::walk;
use glam::DVec3;

/// A polygon nearby, as each vertex's move in units of the largest one allowed: lengths up to 1.
type Moves = Vec<DVec3>;

/// Random polygons that are tried.
const TRIALS: usize = 48;
/// Steps along the gradient.
const STEPS: usize = 4;
/// Halvings between two polygons whose values lie on either side; a jump ends them unsuccessful.
const HALVINGS: usize = 40;

/// The values nearby one case.
pub struct Nearby {
    vertices: Vec<DVec3>,
    radii: Vec<f64>,
}

impl Nearby {
    /// The polygons nearby a case, whose vertices must be finite.
    pub fn new(case: &HardCase) -> Self {
        let anchor = DVec3::from_array(case.anchor.map(f64::from));
        let vertices: Vec<DVec3> =
            case.offsets_exactly().into_iter().map(|o| anchor + DVec3::from_array(o)).collect();
        // float64 rounds the vertices and the moves, by less than a millionth of them
        let radii = vertices.iter().map(|v| v.length() * MOVE * (1.0 - 1e-6)).collect();
        Self { vertices, radii }
    }

    /// What a polygon nearby sends from either side. In float64: its error is 1e-16 over rho, and where rho is
    /// smaller than [`MOVE`], that of a polygon that is nearby too.
    fn value(&self, moves: &[DVec3]) -> f64 {
        let moved = self.vertices.iter().zip(&self.radii).zip(moves);
        let vertices: Vec<[f64; 3]> = moved.map(|((v, radius), m)| (*v + *m * *radius).to_array()).collect();
        walk::<f64>([0.0; 3], &vertices).signed_form_factor().abs().min(1.0)
    }

    /// An upper bound of the distance from `computed` to the values nearby. Stops searching at `enough`.
    pub fn distance(&self, computed: f64, exact: f64, enough: f64) -> f64 {
        if !computed.is_finite() {
            return f64::INFINITY;
        }
        let given = (exact, vec![DVec3::ZERO; self.vertices.len()]);
        let mut search =
            Search { nearby: self, computed, enough, best: f64::INFINITY, below: None, above: None };
        if search.visit(given.0, given.1.clone()) || search.climb(&given.1) || search.translate() {
            return search.best;
        }
        search.scatter();
        search.best
    }
}

/// A search for a polygon nearby that has the computed value.
struct Search<'a> {
    nearby: &'a Nearby,
    computed: f64,
    enough: f64,
    best: f64,
    /// The nearest polygon whose value is too small.
    below: Option<(f64, Moves)>,
    /// The nearest polygon whose value is too large.
    above: Option<(f64, Moves)>,
}

impl Search<'_> {
    /// Notes a polygon's value, and those between it and the nearest on the other side. Whether that is enough.
    fn visit(&mut self, value: f64, moves: Moves) -> bool {
        let distance = (value - self.computed).abs();
        if distance.is_nan() {
            return false;
        }
        self.best = self.best.min(distance);
        let side = if value < self.computed { &mut self.below } else { &mut self.above };
        if side.as_ref().is_none_or(|(nearest, _)| distance < (nearest - self.computed).abs()) {
            *side = Some((value, moves));
            if self.best > self.enough {
                self.halve();
            }
        }
        self.best <= self.enough
    }

    /// Halves the way between the nearest polygons on either side. The set of moves is convex, so that all on
    /// the way are nearby.
    fn halve(&mut self) {
        let (Some((_, below)), Some((_, above))) = (&self.below, &self.above) else { return };
        let (mut below, mut above) = (below.clone(), above.clone());
        for _ in 0..HALVINGS {
            let middle: Moves = below.iter().zip(&above).map(|(a, b)| (*a + *b) * 0.5).collect();
            let value = self.nearby.value(&middle);
            self.best = self.best.min((value - self.computed).abs());
            if self.best <= self.enough || value.is_nan() {
                return;
            }
            *(if value < self.computed { &mut below } else { &mut above }) = middle;
        }
    }

    /// Moves every vertex as far as allowed along the gradient that leads towards the computed value, and again
    /// from there.
    fn climb(&mut self, given: &Moves) -> bool {
        const STEP: f64 = 0.125;
        let mut moves = given.clone();
        for _ in 0..STEPS {
            let towards = (self.computed - self.nearby.value(&moves)).signum();
            let mut gradient = moves.clone();
            for i in 0..moves.len() {
                for axis in 0..3 {
                    let place = moves[i];
                    let mut at = |step: f64| {
                        moves[i][axis] = place[axis] + step;
                        self.nearby.value(&moves)
                    };
                    gradient[i][axis] = (at(STEP) - at(-STEP)) * towards;
                    moves[i] = place;
                }
            }
            moves = gradient.iter().map(|g| g.try_normalize().unwrap_or_default()).collect();
            let value = self.nearby.value(&moves);
            if self.visit(value, moves.clone()) {
                return true;
            }
        }
        false
    }

    /// Moves the whole polygon along axes and diagonals: what matters in contact.
    fn translate(&mut self) -> bool {
        for place in 0..27 {
            let way = DVec3::from_array([place % 3, place / 3 % 3, place / 9].map(|c| f64::from(c) - 1.0));
            let Some(way) = way.try_normalize() else { continue };
            let moves = vec![way; self.nearby.vertices.len()];
            if self.visit(self.nearby.value(&moves), moves) {
                return true;
            }
        }
        false
    }

    /// Moves each vertex its own random way.
    fn scatter(&mut self) {
        let mut stream = Stream::new("nearby", 0, self.computed.to_bits());
        for _ in 0..TRIALS {
            let moves: Moves = self.nearby.vertices.iter().map(|_| stream.direction()).collect();
            if self.visit(self.nearby.value(&moves), moves) {
                return;
            }
        }
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
        let exact = Reference::new(case).form_factor;
        Nearby::new(case).distance(computed, exact, 1e-12)
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
    fn on_the_light_both_sides_values_are_nearby_and_no_other() {
        // In the plane of the horizon, but for a millionth of a millionth: 1 from below it, 0 from above
        let case = square(0.3, 1e-12);
        assert_eq!((Reference::new(&case).form_factor * 1e3).round(), 1e3);
        assert!(distance(&case, 1.0) < 1e-6 && distance(&case, 0.0) < 1e-6);
        assert!(distance(&case, 0.5) > 0.4);
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
