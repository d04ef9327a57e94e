//! Statistics for people: as text for a terminal, as Markdown for the documents.

use super::{Compiled, Family, Measured};
use crate::table::Table;
use std::fmt::Write as _;

const HEADS: &str = " | ratio | inverse throughput | VGPRs | waves | SGPRs | spilled VGPRs | spilled SGPRs | \
    scratch | instructions | branches | bytes | latency | CPU s";

impl Compiled {
    /// The tables for a terminal.
    pub fn to_text(&self) -> String {
        let family = |family: &Family| format!("{}\n{}", heading(family), table(family).to_text());
        self.families.iter().map(family).collect::<Vec<_>>().join("\n")
    }

    /// The tables as Markdown.
    pub fn to_markdown(&self) -> String {
        let family = |family: &Family| {
            format!(
                "### {}\n\n{}.\n\n{}\n{}",
                family.family,
                heading(family),
                crowded(family),
                table(family).to_markdown()
            )
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

/// Which rows spill, and which leave a SIMD few waves.
fn crowded(family: &Family) -> String {
    let list = |what: &str, is_such: &dyn Fn(&Measured) -> bool| {
        let names: Vec<String> =
            family.rows.iter().filter(|row| is_such(row)).map(|row| format!("`{}`", row.name())).collect();
        let (count, all) = (names.len(), family.rows.len());
        let names = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
        format!("- {what}, {count} of {all} rows{names}\n")
    };
    let most = family.rows.iter().map(|row| row.waves).max().unwrap_or(0);
    let few = most / 4;
    list("Registers spill", &|row| row.spilled_vgprs + row.spilled_sgprs > 0)
        + &list(&format!("At most {few} waves, a quarter of the most"), &|row| row.waves <= few)
}

fn table(family: &Family) -> Table {
    Table::new(HEADS, family.rows.iter().map(cells))
}

fn cells(row: &Measured) -> Vec<String> {
    let mut cells = vec![row.name(), row.ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"))];
    let numbers = [
        row.inverse_throughput,
        row.vgprs,
        row.waves,
        row.sgprs,
        row.spilled_vgprs,
        row.spilled_sgprs,
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
