//! The values of the shapes nearby: how far a computed value is from all that moving a shape's vectors by
//! [`MOVE`] of their lengths can reach. That is the backward error, as `hard::nearby` has it for polygons.
//!
//! The interval is searched, not known: its ends are values of shapes that were evaluated. A search that is
//! too weak overstates the error and never understates it.

use crate::hard::promise::MOVE;
use arealight_oracle::ellipse::{self, Ellipse};
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::stream::Stream;
use arealight_oracle::tube::{self, Tube};
use glam::DVec3;

/// Random shapes that are tried.
const TRIALS: usize = 48;
/// Random shapes that are tried about the best ones, ever closer.
const REFINEMENTS: i32 = 120;
/// Steps along the gradient.
const STEPS: usize = 3;
/// The moves allowed, a little less than promised: what rounding adds to them must not count.
const REACH: f64 = MOVE * (1.0 - 1e-6);
/// How far before a plane its contact is taken, in units of the largest move.
const BEFORE_PLANE: f64 = 1e-7;

/// Moves of up to three vectors, in units of the largest one allowed: lengths up to 1.
pub type Moves = [DVec3; 3];

/// A shape whose vectors can be moved.
pub trait Movable {
    /// The form factor of the moved shape, of whatever side is seen.
    fn value(&self, moves: &Moves) -> f64;

    /// The same moves but for the center's, which goes on to where the point lies in the shape's plane, just
    /// before it and just behind: where a search along gradients steps over. `None` where that is out of
    /// reach, or nothing is flat.
    fn contacts(&self, _moves: &Moves) -> Option<[Moves; 2]> {
        None
    }
}

fn moved(v: DVec3, move_by: DVec3) -> DVec3 {
    v + move_by * (v.length() * REACH)
}

fn moved_ellipse(ellipse: &Ellipse, moves: &Moves) -> Ellipse {
    Ellipse {
        center: moved(ellipse.center, moves[0]),
        axis_u: moved(ellipse.axis_u, moves[1]),
        axis_v: moved(ellipse.axis_v, moves[2]),
    }
}

impl Movable for Ellipse {
    fn value(&self, moves: &Moves) -> f64 {
        ellipse::form_factor(&moved_ellipse(self, moves)).abs()
    }

    fn contacts(&self, moves: &Moves) -> Option<[Moves; 2]> {
        let there = moved_ellipse(self, &[DVec3::ZERO, moves[1], moves[2]]);
        let normal = there.axis_u.cross(there.axis_v).try_normalize()?;
        let along = -there.center.dot(normal) / (there.center.length() * REACH);
        let left = 1.0 - (along.abs() + BEFORE_PLANE).powi(2);
        let across = (moves[0] - normal * moves[0].dot(normal)).clamp_length_max(left.max(0.0).sqrt());
        let at = |side: f64| [across + normal * (along + side * BEFORE_PLANE), moves[1], moves[2]];
        (left >= 0.0).then(|| [at(1.0), at(-1.0)])
    }
}

/// Its center, and in the second move's x its radius.
impl Movable for Sphere {
    fn value(&self, moves: &Moves) -> f64 {
        let radius = self.radius * (1.0 + moves[1].x * REACH);
        sphere::form_factor(&Self { center: moved(self.center, moves[0]), radius })
    }
}

/// Its center, half its axis, and in the third move's x its radius.
impl Movable for Tube {
    fn value(&self, moves: &Moves) -> f64 {
        let center = moved((self.start + self.end) * 0.5, moves[0]);
        let half_axis = moved((self.end - self.start) * 0.5, moves[1]);
        let radius = self.radius * (1.0 + moves[2].x * REACH);
        tube::form_factor(&Self {
            start: center - half_axis,
            end: center + half_axis,
            radius,
            ends: self.ends,
        })
    }
}

/// An upper bound of the distance from `computed` to the interval of the values of shapes nearby. Stops
/// searching at `enough`.
pub fn distance(shape: &impl Movable, computed: f64, enough: f64) -> f64 {
    if !computed.is_finite() || computed < 0.0 {
        return f64::INFINITY;
    }
    let still = [DVec3::ZERO; 3];
    let end = (shape.value(&still), still);
    let mut search = Search { shape, computed, enough, lowest: end, highest: end };
    let _ = search.is_enough()
        || search.climb(1.0)
        || search.climb(-1.0)
        || search.visit(&still)
        || search.scatter()
        || search.refine();
    search.distance()
}

struct Search<'a, S> {
    shape: &'a S,
    computed: f64,
    enough: f64,
    lowest: (f64, Moves),
    highest: (f64, Moves),
}

impl<S: Movable> Search<'_, S> {
    fn distance(&self) -> f64 {
        (self.lowest.0 - self.computed).max(self.computed - self.highest.0).max(0.0)
    }

    fn is_enough(&self) -> bool {
        self.distance() <= self.enough
    }

    /// Notes the value of a shape, and of those in whose plane the point is. Whether that is enough.
    fn visit(&mut self, moves: &Moves) -> bool {
        self.note(moves);
        for contact in self.shape.contacts(moves).into_iter().flatten() {
            self.note(&contact);
        }
        self.is_enough()
    }

    fn note(&mut self, moves: &Moves) {
        let value = self.shape.value(moves);
        if value < self.lowest.0 {
            self.lowest = (value, *moves);
        }
        if value > self.highest.0 {
            self.highest = (value, *moves);
        }
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
                        self.shape.value(&moved)
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

    /// Moves on from the shapes at the interval's ends.
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
    use arealight_oracle::ellipse::form_factor;

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

    /// An ellipse whose plane is not looked for.
    struct Blind(Ellipse);

    impl Movable for Blind {
        fn value(&self, moves: &Moves) -> f64 {
            self.0.value(moves)
        }
    }

    #[test]
    fn the_plane_is_found_between_two_sides() {
        // A case of the long battery: the point is 9e-8 off the plane, and outside of the rim, so that from
        // an ellipse nearby nothing is seen, and from those beyond as much as before
        let ellipse = crate::hard::ellipse::Family::find("contact-rim").unwrap().case(7037, 0);
        assert!(form_factor(&ellipse).abs() > 4e-3);
        assert!(distance(&ellipse, 0.0, 1e-7) <= 1e-7);
        // The twins: along gradients alone it is not found, and what none nearby has is still refused
        assert!(distance(&Blind(ellipse), 0.0, 1e-7) > 1e-6);
        assert!(distance(&ellipse, 0.9, 1e-7) > 0.1);
    }

    #[test]
    fn spheres_and_tubes_are_moved_too() {
        let sphere = Sphere { center: DVec3::new(0.3, 0.1, 1.0), radius: 0.5 };
        let tube = Tube {
            start: DVec3::new(-1.0, 0.2, 0.7),
            end: DVec3::new(1.0, 0.1, 0.9),
            radius: 0.2,
            ends: tube::Ends::Flat,
        };
        let still = [DVec3::ZERO; 3];
        for moves in [[DVec3::X, DVec3::ZERO, DVec3::ZERO], [DVec3::ZERO, DVec3::X, DVec3::X]] {
            for (value, there) in
                [(sphere.value(&still), sphere.value(&moves)), (tube.value(&still), tube.value(&moves))]
            {
                assert!(value != there && (value - there).abs() < 10.0 * MOVE, "{value}, {there}");
            }
        }
        for error in [distance(&sphere, 0.5, 1e-7), distance(&tube, 0.9, 1e-7)] {
            assert!(error > 0.1 && error < 0.9, "{error}");
        }
    }
}
