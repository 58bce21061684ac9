//! The analytic centre of half-spaces: the z of least −Σ ln(sᵢ + τ − pᵢ·z).
//!
//! The body contains the unit ball of its Hessian about the centre, and lies in the ball m times as large.

use crate::inscribed::coordinates::Rows;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{cholesky, dot, solve_lower, solve_lower_transpose};

/// The most Newton steps; damped ones always descend by a constant, so they are hundreds only for thousands of
/// half-spaces.
const MOST_STEPS: usize = 500;

/// The largest ratio of the diagonal of the Hessian's factor at which its rounding leaves the coordinates round.
const NEARLY_ROUND: f64 = 1e4;

/// A point near the centre.
pub(crate) struct Centered {
    pub(crate) z: Vec<f64>,
    /// C = L⁻ᵀ with L·Lᵀ the Hessian: the body contains the image of the unit ball under it.
    pub(crate) round: Vec<f64>,
    /// Whether the coordinates were so round already that C is exact except for a little rounding.
    pub(crate) near: bool,
}

/// Follows Newton's method from `z`, inside the half-spaces relaxed by τ; `None` if it is not.
pub(crate) fn center<D: Dimension>(dim: D, rows: &Rows, mut z: Vec<f64>, relaxation: f64) -> Option<Centered> {
    let n = dim.get();
    let mut slacks = vec![0.0; rows.s.len()];
    let mut fresh = slacks.clone();
    let mut l = dim.zero_matrix();
    let l = &mut l.as_mut()[..n * n];
    if !slacks_at(dim, rows, relaxation, &z, &mut slacks) {
        return None;
    }
    for _ in 0..MOST_STEPS {
        let mut step = newton(dim, rows, &slacks, l)?;
        let step = &mut step.as_mut()[..n];
        let decrement = dot(step, step).sqrt();
        if decrement < 0.5 {
            break;
        }
        solve_lower_transpose(dim, l, step);
        // A damped step stays inside except for rounding, against which it is halved.
        let mut damping = 1.0 / (1.0 + decrement);
        let moved = loop {
            let moved: Vec<f64> = z.iter().zip(&*step).map(|(z, d)| z + damping * d).collect();
            if moved == z || slacks_at(dim, rows, relaxation, &moved, &mut fresh) {
                break moved;
            }
            damping *= 0.5;
        };
        if moved == z {
            break;
        }
        z = moved;
        std::mem::swap(&mut slacks, &mut fresh);
    }
    let diagonal = l.iter().step_by(n + 1);
    let (least, most) = diagonal.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), &d| (l.min(d), m.max(d)));
    // Row k of L⁻ᵀ is column k of L⁻¹.
    let mut round = vec![0.0; n * n];
    for (k, row) in round.chunks_exact_mut(n).enumerate() {
        row[k] = 1.0;
        solve_lower(dim, l, row);
    }
    Some(Centered { z, round, near: most < NEARLY_ROUND * least })
}

/// Writes sᵢ + τ − pᵢ·z; false unless all are positive.
fn slacks_at<D: Dimension>(dim: D, rows: &Rows, relaxation: f64, z: &[f64], slacks: &mut [f64]) -> bool {
    let n = dim.get();
    let mut inside = true;
    for ((p, s), slack) in rows.iter().zip(slacks) {
        *slack = s + relaxation;
        for k in 0..n {
            *slack -= p[k] * z[k];
        }
        inside &= *slack > 0.0;
    }
    inside
}

/// Factors the Hessian H = Σpᵢpᵢᵀ/sᵢ² = L·Lᵀ and returns −L⁻¹g, g = Σpᵢ/sᵢ: its length is the decrement √(gᵀH⁻¹g), and
/// the Newton step is L⁻ᵀ times it.
fn newton<D: Dimension>(dim: D, rows: &Rows, slacks: &[f64], l: &mut [f64]) -> Option<D::Point> {
    let n = dim.get();
    l.fill(0.0);
    let mut step = dim.zero();
    let g = &mut step.as_mut()[..n];
    for ((p, _), s) in rows.iter().zip(slacks) {
        let inverse = 1.0 / s;
        for i in 0..n {
            let along = p[i] * inverse;
            g[i] -= along;
            for j in 0..=i {
                l[i * n + j] += along * (p[j] * inverse);
            }
        }
    }
    if !cholesky(dim, l) {
        return None;
    }
    solve_lower(dim, l, g);
    Some(step)
}
