//! The convex hull of points.

mod lanes;

use num_traits::Float as _;

use alloc::vec::Vec;

use lanes::Lanes;

use crate::error::InvalidShape;
use crate::support::ScalarOf;
use crate::{Hint, Scalar, SupportMap, Vector};

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
#[derive(Clone, Debug, PartialEq)]
pub struct Polytope<V: Vector> {
    points: Vec<V>,
    /// The points relative to `middle`.
    lanes: Lanes<V>,
    middle: V,
    extent: V::Scalar,
}

impl<V: Vector> Polytope<V> {
    /// The convex hull of the points.
    ///
    /// # Errors
    /// [`InvalidShape::NoPoints`], or [`InvalidShape::NonFinite`] naming the index of the point that is not finite.
    pub fn new(points: impl IntoIterator<Item = V>) -> Result<Self, InvalidShape> {
        let points: Vec<V> = points.into_iter().collect();
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            return Err(InvalidShape::NonFinite { parameter: "points", index });
        }
        if points.is_empty() {
            return Err(InvalidShape::NoPoints);
        }
        let middle = middle(points.iter().copied());
        let extent = points.iter().map(|&p| (p - middle).norm()).fold(V::Scalar::ZERO, V::Scalar::max);
        let relative: Vec<V> = points.iter().map(|&p| p - middle).collect();
        Ok(Self { lanes: Lanes::new(&relative), points, middle, extent })
    }

    /// The points, as given.
    #[must_use]
    pub fn points(&self) -> &[V] {
        &self.points
    }
}

/// The middle of the bounding box of a non-empty list of points.
#[inline]
pub(super) fn middle<V: Vector>(points: impl IntoIterator<Item = V>) -> V {
    let mut points = points.into_iter();
    let first = points.next().unwrap_or(V::ZERO);
    let (low, high) = points.fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
    let half = V::Scalar::from_f64(0.5);
    low * half + high * half
}

impl<V: Vector> SupportMap for Polytope<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        self.points[self.lanes.farthest(direction)]
    }

    #[inline]
    fn origin(&self) -> V {
        self.middle
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        self.support(direction) - self.middle
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<Self> {
        self.extent
    }
}
