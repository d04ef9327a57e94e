//! Whether two runs agree within the spread that they state.

use super::{Ladder, Spread, number, percent};
use crate::table::Table;

/// Two runs of the same measurements beside each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// How many numbers were compared.
    pub numbers: usize,
    /// Those that disagree: what it is, the one, the other.
    pub apart: Vec<[String; 3]>,
}

impl Comparison {
    /// Notes whether two spreads overlap.
    fn spread(&mut self, what: String, a: &Spread, b: &Spread) {
        self.numbers += 1;
        let [(a_low, a_high), (b_low, b_high)] =
            [a, b].map(|spread| (spread.quartiles[0], spread.quartiles[1]));
        // NaN overlaps with nothing
        let overlap = a_low <= b_high && b_low <= a_high;
        if !overlap {
            let cell = |spread: &Spread| {
                let [low, high] = spread.quartiles.map(number);
                format!("{} ({low} to {high})", number(spread.median))
            };
            self.apart.push([what, cell(a), cell(b)]);
        }
    }

    /// Notes whether two errors are the same to the digits that are shown.
    fn error(&mut self, what: String, a: f64, b: f64) {
        self.numbers += 1;
        if percent(a) != percent(b) {
            self.apart.push([what, percent(a), percent(b)]);
        }
    }

    /// For a terminal.
    pub fn to_text(&self) -> String {
        let mut text = format!("{} of {} numbers agree\n", self.numbers - self.apart.len(), self.numbers);
        if !self.apart.is_empty() {
            let heads = ["apart", "first", "second"].map(str::to_owned).to_vec();
            let rows = self.apart.iter().map(|row| row.to_vec()).collect();
            text += &Table { heads, rows }.to_text();
        }
        text
    }
}

/// Compares two runs: errors to the digits that are shown, and ratios of time by whether their quartiles
/// overlap. What one of them has alone is apart.
pub fn compare(a: &Ladder, b: &Ladder) -> Comparison {
    let mut found = Comparison { numbers: 0, apart: vec![] };
    let missing = |what: String, is_first: bool| {
        let [first, second] = if is_first { ["is there", "-"] } else { ["-", "is there"] };
        [what, first.to_owned(), second.to_owned()]
    };
    for row in &a.rows {
        let what = |number: &str| format!("{}, {}: {number}", row.lights, row.name);
        let Some(other) = b.rows.iter().find(|o| (&o.lights, &o.name) == (&row.lights, &row.name)) else {
            found.numbers += 1;
            found.apart.push(missing(what("row"), true));
            continue;
        };
        found.error(what("RMSE"), row.errors.all.rmse, other.errors.all.rmse);
        found.spread(what("time"), &row.time.ratio, &other.time.ratio);
    }
    for row in &b.rows {
        if !a.rows.iter().any(|o| (&o.lights, &o.name) == (&row.lights, &row.name)) {
            found.numbers += 1;
            found.apart.push(missing(format!("{}, {}: row", row.lights, row.name), false));
        }
    }
    for effect in &a.effects {
        let what = |number: &str| format!("{}: {number}", effect.effect);
        let Some(other) = b.effects.iter().find(|other| other.effect == effect.effect) else {
            found.numbers += 1;
            found.apart.push(missing(what("effect"), true));
            continue;
        };
        found.spread(what("turned on"), &effect.on, &other.on);
        if let (Some(a), Some(b)) = (&effect.used, &other.used) {
            found.spread(what("needed"), a, b);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_agree_where_their_quartiles_overlap() {
        let spread = |low, median, high| Spread { median, quartiles: [low, high] };
        let mut found = Comparison { numbers: 0, apart: vec![] };
        found.spread("touching".into(), &spread(1.0, 1.1, 1.2), &spread(1.2, 1.3, 1.4));
        found.spread("within".into(), &spread(1.0, 1.1, 1.5), &spread(1.2, 1.3, 1.4));
        found.error("rounded".into(), 0.03501, 0.03502);
        assert_eq!((found.numbers, found.apart.len()), (3, 0), "{found:?}");
        found.spread("apart".into(), &spread(1.0, 1.1, 1.2), &spread(1.21, 1.3, 1.4));
        found.spread("none".into(), &spread(f64::NAN, f64::NAN, f64::NAN), &spread(1.0, 1.0, 1.0));
        found.error("error".into(), 0.035, 0.036);
        let apart: Vec<&str> = found.apart.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(apart, ["apart", "none", "error"]);
        let text = found.to_text();
        assert!(text.starts_with("3 of 6 numbers agree") && text.contains("3.50 %"), "{text}");
    }
}
