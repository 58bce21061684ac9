//! Where a ray, or a body that moves straight, enters a half-space.

use convex_support::numerics::bound::roundings;
use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float;

use super::HalfSpace;
use super::plane::{Lowest, Plane};
use crate::contact::Level;
use crate::{
    Cast, Impact, LinearCast, LinearCastOptions, Miss, Motion, Outcome, Ray, RayCast, RayCastError, RayCastOptions,
    RayHit, StartInContact, Status,
};

impl<V: Vector> HalfSpace<V> {
    /// The ray's first point in the half-space: where n·(s + λd) = offset, λ = (n·s − offset)/(−n·d).
    ///
    /// Its beginning and end are treated as by [`ray_cast`](crate::ray_cast()). The height and the speed are each
    /// accurate to a few roundings of themselves, and so is λ.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast(&self, ray: Ray<V>, options: RayCastOptions<V>) -> Result<RayCast<V>, RayCastError> {
        ray.check(&options)?;
        let zero = V::Scalar::ZERO;
        let plane = self.plane();
        if options.is_empty() {
            return Ok(RayCast::missed(plane.unit));
        }
        let begin = options.min_lambda.max(zero);
        let (height, sinking) = if begin > zero {
            let way = ray.direction * begin;
            // The product is rounded in each coordinate.
            let rounded = plane.per_length(roundings(2.0, plane.normal().abs().dot(way.abs())));
            (plane.height([ray.source, way], rounded, zero), plane.sinking([ray.direction]))
        } else {
            (plane.height([ray.source], zero, zero), plane.sinking([ray.direction]))
        };
        let rest = options.max_lambda - begin;
        let Cast { outcome, lower, upper, status, iterations } =
            plane.crossing(height, sinking, rest + roundings(1.0, rest));
        // The rounding of the sums.
        let from_source = |lambda, count| {
            let sum: V::Scalar = begin + lambda;
            if sum.is_finite() { sum + roundings(count, sum) } else { lambda }
        };
        let is_at_once = begin <= zero;
        let mut outcome = outcome.map(|time| {
            let lambda = if is_at_once { time } else { begin + time };
            let point = if lambda > zero { ray.at(lambda) } else { ray.source };
            RayHit { lambda, point, normal: (time > zero).then_some(plane.unit) }
        });
        let (lower, upper) = if is_at_once {
            (lower, upper)
        } else if upper <= zero {
            (begin, begin)
        } else {
            (from_source(lower, -4.0).max(begin), from_source(upper, 4.0))
        };
        let upper = outcome.until(options.max_lambda, upper, |hit| hit.lambda);
        let status = status.of(&outcome, upper < Float::infinity());
        Ok(RayCast { outcome, lower, upper, status, iterations })
    }

    /// The first contact of a moving shape, `a`, with the half-space, `b`: the ray of its lowest point.
    ///
    /// # Errors
    /// Those of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<V>,
        options: LinearCastOptions<V>,
    ) -> Result<LinearCast<V>, RayCastError> {
        motion.check(&options)?;
        let zero = V::Scalar::ZERO;
        let plane = self.plane();
        let Lowest { height, point } = plane.lowest(shape, options.target_distance.max(zero));
        let sinking = plane.sinking([motion.velocity_a, -motion.velocity_b]);
        let goes_deeper = options.start_in_contact == StartInContact::IfDeeper;
        // What may be in contact gets deeper just if it sinks, however deep it is. NaN tells nothing.
        if goes_deeper && height.least() <= zero && !(sinking.least() > zero) {
            let miss = (Outcome::Miss(Miss { axis: plane.unit }), V::Scalar::infinity(), Status::Converged);
            let is_known = sinking.most() <= zero;
            let (outcome, lower, status) = if is_known { miss } else { (Outcome::Undecided, zero, Status::Stalled) };
            return Ok(LinearCast::without_upper(outcome, lower, status, 1));
        }
        let Cast { outcome, lower, upper, status, .. } = plane.crossing(height, sinking, options.max_time);
        let has_normal = height.most() >= zero || goes_deeper;
        let outcome = outcome.map(|time| {
            // With a target distance, the point of the half-space below.
            let point = point + motion.velocity_a * time;
            Impact { time, point, normal: (time > zero || has_normal).then_some(plane.unit) }
        });
        Ok(LinearCast { outcome, lower, upper, status, iterations: 1 })
    }
}

impl<V: Vector> Plane<V> {
    /// When a point at a height, which sinks at a speed, lands, counted from zero, if it lands before `end`. If it may
    /// be in the half-space already, the answer is a hit at once. This hit is certain if the point is inside by more
    /// than its error, or certainly sinks.
    pub(super) fn crossing(
        &self,
        height: Level<V::Scalar>,
        sinking: Level<V::Scalar>,
        end: V::Scalar,
    ) -> Cast<V::Scalar, V> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let miss = |lower| Cast::without_upper(Outcome::Miss(Miss { axis: self.unit }), lower, Status::Converged, 0);
        let undecided = |lower| Cast::without_upper(Outcome::Undecided, lower, Status::Stalled, 0);
        let hit = |time, lower, upper| {
            let mut outcome = Outcome::Hit(time);
            let upper = outcome.until(end, upper, |&time| time);
            let status = Status::Converged.of(&outcome, upper < infinity);
            Cast { outcome, lower, upper, status, iterations: 0 }
        };
        let is_known = height.value.is_finite() && height.error.is_finite() && !sinking.value.is_nan();
        if !is_known {
            return undecided(zero);
        }
        if end < zero {
            return miss(infinity);
        }
        // The quotient loses half an ε.
        let latest = |height: V::Scalar| {
            let time = height / sinking.least();
            if sinking.least() > zero { time + roundings(2.0, time) } else { infinity }
        };
        if !(height.least() > zero) {
            let upper = if height.most() <= zero { zero } else { latest(height.most()) };
            return hit(zero, zero, upper);
        }
        if !(sinking.most() > zero) {
            return miss(infinity);
        }
        let earliest = (height.least() / sinking.most()).min(V::Scalar::max_value());
        let lower = earliest - roundings(2.0, earliest);
        if lower > end {
            return miss(infinity);
        }
        if !(sinking.least() > zero) {
            return undecided(lower);
        }
        hit(height.value / sinking.value, lower, latest(height.most()))
    }
}
