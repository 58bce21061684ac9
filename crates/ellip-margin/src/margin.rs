//! The free margin of two ellipsoids.

use convex_support::numerics::elementary::sqrt;
use convex_support::{Ellipsoid, Scalar, Vector};

use crate::numerics::{add, dot, store, sub};
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

/// The free margin of `e1` about `e2` (Rimon and Boyd, Section 3): the square of the factor by which `e1` has to grow
/// about its centre to touch `e2`, minus one.
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
#[doc(alias("clearance", "barrier_function"))]
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
/// polynomial would lose digits; from `start`, 0 if unknown.
///
/// The rare cases take the pair by value, so that the pair of the usual case can stay in registers.
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
        sqrt(V::Scalar::ONE + self.margin)
    }

    /// A lower bound of the margin after E₁ has moved, without another query: `from` is where it was when this margin
    /// was found, and `to` is where it is now. E₂ is at rest. As long as the bound is above the margin to be kept, E₂
    /// need not be asked about again. −1 if the semi-axes have changed. The bound is as right as the margin: one that
    /// was found with a wide tolerance, or has not converged, promises nothing.
    ///
    /// ```
    /// use ellip_margin::convex_support::{Ellipsoid, glam::{DQuat, DVec3}};
    /// use ellip_margin::{MarginOptions, free_margin};
    ///
    /// let hand = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.2, 0.1, 0.1), DQuat::IDENTITY)?;
    /// let shelf = Ellipsoid::new(DVec3::X, DVec3::new(0.2, 0.5, 0.5), DQuat::IDENTITY)?;
    /// let margin = free_margin(&hand, &shelf, MarginOptions::default()); // 4² − 1
    ///
    /// // It may go on by 0.1 and turn by 0.1, and touches only at more than twice its size, for all that is known.
    /// let near = Ellipsoid::new(DVec3::X * 0.1, DVec3::new(0.2, 0.1, 0.1), DQuat::from_rotation_z(0.1))?;
    /// assert!(margin.after_motion(&hand, &near) > 3.0);
    /// assert!(margin.after_motion(&hand, &near) < free_margin(&near, &shelf, MarginOptions::default()).margin);
    /// // It may not go on by 0.7.
    /// let far = Ellipsoid::new(DVec3::X * 0.7, DVec3::new(0.2, 0.1, 0.1), DQuat::IDENTITY)?;
    /// assert!(margin.after_motion(&hand, &far) < 0.0);
    /// # Ok::<(), ellip_margin::convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn after_motion(&self, from: &Ellipsoid<V>, to: &Ellipsoid<V>) -> V::Scalar {
        // The margin is right to some twelve digits, or to the rounding of its own precision.
        let lost = 16.0 * V::Scalar::EPSILON.as_f64() + 1e-11;
        let scale = scale_after::<V>(self.scale().as_f64() * (1.0 - lost), from, to).max(0.0);
        V::Scalar::from_f64(scale * scale * (1.0 - lost) - 1.0)
    }
}

/// A lower bound of √(1 + m) with E₁ at `to`, if that was `scale` with E₁ at `from`; 0 if its semi-axes have changed.
///
/// A point with the coordinates p = diag(a)⁻¹Rᵀ(x − x₁) in the old ball has p′ = Gp + δ in the new one, with G =
/// diag(a)⁻¹R′ᵀR·diag(a), δ = diag(a)⁻¹R′ᵀ(x₁ − x₁′): ‖p′‖ ≥ (1 − ‖G − I‖)‖p‖ − ‖δ‖.
pub(crate) fn scale_after<V: Vector>(scale: f64, from: &Ellipsoid<V>, to: &Ellipsoid<V>) -> f64 {
    fn once<V: Vector, const N: usize>(scale: f64, from: &Ellipsoid<V>, to: &Ellipsoid<V>) -> f64 {
        let Pair { x1: old_center, x2: center, axes1: old, axes2: new, a1: a, a2 } = Pair::<N>::new(from, to);
        if a2 != a {
            return 0.0;
        }
        let moved = sub(old_center, center);
        let (mut turn, mut shift) = (0.0, 0.0);
        for i in 0..N {
            for j in 0..N {
                let entry = (dot(new[i], old[j]) - f64::from(u8::from(i == j))) * (a[j] / a[i]);
                turn += entry * entry;
            }
            let delta = dot(new[i], moved) / a[i];
            shift += delta * delta;
        }
        // A generous bound on the rounding of axes and products.
        let [least, most] = [f64::min, f64::max].map(|extreme| a.into_iter().reduce(extreme).unwrap_or(0.0));
        let turn = sqrt(turn) + 64.0 * V::Scalar::EPSILON.as_f64() * (most / least);
        (1.0 - turn) * scale - sqrt(shift) * (1.0 + 1e-12)
    }
    in_dimension!(once::<V>(scale, from, to))
}
