//! The trait of motions, for the first contact of moving bodies.

use convex_support::{BoundingSphere, InvalidShape, Matrix, Posed, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::unit::length_bound;

/// A motion at a constant velocity and a constant angular velocity about a centre that moves with the body:
///
/// > x(t) = c + t·v + R(t)·(x − c),   with R(t) the rotation by |ω|·t about ω,
///
/// in world axes, for any number of turns. The default is rest.
///
/// ```
/// use convex_support::glam::DVec3;
/// use gjk_raycast::{RigidMotion, Trajectory};
///
/// // A wheel of radius 1/2 that rolls along x: its lowest point is at rest.
/// let rolling = RigidMotion {
///     velocity: DVec3::X,
///     angular_velocity: DVec3::new(0.0, 0.0, -2.0),
///     center: DVec3::ZERO,
/// };
/// assert_eq!(rolling.velocity(0.0, DVec3::new(0.0, -0.5, 0.0)), DVec3::ZERO);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidMotion<V: Vector> {
    /// The velocity `v` of the centre, in units of length per unit of time.
    pub velocity: V,
    /// The angular velocity `ω`, in radians per unit of time: a vector in 3D, a number in 2D.
    pub angular_velocity: V::AngularVelocity,
    /// The centre `c` of the rotation at time 0, in the world. It may be any point that moves at the velocity above,
    /// such as the centre of mass.
    pub center: V,
}

/// A rigid motion: the pose of a body at any time, and a bound on the acceleration of its points in between.
///
/// Times are at least 0. At any time the body is in the place of its shape, moved by the
/// [displacement](Self::displacement) of that time; for most motions the displacement of time 0 is none.
/// [`RigidMotion`] is the motion at constant velocities, and [`ChainMotion`](crate::ChainMotion) that of a link whose
/// joints move linearly. Implement this trait for other motions.
///
/// # What an implementor must obey
/// The bounds certify a first contact, so they must hold for all points of the body and for all times of the
/// interval. This is most important for [`acceleration_along`](Self::acceleration_along), which alone proves that
/// nothing happens between two times that are examined. A larger bound costs time; a smaller one may let bodies pass
/// through one another. [`velocity`](Self::velocity) only steers the search, so that a wrong one costs time, never
/// correctness.
pub trait Trajectory {
    /// The space the body moves in.
    type Vector: Vector;

    /// The displacement of the body at a time, from the place of its shape.
    fn displacement(&self, time: ScalarOf<Self>) -> Displacement<Self::Vector>;

    /// The velocity, at a time, of the body's point that is at `point` then.
    fn velocity(&self, time: ScalarOf<Self>, point: Self::Vector) -> Self::Vector;

    /// An upper bound of `2·r·ẋ(t) + n·ẍ(t)`, for all points `x` of the body that start in the ball, all times `t` of
    /// the interval, and all normals `n` of the plane, which change at the rate `r`. It should be finite at least for
    /// finite intervals.
    ///
    /// This is the second derivative of `n(t)·x(t)`, the height of the point over a plane that turns. Since it is
    /// linear in `n`, a bound that holds for the first and the last normal holds for those in between.
    fn acceleration_along(
        &self,
        ball: BoundingSphere<Self::Vector>,
        plane: TurningPlane<Self::Vector>,
        interval: [ScalarOf<Self>; 2],
    ) -> ScalarOf<Self>;

    /// A ball that moves at constant velocity and contains, throughout the interval, every point that starts in `ball`.
    /// The interval may be infinite. The provided method moves the ball along the chord of the path of its centre, and
    /// grows it by a bound on how far the motion may leave this chord.
    fn moving_ball(
        &self,
        ball: BoundingSphere<Self::Vector>,
        [from, to]: [ScalarOf<Self>; 2],
    ) -> MovingBall<Self::Vector> {
        let duration = to - from;
        let [start, end] = [from, to].map(|time| self.displacement(time));
        let error = start.error_of(ball.center).max(end.error_of(ball.center));
        let [start, end] = [start, end].map(|displacement| displacement.of(ball.center));
        let velocity = if duration > Scalar::ZERO { (end - start) / duration } else { Vector::ZERO };
        // A curve leaves its chord by at most s²/8 times the largest second derivative, in any direction.
        let center = BoundingSphere { center: ball.center, radius: Scalar::ZERO };
        let most = Self::Vector::from_fn(|i| {
            let along = |normal| self.acceleration_along(center, TurningPlane { from: normal, to: normal }, [from, to]);
            let axis = Self::Vector::axis(i);
            along(axis).max(along(-axis))
        });
        let sagitta = most.norm() * duration * duration * Scalar::from_f64(0.125);
        MovingBall { start, velocity, radius: ball.radius + sagitta + error }
    }

    /// The motion as a [`RigidMotion`], if it is one; the provided method returns `None`. Bodies whose motions do not
    /// turn are cast by [`linear_cast`](crate::linear_cast), and bodies whose motions are equal do not meet.
    fn as_rigid_motion(&self) -> Option<RigidMotion<Self::Vector>> {
        None
    }
}

/// The scalar of the space a body moves in.
pub(crate) type ScalarOf<M> = <<M as Trajectory>::Vector as Vector>::Scalar;

/// The displacement of a body by a rigid motion: `x ↦ x + shift + turn·(x − pivot)`, with `1 + turn` for the
/// rotation.
///
/// It holds only what the motion adds to a point, so that bodies far from the world's origin, or from the pivot, keep
/// the digits of the distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement<V: Vector> {
    /// The point that the body is turned about, in the world at time 0.
    pub pivot: V,
    /// How far that point has moved.
    pub shift: V,
    /// The rotation about it, less the identity.
    pub turn: V::Matrix,
    /// A bound on the error of the turn as an operator, with the rounding of a product included: how far the computed
    /// product with a vector may be from the exact one, relative to the vector's length.
    pub turn_error: V::Scalar,
    /// A bound on the length of the error of the shift.
    pub shift_error: V::Scalar,
}

impl<V: Vector> Displacement<V> {
    /// The displacement by `shift`, to rounding.
    #[must_use]
    pub fn shifted(shift: V) -> Self {
        // One rounding of each coordinate.
        let shift_error = length_bound(shift) * V::Scalar::EPSILON * V::Scalar::from_f64(0.5);
        let turn = V::Matrix::from_cols_fn(|_| V::ZERO);
        Self { pivot: V::ZERO, shift, turn, turn_error: V::Scalar::ZERO, shift_error }
    }

    /// The displaced point.
    #[must_use]
    pub fn of(&self, point: V) -> V {
        point + self.shift + self.turned(point)
    }

    /// The displacement of a point by the turn alone.
    pub(super) fn turned(&self, point: V) -> V {
        self.turn * (point - self.pivot)
    }

    /// A bound on the error of [`of`](Self::of) at a point, apart from the rounding of the sum.
    fn error_of(&self, point: V) -> V::Scalar {
        self.shift_error + self.turn_error * length_bound(point - self.pivot)
    }

    /// The rotation.
    #[must_use]
    pub fn rotation(&self) -> V::Matrix {
        <V::Matrix as Matrix>::IDENTITY + self.turn
    }

    /// A displaced body: the same shape in another pose, for the next step of a simulation or for another query.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::{DQuat, DVec3}};
    /// use gjk_raycast::{RigidMotion, Trajectory};
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // A plank tumbles about its centre as it flies.
    /// let center = DVec3::new(5.0, 1.0, 0.0);
    /// let plank = Posed::new(Cuboid::new(DVec3::new(2.0, 0.1, 0.5))?, DQuat::IDENTITY, center)?;
    /// let motion =
    ///     RigidMotion { velocity: DVec3::X * 3.0, angular_velocity: DVec3::Z * FRAC_PI_2, center };
    /// let later: Posed<Cuboid<DVec3>> = motion.displacement(1.0).moved(&plank)?;
    /// assert!((later.translation() - DVec3::new(8.0, 1.0, 0.0)).length() < 1e-15);
    /// assert!((later.rotation() * DVec3::X - DVec3::Y).length() < 1e-15);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidShape`] if the body would be beyond the largest number.
    pub fn moved<S: SupportMap<Vector = V> + Clone>(&self, body: &Posed<S>) -> Result<Posed<S>, InvalidShape> {
        Posed::from_matrix(body.shape().clone(), self.rotation() * body.rotation(), self.of(body.translation()))
    }
}

/// A plane through zero that turns: its normal goes straight, at a constant rate, from one vector to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningPlane<V> {
    /// The normal at the start of the interval.
    pub from: V,
    /// The normal at the end of it.
    pub to: V,
}

/// A plane through zero at one end of an interval in which its normal [bends](super::bent_plane).
pub(super) struct BentPlane<V: Vector> {
    pub(super) time: V::Scalar,
    /// The normal, and its first and second derivative.
    pub(super) normal: V,
    pub(super) rate: V,
    pub(super) bend: V,
    /// Bounds on the length of the normal and its rate in the interval.
    pub(super) longest: V::Scalar,
    pub(super) fastest: V::Scalar,
    /// `μ`, half of the square of the duration.
    pub(super) lean: V::Scalar,
}

/// A ball that moves at constant velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingBall<V: Vector> {
    /// Its centre at the start of the interval.
    pub start: V,
    /// Its velocity.
    pub velocity: V,
    /// Its radius.
    pub radius: V::Scalar,
}

impl<M: Trajectory + ?Sized> Trajectory for &M {
    type Vector = M::Vector;

    fn displacement(&self, time: ScalarOf<Self>) -> Displacement<M::Vector> {
        (**self).displacement(time)
    }

    fn velocity(&self, time: ScalarOf<Self>, point: M::Vector) -> M::Vector {
        (**self).velocity(time, point)
    }

    fn acceleration_along(
        &self,
        ball: BoundingSphere<M::Vector>,
        plane: TurningPlane<M::Vector>,
        interval: [ScalarOf<Self>; 2],
    ) -> ScalarOf<Self> {
        (**self).acceleration_along(ball, plane, interval)
    }

    fn moving_ball(&self, ball: BoundingSphere<M::Vector>, interval: [ScalarOf<Self>; 2]) -> MovingBall<M::Vector> {
        (**self).moving_ball(ball, interval)
    }

    fn as_rigid_motion(&self) -> Option<RigidMotion<M::Vector>> {
        (**self).as_rigid_motion()
    }
}
