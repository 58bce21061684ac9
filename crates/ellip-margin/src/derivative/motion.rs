//! Gradients and Hessians by the motion of a body.

use convex_support::{Ellipsoid, Matrix, Scalar};

use super::contact::{Contact, Form, Mover, Units};
use crate::Wedge;
use crate::numerics::{Vec, load, load_columns, store};

/// The derivative of a quantity by the motion of one of the two ellipsoids. It is like a force that acts on the body at a point.
///
/// It is zero where the quantity is at its floor: the margin where x₁ lies in E₂, the distance where the bodies overlap, the
/// common scale where they are concentric.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionGradient<V: Wedge> {
    /// The change per translation of the body, in world axes.
    pub translation: V,
    /// The change per rotation ω of the body about its own centre, in world axes; one number in 2D, counter-clockwise.
    pub rotation: V::Bivector,
    /// The centre of the body.
    pub center: V,
}

impl<V: Wedge> MotionGradient<V> {
    /// The change per rotation ω of the body about `pivot`, which carries its centre along.
    #[must_use]
    pub fn rotation_about(&self, pivot: V) -> V::Bivector {
        let carried = (self.center - pivot).wedge(self.translation);
        V::bivector(|i| V::coordinates(&self.rotation)[i] + V::coordinates(&carried)[i])
    }

    /// The change per radian of a revolute joint that carries the body, about the unit vector `axis` through `pivot` (in 2D an axis of
    /// 1 is counter-clockwise): one entry of the gradient by the joint angles.
    #[must_use]
    pub fn revolute(&self, pivot: V, axis: V::Bivector) -> V::Scalar {
        V::bivector_dot(self.rotation_about(pivot), axis)
    }

    /// The change per unit of length of a prismatic joint that carries the body, along the unit vector `axis`.
    #[must_use]
    pub fn prismatic(&self, axis: V) -> V::Scalar {
        self.translation.dot(axis)
    }

    /// At the floor.
    pub(super) fn zero(body: &Ellipsoid<V>) -> Self {
        Self { translation: V::ZERO, rotation: V::Bivector::default(), center: body.center() }
    }

    /// Of the value of a contact.
    pub(super) fn of_contact<const N: usize>(
        contact: &Contact<N>,
        mover: Mover,
        body: &Ellipsoid<V>,
        units: Units,
    ) -> Self {
        let (force, e, factor) = contact.gradient(mover);
        Self {
            translation: store(force.map(|x| x * (units.value / units.length))),
            rotation: torque(body, e, factor * units.value),
            center: body.center(),
        }
    }
}

/// The second derivatives of a quantity by the motion of one of the two ellipsoids.
///
/// The motion is a translation δ and a rotation vector ω, both in world axes, the rotation about the body's own centre:
///
/// > centre x ↦ x + δ, axes R ↦ exp(\[ω\]×)R, f ↦ f + gᵀθ + ½θᵀHθ + O(‖θ‖³) with θ = (δ, ω),
///
/// in 2D with the angle ω, counter-clockwise. H is symmetric. (A gradient taken anew in world axes at the moved body is
/// g + Hθ + ½(0, ω × ∂f/∂ω) + O(‖θ‖²), since rotations do not commute.)
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionHessian<V: Wedge> {
    /// H: an array of 6 rows by 6 in 3D, of 3 by 3 in 2D; translations first.
    pub matrix: V::MotionMatrix,
}

impl<V: Wedge> MotionHessian<V> {
    /// The block of translations: ∂²f/∂x², symmetric.
    #[must_use]
    pub fn translation(&self) -> V::Matrix {
        V::Matrix::from_cols_fn(|j| V::from_fn(|i| V::motion_entry(&self.matrix, i, j)))
    }

    /// The second derivative along a motion: θᵀHθ for θ = (`translation`, `rotation`).
    #[must_use]
    pub fn along(&self, translation: V, rotation: V::Bivector) -> V::Scalar {
        let turn = V::coordinates(&rotation);
        let theta = |i: usize| if i < V::DIM { translation.get(i) } else { turn[i - V::DIM] };
        let count = V::DIM + turn.len();
        let mut sum = V::Scalar::ZERO;
        for i in 0..count {
            for j in 0..count {
                sum += theta(i) * theta(j) * V::motion_entry(&self.matrix, i, j);
            }
        }
        sum
    }

    /// At the floor.
    pub(super) fn zero() -> Self {
        Self { matrix: V::motion_matrix(|_, _| V::Scalar::ZERO) }
    }

    /// Of a number that is a function of the value of a contact.
    pub(super) fn of_contact<const N: usize>(contact: &Contact<N>, mover: Mover, form: Form) -> Self {
        let hessian = contact.hessian(mover, form);
        Self { matrix: V::motion_matrix(|i, j| V::Scalar::from_f64(hessian[i][j])) }
    }
}

/// `factor`·Σ uᵢuⱼ(aᵢ/aⱼ − aⱼ/aᵢ) eᵢ∧eⱼ over the planes i < j of the axes of `body`.
///
/// Torques about the own centre are such sums in body axes, where nothing cancels: it is zero in a plane where the body is round,
/// to the last bit.
#[inline]
pub(super) fn torque<V: Wedge, const N: usize>(body: &Ellipsoid<V>, u: Vec<N>, factor: f64) -> V::Bivector {
    let (axes, a): ([Vec<N>; N], Vec<N>) = (load_columns(body.axes()), load(body.semi_axes()));
    let mut sum = [0.0; 3];
    for i in 0..N {
        for j in i + 1..N {
            let size = factor * u[i] * u[j] * ((a[i] - a[j]) / a[i] * ((a[i] + a[j]) / a[j]));
            for (k, sum) in sum.iter_mut().enumerate() {
                let (p, q) = if N == 2 { (0, 1) } else { ((k + 1) % 3, (k + 2) % 3) };
                *sum += size * (axes[i][p] * axes[j][q] - axes[i][q] * axes[j][p]);
            }
        }
    }
    V::bivector(|k| V::Scalar::from_f64(sum[k]))
}
