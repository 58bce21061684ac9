//! The intersection of half-spaces: is it bounded, does it have an interior, and a frame in which it is round.

use crate::dimension::{Dimension, Dynamic};
use crate::error::InscribedError;
use crate::linalg::{UNIT_ROUNDOFF, cholesky, dot, solve_lower};

/// Half-spaces aᵢ·(x − o) ≤ bᵢ, |aᵢ| near one; rows of `n` numbers.
#[derive(Clone, Debug)]
pub(crate) struct Polyhedron {
    pub(crate) n: usize,
    pub(crate) normals: Vec<f64>,
    pub(crate) offsets: Vec<f64>,
    pub(crate) origin: Vec<f64>,
}

impl Polyhedron {
    pub(crate) fn len(&self) -> usize {
        self.offsets.len()
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.normals.chunks_exact(self.n).zip(self.offsets.iter().copied())
    }

    /// bᵢ − aᵢ·(x − o) for every half-space.
    pub(crate) fn slacks(&self, x: &[f64]) -> Vec<f64> {
        let e: Vec<f64> = x.iter().zip(&self.origin).map(|(x, o)| x - o).collect();
        self.rows().map(|(a, b)| b - dot(a, &e)).collect()
    }
}

/// The map x = o + M·z to the coordinates z in which a body is round, M stored by rows.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    pub(crate) origin: Vec<f64>,
    pub(crate) map: Vec<f64>,
}

impl Coordinates {
    /// o + M·z.
    pub(crate) fn image(&self, z: &[f64]) -> Vec<f64> {
        let n = self.origin.len();
        self.origin.iter().zip(self.map.chunks_exact(n)).map(|(o, row)| o + dot(row, z)).collect()
    }

    /// M ← M·L⁻ᵀ: every row m of M becomes L⁻¹m.
    fn whiten<D: Dimension>(&mut self, dim: D, l: &[f64]) {
        self.map.chunks_exact_mut(dim.get()).for_each(|row| solve_lower(dim, l, row));
    }
}

/// Coordinates about the analytic centre of the intersection in which it contains the unit ball and lies in a ball of
/// radius m.
///
/// The normals are first transformed so that Σaᵢaᵢᵀ = I (their condition is then gone), and are seen to span the space
/// positively; a linear program finds an interior point; Newton's method on −Σ ln sᵢ centres it, in coordinates that make each
/// Hessian the identity.
///
/// # Errors
/// [`InscribedError::Unbounded`], [`InscribedError::EmptyInterior`].
pub(crate) fn round_coordinates<D: Dimension>(dim: D, polyhedron: &Polyhedron) -> Result<Coordinates, InscribedError> {
    let n = dim.get();
    let m = polyhedron.len();
    let mut rows = polyhedron.normals.clone();
    let mut coordinates = Coordinates { origin: polyhedron.origin.clone(), map: vec![0.0; n * n] };
    orthonormal_columns(n, &mut rows, &mut coordinates.map)?;
    if !positively_spans(n, &rows) {
        return Err(InscribedError::Unbounded);
    }
    // Rows of unit length again, so that the program measures all half-spaces alike.
    let mut unit_rows = rows.clone();
    let mut unit_offsets = polyhedron.offsets.clone();
    for (row, b) in unit_rows.chunks_exact_mut(n).zip(&mut unit_offsets) {
        let length = dot(row, row).sqrt();
        row.iter_mut().for_each(|x| *x /= length);
        *b /= length;
    }
    let inside = interior_point(n, &unit_rows, &unit_offsets).ok_or(InscribedError::EmptyInterior)?;
    coordinates.origin = coordinates.image(&inside);
    let mut slacks = polyhedron.slacks(&coordinates.origin);
    if slacks.iter().any(|s| !(*s > 0.0)) {
        return Err(InscribedError::EmptyInterior);
    }
    let mut l = dim.zero_matrix();
    let l = &mut l.as_mut()[..n * n];
    for _ in 0..500 {
        l.fill(0.0);
        for (a, s) in rows.chunks_exact(n).zip(&slacks) {
            for i in 0..n {
                for j in 0..=i {
                    l[i * n + j] += (a[i] / s) * (a[j] / s);
                }
            }
        }
        if !cholesky(dim, l) {
            return Err(InscribedError::EmptyInterior);
        }
        coordinates.whiten(dim, l);
        let mut step = dim.zero();
        let step = &mut step.as_mut()[..n];
        for (a, s) in rows.chunks_exact_mut(n).zip(&slacks) {
            solve_lower(dim, l, a);
            step.iter_mut().zip(&*a).for_each(|(g, a)| *g -= a / s);
        }
        // The Hessian is the identity here, so the Newton step is −g and its decrement |g|.
        let decrement = dot(step, step).sqrt();
        if decrement < 0.5 {
            return Ok(coordinates);
        }
        let damping = 1.0 / (1.0 + decrement);
        step.iter_mut().for_each(|x| *x *= damping);
        coordinates.origin = coordinates.image(step);
        let fresh = polyhedron.slacks(&coordinates.origin);
        for i in 0..m {
            // Recomputed slacks do not drift; a damped step cannot leave the interior but by rounding.
            slacks[i] = if fresh[i] > 0.0 { fresh[i] } else { 0.5 * slacks[i] };
        }
    }
    Ok(coordinates)
}

/// Transforms the rows of `a` (m of n) so that `AᵀA = I`, and writes the map M with x = M·z for which A·M are the new rows.
fn orthonormal_columns(n: usize, a: &mut [f64], map: &mut [f64]) -> Result<(), InscribedError> {
    (0..n).for_each(|k| map[k * n + k] = 1.0);
    // Columns of wildly different size come from coordinates in different units: no sign of dependence.
    for k in 0..n {
        let size = a.chunks_exact(n).map(|row| row[k].abs()).fold(0.0, f64::max);
        if size == 0.0 {
            return Err(InscribedError::Unbounded);
        }
        a.chunks_exact_mut(n).for_each(|row| row[k] /= size);
        map[k * n + k] /= size;
    }
    let column = |a: &[f64], j: usize, k: usize| a.chunks_exact(n).map(|row| row[j] * row[k]).sum::<f64>();
    let original: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
    let mut done: Vec<usize> = Vec::with_capacity(n);
    for _ in 0..n {
        let lengths: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
        let pivot = (0..n)
            .filter(|k| !done.contains(k))
            .max_by(|&i, &j| lengths[i].total_cmp(&lengths[j]))
            .ok_or(InscribedError::Unbounded)?;
        // What rounding leaves of a column dependent on the others.
        if !(lengths[pivot] > 32.0 * f64::EPSILON * original[pivot]) {
            return Err(InscribedError::Unbounded);
        }
        for pass in 0..2 {
            let subtract = |a: &mut [f64], map: &mut [f64], from: usize, factor: f64, of: usize| {
                a.chunks_exact_mut(n).chain(map.chunks_exact_mut(n)).for_each(|row| row[from] -= factor * row[of]);
            };
            // A second time against rounding.
            for &k in &done {
                let along = column(a, pivot, k);
                subtract(a, map, pivot, along, k);
            }
            let length = column(a, pivot, pivot).sqrt();
            a.chunks_exact_mut(n).chain(map.chunks_exact_mut(n)).for_each(|row| row[pivot] /= length);
            if pass == 1 {
                for k in (0..n).filter(|k| !done.contains(k) && *k != pivot) {
                    let along = column(a, k, pivot);
                    subtract(a, map, k, along, pivot);
                }
            }
        }
        done.push(pivot);
    }
    Ok(())
}

/// Whether the rows, which span the space, do so with non-negative combinations: then no direction z has aᵢ·z ≤ 0 for all.
///
/// By Stiemke's lemma this is so exactly if −g, g = Σaᵢ/|aᵢ|, is a non-negative combination of the rows. The residual of
/// the non-negative least-squares problem (Lawson and Hanson) is otherwise such a direction.
fn positively_spans(n: usize, rows: &[f64]) -> bool {
    let mut unit = rows.to_vec();
    for row in unit.chunks_exact_mut(n) {
        let length = dot(row, row).sqrt();
        row.iter_mut().for_each(|x| *x /= length);
    }
    let m = unit.len() / n;
    let unit = |i: usize| &unit[i * n..(i + 1) * n];
    let mut target = vec![0.0; n];
    for i in 0..m {
        target.iter_mut().zip(unit(i)).for_each(|(t, x)| *t -= x);
    }
    let tolerance = 1e-12 * m as f64;
    let mut passive: Vec<usize> = Vec::new();
    let mut weights: Vec<f64> = Vec::new();
    for _ in 0..20 * (m + n) {
        let mut residual = target.clone();
        for (&i, w) in passive.iter().zip(&weights) {
            residual.iter_mut().zip(unit(i)).for_each(|(r, x)| *r -= w * x);
        }
        let length = dot(&residual, &residual).sqrt();
        if length <= tolerance {
            return true;
        }
        let best = (0..m)
            .filter(|i| !passive.contains(i))
            .map(|i| (i, dot(unit(i), &residual)))
            .fold((usize::MAX, 1e-13 * length), |best, now| if now.1 > best.1 { now } else { best });
        if best.0 == usize::MAX || passive.len() == n {
            return false;
        }
        passive.push(best.0);
        weights.push(0.0);
        while let Some(solution) = least_squares(&passive.iter().map(|&i| unit(i)).collect::<Vec<_>>(), &target) {
            if solution.iter().all(|w| *w > 0.0) {
                weights = solution;
                break;
            }
            let mut alpha: f64 = 1.0;
            for (w, s) in weights.iter().zip(&solution) {
                if *s <= 0.0 {
                    alpha = alpha.min(w / (w - s));
                }
            }
            weights.iter_mut().zip(&solution).for_each(|(w, s)| *w += alpha * (s - *w));
            let keep: Vec<bool> =
                weights.iter().zip(&solution).map(|(w, s)| *s > 0.0 || *w > UNIT_ROUNDOFF * length).collect();
            if keep.iter().all(|k| *k) {
                break;
            }
            let mut kept = keep.iter();
            passive.retain(|_| *kept.next().unwrap_or(&true));
            let mut kept = keep.iter();
            weights.retain(|_| *kept.next().unwrap_or(&true));
        }
    }
    false
}

/// The combination of `vectors` nearest to `target`, by orthogonalisation; `None` if they are dependent.
fn least_squares(vectors: &[&[f64]], target: &[f64]) -> Option<Vec<f64>> {
    let k = vectors.len();
    if k == 0 {
        return None;
    }
    let mut q: Vec<Vec<f64>> = Vec::with_capacity(k);
    let mut r = vec![0.0; k * k];
    for (j, v) in vectors.iter().enumerate() {
        let mut v = v.to_vec();
        for _ in 0..2 {
            for (i, q) in q.iter().enumerate() {
                let along = dot(q, &v);
                r[i * k + j] += along;
                v.iter_mut().zip(q).for_each(|(x, y)| *x -= along * y);
            }
        }
        let length = dot(&v, &v).sqrt();
        if !(length > 1e-14) {
            return None;
        }
        r[j * k + j] = length;
        v.iter_mut().for_each(|x| *x /= length);
        q.push(v);
    }
    let mut x: Vec<f64> = q.iter().map(|q| dot(q, target)).collect();
    for i in (0..k).rev() {
        for j in i + 1..k {
            x[i] -= r[i * k + j] * x[j];
        }
        x[i] /= r[i * k + i];
    }
    Some(x)
}

/// A point well inside aᵢ·x ≤ bᵢ, |aᵢ| = 1: the origin if it is, else near the centre of a largest inscribed ball.
///
/// max t subject to aᵢ·x + t ≤ bᵢ, by a primal–dual interior-point method whose primal iterates (x, t) are always
/// feasible: with slacks s and multipliers y, each step solves GᵀDG·Δw = −c − Gᵀ(σμ/s), D = diag(y/s), G's rows (aᵢ, 1).
/// `None` if t stays within rounding of zero or below.
fn interior_point(n: usize, rows: &[f64], offsets: &[f64]) -> Option<Vec<f64>> {
    let m = offsets.len();
    let scale = offsets.iter().fold(0.0, |s: f64, b| s.max(b.abs()));
    let least = offsets.iter().fold(f64::INFINITY, |s: f64, b| s.min(*b));
    if least > 1e-3 * scale {
        return Some(vec![0.0; n]);
    }
    if !(scale > 0.0) {
        return None;
    }
    let rounding = 32.0 * f64::EPSILON * scale;
    let p = n + 1;
    let row = |i: usize, k: usize| if k < n { rows[i * n + k] } else { 1.0 };
    let mut w = vec![0.0; p];
    w[n] = least - scale;
    let mut y = vec![1.0 / m as f64; m];
    let mut s: Vec<f64> = offsets.iter().map(|b| b - w[n]).collect();
    let mut hessian = vec![0.0; p * p];
    for _ in 0..100 {
        let mu = dot(&s, &y) / m as f64;
        let dual_residual: f64 = (0..p)
            .map(|k| {
                let sum: f64 = (0..m).map(|i| row(i, k) * y[i]).sum();
                (sum - if k == n { 1.0 } else { 0.0 }).powi(2)
            })
            .sum::<f64>()
            .sqrt();
        let upper = w[n] + m as f64 * mu;
        if dual_residual < 1e-8 && (w[n] > rounding && upper < 1.5 * w[n] || upper < rounding) {
            break;
        }
        let target = 0.1 * mu;
        hessian.fill(0.0);
        let mut step = vec![0.0; p];
        step[n] = 1.0;
        for i in 0..m {
            for k in 0..p {
                step[k] -= row(i, k) * target / s[i];
                for l in 0..=k {
                    hessian[k * p + l] += row(i, k) * row(i, l) * y[i] / s[i];
                }
            }
        }
        if !cholesky(Dynamic(p), &mut hessian) {
            break;
        }
        solve_lower(Dynamic(p), &hessian, &mut step);
        crate::linalg::solve_lower_transpose(Dynamic(p), &hessian, &mut step);
        let ds: Vec<f64> = (0..m).map(|i| -(0..p).map(|k| row(i, k) * step[k]).sum::<f64>()).collect();
        let dy: Vec<f64> = (0..m).map(|i| (target - s[i] * y[i] - y[i] * ds[i]) / s[i]).collect();
        let length = |x: &[f64], d: &[f64]| {
            x.iter().zip(d).filter(|(_, d)| **d < 0.0).fold(1.0, |t: f64, (x, d)| t.min(-0.99 * x / d))
        };
        let (primal, dual) = (length(&s, &ds), length(&y, &dy));
        w.iter_mut().zip(&step).for_each(|(w, d)| *w += primal * d);
        y.iter_mut().zip(&dy).for_each(|(y, d)| *y += dual * d);
        for i in 0..m {
            let fresh = offsets[i] - (0..p).map(|k| row(i, k) * w[k]).sum::<f64>();
            s[i] = if fresh > 0.0 { fresh } else { s[i] * 0.01 };
        }
    }
    if w[n] > rounding {
        w.truncate(n);
        Some(w)
    } else {
        None
    }
}
