//! Numbers of two parts, for the few places where a difference of nearly equal numbers decides.
//!
//! A `DoubleDouble` is an unevaluated sum `high + low` with |low| ≤ ulp(high)/2: some 106 bits. Dekker, *A
//! floating-point technique for extending the available precision*, 1971; Ogita, Rump, Oishi, *Accurate sum and dot
//! product*, 2005.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::twofold::two_sum;

/// `high + low`, not rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    pub high: f64,
    pub low: f64,
}

impl DoubleDouble {
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// `a + b` exactly (Knuth's two-sum).
    #[inline]
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let [high, low] = two_sum(a, b);
        Self { high, low }
    }

    /// `a·b` exactly, unless a factor exceeds 1e300 (Dekker's product with Veltkamp's splitting: no fused
    /// multiply-add, which baseline x86-64 would have to emulate).
    #[inline]
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let split = |x: f64| {
            let t = 134_217_729.0 * x; // 2²⁷ + 1
            let high = t - (t - x);
            (high, x - high)
        };
        let high = a * b;
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        Self { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }

    /// The square root of a number that is not negative.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        let first = num_traits::Float::sqrt(self.high);
        if first == 0.0 {
            return Self::ZERO;
        }
        let rest = self - Self::product(first, first);
        Self::sum(first, rest.value() / (2.0 * first))
    }

    /// The nearest plain number.
    #[inline]
    #[must_use]
    pub fn value(self) -> f64 {
        self.high + self.low
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        let s = Self::sum(self.high, rhs.high);
        let t = Self::sum(self.low, rhs.low);
        let u = Self::sum(s.high, s.low + t.high);
        Self::sum(u.high, u.low + t.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        self + -rhs
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: Self) -> Self {
        let p = Self::product(self.high, rhs.high);
        Self::sum(p.high, p.low + (self.high * rhs.low + self.low * rhs.high))
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: f64) -> Self {
        let p = Self::product(self.high, rhs);
        Self::sum(p.high, p.low + self.low * rhs)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, rhs: Self) -> Self {
        let first = self.high / rhs.high;
        let rest = self - rhs * first;
        Self::sum(first, rest.value() / rhs.high)
    }
}

#[cfg(test)]
mod tests {
    use super::DoubleDouble;

    #[test]
    fn keeps_what_plain_arithmetic_drops() {
        let tiny = f64::EPSILON * f64::EPSILON;
        // (1 + ε)² − 1 − 2ε = ε²
        let square = DoubleDouble::product(1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!((square - DoubleDouble::sum(1.0, 2.0 * f64::EPSILON)).value(), tiny);
        // 1/3·3 = 1 to 106 bits
        let third = DoubleDouble::from(1.0) / 3.0.into();
        assert!((third * 3.0 - DoubleDouble::from(1.0)).value().abs() <= tiny, "{third:?}");
    }
}
