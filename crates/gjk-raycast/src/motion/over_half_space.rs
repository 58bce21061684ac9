//! The first contact of a body that moves and turns with a half-space.

use core::cell::Cell;

use convex_support::{Hint, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float;

use super::first_contact::Search;
use super::instant::{Approach, Instant, Limits};
use super::motion_cast::{check, checked};
use super::moving_body::MovingBody;
use super::trajectory::{Trajectory, TurningPlane};
use crate::contact::Level;
use crate::half_space::{Lowest, Plane};
use crate::pair::{Shape, WithoutLines};
use crate::unit::{length_bound, lost_to_underflow};
use crate::{
    Distance, HalfSpace, Motion, MotionCast, MotionCastOptions, MotionClearance, MotionClearanceOptions, MotionIterate,
    RayCastError,
};

impl<V: Vector> HalfSpace<V> {
    /// The first contact of a shape that moves and turns, `a`, with the half-space, `b`, which is at rest.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{HalfSpace, MotionCastOptions, RigidMotion};
    ///
    /// // A cube of edge 2 turns about z, with its middle at a height of 1.2 over the floor.
    /// let floor = HalfSpace::new(DVec3::Y, 0.0)?;
    /// let cube = Posed::translated(Cuboid::new(DVec3::ONE)?, DVec3::Y * 1.2)?;
    /// let turning = RigidMotion::rotation(DVec3::Z, DVec3::Y * 1.2);
    /// let cast = floor.motion_cast(&cube, turning, MotionCastOptions::new())?;
    ///
    /// // Its corners reach √2 from the middle, and point down after an eighth of a turn.
    /// let hit = cast.outcome.hit().ok_or("they meet")?;
    /// let truth = std::f64::consts::FRAC_PI_4 - (1.2 / std::f64::consts::SQRT_2).acos();
    /// assert!(cast.lower <= truth && truth <= cast.upper && cast.upper - cast.lower < 1e-13);
    /// assert_eq!(hit.normal, Some(DVec3::Y));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// This is [`motion_cast`](crate::motion_cast()) against a body without an end: hits, misses and brackets mean the
    /// same. At every time the body's lowest point is one support point, and the plane between the bodies is known. A
    /// shape that does not turn is cast by [`linear_cast`](Self::linear_cast).
    ///
    /// The [`gradient`](crate::Impact::gradient) of a hit is that against a body at rest.
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = V>,
        options: MotionCastOptions<V>,
    ) -> Result<MotionCast<V>, RayCastError> {
        self.motion_cast_with(shape, motion, options, |_| {})
    }

    /// [`motion_cast`](Self::motion_cast) with an observer that sees every time examined. If nothing turns, it sees
    /// none.
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_with<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = V>,
        options: MotionCastOptions<V>,
        mut observer: impl FnMut(MotionIterate<V>),
    ) -> Result<MotionCast<V>, RayCastError> {
        check("motion_a", &motion)?;
        let options = checked(options)?;
        let rigid = motion.as_rigid_motion();
        if let Some(straight) = rigid.filter(|rigid| rigid.angular_velocity == Default::default()) {
            let motion = Motion { velocity_a: straight.velocity, velocity_b: V::ZERO };
            let cast = self.linear_cast(shape, motion, options.straight())?;
            return Ok(MotionCast { lower: cast.lower.min(options.max_time), ..cast });
        }
        Ok(by_search(&WithoutLines(shape), &motion, self, options, &mut observer))
    }

    /// The least distance of a shape that moves and turns, `a`, from the half-space, `b`, which is at rest, over a
    /// motion.
    ///
    /// This is [`motion_clearance`](crate::motion_clearance()) against a body without an end.
    ///
    /// # Errors
    /// Those of [`motion_clearance`](crate::motion_clearance()).
    pub fn motion_clearance<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = V>,
        options: MotionClearanceOptions<V>,
    ) -> Result<MotionClearance<V>, RayCastError> {
        self.motion_clearance_with(shape, motion, options, |_| {})
    }

    /// [`motion_clearance`](Self::motion_clearance) with an observer that sees every time examined.
    ///
    /// # Errors
    /// Those of [`motion_clearance`](crate::motion_clearance()).
    pub fn motion_clearance_with<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = V>,
        options: MotionClearanceOptions<V>,
        observer: impl FnMut(MotionIterate<V>),
    ) -> Result<MotionClearance<V>, RayCastError> {
        self.clearance_within(shape, motion, options, V::Scalar::infinity(), observer)
    }

    /// The same with a limit, as for [two bodies](super::clearance_within).
    pub(crate) fn clearance_within<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = V>,
        options: MotionClearanceOptions<V>,
        limit: V::Scalar,
        mut observer: impl FnMut(MotionIterate<V>),
    ) -> Result<MotionClearance<V>, RayCastError> {
        check("motion_a", &motion)?;
        let options = options.checked()?;
        Ok(clearance_by_search(&WithoutLines(shape), &motion, self, options, limit, &mut observer))
    }
}

compiled_once! {
    /// The first contact of a body that turns.
    fn by_search<V>(
        shape: Shape<'_, V>,
        motion: &dyn Trajectory<Vector = V>,
        half_space: &HalfSpace<V>,
        options: MotionCastOptions<V>,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> MotionCast<V> {
        let begin_in_contact = options.rare.0.map(|rare| rare.begin_in_contact);
        let mut bodies = OverHalfSpace::new(shape, motion, half_space, options.target_distance);
        Search::run(&mut bodies, options, begin_in_contact, observer)
    }
}

compiled_once! {
    /// The least distance of a body from the half-space.
    fn clearance_by_search<V>(
        shape: Shape<'_, V>,
        motion: &dyn Trajectory<Vector = V>,
        half_space: &HalfSpace<V>,
        options: MotionClearanceOptions<V>,
        limit: V::Scalar,
        observer: &mut dyn FnMut(MotionIterate<V>),
    ) -> MotionClearance<V> {
        let mut bodies = OverHalfSpace::new(shape, motion, half_space, Scalar::ZERO);
        MotionClearance::of(&mut bodies, options, limit, observer)
    }
}

/// A moving body, `a`, over a half-space at rest, `b`.
struct OverHalfSpace<'s, V: Vector> {
    body: MovingBody<'s, V>,
    /// The target distance, by which the body's radius is grown.
    margin: V::Scalar,
    plane: Plane<V>,
    /// The support points computed.
    iterations: Cell<usize>,
    /// The hint of the last time, since it mostly fits again.
    hint: Cell<Hint>,
}

impl<'s, V: Vector> OverHalfSpace<'s, V> {
    fn new(
        shape: Shape<'s, V>,
        motion: &'s dyn Trajectory<Vector = V>,
        half_space: &HalfSpace<V>,
        margin: V::Scalar,
    ) -> Self {
        let (body, plane) = (MovingBody::new(shape, motion, margin), half_space.plane());
        Self { body, margin, plane, iterations: Cell::new(0), hint: Cell::new(Hint::new()) }
    }

    /// The height of the body's lowest point over the half-space at a time, less the target distance, and the lowest
    /// point of its core in the world.
    ///
    /// The height is computed from the origin, the displacement and the support point, each by itself, so that it is as
    /// exact for a body far along the plane as for any other.
    fn lowest(&self, time: V::Scalar) -> (Level<V::Scalar>, V) {
        let (origin, radius) = (self.body.core.origin, self.body.core.radius);
        let place = self.body.place(time);
        let (shift, turned) = (place.shift, place.swing);
        let moved_origin = origin + shift + turned;
        let moved = self.body.moved(&place, moved_origin, place.error);
        let mut hint = self.hint.get();
        hint.rewind();
        let point = moved.core_support(-self.plane.normal(), &mut hint);
        self.hint.set(hint);
        self.iterations.set(self.iterations.get() + 1);
        let error = self.plane.error_along(&moved.rounding());
        let height = self.plane.height([origin, shift, turned, point], error, radius);
        (height, moved_origin + point)
    }
}

impl<V: Vector> Approach<V> for OverHalfSpace<'_, V> {
    fn aim(&mut self, target: V::Scalar) {
        self.margin = target;
        self.body.core.radius = self.body.shape.core().radius + target;
    }

    fn distance(&self, time: V::Scalar, _: Option<V>) -> Distance<V> {
        let (height, core_point) = self.lowest(time);
        let point = core_point - self.plane.unit * self.body.core.radius;
        Lowest { height, point }.distance(self.plane.unit)
    }

    fn size(&self) -> V::Scalar {
        self.body.core.extent + self.body.core.radius
    }

    fn iterations(&self) -> usize {
        self.iterations.get()
    }

    fn between(&self) -> V {
        self.plane.unit
    }

    fn at(&self, time: V::Scalar, _axis: V, _limits: Limits<V::Scalar>, _is_close: bool) -> Instant<V> {
        let (height, core_point) = self.lowest(time);
        let unit = self.plane.unit;
        let point_a = core_point - unit * self.body.core.radius;
        // The point of the plane below it, or, if the body is in the half-space, its own lowest point.
        let point = point_a - unit * height.value.max(-self.margin);
        Instant {
            time,
            normal: unit,
            gap: height.least(),
            distance: height.value,
            upper: height.most(),
            error: height.error,
            closing: -unit.dot(self.body.velocity(time, point_a)),
            point,
            is_close: true,
        }
    }

    /// The normal is always that of the plane, whatever the argument is.
    fn level(&self, time: V::Scalar, _normal: V) -> (V::Scalar, V::Scalar) {
        let (Level { value, error }, _) = self.lowest(time);
        (value, error)
    }

    /// The plane does not turn, whatever rounding has made of the normals.
    fn acceleration_along(&self, _plane: TurningPlane<V>, interval: [V::Scalar; 2]) -> V::Scalar {
        let normal = self.plane.normal();
        self.plane.per_length(self.body.acceleration_along(TurningPlane { from: normal, to: normal }, interval))
    }

    fn reach(&self) -> V::Scalar {
        self.body.core.radius
    }

    /// The ball is lowest at one of the ends.
    fn stays_far_apart(&self, interval: [V::Scalar; 2]) -> Option<V> {
        let zero = V::Scalar::ZERO;
        let ball = self.body.moving_ball(interval);
        let reach = ball.radius + self.body.core.radius;
        let height = self.plane.height([ball.start], zero, reach).least();
        let sinking = self.plane.sinking([ball.velocity]).most();
        // If it does not sink, it stays apart for ever.
        let way = if sinking <= zero { zero } else { sinking * (interval[1] - interval[0]) };
        // A bound on the rounding of the ball.
        let measure = reach + length_bound(ball.start) + way;
        let margin = measure * V::Scalar::from_f64(32.0) * V::Scalar::EPSILON + lost_to_underflow(measure);
        // If a number is NaN, the bodies are not known to be apart.
        (height - way > margin).then_some(self.plane.unit)
    }

    /// The same as for [two bodies](super::in_contact), with only one direction.
    fn stay_in_contact(&self, from: &Instant<V>, to: &Instant<V>, depth: V::Scalar) -> bool {
        self.body.strays(self.plane.unit, [from.time, to.time]) <= depth * Scalar::from_f64(4.0)
    }

    fn velocities(&self, time: V::Scalar, point: V) -> [V; 2] {
        [self.body.velocity(time, point), V::ZERO]
    }
}
