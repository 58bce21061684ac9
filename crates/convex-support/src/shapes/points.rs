//! Sets of points, relative to the middle of their bounding box.

use crate::numerics::bound::raised_vector;
use crate::numerics::twofold::lost_in_sum;
use crate::{Rounding, Scalar, Vector};

/// The middle of the bounding box of a non-empty list of points. Its zeros are positive, so that it is the same, to the
/// last bit, without points that are not vertices.
#[inline]
pub(super) fn middle<V: Vector>(points: impl IntoIterator<Item = V>) -> V {
    let mut points = points.into_iter();
    let first = points.next().unwrap_or(V::ZERO);
    let (low, high) = points.fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
    let half = V::Scalar::from_f64(0.5);
    low * half + high * half + V::ZERO
}

/// The points relative to their middle.
#[inline]
pub(super) fn relative<V: Vector, const N: usize>(points: [V; N]) -> [V; N] {
    let middle = middle(points);
    points.map(|point| point - middle)
}

/// The largest distance of the points from their middle, for each coordinate.
#[inline]
pub(super) fn extent<V: Vector, const N: usize>(points: &[V; N]) -> V {
    relative(*points).into_iter().fold(V::ZERO, |extent, point| extent.max(point.abs()))
}

/// The rounding of points that are computed relative to their middle: the exact error of the subtraction.
pub(super) fn rounding_of_points<V: Vector>(points: &[V]) -> Rounding<V> {
    let middle = middle(points.iter().copied());
    let (extent, lost) = points.iter().fold((V::ZERO, V::ZERO), |(extent, lost), &point| {
        (extent.max((point - middle).abs()), lost.max(lost_in_sum(point, -middle).abs()))
    });
    Rounding::exact(raised_vector(extent)).with_error(lost)
}
