//! First derivatives: forces at points.

use convex_support::numerics::angular;
use convex_support::numerics::elementary::sin_cos;
use convex_support::{AngularVelocity, Matrix, MotionGradient, Scalar, Vector};

use super::ClosestFeatures;
use crate::{Displacement, GrowthDistance, Impact, PairGradient, Ray, RayHit, RigidMotion, SignedDistance, Trajectory};

impl<V: Vector> PairGradient<V> {
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
    /// shapes these are accurate only to about half their digits, since the distance is stationary in them; here they
    /// are accurate to rounding.
    pub fn gradient(&self) -> PairGradient<V> {
        PairGradient::new(self.normal, self.points[0], self.points[1])
    }
}

impl<V: Vector> SignedDistance<V> {
    /// The derivative of the signed distance by the poses and radii of both shapes, at any depth.
    ///
    /// If there is only one normal and one pair of points it is the derivative, otherwise one of several one-sided
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

/// The force `−n/(n·w)` at a point of contact: moving the body on the normal's side along it delays the hit. `w` is
/// the velocity there relative to the other body. `None` if the two do not approach one another.
fn at_contact<V: Vector>(normal: Option<V>, velocity: V, point: V) -> Option<MotionGradient<V>> {
    let closing = -normal?.dot(velocity);
    let force = normal? / closing;
    // Also if the quotient overflows, or a number is NaN.
    (closing > V::Scalar::ZERO && force.is_finite()).then_some(MotionGradient::force(force, point))
}

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
    /// The derivatives of λ, given the ray of the cast. `None` if the source is in the target, so that λ is 0.
    ///
    /// With `n` the normal and `d` the direction, the ray comes nearer to the tangent plane by `−n·d` per λ. So moving
    /// the source by `δ` changes λ by `−n·δ/(n·d)`, moving the target by the opposite, and changing the direction by
    /// `λ` times as much. The derivatives grow as `1/(n·d)` towards grazing rays. At an edge of the target they are
    /// one-sided.
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
        // The point of the ray is the moving body, and the target is at rest.
        let contact = at_contact(self.normal, ray.direction, self.point)?;
        Some(RayCastGradient {
            target: contact.reversed(),
            source: contact.translation,
            direction: contact.translation * self.lambda,
            radius: -contact.translation.length(),
        })
    }
}

/// The derivatives of a growth distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct GrowthGradient<V: Vector> {
    /// By the motion of `a`, which carries its centre.
    pub a: MotionGradient<V>,
    /// By the motion of `b`, which carries its centre.
    pub b: MotionGradient<V>,
    /// By the centre of `a` alone, in a shape at rest.
    pub center_a: V,
    /// By the centre of `b` alone.
    pub center_b: V,
    /// By the radius of either body before it grows: never positive.
    pub radius: V::Scalar,
}

impl<V: Vector> GrowthDistance<V> {
    /// The derivatives of the scale, given both centres. `None` if the scale is 0, where it has a kink, or not known.
    ///
    /// With `n` the normal, `d = b − a` the way between the centres and `h` the support value of the difference of both
    /// shapes, each relative to its centre, along `−n`, the scale is `s = −n·d/h`, and stationary in `n`. A shape that
    /// moves by `u` without its centre changes `h` by `−n·u` at a point `x` of its surface, and the centre alone
    /// changes both `h` and `d`. Together they are a force at `a + s(x − a)`, the point that both have in common: the
    /// bodies close in there, per unit of the scale, at the speed `−n·d/s = h`.
    ///
    /// If the grown shapes touch in one point and with one normal they are derivatives, otherwise one-sided;
    /// [`closest_features`](Self::closest_features) tells which. They are as accurate as the normal and the point of
    /// the answer: of curved shapes to about half of their digits, unless it is [refined](Self::refined).
    #[must_use]
    pub fn gradient(&self, [center_a, center_b]: [V; 2]) -> Option<GrowthGradient<V>> {
        let a = at_contact(self.normal, (center_b - center_a) / self.scale, self.point)?;
        let center_a = a.translation * (V::Scalar::ONE - self.scale);
        let radius = -a.translation.length() * self.scale;
        Some(GrowthGradient { a, b: a.reversed(), center_a, center_b: -center_a, radius })
    }
}

/// The derivatives of the time of first contact of two bodies that move, and may turn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct ImpactGradient<V: Vector> {
    /// By the pose of `a` at the start. Its motion does not change, the centre included.
    pub pose_a: MotionGradient<V>,
    /// By the pose of `b` at the start.
    pub pose_b: MotionGradient<V>,
    /// By the place of `a` at the time of contact. It gives the derivative by any parameter of the motion: find how the
    /// parameter displaces the body at that time. [`RigidMotion::gradient`] does so for the parameters of a rigid
    /// motion; by its velocity it is the time times the derivative by a translation.
    pub contact_a: MotionGradient<V>,
    /// By the place of `b` at the time of contact.
    pub contact_b: MotionGradient<V>,
    /// By the radius of either body, that is, as the body is grown all around, and by the target distance: never
    /// positive.
    pub radius: V::Scalar,
}

/// The derivatives of a number by the parameters of a rigid motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidMotionGradient<V: Vector> {
    /// By the velocity.
    pub velocity: V,
    /// By the angular velocity.
    pub angular_velocity: V::AngularVelocity,
    /// By the centre.
    pub center: V,
}

impl<V: Vector> Impact<V> {
    /// The derivatives of the time of first contact, given the motions of the cast. `None` if the bodies overlap at the
    /// start, since the time is then 0, or touch and do not approach one another, since it then jumps. The motions of a
    /// [`linear_cast`](crate::linear_cast) are its [translations](crate::Motion::translations).
    ///
    /// With `n` the normal at the time `t`, `p` the point of contact and `w` the velocity there of `a` relative to `b`,
    /// a displacement `δ` of `a` at that time changes it by `−n·δ/(n·w)`. The motion turns a displacement of the start
    /// pose until then: the force on the start pose is `Rᵀ(−n/(n·w))`, at the starting place of the body's point of
    /// contact. The derivatives grow as `1/(n·w)` towards grazing contacts.
    ///
    /// If there is only one point of contact they are derivatives, otherwise one-sided derivatives;
    /// [`closest_features`](Self::closest_features) tells which.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, motion_cast};
    ///
    /// // A thin blade turns about z. It touches a ball of radius 1/2 at x = 1 where it comes within
    /// // 30° of x.
    /// let blade = Capsule::new(1.0, 0.0)?; // along y
    /// let ball = Posed::translated(Ball::new(0.5)?, DVec3::X)?;
    /// let turning = RigidMotion::rotation(DVec3::Z * 2.0, DVec3::ZERO);
    /// let options = MotionCastOptions::new().with_max_time(1.0);
    /// let cast = motion_cast(&blade, turning, &ball, RigidMotion::default(), options)?;
    /// let hit = cast.outcome.hit().ok_or("they meet")?;
    /// let gradient = hit.gradient(&turning, &RigidMotion::default()).ok_or("they approach")?;
    ///
    /// // Turned ahead by an angle at the start, it is there sooner by half as much time; and
    /// // t = (angle)/ω.
    /// assert!((gradient.pose_a.revolute(DVec3::ZERO, DVec3::Z) + 0.5).abs() < 1e-14);
    /// let by_motion = turning.gradient(hit.time, gradient.contact_a);
    /// assert!((by_motion.angular_velocity.z + hit.time / 2.0).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
    ///
    /// // A ball flies at a wall 9 m away, at 3 m/s and obliquely.
    /// let ball = Ball::new(1.0)?;
    /// let wall =
    ///     Posed::translated(Cuboid::new(DVec3::new(1.0, 50.0, 50.0))?, DVec3::new(11.0, 0.0, 0.0))?;
    /// let motion = Motion { velocity_a: DVec3::new(3.0, 4.0, 0.0), velocity_b: DVec3::ZERO };
    /// let cast = linear_cast(&ball, &wall, motion, LinearCastOptions::default())?;
    /// let hit = cast.outcome.hit().ok_or("it arrives")?;
    /// let [motion_a, motion_b] = motion.translations();
    /// let gradient = hit.gradient(&motion_a, &motion_b).ok_or("it approaches")?;
    /// // A metre ahead is a third of a second sooner.
    /// assert_eq!(gradient.pose_a.translation, DVec3::new(-1.0 / 3.0, 0.0, 0.0));
    /// let by_velocity = gradient.contact_a.translation * hit.time;
    /// assert_eq!(by_velocity, DVec3::new(-1.0, 0.0, 0.0)); // t = 9/v
    /// assert_eq!(gradient.radius, -1.0 / 3.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gradient(
        &self,
        motion_a: &dyn Trajectory<Vector = V>,
        motion_b: &dyn Trajectory<Vector = V>,
    ) -> Option<ImpactGradient<V>> {
        let velocity = motion_a.velocity(self.time, self.point) - motion_b.velocity(self.time, self.point);
        let contact_a = at_contact(self.normal, velocity, self.point)?;
        let contact_b = contact_a.reversed();
        Some(ImpactGradient {
            pose_a: at_start(motion_a, self.time, contact_a),
            pose_b: at_start(motion_b, self.time, contact_b),
            contact_a,
            contact_b,
            radius: -contact_a.translation.length(),
        })
    }
}

/// The force on the pose at the start that corresponds to a force at the given time.
fn at_start<V: Vector>(
    motion: &dyn Trajectory<Vector = V>,
    time: V::Scalar,
    force: MotionGradient<V>,
) -> MotionGradient<V> {
    let displacement = motion.displacement(time);
    let turned_back = displacement.rotation().transpose_mul(force.translation);
    MotionGradient::force(turned_back, start_of(&displacement, force.point))
}

/// The place at the start of the point that a displacement takes to `x`. With `P` the pivot and `s` its shift, `x = P +
/// s + R·(x₀ − P)`, so that a change of the start pose is turned: `δx = R·δx₀`.
pub(super) fn start_of<V: Vector>(displacement: &Displacement<V>, x: V) -> V {
    displacement.pivot + displacement.rotation().transpose_mul(x - displacement.pivot - displacement.shift)
}

impl<V: Vector> RigidMotion<V> {
    /// The change per unit of time of a number with this derivative, as the body begins to move. If the motion is that
    /// of a joint per radian, it is the change per radian of the joint.
    #[must_use]
    pub fn rate_of(&self, gradient: MotionGradient<V>) -> V::Scalar {
        gradient.prismatic(self.velocity) + gradient.revolute(self.center, self.angular_velocity)
    }

    /// The derivatives of a number by the parameters of this motion, given `force`, its derivative by the pose of the
    /// body at `time`; such as [`ImpactGradient::contact_a`] and the time of the hit.
    ///
    /// With `x = c + t·v + y`, `y = R(tω)·(x₀ − c)`, the parameters displace a point by
    ///
    /// > δx = δc + t·δv − R·δc + (t·J(tω)·δω) × y,
    ///
    /// where `J` is the left Jacobian of the rotations, 1 in 2D; in 3D, with `θ = tω`, its transpose is
    ///
    /// > Jᵀ = 1 − (1 − cos|θ|)/|θ|²·θ× + (|θ| − sin|θ|)/|θ|³·(θ×)².
    pub fn gradient(&self, time: V::Scalar, force: MotionGradient<V>) -> RigidMotionGradient<V> {
        let moment = force.rotation_about(self.center + self.velocity * time);
        // δc − R·δc, by the change that the rotation adds.
        let turn = self.angular_velocity.turn(time);
        RigidMotionGradient {
            velocity: force.translation * time,
            angular_velocity: pulled_back::<V>(moment, self.angular_velocity, time).scaled(time),
            center: -turn.transpose_mul(force.translation),
        }
    }
}

/// `Jᵀ` times a moment.
fn pulled_back<V: Vector>(
    moment: V::AngularVelocity,
    velocity: V::AngularVelocity,
    time: V::Scalar,
) -> V::AngularVelocity {
    if V::DIM == 2 {
        return moment;
    }
    let (theta, m) = (angular::vector::<V>(velocity.scaled(time)), angular::vector::<V>(moment));
    let once = angular::turning(theta, m);
    let [first, second] = jacobian_coefficients(theta.norm());
    let pulled = m - once * first + angular::turning(theta, once) * second;
    V::AngularVelocity::from_coordinates(|i| pulled.get(i))
}

/// `(1 − cos x)/x² = ½·(sin(x/2)/(x/2))²` and `(x − sin x)/x³`, by its series if the difference would cancel.
fn jacobian_coefficients<S: Scalar>(x: S) -> [S; 2] {
    let (half, one) = (S::from_f64(0.5), S::ONE);
    let sinc = if x > S::ZERO { sin_cos(x * half).0 / (x * half) } else { one };
    let first = half * sinc * sinc;
    if x > one {
        return [first, (x - sin_cos(x).0) / (x * x * x)];
    }
    // Σ (−x²)ᵏ/(2k + 3)!; the first term left out is 1/17!.
    let mut sum = S::ZERO;
    for k in (1..8).rev() {
        let factor = f64::from((2 * k + 2) * (2 * k + 3));
        sum = (one + sum) * (-(x * x) / S::from_f64(factor));
    }
    [first, (one + sum) / S::from_f64(6.0)]
}
