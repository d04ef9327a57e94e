//! Numbers of 106 bits, as the unevaluated sum of two float64 (double-double): Dekker 1971, Knuth's two-sum.
//!
//! Written here because the ready-made types err: `twofloat` 0.8 gives `atan2(0.3, 0.7)` to 4e-17 only, and
//! arbitrary precision costs a hundred times as much as a battery of millions of edges can take.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What the reference computes with: float64 for searches, [`Double`] for the truth.
pub trait Number:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// A float64, exactly.
    fn exact(value: f64) -> Self;
    /// `a + b`, rounded to this type: exact in [`Double`] wherever 106 bits hold it.
    fn sum(a: f64, b: f64) -> Self;
    /// The nearest float64.
    fn round(self) -> f64;
    /// The square root; 0 of what is not positive.
    #[must_use]
    fn square_root(self) -> Self;
    /// The angle in [0, pi] of a sine, which is not negative, and a cosine of one common length; 0 of 0 and
    /// 0.
    fn angle(sine: Self, cosine: Self) -> Self;
}

impl Number for f64 {
    const ZERO: Self = 0.0;

    fn exact(value: f64) -> Self {
        value
    }

    fn sum(a: f64, b: f64) -> Self {
        a + b
    }

    fn round(self) -> f64 {
        self
    }

    fn square_root(self) -> Self {
        self.max(0.0).sqrt()
    }

    fn angle(sine: Self, cosine: Self) -> Self {
        sine.atan2(cosine)
    }
}

/// The sum `high + low`, with `|low|` at most half a unit in the last place of `high`. Relative errors:
/// 2^-104 for sums, products, quotients and roots, 1e-30 for angles. Not for numbers beyond 1e±150.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Double {
    high: f64,
    low: f64,
}

/// `a + b` and its rounding error, for any order of sizes.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let shadow = sum - a;
    (sum, (a - (sum - shadow)) + (b - shadow))
}

/// `a b` and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

impl Double {
    /// A number whose second part is small beside the first.
    fn renormalized(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }

    /// The product with a power of two, exactly.
    fn scaled(self, power: f64) -> Self {
        Self { high: self.high * power, low: self.low * power }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, lost) = two_sum(self.low, other.low);
        let first = Self::renormalized(high, error + low);
        Self::renormalized(first.high, first.low + lost)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (high, error) = two_product(self.high, other.high);
        Self::renormalized(high, error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        // Long division: each digit is a float64
        let first = self.high / other.high;
        let rest = self - other * Self::exact(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::exact(second);
        let third = rest.high / other.high;
        Self::renormalized(first, second) + Self::exact(third)
    }
}

impl Number for Double {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };

    fn exact(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self { high, low }
    }

    fn round(self) -> f64 {
        self.high
    }

    fn square_root(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        // Two steps of Newton's from float64's root
        let root = Self::exact(self.high.sqrt());
        let root = (root + self / root).scaled(0.5);
        (root + self / root).scaled(0.5)
    }

    fn angle(sine: Self, cosine: Self) -> Self {
        let length = (sine * sine + cosine * cosine).square_root();
        if length.high == 0.0 {
            return Self::ZERO;
        }
        // What float64's angle lacks is the sine of what is left, which is below 1e-15
        let near = sine.high.atan2(cosine.high);
        let (near_sine, near_cosine) = sine_and_cosine(near);
        Self::exact(near) + (sine * near_cosine - cosine * near_sine) / length
    }
}

/// Sine and cosine of an angle in [0, pi].
fn sine_and_cosine(angle: f64) -> (Double, Double) {
    // Taylor's series at a thirty-second of the angle, where twelve terms are enough: 0.1^25 / 25! is 6e-51
    let part = Double::exact(angle / 32.0);
    let square = part * part;
    let (mut sine, mut versine) = (Double::ZERO, Double::ZERO);
    for n in (0..12).rev() {
        let n = f64::from(n);
        sine = Double::exact(1.0) - sine * square / Double::exact((2.0 * n + 2.0) * (2.0 * n + 3.0));
        versine = Double::exact(1.0) - versine * square / Double::exact((2.0 * n + 3.0) * (2.0 * n + 4.0));
    }
    let (mut sine, mut versine) = (sine * part, versine * square.scaled(0.5));
    // Double the angle five times. The versine 1 - cos keeps what the cosine of a small angle would lose
    for _ in 0..5 {
        let twice = (sine * (Double::exact(1.0) - versine)).scaled(2.0);
        versine = (sine * sine).scaled(2.0);
        sine = twice;
    }
    (sine, Double::exact(1.0) - versine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number from the decimal digits of its two parts.
    fn number(high: f64, low: f64) -> Double {
        Double { high, low }
    }

    fn relative_error(found: Double, expected: Double) -> f64 {
        ((found - expected) / expected).high.abs()
    }

    #[test]
    fn pi_by_its_angle() {
        // pi to 33 digits: its float64, and what that leaves
        let pi = number(std::f64::consts::PI, 1.2246467991473532e-16);
        assert!(relative_error(Double::angle(Double::ZERO, Double::exact(-1.0)), pi) < 1e-31);
        let half = Double::angle(Double::exact(1.0), Double::ZERO);
        assert!(relative_error(half.scaled(2.0), pi) < 1e-31);
        // The twin: float64's pi is not that good
        assert!(relative_error(Double::exact(std::f64::consts::PI), pi) > 1e-17);
    }

    #[test]
    fn angles_to_thirty_digits() {
        // mpmath 1.3.0 at 50 digits: atan2(sine, cosine) as float64, and what is left of it
        for (sine, cosine, high, low) in ANGLES {
            let angle = Double::angle(Double::exact(sine), Double::exact(cosine));
            let error = relative_error(angle, number(high, low));
            assert!(error < 1e-30, "atan2({sine}, {cosine}): {error:e}");
        }
    }

    #[test]
    fn roots_and_quotients_multiply_back() {
        for value in [2.0, 3.0, 1e-20, 7.25e30] {
            let value = Double::exact(value) / Double::exact(3.0);
            let root = value.square_root();
            // 2^-104 each for root and product
            assert!(relative_error(root * root, value) < 1e-30);
            assert!(relative_error(value * Double::exact(3.0) / value, Double::exact(3.0)) < 1e-30);
        }
        assert_eq!(Double::exact(-1.0).square_root(), Double::ZERO);
    }

    #[test]
    fn a_sum_that_float64_rounds_is_exact() {
        let sum = Double::sum(1e8, 1e-16);
        assert_eq!(sum - Double::exact(1e8), Double::exact(1e-16));
        assert_eq!(1e8 + 1e-16 - 1e8, 0.0, "the twin");
    }

    const ANGLES: [(f64, f64, f64, f64); 8] = [
        (0.3, 0.7, 0.40489178628508343, 2.7690323179934683e-19),
        (1.0, 1e-05, 1.570786326794897, 1.5987685627180556e-17),
        (0.001, -1.0, 3.1405926539231266, -2.15270241598307e-16),
        (0.9, -0.2, 1.7894652726688385, 1.0751866108148944e-16),
        (1e-09, 1.0, 1e-09, -3.3333333333333338e-28),
        (1e-09, -1.0, 3.141592652589793, 2.0520505085187742e-16),
        (1e-20, 0.5, 2e-20, -2.666666666666666e-60),
        (3.0, -1e-12, 1.5707963267952298, 1.0561368081870086e-16),
    ];
}
