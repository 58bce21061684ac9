//! Where a ray, or what sinks like one, enters a half-space.

use convex_support::numerics::bound::roundings;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::HalfSpace;
use super::plane::Plane;
use crate::level::Level;
use crate::{Miss, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, Status};

impl<V: Vector> HalfSpace<V> {
    /// The ray's first point in the half-space: where n·(s + λd) = offset, λ = (n·s − offset)/(−n·d).
    ///
    /// Its beginning and end are treated as by [`ray_cast`](crate::ray_cast()). The height and the speed are each known
    /// to a few roundings of themselves, and so is λ.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast(&self, ray: Ray<V>, options: RayCastOptions<V>) -> Result<RayCast<V>, RayCastError> {
        ray.check(&options)?;
        let zero = V::Scalar::ZERO;
        let plane = self.plane();
        let begin = options.min_lambda.max(zero);
        let (height, sinking) = if begin > zero {
            let way = ray.direction * begin;
            // The product is rounded, coordinate by coordinate.
            let rounded = plane.per_length(roundings(2.0, plane.normal().abs().dot(way.abs())));
            (plane.height([ray.source, way], rounded, zero), plane.sinking([ray.direction]))
        } else {
            (plane.height([ray.source], zero, zero), plane.sinking([ray.direction]))
        };
        let Landing { outcome, lower, upper, status } = plane.crossing(height, sinking, options.max_lambda - begin);
        // What the sums lose.
        let from_source = |lambda, count| begin + lambda + roundings(count, begin + lambda);
        let is_at_once = begin <= zero;
        let outcome = match outcome {
            Outcome::Hit(lambda) if lambda > zero => {
                let lambda = if is_at_once { lambda } else { begin + lambda };
                Outcome::Hit(RayHit { lambda, point: ray.at(lambda), normal: Some(plane.unit) })
            }
            Outcome::Hit(_) => {
                let point = if is_at_once { ray.source } else { ray.at(begin) };
                Outcome::Hit(RayHit { lambda: begin, point, normal: None })
            }
            Outcome::Miss(miss) => Outcome::Miss(miss),
            Outcome::Undecided => Outcome::Undecided,
        };
        let (lower, upper) = if is_at_once {
            (lower, upper)
        } else if upper <= zero {
            (begin, begin)
        } else {
            (from_source(lower, -4.0).max(begin), from_source(upper, 4.0))
        };
        Ok(RayCast { outcome, lower, upper, status, iterations: 0 })
    }
}

/// When what sinks comes to the plane: its time, and bounds on it, of what begins at zero.
pub(super) struct Landing<V: Vector> {
    pub(super) outcome: Outcome<V::Scalar, V>,
    pub(super) lower: V::Scalar,
    pub(super) upper: V::Scalar,
    pub(super) status: Status,
}

impl<V: Vector> Plane<V> {
    /// When something at a height, which sinks at a speed, comes to the plane, if it does so until `end`. If it may be
    /// in the half-space already, the answer is a hit at once. That hit is certain if it is inside by more than its
    /// error, or certainly sinks.
    pub(super) fn crossing(&self, height: Level<V::Scalar>, sinking: Level<V::Scalar>, end: V::Scalar) -> Landing<V> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let miss = Landing {
            outcome: Outcome::Miss(Miss { axis: self.unit }),
            lower: infinity,
            upper: infinity,
            status: Status::Converged,
        };
        let undecided =
            |lower| Landing { outcome: Outcome::Undecided, lower, upper: infinity, status: Status::Stalled };
        let is_known = height.value.is_finite() && height.error.is_finite() && !sinking.value.is_nan();
        if !is_known {
            return undecided(zero);
        }
        if end < zero {
            return miss;
        }
        // The quotient loses half an ε.
        let latest = |height: V::Scalar| {
            let time = height / sinking.least();
            if sinking.least() > zero { time + roundings(2.0, time) } else { infinity }
        };
        if !(height.least() > zero) {
            let upper = if height.most() <= zero { zero } else { latest(height.most()) };
            let outcome = Outcome::Hit(zero);
            return Landing { status: Status::Converged.of(&outcome, upper < infinity), outcome, lower: zero, upper };
        }
        if !(sinking.most() > zero) {
            return miss;
        }
        let earliest = height.least() / sinking.most();
        let lower = earliest - roundings(2.0, earliest);
        if lower > end {
            return miss;
        }
        if !(sinking.least() > zero) {
            return undecided(lower);
        }
        // Whether a hit at the very end counts is decided by the time as it is returned.
        let time = height.value / sinking.value;
        if !(time <= end) {
            return Landing { lower, ..miss };
        }
        let (outcome, upper) = (Outcome::Hit(time), latest(height.most()));
        Landing { status: Status::Converged.of(&outcome, upper < infinity), outcome, lower, upper }
    }
}
