//! A solid cone about the y axis.

use super::cylinder::{across, disc_hessian};
use crate::closest_point::closest_of_cone;
use crate::error::{InvalidShape, measurable, non_negative};
use crate::line_crossing::{NearLine, closely, cone};
use crate::numerics::bound::roundings;
use crate::numerics::elementary::hypot;
use crate::support::swept;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, LineCrossing, LineQuery, Rounding,
    Scalar, SupportMap, Vector3,
};

/// The cone with its apex at `(0, half_height, 0)` and its base disc at `y = −half_height`.
///
/// ```
/// use convex_support::{Cone, SupportMap, glam::DVec3};
///
/// let cone = Cone::<DVec3>::new(1.0, 0.5)?;
/// assert_eq!(cone.support(DVec3::new(1.0, 1.0, 0.0)), DVec3::new(0.0, 1.0, 0.0));
/// assert_eq!(cone.support(DVec3::new(1.0, 0.1, 0.0)), DVec3::new(0.5, -1.0, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<V: Vector3> {
    half_height: V::Scalar,
    radius: V::Scalar,
    extent: V::Scalar,
    /// Cosine and sine of half the opening angle.
    slant: (V::Scalar, V::Scalar),
}

impl<V: Vector3> Cone<V> {
    /// The cone of height `2·half_height`; either number may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] naming the number that is negative or not finite, or if the cone is larger than the largest
    /// number.
    pub fn new(half_height: V::Scalar, radius: V::Scalar) -> Result<Self, InvalidShape> {
        let half_height = non_negative("half_height", half_height)?;
        let radius = non_negative("radius", radius)?;
        // The slant is from the rim up to the apex; a point has an upright one.
        let half_radius = radius * V::Scalar::from_f64(0.5);
        let half_length = hypot(half_height, half_radius);
        let slant = if half_length > V::Scalar::ZERO {
            (half_height / half_length, half_radius / half_length)
        } else {
            (V::Scalar::ONE, V::Scalar::ZERO)
        };
        let extent = measurable("half_height", hypot(radius, half_height))?;
        Ok(Self { half_height, radius, extent, slant })
    }

    /// Half the height, from the middle to the apex or to the base.
    #[must_use]
    pub fn half_height(&self) -> V::Scalar {
        self.half_height
    }

    /// Cosine and sine of half the opening angle.
    pub(crate) fn slant(&self) -> (V::Scalar, V::Scalar) {
        self.slant
    }

    /// The radius of the base disc.
    #[must_use]
    pub fn disc_radius(&self) -> V::Scalar {
        self.radius
    }

    /// The cone is the hull of its apex (support value `h·d_y`) and its base disc (`r·|d_xz| − h·d_y`): the apex is
    /// farther where `2h·d_y > r·|d_xz|`, here in units of the slant's length, so that no product is out of range.
    #[inline(always)]
    fn is_apex_farthest(&self, direction: V, across: V) -> bool {
        let (cosine, sine) = self.slant;
        cosine * direction.get(1) > sine * across.norm()
    }
}

impl<V: Vector3> SupportMap for Cone<V> {
    type Vector = V;

    #[inline(always)]
    fn support(&self, direction: V) -> V {
        let across = across(direction);
        if self.is_apex_farthest(direction, across) {
            V::axis(1) * self.half_height
        } else {
            swept(self.radius, across) - V::axis(1) * self.half_height
        }
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core { error: roundings(15.0, self.radius), ..Core::exact(CoreKind::Curved, self.extent) }
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        if self.is_apex_farthest(direction, across(direction)) {
            return [V::Scalar::ZERO; 3];
        }
        disc_hessian(self.radius, direction, changes)
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(closest_of_cone(self.half_height, self.radius, x))
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.radius > V::Scalar::ZERO {
            return None;
        }
        if line.is_close {
            return closely(self, line);
        }
        NearLine::new(line, V::ZERO, self.extent)?.cone(self)
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.cone(self.half_height, self.radius)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let discs = [(self.half_height, V::Scalar::ZERO), (-self.half_height, self.radius)];
        feature.collect_discs(direction, slab, discs);
    }

    /// The heights are exact, and the unit vector times the radius is right to 6 roundings. The slant's length divides
    /// both sides of the comparison, which then have errors of 2 and 4 roundings. So the wrong one of apex and rim is
    /// taken only if their support values, `2h·d_y` and `r·|d_xz|`, agree to that; then it falls short by 6.5 roundings
    /// of `r·|d_xz|` at most.
    fn rounding(&self) -> Rounding<V> {
        let extent = V::from_fn(|i| if i == 1 { self.half_height } else { self.radius });
        Rounding::exact(extent).with_error(across(V::splat(roundings(12.5, self.radius))))
    }
}

impl<V: Vector3> CrossedByLine for Cone<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        cone(self, source, direction).into()
    }
}
