//! Numbers of 500 bits behind the binary point.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::BigInt;

const BITS: u32 = 500;

/// A multiple of `2⁻⁵⁰⁰`. Numbers of moderate size come in without rounding.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Fixed(BigInt);

impl Fixed {
    pub(crate) fn zero() -> Self {
        Self(BigInt::ZERO)
    }

    pub(crate) fn whole(n: i32) -> Self {
        Self(BigInt::from(n) << BITS)
    }

    pub(crate) fn from_f64(x: f64) -> Self {
        let (mantissa, exponent, sign) = num_traits::Float::integer_decode(x);
        let shift = i32::from(exponent) + BITS as i32;
        let magnitude = BigInt::from(mantissa);
        let magnitude = if shift >= 0 { magnitude << shift } else { magnitude >> -shift };
        Self(magnitude * i32::from(sign))
    }

    /// The nearest double, but for an ulp: for messages and ratios.
    pub(crate) fn as_f64(&self) -> f64 {
        let bits = self.0.magnitude().bits();
        let drop = bits.saturating_sub(60);
        let leading: f64 = (&self.0 >> drop).to_string().parse().expect("an integer");
        leading * 2f64.powi(drop as i32 - BITS as i32)
    }

    pub(crate) fn abs(self) -> Self {
        if self.0 < BigInt::ZERO { Self(-self.0) } else { self }
    }

    pub(crate) fn sqrt(&self) -> Self {
        Self((&self.0 << BITS).sqrt())
    }

    /// Sine and cosine by their series.
    pub(crate) fn sin_cos(&self) -> [Self; 2] {
        let mut sums = [Self::zero(), Self::zero()];
        let mut term = Self::whole(1);
        for n in 0..400 {
            let signed = if n % 4 < 2 { term.clone() } else { -term.clone() };
            let sum = &mut sums[(n + 1) % 2];
            *sum = sum.clone() + signed;
            term = term * self.clone() / Self::whole(n as i32 + 1);
        }
        sums
    }
}

impl Add for Fixed {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Sub for Fixed {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl Neg for Fixed {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul for Fixed {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        Self((self.0 * rhs.0) >> BITS)
    }
}

impl Div for Fixed {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        Self((self.0 << BITS) / rhs.0)
    }
}

pub(crate) fn dot(a: &[Fixed; 3], b: &[Fixed; 3]) -> Fixed {
    (0..3).fold(Fixed::zero(), |sum, i| sum + a[i].clone() * b[i].clone())
}

pub(crate) fn norm(a: &[Fixed; 3]) -> Fixed {
    dot(a, a).sqrt()
}
