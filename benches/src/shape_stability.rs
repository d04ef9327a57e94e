//! The battery of disks, spheres and tubes: families of hard cases on a device, each result judged by its
//! bits, and the published disk beside the disks.

mod family;

use crate::shapes::{SHAPES, ShapeArguments, ShapeFunction};
use crate::table::Table;
use arealight_engine::host::Host;
use arealight_engine::{EngineError, Passes};
use arealight_oracle::stream::Stream;
use arealight_vk::Resource;
use family::{Case, Family, families};
use rayon::prelude::*;
use serde::Serialize;
use std::fmt::Write as _;

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
    /// Where that was broken.
    pub shortfall: Option<ShapeShortfall>,
    /// Of disks: how many results of the published disk are not finite, and the largest error of those that
    /// are.
    pub published: Option<(usize, f64)>,
}

/// The cases of a family whose errors are larger than promised: the worst of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShapeShortfall {
    /// How many there were.
    pub count: usize,
    /// The worst one's index, from which the family and the seed make it again.
    pub index: usize,
    /// Its numbers.
    pub shape: String,
    /// Its result, as text: it may be no number.
    pub result: String,
    /// The truth about it.
    pub exact: f64,
}

impl ShapeRow {
    /// Whether every promise was kept.
    pub fn is_kept(&self) -> bool {
        self.out_of_range == 0 && self.largest_error.is_none_or(|error| error <= self.promise)
    }
}

/// Runs `samples` shapes of each family, and as many of random bits for each kind. Another `seed` makes other
/// shapes.
pub fn run(
    host: &Host,
    samples: u64,
    seed: u64,
    progress: &dyn Fn(u64),
) -> Result<Vec<ShapeRow>, EngineError> {
    let passes = Passes::new(host.clone())?;
    let mut rows = Vec::new();
    for family in families() {
        let cases: Vec<Case> = (0..samples).into_par_iter().map(|index| family.case(index, seed)).collect();
        rows.push(judged(&passes, &family, &cases)?);
        progress(samples);
    }
    for (name, function) in
        [("disk", ShapeFunction::Ellipse), ("sphere", ShapeFunction::Sphere), ("tube", ShapeFunction::Tube)]
    {
        rows.push(of_any_bits(&passes, name, function, samples, seed)?);
        progress(samples);
    }
    Ok(rows)
}

/// A family's row.
fn judged(passes: &Passes, family: &Family, cases: &[Case]) -> Result<ShapeRow, EngineError> {
    let (arguments, ends): (Vec<_>, Vec<_>) = cases.iter().map(Case::arguments).unzip();
    let found = evaluate(passes, family.function, &arguments, &ends)?;
    let published = match family.function {
        ShapeFunction::Ellipse => {
            let found = evaluate(passes, ShapeFunction::Published, &arguments, &ends)?;
            let pairs = cases.iter().zip(found);
            let errors: Vec<f64> =
                pairs.map(|(case, found)| (f64::from(found) - case.value()).abs()).collect();
            let finite = || errors.iter().filter(|error| error.is_finite());
            Some((errors.len() - finite().count(), finite().fold(0.0, |m: f64, error| m.max(*error))))
        }
        _ => None,
    };
    let error = |(case, found): (&Case, &f32)| family.error(case, f64::from(*found));
    let errors: Vec<f64> = cases.par_iter().zip(&found).map(error).collect();
    Ok(ShapeRow {
        family: family.name.clone(),
        samples: cases.len(),
        out_of_range: out_of_range(&found),
        largest_error: Some(errors.iter().copied().fold(0.0, f64::max)),
        promise: family.promise(),
        shortfall: shortfall(cases, &found, &errors, family.promise()),
        published,
    })
}

/// The worst of the cases whose errors are larger than promised.
fn shortfall(cases: &[Case], found: &[f32], errors: &[f64], promise: f64) -> Option<ShapeShortfall> {
    let (index, worst) = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (*worst > promise).then(|| ShapeShortfall {
        count: errors.iter().filter(|error| **error > promise).count(),
        index,
        shape: cases[index].numbers(),
        result: found[index].to_string(),
        exact: cases[index].value(),
    })
}

/// The row of a kind's results of random bits.
fn of_any_bits(
    passes: &Passes,
    name: &str,
    function: ShapeFunction,
    samples: u64,
    seed: u64,
) -> Result<ShapeRow, EngineError> {
    let mut stream = Stream::new(name, 0, seed);
    let arguments: Vec<ShapeArguments> = (0..samples)
        .map(|_| [[0; 4]; 4].map(|row| row.map(|_: u32| f32::from_bits(stream.bits()))))
        .collect();
    let ends: Vec<u32> = (0..samples).map(|index| (index % 3) as u32).collect();
    let found = evaluate(passes, function, &arguments, &ends)?;
    Ok(ShapeRow {
        family: format!("{name}, any bits"),
        samples: found.len(),
        out_of_range: out_of_range(&found),
        largest_error: None,
        promise: 0.0,
        shortfall: None,
        published: None,
    })
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
    arguments: &[ShapeArguments],
    ends: &[u32],
) -> Result<Vec<f32>, EngineError> {
    let host = passes.host();
    let inputs = [host.storage_buffer("arguments", arguments)?, host.storage_buffer("ends", ends)?];
    let kernel = (&SHAPES, &[(0, function as u32), (1, 0)][..]);
    let resources = [&inputs[0], &inputs[1]].map(|buffer| Resource::buffer(buffer.handle()));
    let count = arguments.len();
    // SAFETY: The inputs live until this returns.
    let list = unsafe { passes.over_list::<[f32; 4], u32>(kernel, &resources, count as u32, count) }?;
    list.run()?;
    Ok(list.results()?.into_iter().map(|result| result[0]).collect())
}

/// The rows as a Markdown table, whose heads say what is in it; after it the worst case of each family that
/// broke its promise.
pub fn markdown(rows: &[ShapeRow]) -> String {
    let row = |row: &ShapeRow| {
        let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
        let published = row.published.map(|(count, error)| [count.to_string(), format!("{error:.0e}")]);
        let mut cells = vec![
            row.family.clone(),
            or_none(row.largest_error.map(|error| format!("{error:.1e}"))),
            or_none(row.largest_error.map(|_| format!("{:.0e}", row.promise))),
            row.out_of_range.to_string(),
            if row.is_kept() { "kept" } else { "**BROKEN**" }.to_owned(),
        ];
        cells.extend(published.unwrap_or_default());
        cells
    };
    let heads = "family | largest error | promised | out of [0, 1] | verdict | published: not finite | \
        its largest error";
    let mut text = Table::new(heads, rows.iter().map(row)).to_markdown();
    for row in rows {
        let Some(worst) = &row.shortfall else { continue };
        let _ = writeln!(
            text,
            "\n{}: {} of {} broken, worst #{}: {} for {:e}, {}",
            row.family, worst.count, row.samples, worst.index, worst.result, worst.exact, worst.shape
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_from_0_to_1_is_counted() {
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
            shortfall: None,
            published: None,
        };
        assert!(row(Some(1e-7), 0).is_kept() && row(None, 0).is_kept());
        for broken in [row(Some(2e-6), 0), row(Some(f64::NAN), 0), row(None, 1)] {
            assert!(!broken.is_kept() && markdown(&[broken]).contains("BROKEN"));
        }
    }

    #[test]
    fn the_worst_case_is_named_with_what_makes_it_again() {
        let family = &families()[0];
        let cases: Vec<Case> = (0..3).map(|index| family.case(index, 0)).collect();
        let found = [0.0, f32::NAN, 0.0];
        let errors = [2e-6, f64::INFINITY, 0.0];
        let worst = shortfall(&cases, &found, &errors, 1e-6).unwrap();
        assert_eq!((worst.count, worst.index, worst.result.as_str()), (2, 1, "NaN"));
        assert_eq!((worst.shape, worst.exact), (cases[1].numbers(), cases[1].value()));
        // The twin: where the promise is kept, none is
        assert_eq!(shortfall(&cases, &found, &[1e-6; 3], 1e-6), None);
    }
}
