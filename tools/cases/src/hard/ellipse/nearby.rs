//! The values of the ellipses nearby: how far a computed value is from all that moving the center and the axes by
//! [`MOVE`] of their lengths can reach. That is the backward error, as `hard::nearby` has it for polygons.
//!
//! The interval is searched, not known: its ends are values of ellipses that were evaluated. A search that is too weak
//! overstates the error and never understates it.

use crate::hard::promise::MOVE;
use arealight_oracle::ellipse::{Ellipse, form_factor};
use arealight_oracle::stream::Stream;
use glam::DVec3;

/// Random ellipses that are tried.
const TRIALS: usize = 48;
/// Random ellipses that are tried about the best ones, ever closer.
const REFINEMENTS: i32 = 120;
/// Steps along the gradient.
const STEPS: usize = 3;

/// Moves of the center and both axes, in units of the largest one allowed: lengths up to 1.
type Moves = [DVec3; 3];

/// An upper bound of the distance from `computed` to the interval of the values of ellipses nearby, of `|form_factor|`.
/// Stops searching at `enough`.
pub fn distance(ellipse: &Ellipse, computed: f64, enough: f64) -> f64 {
    if !computed.is_finite() || computed < 0.0 {
        return f64::INFINITY;
    }
    let value = form_factor(ellipse).abs();
    let end = (value, [DVec3::ZERO; 3]);
    let mut search = Search { ellipse, computed, enough, lowest: end, highest: end };
    let _ =
        search.is_enough() || search.climb(1.0) || search.climb(-1.0) || search.scatter() || search.refine();
    search.distance()
}

struct Search<'a> {
    ellipse: &'a Ellipse,
    computed: f64,
    enough: f64,
    lowest: (f64, Moves),
    highest: (f64, Moves),
}

impl Search<'_> {
    fn distance(&self) -> f64 {
        (self.lowest.0 - self.computed).max(self.computed - self.highest.0).max(0.0)
    }

    fn is_enough(&self) -> bool {
        self.distance() <= self.enough
    }

    fn value(&self, moves: &Moves) -> f64 {
        let moved = |v: DVec3, m: DVec3| v + m * (v.length() * MOVE * (1.0 - 1e-6));
        let Ellipse { center, axis_u, axis_v } = *self.ellipse;
        form_factor(&Ellipse {
            center: moved(center, moves[0]),
            axis_u: moved(axis_u, moves[1]),
            axis_v: moved(axis_v, moves[2]),
        })
        .abs()
    }

    /// Notes an ellipse's value. Whether that is enough.
    fn visit(&mut self, moves: &Moves) -> bool {
        let value = self.value(moves);
        if value < self.lowest.0 {
            self.lowest = (value, *moves);
        }
        if value > self.highest.0 {
            self.highest = (value, *moves);
        }
        self.is_enough()
    }

    /// Moves as far as allowed along the gradient or against it, and again from there.
    fn climb(&mut self, way: f64) -> bool {
        const STEP: f64 = 0.125;
        let mut moves = [DVec3::ZERO; 3];
        for _ in 0..STEPS {
            let mut gradient = moves;
            for i in 0..3 {
                for axis in 0..3 {
                    let at = |step: f64| {
                        let mut moved = moves;
                        moved[i][axis] += step;
                        self.value(&moved)
                    };
                    gradient[i][axis] = (at(STEP) - at(-STEP)) * way;
                }
            }
            moves = gradient.map(|g| g.try_normalize().unwrap_or_default());
            if self.visit(&moves) {
                return true;
            }
        }
        false
    }

    /// Moves each vector its own random way.
    fn scatter(&mut self) -> bool {
        let mut stream = Stream::new("nearby", 0, self.computed.to_bits());
        (0..TRIALS).any(|_| self.visit(&[0; 3].map(|_| stream.direction())))
    }

    /// Moves on from the ellipses at the interval's ends.
    fn refine(&mut self) -> bool {
        let mut stream = Stream::new("refined", 0, self.computed.to_bits());
        (0..2 * REFINEMENTS).any(|trial| {
            let best = if trial % 2 == 0 { self.lowest.1 } else { self.highest.1 };
            let step = 0.5_f64.powi(trial / 40);
            let moves = best.map(|m| {
                let moved = m + stream.direction() * step;
                moved / moved.length().max(1.0)
            });
            self.visit(&moves)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_from_contact_the_backward_error_is_about_the_forward_error() {
        let disk = Ellipse::disk(DVec3::new(0.3, 0.0, 1.0), -DVec3::Z, 1.0);
        let exact = form_factor(&disk);
        assert!(distance(&disk, exact + 1e-7, 1e-12) < 1e-9);
        let error = distance(&disk, exact + 1e-5, 1e-12);
        assert!(error > 0.9e-5 && error < 1e-5, "{error:e}");
        assert_eq!(distance(&disk, f64::NAN, 1e-12), f64::INFINITY);
    }

    #[test]
    fn at_the_rim_much_is_nearby() {
        // Upright, its rim a millionth away: from none of it to half of the sky
        let disk = Ellipse::disk(DVec3::new(1e-7, 0.0, 1.0), -DVec3::X, 1.0);
        let values = [0.05, 0.2, 0.4].map(|value| distance(&disk, value, 1e-12));
        assert!(values.iter().all(|error| *error < 1e-6), "{values:?}");
        // The twin: a thousandth away that is not so
        let disk = Ellipse::disk(DVec3::new(1e-3, 0.0, 1.0), -DVec3::X, 1.0);
        assert!([0.05, 0.4].map(|value| distance(&disk, value, 1e-12)).iter().any(|error| *error > 0.05));
    }
}
