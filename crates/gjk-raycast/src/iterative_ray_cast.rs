//! A ray cast from closest points alone (the paper's Algorithm 1).

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::cast::LocalRay;
use crate::unit::power_of_two_near;
use crate::{Iterate, Miss, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, Status};

/// The first point of a ray in a convex set that is known by its closest points: `closest_point(x)` is the point of
/// the set closest to `x`, which is `x` itself within the set, or `None` where that is not known.
///
/// The method moves to the plane through the closest point, again and again. It is Newton's iteration for the distance
/// along the ray: on a polytope it ends after finitely many steps, and on a curved surface the digits double with each.
/// Any set will do that gives closest points, not only shapes: so it is taken as a function. That of a shape is
/// [`closest_point`](convex_support::closest_point).
///
/// ```
/// use convex_support::{Cone, closest_point, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, iterative_ray_cast};
///
/// let cone = Cone::<DVec3>::new(1.0, 0.5)?;
/// let ray = Ray { source: DVec3::new(-1e6, 0.0, 0.0), direction: DVec3::X };
/// let cast = iterative_ray_cast(|x| closest_point(&cone, x), ray, RayCastOptions::default())?;
/// let hit = cast.outcome.hit().ok_or("it hits")?;
/// assert!((hit.lambda - (1e6 - 0.25)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Accuracy
/// λ is within rounding of the truth, as for [`ray_cast`](crate::ray_cast), if the closest point is within rounding of
/// the coordinates of `x` and of the set. The point closest to the source tells where the set is; the ray is based at its
/// own point closest to that, so that a far source costs nothing but its own digits.
///
/// # Errors
/// [`RayCastError`] if the direction is zero or a coordinate is not finite, or where a closest point is not known.
pub fn iterative_ray_cast<V: Vector>(
    closest_point: impl FnMut(V) -> Option<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
) -> Result<RayCast<V>, RayCastError> {
    iterative_ray_cast_with(closest_point, ray, options, |_| {})
}

/// [`iterative_ray_cast`], showing an observer every iterate: `v` is the vector to the current point of the ray from
/// the closest point.
///
/// # Errors
/// As [`iterative_ray_cast`].
pub fn iterative_ray_cast_with<V: Vector>(
    mut closest_point: impl FnMut(V) -> Option<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    mut observer: impl FnMut(Iterate<'_, V>),
) -> Result<RayCast<V>, RayCastError> {
    ray.check()?;
    let zero = V::Scalar::ZERO;
    let rounding = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
    let origin = closest_point(ray.source).ok_or(RayCastError::NoClosestPoint)?;
    let mut answer = RayCast {
        outcome: Outcome::Undecided,
        lower: zero,
        upper: V::Scalar::infinity(),
        status: Status::Stalled,
        iterations: 1,
    };
    if !origin.is_finite() {
        return Ok(answer);
    }
    let scale = power_of_two_near((ray.source - origin).norm());
    let local = LocalRay::new(ray, origin, scale);
    let (line, down) = (local.line, scale.recip());
    let direction = line.direction;

    // At μ, the ray is before the plane with the normal n, which it crosses at `crossing`: μ stays behind by what rounding
    // may have moved the plane. Not before `proved`, if rounding turned it as well, does the ray enter the set.
    let begin = if options.min_lambda > zero { local.mu(options.min_lambda) } else { local.start };
    let least = options.min_lambda.max(zero);
    let (mut mu, mut crossing, mut proved) = (begin, begin, begin);
    let (mut normal, mut tilt) = (None::<V>, zero);
    let mut c = origin;
    loop {
        let from_start = mu <= begin;
        let x = if mu <= local.start { ray.source } else { origin + line.at(mu) * scale };
        if answer.iterations > 1 || mu > local.start {
            c = closest_point(x).ok_or(RayCastError::NoClosestPoint)?;
        }
        let v = (x - c) * down;
        let length = v.norm();
        observer(Iterate {
            iteration: answer.iterations - 1,
            simplex: &[v],
            v,
            w: v,
            scale,
            lower: local.lambda(proved).max(least),
            upper: answer.upper,
        });
        // x is only known to the rounding of its coordinates, and so is its distance.
        let noise = rounding * (x.norm() + c.norm()) * down;
        answer.lower = (local.lambda(proved) - local.error(proved, zero)).max(least);
        if length <= noise + noise {
            // Where the set is entered, its surface may be flatter to the ray by what the last normal was turned by rounding.
            let slope = normal.map_or(V::Scalar::ONE, |n| -n.dot(direction));
            let slope = (slope - tilt).max(slope / V::Scalar::from_f64(8.0));
            let lambda = if from_start { least } else { local.lambda(crossing).max(least) };
            let point = if lambda > zero { origin + line.at(crossing) * scale } else { ray.source };
            answer.upper = if from_start {
                least
            } else {
                lambda + local.error(crossing, noise * V::Scalar::from_f64(4.0) / slope)
            };
            (answer.outcome, answer.status) = if lambda > options.max_lambda {
                (Outcome::Miss(Miss { axis: normal.unwrap_or(-direction) }), Status::Converged)
            } else {
                (Outcome::Hit(RayHit { lambda, point, normal }), Status::Converged)
            };
            break;
        }
        let n = v / length;
        let slope = n.dot(direction);
        let next = mu - (length - noise) / slope;
        // What v is wrong by turns n by `noise/length`, so that the plane may be as much steeper to the ray than it seems.
        // The set is behind the plane, and so it is of all of the ray before x.
        tilt = noise / length;
        proved = proved.max(mu - (length - noise) / (slope - tilt));
        if slope >= zero || local.lambda(proved) - local.error(proved, zero) > options.max_lambda {
            // Together with the plane before x, the axis has the whole ray before it: across the ray, both count.
            let axis = normal.filter(|_| slope > zero).and_then(|m| (m * slope - n * m.dot(direction)).unit());
            answer.outcome = Outcome::Miss(Miss { axis: axis.unwrap_or(n) });
            answer.status = Status::Converged;
            (answer.lower, answer.upper) = (V::Scalar::infinity(), V::Scalar::infinity());
            break;
        }
        if !(next > mu) {
            break;
        }
        if answer.iterations >= options.max_iterations {
            answer.status = Status::IterationLimit;
            break;
        }
        answer.iterations += 1;
        (mu, crossing, normal) = (next, mu - length / slope, Some(n));
    }
    Ok(answer)
}
