//! The points of two cores between which the shortest way out leads.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::boundary::Boundary;
use super::expansion::WayOut;
use crate::body::{PointPair, Witness as _};
use crate::simplex::project;

/// Facets that are walked over in the plane of one of the boundary.
const MAX_WALK: usize = 64;

/// The points of both cores whose difference is the end `h·u` of the way out.
///
/// Where the difference is smooth there, they are those that the support point is made of. Where it has a face or an edge, they are
/// the weighted sums of the corners of the facet that zero's foot is in. Which of the two it is shows by which comes nearer to
/// `h·u`; what is left of the difference is split between both.
pub(super) fn points<V: Vector>(boundary: &Boundary<V>, nearest: usize, way: &WayOut<V>) -> PointPair<V> {
    let end = way.u() * way.h;
    let of_facet = at_foot(boundary, nearest);
    let rest = |(point, _): &(V, PointPair<V>)| (end - *point).length_squared();
    let of_vertex = (way.vertex.point, way.vertex.pair);
    let (point, pair) = if rest(&of_facet) < rest(&of_vertex) { of_facet } else { of_vertex };
    let half = (end - point) * V::Scalar::from_f64(0.5);
    PointPair { a: pair.a + half, b: pair.b - half }
}

/// The point of the boundary next to zero, and the points of both cores that it is made of.
///
/// The nearest facet may be one of several in a plane, of which another has zero's foot: the one that lies across the ridges that the
/// foot is beyond.
pub(super) fn at_foot<V: Vector>(boundary: &Boundary<V>, nearest: usize) -> (V, PointPair<V>) {
    let mut facet = nearest;
    let mut weights = [V::Scalar::ZERO; 4];
    for _ in 0..MAX_WALK {
        let corners = boundary.corner_points(facet);
        weights = project(&corners[..V::DIM], |corner| -corner).coordinates;
        let least = (1..V::DIM).fold(0, |least, i| if weights[i] < weights[least] { i } else { least });
        // NaN ends this too.
        if !(weights[least] < -V::Scalar::EPSILON * V::Scalar::from_f64(16.0)) {
            break;
        }
        facet = boundary.across(facet, least);
    }
    let weights = weights.map(|w| w.max(V::Scalar::ZERO));
    let sum = weights.iter().fold(V::Scalar::ZERO, |sum, &w| sum + w);
    let mut point = V::ZERO;
    let mut pair = PointPair::default();
    for (vertex, &weight) in boundary.corners(facet).iter().zip(&weights[..V::DIM]) {
        point += vertex.point * (weight / sum);
        pair = pair.plus(vertex.pair, weight / sum);
    }
    (point, pair)
}
