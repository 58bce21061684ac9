//! The point of a triangle nearest a given point.

use super::segment::clamp_to_segment;
use crate::shapes::planar_triangle::{PlanarTriangle, longest_edge_first};
use crate::{Scalar, Vector};

/// Outside, the answer is the foot on an edge that has the point on its outer side, or else a corner. Comparing the
/// distances of all three edges instead would lose half the digits, since a distance is flat at its minimum.
pub(crate) fn closest_of_triangle<V: Vector>(corners: [V; 3], x: V) -> V {
    let Some(PlanarTriangle { corners: [a, b, c], axes: [u, v], length, along, height }) = PlanarTriangle::new(corners)
    else {
        let [a, b, _] = longest_edge_first(corners);
        return clamp_to_segment([a, b], x);
    };
    let (p, q) = (u.dot(x - a), v.dot(x - a));
    let beyond_ab = q < V::Scalar::ZERO;
    let beyond_bc = (length - p) * height < q * (length - along);
    let beyond_ca = p * height < q * along;
    let mut corner: Option<V> = None;
    for (beyond, edge) in [(beyond_ab, [a, b]), (beyond_bc, [b, c]), (beyond_ca, [c, a])] {
        if beyond {
            let foot = clamp_to_segment(edge, x);
            if foot != edge[0] && foot != edge[1] {
                return foot;
            }
            corner = Some(corner.map_or(foot, |other| nearer(x, other, foot)));
        }
    }
    corner.unwrap_or(if V::DIM == 2 { x } else { a + u * p + v * q })
}

/// Whichever of two points is nearer to `x`.
#[inline]
fn nearer<V: Vector>(x: V, p: V, q: V) -> V {
    if (x - q).norm() < (x - p).norm() { q } else { p }
}
