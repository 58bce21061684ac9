//! The free margin of two ellipsoids.

use convex_support::{Ellipsoid, Scalar, Vector};

use crate::numerics::{add, store};
use crate::pair::Pair;
use crate::polynomial::{self, Quick};
use crate::secular::{self, Solution};
use crate::{MarginOptions, Method, Status};

/// The free margin of E₁ about E₂; see [`free_margin`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct Margin<V: Vector> {
    /// m = min (x − x₁)ᵀP(x − x₁) − 1 over x in E₂, in [−1, ∞): positive where the ellipsoids are disjoint, 0 where
    /// they touch, negative where they overlap, −1 where x₁ lies in E₂. Grown by the factor √(1 + m), E₁ just touches
    /// E₂.
    pub margin: V::Scalar,
    /// The multiplier ν ≥ 0 of the constraint x ∈ E₂: 0 if x₁ lies in E₂, and otherwise minus the minimal eigenvalue λ*
    /// of the paper's 2N×2N matrix.
    pub nu: V::Scalar,
    /// The minimiser x*: the point of E₂ where the grown E₁ touches it; x₁ if x₁ lies in E₂.
    pub point: V,
    /// How the iteration for ν ended.
    pub status: Status,
    /// The steps it took; 0 if x₁ lies in E₂.
    pub iterations: usize,
    /// x* in the frame of E₂: diag(a₂)⁻¹R₂ᵀ(x* − x₂), a unit vector unless x₁ lies in E₂. Kept because gradients from
    /// differences of `point` would lose digits far from the origin.
    pub(crate) ball_point: V,
}

/// The free margin of `e1` about `e2` (Rimon and Boyd, Section 3): how far `e1` is from `e2`, measured in the norm in
/// which `e1` is the unit ball.
///
/// m = min { (x − x₁)ᵀP(x − x₁) : x ∈ E₂ } − 1. It is not symmetric, but its sign is: positive means disjoint, 0
/// touching, negative overlapping. As a function of the bodies it is continuously differentiable everywhere (see
/// [`EllipsoidPair::margin`](crate::EllipsoidPair::margin)) and analytic except where x₁ crosses the boundary of E₂,
/// where m reaches −1, its least value, with gradient zero.
///
/// The secular equation is solved from the semi-axes and axes; no matrix is formed whose condition is the square of an
/// aspect ratio. The margin is that of the bodies as stored to about 12 digits and better, up to a condition of 1e14
/// (an aspect of 1e7 each) and at any scale; near contact too, so that its sign can be trusted down to the rounding of
/// the bodies themselves.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, free_margin};
///
/// // Two balls of radius 2 and 1, their centres 6 apart: the first touches when grown to radius 5.
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
/// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
/// let m = free_margin(&link, &obstacle, MarginOptions::default());
/// assert!((m.margin - 5.25).abs() < 1e-14); // (5/2)² − 1
/// assert!(m.point.abs_diff_eq(DVec3::new(5.0, 0.0, 0.0), 1e-14));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
#[doc = include_str!("../doc/margin.svg")]
#[inline]
pub fn free_margin<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Margin<V> {
    free_margin_with(e1, e2, options, |_, _| {})
}

/// [`free_margin`] with an observer: `observer(ν, φ)` sees every iterate ν with φ(ν) = ‖y(ν)‖, which is 1 at the
/// solution and greater before it.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, free_margin_with};
///
/// let e1 = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 1.0), 0.3)?;
/// let e2 = Ellipsoid::new(DVec2::new(4.0, 1.0), DVec2::new(1.0, 0.2), -0.8)?;
/// let mut last = f64::INFINITY;
/// let m = free_margin_with(&e1, &e2, MarginOptions::default(), |_nu, phi| last = phi);
/// assert!((last - 1.0).abs() < 1e-6 && m.margin > 0.0);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn free_margin_with<V: Vector>(
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
    options: MarginOptions,
    observer: impl FnMut(f64, f64),
) -> Margin<V> {
    #[inline]
    fn once<V: Vector, const N: usize>(
        e1: &Ellipsoid<V>,
        e2: &Ellipsoid<V>,
        options: MarginOptions,
        observer: impl FnMut(f64, f64),
    ) -> Margin<V> {
        let pair = Pair::<N>::new(e1, e2);
        answer(&pair, solve(&pair, 0.0, options, observer))
    }
    in_dimension!(once::<V>(e1, e2, options, observer))
}

/// The solution by the polynomial, refined if rounding could show in its margin, or by the singular basis if the
/// polynomial would lose digits; from `start`, 0 for none known.
///
/// The rare ways take the pair by value, so that the pair of the common way can stay in registers.
#[inline]
pub(crate) fn solve<const N: usize>(
    pair: &Pair<N>,
    start: f64,
    options: MarginOptions,
    mut observer: impl FnMut(f64, f64),
) -> Solution<N> {
    let quick = match options.method {
        Method::Automatic => polynomial::solve(pair, start, options, &mut observer),
        Method::SingularBasis => None,
    };
    match quick {
        Some(Quick { solution, is_sure: true }) => solution,
        Some(Quick { solution, is_sure: false }) => {
            Solution { margin: pair.compensated_margin(solution.y, solution.nu), ..solution }
        }
        None => secular::solve(*pair, start, options, observer),
    }
}

/// `solution` in world coordinates.
#[inline]
pub(crate) fn answer<V: Vector, const N: usize>(pair: &Pair<N>, solution: Solution<N>) -> Margin<V> {
    let Solution { nu, y, margin, status, iterations } = solution;
    let point = if nu > 0.0 { add(pair.x2, pair.out_of_ball(y)) } else { pair.x1 };
    Margin {
        margin: V::Scalar::from_f64(margin),
        nu: V::Scalar::from_f64(nu),
        point: store(point),
        status,
        iterations,
        ball_point: store(y),
    }
}

impl<V: Vector> Margin<V> {
    /// The factor √(1 + m) about x₁ that makes E₁ touch E₂.
    #[must_use]
    pub fn scale(&self) -> V::Scalar {
        num_traits::Float::sqrt(V::Scalar::ONE + self.margin)
    }
}
