//! The paper's gradient of the minimal eigenvalue, Corollary 4.1.

use convex_support::{Scalar, Vector};

/// The gradient of the paper's eigenvalue; see [`eigenvalue_gradient`].
///
/// It is that of λ* where Σ b̄ᵢ²/(λᵢ − λ*)² = 1, in the eigenbasis of C.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct EigenvalueGradient<V: Vector> {
    /// ∂λ*/∂b̄ᵢ = −b̄ᵢ/(η(λᵢ − λ*)²), with η = Σ b̄ᵢ²/(λᵢ − λ*)³.
    pub b: V,
    /// ∂λ*/∂λᵢ = b̄ᵢ²/(η(λᵢ − λ*)³).
    pub eigenvalues: V,
}

/// Corollary 4.1 of Rimon and Boyd: how the minimal eigenvalue λ* changes with b̄ = Rᵀb and the eigenvalues λᵢ of C.
///
/// The formula is right, but it is the gradient of λ*, not of the margin, and it lives in a basis that is undefined
/// where two eigenvalues meet, as for spheroids. The gradient of
/// [`EllipsoidPair::margin`](crate::EllipsoidPair::margin) has neither limit.
///
/// ```
/// use convex_support::glam::DVec2;
/// use ellip_margin::paper::eigenvalue_gradient;
///
/// // b̄ = (3, 0), λ = (1, 2): 9/(1 − λ*)² = 1 at λ* = −2, which falls as b̄₁ grows.
/// let gradient = eigenvalue_gradient(DVec2::new(3.0, 0.0), DVec2::new(1.0, 2.0), -2.0);
/// assert_eq!(gradient.b, DVec2::new(-1.0, 0.0));
/// assert_eq!(gradient.eigenvalues, DVec2::new(1.0, 0.0));
/// ```
pub fn eigenvalue_gradient<V: Vector>(b: V, eigenvalues: V, lambda: V::Scalar) -> EigenvalueGradient<V> {
    let shifted = |i: usize| eigenvalues.get(i) - lambda;
    let cubic = |i: usize| b.get(i) * b.get(i) / (shifted(i) * shifted(i) * shifted(i));
    let eta = (0..V::DIM).fold(V::Scalar::ZERO, |sum, i| sum + cubic(i));
    EigenvalueGradient {
        b: V::from_fn(|i| -b.get(i) / (shifted(i) * shifted(i)) / eta),
        eigenvalues: V::from_fn(|i| cubic(i) / eta),
    }
}
