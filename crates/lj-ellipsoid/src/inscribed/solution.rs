//! From a body in round coordinates to the ellipsoid that is returned, with its certified gap.

use crate::error::InscribedError;
use crate::inscribed::Observer;
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::primal_dual::{Dual, Maximum, Point, maximize};
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot, sum_of_logarithms};
use crate::options::{InscribedOptions, Status};
use crate::shape::{Shape, shape_from_axes};
use crate::weight::Weight;

/// A solved inscribed problem of any dimension.
#[derive(Clone, Debug)]
pub(crate) struct InscribedSolution<D: Dimension> {
    pub(crate) shape: Shape<D>,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
}

/// Solves for the body `rows` in `coordinates` about an interior point; `within` scales an ellipsoid so that it touches the body
/// from inside, or answers `None` where nothing is left of it.
pub(crate) fn solve<D: Dimension>(
    dim: D,
    mut coordinates: Coordinates,
    rows: &Rows,
    within: &mut dyn FnMut(&mut Shape<D>) -> Option<()>,
    options: InscribedOptions,
    observer: &mut Observer<'_>,
) -> Result<InscribedSolution<D>, InscribedError> {
    let n = dim.get();
    // { z : pᵢ·z ≤ 1 }.
    let mut p = rows.p.clone();
    for (p, s) in p.chunks_exact_mut(n).zip(&rows.s) {
        if !(*s > 0.0) {
            return Err(InscribedError::EmptyInterior);
        }
        p.iter_mut().for_each(|x| *x /= s);
    }
    let Maximum { point, dual, ended, iterations } = maximize(dim, &p, options, observer)?;
    // Grow B until the first constraint is active.
    let growth = point.h.iter().zip(&point.c).fold(f64::INFINITY, |g: f64, (h, c)| g.min((h + c) / h));
    let b: Vec<f64> = point.b.iter().map(|b| growth * b).collect();
    coordinates.shift(&point.d);
    coordinates.stretch(dim, &b);
    let log_det_image = sum_of_logarithms(coordinates.lengths.iter().copied());
    let semi_axes = dim.point(coordinates.lengths.iter().copied());
    let mut shape = shape_from_axes(dim, n, semi_axes, dim.matrix(coordinates.axes.iter().copied()));
    shape.center = dim.point(coordinates.origin.iter().copied());
    within(&mut shape).ok_or(InscribedError::EmptyInterior)?;
    let semi_axes = shape.semi_axes.as_ref();
    shape.log_det = -2.0 * sum_of_logarithms(semi_axes.iter().copied());
    if !(shape.log_det.is_finite() && shape.matrix.as_ref().iter().all(|x| x.is_finite())) {
        return Err(InscribedError::OutOfRange);
    }
    let log_det_gap = dual.as_ref().map_or(f64::INFINITY, |dual| {
        // ln det of M alone is that of M·B·growth less that of B·growth.
        let bound = dual.log_det_bound + log_det_image - point.log_det - n as f64 * growth.ln();
        let logarithms: f64 = semi_axes.iter().map(|a| a.ln().abs()).sum();
        let rounding = rounding_of_bound(&p, &rows.error, &point, dual);
        (2.0 * bound + shape.log_det + rounding + 8.0 * UNIT_ROUNDOFF * (logarithms + (n * n) as f64)).max(0.0)
    });
    let status = match ended {
        _ if log_det_gap <= options.epsilon => Status::Converged,
        Status::IterationLimit => Status::IterationLimit,
        _ => Status::Stalled,
    };
    let y = dual.as_ref().map_or(&[][..], |dual| &dual.y);
    let positive = y.iter().enumerate().filter(|(_, y)| **y > 0.0);
    let weights = positive.map(|(index, &weight)| Weight { index, weight }).collect();
    Ok(InscribedSolution { shape, log_det_gap, weights, status, iterations })
}

/// What the rounding of the pᵢ does to the bound on 2·ln det B.
///
/// If they stand for pᵢ + δpᵢ then Σyᵢ|B'pᵢ| ≤ Σyᵢ(1 + εᵢ) of every feasible (B', d'), εᵢ the largest |δpᵢ·z| in the body, so
/// the bound on ln det B' grows by N·Σyᵢεᵢ, Σyᵢ = 1. The body lies in the largest ellipsoid grown by N about its centre (John);
/// twice that allows for one that is not yet the largest.
fn rounding_of_bound(p: &[f64], error: &[f64], point: &Point, dual: &Dual) -> f64 {
    let n = point.d.len();
    let radius = dot(&point.d, &point.d).sqrt() + 2.0 * n as f64 * dot(&point.b, &point.b).sqrt();
    let weighted = p.chunks_exact(n).zip(error).zip(&dual.y).filter(|(_, y)| **y > 0.0);
    let moved = |p: &[f64], error: f64| (4.0 * UNIT_ROUNDOFF + error) * (1.0 + radius * dot(p, p).sqrt());
    let sum: f64 = weighted.map(|((p, error), y)| y * moved(p, *error)).sum();
    2.0 * n as f64 * sum
}
