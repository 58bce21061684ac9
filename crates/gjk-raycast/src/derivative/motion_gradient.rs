//! The derivative of a number by the motion of a body.

use convex_support::{AngularVelocity, Scalar, Vector};

use crate::RigidMotion;

/// The derivative of a number by the motion of a body. It is like a force that acts on the body at a point.
///
/// A translation `δ` of the body changes the number by `translation·δ`, and a turn `ω` about any point `p` by
/// `((point − p) × translation)·ω`, in world axes and to first order.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{SignedDistanceOptions, signed_distance};
///
/// // An arm along x, with a joint at zero about z, carries a ball above a table.
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(2.0, 1.0, 0.0))?;
/// let table = Cuboid::new(DVec3::new(5.0, 0.5, 5.0))?;
/// let gradient = signed_distance(&ball, &table, SignedDistanceOptions::default()).gradient().a;
/// assert_eq!(gradient.translation, DVec3::Y);
/// assert_eq!(gradient.rotation_about(DVec3::ZERO), DVec3::Z * 2.0);
/// assert_eq!(gradient.revolute(DVec3::ZERO, DVec3::Z), 2.0); // per radian of the joint
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionGradient<V> {
    /// The change per translation of the body, in world axes: the force.
    pub translation: V,
    /// The point that the force acts at, in the world. A turn of the body about it changes nothing.
    pub point: V,
}

impl<V: Vector> MotionGradient<V> {
    /// The change per turn of the body about the point `pivot`, in world axes: a vector in 3D, in 2D a number, counterclockwise.
    #[must_use]
    pub fn rotation_about(&self, pivot: V) -> V::AngularVelocity {
        V::AngularVelocity::moment(self.point - pivot, self.translation)
    }

    /// The change per radian of a revolute joint that carries the body, about the unit vector `axis` through `pivot` (in 2D an axis of 1
    /// is counterclockwise): one entry of the gradient by the joint angles.
    #[must_use]
    pub fn revolute(&self, pivot: V, axis: V::AngularVelocity) -> V::Scalar {
        self.translation.dot(axis.cross_matrix() * (self.point - pivot))
    }

    /// The change per unit of length of a prismatic joint that carries the body, along the unit vector `axis`.
    #[must_use]
    pub fn prismatic(&self, axis: V) -> V::Scalar {
        self.translation.dot(axis)
    }

    /// The change per unit of time as the body begins to move along a rigid motion. If the motion is what a joint does per radian, it is
    /// the change per radian of the joint.
    #[must_use]
    pub fn along(&self, motion: RigidMotion<V>) -> V::Scalar {
        self.prismatic(motion.velocity) + self.revolute(motion.center, motion.angular_velocity)
    }

    /// The same of the body that the force reacts upon.
    pub(super) fn reversed(self) -> Self {
        Self { translation: -self.translation, ..self }
    }

    /// No change.
    pub(super) fn zero(point: V) -> Self {
        Self { translation: V::ZERO, point }
    }
}

/// The force `−n/(n·w)` at a point of contact, of which a displacement of the body on the normal's side puts off the hit; `w` is the
/// velocity there as seen from the other body. `None` where the two do not approach one another.
pub(super) fn at_contact<V: Vector>(normal: Option<V>, velocity: V, point: V) -> Option<MotionGradient<V>> {
    let closing = -normal?.dot(velocity);
    let force = normal? / closing;
    // Also where the quotient overflows, or something is NaN.
    (closing > V::Scalar::ZERO && force.is_finite()).then_some(MotionGradient { translation: force, point })
}
