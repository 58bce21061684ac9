//! A triangle in coordinates of its own plane.

use crate::Vector;

/// A triangle in its own plane: the longest edge from `(0, 0)` to `(length, 0)`, the third corner above it at
/// `(along, height)`, so that `0 ≤ along ≤ length`.
///
/// Signs of areas in these coordinates tell inside from outside without the cancellation of Gram determinants.
pub(crate) struct PlanarTriangle<V: Vector> {
    /// The corners, those of the longest edge first.
    pub(crate) corners: [V; 3],
    /// Unit vectors along the longest edge and up to the third corner.
    pub(crate) axes: [V; 2],
    pub(crate) length: V::Scalar,
    pub(crate) along: V::Scalar,
    pub(crate) height: V::Scalar,
}

impl<V: Vector> PlanarTriangle<V> {
    /// `None` if the triangle of these corners is a segment or a point.
    pub(crate) fn new(corners: [V; 3]) -> Option<Self> {
        let [a, b, c] = longest_edge_first(corners);
        let u = (b - a).unit()?;
        let along = u.dot(c - a);
        let up = (c - a) - u * along;
        // Once more, because `up` may be small against the subtracted part.
        let up = up - u * u.dot(up);
        let v = up.unit()?;
        Some(Self { corners: [a, b, c], axes: [u, v], length: u.dot(b - a), along, height: v.dot(up) })
    }
}

/// The corners in the same cyclic order, the longest edge between the first two.
pub(crate) fn longest_edge_first<V: Vector>([a, b, c]: [V; 3]) -> [V; 3] {
    let (ab, bc, ca) = ((b - a).norm(), (c - b).norm(), (a - c).norm());
    if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
