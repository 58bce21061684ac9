//! How deep is an intersection of half-spaces: the linear program of the largest ball.
//!
//! > max t subject to pᵢ·z + t ≤ sᵢ, |pᵢ| = 1,
//!
//! by a primal–dual interior-point method whose primal iterates w = (z, t) are always feasible: with slacks c and
//! multipliers y, each step solves GᵀDG·Δw = e − Gᵀ(σμ/c), D = diag(y/c), G's rows (pᵢ, 1), e the unit vector of t. The
//! optimum is between t and t + mμ once the multipliers are feasible.

use crate::inscribed::coordinates::Rows;
use crate::numerics::dimension::Dynamic;
use crate::numerics::linalg::{cholesky, dot, power_of_two_inverse, solve_factored};

/// Depths below this share of the largest offset are too little for the program to tell.
const THIN: f64 = 1e-6;

/// The share that rounding and the error of the multipliers cannot reach.
const NOTHING: f64 = 1e-7;

/// An origin as deep as this share of the largest offset is a point well inside.
const DEEP: f64 = 1e-3;

/// What the program found.
pub(crate) enum Depth {
    /// A point well inside: the origin if it is, else near the centre of a largest ball.
    Inside(Vec<f64>),
    /// The intersection is thin, or empty by little. The point is inside the half-spaces relaxed by so much.
    Thin { at: Vec<f64>, relaxation: f64 },
    /// There is no common point.
    Empty,
}

/// The iterate of the program.
struct ChebyshevIterate {
    /// (z, t).
    w: Vec<f64>,
    /// Multipliers.
    y: Vec<f64>,
    /// cᵢ = sᵢ − t − pᵢ·z.
    c: Vec<f64>,
}

/// How deep the intersection is; rows of unit length.
///
/// The systems are of numbers per length, and Cholesky takes their roots: the digits of the root of a length are
/// others in another unit, and so all is measured in a power of two near the largest offset.
pub(crate) fn depth(rows: &Rows) -> Depth {
    let per_unit = power_of_two_inverse(rows.s.iter().fold(0.0, |s: f64, b| s.max(b.abs())));
    let back = |z: Vec<f64>| z.into_iter().map(|x| x / per_unit).collect();
    match depth_in_unit(&Rows { s: rows.s.iter().map(|b| b * per_unit).collect(), ..rows.clone() }) {
        Depth::Inside(z) => Depth::Inside(back(z)),
        Depth::Thin { at, relaxation } => Depth::Thin { at: back(at), relaxation: relaxation / per_unit },
        Depth::Empty => Depth::Empty,
    }
}

fn depth_in_unit(rows: &Rows) -> Depth {
    let n = rows.n;
    let m = rows.s.len();
    let scale = rows.s.iter().fold(0.0, |s: f64, b| s.max(b.abs()));
    let least = rows.s.iter().fold(f64::INFINITY, |s: f64, b| s.min(*b));
    if least > DEEP * scale {
        return Depth::Inside(vec![0.0; n]);
    }
    if !(scale > 0.0) {
        return Depth::Empty;
    }
    let (thin, nothing) = (THIN * scale, NOTHING * scale);
    let mut w = vec![0.0; n + 1];
    w[n] = least - scale;
    let c = rows.s.iter().map(|b| b - w[n]).collect();
    let mut at = ChebyshevIterate { w, y: vec![1.0 / m as f64; m], c };
    for _ in 0..100 {
        let t = at.w[n];
        let mu = dot(&at.c, &at.y) / m as f64;
        let upper = t + m as f64 * mu;
        if at.dual_residual(rows) < 1e-8 {
            if t > thin && upper < 1.5 * t {
                break;
            }
            if upper < -nothing {
                return Depth::Empty;
            }
            if upper < thin && t > -thin {
                break;
            }
        }
        if !at.step(rows, 0.1 * mu) {
            break;
        }
    }
    let t = at.w[n];
    let mut z = at.w;
    z.truncate(n);
    if t > thin { Depth::Inside(z) } else { Depth::Thin { at: z, relaxation: 2.0 * thin.max(-t) } }
}

impl ChebyshevIterate {
    /// |Gᵀy − e|.
    fn dual_residual(&self, rows: &Rows) -> f64 {
        let mut residual = vec![0.0; self.w.len()];
        for ((p, _), y) in rows.iter().zip(&self.y) {
            for (r, p) in residual.iter_mut().zip(p.iter().chain(&[1.0])) {
                *r += p * y;
            }
        }
        residual[rows.n] -= 1.0;
        dot(&residual, &residual).sqrt()
    }

    /// One step that aims at the products cᵢyᵢ = `target`; false where the system is not numerically definite.
    fn step(&mut self, rows: &Rows, target: f64) -> bool {
        let Self { w, y, c } = self;
        let k = w.len();
        let mut hessian = vec![0.0; k * k];
        let mut step = vec![0.0; k];
        step[k - 1] = 1.0;
        let mut g = vec![1.0; k];
        for (((p, _), y), c) in rows.iter().zip(&*y).zip(&*c) {
            g[..k - 1].copy_from_slice(p);
            for i in 0..k {
                step[i] -= g[i] * target / c;
                for j in 0..=i {
                    hessian[i * k + j] += g[i] * g[j] * y / c;
                }
            }
        }
        if !cholesky(Dynamic(k), &mut hessian) {
            return false;
        }
        solve_factored(Dynamic(k), &hessian, &mut step);
        let dc: Vec<f64> = rows.iter().map(|(p, _)| -(dot(p, &step[..k - 1]) + step[k - 1])).collect();
        let dy: Vec<f64> = y.iter().zip(&*c).zip(&dc).map(|((y, c), dc)| (target - c * y - y * dc) / c).collect();
        let length = |x: &[f64], d: &[f64]| {
            x.iter().zip(d).filter(|(_, d)| **d < 0.0).fold(1.0, |t: f64, (x, d)| t.min(-0.99 * x / d))
        };
        let (primal, dual) = (length(c, &dc), length(y, &dy));
        w.iter_mut().zip(&step).for_each(|(w, d)| *w += primal * d);
        y.iter_mut().zip(&dy).for_each(|(y, d)| *y += dual * d);
        for ((p, s), c) in rows.iter().zip(c) {
            let fresh = s - (dot(p, &w[..k - 1]) + w[k - 1]);
            *c = if fresh > 0.0 { fresh } else { *c * 0.01 };
        }
        true
    }
}
