//! Numbers in twice the precision of `f64` that carry a bound on their error.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::double_double::DoubleDouble;

/// The largest error of an operation on numbers of two parts, relative to its result: a sum `2⁻¹⁰³`, a product or a
/// root `2⁻¹⁰⁰`, a quotient `2⁻⁹⁹` (Joldes, Muller and Popescu, *Tight and rigorous error bounds for basic building
/// blocks of double-word arithmetic*, 2017). A product may also underflow.
const LOST: f64 = f64::EPSILON * f64::EPSILON * 64.0;

/// The factor by which bounds on errors are raised, because they are rounded themselves.
const RAISED: f64 = 1.0 + 16.0 * f64::EPSILON;

/// A number with an error of at most `error`.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    value: DoubleDouble,
    error: f64,
}

impl Bounded {
    /// The sum of two numbers, exactly.
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        Self { value: DoubleDouble::sum(a, b), error: 0.0 }
    }

    /// The result of an operation with this error.
    fn new(value: DoubleDouble, error: f64) -> Self {
        Self { value, error: (error + LOST * value.high.abs()) * RAISED }
    }

    /// The nearest plain number to its middle.
    #[must_use]
    pub fn middle(self) -> f64 {
        self.value.value()
    }

    /// The number with a further error.
    #[must_use]
    pub fn give_or_take(self, error: f64) -> Self {
        Self { error: (self.error + error) * RAISED, ..self }
    }

    /// Numbers that it is certainly not below and not above.
    #[must_use]
    pub fn bounds(self) -> [f64; 2] {
        let DoubleDouble { high, low } = self.value;
        let wide = self.error + low.abs() + f64::EPSILON * high.abs();
        // If the low part and the error are less than half a unit in the last place, the next numbers are bounds.
        if wide.is_finite() { [high - wide, high + wide] } else { [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Whether it is certainly less than zero.
    #[must_use]
    pub fn is_negative(self) -> bool {
        self.value.value() < -self.error * RAISED
    }

    /// Whether it is certainly greater than zero.
    #[must_use]
    pub fn is_positive(self) -> bool {
        (-self).is_negative()
    }

    /// A bound on the magnitude of the number as it is computed.
    fn size(self) -> f64 {
        self.value.high.abs() + self.value.low.abs()
    }

    /// Its square.
    #[must_use]
    pub fn squared(self) -> Self {
        self * self
    }

    /// The root of a number that is certainly positive. With `√x − √(x − e) ≤ e/√x`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::new(root, self.error / root.high)
    }
}

impl From<f64> for Bounded {
    fn from(high: f64) -> Self {
        Self { value: high.into(), error: 0.0 }
    }
}

impl Neg for Bounded {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Add for Bounded {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.error + other.error)
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
        let (a, b) = (self.size(), other.size());
        let error = a * other.error + b * self.error + self.error * other.error;
        let underflow = if a == 0.0 || b == 0.0 { 0.0 } else { f64::MIN_POSITIVE };
        Self::new(self.value * other.value, error + underflow)
    }
}

impl Div for Bounded {
    type Output = Self;

    /// The quotient by a number that is certainly not zero: two steps of long division.
    fn div(self, other: Self) -> Self {
        let quotient = Self { value: self.value / other.value, error: 0.0 };
        let least = (other.value.high.abs() - other.value.low.abs() - other.error) * (1.0 - 4.0 * f64::EPSILON);
        let error = (self.error + quotient.size() * other.error) / least + f64::MIN_POSITIVE;
        // An error as large as the divisor leaves the quotient unknown.
        Self::new(quotient.value, if least > 0.0 { error } else { f64::INFINITY })
    }
}
