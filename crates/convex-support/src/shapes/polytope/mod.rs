//! The convex hull of points.

#[cfg(feature = "hull")]
mod convex_hull;
#[cfg(feature = "hull")]
mod faceted;
mod graph;
#[cfg(feature = "hull")]
mod hull;
mod lanes;
#[cfg(feature = "hull")]
mod planes;

use core::fmt;

use num_traits::Float as _;

use alloc::vec::Vec;

use graph::{FOLLOWED, Graph};
use lanes::Lanes;

use super::points::{middle, rounding_of_points};
use crate::error::{InvalidShape, measurable};
use crate::numerics::bound::roundings_of;
use crate::numerics::range::{is_comfortable, power_of_two_below};
use crate::vector::{rarely, scaled};
use crate::{Core, CoreKind, Feature, Hint, Rounding, Scalar, SupportMap, Vector};

#[cfg(feature = "hull")]
pub use faceted::Faceted;
#[cfg(feature = "hull")]
pub(crate) use lanes::PLANES;
#[cfg(feature = "hull")]
pub(crate) use planes::{Planes, facet};

/// The convex hull of a list of points; a polygon in 2D, a polyhedron in 3D.
///
/// The points need not be vertices of the hull, and may be repeated, collinear or coplanar: a flat polytope is a
/// polytope. They are kept relative to the middle of their bounding box.
///
/// ```
/// use convex_support::{Polytope, SupportMap, glam::DVec2};
///
/// let polygon = Polytope::new([DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::new(0.2, 0.2)])?;
/// assert_eq!(polygon.support(DVec2::new(1.0, 2.0)), DVec2::Y);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// # Speed
/// [`new`](Self::new) keeps the points as they are and scans all of them for each support point, several at a time.
/// With the feature `hull`, `Polytope::hull_of` finds the vertices and edges of the hull first. If there are more
/// than eight vertices, it also finds, for each cell of a grid of directions, those that can be farthest along a
/// direction of the cell. A support point then tests a handful of vertices, however many there are. In a cell that
/// has too many, it climbs along the edges instead, from a vertex of the cell or from the last answer ([`Hint`]).
///
/// # Ties
/// If several points are equally far along a direction, to the last bit of the dot products computed relative to the
/// middle, the answer is the first of them in [`points`](Self::points), unless it was found by climbing.
#[doc(alias("convex_hull", "polygon", "polyhedron", "convex_mesh"))]
#[derive(Clone, PartialEq)]
pub struct Polytope<V: Vector> {
    points: Vec<V>,
    search: Search<V>,
    middle: V,
    extent: V::Scalar,
    rounding: Rounding<V>,
}

/// The points, without the data for searching them.
impl<V: Vector> fmt::Debug for Polytope<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Polytope").field("points", &self.points).finish()
    }
}

/// Up to this many points are scanned as quickly as edges are followed.
const LOOKED_AT: usize = 128;

/// How the farthest of the points, relative to the middle, is found.
#[derive(Clone, Debug, PartialEq)]
enum Search<V: Vector> {
    Scan(Lanes<V>),
    #[cfg_attr(not(feature = "hull"), allow(dead_code, reason = "only the feature `hull` finds the edges"))]
    Look {
        graph: Graph<V>,
        unit: V::Scalar,
    },
}

impl<V: Vector> Polytope<V> {
    /// The convex hull of the points. Every support point scans all of them.
    ///
    /// # Errors
    /// [`InvalidShape::NoPoints`], [`InvalidShape::NonFinite`] naming the index of the point that is not finite, or
    /// [`InvalidShape::TooLarge`] if distances of the points overflow.
    pub fn new(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        let points = checked(points)?;
        let middle = middle(points.iter().copied());
        let (seen, _) = relative(&points, middle);
        Self::searched_by(Search::Scan(Lanes::new(&seen)), points, middle)
    }

    fn searched_by(search: Search<V>, points: Vec<V>, middle: V) -> Result<Self, InvalidShape> {
        let extent = points.iter().map(|&p| (p - middle).norm()).fold(V::Scalar::ZERO, V::Scalar::max);
        // Two products with the direction, of 3 roundings each, are compared to find the farthest point. A climb ends
        // where every edge gains no more than 4 roundings of its own length, and there are some on the way to the
        // farthest.
        let compared = match &search {
            Search::Scan(_) => 6.0,
            Search::Look { .. } => 16.0,
        };
        let rounding = rounding_of_points(&points);
        let rounding = rounding.with_error(roundings_of(compared, rounding.extent));
        Ok(Self { points, search, middle, extent: measurable("points", extent)?, rounding })
    }

    /// The polytope from the points of another one, by which it was [searched by edges](Self::has_edges) or not.
    /// Without the feature `hull` its points are scanned.
    #[cfg(feature = "serde")]
    pub(crate) fn restored(points: Vec<V>, has_edges: bool) -> Result<Self, InvalidShape> {
        #[cfg(feature = "hull")]
        if has_edges {
            return Self::hull_of(points);
        }
        let _ = has_edges;
        Self::new(points)
    }

    /// Whether the edges of the hull are known.
    #[cfg(feature = "serde")]
    pub(crate) fn has_edges(&self) -> bool {
        matches!(self.search, Search::Look { .. })
    }

    /// The index in the search of the point farthest along `direction`; `hint` is an index to begin at, or any number.
    ///
    /// A direction whose products with coordinates could vanish or overflow is scaled.
    #[inline(always)]
    fn farthest(&self, direction: V, hint: u32) -> u32 {
        let coordinates = |v: V| (v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO });
        let (mut dx, mut dy, mut dz) = coordinates(direction);
        // Added from the last to the first, so that the compiler reads x and y as one piece, which is how a caller
        // behind `dyn` writes them; y and z would be a piece of two writes, for which the processor waits.
        if !is_comfortable(dz * dz + dy * dy + dx * dx)
            && let Some((multiple, _)) = rarely(direction, scaled)
        {
            (dx, dy, dz) = coordinates(multiple);
        }
        match &self.search {
            Search::Scan(lanes) => lanes.farthest(dx, dy, dz) as u32,
            Search::Look { graph, .. } => graph.farthest(dx, dy, dz, hint),
        }
    }

    /// The points: as given, or the vertices of their hull for `Polytope::hull_of`.
    #[must_use]
    pub fn points(&self) -> &[V] {
        &self.points
    }
}

/// The points, of which there is at least one and all are finite.
fn checked<V: Vector>(points: impl IntoIterator<Item = V>) -> Result<Vec<V>, InvalidShape> {
    let points: Vec<V> = points.into_iter().collect();
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(InvalidShape::NonFinite { parameter: "points", index });
    }
    if points.is_empty() { Err(InvalidShape::NoPoints) } else { Ok(points) }
}

/// The points relative to the middle, in units of a power of two near their size, and that unit. The search works only
/// on these rounded differences, so that their exact properties stay exact, and products with a direction stay in
/// range.
fn relative<V: Vector>(points: &[V], middle: V) -> (Vec<V>, V::Scalar) {
    let mut seen: Vec<V> = points.iter().map(|&p| p - middle).collect();
    let largest = seen.iter().fold(V::Scalar::ZERO, |largest, p| largest.max(p.abs().max_element()));
    let unit = power_of_two_below(largest);
    seen.iter_mut().for_each(|p| *p = *p / unit);
    (seen, unit)
}

impl<V: Vector> SupportMap for Polytope<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        let index = self.farthest(direction, u32::MAX);
        match &self.search {
            Search::Scan(_) => self.points[index as usize],
            Search::Look { graph, .. } => self.points[graph.name(index)],
        }
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        let exact = Core::exact(CoreKind::Polytope, self.extent);
        Core { origin: self.middle, error: self.rounding.error_length, ..exact }
    }

    #[inline(always)]
    fn core_support(&self, direction: V, hint: &mut Hint) -> V {
        match &self.search {
            Search::Scan(_) => self.points[self.farthest(direction, u32::MAX) as usize] - self.middle,
            Search::Look { graph, unit } => {
                let mut unknown = u32::MAX;
                let last = hint.next_slot().unwrap_or(&mut unknown);
                *last = self.farthest(direction, *last);
                graph.vertex(*last) * *unit
            }
        }
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let point = |i: usize| self.points[i] - self.middle;
        if let Search::Look { graph, unit } = &self.search
            && self.points.len() > LOOKED_AT
        {
            // A level is a dot product, of three roundings.
            let rounding = direction.norm() * self.extent * V::Scalar::EPSILON * V::Scalar::from_f64(16.0);
            let mut room = [0; FOLLOWED];
            let farthest = self.farthest(direction, u32::MAX);
            if let Some(near) = graph.near(farthest, direction, (slab + rounding) / *unit, &mut room) {
                return feature.collect(direction, slab, near.iter().map(|&i| i as usize), point);
            }
        }
        feature.collect(direction, slab, 0..self.points.len(), point);
    }

    #[inline]
    fn rounding(&self) -> Rounding<V> {
        self.rounding
    }
}
