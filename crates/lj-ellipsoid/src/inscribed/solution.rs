//! From a body in round coordinates to the ellipsoid that is returned, with its certified gap.

use crate::error::InscribedError;
use crate::inscribed::body::Body;
use crate::inscribed::certificate::log_det_at_most;
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::observer::Observer;
use crate::inscribed::primal_dual::{Dual, Maximum, maximize};
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, logarithms, power_of_two_inverse};
use crate::options::{InscribedOptions, Status};
use crate::shape::{Shape, round_inward, shape_from_axes};
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

/// Solves for the body `rows` in `coordinates` about an interior point.
pub(crate) fn solve<D: Dimension>(
    dim: D,
    mut coordinates: Coordinates,
    rows: &Rows,
    body: &dyn Body<D>,
    options: InscribedOptions,
    observer: &mut Observer<'_>,
) -> Result<InscribedSolution<D>, InscribedError> {
    let n = dim.get();
    // { z : pᵢ·z ≤ 1 }.
    let mut p = rows.p.clone();
    for (p, s) in p.chunks_exact_mut(n).zip(&rows.s) {
        if !(*s > 0.0) {
            return Err(InscribedError::NearlyEmpty { ratio: coordinates.aspect() });
        }
        p.iter_mut().for_each(|x| *x /= s);
    }
    let Maximum { point, dual, ended, iterations } = maximize(dim, &p, options, observer)?;
    // Both logarithms of determinants are for lengths in one unit, so that the unit of the input does not matter.
    let per_unit = power_of_two_inverse(coordinates.lengths.iter().copied().fold(0.0, f64::max));
    let y = dual.as_ref().map_or(&[][..], |dual| &dual.y);
    let log_det_bound = match &dual {
        Some(Dual { y, .. }) => {
            // A rounding for each of the divided numbers, and for the quotient.
            let error: Vec<f64> = rows.error.iter().map(|e| e + 4.0 * UNIT_ROUNDOFF).collect();
            log_det_at_most(dim, &p, &point, y, &error, &|i, weight| body.beyond(i, weight))
                + coordinates.log_det_at_most(per_unit)
        }
        None => f64::INFINITY,
    };
    // Grow B until the first constraint is active.
    let growth = point.h.iter().zip(&point.c).fold(f64::INFINITY, |g: f64, (h, c)| g.min((h + c) / h));
    let b: Vec<f64> = point.b.iter().map(|b| growth * b).collect();
    coordinates.shift(&point.d);
    coordinates.stretch(dim, &b);
    let shape_of = |semi_axes: &[f64], axes: &[f64]| {
        shape_from_axes(dim, n, dim.point(semi_axes.iter().copied()), dim.matrix(axes.iter().copied()))
    };
    let mut shape = shape_of(&coordinates.lengths, &coordinates.axes);
    shape.center = dim.point(coordinates.origin.iter().copied());
    body.touch(&mut shape).ok_or(InscribedError::NearlyEmpty { ratio: coordinates.aspect() })?;
    shape = Shape { center: shape.center, ..shape_of(shape.semi_axes.as_ref(), shape.axes.as_ref()) };
    if !(shape.log_det.is_finite() && shape.matrix.as_ref().iter().all(|x| x.is_finite())) {
        return Err(InscribedError::OutOfRange);
    }
    round_inward(dim, &mut shape);
    let [sum, size] = logarithms(shape.semi_axes.as_ref(), per_unit);
    let log_det_gap = 2.0 * (log_det_bound - sum) + 4.0 * UNIT_ROUNDOFF * (size + n as f64);
    // The ellipsoid is proved to be inside and the bound holds for all that are. A negative difference, or NaN, would
    // only prove that numbers left the range in which the errors are bounded.
    let log_det_gap = if log_det_gap >= 0.0 { log_det_gap } else { f64::INFINITY };
    let status = match ended {
        _ if log_det_gap <= options.epsilon => Status::Converged,
        Status::IterationLimit => Status::IterationLimit,
        _ => Status::Stalled,
    };
    let positive = y.iter().enumerate().filter(|(_, y)| **y > 0.0);
    let weights = positive.map(|(index, &weight)| Weight { index, weight }).collect();
    Ok(InscribedSolution { shape, log_det_gap, weights, status, iterations })
}
