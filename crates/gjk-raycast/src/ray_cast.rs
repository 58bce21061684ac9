//! Where a ray enters a shape: the paper's question, answered by a closed form, by a portal or by its Algorithm 3.

use convex_support::numerics::bound::roundings;
use convex_support::{LineQuery, Point, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float;

use crate::body::{CastBody, Measures, Single};
use crate::cast::{
    CastHit, CastRay, LocalRay, ObstacleCast, Part, RayBodies, cast, certain, certain_closely, is_plain, settle_ends,
    show,
};
use crate::observer::Observer;
use crate::pair::{Shape, WithoutLines};
use crate::unit::power_of_two_near;
use crate::{Iterate, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, Status};

/// The first point of a ray in a shape, with the normal there.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, ray_cast};
///
/// let planet = Posed::translated(Ball::new(2.0)?, DVec3::new(10.0, 0.0, 0.0))?;
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let cast = ray_cast(&planet, ray, RayCastOptions::default())?;
/// let hit = cast.outcome.hit().ok_or("it is in the way")?;
/// assert_eq!((hit.lambda, hit.normal), (8.0, Some(DVec3::NEG_X)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
#[doc = include_str!("../doc/ray.svg")]
///
/// # How it begins and ends
/// - If the source is in the target, or no farther from it than its own error, the answer is a hit at λ = 0 with no
///   normal, whatever the direction.
/// - If the source is outside, by however little, a ray that leaves or slides past the target is a miss.
/// - A ray that grazes the target within rounding may be a hit or a miss. A hit is certain if
///   [`upper`](RayCast::upper) is finite ([`is_certain`](RayCast::is_certain)); otherwise the status is
///   [`Status::Stalled`].
/// - The end of the ray, [`max_lambda`](RayCastOptions::max_lambda), belongs to the ray.
/// - A ray can begin beyond its source, at [`min_lambda`](RayCastOptions::min_lambda), which belongs to the ray. So a
///   shadow ray can leave the surface that it starts on. If the ray begins in the target, the answer is a hit there,
///   with no normal.
/// - [`ray_exit`](crate::ray_exit) tells where the ray leaves the target again.
///
/// # Accuracy
/// The error of λ is a few ulps of the target's size, divided by the cosine of the angle of incidence, and a few ulps
/// of the distance of the source.
///
/// # Errors
/// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
#[doc(alias("raycast", "line_trace", "cast_ray", "ray_intersection"))]
#[inline]
pub fn ray_cast<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
) -> Result<RayCast<S::Vector>, RayCastError> {
    match plainly(target, ray, &options) {
        Some(answer) => Ok(answer),
        None => searched(target, ray.source, ray.direction, options, Observer::none()),
    }
}

/// [`ray_cast`] with an observer that sees every iterate.
///
/// # Errors
/// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
#[inline]
pub fn ray_cast_with<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
    mut observer: impl FnMut(Iterate<'_, S::Vector>),
) -> Result<RayCast<S::Vector>, RayCastError> {
    let mut observer = Observer::new(&mut observer);
    match plainly(target, ray, &options) {
        Some(answer) => {
            show(&answer, &mut Single::new(target), ray, &mut observer);
            Ok(answer)
        }
        None => searched(target, ray.source, ray.direction, options, observer),
    }
}

/// The cast by the certain crossing of the shape in plain numbers, if there is one.
///
/// Twice the precision is left to [`searched`]: in the same function it made the answer go through memory, and rays
/// at balls and boxes took 15 to 30 % more instructions. And the shape is called here, not by [`certain`]: through a
/// closure rays at balls and cylinders took 4 % more.
#[inline(always)]
fn plainly<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: &RayCastOptions<S::Vector>,
) -> Option<RayCast<S::Vector>> {
    if !is_plain(options) {
        return None;
    }
    let ray = ray.by_coordinates();
    certain(target.certain_crossing(LineQuery::new(ray.source, ray.direction))?, ray, options)
}

/// The cast if nothing is certain in plain numbers. Each vector of the ray is passed by itself: of a ray that is
/// written to memory in pieces and then read in others, the processor waits for the pieces.
#[inline(never)]
fn searched<S: SupportMap + ?Sized>(
    target: &S,
    source: S::Vector,
    direction: S::Vector,
    options: RayCastOptions<S::Vector>,
    mut observer: Observer<'_, S::Vector>,
) -> Result<RayCast<S::Vector>, RayCastError> {
    let ray = Ray { source, direction };
    ray.check(&options)?;
    let mut body = Single::new(target);
    let known = certain_closely(&mut body, ray, Scalar::ZERO, &options, &mut observer);
    match known {
        Some(answer) if !(answer.upper > options.max_lambda) || answer.outcome.is_miss() => Ok(answer),
        _ => Ok(by_search(&mut body, &WithoutLines(target), ray, &options, known.as_ref(), &mut observer)),
    }
}

compiled_once! {
    /// The cast by a search, for a body that is the shape; or of which all is known but whether it ends before its hit.
    fn by_search<V>(
        body: &mut dyn CastBody<Vector = V>,
        shape: Shape<'_, V>,
        ray: Ray<V>,
        options: &RayCastOptions<V>,
        known: Option<&RayCast<V>>,
        observer: &mut Observer<'_, V>,
    ) -> RayCast<V> {
        if options.min_lambda > Scalar::ZERO {
            return late(body, ray, *options, observer);
        }
        let mut cast = match known {
            Some(known) => ObstacleCast::of_certain(known, body, ray),
            None => cast(body, CastRay::of(ray, Part::Whole), options, observer),
        };
        if let Ok(tip) = Point::new(ray.source) {
            let (b, skin, direction_error) = (&WithoutLines(&tip), Scalar::ZERO, Scalar::ZERO);
            settle_ends(&mut cast, RayBodies { a: shape, skin, b, direction: ray.direction, direction_error }, options);
        }
        answer(cast, ray)
    }
}

/// The cast of a ray that begins at [`min_lambda`](RayCastOptions::min_lambda).
///
/// The place of this beginning on the line is known only to within a slack. So the ray is cast from a slack before
/// it. If the hit is later than a slack behind the beginning, it is an ordinary hit. An earlier hit is reported at
/// the beginning; its upper bound is the hit of a ray that begins a slack behind it.
#[cold]
#[inline(never)]
fn late<V: Vector>(
    body: &mut dyn CastBody<Vector = V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    observer: &mut Observer<'_, V>,
) -> RayCast<V> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let (begin, end) = (options.min_lambda, options.max_lambda);
    if options.is_empty() {
        return RayCast::missed(ray.direction);
    }
    let Measures { origin, radius, extent, .. } = body.measures();
    let size = extent + radius;
    let whole = LocalRay::new(ray, origin, power_of_two_near(size.max((ray.source - origin).norm())));
    let error = whole.error(whole.mu(begin), zero);
    let slack = error + error;
    if !(begin + slack < infinity) {
        // Numbers are out of range.
        return RayCast::without_upper(Outcome::Undecided, begin, Status::Stalled, 0);
    }
    let mut from = |begin| {
        // To a slack behind the end, so that a ray that ends before that misses.
        let rest = end - begin + slack;
        let wanted = options.with_max_lambda(rest + roundings(2.0, rest));
        answer(cast(body, CastRay::of(ray, Part::From(begin)), &wanted, observer), ray)
    };
    let early = from(begin - slack);
    let mut answer = match early.outcome {
        Outcome::Hit(hit) if hit.lambda <= slack + slack => {
            let behind = from(begin + slack);
            let upper =
                if early.upper <= zero && behind.upper <= zero { begin } else { begin + slack + behind.upper + error };
            let outcome = Outcome::Hit(RayHit { lambda: begin, point: ray.at(begin), normal: None });
            let iterations = early.iterations + behind.iterations;
            RayCast { outcome, lower: begin, upper, status: behind.status, iterations }
        }
        _ => {
            let (mut answer, start) = (early, begin - slack);
            if let Outcome::Hit(hit) = &mut answer.outcome {
                hit.lambda = (start + hit.lambda).max(begin);
                hit.point = ray.at(hit.lambda);
            }
            answer.lower = (start + answer.lower - error).max(begin);
            answer.upper = start + answer.upper + error;
            answer
        }
    };
    answer.upper = answer.outcome.until(end, answer.upper, |hit| hit.lambda);
    answer.status = answer.status.of(&answer.outcome, answer.upper < infinity);
    answer
}

#[inline(always)]
fn answer<V: Vector>(cast: ObstacleCast<V>, ray: Ray<V>) -> RayCast<V> {
    let outcome = cast.outcome.map(|CastHit { lambda, normal, .. }| {
        let point = if lambda > Scalar::ZERO { ray.at(lambda) } else { ray.source };
        RayHit { lambda, point, normal }
    });
    let status = cast.status.of(&outcome, cast.upper < V::Scalar::infinity());
    RayCast { outcome, lower: cast.lower, upper: cast.upper, status, iterations: cast.iterations }
}
