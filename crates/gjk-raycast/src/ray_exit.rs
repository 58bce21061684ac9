//! Where a ray leaves a shape.

use convex_support::{Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use crate::body::{CastBody, Measures, Single};
use crate::cast::{CastHit, CastRay, LocalRay, ObstacleCast, Part, cast};
use crate::observer::Observer;
use crate::{Miss, Outcome, Ray, RayCastError, RayCastOptions, RayHit, Status, ray_cast};

/// The last point of a ray in a shape, with the normal there.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, ray_exit};
///
/// let planet = Posed::translated(Ball::new(2.0)?, DVec3::new(10.0, 0.0, 0.0))?;
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let cast = ray_exit(&planet, ray, RayCastOptions::default())?;
/// let exit = cast.outcome.hit().ok_or("it is in the way")?;
/// assert_eq!((exit.lambda, exit.normal), (12.0, Some(DVec3::X)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// The line of the ray is cast from beyond the shape back to the source, and certified like a [`ray_cast`]. Where
/// this line enters the shape, the ray leaves it.
///
/// - A ray with no point of the shape between [`min_lambda`](RayCastOptions::min_lambda) and
///   [`max_lambda`](RayCastOptions::max_lambda) is a miss.
/// - A ray that ends in the shape is a hit at its end, with no normal.
/// - The [`warm_start`](RayCastOptions::warm_start) of the options predicts the normal at the exit.
///
/// # Errors
/// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
#[doc(alias("back_face"))]
pub fn ray_exit<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
) -> Result<RayExit<S::Vector>, RayCastError> {
    ray.check(&options)?;
    let mut exit = by_search(&mut Single::new(target), ray, &options);
    let (begin, end) = (options.min_lambda.max(Scalar::ZERO), options.max_lambda);
    let infinity = <S::Vector as Vector>::Scalar::infinity();
    let Outcome::Hit(hit) = exit.outcome else { return Ok(exit) };
    if exit.upper < begin || options.is_empty() {
        return Ok(
            RayExit { outcome: Outcome::Miss(Miss { axis: hit.normal.unwrap_or(ray.direction) }), ..exit }.missed()
        );
    }
    if hit.lambda > end {
        // The line leaves the shape after the ray has ended, which is in the shape if it meets it at all.
        let entry = ray_cast(target, ray, RayCastOptions { warm_start: None, ..options })?;
        exit.iterations += entry.iterations;
        return Ok(match entry.outcome {
            Outcome::Hit(_) => {
                let outcome = Outcome::Hit(RayHit { lambda: end, point: ray.at(end), normal: None });
                // It is in the shape from where it enters for certain to where it leaves at the earliest.
                let lower = if entry.is_certain() { end.min(exit.lower) } else { -infinity };
                let status = if lower < end { exit.status } else { Status::Converged };
                RayExit { outcome, lower, upper: end, status, ..exit }.on_ray(begin)
            }
            Outcome::Miss(miss) => RayExit { outcome: Outcome::Miss(miss), status: entry.status, ..exit }.missed(),
            Outcome::Undecided => {
                let (outcome, status) = (Outcome::Undecided, entry.status);
                RayExit { outcome, lower: -infinity, upper: end, status, ..exit }
            }
        });
    }
    let lambda = hit.lambda.max(begin);
    exit.outcome = Outcome::Hit(RayHit { lambda, point: ray.at(lambda), normal: hit.normal });
    Ok(exit.on_ray(begin))
}

/// The answer of [`ray_exit`](crate::ray_exit).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct RayExit<V: Vector> {
    /// Where the ray leaves, with the outward normal there; a miss if no point of the ray is in the target; or
    /// undecided.
    pub outcome: Outcome<RayHit<V>, V>,
    /// A point of the ray at this parameter, or after it, is in the target; minus infinity if no such point is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// No point of the ray after this parameter is in the target; minus infinity for a miss.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed.
    pub iterations: usize,
}

impl<V: Vector> RayExit<V> {
    /// Whether the outcome is certain: a hit is if the lower bound is finite, and a miss always.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.outcome.is_certain(self.lower > -V::Scalar::infinity())
    }
}

compiled_once! {
    /// Where the whole line of the ray leaves a body.
    fn by_search<V>(body: &mut dyn CastBody<Vector = V>, ray: Ray<V>, options: &RayCastOptions<V>) -> RayExit<V> {
        let infinity = V::Scalar::infinity();
        let wanted = RayCastOptions { min_lambda: Scalar::ZERO, max_lambda: infinity, ..*options };
        let Measures { radius, extent, .. } = body.measures();
        if !(extent + radius).is_finite() {
            let (outcome, status) = (Outcome::Undecided, Status::Stalled);
            return RayExit { outcome, lower: -infinity, upper: infinity, status, iterations: 0 };
        }
        let cast = cast_back(body, CastRay::of(ray, Part::Whole), &wanted);
        let ObstacleCast { lower, upper, .. } = cast;
        let outcome = cast.outcome.map(|CastHit { lambda, normal, .. }| RayHit { lambda, point: ray.at(lambda), normal });
        let status = cast.status.of(&outcome, lower > -infinity);
        let answer = RayExit { outcome, lower, upper, status, iterations: cast.iterations };
        if outcome.is_miss() { answer.missed() } else { answer }
    }
}

/// Casts the whole line of a ray from beyond a body back to where it comes from, and says in parameters of the ray
/// where it leaves the body.
#[inline(always)]
pub(crate) fn cast_back<V: Vector>(
    body: &mut dyn CastBody<Vector = V>,
    line: CastRay<V>,
    options: &RayCastOptions<V>,
) -> ObstacleCast<V> {
    let infinity = V::Scalar::infinity();
    let origin = body.measures().origin;
    let mut cast = cast(body, CastRay { part: Part::Reversed, ..line }, options, &mut Observer::none());
    let forward = LocalRay::new(line.ray, origin, cast.scale);
    let (reverse, error) = (|lambda| forward.reverse(lambda), forward.error_of_reverse());
    (cast.lower, cast.upper) = (reverse(cast.upper) - error, reverse(cast.lower) + error);
    cast.outcome = cast.outcome.map(|hit| CastHit { lambda: reverse(hit.lambda), ..hit });
    cast.outcome.until(infinity, cast.upper, |hit| hit.lambda);
    if !(cast.lower <= cast.upper) {
        // Numbers are out of range.
        (cast.lower, cast.upper) = (-infinity, infinity);
    }
    cast
}

impl<V: Vector> RayExit<V> {
    /// For a ray that begins at a parameter of the line: points of the shape before it do not count.
    fn on_ray(self, begin: V::Scalar) -> Self {
        let is_bounded = self.lower >= begin;
        let lower = if is_bounded { self.lower } else { -V::Scalar::infinity() };
        Self { lower, status: self.status.of(&self.outcome, is_bounded), ..self }
    }

    fn missed(self) -> Self {
        let infinity = V::Scalar::infinity();
        Self { lower: -infinity, upper: -infinity, ..self }
    }
}
