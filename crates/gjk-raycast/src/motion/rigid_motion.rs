//! Motion at constant linear and angular velocity.

use convex_support::numerics::angular;
use convex_support::numerics::bound::least;
use convex_support::numerics::elementary::tan;
use convex_support::{AngularVelocity, BoundingSphere, Matrix, Scalar, Vector};
use num_traits::Float as _;

use super::trajectory::{Displacement, MovingBall, RigidMotion, Trajectory, TurningPlane};

/// The spin of the angular velocities of a space.
pub(super) type SpinOf<V> = <<V as Vector>::AngularVelocity as AngularVelocity<V>>::Spin;

/// The pose of a body: the body is turned about zero, then moved. The default leaves it where it is.
#[doc(alias("isometry", "transform", "identity"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose<V: Vector> {
    /// The rotation: an angle in 2D, a quaternion of any length in 3D.
    pub rotation: V::Rotation,
    /// The translation.
    pub translation: V,
}

impl<V: Vector> RigidMotion<V> {
    /// The motion without turning.
    #[must_use]
    pub fn translation(velocity: V) -> Self {
        Self { velocity, ..Self::default() }
    }

    /// The rotation about a centre at rest.
    #[must_use]
    pub fn rotation(angular_velocity: V::AngularVelocity, center: V) -> Self {
        Self { velocity: V::ZERO, angular_velocity, center }
    }

    /// The motion that takes a body from one pose to another within `duration`: its own origin moves straight, and it
    /// turns at a constant rate the short way round. It moves a body in its first pose in the world, such as a
    /// [`Posed`](convex_support::Posed) shape.
    ///
    /// ```
    /// use convex_support::glam::DVec2;
    /// use gjk_raycast::{Pose, RigidMotion, Trajectory};
    ///
    /// let from = Pose { rotation: 3.0, translation: DVec2::new(1.0, 0.0) };
    /// let to = Pose { rotation: -3.0, translation: DVec2::new(5.0, 2.0) };
    /// let motion = RigidMotion::between(from, to, 2.0);
    /// assert_eq!(motion.velocity, DVec2::new(2.0, 1.0));
    /// assert!((motion.angular_velocity - (std::f64::consts::PI - 3.0)).abs() < 1e-15);
    /// assert_eq!(motion.displacement(2.0).of(from.translation), to.translation);
    /// ```
    #[must_use]
    pub fn between(from: Pose<V>, to: Pose<V>, duration: V::Scalar) -> Self {
        let turn = V::AngularVelocity::between(from.rotation, to.rotation);
        Self {
            velocity: (to.translation - from.translation) / duration,
            angular_velocity: turn.scaled(duration.recip()),
            center: from.translation,
        }
    }

    /// The motion from one pose to another within `duration` along a screw (Chasles): a rotation about an axis and a
    /// translation along it, so that the points of the body on the axis stay on it. In 2D the axis is a point, and the
    /// motion a rotation about it. If the body does not turn, it is a translation.
    #[must_use]
    pub fn screw_between(from: Pose<V>, to: Pose<V>, duration: V::Scalar) -> Self {
        let straight = Self::between(from, to, duration);
        let turn = V::AngularVelocity::between(from.rotation, to.rotation);
        let w = turn.cross_matrix();
        let (angle, moved) = (angular::vector::<V>(turn).norm(), to.translation - from.translation);
        if angle == V::Scalar::ZERO {
            return straight;
        }
        // Let a = ω/|ω|, and let p be the part of the origin's way that is perpendicular to the axis. The axis passes
        // by the middle of p at the distance cot(θ/2)·(a × p)/2. The rest of the way is along the axis.
        let (half, axis) = (V::Scalar::from_f64(0.5), w * moved / angle);
        let across = -(w * axis) / angle;
        let center = from.translation + (across + axis * tan(angle * half).recip()) * half;
        Self { velocity: (moved - across) / duration, center, ..straight }
    }

    /// Whether nothing moves.
    pub(super) fn is_rest(&self) -> bool {
        self.velocity == V::ZERO && self.angular_velocity == Default::default()
    }

    /// [`acceleration_along`](Trajectory::acceleration_along), by the [reach](Self::reach) of the ball.
    ///
    /// With `y` the vector to the point from the centre, `ẋ = v + Wy` and `ẍ = W²y` for `W = ω×`, whose transpose is
    /// `−W`. So
    ///
    /// > 2·r·ẋ + n·ẍ = 2·r·v + y·W(Wn − 2r),
    ///
    /// and the last vector is perpendicular to `ω`. Along such a vector `y` is no longer than the distance from the
    /// axis to the far side of the ball. For a normal that turns with the body, which means `r = Wn`, this is no more
    /// than for a normal that does not turn.
    #[inline(always)]
    pub(super) fn acceleration_within(
        &self,
        reach: V::Scalar,
        TurningPlane { from, to }: TurningPlane<V>,
        interval: [V::Scalar; 2],
    ) -> V::Scalar {
        let (w, turns) = (|v| self.turning(v), self.angular_velocity != Default::default());
        if from == to {
            return if turns { longer([w(w(from)); 2]) * reach + least::<V::Scalar>() } else { V::Scalar::ZERO };
        }
        let twice_rate = (to - from) * (V::Scalar::from_f64(2.0) / (interval[1] - interval[0]));
        let straight = twice_rate.dot(self.velocity);
        if !turns {
            return straight;
        }
        let bent = [w(w(from) - twice_rate), w(w(to) - twice_rate)];
        straight + longer(bent) * reach + least::<V::Scalar>()
    }

    /// The distance from the axis through the centre within which all of a ball stays.
    pub(super) fn reach(&self, ball: BoundingSphere<V>) -> V::Scalar {
        self.lever(ball).1
    }

    /// `|ω|`, and the [reach](Self::reach) of a ball.
    fn lever(&self, ball: BoundingSphere<V>) -> (V::Scalar, V::Scalar) {
        if self.angular_velocity == Default::default() {
            return (V::Scalar::ZERO, ball.radius);
        }
        let (rate, arm) = (angular::vector::<V>(self.angular_velocity).norm(), ball.center - self.center);
        let off = if arm == V::ZERO { V::Scalar::ZERO } else { self.turning(arm).norm() / rate };
        (rate, off + ball.radius)
    }

    /// `|ω|`.
    pub(super) fn rate(&self) -> V::Scalar {
        angular::vector::<V>(self.angular_velocity).norm()
    }

    /// `ω × v`.
    #[inline(always)]
    pub(super) fn turning(&self, v: V) -> V {
        angular::turning(angular::vector(self.angular_velocity), v)
    }
}

/// A bound on the error of a [turn](AngularVelocity::turn) as an operator, its product with a vector included.
///
/// It is relative to the root of the sum of the squared entries of `R − 1`. That sum is the trace of
/// `(R − 1)ᵀ(R − 1) = (1 − R) + (1 − R)ᵀ`, in which nothing cancels, since no entry on the diagonal of `1 − R` is
/// negative.
#[inline(always)]
pub(super) fn turn_error<V: Vector>(turn: &V::Matrix) -> V::Scalar {
    let trace = (0..V::DIM).fold(V::Scalar::ZERO, |sum, j| sum - turn.col(j).get(j));
    let squared = trace + trace;
    // The product with a vector loses four more.
    let units = <V::AngularVelocity as AngularVelocity<V>>::TURN_ERROR + 4.0;
    squared.sqrt() * V::Scalar::EPSILON * V::Scalar::from_f64(units)
}

/// The length of the longer of two vectors.
#[inline(always)]
fn longer<V: Vector>(vectors: [V; 2]) -> V::Scalar {
    let [first, second] = vectors.map(V::length_squared);
    let squared = if first > second { first } else { second };
    let in_range = V::Scalar::min_positive_value() / (V::Scalar::EPSILON * V::Scalar::EPSILON);
    if squared > in_range { squared.sqrt() } else { hardly_bent(vectors) }
}

/// The length of the longer of two vectors whose squares underflow, plus a bound on what products of such numbers may
/// have lost.
#[cold]
#[inline(never)]
fn hardly_bent<V: Vector>([from, to]: [V; 2]) -> V::Scalar {
    from.norm().max(to.norm()) + V::Scalar::min_positive_value()
}

impl<V: Vector> Trajectory for RigidMotion<V> {
    type Vector = V;

    #[inline]
    fn displacement(&self, time: V::Scalar) -> Displacement<V> {
        let mut displacement = Displacement::shifted(self.velocity * time);
        if self.angular_velocity != Default::default() {
            let turn = self.angular_velocity.turn(time);
            displacement.turn_error = turn_error::<V>(&turn);
            displacement.pivot = self.center;
            displacement.turn = turn;
        }
        displacement
    }

    #[inline]
    fn velocity(&self, time: V::Scalar, point: V) -> V {
        self.velocity + self.turning(point - self.center - self.velocity * time)
    }

    #[inline]
    fn acceleration_along(
        &self,
        ball: BoundingSphere<V>,
        plane: TurningPlane<V>,
        interval: [V::Scalar; 2],
    ) -> V::Scalar {
        self.acceleration_within(self.reach(ball), plane, interval)
    }

    /// The moving ball is about the centre of the motion, which moves at constant velocity, or about the middle of the
    /// given ball, whichever makes it smaller. The middle leaves the chord of its path by no more than its distance
    /// from the axis times `1 − cos(ωs/2) ≤ (ωs)²/8`.
    fn moving_ball(&self, ball: BoundingSphere<V>, [from, to]: [V::Scalar; 2]) -> MovingBall<V> {
        let arm = ball.center - self.center;
        let about = |arm| {
            let start = self.center + self.velocity * from;
            MovingBall { start, velocity: self.velocity, radius: arm + ball.radius }
        };
        // Most bodies turn about their own centre.
        if arm == V::ZERO {
            return about(V::Scalar::ZERO);
        }
        let arm = arm.norm();
        let duration = to - from;
        let (rate, off_axis) = self.lever(BoundingSphere { radius: V::Scalar::ZERO, ..ball });
        let angle = rate * duration;
        let sagitta = off_axis * angle * angle * V::Scalar::from_f64(0.125);
        if !(sagitta < arm) {
            return about(arm);
        }
        let [start, end] = [from, to].map(|time| self.displacement(time).of(ball.center));
        let velocity = if duration > V::Scalar::ZERO { (end - start) / duration } else { V::ZERO };
        MovingBall { start, velocity, radius: ball.radius + sagitta }
    }

    fn as_rigid_motion(&self) -> Option<Self> {
        Some(*self)
    }
}
