//! How the margin, the distance and the common scale change as a body moves: one derivation for the three.
//!
//! Each is the greatest value s of a difference of support functions over normals N from E₁ to E₂. With r = x₂ − x₁,
//! Sₖ = Rₖ·diag(aₖ)²·Rₖᵀ and hₖ = √(NᵀSₖN), growing E₁ by ρ = √(1 + m), keeping the two apart by d, or scaling both by
//! α:
//!
//! | | s | maximises | where |
//! |---|---|---|---|
//! | margin | ρ | N·r − h₂ | h₁ = 1 |
//! | distance | d | N·r − h₁ − h₂ | ‖N‖ = 1 |
//! | common scale | α | N·r | h₁ + h₂ = 1 |
//!
//! In all three the objective is N·r − f·(‖N‖, h₁, h₂) and the constraint γ(N) = g·(‖N‖, h₁, h₂) = 1, with weights f
//! and g of 0 and 1. The multiplier of the constraint is s itself, since all is homogeneous in N, so that with k = f +
//! s·g
//!
//! > L(N) = N·r − k₀‖N‖ − k₁h₁(N) − k₂h₂(N)
//!
//! is stationary: the bodies grown by k₁ and k₂ have a slab of width k₀ between them. [`contact`] has the formulas that
//! follow. A motion of a body is a translation δ and a rotation vector ω about the body's own centre, both in world
//! axes: x ↦ x + δ, R ↦ exp([ω]×)R.

mod contact;
mod margin;
mod motion;
pub(crate) mod shape;
mod side;

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Scalar, Vector};

use self::contact::{Contact, Form, Mover, Quantity, Units};
use crate::numerics::{Vec, combine, load};
use crate::pair::Pair;
use crate::{Answer, Distance, Scaling};

/// A quantity of two ellipsoids that is a function of the value of a contact.
trait OfContact<V: Vector> {
    /// The contact, and the function of its value; `None` where the quantity is at its floor.
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Form)>;

    /// The gradient by the motion of one of the two, of a quantity that is the value itself.
    fn gradient<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>, mover: Mover) -> MotionGradient<V> {
        let body = mover.of(first, second);
        self.contact::<N>(first, second).map_or_else(
            || MotionGradient::force(V::ZERO, body.center()),
            |(contact, form)| motion::gradient(&contact, mover, body, form.units),
        )
    }
}

impl<V: Vector> OfContact<V> for Distance<V> {
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Form)> {
        let (pair, length) = Pair::<N>::new(first, second).in_own_unit();
        let normal = load(self.bracket.normal);
        let contact = Contact::new(&pair, Quantity::DISTANCE, normal)?.refined(&pair);
        Some((contact, Form::of_value(Units { value: length, length })))
    }
}

impl<V: Vector> OfContact<V> for Scaling<V> {
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Form)> {
        let (pair, length) = Pair::<N>::new(first, second).in_own_unit();
        let [e1, e2]: [Vec<N>; 2] = self.ball_points.map(load);
        // Qv, against E₂'s own normal there.
        let normal = combine(pair.axes2, core::array::from_fn(|j| e2[j] / pair.a2[j]));
        let contact = Contact::at_points(&pair, Quantity::SCALE, normal, [e1, e2], None)?;
        Some((contact, Form::of_value(Units { value: 1.0, length })))
    }
}

/// The derivatives of the margin, the [distance](crate::Distance) and the [common scale](crate::Scaling), which
/// [`EllipsoidPair`](crate::EllipsoidPair) shows.
#[allow(private_bounds, reason = "there are these three quantities and no others")]
impl<V: Vector, A: OfContact<V>> Answer<'_, V, A> {
    /// The gradient with respect to the motion of the first ellipsoid; zero where the quantity is at its floor.
    #[inline]
    pub fn gradient(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, Mover::First))
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    #[inline]
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, Mover::Second))
    }

    /// The second derivatives with respect to the motion of the first ellipsoid; zero where the quantity is at its
    /// floor.
    pub fn hessian(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::First))
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::Second))
    }
}

#[inline]
fn gradient<V: Vector, const N: usize>(answer: &Answer<'_, V, impl OfContact<V>>, mover: Mover) -> MotionGradient<V> {
    (**answer).gradient::<N>(answer.first(), answer.second(), mover)
}

fn hessian<V: Vector, const N: usize>(answer: &Answer<'_, V, impl OfContact<V>>, mover: Mover) -> MotionHessian<V> {
    let rows = match answer.contact::<N>(answer.first(), answer.second()) {
        Some((contact, form)) => contact.hessian(mover, form),
        None => [[0.0; 6]; 6],
    };
    MotionHessian::from_rows(rows.map(|row| row.map(V::Scalar::from_f64)), true)
}
