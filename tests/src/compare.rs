//! A comparison that cannot pass by comparing nothing.

use glam::{DVec3, Vec3};

/// What float32 may lose of a form factor in the lobe of `alpha`; Lambert's is as wide as 1. Vertices, frame
/// and matrix are rounded about sixteen times, each by 2^-24 of a direction, and the lobe turns a direction's
/// error into 1/alpha of itself; beside that stands the edge sum's own 1e-6.
pub fn rounding(alpha: f64) -> f64 {
    1e-6 + 16.0 * 2.0_f64.powi(-24) / alpha
}

/// Differences against bounds. Call [`Comparison::assert_all`] at the end: it fails if nothing was compared.
#[must_use = "compares nothing unless assert_all is called"]
pub struct Comparison {
    what: String,
    compared: usize,
    failures: Vec<String>,
    largest: f64,
    largest_ratio: f64,
}

impl Comparison {
    /// An empty comparison of `what`.
    pub fn new(what: impl Into<String>) -> Self {
        Self { what: what.into(), compared: 0, failures: Vec::new(), largest: 0.0, largest_ratio: 0.0 }
    }

    /// Compares one number; `place` says which. A difference that is NaN fails.
    pub fn add(&mut self, actual: f64, expected: f64, bound: f64, place: impl FnOnce() -> String) {
        let difference = (actual - expected).abs();
        self.compared += 1;
        self.largest = self.largest.max(difference);
        self.largest_ratio = self.largest_ratio.max(difference / bound);
        let within = difference <= bound;
        if !within {
            self.failures.push(format!(
                "{}: {actual:e} is not {expected:e}: {difference:e} apart, {bound:e} allowed",
                place()
            ));
        }
    }

    /// Compares each channel of a colour; `place` says of what.
    pub fn add_color(&mut self, actual: Vec3, expected: DVec3, bound: f64, place: impl Fn() -> String) {
        for channel in 0..3 {
            let place = || format!("channel {channel} of {}", place());
            self.add(actual[channel].into(), expected[channel], bound, place);
        }
    }

    /// The largest difference so far.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// How many differences are beyond their bounds.
    pub fn failures(&self) -> usize {
        self.failures.len()
    }

    /// Fails with the first few differences that are too large, or if nothing was compared.
    pub fn assert_all(self) {
        assert!(self.compared > 0, "{}: nothing was compared", self.what);
        println!(
            "{}: {} compared, largest difference {:.2e} ({:.2} of its bound)",
            self.what, self.compared, self.largest, self.largest_ratio
        );
        let shown: Vec<_> = self.failures.iter().take(5).cloned().collect();
        assert!(
            self.failures.is_empty(),
            "{}: {} of {} are apart:\n{}",
            self.what,
            self.failures.len(),
            self.compared,
            shown.join("\n")
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "nothing was compared")]
    fn comparing_nothing_fails() {
        Comparison::new("nothing").assert_all();
    }

    #[test]
    #[should_panic(expected = "1 of 2 are apart")]
    fn a_difference_beyond_its_bound_fails() {
        let mut comparison = Comparison::new("two numbers");
        comparison.add(1.0, 1.0, 0.0, || "first".into());
        comparison.add(1.0, 1.1, 0.05, || "second".into());
        comparison.assert_all();
    }

    #[test]
    #[should_panic(expected = "1 of 1 are apart")]
    fn not_a_number_fails() {
        let mut comparison = Comparison::new("NaN");
        comparison.add(f64::NAN, 0.0, 1.0, || "it".into());
        comparison.assert_all();
    }
}
