//! Polytopes that know the planes of their facets.

use alloc::vec::Vec;

use glam::DVec3;

use super::Polytope;
use super::convex_hull::ConvexHull;
use super::hull::FromPoints;
use super::lanes::{WIDTH, coordinate, side_by_side};
use crate::error::InvalidShape;
use crate::line_crossing::faceted;
use crate::{Core, Feature, Hint, LineCrossing, Rounding, Scalar, SupportMap, Vector};

/// [`WIDTH`] planes, each a unit outward normal by coordinates and how far the polytope reaches along it from the middle.
pub(crate) type Planes<S> = [[S; WIDTH]; 4];

/// The convex hull of points both ways: by its vertices, as a [`Polytope`], and by the half-spaces of its facets.
///
/// It is for lines: [`line_crossing`](crate::line_crossing) clips a line by every facet, and tells where it leaves, too. That takes time
/// proportional to the number of facets. Up to about a hundred facets it takes less time than a ray cast by support points, which
/// needs no facets and whose time hardly grows (measured: docs/performance.md, W1).
///
/// ```
/// use convex_support::{Faceted, glam::DVec3, line_crossing};
///
/// let octahedron = Faceted::hull_of([
///     DVec3::X,
///     DVec3::Y,
///     DVec3::Z,
///     DVec3::NEG_X,
///     DVec3::NEG_Y,
///     DVec3::NEG_Z,
/// ])?;
/// let source = DVec3::new(0.25, 0.25, 3.0);
/// let crossing = line_crossing(&octahedron, source, DVec3::NEG_Z).crossing().ok_or("a miss")?;
/// assert!((crossing.entry - 2.5).abs() < 1e-15 && (crossing.exit - 3.5).abs() < 1e-15);
/// assert!((crossing.normal - DVec3::ONE.normalize()).length() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Faceted<V: Vector> {
    polytope: Polytope<V>,
    planes: Vec<Planes<V::Scalar>>,
    count: usize,
}

impl<V: Vector> Faceted<V> {
    /// The convex hull of the points, as of [`Polytope::hull_of`], with its facets.
    ///
    /// # Errors
    /// As [`Polytope::new`].
    pub fn hull_of(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        let FromPoints { polytope, seen, hull } = FromPoints::new(points)?;
        // Without a hull, the bounding box is all that is known.
        let mut normals: Vec<V> = normals(&hull.unwrap_or(ConvexHull::Point(0)), &seen, V::DIM)
            .into_iter()
            .filter_map(|n| V::from_fn(|i| V::Scalar::from_f64(n[i])).unit())
            .collect();
        distinct(&mut normals);
        let facet = |n: &V| (*n, n.dot(polytope.core_support(*n, &mut Hint::new())));
        let facets: Vec<(V, V::Scalar)> = normals.iter().map(facet).collect();
        let planes = side_by_side(&facets, |(n, reach), i| if i == 3 { reach } else { coordinate(n, i) });
        Ok(Self { planes, count: facets.len(), polytope })
    }

    /// The same set by its vertices.
    #[must_use]
    pub const fn polytope(&self) -> &Polytope<V> {
        &self.polytope
    }

    /// The vertices.
    #[must_use]
    pub fn points(&self) -> &[V] {
        self.polytope.points()
    }

    /// The half-spaces whose intersection the set is: unit outward normals `n` and how far the set reaches along them, so that it is
    /// all `x` with `n·x ≤ b`, to rounding of its size. Triangles in one plane count once; a flat set has facets on both sides and
    /// around it.
    pub fn half_spaces(&self) -> impl ExactSizeIterator<Item = (V, V::Scalar)> + '_ {
        (0..self.count).map(|i| {
            let (n, reach) = self.facet(i);
            (n, reach + n.dot(self.polytope.middle))
        })
    }

    /// The normal of a facet, and how far the polytope reaches along it from the middle.
    pub(crate) fn facet(&self, index: usize) -> (V, V::Scalar) {
        let (planes, l) = (&self.planes[index / WIDTH], index % WIDTH);
        (V::from_fn(|i| planes[i][l]), planes[3][l])
    }

    pub(crate) fn planes(&self) -> &[Planes<V::Scalar>] {
        &self.planes
    }
}

/// Takes away what is another normal again to rounding: the triangles of one plane.
fn distinct<V: Vector>(normals: &mut Vec<V>) {
    let key = |n: &V| [0, 1, V::DIM - 1].map(|i| n.get(i).as_f64());
    normals.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(core::cmp::Ordering::Equal));
    let within = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
    normals.dedup_by(|a, b| (*a - *b).abs().max_element() <= within);
}

/// Outward normals, of any length, of half-spaces whose intersection the hull is, in the first `dimension` coordinates.
///
/// A plane is laid as far out as the polytope reaches along its normal, so that rounding of a normal cuts nothing off. A sliver's
/// normal is known across it only to `ε` by its width; but what it leaves uncut is as narrow as it is, between its neighbours.
fn normals(hull: &ConvexHull, points: &[[f64; 3]], dimension: usize) -> Vec<DVec3> {
    let at = |i: u32| DVec3::from(points[i as usize]);
    let both = |n: DVec3| [n, -n];
    match hull {
        ConvexHull::Point(_) => DVec3::AXES[..dimension].iter().copied().flat_map(both).collect(),
        // Along it, and across: what is left of the axes, and in space what is across those too.
        ConvexHull::Segment([a, b]) => {
            let along = at(*b) - at(*a);
            let third = if dimension == 2 { DVec3::Z } else { DVec3::AXES[along.abs().min_position()] };
            let across = along.cross(third);
            let mut normals: Vec<DVec3> = both(along).into_iter().chain(both(across)).collect();
            if dimension == 3 {
                normals.extend(both(along.cross(across)));
            }
            normals
        }
        ConvexHull::Polygon(corners) => {
            let next = || corners.iter().cycle().skip(1);
            let first = at(corners[0]);
            // Twice the area as a vector: the sum of the triangles from the first corner.
            let triangle = |(&p, &q): (&u32, &u32)| (at(p) - first).cross(at(q) - first);
            let area: DVec3 = corners.iter().zip(next()).map(triangle).sum();
            let side = |(&p, &q): (&u32, &u32)| (at(q) - at(p)).cross(area);
            let mut normals: Vec<DVec3> = corners.iter().zip(next()).map(side).collect();
            if dimension == 3 {
                normals.extend(both(area));
            }
            normals
        }
        ConvexHull::Polyhedron(triangles) => triangles
            .iter()
            .map(|&[a, b, c]| {
                let [a, b, c] = [a, b, c].map(at);
                // The two shorter edges lose the least.
                let edges = [b - a, c - b, a - c];
                let longest = DVec3::from(edges.map(DVec3::length_squared)).max_position();
                edges[(longest + 1) % 3].cross(edges[(longest + 2) % 3])
            })
            .collect(),
    }
}

/// Everything as the polytope, and the crossing by a line beside.
impl<V: Vector> SupportMap for Faceted<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        self.polytope.support(direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        self.polytope.core()
    }

    #[inline(always)]
    fn core_support(&self, direction: V, hint: &mut Hint) -> V {
        self.polytope.core_support(direction, hint)
    }

    #[inline]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        faceted(self, radius, source, direction).into()
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        self.polytope.core_support_feature(direction, slab, feature);
    }

    #[inline]
    fn rounding(&self) -> Rounding<V> {
        self.polytope.rounding
    }
}
