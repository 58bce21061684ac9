//! Polytopes with the planes of their facets.

use alloc::vec;
use alloc::vec::Vec;

use num_traits::Float as _;

use glam::DVec3;

use super::Polytope;
use super::convex_hull::{ConvexHull, convex_hull, farthest_along_an_axis};
use super::hull::FromPoints;
use super::lanes::{coordinate, side_by_side};
use super::planes::{Planes, facet};
use crate::error::InvalidShape;
use crate::line_crossing::{NearLine, faceted, lanes};
use crate::numerics::bound::roundings;
use crate::{
    CertainCrossing, Core, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Lines, Rounding, Scalar, SupportMap,
    Vector, compiled_once,
};

/// The convex hull of points in two forms: by its vertices, as a [`Polytope`], and by the half-spaces of its facets.
///
/// It is for lines: a ray cast clips a ray by every facet, and [`line_crossing`](crate::line_crossing) also tells
/// where it leaves. This takes time proportional to the number of facets. Up to about a hundred facets it takes less
/// time than a ray cast by support points, which needs no facets and whose time hardly grows (measured:
/// docs/comparison.md, W1).
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
#[doc(alias("half_spaces", "polyhedron"))]
#[derive(Clone, Debug, PartialEq)]
pub struct Faceted<V: Vector> {
    polytope: Polytope<V>,
    planes: Vec<Planes<V::Scalar>>,
    count: usize,
    /// Every point behind all planes by more than this is in the hull of the points relative to the middle; infinite if
    /// this is not known.
    uncut: V::Scalar,
}

impl<V: Vector> Faceted<V> {
    /// The convex hull of the points, as [`Polytope::hull_of`] finds it, with its facets.
    ///
    /// # Errors
    /// Those of [`Polytope::new`].
    pub fn hull_of(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        FromPoints::new(points).map(with_facets)
    }

    fn of(FromPoints { polytope, seen, unit, hull }: FromPoints<V>) -> Self {
        // Without a hull, only the bounding box is known.
        let hull = hull.unwrap_or(ConvexHull::Point(0));
        let unit_normal = |n: DVec3| V::from_fn(|i| V::Scalar::from_f64(n[i])).unit();
        let mut normals: Vec<V> = normals(&hull, &seen, V::DIM).into_iter().filter_map(unit_normal).collect();
        let corners = corners(&hull, V::DIM);
        // A facet without a normal has no plane.
        let has_all_facets = !corners.is_empty() && corners.len() == normals.len();
        normals.extend(silhouette(&hull, &seen, V::DIM).into_iter().filter_map(unit_normal));
        let (distinct, plane_of) = distinct(&normals);
        let reaching = |n: V| (n, n.dot(polytope.core_support(n, &mut Hint::new())));
        let facets: Vec<(V, V::Scalar)> = distinct.into_iter().map(reaching).collect();
        let corner = |i: u32| V::from_fn(|axis| V::Scalar::from_f64(seen[i as usize][axis])) * unit;
        let uncut = if has_all_facets {
            let facets_of = plane_of.iter().map(|&plane| facets[plane]);
            uncut(&polytope, &facets, corners.into_iter().map(|corners| corners.map(corner)).zip(facets_of))
        } else {
            V::Scalar::infinity()
        };
        let planes = side_by_side(&facets, |(n, reach), i| if i == 3 { reach } else { coordinate(n, i) });
        Self { planes, count: facets.len(), uncut, polytope }
    }

    /// The same set in terms of its vertices.
    #[must_use]
    pub const fn polytope(&self) -> &Polytope<V> {
        &self.polytope
    }

    /// The vertices.
    #[must_use]
    pub fn points(&self) -> &[V] {
        self.polytope.points()
    }

    /// The half-spaces whose intersection is the set: unit outward normals `n` with the support values `b`, so that the
    /// set is all `x` with `n·x ≤ b`, to rounding of its size. Triangles in one plane count once; a flat set has facets
    /// on both sides and around it.
    pub fn half_spaces(&self) -> impl ExactSizeIterator<Item = (V, V::Scalar)> + '_ {
        (0..self.count).map(|i| {
            let (n, reach): (V, _) = facet(&self.planes, i);
            (n, reach + n.dot(self.polytope.middle))
        })
    }
}

compiled_once! {
    /// The polytope with its facets.
    fn with_facets<V>(found: FromPoints<V>) -> Faceted<V> {
        Faceted::of(found)
    }
}

/// The normals without repetitions to rounding, as from triangles in one plane; and for each the index of its normal
/// among those.
fn distinct<V: Vector>(normals: &[V]) -> (Vec<V>, Vec<usize>) {
    let key = |i: usize| [0, 1, V::DIM - 1].map(|axis| normals[i].get(axis).as_f64());
    let mut order: Vec<usize> = (0..normals.len()).collect();
    order.sort_by(|&a, &b| key(a).partial_cmp(&key(b)).unwrap_or(core::cmp::Ordering::Equal));
    let within = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
    let (mut kept, mut which): (Vec<V>, Vec<usize>) = (Vec::new(), vec![0; normals.len()]);
    for i in order {
        let is_known = kept.last().is_some_and(|&last| (normals[i] - last).abs().max_element() <= within);
        if !is_known {
            kept.push(normals[i]);
        }
        which[i] = kept.len() - 1;
    }
    (kept, which)
}

/// The corners of the facets of a hull that spans the space, in the order of their [`normals`]; in the plane the second
/// is repeated.
fn corners(hull: &ConvexHull, dimension: usize) -> Vec<[u32; 3]> {
    match hull {
        ConvexHull::Polygon(corners) if dimension == 2 => {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(&p, &q)| [p, q, q]).collect()
        }
        ConvexHull::Polyhedron(triangles) => triangles.clone(),
        _ => Vec::new(),
    }
}

/// If corners are farther behind the plane of their facet, in ε of the size, they are of slivers, and nothing is known.
const FARTHEST_BEHIND: f64 = 64.0;

/// Every point behind all planes by more than this is in the hull. All facets of the hull are given, each with its
/// corners and its plane; more planes only make fewer points be behind all.
///
/// Let no corner be farther behind the plane of its facet than that, and let a point `o` of the hull, here the mean of
/// the vertices, be farther behind all planes. A line from `o` to a point `x` outside leaves the hull through some
/// facet, at a point `q` between its corners. From `o` to `q` the line comes nearer to the plane of that facet, and
/// from there to `x` still nearer or past it: so `x` is not farther behind that plane than the corners are.
fn uncut<V: Vector>(
    polytope: &Polytope<V>,
    planes: &[(V, V::Scalar)],
    facets: impl Iterator<Item = ([V; 3], (V, V::Scalar))>,
) -> V::Scalar {
    let (count, extent) = (polytope.points.len() as f64, polytope.extent);
    let behind = |(n, reach): (V, V::Scalar), p: V| reach - n.dot(p);
    let of_corners = facets.flat_map(|(corners, plane)| corners.map(|p| behind(plane, p)));
    let farthest = of_corners.fold(V::Scalar::ZERO, V::Scalar::max) + roundings(8.0, extent);
    let sum = polytope.points.iter().fold(V::ZERO, |sum, &p| sum + (p - polytope.middle));
    let mean = sum / V::Scalar::from_f64(count);
    let apart = farthest + roundings(count + 16.0, extent);
    let is_known = farthest <= extent * (V::Scalar::EPSILON * V::Scalar::from_f64(FARTHEST_BEHIND))
        && planes.iter().all(|&plane| behind(plane, mean) > apart);
    if is_known { farthest } else { V::Scalar::infinity() }
}

/// Outward normals, of any length, of half-spaces whose intersection is the hull, in the first `dimension` coordinates.
///
/// A plane is placed at the support value of the polytope along its normal, so that rounding of a normal cuts nothing
/// off. The error of a sliver's normal across it is `ε` by its width; but the part that it leaves uncut, between its
/// neighbours, is as narrow.
fn normals(hull: &ConvexHull, points: &[[f64; 3]], dimension: usize) -> Vec<DVec3> {
    let at = |i: u32| DVec3::from(points[i as usize]);
    let both = |n: DVec3| [n, -n];
    match hull {
        ConvexHull::Point(_) => DVec3::AXES[..dimension].iter().copied().flat_map(both).collect(),
        // Along it, and across: the parts of the axes across it, and in space across those too.
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

/// A hull is thin if its width is less than its length by this factor.
const THIN: f64 = 64.0;

/// Outward normals, of any length, of half-spaces that bound a thin hull where its facets do not.
///
/// The facets of a needle or a plate may all be nearly along it, so that the places where their planes meet are known
/// to rounding times its length by its width: points in a plane, once turned, are the corners of a plate as thick as
/// rounding, whose facets have one plane on either side. So a needle is also bounded by planes across its ends and
/// about it, and a plate by those through the sides of its outline.
fn silhouette(hull: &ConvexHull, points: &[[f64; 3]], dimension: usize) -> Vec<DVec3> {
    let is_solid = dimension == 3 && matches!(hull, ConvexHull::Polyhedron(_));
    let ends = farthest_along_an_axis(points).filter(|_| is_solid || matches!(hull, ConvexHull::Polygon(_)));
    let Some([a, b]) = ends else { return Vec::new() };
    let first = DVec3::from(points[a as usize]);
    let span = DVec3::from(points[b as usize]) - first;
    let along = span.normalize();
    let seen = || points.iter().map(|&p| DVec3::from(p) - first);
    let farther = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    let farthest = seen().map(|p| p.reject_from_normalized(along)).fold(DVec3::ZERO, farther);
    let width = farthest.length();
    let mut normals = Vec::new();
    if width * THIN < span.length() {
        normals = self::normals(&ConvexHull::Segment([a, b]), points, dimension);
    }
    // Of points on a line to rounding, the planes about it are all that is known.
    let Some(across) = farthest.reject_from_normalized(along).try_normalize().filter(|_| is_solid) else {
        return normals;
    };
    let up = along.cross(across);
    let thickness = seen().map(|p| up.dot(p).abs()).fold(0.0, f64::max);
    if thickness * THIN < width {
        let outline: Vec<[f64; 3]> = seen().map(|p| [along.dot(p), across.dot(p), 0.0]).collect();
        let sides = convex_hull(&outline).map_or_else(Vec::new, |hull| self::normals(&hull, &outline, 2));
        normals.extend(sides.into_iter().map(|n| along * n.x + across * n.y));
    }
    normals
}

/// The polytope's answers, except for the crossing by a line.
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
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        let Core { origin, extent, error, .. } = self.core();
        if line.radius != V::Scalar::ZERO || line.is_close || self.uncut == V::Scalar::infinity() {
            return None;
        }
        NearLine::new(line.within(error + self.uncut), origin, extent)?.faceted(&self.planes)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        self.polytope.core_support_feature(direction, slab, feature);
    }

    #[inline]
    fn rounding(&self) -> Rounding<V> {
        self.polytope.rounding
    }
}

impl<V: Vector> CrossedByLine for Faceted<V> {
    #[inline]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        faceted(&self.planes, source, direction).into()
    }

    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<V::Scalar>) -> bool {
        let Core { origin, extent, error, .. } = self.core();
        if self.uncut < V::Scalar::infinity() {
            lanes::hull::hull(lines, &self.planes, origin, extent, error + self.uncut);
        }
        self.uncut < V::Scalar::infinity()
    }
}
