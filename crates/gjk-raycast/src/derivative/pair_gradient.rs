//! The derivatives of a distance by the motions and the radii of both bodies.

use convex_support::{MotionGradient, Scalar, Vector};

use super::ClosestFeatures;
use crate::{Distance, RigidMotion, SignedDistance};

/// The derivatives of a distance by the motion of either body and by their radii.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct PairGradient<V: Vector> {
    /// By the motion of `a`: the normal, at the closest point of `a`.
    pub a: MotionGradient<V>,
    /// By the motion of `b`: minus the normal, at the closest point of `b`.
    pub b: MotionGradient<V>,
    /// By the radius of either body, that is, as the body is grown all around: −1.
    pub radius: V::Scalar,
}

impl<V: Vector> PairGradient<V> {
    fn new(normal: V, point_a: V, point_b: V) -> Self {
        Self {
            a: MotionGradient::force(normal, point_a),
            b: MotionGradient::force(-normal, point_b),
            radius: -V::Scalar::ONE,
        }
    }

    /// The change per unit of time as both bodies begin to move.
    #[must_use]
    pub fn along(&self, motion_a: RigidMotion<V>, motion_b: RigidMotion<V>) -> V::Scalar {
        motion_a.rate_of(self.a) + motion_b.rate_of(self.b)
    }
}

impl<V: Vector> ClosestFeatures<V> {
    /// The derivative of the signed distance by the poses and radii of both shapes, to rounding, where it is
    /// [smooth](Self::smoothness).
    ///
    /// The [gradient](SignedDistance::gradient) of an answer uses the normal and the points of the answer. For curved
    /// shapes these are known only to about half their digits, since the distance is stationary in them; here they are
    /// known to rounding.
    pub fn gradient(&self) -> PairGradient<V> {
        PairGradient::new(self.normal, self.points[0], self.points[1])
    }
}

impl<V: Vector> Distance<V> {
    /// The derivative of the distance by the poses and radii of both shapes. It is zero where they overlap, since the
    /// distance then stays 0 however they move; the derivative of [`signed_distance`](crate::signed_distance) tells the
    /// way out.
    ///
    /// Where there is only one pair of closest points it is the derivative, and elsewhere one of several one-sided
    /// derivatives; [`closest_features`](Self::closest_features) tells which. For translations alone it is the
    /// derivative of any two shapes that are apart. It is as accurate as the normal and the points of the answer.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{DistanceOptions, distance};
    ///
    /// let (a, b) = (Posed::translated(Ball::new(1.0)?, DVec2::new(3.0, 4.0))?, Ball::new(1.0)?);
    /// let gradient = distance(&a, &b, DistanceOptions::default()).gradient();
    /// assert!((gradient.a.translation - DVec2::new(0.6, 0.8)).length() < 1e-15);
    /// assert_eq!((gradient.b.translation, gradient.radius), (-gradient.a.translation, -1.0));
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn gradient(&self) -> PairGradient<V> {
        match self.normal {
            Some(normal) => PairGradient::new(normal, self.point_a, self.point_b),
            None => PairGradient {
                a: MotionGradient::force(V::ZERO, self.point_a),
                b: MotionGradient::force(V::ZERO, self.point_b),
                radius: V::Scalar::ZERO,
            },
        }
    }
}

impl<V: Vector> SignedDistance<V> {
    /// The derivative of the signed distance by the poses and radii of both shapes, at any depth.
    ///
    /// Where the normal and the points are the only ones it is the derivative, and elsewhere one of several one-sided
    /// derivatives; [`closest_features`](Self::closest_features) tells which. It is as accurate as the normal and the
    /// points of the answer.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{SignedDistanceOptions, signed_distance};
    ///
    /// // A box has sunk 0.1 into the floor, one of its lower corners first.
    /// let floor = Cuboid::new(DVec3::new(50.0, 1.0, 50.0))?;
    /// let parcel = |angle: f64| {
    ///     let lean = gjk_raycast::convex_support::glam::DQuat::from_rotation_z(0.3 + angle);
    ///     Posed::new(Cuboid::new(DVec3::splat(0.5))?, lean * lean, DVec3::new(3.0, 1.5, 0.0))
    /// };
    /// let answer = |angle| Ok::<_, gjk_raycast::convex_support::InvalidShape>(
    ///     signed_distance(&parcel(angle)?, &floor, SignedDistanceOptions::default()));
    /// let at = answer(0.0)?;
    ///
    /// // Turned about its centre by twice the angle, the corner sinks or rises with the derivative.
    /// let per_angle = 2.0 * at.gradient().a.revolute(DVec3::new(3.0, 1.5, 0.0), DVec3::Z);
    /// let difference = (answer(1e-6)?.signed_distance - answer(-1e-6)?.signed_distance) / 2e-6;
    /// assert!((per_angle - difference).abs() < 1e-9);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn gradient(&self) -> PairGradient<V> {
        PairGradient::new(self.normal, self.point_a, self.point_b)
    }
}
