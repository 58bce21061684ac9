//! Angular velocities as vectors: along the axis in 3D, a number in the first coordinate in 2D. Formulas for their
//! sums, products and matrices are then the same in both.

use convex_support::{AngularVelocity, Matrix, Vector};

use crate::simplex::cross;

/// The vector of an angular velocity.
pub(crate) fn vector<V: Vector>(spin: V::AngularVelocity) -> V {
    V::from_fn(|i| if V::DIM == 3 || i == 0 { spin.coordinate(i) } else { convex_support::Scalar::ZERO })
}

/// The matrix of the product with it.
pub(crate) fn matrix<V: Vector>(spin: V) -> V::Matrix {
    V::AngularVelocity::from_coordinates(|i| spin.get(i)).cross_matrix()
}

/// `ω × v`.
#[inline(always)]
pub(crate) fn turning<V: Vector>(spin: V, v: V) -> V {
    if V::DIM == 3 {
        return cross(spin, v);
    }
    let w = spin.get(0);
    V::from_fn(|i| if i == 0 { -w * v.get(1) } else { w * v.get(0) })
}

/// `ω × ω'`, which is zero in 2D.
#[inline(always)]
pub(crate) fn product<V: Vector>(a: V, b: V) -> V {
    if V::DIM == 3 { cross(a, b) } else { V::ZERO }
}

/// The angular velocity turned by a rotation, which changes nothing in 2D.
#[inline(always)]
pub(crate) fn turned<M: Matrix>(rotation: &M, spin: M::Vector) -> M::Vector {
    if M::Vector::DIM == 3 { *rotation * spin } else { spin }
}
