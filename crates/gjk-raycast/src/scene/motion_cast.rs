//! Which body a shape meets first that moves and turns.

use convex_support::{Bound, Boxes, Lanes, Scalar, SupportMap, SweptBox, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::pieces::{MAX_PIECES, Piece, Pieces};
use super::result::SceneMotionCast;
use super::{Among, Scene};
use crate::motion::{check, checked};
use crate::{MotionCastOptions, RayCastError, Trajectory};

impl<S: SupportMap> Scene<S> {
    /// The first body that a shape meets as it moves and turns among bodies at rest: the end time of
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
        let bound = MovingBalls(Pieces::new(shape, &motion, &options).map(MovingBox::new).collect());
        self.first(&bound, options.max_time, |body| Ok(body.motion_cast(shape, &motion, options)?.into()))
    }
}

/// When a shape may meet a box, from below: when the first of the balls does that contain it during the motion.
struct MovingBalls<V: Vector>(SmallVec<[MovingBox<V>; MAX_PIECES]>);

/// The box around a moving ball, when it begins to move, and how long it does, rounded up.
struct MovingBox<V: Vector> {
    start: V::Scalar,
    duration: V::Scalar,
    swept: SweptBox<V>,
}

impl<V: Vector> MovingBox<V> {
    /// With room for the rounding of where the ball is.
    fn new(piece: Piece<V>) -> Self {
        let number = V::Scalar::from_f64;
        let reach = piece.reach();
        let Piece { start, duration, ball } = piece;
        // What moves for ever is as far as it is asked about.
        let reach = if reach.is_finite() { reach } else { ball.start.abs() + V::splat(ball.radius) };
        let room = number(64.0) * V::Scalar::EPSILON * reach.max_element();
        let swept = SweptBox::new(V::splat(ball.radius + room), ball.start, ball.velocity);
        Self { start, duration: duration * (V::Scalar::ONE + number(8.0) * V::Scalar::EPSILON), swept }
    }
}

impl<V: Vector> Bound<V> for MovingBalls<V> {
    fn bounds(&self, boxes: &Boxes<V>) -> <V::Scalar as Scalar>::Lanes {
        let splat = <V::Scalar as Scalar>::Lanes::splat;
        let infinity = splat(V::Scalar::infinity());
        // What the sum of a piece's start and the time in it loses.
        let deflate = splat(V::Scalar::ONE - V::Scalar::from_f64(4.0) * V::Scalar::EPSILON);
        self.0.iter().fold(infinity, |first, piece| {
            let after = piece.swept.bounds(boxes);
            let time = (splat(piece.start) + after) * deflate;
            first.min(after.if_at_most(splat(piece.duration), time, infinity))
        })
    }
}
