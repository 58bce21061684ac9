//! The least margin so far, and the bounds that exclude a pair.

use convex_support::numerics::elementary::sqrt;
use convex_support::{Scalar, Vector};

use crate::Margin;

/// The least margin so far with its link and obstacle.
pub(super) struct Least<V: Vector>(pub(super) Option<(Margin<V>, usize, usize)>);

impl<V: Vector> Default for Least<V> {
    fn default() -> Self {
        Self(None)
    }
}

impl<V: Vector> Least<V> {
    pub(super) fn take(&mut self, margin: Margin<V>, link: usize, obstacle: usize) {
        let better = self.0.is_none_or(|(least, l, o)| {
            margin.margin < least.margin || (margin.margin == least.margin && (link, obstacle) < (l, o))
        });
        if better {
            self.0 = Some((margin, link, obstacle));
        }
    }

    /// The lesser of two.
    pub(super) fn or(mut self, other: Self) -> Self {
        if let Some((margin, link, obstacle)) = other.0 {
            self.take(margin, link, obstacle);
        }
        self
    }

    /// The margin beyond which a pair is certainly not the least.
    pub(super) fn limit(&self) -> Limit {
        let margin = self.0.map_or(f64::INFINITY, |(least, ..)| least.margin.as_f64());
        Limit(margin, V::Scalar::EPSILON.as_f64())
    }

    /// Whether a pair with √(1 + m) ≥ `scale` is certainly not the least.
    pub(super) fn excludes(&self, scale: f64) -> bool {
        self.limit().excludes(scale)
    }

    /// √(1 + m) of the least, from below.
    pub(super) fn scale(&self) -> f64 {
        self.0.map_or(f64::INFINITY, |(least, ..)| scale(least))
    }
}

/// √(1 + m), from below.
pub(super) fn scale<V: Vector>(margin: Margin<V>) -> f64 {
    let rounding = 8.0 * V::Scalar::EPSILON.as_f64();
    sqrt(((1.0 + margin.margin.as_f64()) * (1.0 - rounding) - rounding).max(0.0))
}

/// A margin, with the ε of its type.
#[derive(Clone, Copy)]
pub(super) struct Limit(pub(super) f64, pub(super) f64);

impl Limit {
    /// Whether √(1 + m) ≥ `scale` means a greater m, by more than the largest rounding. A negative bound or NaN never
    /// does.
    #[inline]
    pub(super) fn excludes(self, scale: f64) -> bool {
        let scale = scale.max(0.0);
        scale * scale > self.squared()
    }

    /// The greatest √(1 + m) that is not excluded, but for rounding.
    pub(super) fn scale(self) -> f64 {
        sqrt(self.squared())
    }

    fn squared(self) -> f64 {
        let Self(margin, epsilon) = self;
        (1.0 + margin) * (1.0 + 64.0 * epsilon) + 64.0 * epsilon
    }
}
