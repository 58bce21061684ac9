//! Which body is first met by a shape that moves and turns.

use convex_support::glam::Vec4;
use convex_support::{
    Aabb, Bound, Boxes, CoarseBound, CoarseSweptBox, CoarseUnit, Frame, Scalar, SupportMap, SweptBox, Vector,
};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::pieces::{MAX_PIECES, MotionPiece, MotionPieces};
use super::result::SceneMotionCast;
use super::single::seen_from;
use super::{Among, Scene};
use crate::motion::{check, checked};
use crate::{ChainMotion, MotionCastOptions, RayCastError, RigidMotion, Trajectory};

impl<S: SupportMap> Scene<S> {
    /// The first body that a shape meets as it moves and turns among bodies at rest: the least time of
    /// [`motion_cast`](crate::motion_cast()) of the shape, `a`, against each body, `b`.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, Scene};
    ///
    /// // A blade turns about z, once a second, among balls.
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec3::new(x, y, 0.0));
    /// let scene = Scene::new([ball_at(-1.0, 0.0)?, ball_at(0.0, 3.0)?, ball_at(1.0, 1.0)?])?;
    /// let blade = Capsule::new(1.0, 0.0)?; // along y
    /// let turning = RigidMotion::rotation(DVec3::Z * std::f64::consts::TAU, DVec3::ZERO);
    /// let answer = scene.motion_cast(&blade, turning, MotionCastOptions::new().with_max_time(1.0))?;
    /// let first = answer.first.ok_or("two are in the way")?;
    /// assert_eq!(first.body, 0);
    /// // After 60°, as the first ball reaches 30° to both sides.
    /// assert!((first.hit.time - 1.0 / 6.0).abs() < 1e-14);
    /// assert_eq!(answer.work.culled, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        self.all().motion_cast(shape, motion, options)
    }

    /// The first body that a shape meets as both move: the bodies all by one rigid motion, such as what rides on a
    /// vehicle or hangs on a gripper. It is the least time of [`motion_cast`](crate::motion_cast()) of the shape, `a`,
    /// against each body, `b`; the point and the normal are those in the world at that time.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, Scene};
    ///
    /// // Two balls on a turntable, and a bar that is let down between them.
    /// let ball_at = |x| Posed::translated(Ball::new(0.5)?, DVec3::new(x, 0.0, 0.0));
    /// let balls = Scene::new([ball_at(2.0)?, ball_at(-3.0)?])?;
    /// let table = RigidMotion::rotation(DVec3::Y, DVec3::ZERO);
    /// let bar = Posed::translated(Capsule::new(1.0, 0.1)?, DVec3::new(0.0, 2.0, 2.0))?;
    /// let down = RigidMotion::translation(DVec3::NEG_Y * 0.3);
    /// let cast = balls.motion_cast_of_both(&bar, down, table, MotionCastOptions::new().with_max_time(6.0))?;
    /// // The first ball comes there after three quarters of a turn, and its rim a little before.
    /// let first = cast.first.ok_or("they meet")?;
    /// assert_eq!(first.body, 0);
    /// assert!(4.2 < first.hit.time && first.hit.time < 4.71);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_bodies: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        self.all().motion_cast_of_both(shape, motion, of_bodies, options)
    }
}

impl<S: SupportMap> Among<'_, S> {
    /// [`Scene::motion_cast`] among these bodies.
    ///
    /// # Errors
    /// As of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        check("motion", &motion)?;
        let options = checked(options)?;
        self.first(&MovingBalls::new(shape, &motion, &options), options.max_time, |body| {
            Ok(body.motion_cast(shape, &motion, options, |_| {})?.into())
        })
    }

    /// [`Scene::motion_cast_of_both`] among these bodies.
    ///
    /// # Errors
    /// As of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_bodies: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        check("motion", &motion)?;
        check("of_bodies", &of_bodies)?;
        let options = checked(options)?;
        let seen = seen_from(of_bodies, motion);
        self.first(&MovingBalls::new(shape, &ChainMotion::new(&seen), &options), options.max_time, |body| {
            Ok(body.motion_cast_of_both(shape, motion, of_bodies, options)?.into())
        })
    }
}

/// When a shape may meet a box, from below: when the first of the balls does that contain it during the motion.
struct MovingBalls<V: Vector>(SmallVec<[MovingBox<V>; MAX_PIECES]>);

impl<V: Vector> MovingBalls<V> {
    fn new<A: SupportMap<Vector = V> + ?Sized>(
        shape: &A,
        motion: &impl Trajectory<Vector = V>,
        options: &MotionCastOptions<V>,
    ) -> Self {
        Self(MotionPieces::new(shape, motion, options).map(MovingBox::new).collect())
    }
}

/// The box around a moving ball, when it begins to move, and how long it does, rounded up.
struct MovingBox<V: Vector> {
    start: V::Scalar,
    duration: V::Scalar,
    swept: SweptBox<V>,
}

impl<V: Vector> MovingBox<V> {
    /// With room for the rounding of where the ball is.
    fn new(piece: MotionPiece<V>) -> Self {
        let number = V::Scalar::from_f64;
        let reach = piece.reach();
        let MotionPiece { start, duration, ball } = piece;
        // What moves for ever is as far as it is asked about.
        let reach = if reach.is_finite() { reach } else { ball.start.abs() + V::splat(ball.radius) };
        let room = number(64.0) * V::Scalar::EPSILON * reach.max_element();
        let swept = SweptBox::new(V::splat(ball.radius + room), ball.start, ball.velocity);
        Self { start, duration: duration * (V::Scalar::ONE + number(8.0) * V::Scalar::EPSILON), swept }
    }
}

impl<V: Vector> Bound<V> for MovingBalls<V> {
    type Coarse = CoarseMovingBalls<V>;

    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        // What the sum of a piece's start and the time in it loses.
        let deflate = V::Scalar::ONE - V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
        self.0.iter().fold(V::Scalar::infinity(), |first, piece| {
            let after = piece.swept.bound(around);
            if after <= piece.duration { first.min((piece.start + after) * deflate) } else { first }
        })
    }

    fn coarse(&self, frame: &Frame<V>) -> CoarseMovingBalls<V> {
        let coarse = |piece: &MovingBox<V>| {
            let swept = piece.swept.coarse(frame);
            // Without an end it ends where all numbers do.
            let duration = swept.limit(piece.duration.as_f64());
            CoarseMovingBox { start: 0.0, duration, per_piece: 1.0, swept }
        };
        let mut balls: SmallVec<[_; MAX_PIECES]> = self.0.iter().map(coarse).collect();
        // All in the finest unit of time.
        let per_unit = balls.iter().map(|ball| ball.swept.unit().per_unit()).fold(0.0, f64::max).min(f64::MAX);
        for (ball, piece) in balls.iter_mut().zip(&self.0) {
            ball.start = CoarseUnit::down(piece.start.as_f64() * per_unit).max(0.0);
            ball.per_piece = CoarseUnit::down(per_unit / ball.swept.unit().per_unit());
        }
        CoarseMovingBalls { balls, unit: CoarseUnit::new::<V::Scalar>(per_unit) }
    }
}

/// [`MovingBalls`] in the frame of a tree.
struct CoarseMovingBalls<V> {
    balls: SmallVec<[CoarseMovingBox<V>; MAX_PIECES]>,
    unit: CoarseUnit,
}

struct CoarseMovingBox<V> {
    start: f32,
    /// In the unit of the piece.
    duration: f32,
    per_piece: f32,
    swept: CoarseSweptBox<V>,
}

impl<V: Vector> CoarseBound for CoarseMovingBalls<V> {
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        self.balls.iter().fold(Vec4::INFINITY, |first, piece| {
            let after = piece.swept.bounds(boxes);
            let time = (after * piece.per_piece + piece.start).min(Vec4::MAX);
            first.min(Vec4::select(after.cmple(Vec4::splat(piece.duration)), time, Vec4::INFINITY))
        })
    }

    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit(limit)
    }
}
