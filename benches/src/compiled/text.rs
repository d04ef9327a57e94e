//! Statistics for people: as text for a terminal, as Markdown for the documents.

use super::{Compiled, Family, Measured};
use crate::table::Table;
use std::fmt::Write as _;

const HEADS: [&str; 13] = [
    "",
    "ratio",
    "inverse throughput",
    "VGPRs",
    "waves",
    "SGPRs",
    "spills",
    "scratch",
    "instructions",
    "branches",
    "bytes",
    "latency",
    "CPU s",
];

impl Compiled {
    /// The tables for a terminal.
    pub fn to_text(&self) -> String {
        let family = |family: &Family| format!("{}\n{}", heading(family), table(family).to_text());
        self.families.iter().map(family).collect::<Vec<_>>().join("\n")
    }

    /// The tables as Markdown.
    pub fn to_markdown(&self) -> String {
        let family = |family: &Family| {
            format!("### {}\n\n{}.\n\n{}", family.family, heading(family), table(family).to_markdown())
        };
        self.families.iter().map(family).collect::<Vec<_>>().join("\n")
    }
}

fn heading(family: &Family) -> String {
    let sizes: std::collections::BTreeSet<u32> = family.rows.iter().map(|row| row.subgroup_size).collect();
    let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
    let mut text =
        format!("{}, {}: waves of {} invocations", family.family, family.driver, sizes.join(" or "));
    if let Some(seconds) = family.seconds() {
        let _ = write!(text, "; {} rows compiled in {seconds:.1} s of processor time", family.rows.len());
    }
    text
}

fn table(family: &Family) -> Table {
    Table::new(&HEADS, family.rows.iter().map(cells))
}

fn cells(row: &Measured) -> Vec<String> {
    let mut cells = vec![row.name(), row.ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"))];
    let numbers = [
        row.inverse_throughput,
        row.vgprs,
        row.waves,
        row.sgprs,
        row.spills,
        row.scratch,
        row.instructions,
        row.branches,
        row.code_size,
        row.latency,
    ];
    cells.extend(numbers.map(|number| number.to_string()));
    cells.push(row.seconds.map_or("–".to_owned(), |seconds| format!("{seconds:.1}")));
    cells
}
