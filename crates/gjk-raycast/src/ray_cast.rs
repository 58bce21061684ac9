//! Where a ray enters a shape (the paper's Algorithm 3).

use convex_support::{Scalar, SupportMap};

use crate::body::Single;
use crate::cast::{CastHit, cast};
use crate::{Iterate, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit};

/// The first point of a ray in a shape, with the normal there.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, ray_cast};
///
/// let planet = Posed::translated(Ball::new(2.0)?, DVec3::new(10.0, 0.0, 0.0))?;
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let hit = ray_cast(&planet, ray, RayCastOptions::default())?.outcome.hit().ok_or("it is in the way")?;
/// assert_eq!((hit.lambda, hit.normal), (8.0, Some(DVec3::NEG_X)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
#[doc = include_str!("../doc/ray.svg")]
///
/// # How it begins and ends
/// - A source in the target, or on its boundary to rounding, is a hit at λ = 0 with no normal, whatever the direction.
/// - A source outside is a hit or a miss by the ray alone: one that leaves or slides by at a distance misses.
/// - A ray that grazes the target within rounding may be either.
/// - The end of the ray, [`max_lambda`](RayCastOptions::max_lambda), belongs to it.
///
/// # Accuracy
/// λ is within rounding of the truth: a few ulps of the target's size (divided by the cosine at grazing incidence) and
/// of the source's distance.
///
/// # Errors
/// [`RayCastError`] if the direction is zero or a coordinate is not finite.
pub fn ray_cast<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
) -> Result<RayCast<S::Vector>, RayCastError> {
    ray_cast_with(target, ray, options, |_| {})
}

/// [`ray_cast`], showing an observer every iterate.
///
/// # Errors
/// [`RayCastError`] if the direction is zero or a coordinate is not finite.
pub fn ray_cast_with<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
    observer: impl FnMut(Iterate<'_, S::Vector>),
) -> Result<RayCast<S::Vector>, RayCastError> {
    ray.check()?;
    let cast = cast(&mut Single::new(target), ray, options, observer);
    let outcome = match cast.outcome {
        Outcome::Hit(CastHit { lambda, normal, .. }) => {
            let point = if lambda > Scalar::ZERO { ray.at(lambda) } else { ray.source };
            Outcome::Hit(RayHit { lambda, point, normal })
        }
        Outcome::Miss(miss) => Outcome::Miss(miss),
        Outcome::Undecided => Outcome::Undecided,
    };
    Ok(RayCast { outcome, lower: cast.lower, upper: cast.upper, status: cast.status, iterations: cast.iterations })
}
