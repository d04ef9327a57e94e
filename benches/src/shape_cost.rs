//! What the form factor of a disk, a sphere or a tube costs on a device that crosses the horizon, and of the
//! ways to a disk how far off they are: by the library's levels and by yardsticks.
//!
//! Every method runs in turn, round after round, and is read as a ratio to one of them in the same round: to
//! a disk, exactly.

use crate::ladder::Spread;
use crate::shapes::{SHAPES, ShapeArguments, ShapeFunction, ellipse_arguments, tube_arguments};
use crate::table::Table;
use arealight_cases::hard::ellipse::Family;
use arealight_engine::host::{Buffer, Host};
use arealight_engine::{EngineError, ListPass, Passes};
use arealight_oracle::ellipse::{Ellipse, form_factor};
use arealight_oracle::tube::{Ends, Tube};
use arealight_vk::Resource;
use bytemuck::Pod;
use glam::DMat3;
use serde::Serialize;

/// A way to a shape's form factor.
#[derive(Debug, Clone, Copy)]
struct ShapeMethod {
    name: &'static str,
    function: ShapeFunction,
    level: u32,
    choice: u32,
    kind: Kind,
}

/// What it is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Disk,
    /// A disk, of which its error is told.
    JudgedDisk,
    Sphere,
    Tube(Ends),
}

const DIFFERENCE: u32 = 1;
/// The published disk with its discriminant kept from being negative.
const CLAMPED: u32 = 1;

const fn method(
    name: &'static str,
    function: ShapeFunction,
    level: u32,
    choice: u32,
    kind: Kind,
) -> ShapeMethod {
    ShapeMethod { name, function, level, choice, kind }
}

/// The method that the others are ratios to comes first.
const METHODS: &[ShapeMethod] = &[
    method("disk, exact", ShapeFunction::Ellipse, 0, 0, Kind::JudgedDisk),
    method("an empty loop", ShapeFunction::Nothing, 0, 0, Kind::Disk),
    method("disk, difference", ShapeFunction::Ellipse, DIFFERENCE, 0, Kind::JudgedDisk),
    method("published disk, a sphere's horizon", ShapeFunction::Published, CLAMPED, 0, Kind::JudgedDisk),
    method("published disk, cheap horizon", ShapeFunction::PublishedCheap, CLAMPED, 0, Kind::JudgedDisk),
    method("disk, a sphere's horizon", ShapeFunction::SphereHorizon, 0, 0, Kind::JudgedDisk),
    method("polygon of 8", ShapeFunction::Polygon, 0, 8, Kind::JudgedDisk),
    method("polygon of 16", ShapeFunction::Polygon, 0, 16, Kind::JudgedDisk),
    method("polygon of 32", ShapeFunction::Polygon, 0, 32, Kind::JudgedDisk),
    method("sphere, Lambert's lobe", ShapeFunction::Sphere, 0, 0, Kind::Sphere),
    method("pipe, exact", ShapeFunction::Tube, 0, 0, Kind::Tube(Ends::Open)),
    method("capsule, exact", ShapeFunction::Tube, 0, 0, Kind::Tube(Ends::Round)),
    method("pipe, difference", ShapeFunction::Tube, DIFFERENCE, 0, Kind::Tube(Ends::Open)),
    method("pipe, both horizons", ShapeFunction::Tube, 0, 1, Kind::Tube(Ends::Open)),
];

/// A method's cost, and its error over disks that cross the horizon.
#[derive(Debug, Clone, Serialize)]
pub struct ShapeCost {
    /// The method.
    pub method: &'static str,
    /// The ratio to the exact disk in the same round.
    pub ratio: Spread,
    /// The root of the mean square and the largest of the errors that are finite, and how many are not: of
    /// ways to a disk.
    pub error: Option<ShapeError>,
}

/// How far off results are.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ShapeError {
    /// Root of the mean square.
    pub rms: f64,
    /// The largest.
    pub largest: f64,
    /// Results that are NaN or infinite.
    pub not_finite: usize,
}

const WORK_ITEMS: usize = 4096;
const REPEATS: u32 = 64;

/// The disks, across the horizon.
fn disks() -> Vec<Ellipse> {
    let family = Family::find("crossing").unwrap_or(&arealight_cases::hard::ellipse::FAMILIES[0]);
    (0..WORK_ITEMS as u64).map(|index| family.case(index, 0)).collect()
}

/// The shapes of a kind: about each disk's center, as long as its longer axis, as thick as the shorter one.
fn arguments(kind: Kind) -> Vec<ShapeArguments> {
    let of_disk = |disk: &Ellipse| {
        let radius = 0.5 * disk.axis_v.length().min(disk.center.length());
        match kind {
            Kind::Disk | Kind::JudgedDisk => ellipse_arguments(disk),
            Kind::Sphere => {
                let mut given = ellipse_arguments(disk);
                given[0][3] = radius as f32;
                given
            }
            Kind::Tube(ends) => {
                let (start, end) = (disk.center - disk.axis_u, disk.center + disk.axis_u);
                tube_arguments(&Tube { start, end, radius, ends }, &DMat3::IDENTITY)
            }
        }
    };
    disks().iter().map(of_disk).collect()
}

/// A method over its shapes, and what it reads.
type List = (ListPass<[f32; 4], u32>, [Buffer; 2]);

/// Makes a method's list.
fn list(passes: &Passes, method: &ShapeMethod, repeats: u32) -> Result<List, EngineError> {
    let host = passes.host();
    let ends = if let Kind::Tube(ends) = method.kind { ends as u32 } else { 0 };
    let inputs = [
        host.storage_buffer("arguments", &arguments(method.kind))?,
        host.storage_buffer("ends", &[ends; WORK_ITEMS])?,
    ];
    let constants = [(0, method.function as u32), (1, method.level), (2, method.choice), (3, repeats)];
    let resources = inputs.each_ref().map(|buffer| Resource::buffer(buffer.handle()));
    // SAFETY: The inputs are returned with it.
    let list = unsafe { passes.over_list((&SHAPES, &constants), &resources, WORK_ITEMS as u32, WORK_ITEMS) }?;
    Ok((list, inputs))
}

/// Runs a list of each method in turn, `rounds` times after a round that warms up: the seconds of each.
fn in_turn<R: Pod, C: Pod>(lists: &[ListPass<R, C>], rounds: usize) -> Result<Vec<Vec<f64>>, EngineError> {
    let mut seconds = vec![vec![]; lists.len()];
    for round in 0..=rounds {
        for (list, seconds) in lists.iter().zip(&mut seconds) {
            let took = list.run()?.as_secs_f64();
            if round > 0 {
                seconds.push(took);
            }
        }
    }
    Ok(seconds)
}

/// Measures every method in `rounds` rounds, after one that warms up.
pub fn measure(host: &Host, rounds: usize) -> Result<Vec<ShapeCost>, EngineError> {
    let passes = Passes::new(host.clone())?;
    let made = METHODS.iter().map(|method| list(&passes, method, REPEATS)).collect::<Result<Vec<_>, _>>()?;
    let (lists, _inputs): (Vec<_>, Vec<_>) = made.into_iter().unzip();
    let seconds = in_turn(&lists, rounds)?;
    let truth: Vec<f64> = disks().iter().map(|disk| form_factor(disk).abs()).collect();
    let cost = |(method, taken): (&ShapeMethod, &Vec<f64>)| {
        let is_judged = method.kind == Kind::JudgedDisk;
        Ok(ShapeCost {
            method: method.name,
            ratio: Spread::of_ratios(taken, &seconds[0]),
            error: is_judged.then(|| error(&passes, method, &truth)).transpose()?,
        })
    };
    METHODS.iter().zip(&seconds).map(cost).collect()
}

/// The errors of a method, evaluated once a disk.
fn error(passes: &Passes, method: &ShapeMethod, truth: &[f64]) -> Result<ShapeError, EngineError> {
    let (list, _inputs) = list(passes, method, 1)?;
    list.run()?;
    let results = list.results()?;
    let errors: Vec<f64> =
        results.iter().zip(truth).map(|(found, truth)| (f64::from(found[0]) - truth).abs()).collect();
    let finite = || errors.iter().filter(|error| error.is_finite());
    Ok(ShapeError {
        rms: (finite().map(|error| error * error).sum::<f64>() / finite().count().max(1) as f64).sqrt(),
        largest: finite().fold(0.0, |largest, error| largest.max(*error)),
        not_finite: errors.len() - finite().count(),
    })
}

/// The costs as a Markdown table.
pub fn markdown(costs: &[ShapeCost]) -> String {
    let row = |cost: &ShapeCost| {
        let errors = cost.error.map_or_else(Default::default, |error| {
            let not_finite = match error.not_finite {
                0 => String::new(),
                count => format!(", {count} not finite"),
            };
            [format!("{:.0e}", error.rms), format!("{:.0e}{not_finite}", error.largest)]
        });
        std::iter::once(cost.method.to_owned()).chain(cost.ratio.cells()).chain(errors).collect()
    };
    let heads = ["form factor", "time, exact disk = 1", "quartiles", "RMS error", "largest error"];
    Table::new(&heads, costs.iter().map(row)).to_markdown()
}
