//! How the parameter of a hit changes: rays.

use convex_support::{MotionGradient, Vector};

use super::at_contact::at_contact;
use crate::{Ray, RayHit};

/// The derivatives of the parameter λ at which a ray enters a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct RayCastGradient<V: Vector> {
    /// By the pose of the target.
    pub target: MotionGradient<V>,
    /// By the source of the ray.
    pub source: V,
    /// By the direction of the ray.
    pub direction: V,
    /// By the radius of the target, that is, as the target is grown all around: never positive.
    pub radius: V::Scalar,
}

impl<V: Vector> RayHit<V> {
    /// The derivatives of λ, for the ray of the cast that it is the answer of. `None` where the source is in the
    /// target, so that λ is 0.
    ///
    /// With `n` the normal and `d` the direction, the ray comes nearer to the tangent plane by `−n·d` per λ, so that
    /// moving the source by `δ` changes λ by `−n·δ/(n·d)`, moving the target by the opposite, and changing the
    /// direction by `λ` times as much. The derivatives grow as `1/(n·d)` towards grazing rays. At an edge of the target
    /// they are one-sided.
    ///
    /// ```
    /// use convex_support::{Ball, MotionGradient, Posed, glam::DVec2};
    /// use gjk_raycast::{Ray, RayCastOptions, ray_cast};
    ///
    /// let target = Posed::translated(Ball::new(2.0)?, DVec2::new(10.0, 0.0))?;
    /// let ray = Ray { source: DVec2::ZERO, direction: DVec2::X };
    /// let cast = ray_cast(&target, ray, RayCastOptions::default())?;
    /// let hit = cast.outcome.hit().ok_or("it is in the way")?;
    /// let gradient = hit.gradient(ray).ok_or("it comes from outside")?;
    /// assert_eq!((gradient.source, gradient.direction), (-DVec2::X, -DVec2::X * 8.0));
    /// assert_eq!((gradient.target.translation, gradient.radius), (DVec2::X, -1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gradient(&self, ray: Ray<V>) -> Option<RayCastGradient<V>> {
        // The point of the ray is the body that moves, and is at rest where the target is.
        let contact = at_contact(self.normal, ray.direction, self.point)?;
        Some(RayCastGradient {
            target: contact.reversed(),
            source: contact.translation,
            direction: contact.translation * self.lambda,
            radius: -contact.translation.length(),
        })
    }
}
