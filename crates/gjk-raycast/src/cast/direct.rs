//! The plain case of a closed form of which the shape does not say how certain it is, and of linear casts: the ray
//! comes from outside and crosses a plane at a definite angle, or passes the body by a definite distance.
//!
//! What is certain rests on the same as in a [`Bracket`](super::bracket::Bracket): a miss and a lower bound on the
//! plane of one support point, an upper bound on a ball that rolls within the body, or on where the line enters what is
//! left of it without two errors. But nothing is prepared for a search: lengths stay in the world's unit, the direction
//! keeps its length, and a source near the body is the base of the line. Whatever is in doubt is left to the bracket.
//! `docs/ray-cast.md` derives the bounds.

use convex_support::numerics::range::is_comfortable;
use convex_support::numerics::twofold::foot_from;
use convex_support::{Crossing, LineCrossing, Scalar, Vector};
use num_traits::Float;

use super::bracket::{DEEP, NOISE};
use super::{Cast, CastHit};
use crate::body::{CastBody, Measures};
use crate::observer::Observer;
use crate::unit::is_moderate;
use crate::{CastMethod, Iterate, Miss, Outcome, Ray, RayCastOptions, Status};

/// From how many sizes away a line is looked at, at most.
const NEAR: f64 = 8.0;

/// What a plane that supports the body is wrong by at most where the line meets the body, in units of ε times the size,
/// beside the error of the support points.
///
/// With `u = ε/2`, and a base at most 8 sizes away: the offset from the origin loses `8u` of the size, the step along
/// the line `9u` and its sum `u`; the difference from a support point `2u`, its product with the normal `6u`; the
/// length of that, times the radius, and the last difference `4u`. In all `30u`.
const PLANE_ERROR: f64 = 16.0;

/// The same of a plane beside the line, where it is looked at from the base: the offset loses `8u`, the products of
/// base and support point with the axis `27u`, their difference `9u`, the product of the axis and the direction, times
/// how far the line is seen, `47u`, and sums, radius and squares `21u`. In all `112u`.
const AXIS_ERROR: f64 = 64.0;

/// The least cosine at which a plane is crossed: what its product of two vectors loses is nothing beside it.
const LEAST_SLOPE: f64 = 1.0 / 128.0;

/// The cast of a ray against a body, where it is the plain case. The direction may be wrong by some part of its length.
#[inline(always)]
pub(crate) fn direct<B: CastBody>(
    body: &mut B,
    ray: Ray<B::Vector>,
    direction_error: <B::Vector as Vector>::Scalar,
    options: &RayCastOptions<B::Vector>,
    observer: &mut Observer<'_, B::Vector>,
) -> Option<Cast<B::Vector>> {
    let Measures { origin, radius, extent, error, .. } = body.measures();
    let size = extent + radius;
    let longest = ray.direction.abs().max_element();
    // NaN and zero are not moderate.
    let is_moderate = is_moderate(size) & is_moderate(longest);
    if !is_moderate || options.method != CastMethod::Portal || options.max_iterations == 0 {
        return None;
    }
    let number = <B::Vector as Vector>::Scalar::from_f64;
    let (base, source) = match near(ray, origin, size) {
        Some(source) => (<B::Vector as Vector>::Scalar::ZERO, source),
        // Far along a direction that is wrong, a line is anywhere.
        None if direction_error > <B::Vector as Vector>::Scalar::ZERO => return None,
        None => {
            let (base, foot) = foot_from(origin, ray.source, ray.direction);
            let near = size * number(0.5 * NEAR);
            if !(foot.length_squared() <= near * near) {
                return None;
            }
            (base, foot)
        }
    };
    let turned = if direction_error > <B::Vector as Vector>::Scalar::ZERO {
        direction_error * size * <B::Vector as Vector>::Scalar::from_f64(NEAR + 2.0)
    } else {
        <B::Vector as Vector>::Scalar::ZERO
    };
    let line = BasedLine { base, source, direction: ray.direction, longest, size, error: error + turned };
    match body.line_crossing(source, ray.direction) {
        LineCrossing::Unknown => None,
        LineCrossing::Crosses(crossing) => line.hit(crossing, body, options, observer),
        LineCrossing::Misses(axis) => line.miss(axis, body, options, observer),
    }
}

/// The source of the ray, seen from the origin of the body, if it is near.
#[inline(always)]
fn near<V: Vector>(ray: Ray<V>, origin: V, size: V::Scalar) -> Option<V> {
    let source = ray.source - origin;
    let near = size * V::Scalar::from_f64(NEAR);
    (source.length_squared() <= near * near).then_some(source)
}

/// The line of a ray, in the frame of a body of a `size`, that passes near it at its parameter `base`.
struct BasedLine<V: Vector> {
    base: V::Scalar,
    /// The point there.
    source: V,
    direction: V,
    /// The largest coordinate of the direction: its length, but for a factor of `√3`.
    longest: V::Scalar,
    size: V::Scalar,
    /// What the support points are wrong by, and the line.
    error: V::Scalar,
}

impl<V: Vector> BasedLine<V> {
    /// The hit at the entry of a crossing, or the miss of a ray that ends before it.
    ///
    /// The body is behind the plane `n·y = n·p + r|n|`, and a point `x` of the line that is before it by `a` crosses it
    /// after `a/(−n·d)`.
    #[inline(always)]
    fn hit<B: CastBody<Vector = V>>(
        &self,
        Crossing { entry, normal, .. }: Crossing<V>,
        body: &mut B,
        options: &RayCastOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Option<Cast<V>> {
        let number = V::Scalar::from_f64;
        let (half, epsilon) = (number(0.5), V::Scalar::EPSILON);
        let (point, _) = body.support(normal);
        let x = self.source + self.direction * entry;
        let w = x - point;
        // The normal is nearly a unit vector, and |n| is 1 + excess/2 to the square of that.
        let excess = normal.length_squared() - V::Scalar::ONE;
        let ahead = normal.dot(w) - (body.measures().radius + body.measures().radius * (excess * half));
        let slope = -normal.dot(self.direction);
        let (noise, error) = (self.size * (epsilon * number(NOISE)), self.plane_error());
        let lambda = self.base + entry;
        let rounding = lambda * (epsilon + epsilon);
        let is_plain = (excess.abs() <= epsilon.sqrt() * half)
            & (slope >= self.longest * number(LEAST_SLOPE))
            & (ahead.abs() <= noise)
            & (x.length_squared() <= self.size * self.size * number(1.125))
            // There is a number for it.
            & (lambda < V::Scalar::infinity())
            // The plane is crossed after the ray's start.
            & ((lambda - rounding) * slope > error - ahead);
        if !is_plain {
            return None;
        }
        let within = self.certain_entry(body, entry, [slope, error])?;
        // A step of Newton's method for the reciprocal of the root.
        let n = normal - normal * (excess * half);
        let per_slope = slope.recip();
        let lower = lambda - ((error - ahead) * per_slope + rounding);
        if lambda > options.max_lambda {
            return (lower > options.max_lambda).then(|| missed(n));
        }
        show(observer, n, w);
        let latest = self.base + within;
        let upper = if latest > lambda { latest } else { lambda } + rounding;
        let witness = body.witness(x - n * body.measures().radius);
        Some(Cast {
            outcome: Outcome::Hit(CastHit { lambda, normal: Some(n), spot: x, witness }),
            lower,
            upper,
            ..certain()
        })
    }

    /// Where the line is in the body, at the latest, that enters it at `entry` through a plane that is wrong by an
    /// `error`, as it comes nearer to it by `slope` with each unit of its parameter.
    ///
    /// A ball that rolls within the body tells, where the line comes in so steeply that it [soon is in
    /// it](super::bracket::DEEP); or else what is left of the body without two errors: one moves the body, and one what
    /// is computed of the line.
    #[inline(always)]
    fn certain_entry<B: CastBody<Vector = V>>(
        &self,
        body: &B,
        entry: V::Scalar,
        [slope, error]: [V::Scalar; 2],
    ) -> Option<V::Scalar> {
        let number = V::Scalar::from_f64;
        // The length of the direction squared is no more than the dimension times this.
        let squared = self.longest * self.longest;
        let radius = body.measures().rolling_radius;
        if radius > V::Scalar::ZERO && slope * slope * radius > error * (squared * number(3.0 * DEEP)) {
            return Some(entry + error * number(1.5) / slope);
        }
        match body.eroded_line_crossing(self.source, self.direction, error + error) {
            LineCrossing::Crosses(within) => Some(within.entry),
            LineCrossing::Misses(_) | LineCrossing::Unknown => None,
        }
    }

    /// The miss by a plane across an axis, which is across the line to rounding.
    ///
    /// Of the line only what is in the ball about the body counts, and that is at most `NEAR + 1` sizes from the base:
    /// there it comes no nearer to the plane than by that times `|n·d|/|d|`.
    #[inline(always)]
    fn miss<B: CastBody<Vector = V>>(
        &self,
        axis: V,
        body: &mut B,
        options: &RayCastOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Option<Cast<V>> {
        let number = V::Scalar::from_f64;
        let reach = self.size * number(NEAR + 1.0) / self.longest;
        // A ray that ends before the ball, or begins behind it, is apart by another plane: far from here this one is
        // not known.
        let is_there = (self.base + reach >= V::Scalar::ZERO) & (self.base - reach <= options.max_lambda);
        if !is_there {
            return None;
        }
        // A short vector to a line that comes from far is across it only to the rounding of where it comes from.
        let along = axis.dot(self.direction) / self.direction.length_squared();
        let across = axis - self.direction * along;
        let squared = across.length_squared();
        if !is_comfortable(squared) {
            return None;
        }
        let n = across * squared.sqrt().recip();
        let (point, _) = body.support(n);
        let nearer = n.dot(self.direction).abs() * reach;
        let error = self.size * (V::Scalar::EPSILON * number(AXIS_ERROR)) + self.error;
        // NaN is no miss.
        if !(n.dot(self.source) - n.dot(point) - nearer > body.measures().radius + error) {
            return None;
        }
        show(observer, n, self.source - point);
        Some(missed(n))
    }

    /// What a plane is wrong by where the line meets the body.
    #[inline(always)]
    fn plane_error(&self) -> V::Scalar {
        self.size * (V::Scalar::EPSILON * V::Scalar::from_f64(PLANE_ERROR)) + self.error
    }
}

#[inline(always)]
fn show<V: Vector>(observer: &mut Observer<'_, V>, n: V, w: V) {
    let (lower, upper) = (V::Scalar::ZERO, V::Scalar::infinity());
    observer.show(|| Iterate { iteration: 0, simplex: &[], v: n, w, scale: V::Scalar::ONE, lower, upper });
}

/// A miss by a plane across a unit vector.
#[inline(always)]
fn missed<V: Vector>(axis: V) -> Cast<V> {
    Cast { outcome: Outcome::Miss(Miss { axis }), ..certain() }
}

/// What all such casts have in common: they take one support point, and leave nothing open.
#[inline(always)]
fn certain<V: Vector>() -> Cast<V> {
    let infinity = V::Scalar::infinity();
    Cast {
        outcome: Outcome::Undecided,
        lower: infinity,
        upper: infinity,
        status: Status::Converged,
        iterations: 1,
        scale: V::Scalar::ONE,
        is_open: false,
    }
}
