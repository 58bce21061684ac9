//! A box about the origin, along the axes.

use crate::error::{InvalidShape, finite};
use crate::support::ScalarOf;
use crate::{ClosestPoint, Hint, Scalar, SupportMap, Vector};

/// The box `|xᵢ| ≤ half_extentsᵢ`; a rectangle in 2D.
///
/// ```
/// use convex_support::{Cuboid, SupportMap, glam::DVec3};
///
/// let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0))?;
/// assert_eq!(cuboid.support(DVec3::new(1.0, -1.0, 1.0)), DVec3::new(1.0, -2.0, 3.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<V: Vector> {
    half_extents: V,
    extent: V::Scalar,
}

impl<V: Vector> Cuboid<V> {
    /// The box with the given half extents, any of which may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] naming the half extent that is negative or not finite.
    pub fn new(half_extents: V) -> Result<Self, InvalidShape> {
        let half_extents = finite("half_extents", half_extents)?;
        match (0..V::DIM).find(|&i| half_extents.get(i) < V::Scalar::ZERO) {
            Some(index) => Err(InvalidShape::Negative {
                parameter: "half_extents",
                index,
                value: half_extents.get(index).as_f64(),
            }),
            None => Ok(Self { half_extents, extent: half_extents.norm() }),
        }
    }

    /// Half the size along each axis.
    #[must_use]
    pub fn half_extents(&self) -> V {
        self.half_extents
    }
}

impl<V: Vector> SupportMap for Cuboid<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        self.half_extents.copysign(direction)
    }

    #[inline]
    fn support_value(&self, direction: V) -> V::Scalar {
        direction.abs().dot(self.half_extents)
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        self.support(direction)
    }

    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        true
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(self.closest_point(x))
    }

    #[inline]
    fn core_extent(&self) -> ScalarOf<Self> {
        self.extent
    }
}
