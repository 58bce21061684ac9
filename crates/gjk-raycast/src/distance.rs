//! The distance of two shapes (the paper's Algorithm 2).

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::body::{Body, Pair, PointPair, power_of_two_near};
use crate::decrease::Decrease;
use crate::simplex::Simplex;
use crate::{Distance, DistanceOptions, Iterate, Status};

/// The distance of two shapes, and where they are closest.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, distance};
///
/// let table = Cuboid::new(DVec3::new(2.0, 0.1, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(0.5, 1.0, 0.0))?;
/// let answer = distance(&ball, &table, DistanceOptions::default());
/// assert!((answer.distance - 0.65).abs() < 1e-15);
/// assert!(answer.lower <= answer.distance && answer.distance <= answer.upper);
/// assert_eq!(answer.normal, Some(DVec3::Y)); // from the table to the ball
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn distance<A, B>(a: &A, b: &B, options: DistanceOptions<A::Vector>) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    distance_with(a, b, options, |_| {})
}

/// [`distance`], showing an observer every iterate.
pub fn distance_with<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let descent = descend(a, b, options, observer);
    let Descent { scale, radius, v, length, lower, simplex, .. } = descent;
    let overlap = descent.end == End::Overlap;
    let n = v / length;
    let (mut point_a, mut point_b) = (A::Vector::ZERO, A::Vector::ZERO);
    for (weight, PointPair { a, b }) in simplex.weighted() {
        point_a += a * weight;
        point_b += b * weight;
    }
    let (mut point_a, mut point_b) = (a.origin() + point_a * scale, b.origin() + point_b * scale);
    let zero = Scalar::ZERO;
    if length > zero && !overlap {
        point_a -= n * a.radius();
        point_b += n * b.radius();
    } else if length > zero {
        // The cores are apart by less than both radii: between them, a point in both.
        let part = (a.radius() / scale / radius).min(Scalar::ONE);
        if part.is_finite() {
            point_a -= v * (part * scale);
            point_b += v * ((<A::Vector as Vector>::Scalar::ONE - part) * scale);
        }
    }
    let noise = descent.noise;
    let gap = |l: <A::Vector as Vector>::Scalar| ((l - radius) * scale).max(zero);
    Distance {
        distance: if overlap { zero } else { gap(length) },
        lower: if overlap { zero } else { gap((lower - noise).min(length)) },
        upper: if overlap { gap(length + noise).min(noise * scale) } else { gap(length + noise) },
        overlap,
        point_a,
        point_b,
        normal: (!overlap && length > zero).then_some(n),
        status: match descent.end {
            End::Separated | End::Overlap => Status::Converged,
            End::IterationLimit => Status::IterationLimit,
            End::Stalled => Status::Stalled,
        },
        iterations: descent.iterations,
    }
}

/// How a descent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Separated,
    Overlap,
    IterationLimit,
    Stalled,
}

/// What a descent knows at its end; lengths in units of `scale`.
pub(crate) struct Descent<V: Vector> {
    pub(crate) scale: V::Scalar,
    pub(crate) radius: V::Scalar,
    /// The shortest vector from `b`'s core to `a`'s that was found, and its length.
    pub(crate) v: V,
    pub(crate) length: V::Scalar,
    /// The best lower bound on the distance of the cores, before rounding, and the unit axis that proves it.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    /// What rounding may have added to any bound.
    pub(crate) noise: V::Scalar,
    pub(crate) simplex: Simplex<V, PointPair<V>>,
    pub(crate) end: End,
    pub(crate) iterations: usize,
}

/// Algorithm 2 on the cores, until the distance is known to rounding, or known to exceed `options.limit`.
pub(crate) fn descend<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Descent<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let eps = <A::Vector as Vector>::Scalar::EPSILON;
    let number = <A::Vector as Vector>::Scalar::from_f64;

    let mut body = Pair::new(a, b);
    let origin = a.origin() - b.origin();
    let size = body.extent() + body.radius() + origin.norm();
    let scale = power_of_two_near(size);
    body.set_scale(scale);
    // Of A − B relative to its origin; zero lies at −offset.
    let offset = origin * scale.recip();
    let radius = body.radius() / scale;
    let limit = options.limit / scale + radius;
    let noise = number(8.0) * eps * (size / scale);

    let first = options.axis.and_then(Vector::unit).or_else(|| offset.unit()).unwrap_or_else(|| Vector::axis(0));
    let mut descent = Descent {
        scale,
        radius,
        v: first,
        length: <A::Vector as Vector>::Scalar::infinity(),
        lower: -<A::Vector as Vector>::Scalar::infinity(),
        axis: first,
        noise,
        simplex: Simplex::new(),
        end: End::IterationLimit,
        iterations: 0,
    };
    let mut n = first;
    let mut nearing = Decrease::new();
    while descent.iterations < options.max_iterations {
        let (point, witness) = body.support(-n);
        let w = point + offset;
        descent.iterations += 1;
        if !w.is_finite() {
            descent.end = End::Stalled;
            break;
        }
        // No point of A − B lies before w along n (the paper's bound ‖v‖² − v·w, divided by ‖v‖).
        let reach = n.dot(w);
        if reach > descent.lower {
            (descent.lower, descent.axis) = (reach, n);
        }
        let (length, lower) = (descent.length, descent.lower);
        observer(Iterate {
            iteration: descent.iterations - 1,
            simplex: descent.simplex.points(),
            v: descent.v,
            w,
            scale,
            lower: lower * scale,
            upper: length * scale,
        });
        if lower > limit + noise {
            descent.end = End::Separated;
            break;
        }
        if length - lower <= noise.max(options.tolerance * lower) {
            descent.end = if length - radius <= noise { End::Overlap } else { End::Separated };
            break;
        }
        let mut simplex = descent.simplex;
        if simplex.points().contains(&w) {
            descent.end = End::Stalled;
            break;
        }
        simplex.push(w, -n, witness);
        let Some(next) = options.sub_algorithm.closest(simplex.points(), A::Vector::DIM) else {
            descent.end = End::Stalled;
            break;
        };
        simplex.retain(next.face, next.weights);
        let next_length = next.v.norm();
        if !nearing.goes_on(next_length) {
            descent.end = End::Stalled;
            break;
        }
        descent.simplex = simplex;
        (descent.v, descent.length) = (next.v, next_length);
        // Certainly less than the radii, or no more than rounding: in contact.
        if next_length <= radius.max(noise) {
            descent.end = End::Overlap;
            break;
        }
        n = next.v / next_length;
    }
    if descent.end == End::Stalled && descent.length - radius <= noise {
        descent.end = End::Overlap;
    }
    descent
}
