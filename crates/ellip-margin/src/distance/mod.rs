//! The Euclidean distance of two ellipsoids, from the margin and certified.
//!
//! For a direction n from E₁ to E₂, with r = x₂ − x₁ and Sₖ = Rₖ·diag(aₖ)²·Rₖᵀ, the support points
//!
//! > p₁ = x₁ + S₁n/h₁, p₂ = x₂ − S₂n/h₂, hₖ = √(nᵀSₖn)
//!
//! are points of the bodies, and the slab between their tangent planes has the width f(n) = n·r − h₁ − h₂ = n·(p₂ − p₁)
//! for a unit n. Hence, for *any* n,
//!
//! > f(n) ≤ distance ≤ ‖p₂ − p₁‖,
//!
//! with equality where p₂ − p₁ is along n. The margin's normal at x* gives a first bracket: f is `r(r − 1)/‖Pw‖` there,
//! and p₂ = x*. It is closed in two stages: [`multipliers`] finds the direction of the distance by two numbers, however
//! thin the bodies are, and [`Slab::ascend`] its last digits.

mod bracket;
mod multipliers;
mod slab;

use convex_support::{Ellipsoid, Scalar, Vector};

pub use self::bracket::DistanceBracket;
use self::slab::Slab;
use crate::margin::solve;
use crate::numerics::{add, store, unit};
use crate::pair::Pair;
use crate::polynomial;
use crate::secular::Solution;
use crate::{MarginOptions, Status};

/// The Euclidean distance of two ellipsoids; see [`distance`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distance<V: Vector> {
    /// The distance; 0 where they overlap.
    pub distance: V::Scalar,
    /// The bounds, with the closest points.
    pub bracket: DistanceBracket<V>,
    /// How the iteration ended. The bracket holds in any case.
    pub status: Status,
    /// The steps it took, after those for the margin.
    pub iterations: usize,
}

/// Bounds on the Euclidean distance from the two margins, of `e1` about `e2` and the other way round: no further
/// iteration.
///
/// The lower bound is the better of the two, and so is the upper, whose points are given. On ordinary shapes they are
/// within a few per cent of the distance.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, distance, distance_bracket};
///
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 0.5), Default::default())?;
/// let obstacle =
///     Ellipsoid::new(DVec3::new(3.0, 2.0, 1.0), DVec3::new(0.5, 0.5, 1.0), Default::default())?;
/// let bracket = distance_bracket(&link, &obstacle, MarginOptions::default());
/// let exact = distance(&link, &obstacle, MarginOptions::default()).distance;
/// assert!(bracket.lower <= exact && exact <= bracket.upper);
/// assert!(bracket.upper - bracket.lower < 0.1 * exact);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn distance_bracket<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> DistanceBracket<V> {
    in_dimension!(bracket_in::<V>(e1, e2, options))
}

fn bracket_in<V: Vector, const N: usize>(
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
    options: MarginOptions,
) -> DistanceBracket<V> {
    let (there, length) = Pair::<N>::new(e1, e2).in_own_unit();
    let back = there.swapped();
    let first = solve(&there, 0.0, options, |_, _| {});
    let Some(slab) = Slab::of_margin(&there, &first, options) else { return overlapping(&there, &first, length) };
    let second = solve(&back, 0.0, options, |_, _| {});
    // The slab of the other margin runs from E₂ to E₁.
    let other = Slab::of_margin(&back, &second, options).map(|s| Slab::new(&there, s.n.map(|x| -x)));
    let best = |a: Slab<N>, b: Option<Slab<N>>, better: fn(&Slab<N>, &Slab<N>) -> bool| match b {
        Some(b) if better(&b, &a) => b,
        _ => a,
    };
    let low = best(slab, other, |a, b| a.width > b.width);
    let high = best(slab, other, |a, b| a.length() < b.length());
    let bracket = |slab: Slab<N>| slab.bracket::<V>(&there, slab.exact_width(&there), length);
    DistanceBracket { lower: bracket(low).lower, normal: store(low.n), ..bracket(high) }
}

/// The Euclidean distance between `e1` and `e2` with its closest points, certified: the bracket is the width of a
/// separating slab and the distance of two points, and narrows to about 1e-12 of the distance (1e-7 in `f32`).
///
/// If the bodies overlap, which the sign of the margin decides, it is 0; it may also be 0 if they are apart by less
/// than the rounding of their coordinates.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, distance};
///
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
/// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
/// let d = distance(&link, &obstacle, MarginOptions::default());
/// assert!((d.distance - 3.0).abs() < 1e-14);
/// assert!(d.bracket.lower <= d.distance && d.distance <= d.bracket.upper);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn distance<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Distance<V> {
    in_dimension!(distance_in::<V>(e1, e2, options))
}

fn distance_in<V: Vector, const N: usize>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Distance<V> {
    let (pair, length) = Pair::<N>::new(e1, e2).in_own_unit();
    // A slab that separates the bodies proves them disjoint, however its normal was found.
    let rough = polynomial::rough(&pair).and_then(|y| Slab::across(&pair, y)).filter(|slab| slab.is_wide(&pair));
    let mut slab = match rough {
        Some(slab) => slab,
        None => {
            let margin = solve(&pair, 0.0, options, |_, _| {});
            let Some(slab) = Slab::of_margin(&pair, &margin, options) else {
                let bracket = overlapping(&pair, &margin, length);
                return Distance { distance: V::Scalar::ZERO, bracket, status: margin.status, iterations: 0 };
            };
            slab
        }
    };
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    if slab.width > 0.0 && slab.tangent_squared() > 2.0 * options.tolerance() {
        let beta = slab.h.map(|h| h * slab.width);
        // An eighth of the steps is left for the slab to close by itself, if this iteration ends before it converges.
        let most = options.max_iterations - options.max_iterations / 8;
        if let Some((d, steps)) = multipliers::closest(&pair, beta, most) {
            iterations += steps;
            let next = Slab::new(&pair, unit(d));
            slab = if next.width > slab.width { next } else { slab };
        }
    }
    loop {
        if slab.tangent_squared() <= 2.0 * options.tolerance() {
            status = Status::Converged;
            break;
        }
        if iterations >= options.max_iterations {
            break;
        }
        iterations += 1;
        match slab.ascend(&pair) {
            Some(next) => slab = next,
            None => {
                // No step widens the slab by more than rounding.
                status = if slab.tangent_squared() < 1e-12 { Status::Converged } else { Status::Stalled };
                break;
            }
        }
    }
    let width = slab.exact_width(&pair);
    let distance = V::Scalar::from_f64(width.max(0.0) * length);
    Distance { distance, bracket: slab.bracket(&pair, width, length), status, iterations }
}

/// The bracket of two bodies with a common point.
fn overlapping<V: Vector, const N: usize>(pair: &Pair<N>, solution: &Solution<N>, unit: f64) -> DistanceBracket<V> {
    let point = if solution.nu > 0.0 { add(pair.x2, pair.out_of_ball(solution.y)) } else { pair.x1 };
    let point = store(point.map(|x| x * unit));
    DistanceBracket { lower: V::Scalar::ZERO, upper: V::Scalar::ZERO, point1: point, point2: point, normal: V::ZERO }
}
