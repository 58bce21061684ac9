//! The maximum-volume ellipsoid inside an intersection of half-spaces.
//!
//! With pᵢ the normals divided by their slacks at an interior point, in coordinates centred there, the body is
//! { z : pᵢ·z ≤ 1 } and the ellipsoid { d + B·u : |u| ≤ 1 } lies in it where
//!
//! > maximise ln det B over B ≻ 0 and d, subject to cᵢ = 1 − pᵢ·d − hᵢ ≥ 0, hᵢ = |B·pᵢ|.
//!
//! Primal–dual Newton on the conditions B⁻¹ = Σyᵢ·sym(vᵢpᵢᵀ) with vᵢ = B·pᵢ/hᵢ, Σyᵢpᵢ = 0, cᵢyᵢ = μ, μ → 0, in the
//! N(N + 3)/2 unknowns of (B, d): the multipliers are eliminated, so a step costs time linear in the number of half-spaces.
//!
//! Certificate: for y ≥ 0 with Σyᵢpᵢ = 0 and unit gᵢ, S = Σyᵢ·sym(pᵢgᵢᵀ) ≻ 0, any feasible (B, d) has tr(B·S) ≤ Σyᵢhᵢ ≤ Σyᵢ,
//! so by the inequality of the means ln det B ≤ N·ln(Σy/N) − ln det S.
//!
//! # References
//! Y. Zhang, L. Gao, *On numerical solution of the maximum volume ellipsoid problem*, SIAM J. Optim. 14 (2003), treat the
//! same conditions with m × m systems.

use crate::dimension::{Const, Dimension, Dynamic, LANES};
use crate::ellipsoid::Ellipsoid;
use crate::error::InscribedError;
use crate::interior::{Coordinates, Polyhedron, round_coordinates};
use crate::linalg::{
    UNIT_ROUNDOFF, cholesky, dot, orthogonalize_rows, solve_lower, solve_lower_transpose, triangularize,
};
use crate::options::{InscribedOptions, Status};
use crate::solution::{Shape, Weight, shape_from_axes};

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
    /// The ellipsoid. Its reach normal·c + |diag(a)·Rᵀ·normal| in every given half-space is at most the offset, with the
    /// rounding of the evaluation taken into account.
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
pub(crate) struct InscribedSolution {
    pub(crate) shape: Shape,
    pub(crate) log_det_gap: f64,
    pub(crate) weights: Vec<Weight>,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
}

impl<const N: usize> Inscribed<N> {
    pub(crate) fn from_solution(solution: InscribedSolution) -> Self {
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
    let coordinates = round_coordinates(&polyhedron)?;
    solve(Const::<N>, &polyhedron, coordinates, 0.0, options, observer).map(Inscribed::from_solution)
}

/// Checks half-spaces and brings their normals to unit length.
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
        let length = normal.iter().map(|x| (x / size) * (x / size)).sum::<f64>().sqrt();
        normals.extend(normal.iter().map(|x| x / size / length));
        offsets.push(offset / size / length);
    }
    if offsets.iter().any(|b: &f64| !b.is_finite()) {
        return Err(InscribedError::OutOfRange);
    }
    Ok(Polyhedron { n, normals, offsets, origin: vec![0.0; n] })
}

/// The unknowns of the program and what follows from them.
struct Point {
    /// B, symmetric, n × n.
    b: Vec<f64>,
    d: Vec<f64>,
    /// vᵢ = B·pᵢ/hᵢ.
    v: Vec<f64>,
    h: Vec<f64>,
    /// cᵢ = 1 − pᵢ·d − hᵢ.
    c: Vec<f64>,
    log_det: f64,
}

impl Point {
    /// Evaluates everything at (B, d); `None` unless B ≻ 0 and all cᵢ > 0.
    fn at<D: Dimension>(dim: D, p: &[f64], b: Vec<f64>, d: Vec<f64>) -> Option<Self> {
        let n = dim.get();
        let mut factor = b.clone();
        let log_det = cholesky(dim, &mut factor)?;
        let mut v = vec![0.0; p.len()];
        let m = p.len() / n;
        let (mut h, mut c) = (Vec::with_capacity(m), Vec::with_capacity(m));
        for (p, v) in p.chunks_exact(n).zip(v.chunks_exact_mut(n)) {
            let mut square = 0.0;
            let mut along = 0.0;
            for i in 0..n {
                let mut sum = 0.0;
                for j in 0..n {
                    sum += b[i * n + j] * p[j];
                }
                v[i] = sum;
                square += sum * sum;
                along += p[i] * d[i];
            }
            let length = square.sqrt();
            v.iter_mut().for_each(|v| *v /= length);
            let slack = 1.0 - along - length;
            if !(slack > 0.0) {
                return None;
            }
            h.push(length);
            c.push(slack);
        }
        Some(Self { b, d, v, h, c, log_det })
    }
}

/// The bound on ln det B that multipliers prove.
struct Dual {
    log_det_bound: f64,
    /// Multipliers with Σyᵢpᵢ = 0, scaled to sum to one.
    y: Vec<f64>,
}

/// Corrects y to Σyᵢpᵢ = 0, in proportion to itself so that no sign changes, and evaluates the bound.
fn dual_bound<D: Dimension>(dim: D, p: &[f64], v: &[f64], y: &[f64]) -> Option<Dual> {
    let n = dim.get();
    // y'ᵢ = yᵢ(1 − pᵢ·λ), (Σyᵢpᵢpᵢᵀ)λ = Σyᵢpᵢ.
    let mut y = y.to_vec();
    for _ in 0..2 {
        let mut residual = vec![0.0; n];
        let mut gram = vec![0.0; n * n];
        for (p, &y) in p.chunks_exact(n).zip(&y) {
            for i in 0..n {
                residual[i] += y * p[i];
                for j in 0..=i {
                    gram[i * n + j] += y * p[i] * p[j];
                }
            }
        }
        cholesky(dim, &mut gram)?;
        solve_lower(dim, &gram, &mut residual);
        solve_lower_transpose(dim, &gram, &mut residual);
        for (p, y) in p.chunks_exact(n).zip(&mut y) {
            *y *= 1.0 - dot(p, &residual);
            if !(*y >= 0.0) {
                return None;
            }
        }
    }
    let total: f64 = y.iter().sum();
    y.iter_mut().for_each(|y| *y /= total);
    let mut s = vec![0.0; n * n];
    for ((p, v), &y) in p.chunks_exact(n).zip(v.chunks_exact(n)).zip(&y) {
        for i in 0..n {
            for j in 0..=i {
                s[i * n + j] += 0.5 * y * (p[i] * v[j] + p[j] * v[i]);
            }
        }
    }
    let log_det = cholesky(dim, &mut s)?;
    Some(Dual { log_det_bound: -(n as f64) * (n as f64).ln() - log_det, y })
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
) -> Result<InscribedSolution, InscribedError> {
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
    let center = coordinates.image(&point.d);
    // The semi-axes are the singular values of M·B; as rows, of its transpose.
    let mut rows = vec![0.0; n * n];
    for k in 0..n {
        for i in 0..n {
            rows[k * n + i] = growth * (0..n).map(|j| coordinates.map[i * n + j] * point.b[j * n + k]).sum::<f64>();
        }
    }
    triangularize(n, &mut rows);
    orthogonalize_rows(n, &mut rows);
    let mut axes: Vec<(f64, Vec<f64>)> = rows
        .chunks_exact(n)
        .map(|row| {
            let length = dot(row, row).sqrt();
            (length, row.iter().map(|x| x / length).collect())
        })
        .collect();
    let log_det_image: f64 = axes.iter().map(|a| a.0.ln()).sum();
    // How much room the half-spaces leave, with the rounding of this evaluation taken off.
    let gamma = (n + 4) as f64 * UNIT_ROUNDOFF;
    let mut room = f64::INFINITY;
    let mut error_of_gap = 0.0;
    let zero = vec![0.0; polyhedron.len()];
    let y = dual.as_ref().map_or(&zero, |d| &d.y);
    for ((a, b), y) in polyhedron.rows().zip(y) {
        let reach = axes.iter().map(|(length, axis)| (length * dot(axis, a)).powi(2)).sum::<f64>().sqrt();
        let (mut along, mut size) = (0.0, b.abs());
        for k in 0..n {
            along += a[k] * (center[k] - polyhedron.origin[k]);
            size += (a[k] * (center[k].abs() + polyhedron.origin[k].abs())).abs();
        }
        let longest = axes.iter().fold(0.0, |m: f64, x| m.max(x.0));
        let error = gamma * (size + longest);
        room = room.min((b - along - error) / reach);
        error_of_gap += y * (error / reach + rounding);
    }
    let room = room * (1.0 - 4.0 * UNIT_ROUNDOFF);
    if !(room > 0.0 && room.is_finite()) {
        return Err(InscribedError::OutOfRange);
    }
    axes.iter_mut().for_each(|axis| axis.0 *= room);
    let mut shape = shape_from_axes(n, axes);
    shape.center = center;
    if !shape.log_det.is_finite() {
        return Err(InscribedError::OutOfRange);
    }
    let n_float = n as f64;
    let log_det_gap = dual.as_ref().map_or(f64::INFINITY, |dual| {
        // ln det of M alone is that of M·B·growth less that of B·growth.
        let bound = dual.log_det_bound + log_det_image - point.log_det - n_float * growth.ln();
        let logarithms: f64 = shape.semi_axes.iter().map(|a| a.ln().abs()).sum();
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

/// The complementarity below which the dual bound is evaluated.
const WORTH_BOUNDING: f64 = 1e-3;

type Maximum = (Point, Option<Dual>, Status, usize);

/// The primal–dual iteration over { z : pᵢ·z ≤ 1 }.
fn maximize<D: Dimension>(
    dim: D,
    p: &[f64],
    options: InscribedOptions,
    observer: &mut impl FnMut(InscribedIterate),
) -> Result<Maximum, InscribedError> {
    let n = dim.get();
    let m = p.len() / n;
    let reach = p.chunks_exact(n).fold(0.0, |r: f64, p| r.max(dot(p, p).sqrt()));
    let mut b = vec![0.0; n * n];
    (0..n).for_each(|k| b[k * n + k] = 0.5 / reach);
    let mut point = Point::at(dim, p, b, vec![0.0; n]).ok_or(InscribedError::OutOfRange)?;
    // Σyᵢhᵢ = N at the solution.
    let mut mu = n as f64 / m as f64;
    let mut y: Vec<f64> = point.c.iter().map(|c| mu / c).collect();
    let mut best: (f64, Option<Dual>) = (f64::INFINITY, None);
    let mut system = System::new(n);
    let mut centring = 0.3;
    let mut without_progress = 0;
    let mut iteration = 0;
    let ended = loop {
        let growth = point.h.iter().zip(&point.c).fold(f64::INFINITY, |g: f64, (h, c)| g.min((h + c) / h));
        // The complementarity Σyᵢcᵢ is about half the gap: while it is large the bound is not worth its price.
        let dual = if dot(&point.c, &y) < WORTH_BOUNDING { dual_bound(dim, p, &point.v, &y) } else { None };
        let gap = dual
            .as_ref()
            .map_or(f64::INFINITY, |dual| 2.0 * (dual.log_det_bound - point.log_det - n as f64 * growth.ln()));
        observer(InscribedIterate { iteration, mu, log_det_gap: gap.max(0.0) });
        if gap < best.0 {
            without_progress = 0;
            best = (gap, dual);
        } else {
            without_progress += 1;
        }
        if gap <= 0.5 * options.epsilon {
            break Status::Converged;
        }
        if iteration >= options.max_iterations {
            break Status::IterationLimit;
        }
        if without_progress > 10 && best.0 < 1e-3 || without_progress > 60 {
            break Status::Stalled;
        }
        iteration += 1;
        mu = centring * dot(&point.c, &y) / m as f64;
        if !system.assemble(dim, p, &point, &y, mu) {
            break Status::Stalled;
        }
        let (db, dd) = system.step(n);
        // Δyᵢ = (μ − yᵢcᵢ − yᵢ∇cᵢᵀΔ)/cᵢ, ∇cᵢᵀΔ = −vᵢᵀΔB·pᵢ − pᵢᵀΔd.
        let mut dual_length: f64 = 1.0;
        let mut dy = Vec::with_capacity(m);
        for i in 0..m {
            let (p, v) = (&p[i * n..(i + 1) * n], &point.v[i * n..(i + 1) * n]);
            let mut change = 0.0;
            for j in 0..n {
                change -= p[j] * dd[j] + v[j] * dot(&db[j * n..(j + 1) * n], p);
            }
            let d = (mu - y[i] * point.c[i] - y[i] * change) / point.c[i];
            if d < 0.0 {
                dual_length = dual_length.min(-0.995 * y[i] / d);
            }
            dy.push(d);
        }
        // The longest of 1, 0.98, 0.96, 0.92, … that keeps off the boundary.
        let (mut primal_length, mut shortfall) = (1.0, 0.02);
        let moved = loop {
            let b = point.b.iter().zip(&db).map(|(x, d)| x + primal_length * d).collect();
            let d = point.d.iter().zip(&dd).map(|(x, d)| x + primal_length * d).collect();
            match Point::at(dim, p, b, d) {
                Some(next) if next.c.iter().zip(&point.c).all(|(new, old)| *new >= 0.002 * old) => break Some(next),
                _ if primal_length < 1e-9 => break None,
                _ if shortfall < 0.5 => {
                    primal_length = 1.0 - shortfall;
                    shortfall *= 2.0;
                }
                _ => primal_length *= 0.6,
            }
        };
        let Some(moved) = moved else { break Status::Stalled };
        point = moved;
        y.iter_mut().zip(&dy).for_each(|(y, d)| *y += dual_length * d);
        // Near the end full steps are taken and μ may fall fast; a bold step from afar costs several to recover.
        centring = match primal_length.min(dual_length) {
            length if length > 0.95 && dot(&point.c, &y) < 0.1 => 0.005,
            length if length > 0.7 => 0.05,
            length if length > 0.3 => 0.3,
            // Products yᵢcᵢ too uneven for progress: even them out.
            _ => 1.0,
        };
    };
    Ok((point, best.1, ended, iteration))
}

/// The Newton system in the N(N + 1)/2 entries of B on and above the diagonal and the N of d.
struct System {
    size: usize,
    matrix: Vec<f64>,
    right: Vec<f64>,
    gradients: Vec<f64>,
}

impl System {
    fn new(n: usize) -> Self {
        let size = n * (n + 3) / 2;
        Self { size, matrix: vec![0.0; size * size], right: vec![0.0; size], gradients: Vec::new() }
    }

    /// Assembles and solves
    ///
    /// > (∇²f + Σyᵢ∇²hᵢ + Σ(yᵢ/cᵢ)∇cᵢ∇cᵢᵀ)·Δ = −∇f + Σ(μ/cᵢ)∇cᵢ, f = −ln det B.
    ///
    /// Along Δ: ∇f = −tr(B⁻¹Δ), ∇²f = tr(B⁻¹ΔB⁻¹Δ), ∇hᵢ = vᵢᵀΔpᵢ, ∇²hᵢ = (|Δpᵢ|² − (vᵢᵀΔpᵢ)²)/hᵢ.
    fn assemble<D: Dimension>(&mut self, dim: D, p: &[f64], point: &Point, y: &[f64], mu: f64) -> bool {
        let n = dim.get();
        let size = self.size;
        let entries = size - n;
        let Some(inverse) = inverse(dim, &point.b) else { return false };
        // −∇cᵢ = ∇hᵢ and pᵢ, unknown by unknown, so that the sums over the half-spaces run along lanes.
        let m = y.len();
        let gradients = &mut self.gradients;
        gradients.resize(size * m, 0.0);
        let mut a = 0;
        for j in 0..n {
            for k in j..n {
                for (i, g) in gradients[a * m..(a + 1) * m].iter_mut().enumerate() {
                    let (p, v) = (&p[i * n..(i + 1) * n], &point.v[i * n..(i + 1) * n]);
                    *g = if j == k { v[j] * p[j] } else { v[j] * p[k] + v[k] * p[j] };
                }
                a += 1;
            }
        }
        for j in 0..n {
            for (i, g) in gradients[(entries + j) * m..(entries + j + 1) * m].iter_mut().enumerate() {
                *g = p[i * n + j];
            }
        }
        let ratio: Vec<f64> = y.iter().zip(&point.c).map(|(y, c)| y / c).collect();
        let curvature: Vec<f64> = y.iter().zip(&point.h).map(|(y, h)| y / h).collect();
        let pull: Vec<f64> = point.c.iter().map(|c| mu / c).collect();
        // Along B: (yᵢ/cᵢ − yᵢ/hᵢ)∇hᵢ∇hᵢᵀ, the second from the curvature; along d, and between them: yᵢ/cᵢ.
        let along_b: Vec<f64> = ratio.iter().zip(&curvature).map(|(r, c)| r - c).collect();
        let mut weighted = vec![0.0; m];
        for a in 0..size {
            let weight = if a < entries { &along_b } else { &ratio };
            let g = &gradients[a * m..(a + 1) * m];
            weighted.iter_mut().zip(weight.iter().zip(g)).for_each(|(x, (w, g))| *x = w * g);
            for b in 0..=a {
                self.matrix[a * size + b] = dot_in_lanes(&weighted, &gradients[b * m..(b + 1) * m]);
            }
            self.right[a] = -dot_in_lanes(&pull, g);
        }
        // Σ(yᵢ/hᵢ)|Δpᵢ|² = tr(Δ·W·Δ), W = Σ(yᵢ/hᵢ)pᵢpᵢᵀ.
        let mut w = vec![0.0; n * n];
        for j in 0..n {
            let pj = &gradients[(entries + j) * m..(entries + j + 1) * m];
            weighted.iter_mut().zip(curvature.iter().zip(pj)).for_each(|(x, (c, p))| *x = c * p);
            for k in 0..n {
                w[j * n + k] = dot_in_lanes(&weighted, &gradients[(entries + k) * m..(entries + k + 1) * m]);
            }
        }
        let mut a = 0;
        for i in 0..n {
            for j in i..n {
                self.right[a] += if i == j { inverse[i * n + i] } else { 2.0 * inverse[i * n + j] };
                let mut b = 0;
                for k in 0..n {
                    for l in k..n {
                        if b <= a {
                            self.matrix[a * size + b] += pair(n, &inverse, &w, (i, j), (k, l));
                        }
                        b += 1;
                    }
                }
                a += 1;
            }
        }
        if cholesky(Dynamic(size), &mut self.matrix).is_none() {
            return false;
        }
        solve_lower(Dynamic(size), &self.matrix, &mut self.right);
        solve_lower_transpose(Dynamic(size), &self.matrix, &mut self.right);
        true
    }

    /// ΔB as a full matrix, and Δd.
    fn step(&self, n: usize) -> (Vec<f64>, Vec<f64>) {
        let mut db = vec![0.0; n * n];
        let mut at = 0;
        for i in 0..n {
            for j in i..n {
                db[i * n + j] = self.right[at];
                db[j * n + i] = self.right[at];
                at += 1;
            }
        }
        (db, self.right[at..].to_vec())
    }
}

/// a·b with four partial sums, which the compiler keeps in vector registers.
fn dot_in_lanes(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + dot(a_rest, b_rest)
}

/// tr(CΔC∇) + tr(ΔW∇) for Δ and ∇ the symmetric unit matrices of the entries (i, j) and (k, l).
fn pair(n: usize, c: &[f64], w: &[f64], (i, j): (usize, usize), (k, l): (usize, usize)) -> f64 {
    let mut sum = 0.0;
    let left: &[(usize, usize)] = if i == j { &[(i, j)] } else { &[(i, j), (j, i)] };
    let right: &[(usize, usize)] = if k == l { &[(k, l)] } else { &[(k, l), (l, k)] };
    for &(i, j) in left {
        for &(k, l) in right {
            // tr(C·eᵢeⱼᵀ·C·eₖeₗᵀ) = C_lᵢ·C_jₖ, tr(eᵢeⱼᵀ·W·eₖeₗᵀ) = δ_lᵢ·W_jₖ.
            sum += c[l * n + i] * c[j * n + k] + if l == i { w[j * n + k] } else { 0.0 };
        }
    }
    sum
}

fn inverse<D: Dimension>(dim: D, b: &[f64]) -> Option<Vec<f64>> {
    let n = dim.get();
    let mut factor = b.to_vec();
    cholesky(dim, &mut factor)?;
    let mut inverse = vec![0.0; n * n];
    for row in 0..n {
        let e = &mut inverse[row * n..(row + 1) * n];
        e[row] = 1.0;
        solve_lower(dim, &factor, e);
        solve_lower_transpose(dim, &factor, e);
    }
    Some(inverse)
}
