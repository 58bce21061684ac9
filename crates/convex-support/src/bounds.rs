//! Boxes and balls around shapes, for culling.

use num_traits::Float as _;

use crate::{Core, Hint, Scalar, SupportMap, Vector, support_value};

/// A box along the coordinate axes: the points with `min ≤ x ≤ max`, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Aabb<V: Vector> {
    /// The smallest coordinates.
    pub min: V,
    /// The largest coordinates.
    pub max: V,
}

impl<V: Vector> Aabb<V> {
    /// The box of all finite points.
    #[inline]
    #[must_use]
    pub fn everything() -> Self {
        let all = V::splat(V::Scalar::max_value());
        Self { min: -all, max: all }
    }

    /// The middle of the box.
    #[inline]
    #[must_use]
    pub fn center(&self) -> V {
        let half = V::Scalar::from_f64(0.5);
        self.min * half + self.max * half
    }

    /// Half the size along each axis.
    #[inline]
    #[must_use]
    pub fn half_extents(&self) -> V {
        let half = V::Scalar::from_f64(0.5);
        self.max * half - self.min * half
    }

    /// The smallest box that contains both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the two boxes have a point in common.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..V::DIM).all(|i| self.min.get(i) <= other.max.get(i) && other.min.get(i) <= self.max.get(i))
    }
}

/// The smallest box along the axes that contains the shape. It consists of the support values along the axes, and is
/// as accurate as they are: to a few ulps of the largest coordinate, which are not added.
///
/// ```
/// use convex_support::{Aabb, Cone, Posed, bounding_box, glam::DVec3};
///
/// let cone = Posed::translated(Cone::new(1.0, 0.5)?, DVec3::new(10.0, 0.0, 0.0))?;
/// assert_eq!(
///     bounding_box(&cone),
///     Aabb { min: DVec3::new(9.5, -1.0, -0.5), max: DVec3::new(10.5, 1.0, 0.5) }
/// );
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("aabb", "extents"))]
#[must_use]
pub fn bounding_box<S: SupportMap + ?Sized>(shape: &S) -> Aabb<S::Vector> {
    Aabb {
        min: S::Vector::from_fn(|i| -support_value(shape, -S::Vector::axis(i))),
        max: S::Vector::from_fn(|i| support_value(shape, S::Vector::axis(i))),
    }
}

/// The smallest box around the core, relative to the shape's origin.
pub(crate) fn core_box<S: SupportMap + ?Sized>(shape: &S) -> Aabb<S::Vector> {
    let farthest = |direction: S::Vector| shape.core_support(direction, &mut Hint::new());
    Aabb {
        min: S::Vector::from_fn(|i| farthest(-S::Vector::axis(i)).get(i)),
        max: S::Vector::from_fn(|i| farthest(S::Vector::axis(i)).get(i)),
    }
}

/// A ball about any centre.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundingSphere<V: Vector> {
    /// Its centre.
    pub center: V,
    /// Its radius.
    pub radius: V::Scalar,
}

impl<V: Vector> BoundingSphere<V> {
    /// Whether the two have a point in common.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        (self.center - other.center).norm() <= self.radius + other.radius
    }
}

/// A ball that contains the shape. It is exactly the smallest for balls, boxes, capsules, cylinders and ellipsoids, in
/// any pose, and never larger than the ball around the [`bounding_box`]. A few ulps of rounding are not added.
///
/// ```
/// use convex_support::{Capsule, Posed, bounding_sphere, glam::DVec3};
///
/// let capsule = Posed::translated(Capsule::new(1.0, 0.5)?, DVec3::new(10.0, 0.0, 0.0))?;
/// let sphere = bounding_sphere(&capsule);
/// assert_eq!((sphere.center, sphere.radius), (DVec3::new(10.0, 0.0, 0.0), 1.5));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[must_use]
pub fn bounding_sphere<S: SupportMap + ?Sized>(shape: &S) -> BoundingSphere<S::Vector> {
    // Around the origin with the extent of the core, or around the middle of the core's box to its corner.
    let core = core_box(shape);
    let Core { origin, radius, extent, .. } = shape.core();
    let corner = core.half_extents().norm();
    let (offset, core_radius) = if extent <= corner { (S::Vector::ZERO, extent) } else { (core.center(), corner) };
    BoundingSphere { center: origin + offset, radius: core_radius + radius }
}
