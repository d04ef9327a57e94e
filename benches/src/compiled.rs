//! What a GPU's compiler makes of the kernels: registers, waves, instructions, and its own estimate of
//! cycles, beside yardsticks. Nothing runs, and no GPU is needed: [`arealight_engine::host::null_hardware`].

mod check;
mod own_words;
mod rows;
mod text;

pub(crate) use rows::path_cost;

pub use check::{Check, Finding, OtherDriver, THROUGHPUT_TOLERANCE};
pub use own_words::{OwnWords, of_device};
pub use rows::{DEFERRED_YARDSTICK, Row, YARDSTICK, rows};

use arealight_engine::host::HostError;
use arealight_engine::host::null_hardware::{Compiler, Statistics};
use serde::{Deserialize, Serialize};

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
    /// Inverse throughput over that of [`Row::yardstick`]; `None` where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// The compiler's estimate of the cycles that a wave keeps a SIMD's units busy.
    pub inverse_throughput: u64,
    /// Vector registers an invocation.
    pub vgprs: u64,
    /// Scalar registers a wave.
    pub sgprs: u64,
    /// How many waves a SIMD holds at a time.
    pub waves: u64,
    /// Vector registers that did not fit and went to memory.
    pub spilled_vgprs: u64,
    /// Scalar registers that did not fit and went to lanes of vector registers.
    pub spilled_sgprs: u64,
    /// Memory of its own a wave, in bytes.
    pub scratch: u64,
    /// Instructions.
    pub instructions: u64,
    /// Branches among them.
    pub branches: u64,
    /// Machine code in bytes.
    pub code_size: u64,
    /// The compiler's estimate of the cycles from a wave's start to its end.
    pub latency: u64,
    /// Invocations a wave.
    pub subgroup_size: u32,
    /// Processor time that making the pipeline took, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

impl Measured {
    fn new(row: &Row, said: &Statistics) -> Self {
        Self {
            kernel: row.kernel.to_owned(),
            lights: row.lights.to_owned(),
            level: row.level.to_owned(),
            ratio: None,
            inverse_throughput: said.inverse_throughput,
            vgprs: said.vgprs,
            sgprs: said.sgprs,
            waves: said.waves,
            spilled_vgprs: said.spilled_vgprs,
            spilled_sgprs: said.spilled_sgprs,
            scratch: said.scratch,
            instructions: said.instructions,
            branches: said.branches,
            code_size: said.code_size,
            latency: said.latency,
            subgroup_size: said.subgroup_size,
            seconds: said.seconds,
        }
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

/// Compiles a row on this process's null hardware.
pub fn measure(compiler: &Compiler, row: &Row) -> Result<Measured, HostError> {
    Ok(Measured::new(row, &compiler.statistics(&row.shader())?))
}

impl Family {
    /// The rows that were measured, with their ratios.
    pub fn new(family: String, driver: String, rows: Vec<Measured>) -> Self {
        let mut found = Self { family, driver, rows };
        for row in self::rows() {
            let throughput = |name: &str| found.find(name).map(|one| one.inverse_throughput as f64);
            let ratio = row.yardstick.and_then(throughput).zip(throughput(&row.name()));
            let ratio = ratio.map(|(yardstick, one)| one / yardstick);
            if let Some(measured) = found.rows.iter_mut().find(|measured| measured.name() == row.name()) {
                // Three decimals: the rest is no difference to anybody
                measured.ratio = ratio.map(|ratio| (ratio * 1000.0).round() / 1000.0);
            }
        }
        found
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
            let rows = family.rows.iter().map(|row| json(&Measured { seconds: None, ..row.clone() }));
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
