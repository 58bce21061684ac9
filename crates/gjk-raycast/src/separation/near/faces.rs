//! The faces of a simplex of points of the difference: vectors across them, and where a line through zero pierces them.

use convex_support::numerics::angular::cross;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::PointPair;
use crate::simplex::MAX_POINTS;
use crate::symmetric::{self, Across, axes_across, dot, way};

/// As many corners as there are dimensions, projected along a unit vector: their coordinates across it, and their
/// heights along it. The line through zero along that vector pierces their face where zero is within the projection.
pub(crate) struct ProjectedFace<V: Vector> {
    at: [Across<V::Scalar>; MAX_POINTS],
    heights: [V::Scalar; MAX_POINTS],
}

impl<V: Vector> ProjectedFace<V> {
    #[inline]
    pub(crate) fn along(n: V, points: &[V; MAX_POINTS]) -> Self {
        let [e, f] = axes_across(n);
        Self { at: points.map(|p| (e.dot(p), f.dot(p))), heights: points.map(|p| n.dot(p)) }
    }

    /// Whether zero is within the projection, and stays there as long as no projected corner moves farther than
    /// `moved`: to let zero out by a side, the ends of that side would have to come towards it by at least its
    /// distance.
    #[inline]
    pub(crate) fn surrounds_zero(&self, moved: V::Scalar) -> bool {
        let at = &self.at;
        if V::DIM == 2 {
            let (p, q) = (at[0].0, at[1].0);
            return p.min(q) < -moved && p.max(q) > moved;
        }
        // The product of the distance and the side, and what it has to exceed: the same for `moved`, with a bound on
        // the side, and the rounding of the product, which counts for sides that are short beside the corners'
        // distance.
        let sides = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
            let (p, q, (x, y)) = (at[i], at[j], way(at[i], at[j]));
            let rounded = V::Scalar::EPSILON * V::Scalar::from_f64(4.0) * ((p.0 * q.1).abs() + (p.1 * q.0).abs());
            [symmetric::cross(p, q), moved * (x.abs() + y.abs()) + rounded]
        });
        // Of corners in clockwise order, all products are negative.
        sides.iter().all(|[product, least]| product > least) || sides.iter().all(|[product, least]| -*product > *least)
    }

    /// The height at which the line through zero pierces the triangle or segment, and a bound on the rounding of this
    /// height. Zero has to be within the projection.
    ///
    /// Let `H` be the greatest of the heights. The parts of a segment are right to a few ε, so that no more than
    /// `8·ε·H` is lost. An area is wrong by `2·ε·L²`, where `L` is the distance of the farthest projected corner from
    /// zero. Three areas change the height by `12·ε·H·L²/area`, and the sums lose as much as for a segment.
    pub(crate) fn height_at_zero(&self) -> (V::Scalar, V::Scalar) {
        let (at, heights) = (&self.at, &self.heights);
        let epsilon = V::Scalar::EPSILON * V::Scalar::from_f64(16.0);
        let greatest = heights[..V::DIM].iter().fold(V::Scalar::ZERO, |most, height| most.max(height.abs()));
        if V::DIM == 2 {
            let (p, q) = (at[0].0, at[1].0);
            return ((heights[0] * q - heights[1] * p) / (q - p), epsilon * greatest);
        }
        let areas = [symmetric::cross(at[1], at[2]), symmetric::cross(at[2], at[0]), symmetric::cross(at[0], at[1])];
        let sum = areas[0] + areas[1] + areas[2];
        let height = (heights[0] * areas[0] + heights[1] * areas[1] + heights[2] * areas[2]) / sum;
        let farthest = at[..3].iter().fold(V::Scalar::ZERO, |most, &corner| most.max(dot(corner, corner)));
        (height, epsilon * greatest * (V::Scalar::ONE + farthest / sum.abs()))
    }
}

/// Vectors across the faces of a simplex, as they follow from the points of both shapes: exact edges, as of boxes
/// along the axes, stay exact. A face has two sides; the one along `axis` comes first, and for a simplex of full
/// dimension, with zero inside perhaps, both count. If the simplex is an edge in space, the vector across it nearest
/// to `axis`.
pub(super) fn across_faces<V: Vector>(pairs: &[PointPair<V>], axis: V) -> impl Iterator<Item = V> {
    let edge = |from: PointPair<V>, to: PointPair<V>| (to.a - from.a) - (to.b - from.b);
    let mut across = [V::ZERO; MAX_POINTS];
    let count = match *pairs {
        [p, q] if V::DIM == 2 => {
            across[0] = turned_right(edge(p, q));
            1
        }
        [p, q] => {
            across[0] = cross(cross(edge(p, q), axis), edge(p, q));
            1
        }
        [p, q, r] if V::DIM == 2 => {
            across = [edge(p, q), edge(q, r), edge(r, p), V::ZERO].map(turned_right);
            3
        }
        [p, q, r] => {
            across[0] = cross(edge(p, q), edge(p, r));
            1
        }
        [p, q, r, s] => {
            let face = |a, b, c| cross(edge(a, b), edge(a, c));
            across = [face(p, q, r), face(p, q, s), face(p, r, s), face(q, r, s)];
            4
        }
        _ => 0,
    };
    let sides = if count > 1 { 2 } else { 1 };
    let along = move |n: V| if n.dot(axis) < V::Scalar::ZERO { -n } else { n };
    across.into_iter().take(count).map(along).flat_map(move |n| [n, -n].into_iter().take(sides))
}

/// The vectors across an edge that are nearest to the axes of the coordinates, on the side of `n`. The rounding of a
/// long edge is that of its longest coordinates; along a vector that hardly has these, points may be known well enough
/// to tell bodies apart.
pub(super) fn about_edge<V: Vector>(edge: V, n: V) -> impl Iterator<Item = V> {
    let across = move |v: V| v - edge * (v.dot(edge) / edge.length_squared());
    (0..V::DIM).map(move |i| {
        let v = across(across(Vector::axis(i)));
        if v.dot(n) < V::Scalar::ZERO { -v } else { v }
    })
}

/// A vector of the plane turned by a right angle.
pub(crate) fn turned_right<V: Vector>(v: V) -> V {
    V::from_fn(|i| if i == 0 { v.get(1) } else { -v.get(0) })
}
