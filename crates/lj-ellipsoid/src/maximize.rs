//! The primal–dual iteration for the maximum-volume ellipsoid in { z : pᵢ·z ≤ 1 }.
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

use crate::dimension::{Dimension, Dynamic, LANES};
use crate::error::InscribedError;
use crate::inscribed::InscribedIterate;
use crate::linalg::{cholesky, cholesky_log_det, dot, solve_lower, solve_lower_transpose};
use crate::options::{InscribedOptions, Status};

/// The unknowns of the program and what follows from them.
#[derive(Clone)]
pub(crate) struct Point {
    /// B, symmetric, n × n.
    pub(crate) b: Vec<f64>,
    pub(crate) d: Vec<f64>,
    /// vᵢ = B·pᵢ/hᵢ.
    v: Vec<f64>,
    pub(crate) h: Vec<f64>,
    /// cᵢ = 1 − pᵢ·d − hᵢ.
    pub(crate) c: Vec<f64>,
    pub(crate) log_det: f64,
}

impl Point {
    /// Room for a point of n coordinates and m half-spaces.
    fn new(n: usize, m: usize) -> Self {
        Self {
            b: vec![0.0; n * n],
            d: vec![0.0; n],
            v: vec![0.0; n * m],
            h: vec![0.0; m],
            c: vec![0.0; m],
            log_det: 0.0,
        }
    }

    /// Evaluates everything that follows from B and d; false unless B ≻ 0 and all cᵢ > 0.
    fn evaluate<D: Dimension>(&mut self, dim: D, p: &[f64], factor: &mut Vec<f64>) -> bool {
        let n = dim.get();
        factor.clone_from(&self.b);
        let Some(log_det) = cholesky_log_det(dim, factor) else { return false };
        self.log_det = log_det;
        let (b, d) = (&self.b[..n * n], &self.d[..n]);
        let outputs = self.v.chunks_exact_mut(n).zip(&mut self.h).zip(&mut self.c);
        for (p, ((v, h), c)) in p.chunks_exact(n).zip(outputs) {
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
            *h = square.sqrt();
            *c = 1.0 - along - *h;
            if !(*c > 0.0) {
                return false;
            }
            let inverse = 1.0 / *h;
            v.iter_mut().for_each(|v| *v *= inverse);
        }
        true
    }
}

/// The bound on ln det B that multipliers prove.
pub(crate) struct Dual {
    pub(crate) log_det_bound: f64,
    /// Multipliers with Σyᵢpᵢ = 0, scaled to sum to one.
    pub(crate) y: Vec<f64>,
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
        if !cholesky(dim, &mut gram) {
            return None;
        }
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
    let log_det = cholesky_log_det(dim, &mut s)?;
    Some(Dual { log_det_bound: -(n as f64) * (n as f64).ln() - log_det, y })
}

/// The complementarity below which the dual bound is evaluated.
const WORTH_BOUNDING: f64 = 1e-3;

/// Steps taken beyond the gap asked for, each of which shrinks it by two to three orders, and the gap they aim at.
const POLISHING_STEPS: usize = 3;
const ROUNDING: f64 = 1e-14;

/// Below this gap steps are full ones, and polishing is worth its price.
const NEAR: f64 = 1e-6;

/// The best point, what its multipliers prove, how the iteration ended, and its steps.
type Maximum = (Point, Option<Dual>, Status, usize);

/// The primal–dual iteration over { z : pᵢ·z ≤ 1 }.
pub(crate) fn maximize<D: Dimension>(
    dim: D,
    p: &[f64],
    options: InscribedOptions,
    observer: &mut impl FnMut(InscribedIterate),
) -> Result<Maximum, InscribedError> {
    let n = dim.get();
    let m = p.len() / n;
    let reach = p.chunks_exact(n).fold(0.0, |r: f64, p| r.max(dot(p, p).sqrt()));
    let mut point = Point::new(n, m);
    let mut factor = Vec::with_capacity(n * n);
    (0..n).for_each(|k| point.b[k * n + k] = 0.5 / reach);
    if !point.evaluate(dim, p, &mut factor) {
        return Err(InscribedError::OutOfRange);
    }
    let mut trial = point.clone();
    let mut dy = vec![0.0; m];
    // Σyᵢhᵢ = N at the solution.
    let mut mu = n as f64 / m as f64;
    let mut y: Vec<f64> = point.c.iter().map(|c| mu / c).collect();
    let mut best: (f64, Option<Dual>) = (f64::INFINITY, None);
    let mut system = System::new(n);
    let mut centring = 0.3;
    let mut without_progress = 0;
    let mut iteration = 0;
    let mut polishing = POLISHING_STEPS;
    let mut kept: Option<Point> = None;
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
            if let Some(kept) = kept.take() {
                point = kept;
                break Status::Converged;
            }
        }
        if gap <= 0.5 * options.epsilon {
            if gap <= ROUNDING || gap > NEAR || polishing == 0 || iteration >= options.max_iterations {
                break Status::Converged;
            }
            // A step of rounding may lead anywhere: what is at hand is kept against it.
            polishing -= 1;
            kept = Some(point.clone());
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
        // Δyᵢ = (μ − yᵢcᵢ − yᵢ∇cᵢᵀΔ)/cᵢ, ∇cᵢᵀΔ = −vᵢᵀΔB·pᵢ − pᵢᵀΔd. As cᵢ is concave it stays below its tangent: no step
        // beyond `reachable` keeps cᵢ ≥ 0.002 of what it is.
        let mut dual_length: f64 = 1.0;
        let mut reachable = f64::INFINITY;
        let rows = p.chunks_exact(n).zip(point.v.chunks_exact(n)).zip(point.c.iter().zip(&y));
        for (((p, v), (&c, &y)), dy) in rows.zip(&mut dy) {
            let mut change = 0.0;
            for j in 0..n {
                change -= p[j] * dd[j] + v[j] * dot(&db[j * n..(j + 1) * n], p);
            }
            *dy = (mu - y * c - y * change) / c;
            if *dy < 0.0 {
                dual_length = dual_length.min(-0.995 * y / *dy);
            }
            if change < 0.0 {
                reachable = reachable.min(-0.998 * c / change);
            }
        }
        // The longest of 1, 0.98, 0.96, 0.92, … that keeps off the boundary.
        let (mut primal_length, mut shortfall) = (1.0, 0.02);
        let moved = loop {
            // A little beyond, for the rounding of the tangent.
            if primal_length <= 1.001 * reachable {
                let step = |x: &mut f64, (old, d): (&f64, &f64)| *x = old + primal_length * d;
                trial.b.iter_mut().zip(point.b.iter().zip(&db)).for_each(|(x, from)| step(x, from));
                trial.d.iter_mut().zip(point.d.iter().zip(&dd)).for_each(|(x, from)| step(x, from));
                if trial.evaluate(dim, p, &mut factor)
                    && trial.c.iter().zip(&point.c).all(|(new, old)| *new >= 0.002 * old)
                {
                    break true;
                }
            }
            if primal_length < 1e-9 {
                break false;
            }
            if shortfall < 0.5 {
                primal_length = 1.0 - shortfall;
                shortfall *= 2.0;
            } else {
                primal_length *= 0.6;
            }
        };
        if !moved {
            break Status::Stalled;
        }
        std::mem::swap(&mut point, &mut trial);
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
    /// Weights of the half-spaces, and a row of gradients times them.
    ratio: Vec<f64>,
    curvature: Vec<f64>,
    pull: Vec<f64>,
    along_b: Vec<f64>,
    weighted: Vec<f64>,
}

impl System {
    fn new(n: usize) -> Self {
        let size = n * (n + 3) / 2;
        let [gradients, ratio, curvature, pull, along_b, weighted] = Default::default();
        let (matrix, right) = (vec![0.0; size * size], vec![0.0; size]);
        Self { size, matrix, right, gradients, ratio, curvature, pull, along_b, weighted }
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
        let rows = || p.chunks_exact(n).zip(point.v.chunks_exact(n));
        let mut rest = &mut gradients[..];
        for j in 0..n {
            for k in j..n {
                let (row, others) = rest.split_at_mut(m);
                rest = others;
                if j == k {
                    row.iter_mut().zip(rows()).for_each(|(g, (p, v))| *g = v[j] * p[j]);
                } else {
                    row.iter_mut().zip(rows()).for_each(|(g, (p, v))| *g = v[j] * p[k] + v[k] * p[j]);
                }
            }
        }
        for (j, row) in rest.chunks_exact_mut(m).enumerate() {
            row.iter_mut().zip(p.chunks_exact(n)).for_each(|(g, p)| *g = p[j]);
        }
        let Self { ratio, curvature, pull, along_b, weighted, .. } = self;
        fill(ratio, y.iter().zip(&point.c).map(|(y, c)| y / c));
        fill(curvature, y.iter().zip(&point.h).map(|(y, h)| y / h));
        fill(pull, point.c.iter().map(|c| mu / c));
        // Along B: (yᵢ/cᵢ − yᵢ/hᵢ)∇hᵢ∇hᵢᵀ, the second from the curvature; along d, and between them: yᵢ/cᵢ.
        fill(along_b, ratio.iter().zip(&*curvature).map(|(r, c)| r - c));
        weighted.resize(m, 0.0);
        for a in 0..size {
            let weight = if a < entries { &*along_b } else { &*ratio };
            let g = &gradients[a * m..(a + 1) * m];
            weighted.iter_mut().zip(weight.iter().zip(g)).for_each(|(x, (w, g))| *x = w * g);
            dots_in_lanes(weighted, &gradients[..(a + 1) * m], &mut self.matrix[a * size..a * size + a + 1]);
            self.right[a] = -dot_in_lanes(pull, g);
        }
        // Σ(yᵢ/hᵢ)|Δpᵢ|² = tr(Δ·W·Δ), W = Σ(yᵢ/hᵢ)pᵢpᵢᵀ.
        let mut w = vec![0.0; n * n];
        for j in 0..n {
            let pj = &gradients[(entries + j) * m..(entries + j + 1) * m];
            weighted.iter_mut().zip(curvature.iter().zip(pj)).for_each(|(x, (c, p))| *x = c * p);
            dots_in_lanes(weighted, &gradients[entries * m..], &mut w[j * n..(j + 1) * n]);
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
        if !cholesky(Dynamic(size), &mut self.matrix) {
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

/// Replaces what `to` holds, in the room it has.
fn fill(to: &mut Vec<f64>, numbers: impl Iterator<Item = f64>) {
    to.clear();
    to.extend(numbers);
}

/// outₖ = a·bₖ for the rows bₖ of `rows`: three at a time, so that each number of `a` is loaded once for three.
fn dots_in_lanes(a: &[f64], rows: &[f64], out: &mut [f64]) {
    let m = a.len();
    let mut threes = out.chunks_exact_mut(3);
    let (a_lanes, a_rest) = a.as_chunks::<LANES>();
    for (out, rows) in threes.by_ref().zip(rows.chunks_exact(3 * m)) {
        let (x, rest) = rows.split_at(m);
        let (y, z) = rest.split_at(m);
        let (x, x_rest) = x.as_chunks::<LANES>();
        let (y, y_rest) = y.as_chunks::<LANES>();
        let (z, z_rest) = z.as_chunks::<LANES>();
        let mut sums = [[0.0; LANES]; 3];
        for (((a, x), y), z) in a_lanes.iter().zip(x).zip(y).zip(z) {
            for lane in 0..LANES {
                sums[0][lane] += a[lane] * x[lane];
                sums[1][lane] += a[lane] * y[lane];
                sums[2][lane] += a[lane] * z[lane];
            }
        }
        for ((out, sums), rest) in out.iter_mut().zip(sums).zip([x_rest, y_rest, z_rest]) {
            *out = sums.iter().sum::<f64>() + dot(a_rest, rest);
        }
    }
    let done = rows.len() / m / 3 * 3;
    for (out, row) in threes.into_remainder().iter_mut().zip(rows[done * m..].chunks_exact(m)) {
        *out = dot_in_lanes(a, row);
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
    if !cholesky(dim, &mut factor) {
        return None;
    }
    let mut inverse = vec![0.0; n * n];
    for row in 0..n {
        let e = &mut inverse[row * n..(row + 1) * n];
        e[row] = 1.0;
        solve_lower(dim, &factor, e);
        solve_lower_transpose(dim, &factor, e);
    }
    Some(inverse)
}
