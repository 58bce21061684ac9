//! A flat triangle.

use num_traits::Float as _;

use super::points::{extent, middle, relative, rounding_of_points};
use crate::closest_point::closest_of_triangle;
use crate::error::{InvalidShape, finite, measurable};
use crate::line_crossing::{NearLine, triangle};
use crate::numerics::bound::{roundings, roundings_of};
use crate::{
    CertainCrossing, Core, CoreKind, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Rounding, Scalar,
    SupportMap, Vector,
};

/// The triangle of three points, which may be collinear or coincide.
///
/// ```
/// use convex_support::{SupportMap, Triangle, glam::DVec2};
///
/// let triangle = Triangle::new([DVec2::ZERO, DVec2::X, DVec2::Y])?;
/// assert_eq!(triangle.support(DVec2::new(1.0, 2.0)), DVec2::Y);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<V: Vector> {
    points: [V; 3],
}

impl<V: Vector> Triangle<V> {
    /// The triangle of the three points.
    ///
    /// # Errors
    /// [`InvalidShape`] if a coordinate is not finite, or an edge is longer than the largest number.
    pub fn new(points: [V; 3]) -> Result<Self, InvalidShape> {
        let [a, b, c] = points;
        let points = [finite("points[0]", a)?, finite("points[1]", b)?, finite("points[2]", c)?];
        measurable("points", (b - a).norm().max((c - b).norm()).max((a - c).norm()))?;
        Ok(Self { points })
    }

    /// Its corners.
    #[must_use]
    pub fn points(&self) -> [V; 3] {
        self.points
    }
}

impl<V: Vector> SupportMap for Triangle<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        let [a, b, c] = self.points;
        // Differences first: the corners may be far from the origin and near one another.
        let (to_b, to_c) = (direction.dot(b - a), direction.dot(c - a));
        if to_b > to_c {
            if to_b > V::Scalar::default() { b } else { a }
        } else if to_c > V::Scalar::default() {
            c
        } else {
            a
        }
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        let extent = extent(&self.points).norm();
        let exact = Core::exact(CoreKind::Polytope, extent);
        Core { origin: middle(self.points), error: roundings(24.0, extent), ..exact }
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        self.support(direction) - middle(self.points)
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(closest_of_triangle(relative(self.points), x))
    }

    /// `None` in the plane without a radius, and in twice the precision: a search answers.
    #[inline]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        let (radius, corners) = (line.radius, relative(self.points));
        if line.is_close || V::DIM == 2 && radius == V::Scalar::ZERO {
            return None;
        }
        let near = NearLine::new(line, middle(self.points), extent(&self.points).norm() + radius)?;
        if radius > V::Scalar::ZERO { near.rounded_triangle(corners, radius) } else { near.triangle(corners) }
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let points = relative(self.points);
        feature.collect(direction, slab, 0..3, |i| points[i]);
    }

    /// The products of the direction with two edges decide which corner is farthest, 4 roundings each.
    fn rounding(&self) -> Rounding<V> {
        let [a, b, c] = self.points;
        rounding_of_points(&self.points).with_error(roundings_of(8.0, (b - a).abs().max((c - a).abs())))
    }
}

impl<V: Vector> CrossedByLine for Triangle<V> {
    #[inline]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        triangle(relative(self.points), radius, source, direction).into()
    }
}
