//! The values of the shapes nearby: how far a computed value is from all that moving a shape's vectors by
//! [`MOVE`] of their lengths can reach, by form factors of whatever side is seen. [`super::search`] looks for
//! them.

use super::promise::MOVE;
pub use super::search::{Movable, distance};
use arealight_oracle::ellipse::{self, Ellipse};
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::tube::{self, Tube};
use glam::DVec3;

/// The moves allowed, a little less than promised: what rounding adds to them must not count.
const REACH: f64 = MOVE * (1.0 - 1e-6);
/// How far before a plane its contact is taken, in units of the largest move.
const BEFORE_PLANE: f64 = 1e-7;

fn moved(v: DVec3, move_by: DVec3) -> DVec3 {
    v + move_by * (v.length() * REACH)
}

fn moved_ellipse(ellipse: &Ellipse, moves: &[DVec3]) -> Ellipse {
    Ellipse {
        center: moved(ellipse.center, moves[0]),
        axis_u: moved(ellipse.axis_u, moves[1]),
        axis_v: moved(ellipse.axis_v, moves[2]),
    }
}

impl Movable for Ellipse {
    fn value(&self, moves: &[DVec3]) -> f64 {
        ellipse::form_factor(&moved_ellipse(self, moves)).abs()
    }

    fn contacts(&self, moves: &[DVec3]) -> Option<[Vec<DVec3>; 2]> {
        let there = moved_ellipse(self, &[DVec3::ZERO, moves[1], moves[2]]);
        let normal = there.axis_u.cross(there.axis_v).try_normalize()?;
        let along = -there.center.dot(normal) / (there.center.length() * REACH);
        let left = 1.0 - (along.abs() + BEFORE_PLANE).powi(2);
        let across = (moves[0] - normal * moves[0].dot(normal)).clamp_length_max(left.max(0.0).sqrt());
        let at = |side: f64| vec![across + normal * (along + side * BEFORE_PLANE), moves[1], moves[2]];
        (left >= 0.0).then(|| [at(1.0), at(-1.0)])
    }
}

/// Its center, and in the second move's x its radius.
impl Movable for Sphere {
    fn value(&self, moves: &[DVec3]) -> f64 {
        let radius = self.radius * (1.0 + moves[1].x * REACH);
        sphere::form_factor(&Self { center: moved(self.center, moves[0]), radius })
    }
}

/// Its center, half its axis, and in the third move's x its radius.
impl Movable for Tube {
    fn value(&self, moves: &[DVec3]) -> f64 {
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
        fn value(&self, moves: &[DVec3]) -> f64 {
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
