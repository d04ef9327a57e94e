//! The words in which drivers speak of a shader, and which of them count.

use crate::compiled::Family;
use std::collections::BTreeSet;

/// A driver's words.
#[derive(Debug)]
pub(super) struct Words {
    /// How the driver's name begins.
    driver: &'static str,
    /// Its estimate of what a wave costs, where that can be compared.
    pub work: Option<&'static str>,
    /// How many waves are in flight at a time.
    pub waves: Option<&'static str>,
    /// Registers that went to memory.
    pub spills: &'static [&'static str],
    /// What may not grow beyond what is checked in, with how much more it may be, as a part of that.
    pub held: &'static [(&'static str, f64)],
    /// What a table shows: the driver's names, each with the head of its column where that is another.
    shown: &'static str,
}

/// What a change of the code before moves by other choices of the compiler's, where nothing was added.
const TOLERANCE: f64 = 0.03;

const KNOWN: [Words; 3] = [
    Words {
        driver: "radv",
        work: Some("Inverse Throughput"),
        waves: Some("Subgroups per SIMD"),
        spills: &["Spilled VGPRs", "Spilled SGPRs"],
        held: &[("VGPRs", 0.0), ("Inverse Throughput", TOLERANCE)],
        shown: "Inverse Throughput=inverse throughput | VGPRs | Subgroups per SIMD=waves | SGPRs | \
            Spilled VGPRs=spilled VGPRs | Spilled SGPRs=spilled SGPRs | Scratch size=scratch | \
            Instructions=instructions | Branches=branches | Code size=bytes | Latency=latency",
    },
    Words {
        driver: "Intel open-source Mesa driver",
        // "Cycle Count" has ten rounds of each loop, and both sides of every branch
        work: None,
        waves: None,
        spills: &["Spill Count"],
        held: &[("Instruction Count", TOLERANCE)],
        shown: "Cycle Count=cycles | Instruction Count=instructions | SEND Count=sends | Loop Count=loops | \
            Spill Count=spills | Fill Count=fills | Scratch Memory Size=scratch",
    },
    Words {
        driver: "turnip Mesa driver",
        work: None,
        waves: Some("Max Waves Per Core"),
        spills: &["STP Count"],
        held: &[("Registers used", 0.0), ("Instruction Count", TOLERANCE)],
        shown: "Registers used=registers | Max Waves Per Core=waves | Instruction Count=instructions | \
            NOPs Count=waits among them | cat2 instructions=of two | cat3 instructions=of three | \
            cat4 instructions=special | STP Count=stores | LDP Count=loads of own memory | Code size=bytes",
    },
];

/// Those of a driver that is not known.
const OTHER: Words = Words { driver: "", work: None, waves: None, spills: &[], held: &[], shown: "" };

impl Words {
    /// Of a driver, by its name.
    pub fn of(driver: &str) -> &'static Self {
        KNOWN.iter().find(|words| driver.starts_with(words.driver)).unwrap_or(&OTHER)
    }

    /// Every name that something is decided by.
    pub fn needed(&self) -> impl Iterator<Item = &'static str> {
        let held = self.held.iter().map(|(name, _)| *name);
        self.work.into_iter().chain(self.waves).chain(self.spills.iter().copied()).chain(held)
    }

    /// What a table shows of a family, with the columns' heads: of a driver that is not known, all that
    /// differs between rows.
    pub fn shown<'a>(&self, family: &'a Family) -> Vec<(&'a str, &'a str)> {
        if !self.shown.is_empty() {
            return self.shown.split(" | ").map(|one| one.split_once('=').unwrap_or((one, one))).collect();
        }
        let names: BTreeSet<&str> =
            family.rows.iter().flat_map(|row| row.said.keys()).map(String::as_str).collect();
        let differs = |name: &&str| {
            let values: BTreeSet<_> = family.rows.iter().map(|row| row.said.get(*name)).collect();
            values.len() > 1
        };
        names.into_iter().filter(differs).map(|name| (name, name)).collect()
    }
}
