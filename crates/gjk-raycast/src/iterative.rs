//! A ray cast from closest points alone (the paper's Algorithm 1).

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::error::RayCastError;
use crate::ray_cast::{Ray, check_finite};
use crate::{Iterate, Miss, Outcome, RayCast, RayCastOptions, RayHit, Status};

/// The first point of a ray in a convex set that is known by its closest points: `closest_point(x)` is the point of
/// the set closest to `x`, which is `x` itself within the set.
///
/// The method moves to the plane through the closest point, again and again. It is Newton's iteration for the distance
/// along the ray: on a polytope it ends after finitely many steps, and on a curved surface the digits double with each.
///
/// ```
/// use convex_support::glam::DVec2;
/// use gjk_raycast::{Ray, RayCastOptions, iterative_ray_cast};
///
/// let disc = |x: DVec2| if x.length() > 1.0 { x.normalize() } else { x };
/// let ray = Ray { source: DVec2::new(-3.0, 0.6), direction: DVec2::X };
/// let hit = iterative_ray_cast(disc, ray, RayCastOptions::default())?.outcome.hit().ok_or("it hits")?;
/// assert!((hit.lambda - 2.2).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RayCastError`] if the direction is zero or a coordinate is not finite.
pub fn iterative_ray_cast<V: Vector>(
    closest_point: impl FnMut(V) -> V,
    ray: Ray<V>,
    options: RayCastOptions<V>,
) -> Result<RayCast<V>, RayCastError> {
    iterative_ray_cast_with(closest_point, ray, options, |_| {})
}

/// [`iterative_ray_cast`], showing an observer every iterate: `v` is the vector to the current point of the ray from
/// the closest point.
///
/// # Errors
/// [`RayCastError`] if the direction is zero or a coordinate is not finite.
pub fn iterative_ray_cast_with<V: Vector>(
    mut closest_point: impl FnMut(V) -> V,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    mut observer: impl FnMut(Iterate<'_, V>),
) -> Result<RayCast<V>, RayCastError> {
    check_finite("source", ray.source)?;
    check_finite("direction", ray.direction)?;
    let direction = ray.direction.unit().ok_or(RayCastError::ZeroDirection)?;
    let speed = ray.direction.norm();
    let zero = V::Scalar::ZERO;
    let rounding = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;

    let mut lambda = zero;
    let mut normal = None;
    let mut answer = RayCast {
        outcome: Outcome::Undecided,
        lower: zero,
        upper: V::Scalar::infinity(),
        status: Status::IterationLimit,
        iterations: 0,
    };
    while answer.iterations < options.max_iterations {
        let x = ray.at(lambda);
        let c = closest_point(x);
        answer.iterations += 1;
        let v = x - c;
        let length = v.norm();
        observer(Iterate {
            iteration: answer.iterations - 1,
            simplex: &[v],
            v,
            w: v,
            scale: V::Scalar::ONE,
            lower: lambda,
            upper: answer.upper,
        });
        answer.lower = lambda;
        // x is only known to the rounding of its coordinates, and so is its distance.
        let noise = rounding * (x.norm() + c.norm());
        if length <= noise {
            answer.upper = lambda;
            answer.status = Status::Converged;
            answer.outcome = Outcome::Hit(RayHit { lambda, point: x, normal });
            break;
        }
        let n = v / length;
        let slope = n.dot(direction);
        let next = lambda - length / slope / speed;
        if slope >= zero || next > options.max_lambda {
            answer.lower = if slope >= zero { V::Scalar::infinity() } else { next };
            answer.status = Status::Converged;
            answer.outcome = Outcome::Miss(Miss { axis: n });
            break;
        }
        if !(next > lambda) {
            answer.status = Status::Stalled;
            break;
        }
        lambda = next;
        normal = Some(n);
    }
    Ok(answer)
}
