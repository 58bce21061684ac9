//! A solid cylinder about the y axis.

use num_traits::Float as _;

use crate::closest_point::closest_of_ball;
use crate::error::{InvalidShape, measurable, non_negative};
use crate::line_crossing::{NearLine, closely, cylinder};
use crate::numerics::bound::roundings;
use crate::numerics::elementary::hypot;
use crate::numerics::range::is_comfortable;
use crate::support::{swept, swept_hessian};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, LineCrossing, LineQuery, Rounding,
    Scalar, SupportMap, Vector3,
};

/// The cylinder `x² + z² ≤ radius²`, `|y| ≤ half_height`.
///
/// ```
/// use convex_support::{Cylinder, SupportMap, glam::DVec3};
///
/// let cylinder = Cylinder::<DVec3>::new(1.0, 0.5)?;
/// assert_eq!(cylinder.support(DVec3::new(2.0, -1.0, 0.0)), DVec3::new(0.5, -1.0, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<V: Vector3> {
    half_height: V::Scalar,
    radius: V::Scalar,
    extent: V::Scalar,
}

impl<V: Vector3> Cylinder<V> {
    /// The cylinder of height `2·half_height`; either number may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] naming the number that is negative or not finite, or if the diagonal is longer than the largest
    /// number.
    pub fn new(half_height: V::Scalar, radius: V::Scalar) -> Result<Self, InvalidShape> {
        let half_height = non_negative("half_height", half_height)?;
        let radius = non_negative("radius", radius)?;
        let extent = measurable("half_height", hypot(radius, half_height))?;
        Ok(Self { half_height, radius, extent })
    }

    /// Half the length of the axis.
    #[must_use]
    pub fn half_height(&self) -> V::Scalar {
        self.half_height
    }

    /// The radius of the discs at both ends.
    #[must_use]
    pub fn disc_radius(&self) -> V::Scalar {
        self.radius
    }
}

/// The part of `direction` across the y axis.
#[inline]
pub(crate) fn across<V: Vector3>(direction: V) -> V {
    direction - V::axis(1) * direction.get(1)
}

/// The Hessian of the support value `r·|a|` of a disc across the y axis, with `a` the part of the direction across the
/// axis, as seen along two changes. It is `r/|a|·t·tᵀ`, where the unit vector `t` is across the axis and `a`.
#[inline(always)]
pub(crate) fn disc_hessian<V: Vector3>(radius: V::Scalar, direction: V, [u, w]: [V; 2]) -> [V::Scalar; 3] {
    let (x, z) = (direction.get(0), direction.get(2));
    let squared = x * x + z * z;
    if !is_comfortable(squared) {
        return swept_hessian(radius, across(direction), [across(u), across(w)]);
    }
    let (tu, tw) = (u.get(0) * z - u.get(2) * x, w.get(0) * z - w.get(2) * x);
    let bend = radius / (squared * squared.sqrt());
    [tu * tu * bend, tu * tw * bend, tw * tw * bend]
}

impl<V: Vector3> SupportMap for Cylinder<V> {
    type Vector = V;

    #[inline(always)]
    fn support(&self, direction: V) -> V {
        swept(self.radius, across(direction)) + V::axis(1) * self.half_height.copysign(direction.get(1))
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core { error: roundings(9.0, self.radius), ..Core::exact(CoreKind::Curved, self.extent) }
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        disc_hessian(self.radius, direction, changes)
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        let y = x.get(1).max(-self.half_height).min(self.half_height);
        Some(closest_of_ball(across(x), V::ZERO, self.radius) + V::axis(1) * y)
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.radius > V::Scalar::ZERO {
            return None;
        }
        if line.is_close {
            return closely(self, line);
        }
        NearLine::new(line, V::ZERO, self.extent)?.cylinder(self.half_height, self.radius)
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.cylinder(self.half_height, self.radius)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        let discs = [(self.half_height, self.radius), (-self.half_height, self.radius)];
        feature.collect_discs(direction, slab, discs);
    }

    /// The heights are exact, and the unit vector times the radius is right to 6 roundings.
    fn rounding(&self) -> Rounding<V> {
        let extent = V::from_fn(|i| if i == 1 { self.half_height } else { self.radius });
        Rounding::exact(extent).with_error(across(V::splat(roundings(6.0, self.radius))))
    }
}

impl<V: Vector3> CrossedByLine for Cylinder<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        cylinder(self.half_height, self.radius, source, direction).into()
    }
}
