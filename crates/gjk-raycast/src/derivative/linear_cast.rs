//! How the time of a hit changes: bodies that move without turning.

use convex_support::{MotionGradient, Vector};

use super::at_contact::at_contact;
use crate::{LinearHit, Motion};

/// The derivatives of the time of a hit of two shapes that move without turning.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct LinearCastGradient<V: Vector> {
    /// By the pose of `a` at the start.
    pub pose_a: MotionGradient<V>,
    /// By the pose of `b` at the start.
    pub pose_b: MotionGradient<V>,
    /// By the velocity of `a`.
    pub velocity_a: V,
    /// By the velocity of `b`.
    pub velocity_b: V,
    /// By the radius of either body, that is, as the body is grown all around: never positive.
    pub radius: V::Scalar,
}

impl<V: Vector> LinearHit<V> {
    /// The derivatives of the time of the hit, for the motion of the cast that it is the answer of. `None` where the
    /// shapes overlap at the start, since the time is then 0, or touch and do not approach one another, since it then
    /// jumps.
    ///
    /// With `n` the normal, `p` the point of contact and `w = v_A − v_B`, the gap between the shapes along `n` changes
    /// by `n·w` per time, so that
    ///
    /// > dt = −n·(δa − δb)/(n·w).
    ///
    /// A turn at the start displaces the point of `a` that will be in contact, which is at `p − t·v_A` then; a change
    /// of the velocity displaces it by `t` times as much. The derivatives grow as `1/(n·w)` towards grazing contacts.
    ///
    /// Where there is only one point of contact they are derivatives, and elsewhere one-sided derivatives;
    /// [`closest_features`](Self::closest_features) tells which.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, MotionGradient, Posed, glam::DVec3};
    /// use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
    ///
    /// // A ball flies at a wall 9 m away, at 3 m/s and obliquely.
    /// let ball = Ball::new(1.0)?;
    /// let wall =
    ///     Posed::translated(Cuboid::new(DVec3::new(1.0, 50.0, 50.0))?, DVec3::new(11.0, 0.0, 0.0))?;
    /// let motion = Motion { velocity_a: DVec3::new(3.0, 4.0, 0.0), velocity_b: DVec3::ZERO };
    /// let cast = linear_cast(&ball, &wall, motion, LinearCastOptions::default())?;
    /// let hit = cast.outcome.hit().ok_or("it arrives")?;
    /// let gradient = hit.gradient(motion).ok_or("it approaches")?;
    /// // A metre ahead is a third of a second sooner.
    /// assert_eq!(gradient.pose_a.translation, DVec3::new(-1.0 / 3.0, 0.0, 0.0));
    /// assert_eq!(gradient.velocity_a, DVec3::new(-1.0, 0.0, 0.0)); // t = 9/v
    /// assert_eq!(gradient.radius, -1.0 / 3.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gradient(&self, motion: Motion<V>) -> Option<LinearCastGradient<V>> {
        let contact = at_contact(self.normal, motion.velocity_a - motion.velocity_b, self.point)?;
        let start = |velocity: V| MotionGradient { point: self.point - velocity * self.time, ..contact };
        Some(LinearCastGradient {
            pose_a: start(motion.velocity_a),
            pose_b: start(motion.velocity_b).reversed(),
            velocity_a: contact.translation * self.time,
            velocity_b: -contact.translation * self.time,
            radius: -contact.translation.length(),
        })
    }
}
