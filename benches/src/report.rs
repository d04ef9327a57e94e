//! A battery's result for people: as text for a terminal, as Markdown for the documents.

use crate::method::{METHODS, Method};
use crate::stability::{Row, Stability};
use arealight_oracle::hard::family::{Family, Scope};
use std::fmt::Write as _;

/// The heads of a table's columns.
const HEADS: [&str; 6] = ["family", "error", "backward", "small light", "not finite", "verdict"];

impl Row {
    /// The row's cells, under [`HEADS`].
    fn cells(&self) -> [String; 6] {
        let tally = &self.tally;
        let number = |error: Option<f64>| match error {
            None => "-".to_owned(),
            Some(error) if error.is_finite() => format!("{error:.1e}"),
            Some(_) => "inf".to_owned(),
        };
        [
            self.family.to_owned(),
            number(tally.largest_error),
            number(tally.largest_backward_error),
            number(tally.largest_small_light_error),
            tally.not_finite.to_string(),
            self.verdict(),
        ]
    }

    /// Whether the promises were kept, and how nearly or by how much they were not.
    fn verdict(&self) -> String {
        if self.tally.samples == 0 {
            return "takes none".to_owned();
        }
        if self.tally.shortfalls.is_empty() {
            let largest = self.tally.largest_ratios.values().fold(0.0_f64, |m, ratio| m.max(*ratio));
            return match self.scope {
                Scope::Accuracy => format!("kept, at {largest:.2} of the bound"),
                Scope::Range | Scope::Zero => "kept".to_owned(),
            };
        }
        let samples = self.tally.samples;
        let broken = self.tally.shortfalls.iter().map(|(promise, shortfall)| {
            let by = if shortfall.ratio.is_finite() {
                format!(" at {:.3} of the bound", shortfall.ratio)
            } else {
                String::new()
            };
            format!("{promise} {} of {samples}, worst #{}{by}", shortfall.count, shortfall.index)
        });
        format!("BROKEN: {}", broken.collect::<Vec<_>>().join("; "))
    }
}

impl Stability {
    /// The methods that ran, each with its rows.
    fn by_method(&self) -> impl Iterator<Item = (&'static Method, Vec<&Row>)> {
        METHODS.iter().filter_map(|method| {
            let rows: Vec<&Row> = self.rows.iter().filter(|row| row.method == method.name).collect();
            (!rows.is_empty()).then_some((method, rows))
        })
    }

    /// What a method did, in a sentence.
    fn summary(method: &Method, rows: &[&Row]) -> String {
        let broken = rows.iter().filter(|row| !row.is_kept()).count();
        let polygons: usize = rows.iter().map(|row| row.tally.samples).sum();
        let not_finite: usize = rows.iter().map(|row| row.tally.not_finite).sum();
        let told = match broken {
            0 => "keeps every promise".to_owned(),
            _ => format!("breaks promises in {broken} of {} families", rows.len()),
        };
        let whose = if method.is_yardstick { " (a yardstick, held to the best rung's promises)" } else { "" };
        format!("{told}{whose}; {polygons} polygons, {not_finite} results not finite")
    }

    /// One table a method, for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for (method, rows) in self.by_method() {
            let _ =
                writeln!(text, "{}: {}\n  {}", method.name, method.description, Self::summary(method, &rows));
            let heads = HEADS.map(str::to_owned);
            for [family, error, backward, small, not_finite, verdict] in
                std::iter::once(heads).chain(rows.iter().map(|row| row.cells()))
            {
                let _ = writeln!(
                    text,
                    "  {family:<17} {error:>8} {backward:>9} {small:>12} {not_finite:>11}  {verdict}"
                );
            }
            text.push('\n');
        }
        text + &self.conclusion()
    }

    /// Whether our methods keep their promises, and that the yardsticks do not.
    fn conclusion(&self) -> String {
        let mut text = String::new();
        for (method, rows) in self.by_method() {
            let broken = rows.iter().filter(|row| !row.is_kept()).count();
            if method.is_yardstick {
                let _ =
                    writeln!(text, "{} breaks promises in {broken} of {} families", method.name, rows.len());
            }
        }
        match self.shortfalls().count() {
            0 => text + "Every promise of ours is kept.\n",
            count => format!("{text}OUR PROMISES ARE BROKEN in {count} rows: see above.\n"),
        }
    }

    /// One table a method, and what the families are.
    pub fn to_markdown(&self) -> String {
        let mut text =
            format!("{} polygons a family, seed {}, on {}.\n\n", self.samples, self.seed, self.device);
        for (method, rows) in self.by_method() {
            let _ = writeln!(
                text,
                "### {}\n\n{}. It {}.\n\n| {} |\n|---|---|---|---|---|---|",
                method.name,
                method.description,
                Self::summary(method, &rows),
                HEADS.join(" | ")
            );
            for row in rows {
                let _ = writeln!(text, "| {} |", row.cells().join(" | "));
            }
            text.push('\n');
        }
        text.push_str("### Families\n\n| family | what makes it hard | judged by |\n|---|---|---|\n");
        let mut names: Vec<&str> = self.rows.iter().map(|row| row.family).collect();
        names.dedup();
        for family in names.into_iter().filter_map(Family::find) {
            let scope = match family.scope {
                Scope::Accuracy => "every promise",
                Scope::Range => "a number from 0 to 1",
                Scope::Zero => "exactly 0",
            };
            let _ = writeln!(text, "| {} | {} | {scope} |", family.name, family.description);
        }
        text
    }
}
