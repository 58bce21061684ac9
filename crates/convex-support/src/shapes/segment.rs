//! A straight line segment.

use num_traits::Float as _;

use super::points::{extent, middle, relative, rounding_of_points};
use crate::closest_point::clamp_to_segment;
use crate::error::{InvalidShape, finite, measurable};
use crate::line_crossing::{NearLine, Spine};
use crate::numerics::bound::{roundings, roundings_of};
use crate::{
    CertainCrossing, Core, CoreKind, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Parallelotope, Rounding,
    Scalar, SupportMap, Vector,
};

/// The segment between two points, which may coincide.
///
/// ```
/// use convex_support::{Segment, SupportMap, glam::DVec2};
///
/// let segment = Segment::new([DVec2::ZERO, DVec2::new(2.0, 1.0)])?;
/// assert_eq!(segment.support(DVec2::Y), DVec2::new(2.0, 1.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("edge", "line_segment"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<V: Vector> {
    points: [V; 2],
}

impl<V: Vector> Segment<V> {
    /// The segment between the two points.
    ///
    /// # Errors
    /// [`InvalidShape`] if a coordinate is not finite, or the segment is longer than the largest number.
    pub fn new(points: [V; 2]) -> Result<Self, InvalidShape> {
        let points = [finite("points[0]", points[0])?, finite("points[1]", points[1])?];
        measurable("points", (points[1] - points[0]).norm())?;
        Ok(Self { points })
    }

    /// Its end points.
    #[must_use]
    pub fn points(&self) -> [V; 2] {
        self.points
    }

    /// The point halfway between its ends, relative to the origin, and the vector from there to the second.
    #[inline(always)]
    fn middle_and_half(&self) -> (V, V) {
        let [a, b] = relative(self.points);
        let half = V::Scalar::from_f64(0.5);
        ((a + b) * half, (b - a) * half)
    }
}

impl<V: Vector> SupportMap for Segment<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        let [a, b] = self.points;
        if direction.dot(b - a) > V::Scalar::ZERO { b } else { a }
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        let (origin, extent) = (middle(self.points), extent(&self.points).norm());
        let (middle, half) = self.middle_and_half();
        Core { origin, error: roundings(9.0, extent), ..Core::exact(CoreKind::Segment { middle, half }, extent) }
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        self.support(direction) - middle(self.points)
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(clamp_to_segment(relative(self.points), x))
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        // The axis is rounded, so that a closer computation would gain nothing.
        if line.is_close {
            return None;
        }
        let ends = relative(self.points);
        let size = ends[0].length().max(ends[1].length()) + line.radius;
        NearLine::new(line, middle(self.points), size)?.segment(&Spine::between(ends), line.radius)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let points = relative(self.points);
        feature.collect(direction, slab, 0..2, |i| points[i]);
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<V>> {
        let (center, half) = self.middle_and_half();
        Some(Parallelotope { center, half_edges: [half, V::ZERO, V::ZERO] })
    }

    /// The product of the direction with the difference decides which end is farther, 4 roundings.
    fn rounding(&self) -> Rounding<V> {
        let [a, b] = self.points;
        rounding_of_points(&self.points).with_error(roundings_of(4.0, (b - a).abs()))
    }
}

impl<V: Vector> CrossedByLine for Segment<V> {
    #[inline]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        Spine::between(relative(self.points)).crossing(radius, source, direction).into()
    }
}
