//! Numbers that look random and are the same on every machine.

use convex_support::{Scalar, Vector};

/// Xorshift.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// In 0..1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In −1..1; at times a round number.
    pub(crate) fn signed(&mut self) -> f64 {
        if self.below(8) == 0 { [-1.0, -0.5, 0.0, 0.5, 1.0][self.below(5)] } else { 2.0 * self.unit() - 1.0 }
    }

    pub(crate) fn vector<V: Vector>(&mut self, size: f64) -> V {
        V::from_fn(|_| V::Scalar::from_f64(size * self.signed()))
    }
}
