//! Half-spaces: infinite floors and walls.
//!
//! A half-space has no support points, since it has no farthest point along most directions. But the point of a shape
//! that is nearest to it, or deepest in it, is the support point of the shape along `−n`. So its queries are closed
//! forms of how [high](plane) that point is and how fast it sinks.

mod contact;
mod distance;
mod linear_cast;
mod plane;
mod ray_cast;

use convex_support::{InvalidShape, Scalar, Vector};
use num_traits::Float;

pub(crate) use plane::Plane;

/// The points x with n·x ≤ offset: everything on one side of a plane.
///
/// It is no [`SupportMap`](convex_support::SupportMap), as it is unbounded, and has its own queries:
/// [`ray_cast`](Self::ray_cast), [`linear_cast`](Self::linear_cast), [`motion_cast`](Self::motion_cast),
/// [`distance_from`](Self::distance_from), [`signed_distance`](Self::signed_distance) and [`contact`](Self::contact).
/// It can be a body of a [`Scene`](crate::Scene).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<V: Vector> {
    normal: V,
    offset: V::Scalar,
    /// The length of the normal.
    pub(crate) length: V::Scalar,
}

impl<V: Vector> HalfSpace<V> {
    /// The half-space of the points x with `normal·x ≤ offset`. The normal points out of it and need not be of unit
    /// length.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite, [`InvalidShape::NotPositive`] if the normal is zero or so
    /// long or short that its length is not a number of full precision.
    pub fn new(normal: V, offset: V::Scalar) -> Result<Self, InvalidShape> {
        if let Some(index) = (0..V::DIM).find(|&i| !normal.get(i).is_finite()) {
            return Err(InvalidShape::NonFinite { parameter: "normal", index });
        }
        if !offset.is_finite() {
            return Err(InvalidShape::NonFinite { parameter: "offset", index: 0 });
        }
        let length = normal.norm();
        if !(length >= V::Scalar::min_positive_value() / V::Scalar::EPSILON && length.is_finite()) {
            return Err(InvalidShape::NotPositive { parameter: "normal", index: 0, value: length.as_f64() });
        }
        Ok(Self { normal, offset, length })
    }

    /// The normal as it was given.
    #[must_use]
    pub fn normal(&self) -> V {
        self.normal
    }

    /// The offset as it was given.
    #[must_use]
    pub fn offset(&self) -> V::Scalar {
        self.offset
    }
}
