//! By how much computed points of the difference of two cores may be wrong.
//!
//! A point is wrong by what the [shapes state](Rounding) of their support points, and by what rounding has lost since.
//! Both are known coordinate by coordinate, which tells more than a length: for a horizontal floor the error along the
//! vertical does not depend on its width. What a shape states of the length counts where that is less, as for a body
//! that is turned.

use convex_support::{Rounding, Scalar, Vector};
use num_traits::Float as _;

use crate::pair::AnyPair;

/// The rounding of a point of the difference, in units of ε times the coordinates of the cores and of the offset of
/// their origins.
///
/// A dot product with a unit vector counts in: its three products and two sums lose 1.5 of their magnitudes. The sums
/// `a − b` and `a − b + o` lose 0.5 each.
pub(crate) const SUM: f64 = 2.6;
const OFFSET: f64 = 2.1;

/// A bound on the error of points of the difference of two cores, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uncertainty<V: Vector> {
    /// A bound on the coordinates of the sum of points of both shapes.
    pub(crate) extent: V,
    /// What both shapes state, and its length.
    stated: V,
    pub(crate) stated_length: V::Scalar,
    /// What rounding has lost besides.
    lost: V,
}

impl<V: Vector> Uncertainty<V> {
    /// The error of the difference of two support points that is not rounded itself: what both shapes state of them, in
    /// the unit.
    pub(crate) fn new(pair: &AnyPair<'_, V>, per_unit: V::Scalar) -> Self {
        let Self { extent, stated, stated_length, lost } = Self::of(pair.shapes.each().map(|shape| shape.rounding()));
        let stated_length = stated_length.min(pair.error()) * per_unit;
        Self { extent: extent * per_unit, stated: stated * per_unit, stated_length, lost }
    }

    fn of([a, b]: [Rounding<V>; 2]) -> Self {
        let (stated, stated_length) = (a.error + b.error, a.error_length + b.error_length);
        Self { extent: a.extent + b.extent, stated, stated_length, lost: V::ZERO }
    }

    /// For the sum of two points, each rounded to the shapes' extents, and an exact offset of their origins; in the
    /// world's unit.
    #[inline(always)]
    pub(crate) fn of_exact_offset(shapes: [Rounding<V>; 2], offset: V) -> Self {
        Self::of(shapes).of_sums(offset)
    }

    /// The same where each point is added up in the vectors' own precision, with an exact offset.
    #[inline(always)]
    pub(crate) fn of_sums(self, offset: V) -> Self {
        let [sum, of_offset] = [SUM, OFFSET].map(|units| V::Scalar::EPSILON * Scalar::from_f64(units));
        self.with(self.extent * sum + offset.abs() * of_offset)
    }

    /// The same where so much more is lost.
    #[inline(always)]
    pub(crate) fn with(self, lost: V) -> Self {
        Self { lost: self.lost + lost, ..self }
    }

    /// Whether what the shapes state is much less along one axis than along another.
    pub(crate) fn is_uneven(&self) -> bool {
        self.stated.min_element() * V::Scalar::from_f64(4.0) < self.stated.max_element()
    }

    /// The least error along any axis.
    pub(crate) fn least(&self) -> V::Scalar {
        (self.stated + self.lost).min_element()
    }

    /// A bound on the error of `n·p` for a unit vector `n` and a point `p`.
    #[inline]
    pub(crate) fn along(&self, n: V) -> V::Scalar {
        let n = n.abs();
        n.dot(self.stated).min(self.stated_length) + n.dot(self.lost)
    }

    /// A vector along the unit vector `n` for which `n·p`, less its error, is greatest: with `e` the error of the
    /// coordinates, `n·p − Σ eᵢ|nᵢ|` is a sum of the products of `|nᵢ|` and `|pᵢ| − eᵢ`. Zero if none is positive.
    pub(crate) fn most_certain(&self, p: V) -> V {
        let least = self.stated + self.lost;
        p.max(least) - least + (p.min(-least) + least)
    }

    /// A bound on the length of the error of a point.
    #[inline(never)]
    pub(crate) fn length(&self) -> V::Scalar {
        self.stated_length + self.lost.norm()
    }

    /// By how much the exact point for a computed one may be farther from zero. Along its own direction it is as wrong
    /// as along any unit vector, and what it is wrong by across hardly adds to the length.
    #[inline(never)]
    pub(crate) fn beyond(&self, p: V) -> V::Scalar {
        let along = p.unit().map_or_else(|| self.length(), |u| self.along(u));
        self.beyond_length(p.norm(), along)
    }

    /// The same for a point at this length, which is wrong by `along` in its own direction.
    #[inline(always)]
    pub(crate) fn beyond_length(&self, length: V::Scalar, along: V::Scalar) -> V::Scalar {
        along + added_across(length + along, self.length())
    }
}

/// By how much an error `e` across a direction adds to the length `l` along it, at most: `√(l² + e²) − l` is
/// `e²/(l + √(l² + e²))`, where the root is no less than either.
#[inline(always)]
fn added_across<S: Scalar>(length: S, error: S) -> S {
    // Its own rounding. If both are zero, the quotient is no number, and the error the minimum.
    (error * (error / (length + length.max(error))) * (S::ONE + S::EPSILON * S::from_f64(4.0))).min(error)
}

#[cfg(test)]
mod tests {
    use super::added_across;

    /// What is known to lie `along` a direction, and to be wrong by some error across it, is no longer than that.
    #[test]
    fn an_error_across_makes_a_length_greater() {
        for (length, error) in [(3.0, 4.0), (4.0, 3.0), (1.0, 1e-9), (1e-9, 1.0), (0.0, 1.0), (1.0, 0.0_f64)] {
            let bound = length + added_across(length, error);
            assert!(bound >= length.hypot(error) && bound <= length + error, "{length} {error} {bound}");
        }
        assert!(added_across(1.0_f64, f64::NAN).is_nan());
    }
}
