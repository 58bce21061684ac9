//! The analytic centre of half-spaces: the z of least −Σ ln(sᵢ + τ − pᵢ·z).
//!
//! About it the body contains the unit ball of its Hessian, and lies in the ball m times as large.

use crate::inscribed::coordinates::Rows;
use crate::numerics::dimension::Dynamic;
use crate::numerics::linalg::{cholesky, dot, solve_lower, solve_lower_transpose};

/// Newton steps; damped ones always descend by a constant, so they are hundreds only for thousands of half-spaces.
const MOST_STEPS: usize = 500;

/// The largest ratio of the diagonal of the Hessian's factor at which its rounding leaves the coordinates round.
const NEARLY_ROUND: f64 = 1e4;

/// Near the centre.
pub(crate) struct Centered {
    pub(crate) z: Vec<f64>,
    /// C = L⁻ᵀ with L·Lᵀ the Hessian: it maps the unit ball to where the body contains its image.
    pub(crate) round: Vec<f64>,
    /// The coordinates were so round already that C is exact but for a little rounding.
    pub(crate) near: bool,
}

/// Follows Newton's method from `z`, inside the half-spaces relaxed by τ; `None` where it is not.
pub(crate) fn center(rows: &Rows, mut z: Vec<f64>, relaxation: f64) -> Option<Centered> {
    let n = rows.n;
    let slacks_at = |z: &[f64]| -> Vec<f64> { rows.iter().map(|(p, s)| s + relaxation - dot(p, z)).collect() };
    let mut slacks = slacks_at(&z);
    let mut l = vec![0.0; n * n];
    for _ in 0..MOST_STEPS {
        if slacks.iter().any(|s| !(*s > 0.0)) {
            return None;
        }
        // H = Σpᵢpᵢᵀ/sᵢ², g = Σpᵢ/sᵢ; the step −H⁻¹g has the decrement √(gᵀH⁻¹g) = |L⁻¹g|.
        l.fill(0.0);
        let mut step = vec![0.0; n];
        for ((p, _), s) in rows.iter().zip(&slacks) {
            let inverse = 1.0 / s;
            for i in 0..n {
                let along = p[i] * inverse;
                step[i] -= along;
                for j in 0..=i {
                    l[i * n + j] += along * (p[j] * inverse);
                }
            }
        }
        if !cholesky(Dynamic(n), &mut l) {
            return None;
        }
        solve_lower(Dynamic(n), &l, &mut step);
        let decrement = dot(&step, &step).sqrt();
        if decrement < 0.5 {
            break;
        }
        solve_lower_transpose(Dynamic(n), &l, &mut step);
        // A damped step stays inside but for rounding; it is halved against that.
        let mut damping = 1.0 / (1.0 + decrement);
        let (moved, fresh) = loop {
            let moved: Vec<f64> = z.iter().zip(&step).map(|(z, d)| z + damping * d).collect();
            let fresh = slacks_at(&moved);
            if fresh.iter().all(|s| *s > 0.0) {
                break (moved, fresh);
            }
            damping *= 0.5;
            if damping < f64::EPSILON {
                break (z.clone(), slacks.clone());
            }
        };
        if moved == z {
            break;
        }
        (z, slacks) = (moved, fresh);
    }
    let diagonal = l.iter().step_by(n + 1);
    let (least, most) = diagonal.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), &d| (l.min(d), m.max(d)));
    // Row k of L⁻¹, by columns: L⁻ᵀ stored by rows.
    let mut round = vec![0.0; n * n];
    for (k, row) in round.chunks_exact_mut(n).enumerate() {
        let mut column = vec![0.0; n];
        column[k] = 1.0;
        solve_lower(Dynamic(n), &l, &mut column);
        row.copy_from_slice(&column);
    }
    Some(Centered { z, round, near: most < NEARLY_ROUND * least })
}
