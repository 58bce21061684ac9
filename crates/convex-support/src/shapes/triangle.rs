//! A flat triangle.

use crate::error::{InvalidShape, finite};
use crate::{Hint, SupportMap, Vector};

/// The triangle of three points, which may be collinear or coincide.
///
/// ```
/// use convex_support::{SupportMap, Triangle, glam::DVec2};
///
/// let triangle = Triangle::new([DVec2::ZERO, DVec2::X, DVec2::Y])?;
/// assert_eq!(triangle.support(DVec2::new(1.0, 2.0)), DVec2::Y);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<V: Vector> {
    points: [V; 3],
}

impl<V: Vector> Triangle<V> {
    /// The triangle of the three points.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a coordinate is not finite.
    pub fn new(points: [V; 3]) -> Result<Self, InvalidShape> {
        let [a, b, c] = points;
        Ok(Self { points: [finite("points[0]", a)?, finite("points[1]", b)?, finite("points[2]", c)?] })
    }

    /// Its corners.
    #[must_use]
    pub fn points(&self) -> [V; 3] {
        self.points
    }
}

impl<V: Vector> SupportMap for Triangle<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        let [a, b, c] = self.points;
        // Differences first: the corners may be far from the origin and near one another.
        let (to_b, to_c) = (direction.dot(b - a), direction.dot(c - a));
        if to_b > to_c {
            if to_b > V::Scalar::default() { b } else { a }
        } else if to_c > V::Scalar::default() {
            c
        } else {
            a
        }
    }

    #[inline]
    fn origin(&self) -> V {
        super::polytope::middle(self.points)
    }

    #[inline]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        self.support(direction) - self.origin()
    }
}
