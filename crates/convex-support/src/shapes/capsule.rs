//! A segment along the second axis, swept by a ball.

use num_traits::Float as _;

use crate::error::{InvalidShape, non_negative};
use crate::line_crossing::crossed_by_line::closely;
use crate::line_crossing::{NearLine, Spine, lanes};
use crate::support::support_of_parts;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Lines,
    Parallelotope, Rounding, SupportMap, Vector,
};

/// The segment from `(0, −half_height)` to `(0, half_height)` along the second axis, swept by a ball. Its core is the
/// segment. [`Posed`](crate::Posed) puts it elsewhere. `Rounded::new(Segment::new([a, b])?, radius)` is a capsule
/// between two given points, and as fast.
///
/// ```
/// use convex_support::{Capsule, glam::DVec2, support_value};
///
/// let capsule = Capsule::<DVec2>::new(1.0, 0.5)?;
/// assert_eq!(support_value(&capsule, DVec2::Y), 1.5);
/// assert_eq!(support_value(&capsule, DVec2::X), 0.5);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("stadium", "spherocylinder", "sphyl", "swept_sphere"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<V: Vector> {
    half_height: V::Scalar,
    radius: V::Scalar,
}

impl<V: Vector> Capsule<V> {
    /// The capsule around a segment of length `2·half_height`; either number may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] naming the number that is negative or not finite.
    pub fn new(half_height: V::Scalar, radius: V::Scalar) -> Result<Self, InvalidShape> {
        Ok(Self { half_height: non_negative("half_height", half_height)?, radius: non_negative("radius", radius)? })
    }

    /// Half the length of the segment.
    #[must_use]
    pub fn half_height(&self) -> V::Scalar {
        self.half_height
    }

    /// The radius around the segment.
    #[must_use]
    pub fn radius(&self) -> V::Scalar {
        self.radius
    }
}

impl<V: Vector> SupportMap for Capsule<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        support_of_parts(self, direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        let kind = CoreKind::Segment { middle: V::ZERO, half: V::axis(1) * self.half_height };
        Core { radius: self.radius, ..Core::exact(kind, self.half_height) }
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        V::axis(1) * self.half_height.copysign(direction.get(1))
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(V::axis(1) * x.get(1).max(-self.half_height).min(self.half_height))
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.is_close {
            return closely(self, line);
        }
        let line = line.sweeping(self.radius);
        let spine = Spine::upright(self.half_height);
        NearLine::new(line, V::ZERO, self.half_height + line.radius)?.segment(&spine, line.radius)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let end = V::axis(1) * self.half_height;
        feature.collect(direction, slab, 0..2, |i| if i == 0 { end } else { -end });
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<V>> {
        Some(Parallelotope { center: V::ZERO, half_edges: [V::axis(1) * self.half_height, V::ZERO, V::ZERO] })
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.sweeping(self.radius).capsule(self.half_height)
    }

    fn rounding(&self) -> Rounding<V> {
        Rounding::exact(V::axis(1) * self.half_height)
    }
}

impl<V: Vector> CrossedByLine for Capsule<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        Spine::upright(self.half_height).crossing(radius, source, direction).into()
    }

    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<V::Scalar>) -> bool {
        lanes::capsule::<V>(lines, self.half_height, self.radius);
        true
    }
}
