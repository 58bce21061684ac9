//! The derivatives of the margin as a body moves.
//!
//! With w = x* − x₁, v = x* − x₂ and z = Qv, stationarity says Pw = −νz, and since the minimiser moves to second order
//! only, the margin changes as (x* − x₁)ᵀP(x* − x₁) + ν((x* − x₂)ᵀQ(x* − x₂) − 1) does with x* and ν held:
//!
//! - ∂m/∂x₁ = −2Pw = 2νz =: F, ∂m/∂x₂ = −F;
//! - a turn δω of E₁ about p moves E₁ under a fixed x*: ∂m/∂ω = (x* − p) ∧ F. F at x* is a wrench. For E₂, its
//!   opposite.
//!
//! In the code w and v are kept as each body sees them, w = R₁·diag(a₁)β and v = R₂·diag(a₂)y. Torques about the own
//! centre are w ∧ F = Σ wᵢFⱼ eᵢ∧eⱼ with wᵢ = a₁ᵢβᵢ and Fⱼ = −2βⱼ/a₁ⱼ, hence −2βᵢβⱼ(a₁ᵢ/a₁ⱼ − a₁ⱼ/a₁ᵢ) for each plane i
//! < j.
//!
//! The second derivatives are those of m = ρ² − 1: m″ = 2ρρ″ + 2ρ′ρ′ᵀ, a sum of positive semidefinite terms for
//! translations.

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::contact::{Contact, Form, Mover, Quantity, Units};
use super::motion::{self, torque};
use crate::numerics::{combine, dot, load, size, store, sub, unit};
use crate::pair::Pair;
use crate::{Answer, Margin};

impl<V: Vector> Answer<'_, V, Margin<V>> {
    /// The gradient of the margin with respect to the motion of the first ellipsoid; zero if x₁ lies in E₂.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&link, &obstacle, MarginOptions::default());
    /// let gradient = pair.margin().gradient();
    /// // m = ((6 − x)/2 − ½)² − 1 for the link at (x, 0, 0).
    /// assert_eq!(gradient.translation, DVec3::new(-2.5, 0.0, 0.0));
    /// // A joint at (0, −3, 0) about z swings the link towards −x, by 3 a radian.
    /// assert_eq!(gradient.revolute(DVec3::new(0.0, -3.0, 0.0), DVec3::Z), 7.5);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[inline]
    pub fn gradient(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, self.first(), self.second(), Mover::First))
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    #[inline]
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, self.first(), self.second(), Mover::Second))
    }

    /// The second derivatives with respect to the motion of the first ellipsoid; the block of translations is positive
    /// semidefinite, since m is convex in the centres.
    ///
    /// It is zero where x₁ lies in E₂, and jumps at the boundary of E₂, where m has no second derivative.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::{DMat3, DVec3}};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// // m = (d/2 − ½)² − 1 for balls of radius 2 and 1 at a distance of d: m″ = ½ along,
    /// // m′/d = (d − 1)/2d across.
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(5.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&link, &obstacle, MarginOptions::default());
    /// let hessian = pair.margin().hessian();
    /// let due = DMat3::from_diagonal(DVec3::new(0.5, 0.4, 0.4));
    /// assert!(DMat3::from_cols_array_2d(&hessian.matrix()).abs_diff_eq(due, 1e-15));
    /// // A ball may turn as it likes.
    /// assert_eq!(hessian.along(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)), 0.0);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn hessian(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, self.first(), self.second(), Mover::First))
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, self.first(), self.second(), Mover::Second))
    }
}

/// β = diag(a₁)⁻¹R₁ᵀ(x* − x₁), x* − x₁ as E₁ sees it, and z = Q(x* − x₂).
#[inline]
pub(super) fn beta_and_z<V: Vector, const N: usize>(
    m: &Margin<V>,
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
) -> ([f64; N], [f64; N]) {
    let pair = Pair::<N>::new(e1, e2);
    let y: [f64; N] = load(m.ball_point);
    let nu = m.nu.as_f64();
    let z = combine(pair.axes2, core::array::from_fn(|j| y[j] / pair.a2[j]));
    let (r, v) = (pair.r(), pair.out_of_ball(y));
    // βᵢ = −ν·a₁ᵢ·eᵢ·z = eᵢ·(v − r)/a₁ᵢ; the sums have errors of about ν·a₁ᵢ‖z‖ε and (‖v‖ + ‖r‖)ε/a₁ᵢ.
    let (size_z, size_w) = (nu * size(z), size(v) + size(r));
    let beta = core::array::from_fn(|i| {
        let a = pair.a1[i];
        if a * (a * size_z) < size_w { -nu * a * dot(pair.axes1[i], z) } else { dot(pair.axes1[i], sub(v, r)) / a }
    });
    (beta, z)
}

#[inline]
fn gradient<V: Vector, const N: usize>(
    m: &Margin<V>,
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
    mover: Mover,
) -> MotionGradient<V> {
    let (beta, z) = beta_and_z::<V, N>(m, e1, e2);
    let nu = m.nu.as_f64();
    let (body, sign, rotation) = match mover {
        Mover::First => (e1, 2.0, torque(e1, beta, -2.0)),
        Mover::Second => (e2, -2.0, torque(e2, load::<V, N>(m.ball_point), -2.0 * nu)),
    };
    MotionGradient { translation: store(z.map(|z| sign * nu * z)), rotation, point: body.center() }
}

fn hessian<V: Vector, const N: usize>(
    m: &Margin<V>,
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
    mover: Mover,
) -> MotionHessian<V> {
    if m.nu <= V::Scalar::ZERO {
        return motion::no_hessian();
    }
    // N points along −z; E₁ touches at β, E₂ at y.
    let (beta, z) = beta_and_z::<V, N>(m, e1, e2);
    let points = [unit(beta), load::<V, N>(m.ball_point).map(|y| -y)];
    let (pair, length) = Pair::<N>::new(e1, e2).in_own_unit();
    let rho = dot(beta, beta).sqrt();
    let contact = Contact::at_points(&pair, Quantity::GROWTH, z.map(|z| -z), points, Some(rho));
    contact.as_ref().map_or_else(motion::no_hessian, |contact| {
        let units = Units { value: 1.0, length };
        motion::hessian(contact, mover, Form { slope: 2.0 * contact.value, curvature: 2.0, units })
    })
}
