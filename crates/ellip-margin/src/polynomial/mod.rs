//! The secular equation as the paper's polynomial (9): fast where the condition is moderate.
//!
//! With C = BᵀB the nearest point of the ball is y(ν) = (C + ν)⁻¹b, b = Cc = Bᵀg. By cofactors
//!
//! > y(ν) = p(ν)/D(ν), D(ν) = det(C + ν), p(ν) = adj(C + ν)·b = det C·c + … + νᴺ⁻¹b,
//!
//! in 3D with the middle term ν(tr C·b − Cb). The coefficients of D are det C = Π(a₂/a₁)², tr C = ‖B‖² and ‖cof B‖²,
//! sums and products of positive terms that keep their digits at any condition. All terms of p have the same sign in
//! each eigendirection of C, so that ‖p‖ has the relative accuracy of its terms. Only the cancellations in Bᵀg and Cb
//! lose digits: a factor of the condition of B. ‖p‖ = D is then an equation in one number,
//!
//! > F(ν) = D(ν)² − N(ν) = 0, N(ν) = ‖p(ν)‖², the paper's polynomial of degree 2N.
//!
//! [`problem`] finds its coefficients, [`equation`] its root.

mod equation;
mod problem;

use self::problem::{Nearest, Problem};
use crate::numerics::Vec;
use crate::pair::Pair;
use crate::secular::Solution;
use crate::{MarginOptions, Status};

/// An answer, and whether rounding can show in its margin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quick<const N: usize> {
    pub(crate) solution: Solution<N>,
    /// Otherwise the margin needs [`Pair::compensated_margin`].
    pub(crate) is_sure: bool,
}

/// Solves from `start` (0 if unknown), reporting each iterate (ν, φ); `None` if digits would be lost or x₁ is near the
/// boundary of E₂.
#[inline]
pub(crate) fn solve<const N: usize>(
    pair: &Pair<N>,
    start: f64,
    options: MarginOptions,
    mut observer: impl FnMut(f64, f64),
) -> Option<Quick<N>> {
    let problem = Problem::new(pair);
    if problem.inside {
        return Some(Quick { solution: Solution::inside(pair.c_and_g().0), is_sure: true });
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
        if error <= options.tolerance() * nu {
            status = Status::Converged;
            break;
        }
    }
    let Nearest { y, margin, is_sure, is_sharp } = problem.nearest(pair, nu);
    is_sharp.then_some(Quick { solution: Solution { nu, y, margin, status, iterations }, is_sure })
}

/// [`solve`] from a cold start without branches, so that a loop over pairs can be vectorised: four steps of Newton's
/// method and one by the series, which is enough for nearly all pairs.
#[inline(always)]
pub(crate) fn solve_straight<const N: usize>(pair: &Pair<N>, tolerance: f64) -> Straight<N> {
    let problem = Problem::new(pair);
    let mut nu = problem.start();
    // Not in a loop: the loop to be vectorised is around this code.
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

/// An answer among those found side by side; all of one type, as vector instructions need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight<const N: usize> {
    /// Whether it is one: 1, or 0 if [`solve`] and its fallbacks have to be asked instead.
    pub(crate) is_answer: f64,
    pub(crate) nu: f64,
    pub(crate) y: Vec<N>,
    pub(crate) margin: f64,
}

/// Roughly the nearest point of E₂, as a point of its ball, at any aspect: to a few digits or to none, which the caller
/// has to find out. `None` if x₁ lies in E₂ or near its boundary.
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
