//! The maximum-volume ellipsoid inside an intersection of half-spaces.

use crate::dimension::{Const, Dimension};
use crate::ellipsoid::{Ellipsoid, reach_along};
use crate::error::InscribedError;
use crate::interior::{Coordinates, Polyhedron, round_coordinates};
use crate::linalg::{UNIT_ROUNDOFF, dot, orthogonalize_rows, power_of_two_inverse, sum_of_logarithms, triangularize};
use crate::maximize::maximize;
use crate::options::{InscribedOptions, Status};
use crate::shape::{Shape, shape_from_axes};
use crate::solution::Weight;

/// The half-space { x : normal·x ≤ offset }. The normal points outward and need not be of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halfspace<const N: usize> {
    /// The outward normal.
    pub normal: [f64; N],
    /// The value of normal·x on the boundary.
    pub offset: f64,
}

/// The maximum-volume ellipsoid inside a body, and the proof of how near to maximal it is.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Inscribed<const N: usize> {
    /// The ellipsoid. Its [`support_value`](Ellipsoid::support_value) along the normal of every given half-space, as evaluated
    /// in `f64`, is at most the offset.
    pub ellipsoid: Ellipsoid<N>,
    /// A certified bound: ln det X of `ellipsoid` exceeds that of the true optimum by at most this. It is twice the bound on
    /// the lack of log-volume. Never negative.
    pub log_det_gap: f64,
    /// The multipliers y that prove the gap, positive ones only, with their half-spaces (facets of the hull, for points),
    /// scaled to sum to one.
    pub weights: Vec<Weight>,
    /// How the computation ended.
    pub status: Status,
    /// Newton steps.
    pub iterations: usize,
}

/// A solved inscribed problem of any dimension.
#[derive(Clone, Debug)]
pub(crate) struct InscribedSolution<D: Dimension> {
    pub(crate) shape: Shape<D>,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
}

impl<const N: usize> Inscribed<N> {
    pub(crate) fn from_solution(solution: InscribedSolution<Const<N>>) -> Self {
        Self {
            ellipsoid: Ellipsoid::from_shape(&solution.shape),
            log_det_gap: solution.log_det_gap,
            weights: solution.weights,
            status: solution.status,
            iterations: solution.iterations,
        }
    }

    /// A certified bound on how much ln(volume) falls short of the largest possible.
    #[must_use]
    pub fn log_volume_gap(&self) -> f64 {
        0.5 * self.log_det_gap
    }
}

/// What an observer of [`inscribed_with`] sees after every Newton step.
#[derive(Clone, Copy, Debug)]
pub struct InscribedIterate {
    /// Newton steps so far.
    pub iteration: usize,
    /// The barrier parameter the step aimed at.
    pub mu: f64,
    /// The bound on ln det X − ln det X* of this iterate; infinite while the multipliers prove nothing.
    pub log_det_gap: f64,
}

/// The ellipsoid of greatest volume inside the intersection of `halfspaces`.
///
/// Normals of any length, redundant and repeated half-spaces are fine.
///
/// # Errors
/// [`InscribedError::Unbounded`] and [`InscribedError::EmptyInterior`] where there is no such ellipsoid;
/// [`InscribedError::ZeroNormal`], [`InscribedError::NonFinite`] and [`InscribedError::Empty`] for bad input.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{Halfspace, InscribedOptions, inscribed};
///
/// // A box of 4 × 2 about (1, 0).
/// let sides = [
///     Halfspace { normal: [1.0, 0.0], offset: 3.0 },
///     Halfspace { normal: [-1.0, 0.0], offset: 1.0 },
///     Halfspace { normal: [0.0, 1.0], offset: 1.0 },
///     Halfspace { normal: [0.0, -1.0], offset: 1.0 },
/// ];
/// let answer = inscribed(&sides, InscribedOptions::default())?;
/// assert!((answer.ellipsoid.center()[0] - 1.0).abs() < 1e-9);
/// assert!((answer.ellipsoid.semi_axes()[0] - 2.0).abs() < 1e-9);
/// # Ok::<(), lj_ellipsoid::InscribedError>(())
/// ```
pub fn inscribed<const N: usize>(
    halfspaces: &[Halfspace<N>],
    options: InscribedOptions,
) -> Result<Inscribed<N>, InscribedError> {
    inscribed_with(halfspaces, options, |_| {})
}

/// [`inscribed`](inscribed()), showing every iterate to `observer`.
///
/// # Errors
/// As [`inscribed`](inscribed()).
pub fn inscribed_with<const N: usize>(
    halfspaces: &[Halfspace<N>],
    options: InscribedOptions,
    observer: impl FnMut(InscribedIterate),
) -> Result<Inscribed<N>, InscribedError> {
    let polyhedron = polyhedron(N, halfspaces.iter().map(|h| (&h.normal[..], h.offset)))?;
    let coordinates = round_coordinates(Const::<N>, &polyhedron)?;
    solve(Const::<N>, &polyhedron, coordinates, 0.0, options, observer).map(Inscribed::from_solution)
}

/// Checks half-spaces and scales each so that the largest coordinate of its normal is between one and two.
pub(crate) fn polyhedron<'a>(
    n: usize,
    halfspaces: impl ExactSizeIterator<Item = (&'a [f64], f64)>,
) -> Result<Polyhedron, InscribedError> {
    if halfspaces.len() == 0 || n == 0 {
        return Err(InscribedError::Empty);
    }
    let mut normals = Vec::with_capacity(halfspaces.len() * n);
    let mut offsets = Vec::with_capacity(halfspaces.len());
    for (index, (normal, offset)) in halfspaces.enumerate() {
        for (coordinate, &value) in normal.iter().chain([&offset]).enumerate() {
            if !value.is_finite() {
                return Err(InscribedError::NonFinite { index, coordinate, value });
            }
        }
        let size = normal.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if size == 0.0 {
            return Err(InscribedError::ZeroNormal { index });
        }
        // A power of two moves no bit: what holds for these rows holds for the given ones.
        let unit = power_of_two_inverse(size);
        normals.extend(normal.iter().map(|x| x * unit));
        offsets.push(offset * unit);
    }
    if offsets.iter().any(|b: &f64| !b.is_finite()) {
        return Err(InscribedError::OutOfRange);
    }
    Ok(Polyhedron { n, normals, offsets, origin: vec![0.0; n] })
}

/// Solves in `coordinates` about an interior point; `rounding` bounds the relative error of the half-spaces there beyond
/// that of their own evaluation.
pub(crate) fn solve<D: Dimension>(
    dim: D,
    polyhedron: &Polyhedron,
    coordinates: Coordinates,
    rounding: f64,
    options: InscribedOptions,
    mut observer: impl FnMut(InscribedIterate),
) -> Result<InscribedSolution<D>, InscribedError> {
    let n = dim.get();
    // pᵢ = Mᵀaᵢ/sᵢ.
    let slacks = polyhedron.slacks(&coordinates.origin);
    let mut p = Vec::with_capacity(polyhedron.normals.len());
    for ((a, _), s) in polyhedron.rows().zip(&slacks) {
        if !(*s > 0.0) {
            return Err(InscribedError::EmptyInterior);
        }
        p.extend((0..n).map(|j| (0..n).map(|i| coordinates.map[i * n + j] * a[i]).sum::<f64>() / s));
    }
    let (point, dual, ended, iterations) = maximize(dim, &p, options, &mut observer)?;
    // Grow B until the first constraint is active.
    let growth = point.h.iter().zip(&point.c).fold(f64::INFINITY, |g: f64, (h, c)| g.min((h + c) / h));
    // The semi-axes are the singular values of M·B; as rows, of its transpose.
    let mut rows = dim.zero_matrix();
    for k in 0..n {
        for i in 0..n {
            rows.as_mut()[k * n + i] =
                growth * (0..n).map(|j| coordinates.map[i * n + j] * point.b[j * n + k]).sum::<f64>();
        }
    }
    triangularize(dim, rows.as_mut());
    orthogonalize_rows(dim, rows.as_mut());
    let mut semi_axes = dim.zero();
    for (row, a) in rows.as_mut().chunks_exact_mut(n).zip(semi_axes.as_mut()) {
        *a = dot(row, row).sqrt();
        row.iter_mut().for_each(|x| *x /= *a);
    }
    let log_det_image = sum_of_logarithms(semi_axes.as_ref().iter().copied());
    let mut shape = shape_from_axes(dim, n, semi_axes, rows);
    shape.center = dim.point(coordinates.image(&point.d).into_iter());
    touch(polyhedron, &mut shape).ok_or(InscribedError::OutOfRange)?;
    let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
    shape.log_det = -2.0 * sum_of_logarithms(semi_axes.iter().copied());
    if !shape.log_det.is_finite() {
        return Err(InscribedError::OutOfRange);
    }
    // What the rounding of the half-spaces' evaluation can do to the bound.
    let gamma = (n + 4) as f64 * UNIT_ROUNDOFF;
    let zero = vec![0.0; polyhedron.len()];
    let y = dual.as_ref().map_or(&zero, |d| &d.y);
    let mut error_of_gap = 0.0;
    for ((a, b), y) in polyhedron.rows().zip(y).filter(|(_, y)| **y > 0.0) {
        let size: f64 = (0..n).map(|k| (a[k] * center[k]).abs() + (a[k] * polyhedron.origin[k]).abs()).sum();
        let error = gamma * (size + b.abs() + semi_axes[0] * dot(a, a).sqrt());
        error_of_gap += y * (error / reach_along(axes, semi_axes, a) + rounding);
    }
    let n_float = n as f64;
    let log_det_gap = dual.as_ref().map_or(f64::INFINITY, |dual| {
        // ln det of M alone is that of M·B·growth less that of B·growth.
        let bound = dual.log_det_bound + log_det_image - point.log_det - n_float * growth.ln();
        let logarithms: f64 = semi_axes.iter().map(|a| a.ln().abs()).sum();
        (2.0 * bound
            + shape.log_det
            + 4.0 * n_float * error_of_gap
            + 8.0 * UNIT_ROUNDOFF * (logarithms + n_float * n_float))
            .max(0.0)
    });
    let status = match ended {
        _ if log_det_gap <= options.epsilon => Status::Converged,
        Status::IterationLimit => Status::IterationLimit,
        _ => Status::Stalled,
    };
    let weights =
        y.iter().enumerate().filter(|(_, y)| **y > 0.0).map(|(index, &weight)| Weight { index, weight }).collect();
    Ok(InscribedSolution { shape, log_det_gap, weights, status, iterations })
}

/// Scales the semi-axes so that the ellipsoid touches the first half-space, the most that keeps it in all of them as evaluated:
/// a·(c − o) + |diag(axes)·R·a| ≤ b. `None` where that leaves nothing.
///
/// A scaling may by its own rounding leave a half-space a rounding behind: then it shrinks once more, twice as far every time.
fn touch<D: Dimension>(polyhedron: &Polyhedron, shape: &mut Shape<D>) -> Option<()> {
    let center: Vec<f64> = shape.center.as_ref().iter().zip(&polyhedron.origin).map(|(c, o)| c - o).collect();
    let room = polyhedron
        .rows()
        .map(|(a, b)| (b - dot(a, &center)) / reach_along(shape.axes.as_ref(), shape.semi_axes.as_ref(), a))
        .fold(f64::INFINITY, f64::min);
    let mut scale = room;
    let mut shrinkage = UNIT_ROUNDOFF;
    for _ in 0..MOST_SHRINKS {
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= scale);
        let within = |(a, b): (&[f64], f64)| {
            dot(a, &center) + reach_along(shape.axes.as_ref(), shape.semi_axes.as_ref(), a) <= b
        };
        if polyhedron.rows().all(within) {
            return Some(());
        }
        scale = 1.0 - shrinkage;
        shrinkage *= 2.0;
    }
    None
}

/// Doubling shrinkages: the last is all of the size.
const MOST_SHRINKS: usize = 54;
