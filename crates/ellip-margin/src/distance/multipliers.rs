//! The Euclidean distance as an equation in two numbers, however thin the bodies are.
//!
//! With d = p₂ − p₁ between the closest points, pₖ = xₖ ± Sₖd/βₖ where βₖ = hₖ(d) = √(dᵀSₖd), so that
//!
//! > d = K⁻¹r, K = I + S₁/β₁ + S₂/β₂, hₖ(d) = βₖ.
//!
//! Setting β to h(d) in turn is iterated reweighting, which never ascends from ½‖d‖² + h₁ + h₂ − r·d, but ends slowly.
//! Newton's method in ln β ends fast: since ∂d/∂βⱼ = K⁻¹qⱼ/βⱼ², qⱼ = Sⱼd,
//!
//! > (I − M)·Δ ln β = ln(h/β), Mᵢⱼ = qᵢᵀK⁻¹qⱼ/(hᵢ²βⱼ),
//!
//! where 0 ≤ Mₖₖ < 1 because K ⪰ Sₖ/βₖ. The stiff part of a thin body is inside K⁻¹ and solved exactly; it does not
//! affect the two numbers. For one pair of needles in ten thousand these steps go round in a circle. Then the same
//! matrix serves Newton's method on the convex
//!
//! > Φ(β) = ½(β₁ + β₂ − rᵀK⁻¹r) = min over d of ½‖d‖² + Σ(dᵀSₖd/βₖ + βₖ)/2 − r·d, ∂Φ/∂βₖ = ½(1 − hₖ²/βₖ²),
//! > ∂²Φ/∂βᵢ∂βⱼ = hᵢ²/(βᵢ²βⱼ)·(I − M)ᵢⱼ, hence (I − M)·diag(β)⁻¹Δβ = ½(1 − β²/h²),
//!
//! which is slower, because β at most grows by half, but always descends.

use convex_support::numerics::elementary::{exp, ln, sqrt};

use crate::numerics::{Factor, Vec, combine, dot};
use crate::pair::Pair;

/// The largest change of ln β in a step: beyond it the linear model is poor.
const TRUST: f64 = 2.0;

/// The steps in ln β before those on Φ.
const SWIFT: usize = 12;

/// Below this residual of ln β the step is the last, and d follows it by its derivative: both leave an error of the
/// residual's square, and the slab across d closes with the square of that.
const SMALL: f64 = 1e-4;

/// d up to a factor, from a first guess of its direction and length, and the number of steps; `None` if numbers leave
/// the range.
pub(super) fn closest<const N: usize>(
    pair: &Pair<N>,
    mut beta: [f64; 2],
    max_iterations: usize,
) -> Option<(Vec<N>, usize)> {
    let r = pair.r().map(|x| -x);
    let shapes = [shape(&pair.axes1, &pair.a1), shape(&pair.axes2, &pair.a2)];
    let mut iterations = 0;
    loop {
        iterations += 1;
        let factor = Factor::new(core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let sum = shapes[0][i][j] / beta[0] + shapes[1][i][j] / beta[1];
                if i == j { 1.0 + sum } else { sum }
            })
        }));
        let d = factor.solve(r);
        let q = [times(&pair.axes1, &pair.a1, d), times(&pair.axes2, &pair.a2, d)];
        let h2 = [dot(q[0], d), dot(q[1], d)];
        let squared_ratio: [f64; 2] = core::array::from_fn(|k| h2[k] / (beta[k] * beta[k]));
        let swift = iterations <= SWIFT;
        let rest = squared_ratio.map(|s| if swift { 0.5 * ln(s) } else { 0.5 - 0.5 / s });
        let largest = rest[0].abs().max(rest[1].abs());
        if !largest.is_finite() {
            return None;
        }
        let k = [factor.solve(q[0]), factor.solve(q[1])];
        let m = |i: usize, j: usize| dot(q[i], k[j]) / (h2[i] * beta[j]);
        let (a, b, c, e) = (1.0 - m(0, 0), -m(0, 1), -m(1, 0), 1.0 - m(1, 1));
        let det = a * e - b * c;
        let newton = [(e * rest[0] - b * rest[1]) / det, (a * rest[1] - c * rest[0]) / det];
        let is_step = det > 0.0 && newton.iter().all(|x| x.is_finite());
        if largest <= SMALL || iterations >= max_iterations {
            let [s, t]: [f64; 2] = core::array::from_fn(|k| if is_step { newton[k] / beta[k] } else { 0.0 });
            return Some((core::array::from_fn(|i| d[i] + (s * k[0][i] + t * k[1][i])), iterations));
        }
        for k in 0..2 {
            beta[k] *= match (is_step, swift) {
                (false, _) => sqrt(squared_ratio[k]),
                (true, true) => exp(newton[k].clamp(-TRUST, TRUST)),
                // Equal to 1 + x to first order, and positive.
                (true, false) if newton[k] < 0.0 => 1.0 / (1.0 - newton[k]),
                (true, false) => 1.0 + newton[k],
            };
        }
    }
}

/// The lower triangle of S = R·diag(a)²·Rᵀ.
fn shape<const N: usize>(axes: &[Vec<N>; N], a: &Vec<N>) -> [Vec<N>; N] {
    let scaled: [Vec<N>; N] = core::array::from_fn(|k| axes[k].map(|x| a[k] * x));
    core::array::from_fn(|i| {
        core::array::from_fn(
            |j| if j <= i { (0..N).fold(0.0, |sum, k| sum + scaled[k][i] * scaled[k][j]) } else { 0.0 },
        )
    })
}

/// S·d.
fn times<const N: usize>(axes: &[Vec<N>; N], a: &Vec<N>, d: Vec<N>) -> Vec<N> {
    combine(*axes, core::array::from_fn(|k| a[k] * (a[k] * dot(axes[k], d))))
}
