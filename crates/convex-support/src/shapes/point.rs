//! A single point.

use crate::error::{InvalidShape, finite};
use crate::line_crossing::crossed_by_line::closely;
use crate::line_crossing::{NearLine, ball};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Hint, LineCrossing, LineQuery, Rounding, Scalar,
    SupportMap, Vector,
};

/// The set of one point.
///
/// ```
/// use convex_support::{Point, SupportMap, glam::DVec2};
///
/// let point = Point::new(DVec2::new(1.0, 2.0))?;
/// assert_eq!(point.support(DVec2::X), DVec2::new(1.0, 2.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<V: Vector> {
    at: V,
}

impl<V: Vector> Point<V> {
    /// The point at `at`.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] naming the coordinate that is not finite.
    pub fn new(at: V) -> Result<Self, InvalidShape> {
        Ok(Self { at: finite("at", at)? })
    }

    /// The point.
    #[must_use]
    pub fn at(&self) -> V {
        self.at
    }
}

impl<V: Vector> SupportMap for Point<V> {
    type Vector = V;

    #[inline]
    fn support(&self, _direction: V) -> V {
        self.at
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core { origin: self.at, ..Core::exact(CoreKind::Point(V::ZERO), V::Scalar::ZERO) }
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
        NearLine::new(line, self.at, line.radius)?.swept_point(line)
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.seen_from(self.at).capsule(V::Scalar::ZERO)
    }

    fn rounding(&self) -> Rounding<V> {
        Rounding::exact(V::ZERO)
    }
}

impl<V: Vector> CrossedByLine for Point<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        ball(radius, source, direction).into()
    }
}
