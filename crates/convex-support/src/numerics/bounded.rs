//! Numbers in twice the precision of `f64` that carry a bound on their error.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::twofold::{two_product, two_sum};

/// The largest error of an operation on numbers of two parts, relative to its result: a sum `2⁻¹⁰³`, a product or a
/// root `2⁻¹⁰⁰`, a quotient `2⁻⁹⁹` (Joldes, Muller and Popescu, *Tight and rigorous error bounds for basic building
/// blocks of double-word arithmetic*, 2017). A product may also underflow.
const LOST: f64 = f64::EPSILON * f64::EPSILON * 64.0;

/// The factor by which bounds on errors are raised, because they are rounded themselves.
const RAISED: f64 = 1.0 + 16.0 * f64::EPSILON;

/// The number `high + low`, which is wrong by `error` at most.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    high: f64,
    low: f64,
    error: f64,
}

impl Bounded {
    /// The sum of two numbers, exactly.
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let [high, low] = two_sum(a, b);
        Self { high, low, error: 0.0 }
    }

    fn new(high: f64, low: f64, error: f64) -> Self {
        let [high, low] = two_sum(high, low);
        Self { high, low, error: (error + LOST * high.abs()) * RAISED }
    }

    /// Numbers that it is certainly not below and not above.
    #[must_use]
    pub fn bounds(self) -> [f64; 2] {
        let wide = self.error + self.low.abs() + f64::EPSILON * self.high.abs();
        // Where the low part and the error are less than half a unit in the last place, the next numbers are bounds.
        if wide.is_finite() { [self.high - wide, self.high + wide] } else { [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Whether it is certainly less than zero.
    #[must_use]
    pub fn is_negative(self) -> bool {
        self.high + self.low < -self.error * RAISED
    }

    /// Whether it is certainly greater than zero.
    #[must_use]
    pub fn is_positive(self) -> bool {
        (-self).is_negative()
    }

    /// Its square.
    #[must_use]
    pub fn squared(self) -> Self {
        self * self
    }

    /// The root of a number that is certainly positive: a step of Newton's method. With `√x − √(x − e) ≤ e/√x`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = num_traits::Float::sqrt(self.high);
        let rest = self - Self::from(root) * Self::from(root);
        Self::new(root, (rest.high + rest.low) / (root + root), self.error / root)
    }
}

impl From<f64> for Bounded {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0, error: 0.0 }
    }
}

impl Neg for Bounded {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low, ..self }
    }
}

impl Add for Bounded {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let ([high, lost], [low, lower]) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let [high, lost] = two_sum(high, lost + low);
        Self::new(high, lost + lower, self.error + other.error)
    }
}

impl Sub for Bounded {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let [high, lost] = two_product(self.high, other.high);
        let low = lost + (self.high * other.low + self.low * other.high);
        let (a, b) = (self.high.abs() + self.low.abs(), other.high.abs() + other.low.abs());
        let error = a * other.error + b * self.error + self.error * other.error;
        let underflow = if high == 0.0 && (a == 0.0 || b == 0.0) { 0.0 } else { f64::MIN_POSITIVE };
        Self::new(high, low, error + underflow)
    }
}

impl Div for Bounded {
    type Output = Self;

    /// The quotient by a number that is certainly not zero: two steps of long division.
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - Self::from(first) * Self { error: 0.0, ..other };
        let second = (rest.high + rest.low) / other.high;
        let least = (other.high.abs() - other.low.abs() - other.error) * (1.0 - 4.0 * f64::EPSILON);
        let error = (self.error + (first.abs() + second.abs()) * other.error) / least + f64::MIN_POSITIVE;
        // An error as large as the number that is divided by leaves nothing known.
        Self::new(first, second, if least > 0.0 { error } else { f64::INFINITY })
    }
}
