//! Statistics for people: as text for a terminal, as Markdown for the documents.

use super::words::Words;
use super::{Compiled, Family, Measured};
use crate::table::Table;

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
    let count = family.rows.len();
    let time =
        family.seconds().map(|time| format!(": {count} rows compiled in {time:.1} s of processor time"));
    format!("{}, {}{}", family.family, family.driver, time.unwrap_or_default())
}

/// Which rows spill, and which leave a SIMD few waves, as far as the driver's words are known.
fn crowded(family: &Family) -> String {
    let list = |what: &str, is_such: &dyn Fn(&Measured) -> bool| {
        let names: Vec<String> =
            family.rows.iter().filter(|row| is_such(row)).map(|row| format!("`{}`", row.name())).collect();
        let (count, all) = (names.len(), family.rows.len());
        let names = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
        format!("- {what}, {count} of {all} rows{names}\n")
    };
    let words = Words::of(&family.driver);
    let spills = |row: &Measured| words.spills.iter().any(|name| row.number(name) > 0);
    let mut text = String::new();
    if !words.spills.is_empty() {
        text += &list("Registers spill", &spills);
    }
    if let Some(waves) = words.waves {
        let few = family.rows.iter().map(|row| row.number(waves)).max().unwrap_or(0) / 4;
        let what = format!("At most {few} waves, a quarter of the most");
        text += &list(&what, &|row| row.number(waves) <= few);
    }
    text
}

/// A row per shader, a column per statistic.
fn table(family: &Family) -> Table {
    let shown = Words::of(&family.driver).shown(family);
    let heads = shown.iter().map(|(_, head)| *head);
    let has_ratios = family.rows.iter().any(|row| row.ratio.is_some());
    let ratio = has_ratios.then_some("ratio");
    let heads: Vec<&str> =
        [""].into_iter().chain(ratio).chain(["wave"]).chain(heads).chain(["CPU s"]).collect();
    let cells = |row: &Measured| {
        let ratio = row.ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        let ratio = has_ratios.then_some(ratio);
        let seconds = row.seconds.map_or("–".to_owned(), |seconds| format!("{seconds:.1}"));
        let said = shown.iter().map(|(name, _)| row.said.get(*name).map_or("–".to_owned(), u64::to_string));
        let wave = row.subgroup_size.to_string();
        [row.name()].into_iter().chain(ratio).chain([wave]).chain(said).chain([seconds]).collect()
    };
    Table::new(&heads.join(" | "), family.rows.iter().map(cells))
}
