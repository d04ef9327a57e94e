//! The battery of disks, spheres and tubes: families of hard cases on a device, each result judged by its bits, and the published
//! disk beside the disks.

use crate::shapes::{
    SHAPES, ShapeArguments, ShapeFunction, ellipse_arguments, sphere_arguments, tube_arguments,
};
use arealight_cases::hard::ellipse::{self as hard, nearby};
use arealight_cases::hard::promise::MOVE;
use arealight_engine::host::Host;
use arealight_engine::{EngineError, Passes};
use arealight_oracle::ellipse::{self, Ellipse};
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::stream::Stream;
use arealight_oracle::tube::{self, Ends, Tube};
use arealight_vk::Resource;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use std::fmt::Write as _;

/// The largest backward error: the distance to the values of shapes whose numbers differ by [`MOVE`] of their length.
const BACKWARD: f64 = 1e-6;
/// Far shapes: the largest error as a part of what one sends at the zenith; of tubes by the difference form.
const RELATIVE: f64 = 1e-5;
/// The difference form's level.
const DIFFERENCE: u32 = 1;

/// A shape of a family.
#[derive(Debug, Clone, Copy)]
enum Case {
    Ellipse(Ellipse),
    Sphere(Sphere),
    Tube(Tube),
}

impl Case {
    fn arguments(&self) -> (ShapeArguments, u32) {
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

    fn value(&self) -> f64 {
        match self {
            Self::Ellipse(ellipse) => ellipse::form_factor(ellipse).abs(),
            Self::Sphere(sphere) => sphere::form_factor(sphere),
            Self::Tube(tube) => tube::form_factor(tube),
        }
    }

    /// What it would send if it stood at the zenith and faced the surface: its area over pi times the squared distance, as far
    /// polygons are judged.
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

    /// An upper bound of the backward error of `found`; the search for shapes nearby stops at a tenth of the promise.
    fn backward_error(&self, found: f64) -> f64 {
        let enough = BACKWARD * 0.1;
        let forward = (found - self.value()).abs();
        match self {
            // The comparisons below would pass it over
            _ if !found.is_finite() => f64::INFINITY,
            _ if forward <= enough => forward,
            Self::Ellipse(ellipse) => nearby::distance(ellipse, found, enough),
            Self::Sphere(sphere) => {
                let moved = |way: [DVec3; 2], radius: f64| {
                    let center = sphere.center + way[0] * (sphere.center.length() * MOVE);
                    Self::Sphere(Sphere { center, radius: sphere.radius * (1.0 + MOVE * radius) }).value()
                };
                distance_to_interval(found, moved)
            }
            Self::Tube(tube) => {
                let (center, half) = ((tube.start + tube.end) * 0.5, (tube.end - tube.start) * 0.5);
                let moved = |way: [DVec3; 2], radius: f64| {
                    let center = center + way[0] * (center.length() * MOVE);
                    let half = half + way[1] * (half.length() * MOVE);
                    let (start, end) = (center - half, center + half);
                    let radius = tube.radius * (1.0 + MOVE * radius);
                    Self::Tube(Tube { start, end, radius, ends: tube.ends }).value()
                };
                distance_to_interval(found, moved)
            }
        }
    }
}

/// How far `found` is from the values between those of shapes moved by one along the gradient of each of their vectors, and
/// against it.
fn distance_to_interval(found: f64, value: impl Fn([DVec3; 2], f64) -> f64) -> f64 {
    let mut ways = [DVec3::ZERO; 2];
    for index in 0..2 {
        for axis in 0..3 {
            let at = |step: f64| {
                let mut moved = [DVec3::ZERO; 2];
                moved[index][axis] = step;
                value(moved, 0.0)
            };
            ways[index][axis] = at(0.5) - at(-0.5);
        }
    }
    let ways = ways.map(DVec3::normalize_or_zero);
    let grows = (value([DVec3::ZERO; 2], 1.0) - value([DVec3::ZERO; 2], -1.0)).signum();
    let here = value([DVec3::ZERO; 2], 0.0);
    let (mut low, mut high) = (here, here);
    for share in [1.0, 0.5] {
        for way in [share, -share] {
            let there = value(ways.map(|v| v * way), grows * way);
            low = low.min(there);
            high = high.max(there);
        }
    }
    (low - found).max(found - high).max(0.0)
}

/// What a family is judged by, beside its range.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Judgement {
    Backward,
    /// And relative to what the light sends at most, as far lights are.
    Relative(f64),
}

/// Shapes that are hard in one way.
struct Family {
    name: String,
    function: ShapeFunction,
    level: u32,
    judgement: Judgement,
    make: Box<dyn Fn(u64) -> Case + Sync>,
}

fn families() -> Vec<Family> {
    let mut families: Vec<Family> = hard::FAMILIES
        .iter()
        .map(|family| Family {
            name: format!("disk, {}", family.name),
            function: ShapeFunction::Ellipse,
            level: if family.name == "far-crossing" { DIFFERENCE } else { 0 },
            judgement: if family.name.starts_with("far") {
                Judgement::Relative(RELATIVE)
            } else {
                Judgement::Backward
            },
            make: Box::new(|index| Case::Ellipse(family.case(index))),
        })
        .collect();
    for (name, low, high, judgement) in [
        ("sphere, near", -1.5, 4.0, Judgement::Backward),
        ("sphere, in contact", -20.0, -7.0, Judgement::Backward),
        ("sphere, far", 10.0, 26.0, Judgement::Relative(RELATIVE)),
    ] {
        families.push(Family {
            name: name.into(),
            function: ShapeFunction::Sphere,
            level: 0,
            judgement,
            make: Box::new(move |index| Case::Sphere(hard_sphere(name, index, [low, high]))),
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
                Place::Far | Place::FarCrossing | Place::FarSlim => Judgement::Relative(RELATIVE),
                _ => Judgement::Backward,
            };
            let is_far = !matches!(judgement, Judgement::Backward);
            families.push(Family {
                name: format!("{name}, {}", place.name()),
                function: ShapeFunction::Tube,
                level: if is_far { DIFFERENCE } else { 0 },
                judgement,
                make: Box::new(move |index| Case::Tube(hard_tube(place, ends, index))),
            });
        }
    }
    families
}

fn round(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

/// A sphere whose surface is `2^low` to `2^high` radii away; every other one crosses the horizon.
fn hard_sphere(name: &str, index: u64, [low, high]: [f64; 2]) -> Sphere {
    let mut stream = Stream::new(name, index, 0);
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

fn hard_tube(place: Place, ends: Ends, index: u64) -> Tube {
    let mut stream = Stream::new(place.name(), index, ends as u64);
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

/// What a family's results are like.
#[derive(Debug, Clone, Serialize)]
pub struct ShapeRow {
    /// The shape, and what makes it hard.
    pub family: String,
    /// How many there were.
    pub samples: usize,
    /// Results that are not finite numbers in [0, 1], by their bits.
    pub out_of_range: usize,
    /// The largest backward error, or of far lights the largest relative one; none where bits are random.
    pub largest_error: Option<f64>,
    /// What it may be.
    pub promise: f64,
    /// Of disks: how many results of the published disk are not finite, and the largest error of those that are.
    pub published: Option<(usize, f64)>,
}

impl ShapeRow {
    /// Whether every promise was kept.
    pub fn is_kept(&self) -> bool {
        self.out_of_range == 0 && self.largest_error.is_none_or(|error| error <= self.promise)
    }
}

/// Runs `samples` shapes of each family, and as many of random bits for each kind.
///
/// # Errors
/// [`EngineError`] where the device fails.
pub fn run(host: &Host, samples: u64, progress: &dyn Fn(u64)) -> Result<Vec<ShapeRow>, EngineError> {
    let passes = Passes::new(host.clone())?;
    let mut rows = Vec::new();
    for family in families() {
        let cases: Vec<Case> = (0..samples).into_par_iter().map(|index| (family.make)(index)).collect();
        let (arguments, ends): (Vec<_>, Vec<_>) = cases.iter().map(Case::arguments).unzip();
        let found = evaluate(&passes, family.function, family.level, &arguments, &ends)?;
        let published = match family.function {
            ShapeFunction::Ellipse => {
                let found = evaluate(&passes, ShapeFunction::Published, 1, &arguments, &ends)?;
                let errors: Vec<f64> = cases
                    .iter()
                    .zip(found)
                    .map(|(case, found)| (f64::from(found) - case.value()).abs())
                    .collect();
                let finite = || errors.iter().filter(|error| error.is_finite());
                Some((errors.len() - finite().count(), finite().fold(0.0, |m: f64, error| m.max(*error))))
            }
            _ => None,
        };
        let error = |(case, found): (&Case, &f32)| {
            let found = f64::from(*found);
            match family.judgement {
                Judgement::Backward => case.backward_error(found),
                Judgement::Relative(_) if !found.is_finite() => f64::INFINITY,
                Judgement::Relative(_) => (found - case.value()).abs() / case.most(),
            }
        };
        let largest = cases.par_iter().zip(&found).map(error).reduce(|| 0.0, f64::max);
        rows.push(ShapeRow {
            family: family.name,
            samples: cases.len(),
            out_of_range: out_of_range(&found),
            largest_error: Some(largest),
            promise: match family.judgement {
                Judgement::Backward => BACKWARD,
                Judgement::Relative(bound) => bound,
            },
            published,
        });
        progress(samples);
    }
    for (name, function) in
        [("disk", ShapeFunction::Ellipse), ("sphere", ShapeFunction::Sphere), ("tube", ShapeFunction::Tube)]
    {
        let mut stream = Stream::new(name, 0, 0);
        let arguments: Vec<ShapeArguments> = (0..samples)
            .map(|_| [[0; 4]; 4].map(|row| row.map(|_: u32| f32::from_bits(stream.bits()))))
            .collect();
        let ends: Vec<u32> = (0..samples).map(|index| (index % 3) as u32).collect();
        let found = evaluate(&passes, function, 0, &arguments, &ends)?;
        rows.push(ShapeRow {
            family: format!("{name}, any bits"),
            samples: found.len(),
            out_of_range: out_of_range(&found),
            largest_error: None,
            promise: 0.0,
            published: None,
        });
        progress(samples);
    }
    Ok(rows)
}

fn out_of_range(found: &[f32]) -> usize {
    found.iter().filter(|found| found.to_bits() > 1.0_f32.to_bits()).count()
}

/// How many families [`run`] goes through.
pub fn family_count() -> u64 {
    families().len() as u64 + 3
}

fn evaluate(
    passes: &Passes,
    function: ShapeFunction,
    level: u32,
    arguments: &[ShapeArguments],
    ends: &[u32],
) -> Result<Vec<f32>, EngineError> {
    let host = passes.host();
    let arguments_buffer = host.storage_buffer("arguments", arguments)?;
    let ends = host.storage_buffer("ends", ends)?;
    // What is not written stays NaN
    let results = host.storage_buffer("results", &vec![[f32::NAN; 4]; arguments.len()])?;
    let pass = passes.pass(&SHAPES, &[(0, function as u32), (1, level), (2, 0)])?;
    let resources = [&arguments_buffer, &ends, &results].map(|buffer| Resource::buffer(buffer.handle()));
    // SAFETY: The buffers live until the submission below was waited for.
    let set = unsafe { passes.bind(&pass, &resources) }?;
    let count = arguments.len() as u32;
    host.try_submit(|commands| {
        // SAFETY: `commands` is being recorded, outside a render pass.
        unsafe { set.record(&pass, commands, &count, [count, 1, 1]) }
    })?;
    let results: Vec<[f32; 4]> = results.download()?;
    Ok(results.into_iter().map(|result| result[0]).collect())
}

/// The rows as a Markdown table, whose heads say what is in it.
pub fn markdown(rows: &[ShapeRow]) -> String {
    let mut text = String::from(
        "| family | largest error | promised | out of [0, 1] | verdict | published: not finite | its largest error |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let error = row.largest_error.map_or_else(|| "-".to_owned(), |error| format!("{error:.1e}"));
        let promise = row.largest_error.map_or_else(|| "-".to_owned(), |_| format!("{:.0e}", row.promise));
        let published = row
            .published
            .map_or_else(|| "| |".to_owned(), |(count, error)| format!("| {count} | {error:.0e} |"));
        let verdict = if row.is_kept() { "kept" } else { "**BROKEN**" };
        let _ = writeln!(
            text,
            "| {} | {error} | {promise} | {} | {verdict} {published}",
            row.family, row.out_of_range
        );
    }
    text
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
            let cases: Vec<Case> = (0..20).map(|index| (family.make)(index)).collect();
            let off = |by: f64| cases.iter().map(move |case| case.backward_error(case.value() + by));
            assert!(off(0.0).all(|error| error == 0.0), "{}", family.name);
            let noticed = off(4.0 * BACKWARD).filter(|error| *error > BACKWARD).count();
            assert!(noticed > 15, "{}: {noticed}", family.name);
            assert!(off(f64::NAN).all(|error| error == f64::INFINITY), "{}", family.name);
        }
        assert_eq!(out_of_range(&[0.0, 1.0, f32::NAN, 1.5, -0.5]), 3);
        assert_eq!(family_count(), 44);
    }

    #[test]
    fn a_broken_promise_is_shown() {
        let row = |largest_error, out_of_range| ShapeRow {
            family: "disk, test".into(),
            samples: 1,
            out_of_range,
            largest_error,
            promise: 1e-6,
            published: None,
        };
        assert!(row(Some(1e-7), 0).is_kept() && row(None, 0).is_kept());
        for broken in [row(Some(2e-6), 0), row(Some(f64::NAN), 0), row(None, 1)] {
            assert!(!broken.is_kept() && markdown(&[broken]).contains("BROKEN"));
        }
    }
}
