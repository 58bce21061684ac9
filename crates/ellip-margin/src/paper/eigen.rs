//! The paper's own method for the margin: the minimal eigenvalue of a 2N×2N matrix, found among all of them by the QR
//! algorithm. For comparison and teaching; feature `paper`.
//!
//! Rimon and Boyd, Theorem 2, with the misprint in the point corrected: (13) gives x* in the coordinates of the ball,
//! and the point itself is x₂ + Q^-½[C − λ*I]⁻¹b. Entries of bbᵀ grow with the square of the condition of C, and the QR
//! algorithm's errors are relative to the largest: digits of λ* are lost from a condition of 1e4 on, and all of them
//! from 1e8. [`free_margin`](crate::free_margin) loses none and is faster by far.

use convex_support::{Ellipsoid, Vector};
use faer::Mat;

use crate::margin::answer;
use crate::numerics::{Vec, dot, sub};
use crate::pair::Pair;
use crate::secular::Solution;
use crate::{Answer, EllipsoidPair, Margin, MarginOptions, Status};

/// [`free_margin`](crate::free_margin) by the paper's eigenvalue problem of twice the dimension, all of whose
/// eigenvalues are computed by faer.
///
/// The matrix has the blocks `C` and `−I` above, and `−bbᵀ` and `C` below.
///
/// `iterations` is 0, since the QR algorithm counts its own; `status` is [`Stalled`](Status::Stalled) where the
/// eigenvalue of least real part is not real or not negative, as it should be.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, free_margin, paper::free_margin_eigen};
///
/// let e1 = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 1.0), 0.3)?;
/// let e2 = Ellipsoid::new(DVec2::new(4.0, 1.0), DVec2::new(1.0, 0.5), -0.8)?;
/// let difference = free_margin_eigen(&e1, &e2).margin
///     - free_margin(&e1, &e2, MarginOptions::default()).margin;
/// assert!(difference.abs() < 1e-12);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn free_margin_eigen<'a, V: Vector>(e1: &'a Ellipsoid<V>, e2: &'a Ellipsoid<V>) -> Answer<'a, V, Margin<V>> {
    let margin = if V::DIM == 2 {
        let pair = Pair::<2>::new(e1, e2);
        answer(&pair, solve(&pair))
    } else {
        let pair = Pair::<3>::new(e1, e2);
        answer(&pair, solve(&pair))
    };
    EllipsoidPair::new(e1, e2, MarginOptions::default()).answer(margin)
}

/// The paper's C = Q^-½PQ^-½, b = Q^-½P(x₁ − x₂) and the minimal eigenvalue of its matrix.
fn solve<const N: usize>(pair: &Pair<N>) -> Solution<N> {
    let (ball_center, _) = pair.c_and_g();
    if dot(ball_center, ball_center) <= 1.0 {
        return Solution::inside(ball_center);
    }
    let p = symmetric(pair.axes1, pair.a1.map(|a| 1.0 / (a * a)));
    let root = symmetric(pair.axes2, pair.a2); // Q^-½
    let c = product(product(root, p), root);
    let b = apply(root, apply(p, pair.r()));

    let m = Mat::from_fn(2 * N, 2 * N, |i, j| match (i < N, j < N) {
        (true, true) => c[i][j],
        (true, false) => -f64::from(u8::from(i == j - N)),
        (false, true) => -b[i - N] * b[j],
        (false, false) => c[i - N][j - N],
    });
    let least = m.eigenvalues().ok().and_then(|all| all.into_iter().min_by(|a, b| a.re.total_cmp(&b.re)));
    let (lambda, status) = match least {
        Some(l) if l.re < 0.0 && l.im == 0.0 => (l.re, Status::Converged),
        Some(l) => (l.re.min(0.0), Status::Stalled),
        None => (0.0, Status::Stalled),
    };

    // x̄ = [C − λI]⁻¹b; then y = R₂ᵀx̄ in the axes of E₂, and m = (x* − x₁)ᵀP(x* − x₁) − 1.
    let mut shifted = c;
    for (i, row) in shifted.iter_mut().enumerate() {
        row[i] -= lambda;
    }
    let x = solved(shifted, b);
    let w = sub(apply(root, x), pair.r());
    let margin = dot(w, apply(p, w)) - 1.0;
    let y = core::array::from_fn(|j| dot(pair.axes2[j], x));
    Solution { nu: -lambda, y, margin, status, iterations: 0 }
}

/// `R·diag(d)·Rᵀ`, for the columns of `R`.
fn symmetric<const N: usize>(axes: [Vec<N>; N], d: Vec<N>) -> [Vec<N>; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..N).map(|k| axes[k][i] * d[k] * axes[k][j]).sum()))
}

fn product<const N: usize>(a: [Vec<N>; N], b: [Vec<N>; N]) -> [Vec<N>; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..N).map(|k| a[i][k] * b[k][j]).sum()))
}

fn apply<const N: usize>(a: [Vec<N>; N], x: Vec<N>) -> Vec<N> {
    a.map(|row| dot(row, x))
}

/// `a⁻¹·b` for a symmetric positive definite `a`, by elimination.
fn solved<const N: usize>(mut a: [Vec<N>; N], mut b: Vec<N>) -> Vec<N> {
    for k in 0..N {
        for i in k + 1..N {
            let factor = a[i][k] / a[k][k];
            for j in k..N {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..N).rev() {
        let rest: f64 = (k + 1..N).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - rest) / a[k][k];
    }
    b
}
