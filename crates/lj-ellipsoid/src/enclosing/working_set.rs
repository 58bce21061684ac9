//! The points that an iterate works on.

use crate::enclosing::frame::Frame;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::UNIT_ROUNDOFF;
use crate::points::Points;

/// The points an iterate works on, with their weights, in the coordinates of a frame.
#[derive(Debug, Default)]
pub(crate) struct WorkingSet {
    pub(crate) index: Vec<usize>,
    pub(crate) u: Vec<f64>,
    /// The coordinates, `r` numbers a point.
    pub(crate) y: Vec<f64>,
}

impl WorkingSet {
    pub(crate) fn len(&self) -> usize {
        self.index.len()
    }

    /// The points `index` with these weights, or with equal ones.
    pub(crate) fn new(index: Vec<usize>, weights: Option<Vec<f64>>) -> Self {
        let u = weights.unwrap_or_else(|| vec![1.0 / index.len() as f64; index.len()]);
        Self { u, y: Vec::new(), index }
    }

    /// Becomes a copy of `other`, in its own memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.index.clone_from(&other.index);
        self.u.clone_from(&other.u);
        self.y.clone_from(&other.y);
    }

    /// Recomputes the coordinates in `frame` from the points.
    pub(crate) fn locate<P: Points>(&mut self, points: &P, rank: P::Dim, frame: &Frame<P::Dim>) {
        let dim = points.dim();
        let r = rank.get();
        self.y.resize(self.len() * r, 0.0);
        let mut v = dim.zero();
        for (&i, y) in self.index.iter().zip(self.y.chunks_exact_mut(r)) {
            points.read(i, v.as_mut());
            frame.apply(dim, rank, v.as_mut(), y);
        }
    }

    /// Appends point `i`, with weight zero.
    pub(crate) fn push(&mut self, i: usize, y: &[f64]) {
        self.index.push(i);
        self.u.push(0.0);
        self.y.extend_from_slice(y);
    }

    /// Keeps the members for which `keep(position, weight)` holds.
    pub(crate) fn retain(&mut self, r: usize, mut keep: impl FnMut(usize, f64) -> bool) {
        let mut kept = 0;
        for i in 0..self.len() {
            if keep(i, self.u[i]) {
                self.index[kept] = self.index[i];
                self.u[kept] = self.u[i];
                self.y.copy_within(i * r..(i + 1) * r, kept * r);
                kept += 1;
            }
        }
        self.index.truncate(kept);
        self.u.truncate(kept);
        self.y.truncate(kept * r);
    }

    /// The weighted mean of the points themselves, formed from differences to the frame's origin.
    pub(crate) fn mean<P: Points>(&self, points: &P, frame: &Frame<P::Dim>) -> <P::Dim as Dimension>::Point {
        let dim = points.dim();
        let n = dim.get();
        let mut v = dim.zero();
        let mut shift = dim.zero();
        let (v, shift, origin) = (&mut v.as_mut()[..n], &mut shift.as_mut()[..n], &frame.origin.as_ref()[..n]);
        for (&i, &u) in self.index.iter().zip(&self.u) {
            if u != 0.0 {
                points.read(i, v);
                for k in 0..n {
                    shift[k] += u * (v[k] - origin[k]);
                }
            }
        }
        dim.point(origin.iter().zip(shift).map(|(o, s)| o + *s))
    }

    /// A bound on |δy| over the weighted members, y + δy being the exact image of the point: each coordinate is a
    /// subtraction and a dot product of `n` terms, so |δyᵢ| ≤ (n + 2)u·Σₖ|Tᵢₖ||vₖ − oₖ|.
    pub(crate) fn coordinate_error<P: Points>(&self, points: &P, frame: &Frame<P::Dim>) -> f64 {
        let dim = points.dim();
        let n = dim.get();
        let mut v = dim.zero();
        let mut worst: f64 = 0.0;
        for (&i, _) in self.index.iter().zip(&self.u).filter(|(_, u)| **u > 0.0) {
            points.read(i, v.as_mut());
            let error: f64 = frame
                .map()
                .chunks_exact(n)
                .map(|row| (0..n).map(|k| row[k].abs() * (v.as_ref()[k] - frame.origin.as_ref()[k]).abs()).sum::<f64>())
                .map(|x| x * x)
                .sum();
            worst = worst.max(error);
        }
        (n + 2) as f64 * UNIT_ROUNDOFF * worst.sqrt()
    }
}
