//! The paper's incremental method: inverse iteration for the minimal eigenvalue, from the pose before.
//!
//! Rimon and Boyd, Section 4. With A = [M − λ̂I]⁻¹ for M = [[C, −I], [−bbᵀ, C]], unit vectors x(k) along Ax(k − 1)
//! converge to the eigenvector whose eigenvalue λ is nearest to λ̂. Corrected here (the printed last line normalises
//! x(k) first and returns λ̂ ± 1, and the stop test never fires where λ̂ > λ*): μ = x(k − 1)ᵀAx(k − 1) is an eigenvalue
//! of A, λ = λ̂ + 1/μ, and x(k) takes the sign that agrees with x(k − 1).
//!
//! With G = (C − λ̂I)⁻¹ the blocks (y, z) of Ax for x = (p, q) are, without a 2N×2N inverse,
//!
//! > (C − λ̂I)y − z = p, (C − λ̂I)z − b(bᵀy) = q ⇒ y = Gp + G²q + βG²b, z = Gq + βGb,
//! > β = bᵀy = bᵀ(Gp + G²q)/(1 − bᵀG²b).

use convex_support::{Ellipsoid, Vector};

use crate::margin::{answer, solve};
use crate::numerics::{Vec, add, combine, dot, sub, unit};
use crate::options::check;
use crate::pair::Pair;
use crate::secular::{self, Solution};
use crate::{InvalidQuery, Margin, MarginOptions, Status};

/// The paper's tracker of one pair along a trajectory, for comparison with [`MarginTracker`](crate::MarginTracker).
///
/// Inverse iteration converges to the eigenvalue nearest to the last one, which is the minimal one only while steps
/// are small: about five degrees. Like the paper's, it forms C, whose condition is the square of that of the bodies:
/// at an aspect of 1e8 no digit of it is left, and a residual in terms of C is small for a wrong eigenvalue too. So
/// the result is checked with the bodies themselves. Its point is a point of E₂, so that 1 + m is at most its squared
/// distance from x₁ in the norm of E₁; the plane across the gradient there bounds 1 + m from below. A step where the
/// two differ by more than the tolerance, relative to the lesser of m and 1 + m, or that ends at another eigenvalue
/// or not at all, is solved by [`free_margin`](crate::free_margin) instead, and counted as a fallback.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::paper::InverseIterationTracker;
///
/// let obstacle = Ellipsoid::new(DVec2::new(3.0, 0.0), DVec2::new(1.0, 0.5), 0.2)?;
/// let mut track = InverseIterationTracker::new(1e-6, 14)?;
/// for step in 0..90 {
///     let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(1.5, 0.8), f64::from(step).to_radians())?;
///     assert!(track.step(&link, &obstacle).margin > 0.0);
/// }
/// assert_eq!(track.fallbacks(), 1); // the first step, which has nothing to start from
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseIterationTracker {
    tolerance: f64,
    max_iterations: usize,
    /// λ̂ and the eigenvector's blocks y, z, once known.
    start: Option<(f64, [Vec<3>; 2])>,
    steps: u64,
    iterations: u64,
    fallbacks: u64,
}

impl InverseIterationTracker {
    /// A tracker that stops when the unit eigenvector changes by `tolerance` (the paper's ε), and gives up after
    /// `max_iterations` (its K; ln(1/ε) there).
    ///
    /// # Errors
    /// [`InvalidQuery::Tolerance`] unless the tolerance is positive and finite.
    pub const fn new(tolerance: f64, max_iterations: usize) -> Result<Self, InvalidQuery> {
        match check(tolerance) {
            Ok(tolerance) => Ok(Self { tolerance, max_iterations, start: None, steps: 0, iterations: 0, fallbacks: 0 }),
            Err(why) => Err(why),
        }
    }

    /// The margin of `e1` about `e2` in their present places.
    pub fn step<V: Vector>(&mut self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Margin<V> {
        if V::DIM == 2 {
            let pair = Pair::<2>::new(e1, e2);
            answer(&pair, self.step_in(&pair))
        } else {
            let pair = Pair::<3>::new(e1, e2);
            answer(&pair, self.step_in(&pair))
        }
    }

    /// The number of steps so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.steps
    }

    /// The number of inverse iterations in all steps so far, fallbacks included.
    #[must_use]
    pub const fn iterations(&self) -> u64 {
        self.iterations
    }

    /// The number of steps without an answer of inverse iteration: it ended at another eigenvalue, did not end within
    /// its limit, or had nothing to start from.
    #[must_use]
    pub const fn fallbacks(&self) -> u64 {
        self.fallbacks
    }

    fn step_in<const N: usize>(&mut self, pair: &Pair<N>) -> Solution<N> {
        self.steps += 1;
        let (c, g) = pair.c_and_g();
        if secular::excess(pair, c) <= 0.0 {
            return Solution::inside(c);
        }
        let rows = pair.b();
        let matrix: [Vec<N>; N] =
            core::array::from_fn(|i| core::array::from_fn(|j| (0..N).map(|k| rows[k][i] * rows[k][j]).sum()));
        let b: Vec<N> = core::array::from_fn(|j| (0..N).map(|k| rows[k][j] * g[k]).sum());

        if let Some((shift, start)) = self.start {
            let (found, iterations) = self.iterate(matrix, b, shift, start.map(shrink));
            self.iterations += iterations as u64;
            if let Some((lambda, [y, z])) = found {
                // (10): z = [C − λI]⁻¹b where bᵀy = 1, the point in the ball, of length 1.
                let side = dot(b, y).signum();
                let point = unit(z).map(|z| side * z);
                if self.is_nearest(pair, point) {
                    self.start = Some((lambda, [y, z].map(grow)));
                    let margin = secular::margin(pair, point, -lambda);
                    return Solution { nu: -lambda, y: point, margin, status: Status::Converged, iterations };
                }
            }
        }

        self.fallbacks += 1;
        let solution = solve(pair, 0.0, MarginOptions::default(), |_, _| {});
        // The eigenvector: z = x̄, y = [C − λI]⁻¹z.
        let y = times(inverse(shifted(matrix, -solution.nu)), solution.y);
        let norm = (dot(y, y) + dot(solution.y, solution.y)).sqrt();
        self.start = Some((-solution.nu, [y, solution.y].map(|v| grow(v.map(|v| v / norm)))));
        solution
    }

    /// Whether the point of E₂ with the coordinates `y` in its ball is the nearest to x₁ in the norm of E₁, to the
    /// tolerance.
    ///
    /// With w = x − x₁, β = diag(a₁)⁻¹R₁ᵀw and the normal N = −R₁·diag(a₁)⁻¹β towards x₁, h₁(N) = ‖β‖. Since all of E₂
    /// lies on one side of its tangent plane across N, ‖β‖² ≥ 1 + m ≥ ρ², ρ = (N·(x₁ − x₂) − h₂(N))/‖β‖.
    fn is_nearest<const N: usize>(&self, pair: &Pair<N>, y: Vec<N>) -> bool {
        let w = sub(pair.out_of_ball(y), pair.r());
        let beta: Vec<N> = core::array::from_fn(|i| dot(pair.axes1[i], w) / pair.a1[i]);
        let normal = combine(pair.axes1, core::array::from_fn(|i| -beta[i] / pair.a1[i]));
        let height: Vec<N> = core::array::from_fn(|j| pair.a2[j] * dot(pair.axes2[j], normal));
        let above = dot(beta, beta);
        let rho = (dot(normal, pair.r()) - dot(height, height).sqrt()) / above.sqrt();
        let below = rho.max(0.0) * rho;
        above - below <= self.tolerance * below.min((below - 1.0).abs())
    }

    /// Inverse iteration from the unit vector `x` with the shift λ̂; the minimal eigenvalue with its vector, if it ends
    /// there, and the number of iterations.
    fn iterate<const N: usize>(
        &self,
        c: [Vec<N>; N],
        b: Vec<N>,
        shift: f64,
        mut x: [Vec<N>; 2],
    ) -> (Option<(f64, [Vec<N>; 2])>, usize) {
        let g = inverse(shifted(c, shift));
        let gb = times(g, b);
        let ggb = times(g, gb);
        // If the shift is λ* itself, 1 − bᵀG²b vanishes: any tiny number then gives its eigenvector.
        let pole = 1.0 - dot(b, ggb);
        let pole = if pole == 0.0 { f64::EPSILON } else { pole };
        for iteration in 1..=self.max_iterations {
            let [p, q] = x;
            let gq = times(g, q);
            let y = times(g, add(p, gq));
            let beta = dot(b, y) / pole;
            let ax = [add(y, ggb.map(|v| beta * v)), add(gq, gb.map(|v| beta * v))];
            let mu = dot(p, ax[0]) + dot(q, ax[1]);
            let norm = (dot(ax[0], ax[0]) + dot(ax[1], ax[1])).sqrt().copysign(mu);
            let next = ax.map(|block| block.map(|v| v / norm));
            let change = [sub(next[0], p), sub(next[1], q)];
            x = next;
            if dot(change[0], change[0]) + dot(change[1], change[1]) <= self.tolerance * self.tolerance {
                let lambda = shift + 1.0 / mu;
                // Theorem 3: only the minimal eigenvalue is negative.
                return ((lambda < 0.0 && lambda.is_finite()).then_some((lambda, x)), iteration);
            }
        }
        (None, self.max_iterations)
    }
}

fn shifted<const N: usize>(mut c: [Vec<N>; N], shift: f64) -> [Vec<N>; N] {
    for (i, row) in c.iter_mut().enumerate() {
        row[i] -= shift;
    }
    c
}

fn times<const N: usize>(a: [Vec<N>; N], x: Vec<N>) -> Vec<N> {
    a.map(|row| dot(row, x))
}

/// The inverse of a small matrix by its cofactors, as in the paper's closed form.
fn inverse<const N: usize>(a: [Vec<N>; N]) -> [Vec<N>; N] {
    let cofactor = |i: usize, j: usize| {
        if N == 2 {
            if i == j { a[1 - i][1 - j] } else { -a[1 - i][1 - j] }
        } else {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1]
        }
    };
    let determinant: f64 = (0..N).map(|j| a[0][j] * cofactor(0, j)).sum();
    core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i) / determinant))
}

/// The first coordinates of a block, which has three in either dimension.
fn shrink<const N: usize>(v: Vec<3>) -> Vec<N> {
    core::array::from_fn(|i| v[i])
}

fn grow<const N: usize>(v: Vec<N>) -> Vec<3> {
    core::array::from_fn(|i| if i < N { v[i] } else { 0.0 })
}
