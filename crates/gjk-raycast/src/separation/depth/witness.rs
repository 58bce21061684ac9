//! The points of two cores at the ends of the shortest way out.

use convex_support::{Scalar, Vector};

use super::WayOut;
use super::boundary::Boundary;
use crate::body::PointPair;
use crate::gjk::Gjk;
use crate::separation::MetPoint;
use crate::separation::cores::Cores;
use crate::simplex::project_rarely;

/// The most facets of a walk.
const MAX_FACETS: usize = 64;

/// Points of both cores whose distance is the length of the way out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends<V: Vector> {
    /// The unit vector out of the difference of the cores from one point to the other, and how far it is between them.
    pub(super) u: V,
    pub(super) depth: V::Scalar,
    pub(super) points: PointPair<V>,
}

/// The points of both cores whose difference is the end `h·u` of the way out, which is corrected if it has none.
///
/// If `h` is least among directions near `u`, the ball of radius `h` about zero touches the plane across `u` at a
/// point of the boundary, which is the end. If the boundary is smooth there, that is the support point. If it has a
/// face or an edge, the end is a weighted sum of support points: of the corners of the facet that the way leads
/// through, if these are of that face, and otherwise of those that GJK finds from there, which searches for the point
/// of the difference nearest to the end. Weighted sums with no negative weight are in the cores in any case. Their
/// distance from the end is split between both only if it is the rounding of the search.
///
/// If it is more, the way is not at the bottom of a basin yet, and its end is outside the difference by some `δ`. The
/// plane through the point nearest to the end, across the unit vector `n` from there to it, supports the difference,
/// and is nearer to zero by more than that: `h(n) = n·(h·u − δ·n) ≤ h − δ`. So it is the next way. For an edge or a
/// face the plane is more accurate than the short vector from it, by the part of `u` across it. If no lower way is
/// found, as with no support points left, the way ends at the nearest point, whose depth along it is between the
/// bounds. `None` if that point is on no side of zero that the way leads to.
pub(super) fn ends<V: Vector>(
    cores: &mut Cores<'_, V>,
    boundary: &Boundary<V>,
    nearest: usize,
    way: &mut WayOut<V>,
    max_iterations: usize,
) -> Option<Ends<V>> {
    let noise = cores.noise();
    let ends = |points: PointPair<V>, u, depth, rest: V| {
        let half = rest * V::Scalar::from_f64(0.5);
        Ends { u, depth, points: PointPair { a: points.a + half, b: points.b - half } }
    };
    loop {
        let (u, rest) = (way.u(), way.rest());
        if rest.norm() <= noise {
            return Some(ends(way.vertex.pair, u, way.h, rest));
        }
        let end = u * way.h;
        let mut state = nearest_to(cores, boundary, boundary.pierced(u, nearest), end, max_iterations);
        let MetPoint { point, points, .. } = MetPoint::new(cores, &mut state);
        if point.norm() <= noise {
            return Some(ends(points, u, way.h, -point));
        }
        let across = project_rarely(state.simplex.points(), &|_| u).across.unit();
        let mut lower = None;
        for n in [across, state.normal.unit().map(|n| -n)].into_iter().flatten() {
            if cores.iterations < max_iterations && lower.is_none() {
                lower = cores.support(n).map(WayOut::new).filter(|next| next.h < way.h);
            }
        }
        if let Some(next) = lower {
            *way = next;
            continue;
        }
        // Not along the vector to the nearest point: the radii would magnify by how much that leans.
        let reached = end + point;
        let (length, depth) = (reached.norm(), u.dot(reached));
        let is_before = depth > Scalar::ZERO && length <= way.h;
        return (length <= noise || is_before).then(|| ends(points, u, depth, Vector::ZERO));
    }
}

/// The point of the difference nearest to a `target` outside it or on its boundary, relative to the target: by the
/// facet beside it, and if that is farther than rounding, by GJK.
pub(super) fn nearest_to<V: Vector>(
    cores: &mut Cores<'_, V>,
    boundary: &Boundary<V>,
    from: usize,
    target: V,
    max_iterations: usize,
) -> Gjk<V> {
    let corners = boundary.corners(beside(boundary, from, target));
    cores.nearest_to(target, corners[..V::DIM].iter().map(|&corner| boundary.vertex(corner)), max_iterations)
}

/// The facet that a point is above, or nearly above: the next one across the ridges that the point's projection is
/// beyond, as its coordinates say.
fn beside<V: Vector>(boundary: &Boundary<V>, from: usize, point: V) -> usize {
    let mut facet = from;
    for _ in 0..MAX_FACETS {
        let weights = project_rarely(&boundary.corner_points(facet)[..V::DIM], &|corner| point - corner).coordinates;
        let least = (1..V::DIM).fold(0, |least, i| if weights[i] < weights[least] { i } else { least });
        // NaN ends this too.
        if !(weights[least] < -V::Scalar::EPSILON * V::Scalar::from_f64(16.0)) {
            break;
        }
        facet = boundary.across(facet, least);
    }
    facet
}
