//! The simplex that iterations carry: up to four points of a core, each with what it is made of.

use convex_support::{Scalar, Vector};

/// As many points as a simplex in 3D can have.
pub(crate) const MAX_POINTS: usize = 4;

/// Points of a convex set and what they came from, the newest last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex<V: Vector, W> {
    points: [V; MAX_POINTS],
    witnesses: [W; MAX_POINTS],
    weights: [V::Scalar; MAX_POINTS],
    len: usize,
}

impl<V: Vector, W: Copy + Default> Simplex<V, W> {
    pub(crate) fn new() -> Self {
        Self {
            points: [V::ZERO; MAX_POINTS],
            witnesses: [W::default(); MAX_POINTS],
            weights: [V::Scalar::ZERO; MAX_POINTS],
            len: 0,
        }
    }

    pub(crate) fn points(&self) -> &[V] {
        &self.points[..self.len]
    }

    /// Adds a point with no weight yet.
    ///
    /// # Panics
    /// If there are four already.
    pub(crate) fn push(&mut self, point: V, witness: W) {
        debug_assert!(self.len < MAX_POINTS, "a simplex has at most four points");
        self.points[self.len] = point;
        self.witnesses[self.len] = witness;
        self.weights[self.len] = V::Scalar::ZERO;
        self.len += 1;
    }

    /// Takes the weights, and keeps only the points that have one.
    pub(crate) fn retain(&mut self, weights: [V::Scalar; MAX_POINTS]) {
        let mut kept = 0;
        for (i, &weight) in weights.iter().enumerate().take(self.len) {
            if weight > V::Scalar::ZERO {
                self.points[kept] = self.points[i];
                self.witnesses[kept] = self.witnesses[i];
                self.weights[kept] = weight;
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// The weights and witnesses.
    pub(crate) fn weighted(&self) -> impl Iterator<Item = (V::Scalar, W)> + '_ {
        (0..self.len).map(|i| (self.weights[i], self.witnesses[i]))
    }
}
