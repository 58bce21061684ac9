//! Intervals with ends of 256 bits, rounded outwards: every operation encloses all results of its operands' numbers.

use std::ops::{Add, Mul, Neg, Sub};

use dashu_float::round::mode::{Down, Up};
use dashu_float::{Context, FBig, FpResult, Repr};

const DOWN: Context<Down> = Context::new(256);
const UP: Context<Up> = Context::new(256);

/// All numbers from `low` to `high`; infinite ends bound nothing.
#[derive(Clone, Debug)]
pub struct Interval {
    low: Repr<2>,
    high: Repr<2>,
}

/// The lower end of what was computed; what is no number bounds nothing.
fn low(result: FpResult<FBig<Down, 2>>) -> Repr<2> {
    result.map_or(Repr::neg_infinity(), |value| value.value().into_repr())
}

fn high(result: FpResult<FBig<Up, 2>>) -> Repr<2> {
    result.map_or(Repr::infinity(), |value| value.value().into_repr())
}

impl From<f64> for Interval {
    /// The number itself; what is not finite is any number.
    fn from(number: f64) -> Self {
        match Repr::try_from(number + 0.0) {
            Ok(exact) if number.is_finite() => Self { low: exact.clone(), high: exact },
            _ => Self::unknown(),
        }
    }
}

impl Interval {
    pub(crate) fn unknown() -> Self {
        Self { low: Repr::neg_infinity(), high: Repr::infinity() }
    }

    pub(crate) fn infinity() -> Self {
        Self { low: Repr::infinity(), high: Repr::infinity() }
    }

    /// Whether it is infinity for certain.
    pub(crate) fn is_infinite(&self) -> bool {
        self.low == Repr::infinity()
    }

    pub(crate) fn zero() -> Self {
        Self::from(0.0)
    }

    fn is_bounded(&self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Whether it is one number.
    fn is_exact(&self) -> bool {
        self.is_bounded() && self.low >= self.high
    }

    /// Whether it is zero and nothing else.
    pub(crate) fn is_zero(&self) -> bool {
        self.is_not_negative() && self.is_at_most(&Self::zero())
    }

    /// Whether all of it is at most all of the other.
    pub(crate) fn is_at_most(&self, other: &Self) -> bool {
        self.high <= other.low
    }

    /// Whether all of it is less than all of the other.
    pub(crate) fn is_less_than(&self, other: &Self) -> bool {
        self.high < other.low
    }

    /// Whether all of it is zero or greater.
    pub(crate) fn is_not_negative(&self) -> bool {
        Self::zero().is_at_most(self)
    }

    /// Whether zero is none of it.
    fn is_apart_from_zero(&self) -> bool {
        self.is_less_than(&Self::zero()) || Self::zero().is_less_than(self)
    }

    /// Its lower end: a bound from below on everything in it.
    pub(crate) fn least(&self) -> Self {
        Self::exactly(self.low.clone())
    }

    /// Its upper end.
    pub(crate) fn greatest(&self) -> Self {
        Self::exactly(self.high.clone())
    }

    /// The larger of two numbers.
    pub(crate) fn max(&self, other: &Self) -> Self {
        let larger = |a: &Repr<2>, b: &Repr<2>| if a >= b { a.clone() } else { b.clone() };
        Self { low: larger(&self.low, &other.low), high: larger(&self.high, &other.high) }
    }

    /// The smaller of two numbers.
    pub(crate) fn min(&self, other: &Self) -> Self {
        -&(-self).max(&-other)
    }

    /// The quotient; any number where the divisor may be zero.
    pub(crate) fn over(&self, divisor: &Self) -> Self {
        if !(self.is_bounded() && divisor.is_bounded() && divisor.is_apart_from_zero()) {
            return Self::unknown();
        }
        self.of_ends(divisor, |a, b| low(DOWN.div(a, b)), |a, b| high(UP.div(a, b)))
    }

    /// The square, which is not negative.
    pub(crate) fn squared(&self) -> Self {
        let product = self * self;
        if self.is_apart_from_zero() { product } else { Self { low: Repr::zero(), ..product } }
    }

    /// The root of what is known not to be negative.
    pub(crate) fn root(&self) -> Self {
        let low = if self.is_not_negative() { low(DOWN.sqrt(&self.low)) } else { Repr::zero() };
        Self { low, high: high(UP.sqrt(&self.high)) }
    }

    /// The amount, without its sign.
    pub(crate) fn absolute(&self) -> Self {
        let larger = self.max(&-self);
        if self.is_apart_from_zero() { larger } else { Self { low: Repr::zero(), ..larger } }
    }

    /// The sine and the cosine of an angle, computed to 256 bits, of which the last 16 are not relied on. Neither
    /// changes by more than the angle.
    pub(crate) fn sine_and_cosine(&self) -> [Self; 2] {
        if self.is_zero() {
            return [0.0, 1.0].map(Self::from);
        }
        if !self.is_bounded() {
            return [Self::unknown(), Self::unknown()];
        }
        let lost = &(&self.greatest() - &self.least()) + &Self::exactly(Repr::new(1.into(), -240));
        let (sine, cosine) = DOWN.sin_cos(&self.low, None);
        [sine, cosine].map(low).map(|value| {
            let value = Self::exactly(value);
            Self { low: (&value - &lost).low, high: (&value + &lost).high }
        })
    }

    fn exactly(value: Repr<2>) -> Self {
        Self { low: value.clone(), high: value }
    }

    /// The least and greatest of what an operation makes of the ends of two bounded intervals.
    fn of_ends(
        &self,
        other: &Self,
        down: impl Fn(&Repr<2>, &Repr<2>) -> Repr<2>,
        up: impl Fn(&Repr<2>, &Repr<2>) -> Repr<2>,
    ) -> Self {
        let ends = |i: &Self| if i.is_exact() { 1 } else { 2 };
        let pairs =
            [(&self.low, &other.low), (&self.high, &other.high), (&self.high, &other.low), (&self.low, &other.high)];
        let pairs = match (ends(self), ends(other)) {
            (1, 1) => &pairs[..1],
            (1, _) | (_, 1) => &pairs[..2],
            _ => &pairs[..],
        };
        let low = pairs.iter().map(|(a, b)| down(a, b)).min().unwrap_or(Repr::neg_infinity());
        let high = pairs.iter().map(|(a, b)| up(a, b)).max().unwrap_or(Repr::infinity());
        Self { low, high }
    }

    /// A double between its ends, or near to it; zero where they bound nothing.
    pub(crate) fn middle(&self) -> f64 {
        let [low, high] = [&self.low, &self.high].map(|end| end.to_f64().value());
        let middle = low * 0.5 + high * 0.5;
        if middle.is_finite() { middle } else { 0.0 }
    }

    /// The double nearest to its lower end, for people to read.
    pub fn to_f64(&self) -> f64 {
        self.low.to_f64().value()
    }
}

impl Add for &Interval {
    type Output = Interval;
    fn add(self, other: Self) -> Interval {
        Interval { low: low(DOWN.add(&self.low, &other.low)), high: high(UP.add(&self.high, &other.high)) }
    }
}

impl Sub for &Interval {
    type Output = Interval;
    fn sub(self, other: Self) -> Interval {
        Interval { low: low(DOWN.sub(&self.low, &other.high)), high: high(UP.sub(&self.high, &other.low)) }
    }
}

impl Neg for &Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { low: -self.high.clone(), high: -self.low.clone() }
    }
}

impl Mul for &Interval {
    type Output = Interval;
    fn mul(self, other: Self) -> Interval {
        if !(self.is_bounded() && other.is_bounded()) {
            return Interval::unknown();
        }
        self.of_ends(other, |a, b| low(DOWN.mul(a, b)), |a, b| high(UP.mul(a, b)))
    }
}

/// Three coordinates; the third is zero in the plane.
#[derive(Clone, Debug)]
pub(crate) struct Vector(pub(crate) [Interval; 3]);

impl Vector {
    pub(crate) fn zero() -> Self {
        Self(std::array::from_fn(|_| Interval::zero()))
    }

    pub(crate) fn dot(&self, other: &Self) -> Interval {
        let [x, y, z] = std::array::from_fn(|i| &self.0[i] * &other.0[i]);
        &(&x + &y) + &z
    }

    pub(crate) fn squared(&self) -> Interval {
        let [x, y, z] = self.0.each_ref().map(Interval::squared);
        &(&x + &y) + &z
    }

    pub(crate) fn length(&self) -> Interval {
        self.squared().root()
    }

    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([&(b * z) - &(c * y), &(c * x) - &(a * z), &(a * y) - &(b * x)])
    }

    /// The vector over its length, if that is certainly not zero.
    pub(crate) fn unit(&self) -> Option<Self> {
        let length = self.length();
        Interval::zero().is_less_than(&length).then(|| Self(self.0.each_ref().map(|x| x.over(&length))))
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] + &other.0[i]))
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.times(&Interval::from(-1.0)))
    }

    pub(crate) fn times(&self, factor: &Interval) -> Self {
        Self(self.0.each_ref().map(|x| x * factor))
    }
}

/// The determinant of a square matrix, by minors; exact where the entries are and few bits are needed.
pub(crate) fn determinant(rows: &[Vec<Interval>]) -> Interval {
    let Some(first) = rows.first() else { return Interval::from(1.0) };
    let mut sum = Interval::zero();
    for (column, entry) in first.iter().enumerate() {
        let without = |row: &Vec<Interval>| {
            row.iter().enumerate().filter(|(j, _)| *j != column).map(|(_, e)| e.clone()).collect()
        };
        let minor: Vec<Vec<Interval>> = rows[1..].iter().map(without).collect();
        let term = entry * &determinant(&minor);
        sum = if column % 2 == 0 { &sum + &term } else { &sum - &term };
    }
    sum
}
