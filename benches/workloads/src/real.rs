//! Numbers that truths are computed in: doubles, and unevaluated sums of two doubles.
//!
//! Sums and products are error-free transformations (Dekker, *A floating-point technique for extending the available
//! precision*, 1971; Knuth's two-sum), so that a reference is right to some thirty digits and shares no rounding with
//! what it is held against. Numbers are to be far from over- and underflow.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A double or a sum of two, for vectors of either.
pub trait Real:
    Copy
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest double.
    #[must_use]
    fn f64(self) -> f64;

    /// The root, rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The greater of two.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// Without its sign.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::from(0.0) { -self } else { self }
    }
}

impl Real for f64 {
    fn f64(self) -> f64 {
        self
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }
}

/// The sum `high + low`, where `low` is at most half an ulp of `high`: 106 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b` and its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let seen = sum - a;
    (sum, (a - (sum - seen)) + (b - seen))
}

/// The same where `|a| ≥ |b|`.
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// `a·b` and its rounding error, by Veltkamp's splitting into halves whose products are exact.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2²⁷ + 1
    let split = |x: f64| {
        let t = SPLITTER * x;
        let upper = t - (t - x);
        (upper, x - upper)
    };
    let product = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2))
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        (self.high, self.low).partial_cmp(&(other.high, other.low))
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        let (high, error) = two_sum(self.high, b.high);
        let (low, lower) = two_sum(self.low, b.low);
        let Self { high, low } = quick_two_sum(high, error + low);
        quick_two_sum(high, low + lower)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        let (high, error) = two_product(self.high, b.high);
        quick_two_sum(high, error + (self.high * b.low + self.low * b.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    /// Long division: each quotient is right to 53 bits of what remains.
    fn div(self, b: Self) -> Self {
        let first = self.high / b.high;
        let rest = self - b * Self::from(first);
        let second = rest.high / b.high;
        let rest = rest - b * Self::from(second);
        quick_two_sum(first, second) + Self::from(rest.high / b.high)
    }
}

impl Real for DoubleDouble {
    fn f64(self) -> f64 {
        self.high
    }

    /// One step of Newton's method from the root in doubles.
    fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        if root == 0.0 {
            return Self::from(root);
        }
        let rest = self - Self::from(root) * Self::from(root);
        quick_two_sum(root, rest.high / (root + root))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_digits() {
        let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
        let rest = (third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0)).f64().abs();
        assert!(rest < 1e-31, "3·(1/3) − 1 = {rest:e}");
        let two = DoubleDouble::from(2.0);
        let rest = (two.sqrt() * two.sqrt() - two).f64().abs();
        assert!(rest < 1e-30, "√2² − 2 = {rest:e}");
        // (1 + 2⁻⁶⁰)² − 1 − 2⁻⁵⁹ = 2⁻¹²⁰, which doubles do not see, and double-doubles round off, but no more than
        // that.
        let one = DoubleDouble::from(1.0) + DoubleDouble::from(2.0_f64.powi(-60));
        let rest = (one * one - DoubleDouble::from(1.0) - DoubleDouble::from(2.0_f64.powi(-59))).f64();
        assert!(rest.abs() <= 2.0_f64.powi(-104), "{rest:e}");
    }
}
