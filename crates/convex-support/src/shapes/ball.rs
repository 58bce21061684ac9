//! A ball about the origin.

use crate::ball_support::swept;
use crate::error::{InvalidShape, non_negative};
use crate::line_crossing::crossed_by_line::closely;
use crate::line_crossing::{NearLine, ball, lanes};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Hint, LineCrossing, LineQuery, Lines, Rounding,
    Scalar, SupportMap, Vector,
};

/// The ball `|x| ≤ radius`; a disc in 2D. Its core is a point.
///
/// ```
/// use convex_support::{Ball, SupportMap, glam::DVec3};
///
/// let ball = Ball::<DVec3>::new(2.0)?;
/// assert_eq!(ball.support(DVec3::new(0.0, 0.0, 9.0)), DVec3::new(0.0, 0.0, 2.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("sphere", "circle", "disc"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<V: Vector> {
    radius: V::Scalar,
}

impl<V: Vector> Ball<V> {
    /// The ball of the given radius, which may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] if the radius is negative or not finite.
    pub fn new(radius: V::Scalar) -> Result<Self, InvalidShape> {
        Ok(Self { radius: non_negative("radius", radius)? })
    }

    /// The radius.
    #[must_use]
    pub fn radius(&self) -> V::Scalar {
        self.radius
    }
}

impl<V: Vector> SupportMap for Ball<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        swept(self.radius, direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core { radius: self.radius, ..Core::exact(CoreKind::Point(V::ZERO), V::Scalar::ZERO) }
    }

    #[inline]
    fn core_support(&self, _direction: V, _hint: &mut Hint) -> V {
        V::ZERO
    }

    #[inline]
    fn core_closest_point(&self, _x: V) -> Option<V> {
        Some(V::ZERO)
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.is_close {
            return closely(self, line);
        }
        let line = line.sweeping(self.radius);
        NearLine::new(line, V::ZERO, line.radius)?.swept_point(line)
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.sweeping(self.radius).capsule(V::Scalar::ZERO)
    }

    fn rounding(&self) -> Rounding<V> {
        Rounding::exact(V::ZERO)
    }
}

impl<V: Vector> CrossedByLine for Ball<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        ball(radius, source, direction).into()
    }

    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<V::Scalar>) -> bool {
        lanes::ball::<V>(lines, V::ZERO, self.radius, V::Scalar::ZERO);
        true
    }
}
