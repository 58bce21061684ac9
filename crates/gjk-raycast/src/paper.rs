//! Algorithms 1 to 3 as the paper prints them, to be read beside it, taught, and compared with.
//!
//! The names are the paper's: the ray is `s + λ·r`, `C` is the convex object, `v` the point of a simplex closest to
//! zero, `w` and `p` the newest support points, `W` and `P` the points that are kept. The arithmetic is plain: no
//! frame, no bounds, no closed forms. For answers that are certain, ask [`distance`](crate::distance()),
//! [`ray_cast`](crate::ray_cast()) and [`iterative_ray_cast`](crate::iterative_ray_cast()), which add to these lines:
//!
//! - *to all*: coordinates relative to a point near both bodies, in a unit of their size, so that far bodies lose
//!   nothing; bounds on rounding, and with them a bracket that holds; closed forms for shapes that know theirs;
//! - *to Algorithm 1*: points about the ray that prove it to be inside;
//! - *to Algorithm 2*: a direction turned by the curvature of smooth bodies (Newton's method), or towards the best
//!   plane so far (a level bundle step), where the shortest vector alone converges linearly; and a closer measurement
//!   where the two bodies are apart by little more than rounding;
//! - *to Algorithm 3*: the same turned directions, the search for a [portal](crate::CastMethod::Portal), which is the
//!   default, and a decision about rays that begin within rounding of the body.
//!
//! ```
//! use convex_support::{Ball, glam::DVec3};
//! use gjk_raycast::{Ray, SubAlgorithm, paper};
//!
//! let ray = Ray { source: DVec3::new(-3.0, 0.1, 0.0), direction: DVec3::X };
//! let mut lambdas = Vec::new();
//! let cast = paper::gjk_ray_cast(&Ball::new(1.0)?, ray, 1e-12, 100, &SubAlgorithm::Johnson, |seen| {
//!     lambdas.push(seen.lower);
//! });
//! assert_eq!(cast.hit, Some(true));
//! assert!((cast.lambda - (3.0 - 0.99_f64.sqrt())).abs() < 1e-5, "{cast:?}");
//! assert!(lambdas.is_sorted());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use crate::simplex::MAX_POINTS;
use crate::{Iterate, Ray, SubAlgorithm};

/// What Algorithm 1 or 3 returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedCast<V: Vector> {
    /// What the algorithm returns: true for a hit; `None` if the iterations were used up, or if a number is not finite
    /// or the sub-algorithm found no face, before it returned anything.
    pub hit: Option<bool>,
    /// The hit parameter, or the last lower bound on it.
    pub lambda: V::Scalar,
    /// The point of the ray there.
    pub x: V,
    /// The normal at `x`, of any length; zero if the ray begins in the object.
    pub n: V,
    /// How often the loop was run.
    pub iterations: usize,
}

/// What Algorithm 2 returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedDistance<V: Vector> {
    /// The point of `A − B` closest to zero, to the tolerance; its length is the distance.
    pub v: V,
    /// How often the loop was run.
    pub iterations: usize,
    /// Whether the condition of the loop ended it.
    pub is_close_enough: bool,
}

/// The point of a simplex closest to zero, and of which of its points it is a combination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimplexPoint<V: Vector> {
    /// The point.
    pub v: V,
    /// The weight of each point of the simplex, in order; those of weight zero are discarded.
    pub weights: [V::Scalar; MAX_POINTS],
}

/// Finds the point of a simplex closest to zero: Johnson's, by [`SubAlgorithm`], or one of your own.
pub trait SubDistance<V: Vector> {
    /// The point closest to zero of the hull of one point to [`DIM`](Vector::DIM)` + 1` points, or `None` if none was
    /// found.
    fn closest(&self, points: &[V]) -> Option<SimplexPoint<V>>;
}

impl<V: Vector> SubDistance<V> for SubAlgorithm {
    fn closest(&self, points: &[V]) -> Option<SimplexPoint<V>> {
        let found = Self::closest(*self, points, V::DIM)?;
        let mut weights = [V::Scalar::ZERO; MAX_POINTS];
        let corners = (0..points.len()).filter(|&i| found.face.has(i));
        corners.zip(found.weights).for_each(|(i, weight)| weights[i] = weight);
        Some(SimplexPoint { v: found.v, weights })
    }
}

/// Algorithm 1: the ray cast by `c(x)`, the point of `C` closest to `x`, until `x` is within `tolerance` of it.
pub fn iterative_ray_cast<V: Vector>(
    mut c: impl FnMut(V) -> V,
    ray: Ray<V>,
    tolerance: V::Scalar,
    max_iterations: usize,
) -> PrintedCast<V> {
    let Ray { source: s, direction: r } = ray;
    let mut cast = PrintedCast { hit: None, lambda: Scalar::ZERO, x: s, n: V::ZERO, iterations: 0 };
    while cast.iterations < max_iterations {
        let n = cast.x - c(cast.x);
        if n.length_squared() <= tolerance * tolerance {
            cast.hit = Some(true);
            break;
        }
        cast.iterations += 1;
        cast.n = n;
        if n.dot(r) >= Scalar::ZERO {
            cast.hit = Some(false);
            break;
        }
        cast.lambda -= n.length_squared() / n.dot(r);
        cast.x = s + r * cast.lambda;
    }
    cast
}

/// Algorithm 2: the distance of zero from `A − B`, until `‖v‖² − v·w ≤ ε²`, with `tolerance` for ε.
///
/// The observer sees each `v` and its `w`, the bounds of the distance that they are, and the points of `W`.
pub fn gjk_distance<V: Vector>(
    difference: &impl SupportMap<Vector = V>,
    tolerance: V::Scalar,
    max_iterations: usize,
    sub_algorithm: &impl SubDistance<V>,
    mut observer: impl FnMut(Iterate<'_, V>),
) -> PrintedDistance<V> {
    let mut kept = Points::new();
    let mut v = difference.support(V::axis(0));
    let mut found = PrintedDistance { v, iterations: 0, is_close_enough: false };
    while found.iterations < max_iterations {
        let w = difference.support(-v);
        let (upper, iteration) = (v.norm(), found.iterations);
        let lower = if upper > Scalar::ZERO { v.dot(w) / upper } else { Scalar::ZERO };
        observer(Iterate { iteration, simplex: &kept, v, w, scale: Scalar::ONE, lower, upper });
        found.is_close_enough = v.length_squared() - v.dot(w) <= tolerance * tolerance;
        if found.is_close_enough {
            break;
        }
        found.iterations += 1;
        add(&mut kept, w);
        let Some(closest) = sub_algorithm.closest(&kept) else { break };
        v = closest.v;
        discard(&mut kept, &closest);
        found.v = v;
    }
    found
}

/// Algorithm 3: the ray cast by a support mapping, until `‖v‖² ≤ ε·max{‖x − p‖²: p ∈ P}`, with `tolerance` for ε, which
/// has to be greater than the machine's.
///
/// The observer sees each `v` with its `w`, the λ so far as a lower bound, and the points `x − p` of `P`.
pub fn gjk_ray_cast<V: Vector>(
    object: &impl SupportMap<Vector = V>,
    ray: Ray<V>,
    tolerance: V::Scalar,
    max_iterations: usize,
    sub_algorithm: &impl SubDistance<V>,
    mut observer: impl FnMut(Iterate<'_, V>),
) -> PrintedCast<V> {
    let Ray { source: s, direction: r } = ray;
    let mut cast = PrintedCast { hit: None, lambda: Scalar::ZERO, x: s, n: V::ZERO, iterations: 0 };
    let mut kept = Points::new();
    let mut v = s - object.support(V::axis(0));
    // The first test has no points to compare with: only zero itself is close enough.
    let mut farthest = V::Scalar::ZERO;
    while cast.iterations < max_iterations {
        if v.length_squared() <= tolerance * farthest {
            cast.hit = Some(true);
            break;
        }
        let p = object.support(v);
        let w = cast.x - p;
        let seen = seen_from(&kept, cast.x);
        let (iteration, lower, upper) = (cast.iterations, cast.lambda, V::Scalar::infinity());
        observer(Iterate { iteration, simplex: &seen, v, w, scale: Scalar::ONE, lower, upper });
        cast.iterations += 1;
        if v.dot(w) > Scalar::ZERO {
            if v.dot(r) >= Scalar::ZERO {
                cast.hit = Some(false);
                break;
            }
            cast.lambda -= v.dot(w) / v.dot(r);
            cast.x = s + r * cast.lambda;
            cast.n = v;
        }
        add(&mut kept, p);
        let seen = seen_from(&kept, cast.x);
        let Some(closest) = sub_algorithm.closest(&seen) else { break };
        v = closest.v;
        farthest = seen.iter().fold(Scalar::ZERO, |most, y| y.length_squared().max(most));
        discard(&mut kept, &closest);
    }
    cast
}

/// The points that are kept, at most as many as a simplex has.
type Points<V> = SmallVec<[V; MAX_POINTS]>;

/// Adds a point. A set that is full contains zero, as its `v` says, and then no loop comes here; one that rounding
/// keeps full loses its oldest point.
fn add<V: Vector>(kept: &mut Points<V>, point: V) {
    if kept.len() > V::DIM {
        kept.remove(0);
    }
    kept.push(point);
}

/// Keeps the points with weight.
fn discard<V: Vector>(kept: &mut Points<V>, closest: &SimplexPoint<V>) {
    let mut weights = closest.weights.into_iter();
    kept.retain(|_| weights.next().is_some_and(|weight| weight > Scalar::ZERO));
}

/// The vectors from the points to `x`.
fn seen_from<V: Vector>(kept: &Points<V>, x: V) -> Points<V> {
    kept.iter().map(|&p| x - p).collect()
}
