//! Derivatives of a quantity that is the value of a contact itself.

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Vector};

use super::contact::{Contact, Form, Mover, Units};
use super::motion;
use crate::Answer;

/// An answer about two ellipsoids that is the value of their contact.
pub(super) trait ValueOfContact<V: Vector> {
    /// The contact, and the units it is in; `None` where the quantity is at its floor.
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Units)>;
}

/// The gradient of an answer with respect to the motion of one of the two.
pub(super) fn gradient<V: Vector, A: ValueOfContact<V>>(answer: &Answer<'_, V, A>, mover: Mover) -> MotionGradient<V> {
    let (first, second) = (answer.first(), answer.second());
    let body = match mover {
        Mover::First => first,
        Mover::Second => second,
    };
    let gradient = if V::DIM == 2 {
        let contact = answer.contact::<2>(first, second);
        contact.map(|(contact, units)| motion::gradient(&contact, mover, body, units))
    } else {
        let contact = answer.contact::<3>(first, second);
        contact.map(|(contact, units)| motion::gradient(&contact, mover, body, units))
    };
    gradient.unwrap_or_else(|| motion::no_gradient(body))
}

/// The second derivatives.
pub(super) fn hessian<V: Vector, A: ValueOfContact<V>>(answer: &Answer<'_, V, A>, mover: Mover) -> MotionHessian<V> {
    let (first, second) = (answer.first(), answer.second());
    let hessian = if V::DIM == 2 {
        let contact = answer.contact::<2>(first, second);
        contact.map(|(contact, units)| motion::hessian(&contact, mover, Form { slope: 1.0, curvature: 0.0, units }))
    } else {
        let contact = answer.contact::<3>(first, second);
        contact.map(|(contact, units)| motion::hessian(&contact, mover, Form { slope: 1.0, curvature: 0.0, units }))
    };
    hessian.unwrap_or_else(motion::no_hessian)
}
