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
    let rows = family.rows.iter().map(cells).collect();
    Table { heads: HEADS.iter().map(|head| (*head).to_owned()).collect(), rows }
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

/// The lines that a generated section of a document lies between.
#[derive(Debug, Clone, Copy)]
pub struct Markers {
    /// The line before.
    pub begin: &'static str,
    /// The line after.
    pub end: &'static str,
}

impl Markers {
    /// Of the tables of this module.
    pub const TABLES: Self = Self {
        begin: "<!-- begin: arealight bench compiled -->",
        end: "<!-- end: arealight bench compiled -->",
    };

    /// Of the modelled frames.
    pub const MODEL: Self = Self {
        begin: "<!-- begin: arealight bench compiled --model -->",
        end: "<!-- end: arealight bench compiled --model -->",
    };
}

/// The document with `section` between its markers; `None` where it has no such place.
pub fn replace_section(document: &str, markers: Markers, section: &str) -> Option<String> {
    let (before, rest) = document.split_once(markers.begin)?;
    let (_, after) = rest.split_once(markers.end)?;
    let (begin, end) = (markers.begin, markers.end);
    Some(format!("{before}{begin}\n\n{}\n\n{end}{after}", section.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_takes_the_place_of_the_one_before() {
        let document =
            format!("# Title\n\n{}\nold\n{}\n\n## More\n", Markers::TABLES.begin, Markers::TABLES.end);
        let new = replace_section(&document, Markers::TABLES, "new\n").unwrap();
        assert!(new.starts_with("# Title\n\n<!-- begin") && new.ends_with("-->\n\n## More\n"), "{new}");
        assert!(new.contains("\n\nnew\n\n") && !new.contains("old"));
        assert_eq!(
            replace_section(&new, Markers::TABLES, "new").as_deref(),
            Some(&*new),
            "again is the same"
        );
        assert_eq!(replace_section("# Title\n", Markers::TABLES, "new"), None);
    }
}
