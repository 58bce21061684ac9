//! Polytopes with their vertices and edges.

use alloc::vec::Vec;

use super::convex_hull::{ConvexHull, convex_hull};
use super::graph::Graph;
use super::lanes::Lanes;
use super::{Polytope, Search, checked, middle, relative};
use crate::error::InvalidShape;
use crate::{Scalar, Vector, compiled_once};

/// Up to this many vertices a scan takes no longer than a table (measured: docs/support-maps.md).
const SCANNED: usize = 8;

impl<V: Vector> Polytope<V> {
    /// The convex hull of the points, reduced to its vertices, with the edges between them if there are many.
    ///
    /// For point clouds and meshes of any size: exact predicates sort out duplicates, points inside, on faces and on
    /// edges, and a flat cloud becomes a flat polygon. It takes `O(n log n)` time for most inputs, about 0.1 s
    /// for 60,000 points. [`points`](Self::points) are then the vertices, in the order given; a few that lie on a face
    /// without being a corner of it may be among them.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn hull_of(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        FromPoints::new(points).map(|found| found.polytope)
    }
}

/// A polytope and the data it was found from.
pub(super) struct FromPoints<V: Vector> {
    pub(super) polytope: Polytope<V>,
    /// The points relative to the middle, in the unit.
    pub(super) seen: Vec<[f64; 3]>,
    /// The unit of the points.
    pub(super) unit: V::Scalar,
    /// The hull of the points. Points a hundred orders of magnitude apart have none: then the polytope is complete, but
    /// takes the time of a scan.
    pub(super) hull: Option<ConvexHull>,
}

impl<V: Vector> FromPoints<V> {
    pub(super) fn new(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        from_checked(checked(points)?)
    }

    /// The hull of the vertices is found again without the other points, on which it depends how a face of more than
    /// three corners is divided: so the points of a polytope are all that it is made of.
    fn from_checked(mut points: Vec<V>) -> Result<Self, InvalidShape> {
        loop {
            let found = Self::once(&points)?;
            if found.polytope.points.len() == points.len() {
                return Ok(found);
            }
            points = found.polytope.points;
        }
    }

    fn once(points: &[V]) -> Result<Self, InvalidShape> {
        let middle = middle(points.iter().copied());
        let (seen, unit) = relative(points, middle);
        let coordinates = coordinates(&seen);
        let Some(hull) = convex_hull(&coordinates) else {
            return Ok(Self { polytope: Polytope::new(points.iter().copied())?, seen: coordinates, unit, hull: None });
        };
        let edges = edges(&hull);
        let mut kept: Vec<u32> = edges.iter().map(|e| e[0]).collect();
        kept.sort_unstable();
        kept.dedup();
        let vertices: Vec<V> = kept.iter().map(|&i| points[i as usize]).collect();
        let seen: Vec<V> = kept.iter().map(|&i| seen[i as usize]).collect();
        let search = if vertices.len() <= SCANNED {
            Search::Scan(Lanes::new(&seen))
        } else {
            let place = |i: u32| kept.partition_point(|&k| k < i) as u32;
            let edges: Vec<_> = edges.into_iter().map(|e| e.map(place)).collect();
            Search::Look { graph: Graph::new(&seen, &edges), unit }
        };
        let polytope = Polytope::searched_by(search, vertices, middle)?;
        Ok(Self { polytope, seen: coordinates, unit, hull: Some(hull) })
    }
}

compiled_once! {
    /// The hull of points that are finite.
    fn from_checked<V>(points: Vec<V>) -> Result<FromPoints<V>, InvalidShape> {
        FromPoints::from_checked(points)
    }
}

/// The points in three coordinates of double precision.
fn coordinates<V: Vector>(points: &[V]) -> Vec<[f64; 3]> {
    let coordinates = |p: &V| core::array::from_fn(|i| if i < V::DIM { p.get(i).as_f64() } else { 0.0 });
    points.iter().map(coordinates).collect()
}

/// The edges of the hull, in both directions; those of a point lead from it to itself.
fn edges(hull: &ConvexHull) -> Vec<[u32; 2]> {
    match hull {
        ConvexHull::Point(a) => alloc::vec![[*a, *a]],
        ConvexHull::Segment([a, b]) => alloc::vec![[*a, *b], [*b, *a]],
        ConvexHull::Polygon(corners) => {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).flat_map(|(&a, &b)| [[a, b], [b, a]]).collect()
        }
        // Every edge belongs to two triangles, which contain it in opposite directions.
        ConvexHull::Polyhedron(facets) => facets.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect(),
    }
}
