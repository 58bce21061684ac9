//! A ray in the frame of a body.

use convex_support::numerics::twofold::foot_from;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Ray;
use crate::unit::{power_of_two_near, reciprocal_of_power};

/// The line `foot + μ·direction`, with `direction` of unit length and the foot its point closest to zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<V: Vector> {
    pub(crate) foot: V,
    pub(crate) direction: V,
}

impl<V: Vector> Line<V> {
    pub(crate) fn at(&self, mu: V::Scalar) -> V {
        self.foot + self.direction * mu
    }

    /// The part of `v` across the line.
    pub(crate) fn across(&self, v: V) -> V {
        v - self.direction * v.dot(self.direction)
    }
}

/// A bound on how far rounding moves the foot of a line, besides roundings of its own length, in units of ε² times the
/// distance `D` of the source.
///
/// With `u = ε/2`, the [foot](foot_from) is found up to `8uD` along the line from where it should be, so that the
/// fused multiply-add and the sum with what the difference lost round to `u` of that much each, `17u²D` in all. When it
/// is moved back by that, the direction is wrong by `u` across itself, and the product and the difference lose another
/// `24u²D`.
const OF_DISTANCE: f64 = 16.0;

/// A length in the unit of a body that is larger than its size, which is between one and two of them, or four where the
/// unit is as large as it can be.
const BEYOND: f64 = 8.0;

/// Which part of a ray is cast.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part<S> {
    Whole,
    /// The part from the parameter λ on, from which its own is counted.
    From(S),
    /// The whole line, from beyond any body back to where the ray comes from.
    Reversed,
}

/// The part of a ray to cast, given in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CastRay<V: Vector> {
    pub(crate) ray: Ray<V>,
    /// A bound on the error of the direction, as a part of its length.
    pub(crate) direction_error: V::Scalar,
    /// Parameters are counted from where it begins.
    pub(crate) part: Part<V::Scalar>,
}

impl<V: Vector> CastRay<V> {
    pub(crate) fn of(ray: Ray<V>, part: Part<V::Scalar>) -> Self {
        Self { ray, direction_error: Scalar::ZERO, part }
    }
}

/// A ray in the frame and the unit of a body: a line, based where it is closest to the body's origin, and where on it
/// the ray begins. However far the source is, all later numbers have the body's size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay<V: Vector> {
    pub(crate) line: Line<V>,
    /// Where the source is on the line.
    pub(crate) start: V::Scalar,
    /// A bound on how far the line is from the true one, besides what is relative to the length of its foot.
    pub(crate) lost: V::Scalar,
    /// One unit of μ, in units of λ.
    per_unit: V::Scalar,
}

impl<V: Vector> LocalRay<V> {
    /// The ray relative to `origin`, in units of the power of two `scale`.
    ///
    /// The foot of the line is right to rounding of its own length for the parameter that it is [found](foot_from) at.
    /// The error of that only shifts the foot along the line, where it is undone by a second projection.
    #[inline(always)]
    pub(crate) fn new(ray: Ray<V>, origin: V, scale: V::Scalar) -> Self {
        let down = reciprocal_of_power(scale);
        // The ray's own direction, brought near unit length, is exact, unlike its unit vector.
        let near_one = power_of_two_near(ray.direction.abs().max_element());
        let to_near_one = reciprocal_of_power(near_one);
        let exact = ray.direction * to_near_one;
        let length = exact.length();
        let per_length = length.recip();
        let direction = exact * per_length;
        let (t, foot) = foot_from(origin * down, ray.source * down, exact);
        let rest = foot.dot(direction);
        let foot = foot - direction * rest;
        let start = -(t * length - rest);
        let lost = start.abs() * (V::Scalar::EPSILON * V::Scalar::EPSILON * V::Scalar::from_f64(OF_DISTANCE));
        Self { line: Line { foot, direction }, start, lost, per_unit: scale * per_length * to_near_one }
    }

    #[inline(always)]
    pub(crate) fn part(self, part: Part<V::Scalar>) -> Self {
        let Line { foot, direction } = self.line;
        match part {
            Part::Whole => self,
            Part::From(lambda) => Self { start: self.mu(lambda), ..self },
            Part::Reversed => {
                let line = Line { foot, direction: -direction };
                Self { line, start: -self.beyond(), ..self }
            }
        }
    }

    /// A length beyond the body, which is as much farther along the line than its foot as rounding has moved that.
    fn beyond(&self) -> V::Scalar {
        V::Scalar::from_f64(BEYOND) + self.lost * V::Scalar::from_f64(BEYOND)
    }

    /// The parameter λ of the ray where that of the [reversed](Part::Reversed) one is `lambda`.
    pub(crate) fn reverse(&self, lambda: V::Scalar) -> V::Scalar {
        (self.beyond() - self.start) * self.per_unit - lambda
    }

    /// A bound on the rounding of [`reverse`](Self::reverse).
    pub(crate) fn error_of_reverse(&self) -> V::Scalar {
        self.error(self.beyond(), V::Scalar::ZERO)
    }

    /// The parameter λ of the ray at `μ` on the line.
    pub(crate) fn lambda(&self, mu: V::Scalar) -> V::Scalar {
        (mu - self.start) * self.per_unit
    }

    /// Where on the line the parameter λ of the ray is.
    pub(crate) fn mu(&self, lambda: V::Scalar) -> V::Scalar {
        self.start + lambda / self.per_unit
    }

    /// The rounding error of [`lambda`](Self::lambda), of which `error` is due to `mu` itself.
    pub(crate) fn error(&self, mu: V::Scalar, error: V::Scalar) -> V::Scalar {
        // At the start the difference is exactly zero.
        let sum = if mu == self.start { V::Scalar::ZERO } else { mu.abs() + self.start.abs() };
        (error + V::Scalar::from_f64(4.0) * V::Scalar::EPSILON * sum) * self.per_unit
    }
}
