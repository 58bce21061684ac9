//! The distance of two shapes (the paper's Algorithm 2).

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::body::{Pair, PointPair};
use crate::gjk::{End, Frame, Gjk, GjkOptions, gjk};
use crate::unit::moderate;
use crate::{Distance, DistanceOptions, Iterate};

/// The distance of two shapes, and where they are closest.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, distance};
///
/// let table = Cuboid::new(DVec3::new(2.0, 0.1, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(0.5, 1.0, 0.0))?;
/// let answer = distance(&ball, &table, DistanceOptions::default());
/// assert!((answer.distance - 0.65).abs() < 1e-15);
/// assert!(answer.lower <= answer.distance && answer.distance <= answer.upper);
/// assert_eq!(answer.normal, Some(DVec3::Y)); // from the table to the ball
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// Two points of the shapes bound the distance from above, and a slab between the shapes from below. The iteration ends
/// where the two meet.
///
#[doc = include_str!("../doc/bracket.svg")]
pub fn distance<A, B>(a: &A, b: &B, options: DistanceOptions<A::Vector>) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    distance_with(a, b, options, |_| {})
}

/// [`distance`], showing an observer every iterate.
pub fn distance_with<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let mut pair = Pair::new(a, b);
    let (core_a, core_b) = (a.core(), b.core());
    let offset = core_a.origin - core_b.origin;
    let size = pair.size(offset);
    let frame = Frame::new(&mut pair, offset, size);
    let Frame { scale, per_unit, radius, noise, .. } = frame;
    let first = options.axis.and_then(moderate).or_else(|| moderate(frame.offset)).unwrap_or_else(|| Vector::axis(0));
    let mut state = Gjk::new(first);
    let closest = pair.closest_points(offset, size);
    let meet = closest.is_some_and(|points| state.begin_at(points.a - points.b + frame.offset, points, &frame));
    let options = GjkOptions {
        first: state.normal,
        limit: options.limit * per_unit + radius,
        tolerance: options.tolerance,
        closest_points: true,
        max_iterations: options.max_iterations,
        sub_algorithm: options.sub_algorithm,
    };
    let end = if meet { End::Overlap } else { gjk(&mut state, &mut pair, frame, options, None, observer) };
    state.ensure_measured();
    let Gjk { normal, length, lower, axis, ref simplex, .. } = state;
    let overlap = end == End::Overlap;
    let (mut point_a, mut point_b) = (A::Vector::ZERO, A::Vector::ZERO);
    for (weight, PointPair { a, b }) in simplex.weighted() {
        point_a += a * weight;
        point_b += b * weight;
    }
    let (mut point_a, mut point_b) = (core_a.origin + point_a * scale, core_b.origin + point_b * scale);
    let zero = Scalar::ZERO;
    let n = if length > zero && (overlap || radius > zero || lower <= zero) { normal.unit() } else { None };
    if let Some(n) = n {
        if !overlap {
            point_a -= n * core_a.radius;
            point_b += n * core_b.radius;
        } else {
            // The cores are apart by less than both radii: between them, a point in both.
            let part = (core_a.radius * per_unit / radius).min(Scalar::ONE);
            if part.is_finite() {
                point_a -= n * (length * part * scale);
                point_b += n * (length * (<A::Vector as Vector>::Scalar::ONE - part) * scale);
            }
        }
    }
    let gap = |l: <A::Vector as Vector>::Scalar| ((l - radius) * scale).max(zero);
    Distance {
        distance: if overlap { zero } else { gap(length) },
        lower: if overlap { zero } else { gap((lower - noise).min(length)) },
        upper: if overlap { gap(length + noise).min(noise * scale) } else { gap(length + noise) },
        overlap,
        point_a,
        point_b,
        normal: if overlap || length <= zero {
            None
        } else if lower > zero {
            axis.unit()
        } else {
            n
        },
        status: end.status(),
        iterations: state.iterations,
    }
}
