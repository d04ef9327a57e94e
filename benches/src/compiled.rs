//! What a GPU's compiler makes of the kernels: registers, waves, instructions, and its own estimate of
//! cycles, beside yardsticks. Nothing runs, and no GPU is needed: [`arealight_engine::host::families`].

mod check;
mod rows;
mod text;
mod words;

pub(crate) use rows::path_cost;

pub use check::{Check, Finding, OtherDriver};
pub use rows::{DEFERRED_YARDSTICK, Row, YARDSTICK, rows};

use arealight_engine::host::HostError;
use arealight_engine::host::null_hardware::{Compiler, Said};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use words::Words;

/// Statistics of shaders on families of GPU.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Compiled {
    /// Each family once.
    pub families: Vec<Family>,
}

/// Statistics on one family of GPU.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Family {
    /// As the driver calls it: `navi21`.
    pub family: String,
    /// The driver and its version, on which the numbers depend.
    pub driver: String,
    /// In the order of [`rows`].
    pub rows: Vec<Measured>,
}

/// What the compiler says of a row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// [`Row::kernel`].
    pub kernel: String,
    /// [`Row::lights`].
    pub lights: String,
    /// [`Row::level`].
    pub level: String,
    /// [`Family::work`] over that of [`Row::yardstick`]; `None` where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// Invocations a wave.
    pub subgroup_size: u32,
    /// What the driver says, by its own names.
    pub said: BTreeMap<String, u64>,
    /// Processor time that making the pipeline took, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

impl Measured {
    /// What the driver says by that name.
    pub fn number(&self, name: &str) -> u64 {
        self.said.get(name).copied().unwrap_or(0)
    }

    /// As [`Row::name`].
    pub fn name(&self) -> String {
        format!("{}: {}, {}", self.kernel, self.lights, self.level)
    }
}

/// The rows whose names contain `pattern` (upper and lower case are the same), and those that they are held
/// against.
pub fn matching(pattern: &str) -> Vec<Row> {
    let pattern = pattern.to_lowercase();
    let (all, is_wanted) = (rows(), |row: &Row| row.name().to_lowercase().contains(&pattern));
    let yardsticks: Vec<&str> =
        all.iter().filter(|row| is_wanted(row)).filter_map(|row| row.yardstick).collect();
    let chosen = all.iter().filter(|row| is_wanted(row) || yardsticks.contains(&&*row.name()));
    chosen.cloned().collect()
}

/// Compiles a row.
///
/// # Errors
/// Where no pipeline can be made of it, or the driver doesn't say what [`Check`] and the ratios need.
pub fn measure(compiler: &Compiler, row: &Row) -> Result<Measured, HostError> {
    let Said { subgroup_size, numbers: said, seconds } = compiler.said(&row.shader())?;
    if let Some(name) = Words::of(compiler.driver()).needed().find(|name| !said.contains_key(*name)) {
        return Err(HostError::MissingStatistic(name));
    }
    let (kernel, lights, level) = (row.kernel.to_owned(), row.lights.to_owned(), row.level.to_owned());
    Ok(Measured { kernel, lights, level, ratio: None, subgroup_size, said, seconds })
}

/// Compiles rows by a device's own driver, as a family of the device's name. `progress` is told of each.
///
/// # Errors
/// Where there is no such device, or it gives no statistics.
pub fn of_device(device: Option<&str>, rows: &[Row], progress: &dyn Fn()) -> Result<Family, HostError> {
    let compiler = Compiler::of_device(device)?;
    let measured = rows.iter().map(|row| measure(&compiler, row).inspect(|_| progress()));
    let measured = measured.collect::<Result<_, HostError>>()?;
    Ok(Family::new(compiler.device_name().to_owned(), compiler.driver().to_owned(), measured))
}

impl Family {
    /// The rows that were measured, with their ratios.
    pub fn new(family: String, driver: String, rows: Vec<Measured>) -> Self {
        let mut found = Self { family, driver, rows };
        for row in self::rows() {
            let work = |name: &str| found.find(name).and_then(|one| found.work(one));
            let ratio = row.yardstick.and_then(work).zip(work(&row.name()));
            let ratio = ratio.map(|(yardstick, one)| one / yardstick);
            if let Some(measured) = found.rows.iter_mut().find(|measured| measured.name() == row.name()) {
                // Three decimals: the rest is no difference to anybody
                measured.ratio = ratio.map(|ratio| (ratio * 1000.0).round() / 1000.0);
            }
        }
        found
    }

    /// The driver's estimate of what an invocation costs; `None` of a driver that gives none.
    pub fn work(&self, row: &Measured) -> Option<f64> {
        let work = row.number(Words::of(&self.driver).work?);
        Some(work as f64 / f64::from(row.subgroup_size))
    }

    /// The row of that name.
    pub fn find(&self, name: &str) -> Option<&Measured> {
        self.rows.iter().find(|row| row.name() == name)
    }

    /// Processor time of all rows, in seconds; `None` where the system does not tell.
    pub fn seconds(&self) -> Option<f64> {
        self.rows.iter().map(|row| row.seconds).sum()
    }
}

impl Compiled {
    /// The statistics on a family.
    pub fn find(&self, family: &str) -> Option<&Family> {
        self.families.iter().find(|one| one.family == family)
    }

    /// These statistics in the place of the same families' in `older`, whose others stay.
    #[must_use]
    pub fn replacing(mut self, older: Self) -> Self {
        let new: Vec<String> = self.families.iter().map(|one| one.family.clone()).collect();
        self.families.extend(older.families.into_iter().filter(|one| !new.contains(&one.family)));
        self.families.sort_by(|a, b| a.family.cmp(&b.family));
        self
    }

    /// JSON to check in: a line a row, and nothing that differs from run to run.
    pub fn to_checked_in(&self) -> String {
        /// Strings and numbers, with strings for keys, always serialise.
        fn json(value: &impl Serialize) -> String {
            serde_json::to_string(value).unwrap_or_default()
        }
        let family = |family: &Family| {
            let words = Words::of(&family.driver);
            let row = |row: &Measured| {
                let mut row = Measured { seconds: None, ..row.clone() };
                row.said.retain(|name, _| words.needed().any(|needed| needed == name));
                json(&row)
            };
            let rows = family.rows.iter().map(row);
            let rows: Vec<String> = rows.map(|row| format!("        {row}")).collect();
            format!(
                "    {{\n      \"family\": {},\n      \"driver\": {},\n      \"rows\": \
                [\n{}\n      ]\n    }}",
                json(&family.family),
                json(&family.driver),
                rows.join(",\n")
            )
        };
        let families: Vec<String> = self.families.iter().map(family).collect();
        format!("{{\n  \"families\": [\n{}\n  ]\n}}\n", families.join(",\n"))
    }
}
