//! A family's results against its promises. Results come as bits: a clamp on the way would hide a NaN.

use super::HardCase;
use super::family::{Family, Scope};
use super::nearby::Nearby;
use super::promise::{MOVE, Promise, Promises};
use super::reference::Reference;
use serde::Serialize;
use std::collections::BTreeMap;

/// The bits of the number 1, the largest form factor; those of 0 to 1 are the smaller ones and no others: a
/// sign bit, infinity and NaN all make larger ones.
const ONE: u32 = 0x3f80_0000;

/// A case with its truth, ready to judge any number of results.
pub struct Judged {
    scope: Scope,
    /// `None` where only the range is judged.
    truth: Option<Truth>,
}

/// What is known of a case.
struct Truth {
    reference: Reference,
    /// Form factors that are as right, of an outline that is not flat.
    other_closings: Vec<f64>,
    nearby: Nearby,
}

/// What is found of one result.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Finding {
    /// The distance to the truth; infinite for what is no finite number. `None` where there is no truth.
    pub error: Option<f64>,
    /// The distance to the values of the polygons nearby, at most `error`.
    pub backward_error: Option<f64>,
    /// The error as a part of area / (pi distance²), of a small light.
    pub small_light_error: Option<f64>,
    /// The error of each promise over its bound: above 1 it is broken.
    pub ratios: [Option<(Promise, f64)>; 3],
    /// It is NaN or infinite.
    pub not_finite: bool,
    /// Its bits are not those of a number from 0 to 1.
    pub out_of_range: bool,
}

impl Judged {
    /// Prepares a case of `family`.
    pub fn new(family: &Family, case: &HardCase) -> Self {
        let accurate = family.scope == Scope::Accuracy && case.is_finite();
        // A sum of finite numbers may be beyond float32; then nothing but a number is promised
        let scope = if family.scope == Scope::Accuracy && !accurate { Scope::Range } else { family.scope };
        let truth = accurate.then(|| {
            let (reference, other_closings) = Reference::with_closings(case);
            let nearby = Nearby::new(case, !other_closings.is_empty());
            Truth { reference, other_closings, nearby }
        });
        Self { scope, truth }
    }

    /// The truth; `None` where only the range is judged.
    pub fn reference(&self) -> Option<&Reference> {
        self.truth.as_ref().map(|truth| &truth.reference)
    }

    /// Holds the bits of a result against [`Promises::OURS`].
    pub fn judge(&self, bits: u32) -> Finding {
        let value = f64::from(f32::from_bits(bits));
        let out_of_range = bits > ONE;
        let mut finding = Finding { not_finite: !value.is_finite(), out_of_range, ..Finding::default() };
        let broken = |broken: bool| if broken { f64::INFINITY } else { 0.0 };
        if self.scope == Scope::Zero {
            finding.ratios[0] = Some((Promise::Zero, broken(bits != 0)));
            return finding;
        }
        finding.ratios[0] = Some((Promise::Range, broken(out_of_range)));
        let Some(Truth { reference, other_closings, nearby }) = &self.truth else { return finding };

        // NaN is as far off as can be
        let errors = other_closings.iter().chain([&reference.form_factor]).map(|f| (value - f).abs());
        let error = errors.fold(f64::INFINITY, f64::min);
        // The given polygon is one of those nearby: its value is searched no further where it is close enough
        let bound = Promises::OURS.backward;
        // Nor where it is hopelessly far off: away from contact, values nearby differ by little more than the
        // moves
        let reach = 100.0 * nearby.vertex_count() as f64 * MOVE / reference.rho;
        let searched = error > bound && error <= reach;
        let backward = if searched { nearby.distance(value, bound).min(error) } else { error };
        finding.error = Some(error);
        finding.backward_error = Some(backward);
        finding.small_light_error = reference.small_light_unit.map(|unit| ratio(error, unit));
        finding.ratios[1] = Some((Promise::Backward, ratio(backward, bound)));
        // One of the two bounds of the error is the tighter one
        let forward = (Promise::Forward, ratio(error, Promises::OURS.forward_bound(reference)));
        let small =
            Promises::OURS.small_light_bound(reference).map(|b| (Promise::SmallLight, ratio(error, b)));
        finding.ratios[2] = Some(small.filter(|small| small.1 > forward.1).unwrap_or(forward));
        finding
    }
}

/// An error over its bound; no error is none of any bound.
fn ratio(error: f64, bound: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / bound }
}

/// A promise that was not kept.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shortfall {
    /// In how many cases.
    pub count: usize,
    /// The worst case's index, from which the family makes it again.
    pub index: u64,
    /// The worst case's error over its bound.
    pub ratio: f64,
    /// The bits of its result.
    pub bits: u32,
    /// Its result, as text: it may be no number.
    pub result: String,
    /// The truth about it.
    pub exact: Option<f64>,
}

/// A family's results.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Tally {
    /// How many results there were.
    pub samples: usize,
    /// The largest error; `None` where there is no truth.
    pub largest_error: Option<f64>,
    /// The largest distance to the values of the polygons nearby, at most what the search found.
    pub largest_backward_error: Option<f64>,
    /// The largest error of a small light, as a part of area / (pi distance²).
    pub largest_small_light_error: Option<f64>,
    /// How many were NaN or infinite.
    pub not_finite: usize,
    /// How many were not numbers from 0 to 1, by their bits.
    pub out_of_range: usize,
    /// How near each promise came to being broken: the largest error over its bound.
    pub largest_ratios: BTreeMap<Promise, f64>,
    /// The promises that were broken.
    pub shortfalls: BTreeMap<Promise, Shortfall>,
}

impl Tally {
    /// Adds the finding about the result of the case of an index.
    pub fn add(&mut self, index: u64, bits: u32, exact: Option<f64>, finding: &Finding) {
        let raise = |largest: &mut Option<f64>, error: Option<f64>| {
            if let Some(error) = error {
                *largest = Some(largest.unwrap_or(0.0).max(error));
            }
        };
        self.samples += 1;
        raise(&mut self.largest_error, finding.error);
        raise(&mut self.largest_backward_error, finding.backward_error);
        raise(&mut self.largest_small_light_error, finding.small_light_error);
        self.not_finite += usize::from(finding.not_finite);
        self.out_of_range += usize::from(finding.out_of_range);
        for (promise, ratio) in finding.ratios.iter().flatten() {
            let largest = self.largest_ratios.entry(*promise).or_insert(0.0);
            *largest = largest.max(*ratio);
            let kept = *ratio <= 1.0;
            if kept {
                continue;
            }
            let result = f32::from_bits(bits).to_string();
            let this = Shortfall { count: 0, index, ratio: *ratio, bits, result, exact };
            let worst = self.shortfalls.entry(*promise).or_insert_with(|| this.clone());
            let count = worst.count + 1;
            if this.ratio > worst.ratio {
                *worst = this;
            }
            worst.count = count;
        }
    }

    /// Whether every promise was kept, by at least one result.
    pub fn is_kept(&self) -> bool {
        self.samples > 0 && self.shortfalls.is_empty()
    }
}
