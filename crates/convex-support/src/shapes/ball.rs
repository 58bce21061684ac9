//! A ball about the origin.

use num_traits::Float as _;

use crate::error::{InvalidShape, non_negative};
use crate::line_crossing::{NearLine, ball};
use crate::numerics::twofold::two_sum;
use crate::support::swept;
use crate::{CertainCrossing, Core, CoreKind, Hint, LineCrossing, Rounding, Scalar, SupportMap, Vector};

/// The ball `|x| ≤ radius`; a disc in 2D. Its core is a point.
///
/// ```
/// use convex_support::{Ball, SupportMap, glam::DVec3};
///
/// let ball = Ball::<DVec3>::new(2.0)?;
/// assert_eq!(ball.support(DVec3::new(0.0, 0.0, 9.0)), DVec3::new(0.0, 0.0, 2.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
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

    #[inline]
    fn support_value(&self, direction: V) -> V::Scalar {
        direction.norm() * self.radius
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core {
            origin: V::ZERO,
            radius: self.radius,
            rolling_radius: V::Scalar::ZERO,
            extent: V::Scalar::ZERO,
            error: V::Scalar::ZERO,
            kind: CoreKind::Point(V::ZERO),
        }
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
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius < V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        ball(radius, source, direction).into()
    }

    #[inline(always)]
    fn certain_crossing(
        &self,
        source: V,
        direction: V,
        radius: V::Scalar,
        error: V::Scalar,
    ) -> Option<CertainCrossing<V>> {
        let [radius, lost] = two_sum(self.radius, radius);
        NearLine::new(source, direction, V::ZERO, radius, error + lost.abs())?.ball(radius)
    }

    fn rounding(&self) -> Rounding<V> {
        Rounding::exact(V::ZERO)
    }
}
