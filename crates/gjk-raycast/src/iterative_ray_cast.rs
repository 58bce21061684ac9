//! A ray cast from closest points alone (the paper's Algorithm 1).

use convex_support::{Scalar, Vector};
use num_traits::Float;

use crate::cast::LocalRay;
use crate::unit::power_of_two_near;
use crate::{Iterate, Miss, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, Status};

/// The first point of a ray in a convex set that is given by its closest points: `closest_point(x)` is the point of
/// the set closest to `x`, or `x` itself within the set, or `None` if it is not known.
///
/// Each step moves along the ray to the plane through the closest point. This is Newton's iteration for the distance
/// along the ray: on a polytope it ends after finitely many steps, and on a curved surface the digits double with each step.
/// The set is given by a function, so that it need not be a shape; for a shape, the function is
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
/// λ is as accurate as that of [`ray_cast`](crate::ray_cast), if the closest point is right to rounding of
/// the coordinates of `x` and of the set. The point closest to the source tells where the set is. The ray is based at its
/// own point closest to that one, so that a far source loses only its own digits.
///
/// # Errors
/// [`RayCastError`] if the direction is zero, a coordinate not finite, an end of the ray NaN, or a closest point not
/// known.
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
    ray.check(&options)?;
    let mut closest_point = |x| closest_point(x).ok_or(RayCastError::NoClosestPoint);
    let origin = closest_point(ray.source)?;
    if !origin.is_finite() {
        return Ok(undecided(V::Scalar::ZERO, Status::Stalled, 1));
    }
    let mut way = Way::new(ray, origin, &options);
    let mut iterations = 1;
    loop {
        let x = way.x();
        let c = if iterations == 1 && way.is_at_source() { origin } else { closest_point(x)? };
        let v = (x - c) * way.scale.recip();
        observer(Iterate {
            iteration: iterations - 1,
            simplex: &[v],
            v,
            w: v,
            scale: way.scale,
            lower: way.local.lambda(way.proved).max(way.least),
            upper: Float::infinity(),
        });
        match way.step(x, c, v) {
            Step::Advances if iterations < options.max_iterations => iterations += 1,
            Step::Advances => return Ok(undecided(way.lower(), Status::IterationLimit, iterations)),
            Step::Stalls => return Ok(undecided(way.lower(), Status::Stalled, iterations)),
            Step::Ends(Answer { outcome, lower, upper }) => {
                return Ok(RayCast { outcome, lower, upper, status: Status::Converged, iterations });
            }
        }
    }
}

/// The answer of a search that ended before it came to one.
fn undecided<V: Vector>(lower: V::Scalar, status: Status, iterations: usize) -> RayCast<V> {
    RayCast { outcome: Outcome::Undecided, lower, upper: Float::infinity(), status, iterations }
}

/// How far a ray has come, and the last plane that it crosses on the way.
struct Way<'o, V: Vector> {
    ray: Ray<V>,
    options: &'o RayCastOptions<V>,
    /// The point that the line is relative to, and the unit of its lengths.
    origin: V,
    scale: V::Scalar,
    local: LocalRay<V>,
    /// Where the ray begins on the line, and the λ of that.
    begin: V::Scalar,
    least: V::Scalar,
    /// Where the ray is, before the plane by what rounding may have moved that.
    mu: V::Scalar,
    /// Where it crosses the plane.
    crossing: V::Scalar,
    /// The ray does not enter the set before this, even if rounding turned the planes as well.
    proved: V::Scalar,
    /// The unit normal of the plane, and what that may be turned by.
    normal: Option<V>,
    tilt: V::Scalar,
}

enum Step<V: Vector> {
    Advances,
    /// The next plane is no farther along the ray than the last one.
    Stalls,
    Ends(Answer<V>),
}

struct Answer<V: Vector> {
    outcome: Outcome<RayHit<V>, V>,
    lower: V::Scalar,
    upper: V::Scalar,
}

impl<'o, V: Vector> Way<'o, V> {
    fn new(ray: Ray<V>, origin: V, options: &'o RayCastOptions<V>) -> Self {
        let zero = V::Scalar::ZERO;
        let scale = power_of_two_near((ray.source - origin).norm());
        let local = LocalRay::new(ray, origin, scale);
        let least = options.min_lambda.max(zero);
        let begin = if least > zero { local.mu(least) } else { local.start };
        Self {
            ray,
            options,
            origin,
            scale,
            local,
            begin,
            least,
            mu: begin,
            crossing: begin,
            proved: begin,
            normal: None,
            tilt: zero,
        }
    }

    fn is_at_source(&self) -> bool {
        self.mu <= self.local.start
    }

    /// The point of the ray, in the world.
    fn x(&self) -> V {
        if self.is_at_source() { self.ray.source } else { self.at(self.mu) }
    }

    fn at(&self, mu: V::Scalar) -> V {
        self.origin + self.local.line.at(mu) * self.scale
    }

    fn lower(&self) -> V::Scalar {
        (self.local.lambda(self.proved) - self.local.error(self.proved, V::Scalar::ZERO)).max(self.least)
    }

    /// Goes on to the plane through the closest point `c`, with `v` the vector from there in the unit.
    fn step(&mut self, x: V, c: V, v: V) -> Step<V> {
        let length = v.norm();
        // x is only known to the rounding of its coordinates, and so is its distance.
        let noise = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * (x.norm() + c.norm()) / self.scale;
        if length <= noise + noise {
            return Step::Ends(self.hit(noise));
        }
        let n = v / length;
        let slope = n.dot(self.local.line.direction);
        // What v is wrong by turns n by `noise/length`, so that the plane may be as much steeper to the ray than it seems.
        // The set is behind the plane, and so it is of all of the ray before x.
        let tilt = noise / length;
        self.proved = self.proved.max(self.mu - (length - noise) / (slope - tilt));
        if slope >= V::Scalar::ZERO || self.lower() > self.options.max_lambda {
            return Step::Ends(self.miss(n));
        }
        let next = self.mu - (length - noise) / slope;
        if !(next > self.mu) {
            return Step::Stalls;
        }
        (self.crossing, self.mu) = (self.mu - length / slope, next);
        (self.normal, self.tilt) = (Some(n), tilt);
        Step::Advances
    }

    /// The answer where x is in the set, to noise.
    fn hit(&self, noise: V::Scalar) -> Answer<V> {
        let (zero, from_f64) = (V::Scalar::ZERO, V::Scalar::from_f64);
        let (lower, least) = (self.lower(), self.least);
        let (lambda, upper) = if self.mu <= self.begin {
            (least, least)
        } else {
            // Where the set is entered, its surface may be flatter to the ray by what the last normal was turned by rounding.
            let slope = self.normal.map_or(V::Scalar::ONE, |n| -n.dot(self.local.line.direction));
            let slope = (slope - self.tilt).max(slope / from_f64(8.0));
            let lambda = self.local.lambda(self.crossing).max(least);
            (lambda, lambda + self.local.error(self.crossing, noise * from_f64(4.0) / slope))
        };
        let outcome = if lambda > self.options.max_lambda {
            Outcome::Miss(Miss { axis: self.normal.unwrap_or(-self.local.line.direction) })
        } else {
            let point = if lambda > zero { self.at(self.crossing) } else { self.ray.source };
            Outcome::Hit(RayHit { lambda, point, normal: self.normal })
        };
        Answer { outcome, lower, upper }
    }

    /// The answer where the plane across `n` through x's closest point has all of the ray before it that the last plane has left.
    fn miss(&self, n: V) -> Answer<V> {
        // Together with the plane before x, the axis has the whole ray before it: across the ray, both count.
        let direction = self.local.line.direction;
        let slope = n.dot(direction);
        let last = self.normal.filter(|_| slope > V::Scalar::ZERO);
        let axis = last.and_then(|m| (m * slope - n * m.dot(direction)).unit()).unwrap_or(n);
        let infinity = V::Scalar::infinity();
        Answer { outcome: Outcome::Miss(Miss { axis }), lower: infinity, upper: infinity }
    }
}
