//! The derivatives of the margin as a body moves.
//!
//! With w = x* − x₁, v = x* − x₂ and z = Qv, stationarity says Pw = −νz, and since the minimiser moves to second order
//! only, the margin changes as (x* − x₁)ᵀP(x* − x₁) + ν((x* − x₂)ᵀQ(x* − x₂) − 1) does with x* and ν held:
//!
//! - ∂m/∂x₁ = −2Pw = 2νz =: F, ∂m/∂x₂ = −F;
//! - a turn δω of E₁ about p moves E₁ under a fixed x*: ∂m/∂ω = (x* − p) ∧ F. F at x* is a wrench. For E₂, its
//!   opposite.
//!
//! In the code w and v are in the frames of the bodies, w = R₁·diag(a₁)β and v = R₂·diag(a₂)y. Torques about the own
//! centre are w ∧ F = Σ wᵢFⱼ eᵢ∧eⱼ with wᵢ = a₁ᵢβᵢ and Fⱼ = −2βⱼ/a₁ⱼ, hence −2βᵢβⱼ(a₁ᵢ/a₁ⱼ − a₁ⱼ/a₁ᵢ) for each plane
//! of i < j.
//!
//! The second derivatives are those of m = ρ² − 1: m″ = 2ρρ″ + 2ρ′ρ′ᵀ, a sum of positive semidefinite terms for
//! translations.

use convex_support::numerics::elementary::sqrt;
use convex_support::{Ellipsoid, MotionGradient, Scalar, Vector};

use super::OfContact;
use super::contact::{Contact, Form, Mover, Quantity, Units};
use super::motion::torque;
use crate::Margin;
use crate::numerics::{combine, dot, load, size, store, sub, unit};
use crate::pair::Pair;

impl<V: Vector> OfContact<V> for Margin<V> {
    fn contact<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Option<(Contact<N>, Form)> {
        if self.nu <= V::Scalar::ZERO {
            return None;
        }
        // N points along −z; E₁ touches at β, E₂ at y.
        let (beta, z) = beta_and_z::<V, N>(self, e1, e2);
        let points = [unit(beta), load::<V, N>(self.ball_point).map(|y| -y)];
        let (pair, length) = Pair::<N>::new(e1, e2).in_own_unit();
        let rho = sqrt(dot(beta, beta));
        let contact = Contact::at_points(&pair, Quantity::GROWTH, z.map(|z| -z), points, Some(rho))?;
        let form = Form { slope: 2.0 * contact.value, curvature: 2.0, units: Units { value: 1.0, length } };
        Some((contact, form))
    }

    #[inline]
    fn gradient<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, mover: Mover) -> MotionGradient<V> {
        let (beta, z) = beta_and_z::<V, N>(self, e1, e2);
        let nu = self.nu.as_f64();
        let (sign, rotation) = match mover {
            Mover::First => (2.0, torque(e1, beta, -2.0)),
            Mover::Second => (-2.0, torque(e2, load::<V, N>(self.ball_point), -2.0 * nu)),
        };
        let point = mover.of(e1, e2).center();
        MotionGradient { translation: store(z.map(|z| sign * nu * z)), rotation, point }
    }
}

/// β = diag(a₁)⁻¹R₁ᵀ(x* − x₁), x* − x₁ in the frame of E₁, and z = Q(x* − x₂).
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
