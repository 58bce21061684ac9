//! An ellipsoid in { z : pᵢ·z ≤ 1 }, and the quantities that follow from it.

use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::cholesky_log_det;

/// The unknowns of the program and the quantities that follow from them.
#[derive(Clone)]
pub(crate) struct Point {
    /// B, symmetric, n × n.
    pub(crate) b: Vec<f64>,
    pub(crate) d: Vec<f64>,
    /// vᵢ = B·pᵢ/hᵢ.
    pub(crate) v: Vec<f64>,
    pub(crate) h: Vec<f64>,
    /// cᵢ = 1 − pᵢ·d − hᵢ.
    pub(crate) c: Vec<f64>,
    pub(crate) log_det: f64,
}

impl Point {
    /// Room for a point of n coordinates and m half-spaces.
    pub(crate) fn new(n: usize, m: usize) -> Self {
        Self {
            b: vec![0.0; n * n],
            d: vec![0.0; n],
            v: vec![0.0; n * m],
            h: vec![0.0; m],
            c: vec![0.0; m],
            log_det: 0.0,
        }
    }

    /// Evaluates all quantities that follow from B and d; false unless B ≻ 0 and all cᵢ > 0.
    pub(crate) fn evaluate<D: Dimension>(&mut self, dim: D, p: &[f64]) -> bool {
        let n = dim.get();
        let mut factor = dim.matrix(self.b.iter().copied());
        let Some(log_det) = cholesky_log_det(dim, factor.as_mut()) else { return false };
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
