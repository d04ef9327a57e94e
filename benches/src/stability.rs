//! The battery: every family of hard cases through every method on a device, each result judged by its bits.

use crate::kernel::FormFactorKernel;
use crate::method::{METHODS, Method};
use arealight::LightTable;
use arealight_cases::hard::HardCase;
use arealight_cases::hard::family::{FAMILIES, Family, Scope};
use arealight_cases::hard::judge::{Finding, Judged, Tally};
use arealight_engine::EngineError;
use arealight_engine::host::Host;
use rayon::prelude::*;
use serde::Serialize;

/// How many cases go to the device at once.
const BATCH: u64 = 10_000;

/// What to run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Cases of each family.
    pub samples: u64,
    /// Another seed makes other cases.
    pub seed: u64,
    /// The families.
    pub families: Vec<&'static Family>,
    /// The methods.
    pub methods: Vec<&'static Method>,
}

impl Default for Options {
    /// Every family through every method, 10,000 cases each.
    fn default() -> Self {
        Self {
            samples: 10_000,
            seed: 0,
            families: FAMILIES.iter().collect(),
            methods: METHODS.iter().collect(),
        }
    }
}

/// A family through a method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The family's name.
    pub family: &'static str,
    /// What it is judged by.
    pub scope: Scope,
    /// The method's name.
    pub method: &'static str,
    /// The method is no way of ours.
    pub is_yardstick: bool,
    /// What was found. In JSON a number that is not finite is null.
    pub tally: Tally,
}

impl Row {
    /// Whether every promise was kept, or the method is for none of the family's polygons.
    pub fn is_kept(&self) -> bool {
        self.tally.samples == 0 || self.tally.is_kept()
    }
}

/// What the battery found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stability {
    /// The device's name.
    pub device: String,
    /// Cases of each family.
    pub samples: u64,
    /// The seed of the cases.
    pub seed: u64,
    /// Family by family, each method in turn.
    pub rows: Vec<Row>,
}

impl Stability {
    /// Where a method of ours falls short of what it promises.
    pub fn shortfalls(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.is_yardstick && !row.is_kept())
    }

    /// The families in which a method breaks a promise.
    pub fn broken_families(&self, method: &str) -> Vec<&'static str> {
        let broken = self.rows.iter().filter(|row| row.method == method && !row.is_kept());
        broken.map(|row| row.family).collect()
    }
}

/// Runs the battery on a device. `table` gives the lobes of the families that have one; `progress` is told
/// how many more cases are done.
pub fn run(
    host: &Host,
    table: &LightTable,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<Stability, EngineError> {
    let kernel = FormFactorKernel::new(host, &options.methods)?;
    let mut rows = Vec::new();
    for family in &options.families {
        let mut tallies = vec![Tally::default(); options.methods.len()];
        let mut first = 0;
        while first < options.samples {
            let count = BATCH.min(options.samples - first);
            let indices = first..first + count;
            let cases: Vec<HardCase> =
                indices.into_par_iter().map(|index| family.case(index, options.seed, table)).collect();
            let results = kernel.run(&cases)?;
            judge(family, first, &cases, &options.methods, &results, &mut tallies);
            first += count;
            progress(count);
        }
        rows.extend(options.methods.iter().zip(tallies).map(|(method, tally)| Row {
            family: family.name,
            scope: family.scope,
            method: method.name,
            is_yardstick: method.is_yardstick,
            tally,
        }));
    }
    Ok(Stability { device: host.device_name(), samples: options.samples, seed: options.seed, rows })
}

/// Judges a batch of cases, the first of which has the index `first`: `results` has the bits of each
/// method's.
fn judge(
    family: &Family,
    first: u64,
    cases: &[HardCase],
    methods: &[&Method],
    results: &[Vec<u32>],
    tallies: &mut [Tally],
) {
    let judged: Vec<Judged> = cases.par_iter().map(|case| Judged::new(family, case)).collect();
    for ((method, results), tally) in methods.iter().zip(results).zip(tallies) {
        let judge = |((case, judged), bits): ((&HardCase, &Judged), &u32)| {
            method.takes(case).then(|| judged.judge(*bits))
        };
        let findings: Vec<Option<Finding>> = cases.par_iter().zip(&judged).zip(results).map(judge).collect();
        for (((index, bits), judged), finding) in (first..).zip(results).zip(&judged).zip(&findings) {
            if let Some(finding) = finding {
                let exact = judged.reference().map(|reference| reference.form_factor);
                tally.add(index, *bits, exact, finding);
            }
        }
    }
}
