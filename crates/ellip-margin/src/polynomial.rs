//! The secular equation as the paper's polynomial (9): fast where the condition is moderate.
//!
//! With C = BᵀB the nearest point of the ball is y(ν) = (C + ν)⁻¹b, b = Cc = Bᵀg. By cofactors
//!
//! > y(ν) = p(ν)/D(ν), D(ν) = det(C + ν), p(ν) = adj(C + ν)·b = det C·c + … + νᴺ⁻¹b,
//!
//! and in 3D the term between is ν(tr C·b − Cb). The coefficients of D are det C = Π(a₂/a₁)², tr C = ‖B‖² and ‖cof B‖²,
//! sums and products of positive terms that keep their digits at any condition. All terms of p point the same way in
//! each eigendirection of C, so that ‖p‖ has the relative accuracy of its terms. What is lost, at most, are the
//! cancellations in Bᵀg and Cb: a factor of the condition of B. ‖p‖ = D is then an equation in one number,
//!
//! > F(ν) = D(ν)² − N(ν) = 0, N(ν) = ‖p(ν)‖², the paper's polynomial of degree 2N.
//!
//! Far from the root it is approached by Newton's method for 1/φ = D/√N = 1 (Hebden), which is all but linear. Near it, F
//! is inverted as a series: with u = −F₀/F₁, A = F₂/F₁, B = F₃/F₁ of its Taylor coefficients
//!
//! > δ = u − Au² + (2A² − B)u³ + O(u⁴),
//!
//! which takes one division and no root, and squares the error twice over.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::pair::{Pair, Vec, dot, sub};
use crate::secular::Solution;
use crate::{MarginOptions, Status};

/// The largest factor by which a sum of the coefficients may cancel: the relative errors of ν and y stay below this times
/// a few ε, 1e-12. Beyond it the singular basis is worth its price.
const MAX_LOSS: f64 = 2048.0;

/// Sizes of ‖B‖² up to which sixth powers stay far from the range of `f64`.
const MAX_SIZE: f64 = 1e20;

/// Solves from `start` (0 for none known), reporting each iterate (ν, φ); `None` where digits would be lost or x₁ is near
/// the boundary of E₂.
#[inline]
pub(crate) fn solve<const N: usize>(
    pair: &Pair<N>,
    start: f64,
    options: MarginOptions,
    mut observer: impl FnMut(f64, f64),
) -> Option<Solution<N>> {
    let problem = Problem::new(pair);
    if problem.inside {
        return Some(Solution::inside(pair.c_and_g().0));
    }
    if !problem.fits {
        return None;
    }
    let mut nu = if start > 0.0 { start } else { problem.start() };
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    while iterations < options.max_iterations {
        iterations += 1;
        let taylor = problem.equation.at(nu);
        observer(nu, taylor.phi());
        let (step, error) = if taylor.is_near(nu) { taylor.series() } else { (taylor.hebden(), f64::INFINITY) };
        let next = (nu + step).max(0.0);
        if next.is_nan() {
            return None;
        }
        nu = next;
        if error <= options.tolerance * nu {
            status = Status::Converged;
            break;
        }
    }
    let Nearest { y, margin, is_sure, is_sharp } = problem.nearest(pair, nu);
    let margin = if is_sure { margin } else { pair.compensated_margin(y, nu) };
    is_sharp.then_some(Solution { nu, y, margin, status, iterations })
}

/// [`solve`] from a cold start without branches, so that a loop over pairs can be vectorised: four steps of Newton's
/// method and one by the series, which is enough for nearly all pairs.
#[inline(always)]
pub(crate) fn solve_straight<const N: usize>(pair: &Pair<N>, tolerance: f64) -> Straight<N> {
    let problem = Problem::new(pair);
    let mut nu = problem.start();
    // Not in a loop: the loop that is to be vectorised is around this.
    nu = (nu + problem.equation.at(nu).hebden()).max(0.0);
    nu = (nu + problem.equation.at(nu).hebden()).max(0.0);
    nu = (nu + problem.equation.at(nu).hebden()).max(0.0);
    nu = (nu + problem.equation.at(nu).hebden()).max(0.0);
    let taylor = problem.equation.at(nu);
    let (step, error) = taylor.series();
    let is_root = taylor.is_near(nu) & (error <= tolerance * nu);
    let nu = nu + step;
    let Nearest { y, margin, is_sure, is_sharp } = problem.nearest(pair, nu);
    let is_answer = problem.fits & is_root & is_sure & is_sharp;
    Straight { is_answer: if is_answer { 1.0 } else { 0.0 }, nu, y, margin }
}

/// The steps [`solve_straight`] takes.
pub(crate) const STRAIGHT_STEPS: usize = 5;

/// An answer among those found side by side; all of one type, as vector instructions want it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight<const N: usize> {
    /// 1, or 0 where [`solve`] and its fallbacks have to be asked instead.
    pub(crate) is_answer: f64,
    pub(crate) nu: f64,
    pub(crate) y: Vec<N>,
    pub(crate) margin: f64,
}

/// About the nearest point of E₂, as a point of its ball, at any aspect: to a few digits, or to none, which whoever takes it
/// has to find out. `None` where x₁ lies in E₂ or near its boundary.
#[inline]
pub(crate) fn rough<const N: usize>(pair: &Pair<N>) -> Option<Vec<N>> {
    let problem = Problem::new(pair);
    let mut nu = problem.start();
    for _ in 0..3 {
        nu = (nu + problem.equation.at(nu).hebden()).max(0.0);
    }
    let y = problem.nearest(pair, nu).y;
    (!problem.inside && y.iter().all(|x| x.is_finite())).then_some(y)
}

/// The equation of a pair, and what its solution is turned into an answer with.
#[derive(Clone, Copy, Debug)]
struct Problem<const N: usize> {
    /// x₁ lies in E₂, by far.
    inside: bool,
    /// No digits are lost, and x₁ lies outside E₂ by far.
    fits: bool,
    equation: Equation<N>,
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
    /// Straight through: no branch depends on the numbers, so that several pairs can be set up side by side.
    #[inline(always)]
    fn new(pair: &Pair<N>) -> Self {
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
                n: [n0, 2.0 * dot(low, middle), mm + 2.0 * dot(low, b), 2.0 * dot(middle, b), bb],
                d: [det, squares(&cofactors), norm, 1.0],
            };
            keeps = norm * norm * bb < MAX_LOSS * MAX_LOSS * mm;
        } else {
            middle = [0.0; N];
            equation = Equation { n: [n0, 2.0 * dot(low, b), bb, 0.0, 0.0], d: [det, norm, 1.0, 0.0] };
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
    fn start(&self) -> f64 {
        let [n0, n1, ..] = self.equation.n;
        let [d0, d1, ..] = self.equation.d;
        let bb = self.equation.n[2 * N - 2];
        let from_zero = Taylor { n: [n0, n1, 0.0, 0.0], d: [d0, d1, 0.0, 0.0] }.hebden();
        (bb.sqrt() - self.bcb / bb).max(from_zero)
    }

    /// The answer to ν.
    #[inline(always)]
    fn nearest(&self, pair: &Pair<N>, nu: f64) -> Nearest<N> {
        let inverse = 1.0 / self.equation.determinant(nu);
        let y: Vec<N> = core::array::from_fn(|j| {
            let p = if N == 2 {
                self.low[j] + nu * self.b[j]
            } else {
                self.low[j] + nu * (self.middle[j] + nu * self.b[j])
            };
            p * inverse
        });
        // The Lagrangian ‖w‖² − 1 + ν(‖y‖² − 1) is stationary in y: what y has of errors enters squared.
        let w = sub(apply(&self.rows, y), self.g);
        let squared = dot(w, w);
        let margin = (squared - 1.0) + nu * (dot(y, y) - 1.0);
        // An error of x* − x₁ in space of ε(‖v‖ + ‖r‖) changes m by its product with ∂m/∂x₁ = 2R₁·diag(a₁)⁻¹w: not by 32ε·m?
        let v: Vec<N> = core::array::from_fn(|j| pair.a2[j] * y[j]);
        let pw: Vec<N> = core::array::from_fn(|i| self.i1[i] * w[i]);
        let is_sure = (dot(v, v) + dot(self.r, self.r)) * dot(pw, pw) < 1024.0 * (margin * margin);
        // The margin's error is ‖Bδ‖² for an error δ of y, here up to 1e-12: it must stay below the last digit.
        Nearest { y, margin, is_sure, is_sharp: self.norm < 1e9 * (1.0 + margin) }
    }
}

/// What a root is turned into.
#[derive(Clone, Copy, Debug)]
struct Nearest<const N: usize> {
    y: Vec<N>,
    margin: f64,
    /// Rounding cannot show in the margin.
    is_sure: bool,
    /// The errors of y cannot.
    is_sharp: bool,
}

/// N(ν) = D(ν)², by its coefficients from the constant one up.
#[derive(Clone, Copy, Debug)]
struct Equation<const N: usize> {
    n: [f64; 5],
    d: [f64; 4],
}

impl<const N: usize> Equation<N> {
    #[inline(always)]
    fn determinant(&self, nu: f64) -> f64 {
        let d = &self.d;
        if N == 2 { d[0] + nu * (d[1] + nu) } else { d[0] + nu * (d[1] + nu * (d[2] + nu)) }
    }

    /// The Taylor coefficients of N and D about ν, up to the third.
    #[inline(always)]
    fn at(&self, nu: f64) -> Taylor {
        let Self { n, d } = self;
        let square = nu * nu;
        if N == 2 {
            Taylor {
                n: [(n[0] + nu * n[1]) + square * n[2], n[1] + 2.0 * nu * n[2], n[2], 0.0],
                d: [(d[0] + nu * d[1]) + square, d[1] + 2.0 * nu, 1.0, 0.0],
            }
        } else {
            let n4 = nu * n[4];
            Taylor {
                n: [
                    (n[0] + nu * n[1]) + square * (n[2] + nu * (n[3] + n4)),
                    (n[1] + 2.0 * nu * n[2]) + square * (3.0 * n[3] + 4.0 * n4),
                    n[2] + nu * (3.0 * n[3] + 6.0 * n4),
                    n[3] + 4.0 * n4,
                ],
                d: [
                    (d[0] + nu * d[1]) + square * (d[2] + nu),
                    d[1] + nu * (2.0 * d[2] + 3.0 * nu),
                    d[2] + 3.0 * nu,
                    1.0,
                ],
            }
        }
    }
}

/// N and D about some ν.
#[derive(Clone, Copy, Debug)]
struct Taylor {
    n: [f64; 4],
    d: [f64; 4],
}

impl Taylor {
    /// F₀ to F₃.
    #[inline(always)]
    fn difference(&self) -> [f64; 4] {
        let Self { n, d } = self;
        [
            d[0] * d[0] - n[0],
            2.0 * d[0] * d[1] - n[1],
            (d[1] * d[1] + 2.0 * d[0] * d[2]) - n[2],
            2.0 * (d[1] * d[2] + d[0] * d[3]) - n[3],
        ]
    }

    /// Whether the series converges fast, and to the root on the rising branch of F: |Au| < 1/32 and |u| < ν/16.
    #[inline(always)]
    fn is_near(&self, nu: f64) -> bool {
        let [f0, f1, f2, _] = self.difference();
        (32.0 * (f0 * f2).abs() < f1 * f1) & (16.0 * f0.abs() < nu * f1)
    }

    /// δ, and about what it lacks.
    #[inline(always)]
    fn series(&self) -> (f64, f64) {
        let [f0, f1, f2, f3] = self.difference();
        let inverse = 1.0 / f1;
        let (u, a, b) = (-f0 * inverse, f2 * inverse, f3 * inverse);
        let (first, second) = (a * u, b * (u * u));
        let ratio = first.abs() + second.abs();
        (u * ((1.0 - first) + (2.0 * (first * first) - second)), 5.0 * (ratio * ratio * ratio) * u.abs())
    }

    /// Newton's step (1 − h)/h′ for h = 1/φ, where h′ = (D′ − DN′/2N)/√N.
    #[inline(always)]
    fn hebden(&self) -> f64 {
        let ([n0, n1, ..], [d0, d1, ..]) = (self.n, self.d);
        (n0.sqrt() - d0) * (2.0 * n0 / (2.0 * n0 * d1 - d0 * n1))
    }

    /// φ.
    #[inline(always)]
    fn phi(&self) -> f64 {
        self.n[0].sqrt() / self.d[0]
    }
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
