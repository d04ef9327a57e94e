//! What was found, for people: as text for a terminal, as Markdown for the documents.

use super::cost::UNTEXTURED;
use super::{Footprints, JUDGED_PICTURES, METHODS, Method, Row};
use crate::table::Table;
use crate::textures;
use arealight_oracle::shading::poses::Family;
use std::fmt::Write as _;

/// The document before and after what is measured.
const HEAD: &str = include_str!("head.txt");
const TAIL: &str = include_str!("tail.txt");

/// A row for each method, under its name.
fn by_method(heads: &[String], cells: impl Fn(&Method) -> Vec<String>) -> Table {
    let heads = std::iter::once("lookup".to_owned()).chain(heads.iter().cloned()).collect();
    let row = |method: &Method| {
        let mut row = vec![method.name.to_owned()];
        row.extend(cells(method));
        row
    };
    Table { heads, rows: METHODS.iter().map(row).collect() }
}

impl Row {
    /// nRMSE; median; marked where the bar is missed.
    fn cell(&self, mark: &str) -> String {
        let errors = format!("{}; {}", percent(self.errors.rmse), percent(self.errors.median));
        if self.is_kept() { errors } else { format!("{mark}{errors}{mark}") }
    }
}

/// Two digits of what is small, else one after the point at most.
fn percent(value: f64) -> String {
    match value.abs() {
        small if small < 0.995 => format!("{value:.2}"),
        large if large >= 99.5 => format!("{value:.0}"),
        _ => format!("{value:.1}"),
    }
}

impl Footprints {
    /// A cell for each family.
    fn by_family(&self, pictures: &str, cell: impl Fn(&Row) -> String) -> Table {
        let heads = Family::ALL.map(|family| family.description().to_owned());
        by_method(&heads, |method| {
            let is_it = |row: &&Row| row.pictures == pictures && row.method == method.name;
            self.rows.iter().filter(is_it).map(&cell).collect()
        })
    }

    /// The first table: errors and costs.
    fn overview(&self, mark: &str) -> Table {
        let mut table = self.by_family(JUDGED_PICTURES, |row| row.cell(mark));
        if self.costs.is_empty() {
            return table;
        }
        table.heads.push("time, no texture = 1".to_owned());
        let mut plain = vec![String::new(); table.heads.len() - 1];
        UNTEXTURED.clone_into(&mut plain[0]);
        table.rows.insert(0, plain);
        for (row, cost) in table.rows.iter_mut().zip(&self.costs) {
            row.push(format!("{:.2}", cost.to_untextured));
        }
        table
    }

    fn bars(&self) -> Table {
        let mut table = self.by_family(JUDGED_PICTURES, |row| {
            row.bar.map_or_else(String::new, |bar| format!("{}; {}", bar.rmse, bar.median))
        });
        // The yardstick has none
        table.rows.remove(0);
        table
    }

    fn biases(&self) -> Table {
        self.by_family(JUDGED_PICTURES, |row| format!("{:+.2}", row.errors.bias))
    }

    fn spots(&self) -> Table {
        let pictures = self.rows.last().map_or("", |row| row.pictures);
        self.by_family(pictures, |row| row.cell(""))
    }

    fn far_table(&self) -> Table {
        let first = &METHODS[0];
        let of = |method: &Method| {
            let name = method.name;
            self.far.iter().filter(move |far| far.method == name)
        };
        let heads: Vec<String> = of(first).map(|far| format!("{}, {}", far.picture, far.surface)).collect();
        by_method(&heads, |method| of(method).map(|far| format!("{:.4}", far.ratio)).collect())
    }

    /// Tables for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for method in &METHODS {
            let _ = writeln!(text, "  {:<10}  {}", method.name, method.description);
        }
        let overview = self.overview("!").to_text();
        let _ =
            writeln!(text, "\n{JUDGED_PICTURES}: nRMSE %; median %, ! where the bar is missed\n{overview}");
        let _ = writeln!(text, "the same: mean over the true mean, - 1, in %\n{}", self.biases().to_text());
        let _ = writeln!(text, "a bright spot: nRMSE %; median %\n{}", self.spots().to_text());
        let far = self.far_table().to_text();
        let _ = writeln!(text, "a thousand times its size away: mean over the true mean\n{far}");
        match self.shortfalls().count() {
            0 => text + "Every level is within its bars.\n",
            count => format!("{text}LEVELS MISS THEIR BARS in {count} places: see above.\n"),
        }
    }

    /// The document `docs/data/textures.md`.
    pub fn to_markdown(&self) -> String {
        let made = format!(
            "Made by `arealight bench textures --poses {} --seed {} --markdown FILE` on {}.",
            self.poses, self.seed, self.device
        );
        let methods: Vec<String> =
            METHODS.iter().map(|method| format!("| {} | {} |", method.name, method.description)).collect();
        let mut text = HEAD.replace("{made}", &made).replace("{methods}", &methods.join("\n"));
        for (place, table) in [
            ("{errors}", self.overview("**").to_markdown()),
            ("{bars}", self.bars().to_markdown()),
            ("{biases}", self.biases().to_markdown()),
            ("{spots}", self.spots().to_markdown()),
            ("{far}", self.far_table().to_markdown()),
        ] {
            text = text.replace(place, table.trim_end());
        }
        let updates = if self.updates.is_empty() {
            "Not measured.".to_owned()
        } else {
            textures::markdown(&self.updates)
        };
        text + "\n" + &TAIL.replace("{updates}", updates.trim_end())
    }
}
