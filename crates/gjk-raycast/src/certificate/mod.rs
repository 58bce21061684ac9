//! Proofs of the brackets of answers, for checkers that do not trust the solver (`docs/evidence.md`).
//!
//! A bracket has two ends, and a few numbers prove each. The lower end is proved by a plane that has all of the set `C`
//! behind it, where `C` is the target of a ray, or `A − B`. The upper end is proved by points of `C`, each given by a
//! direction along which it is farthest. Both are computed here after the answer, from the original shapes, so that a
//! query without a certificate takes no longer.

mod points;

use alloc::vec::Vec;

use convex_support::glam::DVec3;
use convex_support::{Core, Hint, Scalar, SupportMap, Vector};

use self::points::{Seen, points, wide};
use crate::{Distance, GrowthDistance, Intersection, LinearCast, Motion, Outcome, Ray, RayCast};
pub use points::WeightedSupport;

/// The proof of a bracket: a plane for its lower end, support points for its upper end.
///
/// Let `C` be the target of a ray, or `A − B` for two shapes, and let `K ⊕ B(r)` be its [core](convex_support::Core)
/// and radius.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Certificate<V: Vector> {
    /// A normal of a plane that has the target behind it, and the start of the ray, or all of the ray, before it. For
    /// two shapes the normal points from `b` to `a`, and the plane has `b` behind it and `a` before it. `None` if the
    /// answer claims no lower bound.
    pub plane: Option<V>,
    /// Points of the core `K`, at most one more than there are dimensions. Their weighted mean is the closest point
    /// found, or the point where the ray enters. The weights are not negative, and their sum is 1 to rounding. Empty if
    /// the answer claims no upper bound.
    pub points: Vec<WeightedSupport<V>>,
}

impl<V: Vector> Certificate<V> {
    fn of_plane(plane: Option<V>) -> Self {
        Self { plane, points: Vec::new() }
    }
}

/// The certificate of a [`distance`](crate::distance).
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, distance, distance_certificate};
///
/// let table = Cuboid::new(DVec3::new(2.0, 0.1, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(0.5, 1.0, 0.0))?;
/// let answer = distance(&ball, &table, DistanceOptions::default());
/// let certificate = distance_certificate(&ball, &table, &answer);
/// assert_eq!(certificate.plane, Some(DVec3::Y));
/// assert!(certificate.points.len() <= 4);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[must_use]
pub fn distance_certificate<A, B>(a: &A, b: &B, answer: &Distance<A::Vector>) -> Certificate<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let plane = answer.normal.filter(|_| answer.lower > Scalar::ZERO);
    Certificate { plane, points: points_of_pair(a, b, DVec3::ZERO, answer.normal, None) }
}

/// The certificate of [`intersects`](crate::intersects): a plane if the shapes are apart, and points if they overlap.
#[must_use]
pub fn intersection_certificate<A, B>(a: &A, b: &B, answer: &Intersection<A::Vector>) -> Certificate<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let points = if answer.overlap { points_of_pair(a, b, DVec3::ZERO, None, None) } else { Vec::new() };
    Certificate { plane: answer.axis, points }
}

/// The certificate of a [`ray_cast`](crate::ray_cast).
///
/// ```
/// use convex_support::{Cuboid, glam::DVec2};
/// use gjk_raycast::{Ray, RayCastOptions, ray_cast, ray_cast_certificate};
///
/// let target = Cuboid::new(DVec2::ONE)?;
/// let ray = Ray { source: DVec2::new(-5.0, 0.5), direction: DVec2::X };
/// let answer = ray_cast(&target, ray, RayCastOptions::default())?;
/// // The edge that the ray pierces, by its two corners.
/// let certificate = ray_cast_certificate(&target, ray, &answer);
/// assert_eq!(certificate.plane, Some(DVec2::NEG_X));
/// let weights: Vec<f64> = certificate.points.iter().map(|p| p.weight).collect();
/// assert!(weights == [0.25, 0.75] || weights == [0.75, 0.25]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn ray_cast_certificate<S: SupportMap + ?Sized>(
    target: &S,
    ray: Ray<S::Vector>,
    answer: &RayCast<S::Vector>,
) -> Certificate<S::Vector> {
    let hit = match answer.outcome {
        Outcome::Hit(hit) => hit,
        Outcome::Miss(miss) => return Certificate::of_plane(Some(leaning(miss.axis, wide(ray.direction)))),
        Outcome::Undecided => return Certificate::of_plane(None),
    };
    let core = target.core();
    let at = wide(ray.source) - wide(core.origin) + wide(ray.direction) * hit.lambda.as_f64();
    let mut hint = Hint::new();
    let mut support = |d: S::Vector| {
        hint.rewind();
        wide(target.core_support(d, &mut hint)) - at
    };
    let (radius, extent) = (core.radius.as_f64(), core.extent.as_f64());
    let size = radius + extent + at.abs().max_element();
    let seen = Seen { radius, size, normal: hit.normal.map(wide), along: Some(wide(ray.direction)) };
    Certificate { plane: hit.normal, points: points(&mut support, &seen) }
}

/// The certificate of a [`linear_cast`](crate::linear_cast).
#[must_use]
pub fn linear_cast_certificate<A, B>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    answer: &LinearCast<A::Vector>,
) -> Certificate<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let along = wide(motion.velocity_b) - wide(motion.velocity_a);
    let hit = match answer.outcome {
        Outcome::Hit(hit) => hit,
        Outcome::Miss(miss) => return Certificate::of_plane(Some(leaning(miss.axis, -along))),
        Outcome::Undecided => return Certificate::of_plane(None),
    };
    let points = points_of_pair(a, b, along * hit.time.as_f64(), hit.normal, Some(along));
    Certificate { plane: hit.normal, points }
}

/// The certificate of a [`growth_distance`](crate::growth_distance()) about these centres, `c_A` and `c_B`.
///
/// With `d = c_B − c_A` the line from zero along `d` leaves `(A − c_A) − (B − c_B)`, which is `A − B` moved by `d`,
/// where it is `d/s` for the scale `s`. The points are about that place of it. There are none if the scale is 0, or not
/// known.
#[must_use]
pub fn growth_distance_certificate<A, B>(
    a: &A,
    center_a: A::Vector,
    b: &B,
    center_b: A::Vector,
    answer: &GrowthDistance<A::Vector>,
) -> Certificate<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let Some(normal) = answer.normal else { return Certificate::of_plane(None) };
    let along = wide(center_b) - wide(center_a);
    let at = along * (answer.scale.as_f64().recip() - 1.0);
    Certificate { plane: Some(normal), points: points_of_pair(a, b, at, Some(normal), Some(along)) }
}

/// The axis of a miss, tilted along the ray if it is across the ray to rounding: the normal of a plane before all of
/// an endless ray.
fn leaning<V: Vector>(axis: V, direction: DVec3) -> V {
    let (Some(n), Some(d)) = (wide(axis).try_normalize(), direction.try_normalize()) else { return axis };
    let rounding = V::Scalar::EPSILON.as_f64();
    if n.dot(d).abs() > 4.0 * rounding {
        return axis;
    }
    let leant = n + d * (8.0 * rounding);
    V::from_fn(|i| V::Scalar::from_f64(leant[i]))
}

/// The points of `A − B` about the point `at`; the normal points from `b` to `a`, which is into the difference.
fn points_of_pair<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    at: DVec3,
    normal: Option<A::Vector>,
    along: Option<DVec3>,
) -> Vec<WeightedSupport<A::Vector>> {
    let (core_a, core_b) = (a.core(), b.core());
    let offset = wide(core_a.origin) - wide(core_b.origin) - at;
    let (mut hint_a, mut hint_b) = (Hint::new(), Hint::new());
    let mut support = |d: A::Vector| {
        hint_a.rewind();
        hint_b.rewind();
        wide(a.core_support(d, &mut hint_a)) - wide(b.core_support(-d, &mut hint_b)) + offset
    };
    let size = |core: Core<A::Vector>| core.extent.as_f64() + core.radius.as_f64();
    let seen = Seen {
        radius: core_a.radius.as_f64() + core_b.radius.as_f64(),
        size: size(core_a) + size(core_b) + offset.abs().max_element(),
        normal: normal.map(|n| -wide(n)),
        along,
    };
    points(&mut support, &seen)
}
