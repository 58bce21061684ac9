//! Khachiyan's first-order method with the away steps of Todd and Yıldırım.
//!
//! # References
//! L. G. Khachiyan, *Rounding of polytopes in the real number model of computation*, Math. Oper. Res. 21 (1996).
//! M. J. Todd, E. A. Yıldırım, *On Khachiyan's algorithm for the computation of minimum-volume enclosing ellipsoids*,
//! Discrete Appl. Math. 155 (2007).

use crate::enclosing::iterate::Iterate;
use crate::enclosing::problem::{Observer, Problem};
use crate::enclosing::solution::Solution;
use crate::enclosing::start::Start;
use crate::enclosing::working_set::WorkingSet;
use crate::error::EnclosingError;
use crate::numerics::dimension::{Const, Dimension, Dynamic};
use crate::options::Status;
use crate::points::Copied;
use crate::points::Points;

/// The most moves, unless the caller says otherwise.
const DEFAULT_ITERATIONS: usize = 1_000_000;

/// Moves between two computations of everything from the weights, against the drift of the updates.
const REFRESH: usize = 200;

/// Moves one weight per iteration, by exact line search.
///
/// With ω = qᵀM⁻¹q of every point, take j₊ of largest ω, and j₋ of smallest ω among those with weight. The one farther
/// from optimality (ω = n) moves: u ← (1 − β)u + β·eⱼ with β = (ωⱼ − n)/(n(ωⱼ − 1)), at least −uⱼ/(1 − uⱼ), where the
/// weight is zero (a drop step). Then g = Q·M⁻¹qⱼ gives ω ← (ω − βg²/(1 − β + βωⱼ))/(1 − β).
pub(crate) fn solve(
    problem: &Problem<'_, Copied<Dynamic>>,
    start: Start<Dynamic>,
    observer: &mut Observer<'_>,
) -> Result<Solution<Dynamic>, EnclosingError> {
    let Problem { points, rank, options } = *problem;
    let r = rank.get();
    let n = r as f64 + 1.0;
    let max_iterations = options.max_iterations.unwrap_or(DEFAULT_ITERATIONS);
    let Start { frame, working, scans, .. } = start;
    let mut weights = vec![0.0; points.len()];
    for &i in &working {
        weights[i] = 1.0 / working.len() as f64;
    }
    let all = WorkingSet::new((0..points.len()).collect(), Some(weights));
    let mut at = Iterate::new(points, rank, frame, all, scans)?;
    // Coordinates relative to the mean at the last refresh, in which M starts as the identity: the lifted qᵢ = (zᵢ; 1).
    let lifted = r + 1;
    let mut inverse = vec![0.0; lifted * lifted];
    let mut omega = vec![0.0; points.len()];
    let ended = 'outer: loop {
        at.recenter(points);
        at.scans += 1;
        let gap = at.moments.log_det_gap();
        observer(at.observed(gap));
        if gap <= 0.5 * options.epsilon {
            break Status::Converged;
        }
        inverse.fill(0.0);
        (0..lifted).for_each(|k| inverse[k * lifted + k] = 1.0);
        let Iterate { set, moments, iterations, scans, .. } = &mut at;
        omega.iter_mut().zip(&moments.q).for_each(|(o, q)| *o = q + 1.0);
        for _ in 0..REFRESH {
            if *iterations >= max_iterations {
                break 'outer Status::IterationLimit;
            }
            let (mut plus, mut most) = (0, f64::NEG_INFINITY);
            let (mut minus, mut least) = (0, f64::INFINITY);
            for (i, (&omega, &u)) in omega.iter().zip(&set.u).enumerate() {
                if omega > most {
                    (plus, most) = (i, omega);
                }
                if u > 0.0 && omega < least {
                    (minus, least) = (i, omega);
                }
            }
            let away = n - omega[minus] > omega[plus] - n;
            // The bound of the weights is r·ln((ω₊ − 1)/r); rounding makes it negative at an optimum.
            if r as f64 * libm::log((omega[plus] - 1.0) / r as f64) <= 0.25 * options.epsilon {
                break;
            }
            let j = if away { minus } else { plus };
            let mut beta = (omega[j] - n) / (n * (omega[j] - 1.0));
            if away {
                // A weight of one cannot move away; it belongs to the only point, and then ω = 1.
                beta = beta.max(-set.u[j] / (1.0 - set.u[j]));
            }
            if !(beta.abs() > 0.0 && beta < 1.0) {
                break;
            }
            *iterations += 1;
            *scans += 1;
            match r {
                2 => rank_one_move(Const::<2>, j, beta, &moments.z, &mut inverse, &mut omega),
                3 => rank_one_move(Const::<3>, j, beta, &moments.z, &mut inverse, &mut omega),
                _ => rank_one_move(rank, j, beta, &moments.z, &mut inverse, &mut omega),
            }
            let dropped = away && beta == -set.u[j] / (1.0 - set.u[j]);
            set.u.iter_mut().for_each(|u| *u *= 1.0 - beta);
            set.u[j] = if dropped { 0.0 } else { set.u[j] + beta };
        }
        let before = moments.log_det_scatter;
        let unchanged = moments.q.clone();
        if !at.update() || at.moments.log_det_scatter <= before && at.moments.q == unchanged {
            break Status::Stalled;
        }
    };
    at.set.retain(r, |_, u| u > 0.0);
    at.update();
    at.finish(points, options.epsilon, ended)
}

/// Updates M⁻¹ and every ω for u ← (1 − β)u + β·eⱼ: M' = (1 − β)M + β·qⱼqⱼᵀ, by Sherman and Morrison.
fn rank_one_move<D: Dimension>(dim: D, j: usize, beta: f64, z: &[f64], inverse: &mut [f64], omega: &mut [f64]) {
    let r = dim.get();
    let lifted = r + 1;
    let entry = |z: &[f64], k: usize| if k < r { z[k] } else { 1.0 };
    let zj = &z[j * r..(j + 1) * r];
    // p = M⁻¹qⱼ, so that gᵢ = qᵢᵀp.
    let p: Vec<f64> = (0..lifted).map(|a| (0..lifted).map(|b| inverse[a * lifted + b] * entry(zj, b)).sum()).collect();
    let factor = beta / (1.0 - beta + beta * omega[j]);
    for (omega, z) in omega.iter_mut().zip(z.chunks_exact(r)) {
        let mut g = p[r];
        for k in 0..r {
            g += z[k] * p[k];
        }
        *omega = (*omega - factor * g * g) / (1.0 - beta);
    }
    for a in 0..lifted {
        for b in 0..lifted {
            inverse[a * lifted + b] = (inverse[a * lifted + b] - factor * p[a] * p[b]) / (1.0 - beta);
        }
    }
}
