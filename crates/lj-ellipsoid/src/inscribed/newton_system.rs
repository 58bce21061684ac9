//! The Newton system of the maximum-volume inscribed ellipsoid, in the N(N + 1)/2 entries of B on and above the
//! diagonal and the N of d.
//!
//! Linearised at (B, d, y), with Δ = (ΔB, Δd), f = −ln det B and cᵢyᵢ to become μ, the conditions are
//!
//! > ∇²f·Δ + Σyᵢ∇²hᵢ·Δ − Σ(yᵢ + Δyᵢ)∇cᵢ = −∇f and yᵢ∇cᵢᵀΔ + cᵢΔyᵢ = μ − cᵢyᵢ.
//!
//! The second give Δyᵢ, and that in the first leaves
//!
//! > (∇²f + Σyᵢ∇²hᵢ + Σ(yᵢ/cᵢ)∇cᵢ∇cᵢᵀ)·Δ = −∇f + Σ(μ/cᵢ)∇cᵢ.
//!
//! Along Δ: ∇f = −tr(B⁻¹Δ), ∇²f = tr(B⁻¹ΔB⁻¹Δ), ∇hᵢ = vᵢᵀΔpᵢ, ∇²hᵢ = (|Δpᵢ|² − (vᵢᵀΔpᵢ)²)/hᵢ.

use crate::inscribed::point::Point;
use crate::numerics::dimension::{Const, Dimension, Dynamic, LANES};
use crate::numerics::linalg::{cholesky, dot, solve_factored};

/// The factored system at a point, and room for the next.
pub(crate) struct System {
    size: usize,
    /// The Cholesky factor of the matrix.
    factor: Vec<f64>,
    /// −∇f.
    right: Vec<f64>,
    /// −∇cᵢ, unknown by unknown, so that the sums over the half-spaces run along lanes.
    gradients: Vec<f64>,
    /// yᵢ/cᵢ, yᵢ/hᵢ, the one less the other, and a row of gradients times one of them.
    ratio: Vec<f64>,
    curvature: Vec<f64>,
    along_b: Vec<f64>,
    weighted: Vec<f64>,
}

/// A step in all unknowns.
pub(crate) struct Direction {
    /// ΔB on and above the diagonal, then Δd.
    delta: Vec<f64>,
    /// ∇cᵢᵀΔ.
    dc: Vec<f64>,
    pub(crate) dy: Vec<f64>,
}

impl Direction {
    /// Room for n coordinates and m half-spaces.
    pub(crate) fn new(n: usize, m: usize) -> Self {
        Self { delta: vec![0.0; n * (n + 3) / 2], dc: vec![0.0; m], dy: vec![0.0; m] }
    }

    /// Writes B + length·ΔB and d + length·Δd to `to`, B and d those of `from`.
    pub(crate) fn advance(&self, n: usize, length: f64, from: &Point, to: &mut Point) {
        let mut delta = self.delta.iter();
        for i in 0..n {
            for (j, x) in (i..n).zip(&mut delta) {
                to.b[i * n + j] = from.b[i * n + j] + length * x;
                to.b[j * n + i] = to.b[i * n + j];
            }
        }
        to.d.iter_mut().zip(from.d.iter().zip(delta)).for_each(|(to, (d, x))| *to = d + length * x);
    }
}

impl Direction {
    /// How far B + t·ΔB, d + t·Δd keeps every cᵢ ≥ 0; infinite where it always does.
    ///
    /// cᵢ(t) = a − t·e − |u + t·w| with u = B·pᵢ, w = ΔB·pᵢ, a = 1 − pᵢ·d, e = pᵢ·Δd. Its first root is that of
    /// (|w|² − e²)t² + 2(u·w + a·e)t − (a² − |u|²), found without cancellation.
    pub(crate) fn reach<D: Dimension>(&self, dim: D, p: &[f64], point: &Point) -> f64 {
        let n = dim.get();
        let mut db = dim.zero_matrix();
        let db = &mut db.as_mut()[..n * n];
        let mut delta = self.delta.iter();
        for i in 0..n {
            for (j, &x) in (i..n).zip(&mut delta) {
                db[i * n + j] = x;
                db[j * n + i] = x;
            }
        }
        let dd = dim.point(delta.copied());
        let dd = &dd.as_ref()[..n];
        let mut reach = f64::INFINITY;
        for (((p, v), h), c) in p.chunks_exact(n).zip(point.v.chunks_exact(n)).zip(&point.h).zip(&point.c) {
            let (mut e, mut vw, mut ww) = (0.0, 0.0, 0.0);
            for i in 0..n {
                let mut w = 0.0;
                for j in 0..n {
                    w += db[i * n + j] * p[j];
                }
                e += p[i] * dd[i];
                vw += v[i] * w;
                ww += w * w;
            }
            let (quadratic, half_linear, constant) = (ww - e * e, h * vw + (c + h) * e, c * (c + 2.0 * h));
            let discriminant = half_linear * half_linear + quadratic * constant;
            let denominator = half_linear + discriminant.sqrt();
            // A negative discriminant is a NaN here: no root.
            if denominator > 0.0 {
                reach = reach.min(constant / denominator);
            }
        }
        reach
    }
}

impl System {
    /// Room for n coordinates and m half-spaces.
    pub(crate) fn new(n: usize, m: usize) -> Self {
        let size = n * (n + 3) / 2;
        let numbers = || vec![0.0; m];
        Self {
            size,
            factor: vec![0.0; size * size],
            right: vec![0.0; size],
            gradients: vec![0.0; size * m],
            ratio: numbers(),
            curvature: numbers(),
            along_b: numbers(),
            weighted: numbers(),
        }
    }

    /// Assembles and factors the system at a point; false where it is not numerically definite.
    pub(crate) fn assemble<D: Dimension>(&mut self, dim: D, p: &[f64], point: &Point, y: &[f64]) -> bool {
        let n = dim.get();
        let size = self.size;
        let entries = size - n;
        let m = y.len();
        let Some(inverse) = inverse(dim, &point.b) else { return false };
        let inverse = &inverse.as_ref()[..n * n];
        self.differentiate(dim, p, &point.v);
        let Self { factor, right, gradients, ratio, curvature, along_b, weighted, .. } = self;
        // Along B: (yᵢ/cᵢ − yᵢ/hᵢ)∇hᵢ∇hᵢᵀ, the second from the curvature; along d, and between them: yᵢ/cᵢ.
        for i in 0..m {
            ratio[i] = y[i] / point.c[i];
            curvature[i] = y[i] / point.h[i];
            along_b[i] = ratio[i] - curvature[i];
        }
        for a in 0..size {
            let weight = if a < entries { &*along_b } else { &*ratio };
            let g = &gradients[a * m..(a + 1) * m];
            weighted.iter_mut().zip(weight.iter().zip(g)).for_each(|(x, (w, g))| *x = w * g);
            dots_in_lanes(weighted, &gradients[..(a + 1) * m], &mut factor[a * size..a * size + a + 1]);
        }
        // Σ(yᵢ/hᵢ)|Δpᵢ|² = tr(Δ·W·Δ), W = Σ(yᵢ/hᵢ)pᵢpᵢᵀ.
        let mut w = dim.zero_matrix();
        let w = &mut w.as_mut()[..n * n];
        for j in 0..n {
            let pj = &gradients[(entries + j) * m..(entries + j + 1) * m];
            weighted.iter_mut().zip(curvature.iter().zip(pj)).for_each(|(x, (c, p))| *x = c * p);
            dots_in_lanes(weighted, &gradients[entries * m..], &mut w[j * n..(j + 1) * n]);
        }
        right.fill(0.0);
        let mut a = 0;
        for i in 0..n {
            for j in i..n {
                right[a] = if i == j { inverse[i * n + i] } else { 2.0 * inverse[i * n + j] };
                let mut b = 0;
                'row: for k in 0..n {
                    for l in k..n {
                        factor[a * size + b] += pair(n, inverse, w, (i, j), (k, l));
                        if b == a {
                            break 'row;
                        }
                        b += 1;
                    }
                }
                a += 1;
            }
        }
        // The sizes in the plane and in space are worth unrolling.
        match size {
            5 => cholesky(Const::<5>, factor),
            9 => cholesky(Const::<9>, factor),
            _ => cholesky(Dynamic(size), factor),
        }
    }

    /// Writes the gradients: for the entry (j, k) of B vⱼpₖ + vₖpⱼ, once on the diagonal, and p for d.
    fn differentiate<D: Dimension>(&mut self, dim: D, p: &[f64], v: &[f64]) {
        let n = dim.get();
        let m = p.len() / n;
        let pairs = || p.chunks_exact(n).zip(v.chunks_exact(n));
        let mut rows = self.gradients.chunks_exact_mut(m);
        for j in 0..n {
            for (k, row) in (j..n).zip(&mut rows) {
                if j == k {
                    row.iter_mut().zip(pairs()).for_each(|(g, (p, v))| *g = v[j] * p[j]);
                } else {
                    row.iter_mut().zip(pairs()).for_each(|(g, (p, v))| *g = v[j] * p[k] + v[k] * p[j]);
                }
            }
        }
        for (j, row) in rows.enumerate() {
            row.iter_mut().zip(p.chunks_exact(n)).for_each(|(g, p)| *g = p[j]);
        }
    }

    /// The step after which, to first order, every product cᵢyᵢ is μ.
    pub(crate) fn solve(&mut self, c: &[f64], y: &[f64], mu: f64, direction: &mut Direction) {
        let m = y.len();
        let Direction { delta, dc, dy } = direction;
        self.weighted.iter_mut().zip(c).for_each(|(pull, c)| *pull = mu / c);
        for ((delta, right), g) in delta.iter_mut().zip(&self.right).zip(self.gradients.chunks_exact(m)) {
            *delta = right - dot_in_lanes(&self.weighted, g);
        }
        let dim = Dynamic(self.size);
        solve_factored(dim, &self.factor, delta);
        dc.fill(0.0);
        for (delta, g) in delta.iter().zip(self.gradients.chunks_exact(m)) {
            dc.iter_mut().zip(g).for_each(|(dc, g)| *dc -= delta * g);
        }
        for i in 0..m {
            dy[i] = self.weighted[i] - y[i] - self.ratio[i] * dc[i];
        }
    }
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
#[inline(always)]
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

/// B⁻¹; `None` unless B ≻ 0.
fn inverse<D: Dimension>(dim: D, b: &[f64]) -> Option<D::Matrix> {
    let n = dim.get();
    let mut factor = dim.matrix(b.iter().copied());
    if !cholesky(dim, factor.as_mut()) {
        return None;
    }
    let mut inverse = dim.zero_matrix();
    for (row, e) in inverse.as_mut().chunks_exact_mut(n).enumerate() {
        e[row] = 1.0;
        solve_factored(dim, factor.as_ref(), e);
    }
    Some(inverse)
}
