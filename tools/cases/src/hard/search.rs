//! The search for what is nearby: how far a computed value is from all that moving a case's vectors can
//! reach. That is the backward error: a result between values nearby is as good as the rounding of the
//! vectors allows.
//!
//! The reachable interval is searched, not known: its ends are values of cases that were evaluated. A search
//! that is too weak overstates the error and never understates it.

use super::stream::Stream;
use glam::DVec3;

/// Random moves that are tried.
const TRIALS: usize = 48;

/// Moves of each vector, in units of the largest one allowed: lengths up to 1.
pub type Moves = Vec<DVec3>;

/// A case whose vectors can be moved.
pub trait Movable {
    /// Random moves that are tried about the best ones, ever closer.
    const REFINEMENTS: i32 = 120;
    /// Steps along the gradient.
    const STEPS: usize = 3;

    /// How many vectors it has.
    fn vectors(&self) -> usize {
        3
    }

    /// The value of the moved case.
    fn value(&self, moves: &[DVec3]) -> f64;

    /// The distance of a computed value to the interval between two values.
    fn outside(&self, computed: f64, [low, high]: [f64; 2]) -> f64 {
        (low - computed).max(computed - high).max(0.0)
    }

    /// Moves that are tried before random ones.
    fn first_moves(&self) -> Vec<Moves> {
        vec![vec![DVec3::ZERO; self.vectors()]]
    }

    /// The same moves but for the first vector's, which goes on to where the point lies in a shape's plane,
    /// just before it and just behind: where a search along gradients steps over. `None` where that is out of
    /// reach, or nothing is flat.
    fn contacts(&self, _moves: &[DVec3]) -> Option<[Moves; 2]> {
        None
    }
}

/// An upper bound of the distance from `computed` to the interval of the values nearby. Stops searching at
/// `enough`.
pub fn distance<M: Movable>(case: &M, computed: f64, enough: f64) -> f64 {
    if !computed.is_finite() || computed < 0.0 {
        return f64::INFINITY;
    }
    let still = vec![DVec3::ZERO; case.vectors()];
    let end = (case.value(&still), still);
    let mut search = Search { case, computed, enough, lowest: end.clone(), highest: end };
    let _ = search.is_enough()
        || search.climb(1.0)
        || search.climb(-1.0)
        || case.first_moves().iter().any(|moves| search.visit(moves))
        || search.scatter()
        || search.refine();
    search.distance()
}

/// A search for moves between whose values the computed one is.
struct Search<'a, M> {
    case: &'a M,
    computed: f64,
    enough: f64,
    lowest: (f64, Moves),
    highest: (f64, Moves),
}

impl<M: Movable> Search<'_, M> {
    fn distance(&self) -> f64 {
        self.case.outside(self.computed, [self.lowest.0, self.highest.0])
    }

    fn is_enough(&self) -> bool {
        self.distance() <= self.enough
    }

    /// Notes the value of a case, and of those in whose plane the point is. Whether that is enough.
    fn visit(&mut self, moves: &Moves) -> bool {
        self.note(moves);
        for contact in self.case.contacts(moves).into_iter().flatten() {
            self.note(&contact);
        }
        self.is_enough()
    }

    fn note(&mut self, moves: &Moves) {
        let value = self.case.value(moves);
        if value < self.lowest.0 {
            self.lowest = (value, moves.clone());
        }
        if value > self.highest.0 {
            self.highest = (value, moves.clone());
        }
    }

    /// Moves every vector as far as allowed along the gradient or against it, and again from there.
    fn climb(&mut self, way: f64) -> bool {
        const STEP: f64 = 0.125;
        let mut moves = vec![DVec3::ZERO; self.case.vectors()];
        for _ in 0..M::STEPS {
            let mut gradient = moves.clone();
            for i in 0..moves.len() {
                for axis in 0..3 {
                    let place = moves[i];
                    let mut at = |step: f64| {
                        moves[i][axis] = place[axis] + step;
                        self.case.value(&moves)
                    };
                    gradient[i][axis] = (at(STEP) - at(-STEP)) * way;
                    moves[i] = place;
                }
            }
            moves = gradient.iter().map(|g| g.try_normalize().unwrap_or_default()).collect();
            if self.visit(&moves) {
                return true;
            }
        }
        false
    }

    /// Moves each vector its own random way.
    fn scatter(&mut self) -> bool {
        let mut stream = Stream::new("nearby", 0, self.computed.to_bits());
        (0..TRIALS).any(|_| {
            let moves: Moves = (0..self.case.vectors()).map(|_| stream.direction()).collect();
            self.visit(&moves)
        })
    }

    /// Moves on from the cases at the interval's ends.
    fn refine(&mut self) -> bool {
        let mut stream = Stream::new("refined", 0, self.computed.to_bits());
        (0..2 * M::REFINEMENTS).any(|trial| {
            let best = if trial % 2 == 0 { &self.lowest.1 } else { &self.highest.1 };
            let step = 0.5_f64.powi(trial / 40);
            let mut next = |m: &DVec3| {
                let moved = *m + stream.direction() * step;
                moved / moved.length().max(1.0)
            };
            let moves = best.iter().map(&mut next).collect();
            self.visit(&moves)
        })
    }
}
