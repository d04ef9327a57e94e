//! Statistics held against those that are checked in.

use super::words::Words;
use super::{Compiled, Family, Measured};
use std::fmt::Write as _;

/// The families none of whose rows may spill, whatever the file says. Of others they spill at most as many
/// registers as that.
pub const NEVER_SPILL: [&str; 2] = ["navi21", "a660"];

/// What differs from the file.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// The row takes more than the file has, or less.
    Changed {
        /// Whether it fails.
        is_worse: bool,
        /// What of it, as the driver calls it.
        what: &'static str,
        /// The file's.
        file: u64,
        /// This one's.
        found: u64,
    },
    /// The file has no such row.
    Missing,
    /// The file has it, and there is no such row any more.
    Gone,
}

/// Statistics held against a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Family, row, and what there is to say of it.
    pub findings: Vec<(String, String, Finding)>,
    /// How many rows were compared.
    pub compared: usize,
}

/// Why nothing can be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the file's numbers of {family} are by {file}, and this is {here}: another version of the compiler makes \
    other code, so that they can't be compared"
)]
pub struct OtherDriver {
    family: String,
    file: String,
    here: String,
}

impl Check {
    /// Holds `found` against `file`. Rows that the file alone has are [`Finding::Gone`] where `all` were
    /// compiled.
    ///
    /// # Errors
    /// [`OtherDriver`] where the file was made by another version of the driver.
    pub fn new(found: &Compiled, file: &Compiled, all: bool) -> Result<Self, OtherDriver> {
        let mut check = Self { findings: vec![], compared: 0 };
        for family in &found.families {
            let Some(older) = file.find(&family.family) else {
                check.add(family, family.rows.iter().map(|row| (row.name(), Finding::Missing)));
                continue;
            };
            if older.driver != family.driver {
                let (file, here) = (older.driver.clone(), family.driver.clone());
                return Err(OtherDriver { family: family.family.clone(), file, here });
            }
            check.compare(family, older);
            if all {
                let gone = older.rows.iter().filter(|row| family.find(&row.name()).is_none());
                check.add(family, gone.map(|row| (row.name(), Finding::Gone)));
            }
        }
        Ok(check)
    }

    fn compare(&mut self, family: &Family, older: &Family) {
        let may_spill = !NEVER_SPILL.contains(&family.family.as_str());
        for row in &family.rows {
            let findings = match older.find(&row.name()) {
                None => vec![Finding::Missing],
                Some(older) => {
                    self.compared += 1;
                    compare(row, older, Words::of(&family.driver), may_spill)
                }
            };
            self.add(family, findings.into_iter().map(|finding| (row.name(), finding)));
        }
    }

    fn add(&mut self, family: &Family, findings: impl Iterator<Item = (String, Finding)>) {
        self.findings.extend(findings.map(|(row, finding)| (family.family.clone(), row, finding)));
    }

    /// Whether every row is in the file and takes no more than that.
    pub fn passes(&self) -> bool {
        self.compared > 0
            && self.findings.iter().all(|(_, _, one)| matches!(one, Finding::Changed { is_worse: false, .. }))
    }

    /// What there is to say, a line each, and what to run where the file is to be brought up to date.
    pub fn to_text(&self, update: &str) -> String {
        let mut text = String::new();
        for (family, row, finding) in &self.findings {
            let _ = writeln!(text, "{family}: {row}: {finding}");
        }
        let state = if self.passes() { "no row takes more than the file says" } else { "FAILED" };
        let _ = writeln!(text, "{} rows compared: {state}", self.compared);
        let is_stale = |finding: &Finding| !matches!(finding, Finding::Changed { is_worse: true, .. });
        if self.findings.iter().any(|(_, _, finding)| is_stale(finding)) {
            let _ = writeln!(text, "to bring the file up to date, run: {update}");
        }
        text
    }
}

/// One row against the file's.
fn compare(row: &Measured, file: &Measured, words: &Words, may_spill: bool) -> Vec<Finding> {
    let wider = f64::from(row.subgroup_size) / f64::from(file.subgroup_size);
    let number = |what, most: &dyn Fn(u64) -> u64| {
        let (found, file) = (row.number(what), file.number(what));
        let is_worse = found > most(file);
        (is_worse || found < file).then_some(Finding::Changed { is_worse, what, file, found })
    };
    let spills = words.spills.iter().map(|what| number(what, &|file| if may_spill { file } else { 0 }));
    // A wave of more invocations may take more
    let most = |file: u64, more: f64| (file as f64 * (1.0 + more) * wider.max(1.0)).floor() as u64;
    let held = words.held.iter().map(|(what, more)| number(what, &|file| most(file, *more)));
    let (found, file) = (row.subgroup_size.into(), file.subgroup_size.into());
    let narrower = Finding::Changed { is_worse: true, what: "invocations a wave", file, found };
    spills.chain(held).flatten().chain((found < file).then_some(narrower)).collect()
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Changed { is_worse, what, file, found } => {
                let verdict = if *is_worse { "FAILED" } else { "better" };
                write!(f, "{verdict}: {what} {found}, where the file says {file}")
            }
            Self::Missing => f.write_str("FAILED: the file has no such row"),
            Self::Gone => f.write_str("FAILED: the file has it, and it is gone"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(level: &str, vgprs: u64, inverse_throughput: u64) -> Measured {
        let said = [("VGPRs", vgprs), ("Inverse Throughput", inverse_throughput)];
        Measured {
            kernel: "shade".into(),
            lights: "quads".into(),
            level: level.into(),
            ratio: None,
            subgroup_size: 64,
            said: said.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
            seconds: Some(1.0),
        }
    }

    fn compiled(rows: Vec<Measured>) -> Compiled {
        Compiled { families: vec![Family { family: "navi21".into(), driver: "radv 1".into(), rows }] }
    }

    fn check(found: Vec<Measured>, file: Vec<Measured>) -> Check {
        Check::new(&compiled(found), &compiled(file), true).unwrap()
    }

    #[test]
    fn the_same_passes_and_more_does_not() {
        let file = || vec![row("exact", 64, 1000), row("split", 80, 2000)];
        assert!(check(file(), file()).passes());
        // 3 % of throughput are allowed, and not a register
        assert!(check(vec![row("exact", 64, 1030), row("split", 80, 2060)], file()).passes());
        let slower = check(vec![row("exact", 64, 1031), row("split", 80, 2000)], file());
        let worse = Finding::Changed { is_worse: true, what: "Inverse Throughput", file: 1000, found: 1031 };
        assert_eq!(slower.findings, [("navi21".into(), "shade: quads, exact".into(), worse)]);
        assert!(!slower.passes() && slower.to_text("X").contains("FAILED: Inverse Throughput 1031"));
        assert!(!slower.to_text("X").contains("run: X"), "what is worse is not to be written down");
        assert!(!check(vec![row("exact", 65, 1000), row("split", 80, 2000)], file()).passes());
    }

    #[test]
    fn less_passes_and_says_how_to_keep_it() {
        let better = check(vec![row("exact", 56, 900)], vec![row("exact", 64, 1000)]);
        assert!(better.passes());
        let text = better.to_text("arealight bench compiled --update");
        assert!(text.contains("better: VGPRs 56, where the file says 64"), "{text}");
        assert!(text.contains("better: Inverse Throughput 900") && text.contains("--update"), "{text}");
    }

    #[test]
    fn a_wave_of_fewer_invocations_fails_and_a_wider_one_may_take_more() {
        let of = |subgroup_size, throughput| Measured { subgroup_size, ..row("exact", 64, throughput) };
        assert!(!check(vec![of(32, 500)], vec![of(64, 1000)]).passes());
        assert!(check(vec![of(64, 1000)], vec![of(32, 500)]).passes());
    }

    #[test]
    fn a_row_that_one_side_lacks_fails() {
        let two = || vec![row("exact", 64, 1000), row("split", 80, 2000)];
        let missing = check(two(), vec![row("exact", 64, 1000)]);
        assert!(
            !missing.passes() && missing.to_text("X").contains("split: FAILED: the file has no such row")
        );
        assert!(missing.to_text("X").contains("run: X"));
        let gone = check(vec![row("exact", 64, 1000)], two());
        assert!(!gone.passes() && gone.to_text("X").contains("it is gone"));
        // Where only some were compiled, the others are not gone
        let some = Check::new(&compiled(vec![row("exact", 64, 1000)]), &compiled(two()), false).unwrap();
        assert!(some.passes());
        assert!(!check(vec![], vec![]).passes(), "nothing compared is no success");
        let other_family = Check::new(&compiled(two()), &Compiled::default(), true).unwrap();
        assert!(!other_family.passes() && other_family.findings.len() == 2);
    }

    #[test]
    fn spills_fail_but_where_the_file_has_them_of_families_that_may() {
        for what in ["Spilled VGPRs", "Spilled SGPRs"] {
            let spilling = || {
                let mut row = row("exact", 64, 1000);
                row.said.insert(what.into(), 4);
                vec![row]
            };
            let check = |family: &str, file| {
                let of = |rows| {
                    let mut compiled = compiled(rows);
                    compiled.families[0].family = family.into();
                    compiled
                };
                Check::new(&of(spilling()), &of(file), true).unwrap()
            };
            for (family, file) in [
                ("navi21", vec![row("exact", 64, 1000)]),
                ("navi21", spilling()),
                ("gfx1100", vec![row("exact", 64, 1000)]),
            ] {
                let failed = check(family, file);
                assert!(!failed.passes() && failed.to_text("X").contains(&format!("FAILED: {what} 4")));
            }
            assert!(check("gfx1100", spilling()).passes(), "the twin");
        }
    }

    #[test]
    fn another_driver_cannot_be_compared() {
        let mut file = compiled(vec![row("exact", 64, 1000)]);
        file.families[0].driver = "radv 2".into();
        let error = Check::new(&compiled(vec![row("exact", 64, 1000)]), &file, true).unwrap_err();
        assert!(error.to_string().contains("by radv 2, and this is radv 1"), "{error}");
    }

    #[test]
    fn the_file_reads_back_without_what_differs_from_run_to_run() {
        let found = compiled(vec![row("exact", 64, 1000), row("split", 80, 2000)]);
        let text = found.to_checked_in();
        assert!(!text.contains("seconds"));
        assert_eq!(text.lines().filter(|line| line.contains("\"VGPRs\"")).count(), 2);
        let read: Compiled = serde_json::from_str(&text).unwrap();
        assert!(Check::new(&found, &read, true).unwrap().findings.is_empty());
    }
}
