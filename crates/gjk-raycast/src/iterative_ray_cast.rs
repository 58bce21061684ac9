//! A ray cast from closest points alone (the paper's Algorithm 1), for what tells no support points.

use convex_support::{Scalar, Vector};
use num_traits::Float;

use crate::cast::LocalRay;
use crate::unit::power_of_two_near;
use crate::{Iterate, Miss, Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, Status};

/// How many places are tested for the ray to be certainly in the set, each four times as far behind the last plane.
const PLACES_BEHIND: usize = 8;

/// The first point of a ray in a convex set that is given by its closest points: `closest_point(x)` is the point of
/// the set closest to `x`, or `x` itself within the set, or `None` if it is not known.
///
/// Each step moves along the ray to the plane through the closest point. This is Newton's iteration for the distance
/// along the ray: on a polytope it ends after finitely many steps, and on a curved surface the digits double with
/// each step. The set is given by a function, so that it need not be a shape; for a shape, the function is
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
/// λ is as accurate as that of [`ray_cast`](crate::ray_cast), if the closest point is right to rounding of the
/// coordinates of `x` and of the set. The ray is based at its own point closest to the set's point closest to the
/// source, so that a far source loses only its own digits.
///
/// A closest point proves a plane, and so a lower bound. Points around the ray prove that it is in the set:
/// [`upper`](RayCast::upper) is where all of them are in the set by more than rounding. It is infinite if no such
/// place is found, as for a graze or a flat set.
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

/// [`iterative_ray_cast`] with an observer that sees every iterate: `v` is the vector from the closest point to the
/// current point of the ray.
///
/// # Errors
/// Those of [`iterative_ray_cast`].
pub fn iterative_ray_cast_with<V: Vector>(
    mut closest_point: impl FnMut(V) -> Option<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    mut observer: impl FnMut(Iterate<'_, V>),
) -> Result<RayCast<V>, RayCastError> {
    ray.check(&options)?;
    if options.is_empty() {
        return Ok(RayCast::missed(ray.direction));
    }
    let mut closest_point = |x| closest_point(x).ok_or(RayCastError::NoClosestPoint);
    let origin = closest_point(ray.source)?;
    if !origin.is_finite() {
        return Ok(RayCast::without_upper(Outcome::Undecided, V::Scalar::ZERO, Status::Stalled, 1));
    }
    let mut way = Travelled::new(ray, origin, &options);
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
            Step::Advances => {
                return Ok(RayCast::without_upper(Outcome::Undecided, way.lower(), Status::IterationLimit, iterations));
            }
            Step::Stalls => {
                return Ok(RayCast::without_upper(Outcome::Undecided, way.lower(), Status::Stalled, iterations));
            }
            Step::Misses(outcome) => {
                return Ok(RayCast::without_upper(outcome, Float::infinity(), Status::Converged, iterations));
            }
            Step::Arrives { noise } => {
                let upper = way.latest_entry(noise, &mut closest_point, &mut iterations)?;
                return Ok(way.hit(upper, iterations));
            }
        }
    }
}

/// How far a ray has come, and the last plane that it crosses on the way.
struct Travelled<'o, V: Vector> {
    ray: Ray<V>,
    options: &'o RayCastOptions<V>,
    /// The point that the line is relative to, and the unit of its lengths.
    origin: V,
    scale: V::Scalar,
    local: LocalRay<V>,
    /// Where the ray begins on the line, and its λ.
    begin: V::Scalar,
    least: V::Scalar,
    /// Where the ray is, before the plane by a bound on its rounding.
    mu: V::Scalar,
    /// Where it crosses the plane.
    crossing: V::Scalar,
    /// The ray does not enter the set before this, even if rounding turned the planes as well.
    proved: V::Scalar,
    /// The unit normal of the plane.
    normal: Option<V>,
    /// That of the first plane after it that the ray runs along, as far as rounding lets one know.
    along: Option<V>,
}

enum Step<V: Vector> {
    Advances,
    /// The next plane is no farther along the ray than the last one.
    Stalls,
    /// The point of the ray is in the set, to its rounding.
    Arrives {
        noise: V::Scalar,
    },
    Misses(Outcome<RayHit<V>, V>),
}

impl<'o, V: Vector> Travelled<'o, V> {
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
            along: None,
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

    /// A bound on the error of a point and its closest point, in the unit: they are only accurate to the rounding of
    /// their coordinates.
    fn noise(&self, x: V, c: V) -> V::Scalar {
        V::Scalar::from_f64(8.0) * V::Scalar::EPSILON * (x.norm() + c.norm()) / self.scale
    }

    /// Goes on to the plane through the closest point `c`, with `v` the vector from there in the unit.
    fn step(&mut self, x: V, c: V, v: V) -> Step<V> {
        let length = v.norm();
        let noise = self.noise(x, c);
        if length <= noise + noise {
            return Step::Arrives { noise };
        }
        let n = v / length;
        let slope = n.dot(self.local.line.direction);
        // What v is wrong by turns n by `noise/length`, so that the plane may be as much steeper to the ray than it
        // seems. The set is behind the plane, and so it is of all of the ray before x.
        let tilt = noise / length;
        self.proved = self.proved.max(self.mu - (length - noise) / (slope - tilt));
        if slope >= tilt || self.lower() > self.options.max_lambda {
            return Step::Misses(self.miss(n));
        }
        let approaches = slope < V::Scalar::ZERO;
        // A plane along the ray, as far as it is known, may be crossed at the end of what it proves.
        let next = if approaches { self.mu - (length - noise) / slope } else { self.proved };
        if !(next > self.mu) {
            return Step::Stalls;
        }
        self.crossing = if approaches { self.mu - length / slope } else { next };
        self.mu = next;
        self.along = if approaches { None } else { self.along.or(Some(n)) };
        self.normal = self.normal.filter(|_| !approaches).or(Some(n));
        Step::Advances
    }

    /// Where the ray is certainly in the set, tested from where it is in the set to noise; infinite if no place is
    /// found.
    ///
    /// At a place `x` of the ray, the points `x ± ρ·eᵢ` along the `n` axes are tested. If each is in the set to two
    /// noises `ν`, with an error of one, then points of the set are no farther than `3ν` from them, and their hull has
    /// a ball about `x` of radius `ρ/√n − 3ν`: for `ρ = 8ν` more than the `ν` that `x` is off the ray.
    ///
    /// Closest points may be computed from larger coordinates than theirs, such as the position of a body that contains
    /// the origin. So where two tests fail, the next ones take half of what a point seems to be outside for `ν`, as far
    /// as the ray should be four times `ρ` behind the plane there.
    fn latest_entry(
        &self,
        mut noise: V::Scalar,
        closest_point: &mut impl FnMut(V) -> Result<V, RayCastError>,
        iterations: &mut usize,
    ) -> Result<V::Scalar, RayCastError> {
        let number = V::Scalar::from_f64;
        let slope = self.normal.map(|n| -n.dot(self.local.line.direction)).filter(|&slope| slope > V::Scalar::ZERO);
        let slope = slope.unwrap_or(V::Scalar::ONE);
        // At once for a ray that begins in the set; from a plane on, where it is as far behind that as the points are
        // around it.
        let mut step = if self.normal.is_some() { noise * number(8.0) / slope } else { V::Scalar::ZERO };
        for _ in 0..PLACES_BEHIND {
            let mu = self.crossing + step;
            let x = if mu <= self.local.start { self.ray.source } else { self.at(mu) };
            noise = noise.max(self.noise(x, x));
            let around = noise * number(8.0);
            let mut is_around = true;
            for i in 0..2 * V::DIM {
                if *iterations >= self.options.max_iterations {
                    return Ok(Float::infinity());
                }
                *iterations += 1;
                let side = if i < V::DIM { around } else { -around };
                let y = x + V::axis(i % V::DIM) * (side * self.scale);
                // NaN is not in the set.
                let outside = (y - closest_point(y)?).norm() / self.scale;
                is_around = outside <= noise + noise;
                if !is_around {
                    noise = noise.max((outside * number(0.5)).min(step * slope * number(0.125)));
                    break;
                }
            }
            if is_around {
                let latest = self.local.lambda(mu) + self.local.error(mu, V::Scalar::ZERO);
                return Ok(if mu <= self.begin { self.least } else { latest.max(self.least) });
            }
            step = (step * number(4.0)).max(around);
        }
        Ok(Float::infinity())
    }

    /// The answer if x is in the set, to noise, and the ray at `upper` for certain.
    fn hit(&self, upper: V::Scalar, iterations: usize) -> RayCast<V> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let (lower, is_at_start) = (self.lower(), self.mu <= self.begin);
        let lambda = if is_at_start { self.least } else { self.local.lambda(self.crossing).max(self.least) };
        let point = if lambda > zero { self.at(self.crossing) } else { self.ray.source };
        let mut outcome = Outcome::Hit(RayHit { lambda, point, normal: self.normal });
        let upper = outcome.until(self.options.max_lambda, upper.max(lambda), |hit| hit.lambda);
        let lower = lower.min(lambda);
        let is_exhausted = iterations >= self.options.max_iterations;
        let status = if is_exhausted { Status::IterationLimit } else { Status::Stalled };
        let status = if upper < infinity { Status::Converged } else { status };
        RayCast { outcome, lower, upper, status, iterations }
    }

    /// The answer if the plane across `n` through x's closest point has the rest of the ray before it, or all of it.
    fn miss(&self, n: V) -> Outcome<RayHit<V>, V> {
        let direction = self.local.line.direction;
        // After a plane that the ray runs along, x is farther on than the planes are certain to prove, and only the
        // rest of the ray from x on need be before a later one. The first has all of the rest before it.
        let n = self.along.filter(|_| n.dot(direction) > V::Scalar::ZERO).unwrap_or(n);
        // Together with the plane before x, the axis has the whole ray before it: across the ray, both count.
        let slope = n.dot(direction);
        let last = self.normal.filter(|_| slope > V::Scalar::ZERO);
        let axis = last.and_then(|m| (m * slope - n * m.dot(direction)).unit()).unwrap_or(n);
        Outcome::Miss(Miss { axis })
    }
}
