//! How the margin changes with the sizes of both bodies.
//!
//! With w = x* − x₁ and v = x* − x₂: ∂m/∂P = wwᵀ, ∂m/∂Q = νvvᵀ; along semi-axis k, direction e: ∂m/∂a₁ₖ =
//! −2(e·w)²/a₁ₖ³, ∂m/∂a₂ₖ = −2ν(e·v)²/a₂ₖ³.

use convex_support::{Ellipsoid, Matrix, Scalar, Vector};

use super::margin::beta_and_z;
use crate::numerics::{combine, load, load_columns, store};
use crate::{Answer, Margin};

/// The gradient of the margin with respect to the sizes of both ellipsoids.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ShapeGradient<V: Vector> {
    /// ∂m/∂a₁: per length of each semi-axis of E₁; never positive.
    pub semi_axes1: V,
    /// ∂m/∂a₂: per length of each semi-axis of E₂; never positive.
    pub semi_axes2: V,
    /// ∂m/∂P = wwᵀ, as a symmetric matrix G: dm = tr(G·dP).
    pub matrix1: V::Matrix,
    /// ∂m/∂Q = νvvᵀ, as a symmetric matrix G: dm = tr(G·dQ).
    pub matrix2: V::Matrix,
}

impl<V: Vector> Answer<'_, V, Margin<V>> {
    /// The gradient with respect to the sizes of both.
    pub fn shape_gradient(&self) -> ShapeGradient<V> {
        in_dimension!(shape_gradient::<V>(self, self.first(), self.second()))
    }
}

fn shape_gradient<V: Vector, const N: usize>(m: &Margin<V>, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> ShapeGradient<V> {
    let (beta, _) = beta_and_z::<V, N>(m, e1, e2);
    let (a1, a2): ([f64; N], [f64; N]) = (load(e1.semi_axes()), load(e2.semi_axes()));
    let y: [f64; N] = load(m.ball_point);
    let nu = m.nu.as_f64();
    let w: [f64; N] = combine(load_columns(e1.axes()), core::array::from_fn(|i| a1[i] * beta[i]));
    let v: [f64; N] = combine(load_columns(e2.axes()), core::array::from_fn(|j| a2[j] * y[j]));
    let outer = |x: [f64; N], factor: f64| {
        V::Matrix::from_cols_fn(|j| V::from_fn(|i| V::Scalar::from_f64(factor * (x[i] * x[j]))))
    };
    // (e·w)/a₁ₖ = βₖ, (e·v)/a₂ₖ = yₖ
    ShapeGradient {
        semi_axes1: store::<V, N>(core::array::from_fn(|k| -2.0 * beta[k] * beta[k] / a1[k])),
        semi_axes2: store::<V, N>(core::array::from_fn(|k| -2.0 * nu * y[k] * y[k] / a2[k])),
        matrix1: outer(w, 1.0),
        matrix2: outer(v, nu),
    }
}
