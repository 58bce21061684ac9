//! The first derivative of a distance, by its answer alone: a force at each of the closest points.
//!
//! The folder `derivative/` derives it, with all others.

use convex_support::{MotionGradient, Scalar, Vector};

use crate::Distance;

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
    pub(crate) fn new(normal: V, point_a: V, point_b: V) -> Self {
        Self {
            a: MotionGradient::force(normal, point_a),
            b: MotionGradient::force(-normal, point_b),
            radius: -V::Scalar::ONE,
        }
    }
}

impl<V: Vector> Distance<V> {
    /// The derivative of the distance by the poses and radii of both shapes. It is zero where they overlap, since the
    /// distance then stays 0 however they move; the derivative of [`signed_distance`](crate::signed_distance) shows the
    /// way out.
    ///
    /// If there is only one pair of closest points it is the derivative, otherwise one of several one-sided
    /// derivatives; [`closest_features`](Self::closest_features) tells which. For translations alone it is the
    /// derivative for any two shapes that are apart. It is as accurate as the normal and the points of the answer.
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
