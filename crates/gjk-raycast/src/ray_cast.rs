//! Where a ray enters a shape (the paper's Algorithm 3).

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::body::{Body, Single, power_of_two_near};
use crate::closest::closest;
use crate::entry::{Line, entry};
use crate::error::RayCastError;
use crate::simplex::Simplex;
use crate::{Iterate, Miss, Outcome, RayCast, RayCastOptions, RayHit, Status};

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
    check_finite("source", ray.source)?;
    check_finite("direction", ray.direction)?;
    if ray.direction == S::Vector::ZERO {
        return Err(RayCastError::ZeroDirection);
    }
    let mut body = Single::new(target);
    let local = Ray { source: ray.source - body.origin(), direction: ray.direction };
    let cast = cast(&mut body, local, options, observer);
    let outcome = match cast.outcome {
        Outcome::Hit(Contact { lambda, normal, .. }) => Outcome::Hit(RayHit { lambda, point: ray.at(lambda), normal }),
        Outcome::Miss(miss) => Outcome::Miss(miss),
        Outcome::Undecided => Outcome::Undecided,
    };
    Ok(RayCast { outcome, lower: cast.lower, upper: cast.upper, status: cast.status, iterations: cast.iterations })
}

pub(crate) fn check_finite<V: Vector>(parameter: &'static str, vector: V) -> Result<(), RayCastError> {
    match (0..V::DIM).find(|&i| !vector.get(i).is_finite()) {
        Some(index) => Err(RayCastError::NonFinite { parameter, index }),
        None => Ok(()),
    }
}

/// A hit, as the core of the method knows it.
pub(crate) struct Contact<V: Vector, W> {
    pub(crate) lambda: V::Scalar,
    pub(crate) normal: Option<V>,
    /// The points of the core whose weighted sum lies below the hit spot.
    pub(crate) simplex: Simplex<V, W>,
}

/// What [`cast`] found; λ in units of the ray's direction.
pub(crate) struct Cast<V: Vector, W> {
    pub(crate) outcome: Outcome<Contact<V, W>, V>,
    pub(crate) lower: V::Scalar,
    pub(crate) upper: V::Scalar,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    pub(crate) scale: V::Scalar,
}

/// Algorithm 3 on the core, for a ray relative to the body's origin.
pub(crate) fn cast<B: Body>(
    body: &mut B,
    ray: Ray<B::Vector>,
    options: RayCastOptions<B::Vector>,
    mut observer: impl FnMut(Iterate<'_, B::Vector>),
) -> Cast<B::Vector, B::Witness> {
    type Scal<B> = <<B as Body>::Vector as Vector>::Scalar;
    let number = Scal::<B>::from_f64;
    let (zero, infinity, eps) = (Scal::<B>::ZERO, Scal::<B>::infinity(), Scal::<B>::EPSILON);

    let bound = body.extent() + body.radius();
    let scale = power_of_two_near(if bound > zero { bound } else { ray.source.norm() });
    body.set_scale(scale);
    let (bound, radius, source) = (bound / scale, body.radius() / scale, ray.source * scale.recip());
    let noise = number(8.0) * eps * bound;

    // The line is based at its point closest to the body's origin; the source is at μ_s, the ray's end at μ_e.
    let speed = ray.direction.norm();
    let direction = ray.direction.unit().unwrap_or_else(|| Vector::axis(0));
    let mut source_mu = source.dot(direction);
    let mut foot = source - direction * source_mu;
    let rest = foot.dot(direction);
    foot -= direction * rest;
    source_mu += rest;
    let line = Line { foot, direction };
    let lambda_of = |mu: Scal<B>| (mu - source_mu) * (scale / speed);
    let end_mu = source_mu + options.max_lambda * (speed / scale);

    let mut cast = Cast {
        outcome: Outcome::Undecided,
        lower: zero,
        upper: infinity,
        status: Status::Converged,
        iterations: 0,
        scale,
    };
    // Outside the ball about the origin that contains the body there is nothing to hit.
    let reach = bound * (Scal::<B>::ONE + number(16.0) * eps);
    let half_chord = (reach * reach - foot.length_squared()).max(zero).sqrt();
    if foot.norm() > reach {
        cast.outcome = Outcome::Miss(Miss { axis: foot.unit().unwrap_or(direction) });
        cast.lower = infinity;
        return cast;
    }
    if source_mu > half_chord {
        cast.outcome = Outcome::Miss(Miss { axis: direction });
        cast.lower = infinity;
        return cast;
    }
    let mut low = source_mu.max(-half_chord);
    let mut high = infinity;
    let mut x = line.at(low);
    let mut simplex = Simplex::new();
    let mut normal = None;
    let mut at_entry = false;
    let mut v = options.axis.and_then(Vector::unit).or_else(|| x.unit()).unwrap_or(-direction);
    let mut n = v;
    cast.status = Status::IterationLimit;
    if low > end_mu {
        cast.outcome = Outcome::Miss(Miss { axis: -direction });
        cast.status = Status::Converged;
        cast.lower = lambda_of(low);
        return cast;
    }

    while cast.iterations < options.max_iterations {
        let (point, witness) = body.support(n);
        cast.iterations += 1;
        let w = x - point;
        observer(Iterate {
            iteration: cast.iterations - 1,
            simplex: &[],
            v,
            w,
            scale,
            lower: lambda_of(low),
            upper: lambda_of(high),
        });
        // The plane n·y = n·point + radius has the whole body behind it.
        let ahead = n.dot(w) - radius;
        let slope = n.dot(direction);
        if ahead > zero {
            if slope >= zero {
                if ahead > noise {
                    cast.outcome = Outcome::Miss(Miss { axis: n });
                    cast.status = Status::Converged;
                    cast.lower = infinity;
                    break;
                }
            } else {
                let next = low - ahead / slope;
                if next > half_chord + noise || next > end_mu + noise {
                    cast.outcome = Outcome::Miss(Miss { axis: n });
                    cast.status = Status::Converged;
                    cast.lower = if next > half_chord + noise { infinity } else { lambda_of(next) };
                    break;
                }
                low = next;
                x = line.at(low);
                normal = Some(n);
            }
        }
        let repeated = simplex.points().contains(&point);
        if at_entry && (repeated || (high - low) * -slope <= noise.max(options.tolerance * bound)) {
            cast.status = if repeated && (high - low) * -slope > number(16.0) * noise {
                Status::Stalled
            } else {
                Status::Converged
            };
            break;
        }
        if !point.is_finite() {
            cast.status = Status::Stalled;
            break;
        }
        if !repeated {
            simplex.push(point, witness);
            let found = entry(simplex.points(), line, radius);
            if let Some(found) = found.filter(|found| found.mu >= low - noise) {
                simplex.retain(found.weights);
                high = found.mu.min(high).max(low);
                (n, v) = (found.n, found.n);
                at_entry = true;
                continue;
            }
            if at_entry {
                // Points of the body on both sides of the lower bound: it is in the body itself, as the source may be.
                cast.status = if found.is_some() { Status::Converged } else { Status::Stalled };
                high = if found.is_some() { low } else { high };
                break;
            }
        }
        // The point of {x} − core closest to zero.
        let mut seen = [B::Vector::ZERO; crate::simplex::MAX_POINTS];
        for (s, p) in seen.iter_mut().zip(simplex.points()) {
            *s = x - *p;
        }
        let Some(next) = closest(&seen[..simplex.points().len()]) else {
            cast.status = Status::Stalled;
            break;
        };
        simplex.retain(next.weights);
        let length = if next.contains { zero } else { next.v.norm() };
        if length <= radius.max(noise) || length - radius <= noise {
            // x is in the body, or no farther from it than rounding.
            high = low;
            cast.status = Status::Converged;
            break;
        }
        if repeated && next.v == v {
            cast.status = Status::Stalled;
            break;
        }
        v = next.v;
        n = v / length;
    }

    if cast.outcome.is_miss() {
        return cast;
    }
    cast.lower = lambda_of(low).max(zero);
    cast.upper = lambda_of(high).max(cast.lower);
    if cast.status == Status::Converged || (at_entry && cast.upper <= options.max_lambda) {
        let inside = low <= source_mu;
        let lambda = if inside { zero } else { cast.lower };
        if lambda > options.max_lambda {
            cast.outcome = Outcome::Miss(Miss { axis: n });
        } else {
            cast.outcome = Outcome::Hit(Contact {
                lambda,
                normal: if inside { None } else { Some(normal.unwrap_or(n)) },
                simplex,
            });
        }
    }
    cast
}
