//! Families of hard disks, spheres and tubes, and the judgement of a result.
//!
//! As for polygons, a case is the same on every machine, and is rounded to float32 before anything is
//! computed from it.

use crate::shapes::{ShapeArguments, ShapeFunction, ellipse_arguments, sphere_arguments, tube_arguments};
use arealight_cases::hard::{ellipse as hard, nearby_shape};
use arealight_oracle::ellipse::{self, Ellipse};
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::stream::Stream;
use arealight_oracle::tube::{self, Ends, Tube};
use glam::{DMat3, DVec3};

/// The largest backward error: the distance to the values of shapes whose numbers differ by [`MOVE`] of their
/// length.
const BACKWARD: f64 = 1e-6;
/// The same of disks: what `arealight_ellipse_form_factor` promises.
const BACKWARD_OF_DISKS: f64 = 6e-7;
/// Far spheres: the largest error as a part of what one sends at the zenith.
const RELATIVE: f64 = 1e-5;
/// The same of tubes: an outline's 1e-7 over the square of a 64th of the distance, which a radius here is at
/// most; a line's, thinner than a hundredth, is less.
const RELATIVE_OF_TUBES: f64 = 5e-4;
/// The same of disks, whose height above their plane is rounded in the distance.
const RELATIVE_OF_DISKS: f64 = 5e-6;

/// A shape of a family.
#[derive(Debug, Clone, Copy)]
pub(super) enum Case {
    Ellipse(Ellipse),
    Sphere(Sphere),
    Tube(Tube),
}

impl Case {
    /// What the kernel takes: its arguments, and a tube's ends.
    pub(super) fn arguments(&self) -> (ShapeArguments, u32) {
        match self {
            Self::Ellipse(ellipse) => (ellipse_arguments(ellipse), 0),
            Self::Sphere(sphere) => {
                let mut given = sphere_arguments(sphere.center, sphere.radius, &DMat3::IDENTITY);
                given[3][3] = 0.0;
                (given, 0)
            }
            Self::Tube(tube) => (tube_arguments(tube, &DMat3::IDENTITY), tube.ends as u32),
        }
    }

    /// Its form factor in float64.
    pub(super) fn value(&self) -> f64 {
        match self {
            Self::Ellipse(ellipse) => ellipse::form_factor(ellipse).abs(),
            Self::Sphere(sphere) => sphere::form_factor(sphere),
            Self::Tube(tube) => tube::form_factor(tube),
        }
    }

    /// Its numbers, to the last digit.
    pub(super) fn numbers(&self) -> String {
        let vector = |v: DVec3| format!("{:?}", v.to_array());
        match self {
            Self::Ellipse(e) => {
                format!(
                    "center {}, axis_u {}, axis_v {}",
                    vector(e.center),
                    vector(e.axis_u),
                    vector(e.axis_v)
                )
            }
            Self::Sphere(s) => format!("center {}, radius {:?}", vector(s.center), s.radius),
            Self::Tube(t) => {
                format!(
                    "start {}, end {}, radius {:?}, {:?}",
                    vector(t.start),
                    vector(t.end),
                    t.radius,
                    t.ends
                )
            }
        }
    }

    /// What it would send if it stood at the zenith and faced the surface: its area over pi times the squared
    /// distance, as far polygons are judged.
    fn most(&self) -> f64 {
        let (center, area) = match self {
            Self::Ellipse(e) => (e.center, e.axis_u.cross(e.axis_v).length()),
            Self::Sphere(s) => (s.center, s.radius * s.radius),
            Self::Tube(t) => {
                let (center, length) = ((t.start + t.end) * 0.5, t.start.distance(t.end));
                (center, t.radius * (2.0 * length / std::f64::consts::PI + t.radius))
            }
        };
        area / center.length_squared()
    }

    /// An upper bound of the backward error of `found`; the search for shapes nearby stops at a tenth of the
    /// promise.
    fn backward_error(&self, found: f64) -> f64 {
        let enough = BACKWARD * 0.1;
        let forward = (found - self.value()).abs();
        match self {
            // The comparisons below would pass it over
            _ if !found.is_finite() => f64::INFINITY,
            _ if forward <= enough => forward,
            Self::Ellipse(ellipse) => nearby_shape::distance(ellipse, found, enough),
            Self::Sphere(sphere) => nearby_shape::distance(sphere, found, enough),
            Self::Tube(tube) => nearby_shape::distance(tube, found, enough),
        }
    }
}

/// What a family is judged by, beside its range.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Judgement {
    /// Its backward error.
    Backward(f64),
    /// And relative to what the light sends at most, as far lights are.
    Relative(f64),
}

/// Shapes that are hard in one way.
pub(super) struct Family {
    /// The shape, and what makes it hard.
    pub(super) name: String,
    /// What evaluates them.
    pub(super) function: ShapeFunction,
    judgement: Judgement,
    make: Box<dyn Fn(u64, u64) -> Case + Sync>,
}

impl Family {
    /// The case of an index and a seed.
    pub(super) fn case(&self, index: u64, seed: u64) -> Case {
        (self.make)(index, seed)
    }

    /// What the error of a result may be.
    pub(super) fn promise(&self) -> f64 {
        match self.judgement {
            Judgement::Backward(bound) | Judgement::Relative(bound) => bound,
        }
    }

    /// The error of a result that the promise is about; infinite for what is no finite number.
    pub(super) fn error(&self, case: &Case, found: f64) -> f64 {
        match self.judgement {
            Judgement::Backward(_) => case.backward_error(found),
            Judgement::Relative(_) if !found.is_finite() => f64::INFINITY,
            Judgement::Relative(_) => (found - case.value()).abs() / case.most(),
        }
    }
}

/// All families.
pub(super) fn families() -> Vec<Family> {
    let mut families: Vec<Family> = hard::FAMILIES
        .iter()
        .map(|family| Family {
            name: format!("disk, {}", family.name),
            function: ShapeFunction::Ellipse,
            judgement: if family.name.starts_with("far") {
                Judgement::Relative(RELATIVE_OF_DISKS)
            } else {
                Judgement::Backward(BACKWARD_OF_DISKS)
            },
            make: Box::new(|index, seed| Case::Ellipse(family.case(index, seed))),
        })
        .collect();
    for (name, low, high, judgement) in [
        ("sphere, near", -1.5, 4.0, Judgement::Backward(BACKWARD)),
        ("sphere, in contact", -20.0, -7.0, Judgement::Backward(BACKWARD)),
        ("sphere, far", 10.0, 26.0, Judgement::Relative(RELATIVE)),
    ] {
        families.push(Family {
            name: name.into(),
            function: ShapeFunction::Sphere,
            judgement,
            make: Box::new(move |index, seed| Case::Sphere(hard_sphere(name, index, seed, [low, high]))),
        });
    }
    for (name, ends) in [("pipe", Ends::Open), ("cylinder", Ends::Flat), ("capsule", Ends::Round)] {
        for place in [
            Place::Generic,
            Place::Crossing,
            Place::Thin,
            Place::Near,
            Place::EndOn,
            Place::Far,
            Place::FarCrossing,
            Place::FarSlim,
        ] {
            let judgement = match place {
                Place::Far | Place::FarCrossing | Place::FarSlim => Judgement::Relative(RELATIVE_OF_TUBES),
                _ => Judgement::Backward(BACKWARD),
            };
            families.push(Family {
                name: format!("{name}, {}", place.name()),
                function: ShapeFunction::Tube,
                judgement,
                make: Box::new(move |index, seed| Case::Tube(hard_tube(place, ends, index, seed))),
            });
        }
    }
    families
}

fn round(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

/// A sphere whose surface is `2^low` to `2^high` radii away; every other one crosses the horizon.
fn hard_sphere(name: &str, index: u64, seed: u64, [low, high]: [f64; 2]) -> Sphere {
    let mut stream = Stream::new(name, index, seed);
    let radius = f64::from(stream.power(-3.0, 3.0) as f32);
    let mut direction = stream.direction();
    let away = radius * (1.0 + stream.power(low, high));
    if stream.one_in(2) {
        direction.z = radius / away * stream.between(-1.0, 1.0);
    }
    Sphere { center: round(direction.normalize_or(DVec3::Z) * away), radius }
}

/// Where a tube is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Generic,
    Crossing,
    Thin,
    Near,
    EndOn,
    /// Wholly above the horizon.
    Far,
    FarCrossing,
    /// A hundred to a hundred thousand times as long as thick; every other one crosses the horizon.
    FarSlim,
}

impl Place {
    fn name(self) -> &'static str {
        match self {
            Self::Generic => "generic",
            Self::Crossing => "crossing",
            Self::Thin => "thin",
            Self::Near => "near",
            Self::EndOn => "end-on",
            Self::Far => "far",
            Self::FarCrossing => "far-crossing",
            Self::FarSlim => "far-slim",
        }
    }
}

fn hard_tube(place: Place, ends: Ends, index: u64, seed: u64) -> Tube {
    let mut stream = Stream::new(place.name(), index, 3 * seed + ends as u64);
    let mut start = stream.direction() * stream.power(-1.5, 1.5);
    let axis = stream.direction() * stream.power(-2.0, 2.0);
    let mut radius = stream.power(-4.0, 0.0);
    match place {
        Place::Generic => {}
        Place::Crossing => start.z = -axis.z * stream.unit(),
        Place::Thin => radius = stream.power(-17.0, -7.0) * start.length(),
        Place::Near => {
            let away = radius * (1.0 + stream.power(-10.0, -3.0));
            start = axis.any_orthonormal_vector() * away - axis * stream.between(-0.1, 1.1);
        }
        Place::EndOn => {
            let beside = axis.any_orthonormal_vector() * (radius * stream.between(0.0, 3.0));
            start = axis * stream.between(0.2, 2.0) + beside;
        }
        Place::Far => {
            start *= stream.power(7.0, 17.0);
            start.z = start.z.abs() + axis.z.abs() + radius;
        }
        Place::FarCrossing => {
            start *= stream.power(7.0, 17.0);
            start.z = -axis.z * stream.unit();
        }
        Place::FarSlim => {
            start *= stream.power(6.0, 17.0);
            if stream.one_in(2) {
                start.z = -axis.z * stream.unit();
            }
            radius = axis.length() * stream.power(-18.0, -7.0);
        }
    }
    if matches!(place, Place::Far | Place::FarCrossing) {
        // Its ends are to be small before their distance
        radius = radius.min(start.length().min((start + axis).length()) / 64.0);
    }
    let (center, half) = (round(start + axis * 0.5), round(axis * 0.5));
    Tube { start: center - half, end: center + half, radius: f64::from(radius as f32), ends }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_judge_finds_what_is_off() {
        // Where shapes are about as large as far, an error is not hidden by what their rounding allows
        for family in families()
            .iter()
            .filter(|family| family.name.ends_with("generic") || family.name == "sphere, near")
        {
            let cases: Vec<Case> = (0..20).map(|index| family.case(index, 0)).collect();
            let off = |by: f64| cases.iter().map(move |case| case.backward_error(case.value() + by));
            assert!(off(0.0).all(|error| error == 0.0), "{}", family.name);
            let noticed = off(4.0 * BACKWARD).filter(|error| *error > BACKWARD).count();
            assert!(noticed > 15, "{}: {noticed}", family.name);
            assert!(off(f64::NAN).all(|error| error == f64::INFINITY), "{}", family.name);
        }
    }

    #[test]
    fn another_seed_makes_other_shapes() {
        for family in families() {
            let numbers = |seed| family.case(0, seed).numbers();
            assert_eq!(numbers(0), numbers(0), "{}", family.name);
            assert_ne!(numbers(0), numbers(1), "{}", family.name);
        }
    }
}
