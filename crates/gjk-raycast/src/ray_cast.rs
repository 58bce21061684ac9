//! Where a ray enters a shape (the paper's Algorithm 3).

use convex_support::{Scalar, SupportMap, Vector};

use crate::body::Single;
use crate::cast::{Contact, cast};
use crate::error::RayCastError;
use crate::{Iterate, Outcome, RayCast, RayCastOptions, RayHit};

/// The ray of the points `source + λ·direction`, λ ≥ 0. The direction need not be of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray<V> {
    /// Where it starts.
    pub source: V,
    /// Where it goes, and the unit of λ.
    pub direction: V,
}

impl<V: Vector> Ray<V> {
    /// The point at parameter `lambda`.
    #[must_use]
    pub fn at(&self, lambda: V::Scalar) -> V {
        self.source + self.direction * lambda
    }

    /// The error of a ray that cannot be cast.
    pub(crate) fn check(&self) -> Result<(), RayCastError> {
        // Zero times what is not finite is NaN; a sum that overflows is looked at coordinate by coordinate.
        if (self.source + self.direction).dot(V::ZERO) != V::Scalar::ZERO {
            check_finite("source", self.source)?;
            check_finite("direction", self.direction)?;
        }
        if self.direction == V::ZERO { Err(RayCastError::ZeroDirection) } else { Ok(()) }
    }
}

pub(crate) fn check_finite<V: Vector>(parameter: &'static str, vector: V) -> Result<(), RayCastError> {
    use num_traits::Float as _;
    match (0..V::DIM).find(|&i| !vector.get(i).is_finite()) {
        Some(index) => Err(RayCastError::NonFinite { parameter, index }),
        None => Ok(()),
    }
}

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
        Outcome::Hit(Contact { lambda, normal, .. }) => {
            let point = if lambda > Scalar::ZERO { ray.at(lambda) } else { ray.source };
            Outcome::Hit(RayHit { lambda, point, normal })
        }
        Outcome::Miss(miss) => Outcome::Miss(miss),
        Outcome::Undecided => Outcome::Undecided,
    };
    Ok(RayCast { outcome, lower: cast.lower, upper: cast.upper, status: cast.status, iterations: cast.iterations })
}
