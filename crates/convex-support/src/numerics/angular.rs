//! Angular velocities as vectors: along the axis in 3D, a number in the first coordinate in 2D. Formulas for their
//! sums, products and matrices are then the same in both.

use crate::{AngularVelocity, Matrix, Scalar, Vector};

/// The cross product, in space.
#[inline(always)]
pub fn cross<V: Vector>(a: V, b: V) -> V {
    debug_assert!(V::DIM == 3, "the cross product needs three dimensions");
    V::from_fn(|i| {
        let (j, k) = ((i + 1) % V::DIM, (i + 2) % V::DIM);
        a.get(j) * b.get(k) - a.get(k) * b.get(j)
    })
}

/// The vector of an angular velocity.
pub fn vector<V: Vector>(spin: V::AngularVelocity) -> V {
    V::from_fn(|i| if V::DIM == 3 || i == 0 { spin.coordinate(i) } else { Scalar::ZERO })
}

/// The matrix of the product with it.
pub fn matrix<V: Vector>(spin: V) -> V::Matrix {
    V::AngularVelocity::from_coordinates(|i| spin.get(i)).cross_matrix()
}

/// `ω × v`.
#[inline(always)]
pub fn turning<V: Vector>(spin: V, v: V) -> V {
    if V::DIM == 3 {
        return cross(spin, v);
    }
    let w = spin.get(0);
    V::from_fn(|i| if i == 0 { -w * v.get(1) } else { w * v.get(0) })
}

/// `ω × ω'`, which is zero in 2D.
#[inline(always)]
pub fn product<V: Vector>(a: V, b: V) -> V {
    if V::DIM == 3 { cross(a, b) } else { V::ZERO }
}

/// The angular velocity turned by a rotation, which changes nothing in 2D.
#[inline(always)]
pub fn turned<M: Matrix>(rotation: &M, spin: M::Vector) -> M::Vector {
    if M::Vector::DIM == 3 { *rotation * spin } else { spin }
}
