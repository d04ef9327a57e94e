//! A battery's result for people: as text for a terminal, as Markdown for the documents.

use crate::method::{METHODS, Method};
use crate::stability::{Row, Stability};
use arealight_cases::hard::family::{Family, Scope};
use std::fmt::Write as _;

/// The heads of a table's columns.
const HEADS: [&str; 6] = ["family", "error", "backward", "small light", "not finite", "verdict"];

/// The methods that stand side by side in the document's first table.
pub(crate) const OVERVIEW: [&str; 6] =
    ["polygon-exact", "quad-exact", "sphere-horizon", "clipless", "clip-by-cases", "clip-and-acos"];

/// The document's words on the first table.
const PROMISES: &str = "\
Each family's polygons go through the library's form factors, and through what others ship: \
sphere-horizon (EEVEE, LearnOpenGL: no clip, a clipped sphere of the same form factor), clipless (three.js, \
HDRP's default: no clip, a rational function in its place), clip-by-cases (Bevy, Godot, ltc_code: quads \
clipped by 16 cases); and clip-and-acos, which clips any outline and takes arc cosines, as the first listing \
of Heitz et al. 2016. The bits of each result are judged against a reference of 106 bits:

1. A finite number in [0, 1]; exactly 0 where a vertex is NaN or infinite.
2. *Backward*: within 6e-7 of the interval of values that the polygons have whose vertices differ by at most \
4 x 2^-24 of their distance.
3. *Forward*: error at most 1e-6 + 1e-7 / rho, rho being the distance to the polygon over that to its \
farthest vertex.
4. *Small light*, of one at n times its extent: error at most 8e-7 n of area / (pi distance^2); of one that \
crosses the horizon 1e-5 n.

The yardsticks are held to the same; `-` is a family whose polygons they don't take.

The table gives the largest backward error; **bold** is a promise broken. A forward error \
near 1 beside a small backward one is contact: on a light's surface the form factor jumps, and no float32 \
vertex says on which side it is.

";

impl Row {
    /// The largest backward error, bold where a promise is broken; and how many results were no numbers.
    fn overview(&self) -> String {
        let tally = &self.tally;
        if tally.samples == 0 {
            return "-".to_owned();
        }
        let error = match tally.largest_backward_error {
            Some(error) if error.is_finite() => format!("{error:.1e}"),
            _ if tally.not_finite > 0 => format!("{} NaN, inf", tally.not_finite),
            Some(_) | None if self.is_kept() => "kept".to_owned(),
            Some(_) | None => "wrong".to_owned(),
        };
        if self.is_kept() { error } else { format!("**{error}**") }
    }

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
            let by = match shortfall.ratio {
                ratio if !ratio.is_finite() => String::new(),
                ratio if ratio >= 1000.0 => format!(" at {ratio:.1e} of the bound"),
                ratio => format!(" at {ratio:.3} of the bound"),
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

    /// How many families have polygons for the method of these rows.
    fn taken(rows: &[&Row]) -> usize {
        rows.iter().filter(|row| row.tally.samples > 0).count()
    }

    /// What a method did, in a sentence.
    fn summary(method: &Method, rows: &[&Row]) -> String {
        let broken = rows.iter().filter(|row| !row.is_kept()).count();
        let polygons: usize = rows.iter().map(|row| row.tally.samples).sum();
        let not_finite: usize = rows.iter().map(|row| row.tally.not_finite).sum();
        let told = match broken {
            0 => "keeps every promise".to_owned(),
            _ => format!("breaks promises in {broken} of {} families", Self::taken(rows)),
        };
        let whose = if method.is_yardstick { " (a yardstick, held to ours)" } else { "" };
        format!("{told}{whose}; {polygons} polygons, {not_finite} results not finite")
    }

    /// A summary of each method, and a table of the families where one of ours falls short; or of every
    /// family. For a terminal.
    pub fn to_text(&self, has_every_family: bool) -> String {
        let mut text = String::new();
        for (method, mut rows) in self.by_method() {
            let _ =
                writeln!(text, "{}: {}\n  {}", method.name, method.description, Self::summary(method, &rows));
            if !has_every_family {
                rows.retain(|row| !method.is_yardstick && !row.is_kept());
            }
            if rows.is_empty() {
                continue;
            }
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
                let of = Self::taken(&rows);
                let _ = writeln!(text, "{} breaks promises in {broken} of {of} families", method.name);
            }
        }
        match self.shortfalls().count() {
            0 => text + "Every promise of ours is kept.\n",
            count => format!("{text}OUR PROMISES ARE BROKEN in {count} rows: see above.\n"),
        }
    }

    /// A document: what is promised, every family by the methods of `OVERVIEW`, and one table a method.
    pub fn to_markdown(&self) -> String {
        let mut text = format!(
            "# Hard cases, every number\n\nMade by `arealight bench stability --samples {} --seed {} \
            --markdown FILE` on {}. [What they say](../stability.md).\n\n{PROMISES}",
            self.samples, self.seed, self.device
        );
        self.write_overview(&mut text);
        let _ = writeln!(text, "## Every method\n");
        for (method, rows) in self.by_method() {
            let _ = writeln!(
                text,
                "<details><summary>{}: {}</summary>\n\n{}. It {}.\n\n| {} |\n|---|---|---|---|---|---|",
                method.name,
                if rows.iter().all(|row| row.is_kept()) { "kept" } else { "broken" },
                method.description,
                Self::summary(method, &rows),
                HEADS.join(" | ")
            );
            for row in rows {
                let _ = writeln!(text, "| {} |", row.cells().join(" | "));
            }
            text.push_str("\n</details>\n\n");
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
        text
    }

    /// A line a family: what makes it hard, and the largest backward error of the methods of `OVERVIEW`.
    fn write_overview(&self, text: &mut String) {
        let methods: Vec<_> =
            self.by_method().filter(|(method, _)| OVERVIEW.contains(&method.name)).collect();
        let names: Vec<&str> = methods.iter().map(|(method, _)| method.name).collect();
        let _ = writeln!(text, "| family | what makes it hard | {} |", names.join(" | "));
        let _ = writeln!(text, "|---|---|{}", "---|".repeat(names.len()));
        let mut families: Vec<&str> = self.rows.iter().map(|row| row.family).collect();
        families.dedup();
        for family in families.into_iter().filter_map(Family::find) {
            let cells = methods.iter().map(|(_, rows)| {
                rows.iter()
                    .find(|row| row.family == family.name)
                    .map_or_else(String::new, |row| row.overview())
            });
            let cells: Vec<String> = cells.collect();
            let _ = writeln!(text, "| {} | {} | {} |", family.name, family.description, cells.join(" | "));
        }
        text.push('\n');
    }
}
