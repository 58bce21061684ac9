//! The coefficients of the polynomial from the axes of both bodies, and the answer to a root.

use convex_support::numerics::elementary::sqrt;

use super::equation::{Equation, Taylor};
use crate::numerics::{Vec, dot, size};
use crate::pair::Pair;

/// The largest factor by which a sum of the coefficients may cancel: the relative errors of ν and y are at most this
/// times a few ε, some 1e-12. Beyond it the singular basis is worth its cost.
const MAX_LOSS: f64 = 2048.0;

/// Sizes of ‖B‖² up to which sixth powers stay far from the range of `f64`.
const MAX_SIZE: f64 = 1e20;

/// The equation of a pair, and the data for the answer from its solution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Problem<const N: usize> {
    /// Whether x₁ lies in E₂, by far.
    pub(super) inside: bool,
    /// Whether no digits are lost, and x₁ lies outside E₂ by far.
    pub(super) fits: bool,
    pub(super) equation: Equation<N>,
    /// p(ν) = `low` + ν·`middle` + ν²b, or in the plane `low` + νb.
    low: Vec<N>,
    middle: Vec<N>,
    b: Vec<N>,
    /// bᵀCb.
    bcb: f64,
    /// B, row by row, and g.
    rows: [Vec<N>; N],
    g: Vec<N>,
    r: Vec<N>,
    /// 1/a₁.
    i1: Vec<N>,
    /// ‖B‖².
    norm: f64,
}

impl<const N: usize> Problem<N> {
    /// No branch depends on the numbers, so that several pairs can be set up side by side.
    #[inline(always)]
    pub(super) fn new(pair: &Pair<N>) -> Self {
        let r = pair.r();
        let i1: Vec<N> = core::array::from_fn(|i| 1.0 / pair.a1[i]);
        let g: Vec<N> = core::array::from_fn(|i| dot(pair.axes1[i], r) * i1[i]);
        // B = diag(i₁)·M·diag(a₂) with M = R₁ᵀR₂
        let scale: [Vec<N>; N] = core::array::from_fn(|i| core::array::from_fn(|j| i1[i] * pair.a2[j]));
        let m: [Vec<N>; N] = core::array::from_fn(|i| core::array::from_fn(|j| dot(pair.axes1[i], pair.axes2[j])));
        let rows: [Vec<N>; N] = core::array::from_fn(|i| core::array::from_fn(|j| m[i][j] * scale[i][j]));
        let norm = squares(&rows);
        let root_det = (1..N).fold(scale[0][0], |product, i| product * scale[i][i]);
        let det = root_det * root_det;

        let b = transposed_times(&rows, g);
        let bb = dot(b, b);
        let forward = apply(&rows, b);
        let bcb = dot(forward, forward);
        // det·c = det·diag(a₂)⁻¹R₂ᵀr, without the division.
        let low: Vec<N> = core::array::from_fn(|j| {
            let rest = if N == 2 { scale[1][1 - j] } else { scale[1][(j + 1) % 3] * scale[2][(j + 2) % 3] };
            root_det * (rest * (i1[0] * dot(pair.axes2[j], r)))
        });
        let (n0, gg) = (dot(low, low), dot(g, g));
        // low·b = det·cᵀCc = det‖Bc‖²
        let low_b = det * gg;
        let (middle, equation, keeps);
        if N == 3 {
            let cb = transposed_times(&rows, forward);
            // cof B = det(diag(i₁))·diag(i₁)⁻¹·M·diag(a₂)⁻¹·det(diag(a₂)): the cofactors of a rotation are itself.
            let cofactors: [Vec<N>; N] = core::array::from_fn(|i| {
                let (k, l) = ((i + 1) % 3, (i + 2) % 3);
                core::array::from_fn(|j| m[i][j] * (scale[k][(j + 1) % 3] * scale[l][(j + 2) % 3]))
            });
            middle = core::array::from_fn(|j| norm * b[j] - cb[j]);
            let mm = dot(middle, middle);
            equation = Equation {
                n: [n0, 2.0 * dot(low, middle), mm + 2.0 * low_b, 2.0 * dot(middle, b), bb],
                d: [det, squares(&cofactors), norm, 1.0],
            };
            keeps = norm * norm * bb < MAX_LOSS * MAX_LOSS * mm;
        } else {
            middle = [0.0; N];
            equation = Equation { n: [n0, 2.0 * low_b, bb, 0.0, 0.0], d: [det, norm, 1.0, 0.0] };
            keeps = true;
        }
        // ‖c‖² = n₀/det²
        let square = det * det;
        let fits = (n0 > 1.25 * square)
            & (n0 < MAX_SIZE * square)
            & (norm < MAX_SIZE)
            & (norm > 1.0 / MAX_SIZE)
            & (norm * gg < MAX_LOSS * MAX_LOSS * bb)
            & keeps;
        Self { inside: n0 < 0.75 * square, fits, equation, low, middle, b, bcb, rows, g, r, i1, norm }
    }

    /// A number below the root: a step of Newton's method from infinity, ‖b‖ − bᵀCb/bᵀb, or from 0.
    #[inline(always)]
    pub(super) fn start(&self) -> f64 {
        let [n0, n1, ..] = self.equation.n;
        let [d0, d1, ..] = self.equation.d;
        let bb = self.equation.n[2 * N - 2];
        let from_zero = Taylor { n: [n0, n1, 0.0, 0.0], d: [d0, d1, 0.0, 0.0] }.hebden();
        (sqrt(bb) - self.bcb / bb).max(from_zero)
    }

    /// The answer to ν.
    #[inline(always)]
    pub(super) fn nearest(&self, pair: &Pair<N>, nu: f64) -> Nearest<N> {
        let inverse = 1.0 / self.equation.determinant(nu);
        let p: Vec<N> = core::array::from_fn(|j| {
            if N == 2 { self.low[j] + nu * self.b[j] } else { self.low[j] + nu * (self.middle[j] + nu * self.b[j]) }
        });
        let y = p.map(|p| p * inverse);
        // w = By − g, with Bp found beside the division.
        let bp = apply(&self.rows, p);
        let w: Vec<N> = core::array::from_fn(|i| bp[i] * inverse - self.g[i]);
        // The Lagrangian ‖w‖² − 1 + ν(‖y‖² − 1) is stationary in y: errors of y enter squared.
        let squared = dot(w, w);
        let margin = (squared - 1.0) + nu * (dot(y, y) - 1.0);
        // Whether the error ε(‖v‖ + ‖r‖) of x* − x₁ in space, times ∂m/∂x₁ = 2R₁·diag(a₁)⁻¹w, is below 128ε·m. Lengths
        // times their inverses, never squared: the answer is the same at any scale.
        let v: Vec<N> = core::array::from_fn(|j| pair.a2[j] * y[j]);
        let pw: Vec<N> = core::array::from_fn(|i| self.i1[i] * w[i]);
        let is_sure = (size(v) + size(self.r)) * size(pw) < 64.0 * margin.abs();
        // The margin's error is ‖Bδ‖² for an error δ of y, here up to 1e-12: it must stay below the last digit.
        Nearest { y, margin, is_sure, is_sharp: self.norm < 1e9 * (1.0 + margin) }
    }
}

/// The answer for a root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest<const N: usize> {
    pub(super) y: Vec<N>,
    pub(super) margin: f64,
    /// Whether rounding cannot show in the margin.
    pub(super) is_sure: bool,
    /// Whether the errors of y cannot show in it.
    pub(super) is_sharp: bool,
}

/// The sum of the squares.
#[inline(always)]
fn squares<const N: usize>(m: &[Vec<N>; N]) -> f64 {
    let mut sum = dot(m[0], m[0]);
    for i in 1..N {
        sum += dot(m[i], m[i]);
    }
    sum
}

/// `m·x`, for the rows of `m`.
#[inline(always)]
fn apply<const N: usize>(m: &[Vec<N>; N], x: Vec<N>) -> Vec<N> {
    core::array::from_fn(|i| dot(m[i], x))
}

/// `mᵀ·x`, for the rows of `m`.
#[inline(always)]
fn transposed_times<const N: usize>(m: &[Vec<N>; N], x: Vec<N>) -> Vec<N> {
    core::array::from_fn(|j| {
        let mut sum = m[0][j] * x[0];
        for i in 1..N {
            sum += m[i][j] * x[i];
        }
        sum
    })
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DQuat, DVec2, DVec3};
    use convex_support::{Ellipsoid, InvalidShape};

    use super::*;

    /// N = ‖p‖², although its products are found by other ways, and p = adj(C + ν)·b.
    fn check<const N: usize>(pair: &Pair<N>) {
        let problem = Problem::new(pair);
        assert!(problem.fits && !problem.inside, "a pair for the polynomial: {pair:?}");
        for nu in [0.0, 1e-3, 0.7, 40.0, 1e4] {
            let p: Vec<N> = core::array::from_fn(|j| {
                let rest = if N == 2 { problem.b[j] } else { problem.middle[j] + nu * problem.b[j] };
                problem.low[j] + nu * rest
            });
            let n = problem.equation.at(nu).n[0];
            assert!((n - dot(p, p)).abs() <= 1e-13 * n, "N({nu}) = {n}, ‖p‖² = {}", dot(p, p));
            // (C + ν)p = D·b with C = BᵀB
            let cp = transposed_times(&problem.rows, apply(&problem.rows, p));
            let d = problem.equation.determinant(nu);
            let size = d * dot(problem.b, problem.b).sqrt();
            for j in 0..N {
                let error = (cp[j] + nu * p[j] - d * problem.b[j]).abs();
                assert!(error <= 1e-12 * size, "row {j} at ν = {nu}: off by {error:e} of {size:e}");
            }
        }
    }

    #[test]
    fn coefficients_are_those_of_the_nearest_point() -> Result<(), InvalidShape> {
        let (q1, q2) = (DQuat::from_xyzw(0.1, 0.7, -0.3, 0.4), DQuat::from_xyzw(-0.5, 0.2, 0.6, 0.1));
        let e1 = Ellipsoid::new(DVec3::new(0.3, -0.2, 1.0), DVec3::new(1.0, 0.3, 0.1), q1)?;
        let e2 = Ellipsoid::new(DVec3::new(2.0, 1.0, -0.5), DVec3::new(0.2, 0.9, 0.5), q2)?;
        check(&Pair::<3>::new(&e1, &e2));
        check(&Pair::<3>::new(&e2, &e1));
        let e1 = Ellipsoid::new(DVec2::new(0.3, -0.2), DVec2::new(1.0, 0.1), 0.4)?;
        let e2 = Ellipsoid::new(DVec2::new(2.0, 1.0), DVec2::new(0.2, 0.9), -1.3)?;
        check(&Pair::<2>::new(&e1, &e2));
        Ok(())
    }
}
