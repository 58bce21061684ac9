//! The points of two cores between which the shortest way out leads.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::boundary::Boundary;
use super::expansion::WayOut;
use crate::body::{PointPair, Witness as _};
use crate::simplex::{MAX_POINTS, cross, project};

/// The part of rounding that a boundary may be below a plane to count as flat: that of the difference is flatter than those of the shapes.
const FLAT: f64 = 1.0 / 1024.0;

/// Facets that are walked over at most.
const MAX_WALK: usize = 64;

/// The points of both cores whose difference is the end `h·u` of the way out.
///
/// Where the difference is smooth there, they are those that the support point is made of. Where it has a face or an edge, they are
/// the weighted sums of the corners of the facet that zero's foot is in. That facet is beside another end where several ways are as
/// short, as of shapes about one centre; then it is the one that the way out leads through. Which of these it is shows by which comes
/// nearest to `h·u`, as points of cores that barely meet do which GJK has `met`; the first to come within `rounding` will do. What is left
/// of the difference is split between both.
///
/// A support point is beside the end, if at all, in the plane through it. A ball of radius `h` touches the boundary there from within,
/// so that it is below that plane by no more than `x²/2h` at a distance `x`.
pub(super) fn points<V: Vector>(
    boundary: &Boundary<V>,
    nearest: usize,
    way: &WayOut<V>,
    rounding: V::Scalar,
    met: impl FnOnce() -> (V, PointPair<V>),
) -> PointPair<V> {
    let u = way.u();
    let end = u * way.h;
    let rest = |point: V| (end - point).length_squared();
    let mut best = (way.vertex.point, way.vertex.pair);
    let mut least = rest(best.0);
    let enough = rounding * rounding;
    let is_end = least <= enough.max(rounding * way.h * V::Scalar::from_f64(FLAT));
    let mut consider = |found: (V, PointPair<V>)| {
        let rest = rest(found.0);
        if rest < least {
            (best, least) = (found, rest);
        }
        rest <= enough
    };
    if !is_end && !consider(at_foot(boundary, nearest)) {
        if boundary.facet_at(nearest).normal != u {
            let _ = consider(on_way(boundary, nearest, u));
        }
        let _ = consider(met());
    }
    let (point, pair) = best;
    let half = (end - point) * V::Scalar::from_f64(0.5);
    PointPair { a: pair.a + half, b: pair.b - half }
}

/// The point of the boundary next to zero, and the points of both cores that it is made of.
///
/// The nearest facet may be one of several in a plane, of which another has zero's foot: the one that lies across the ridges that the
/// foot is beyond.
pub(super) fn at_foot<V: Vector>(boundary: &Boundary<V>, nearest: usize) -> (V, PointPair<V>) {
    walk(boundary, nearest, |corners| project(corners, |corner| -corner).coordinates)
}

/// The point of the boundary in a direction from zero, which is within, and the points of both cores that it is made of.
///
/// The coordinate of a corner is, but for a factor that all have, the volume that the direction spans with the other corners.
fn on_way<V: Vector>(boundary: &Boundary<V>, nearest: usize, u: V) -> (V, PointPair<V>) {
    let area = |p: V, q: V| p.get(0) * q.get(1) - p.get(1) * q.get(0);
    walk(boundary, nearest, |corners| {
        let mut weights = [V::Scalar::ZERO; MAX_POINTS];
        match *corners {
            [p, q] => (weights[0], weights[1]) = (area(u, q), area(p, u)),
            [p, q, r] => {
                for (weight, [p, q]) in weights.iter_mut().zip([[q, r], [r, p], [p, q]]) {
                    *weight = u.dot(cross(p, q));
                }
            }
            _ => {}
        }
        let sum = weights.iter().fold(V::Scalar::ZERO, |sum, &w| sum + w.abs());
        weights.map(|weight| weight / sum)
    })
}

/// From facet to facet across the ridge that a point is beyond, as its coordinates by the corners say, to the facet that it is in.
fn walk<V: Vector>(
    boundary: &Boundary<V>,
    from: usize,
    coordinates: impl Fn(&[V]) -> [V::Scalar; MAX_POINTS],
) -> (V, PointPair<V>) {
    let mut facet = from;
    let mut weights = [V::Scalar::ZERO; MAX_POINTS];
    for _ in 0..MAX_WALK {
        weights = coordinates(&boundary.corner_points(facet)[..V::DIM]);
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
