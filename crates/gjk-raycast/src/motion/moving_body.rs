//! A body and its motion: where it is at a time, and a bound on how its points accelerate in between.

use convex_support::numerics::coordinates::{LEAST, Vec3, array, cross, dot, vector};
use convex_support::{AngularVelocity, BoundingSphere, Core, CoreKind, Matrix, Parallelotope, Scalar, Spin, Vector};
use num_traits::Float;

use super::placed::Moved;
use super::rigid_motion::{SpinOf, turn_error};
use super::trajectory::{MovingBall, RigidMotion, Trajectory, TurningPlane};
use crate::pair::Shape;
use crate::unit::length_bound;

/// If the cosine of the angle between two edges is more than this, a parallelotope does not count as a box.
const NOT_A_BOX: f64 = 1e-6;

/// The thickness of a rectangle in units of its shorter edge: less than rounding, but enough for its normal to be
/// known.
const THICKNESS: f64 = 1.0 / (1_u64 << 60) as f64;

/// A body and its motion.
pub(super) struct MovingBody<'s, V: Vector> {
    pub(super) shape: Shape<'s, V>,
    motion: &'s dyn Trajectory<Vector = V>,
    pub(super) course: Course<V>,
    /// The core of the shape at time 0. Its radius is increased by the target distance.
    pub(super) core: Core<V>,
}

/// The parts of a motion that do not depend on time.
pub(super) enum Course<V: Vector> {
    /// The body stays where it is. Of two bodies one mostly does.
    Rest,
    Rigid(Rigid<V>),
    Other,
}

/// A rigid motion of a body.
pub(super) struct Rigid<V: Vector> {
    pub(super) motion: RigidMotion<V>,
    /// A bound on the rounding error of the shift per unit of time.
    shift_error: V::Scalar,
    pub(super) turning: Option<Turning<V>>,
}

/// How a body turns.
pub(super) struct Turning<V: Vector> {
    spin: SpinOf<V>,
    /// The vector from the centre to the body's origin, unless it is there.
    pub(super) arm: Option<V>,
    /// A bound on the distance of the core's points from the centre.
    lever: V::Scalar,
    /// The greatest distance of the core's points from the axis.
    pub(super) reach: V::Scalar,
}

/// Where a body is at a time. The body is turned about its own origin, which is moved.
pub(super) struct Place<V: Vector> {
    /// How far the centre of the rotation has moved, and how far the rotation about it has moved the body's origin.
    pub(super) shift: V,
    pub(super) swing: V,
    /// The rotation, if it has turned.
    pub(super) rotation: Option<V::Matrix>,
    /// A bound on the error that all of this brings to a point of the core.
    pub(super) error: V::Scalar,
}

impl<'s, V: Vector> MovingBody<'s, V> {
    #[inline(always)]
    pub(super) fn new(shape: Shape<'s, V>, motion: &'s dyn Trajectory<Vector = V>, margin: V::Scalar) -> Self {
        let core = shape.core();
        let course = match motion.as_rigid_motion() {
            None => Course::Other,
            Some(motion) if motion.is_rest() => Course::Rest,
            Some(motion) => Course::Rigid(Rigid::new(motion, &core)),
        };
        let core = Core { radius: core.radius + margin, ..core };
        Self { shape, motion, course, core }
    }

    /// Where the body is at a time.
    #[inline(always)]
    pub(super) fn place(&self, time: V::Scalar) -> Place<V> {
        match &self.course {
            Course::Rest => Place::START,
            Course::Rigid(rigid) if time > Scalar::ZERO => rigid.place(time, self.core.extent),
            Course::Rigid(_) => Place::START,
            Course::Other => self.place_on_trajectory(time),
        }
    }

    #[inline(never)]
    fn place_on_trajectory(&self, time: V::Scalar) -> Place<V> {
        let displacement = self.motion.displacement(time);
        let (origin, extent) = (self.core.origin, self.core.extent);
        let lever = length_bound(origin - displacement.pivot) + extent;
        let rotation = Some(displacement.rotation()).filter(|&rotation| rotation != Matrix::IDENTITY);
        let turning = displacement.turn_error * lever + V::Scalar::EPSILON * extent;
        Place {
            shift: displacement.shift,
            swing: displacement.turned(origin),
            rotation,
            error: displacement.shift_error
                + if displacement.turn_error > Scalar::ZERO { turning } else { Scalar::ZERO },
        }
    }

    /// The shape at a place, with its origin put at the given point, which is wrong by no more than `error`.
    #[inline(always)]
    pub(super) fn moved(&self, place: &Place<V>, origin: V, error: V::Scalar) -> Moved<'_, V> {
        Moved::new(self.shape, Core { origin, ..self.core }, place.rotation, error)
    }

    /// A bound on the acceleration of points of the core, as [`Trajectory::acceleration_along`] defines it.
    #[inline(never)]
    pub(super) fn acceleration_along(&self, plane: TurningPlane<V>, interval: [V::Scalar; 2]) -> V::Scalar {
        match &self.course {
            Course::Rest => Scalar::ZERO,
            Course::Rigid(Rigid { motion, turning, .. }) => {
                let reach = turning.as_ref().map_or(self.core.extent, |turning| turning.reach);
                motion.acceleration_within(reach, plane, interval)
            }
            Course::Other => self.motion.acceleration_along(self.ball(), plane, interval),
        }
    }

    /// The body's part of `E(m)`, the bound of [`in_contact`](super::in_contact) along a unit vector in an interval:
    /// the change of its rotation times the width of its core, plus what its acceleration takes points from the chords
    /// of their paths.
    pub(super) fn strays(&self, n: V, [from, to]: [V::Scalar; 2]) -> V::Scalar {
        let extent = self.core.extent;
        let [before, after] =
            [from, to].map(|time| self.place(time).rotation.map_or(n, |rotation| rotation.transpose_mul(n)));
        let rounding = V::Scalar::EPSILON * Scalar::from_f64(8.0);
        let turned = ((after - before).norm() + rounding) * (extent + extent);
        let most = |n| self.acceleration_along(TurningPlane { from: n, to: n }, [from, to]);
        let bent = Float::max(Float::max(most(n), most(-n)), Scalar::ZERO);
        turned + bent * (to - from) * (to - from) * Scalar::from_f64(0.5)
    }

    /// The velocity, at a time, of the body's point that is at `point` then.
    #[inline(always)]
    pub(super) fn velocity(&self, time: V::Scalar, point: V) -> V {
        match &self.course {
            Course::Rest => Vector::ZERO,
            Course::Rigid(rigid) => rigid.motion.velocity(time, point),
            Course::Other => self.motion.velocity(time, point),
        }
    }

    /// A ball that moves at constant velocity and contains the core throughout the interval; see
    /// [`Trajectory::moving_ball`].
    pub(super) fn moving_ball(&self, interval: [V::Scalar; 2]) -> MovingBall<V> {
        let ball = self.ball();
        match &self.course {
            Course::Rest => MovingBall { start: ball.center, velocity: Vector::ZERO, radius: ball.radius },
            _ => self.motion.moving_ball(ball, interval),
        }
    }

    /// A ball around the core at time 0.
    fn ball(&self) -> BoundingSphere<V> {
        BoundingSphere { center: self.core.origin, radius: self.core.extent }
    }

    /// The core at time 0 relative to its origin, if it is a box without a radius, times a power of two. In space it
    /// may be a rectangle.
    pub(super) fn as_box(&self, per_unit: V::Scalar) -> Option<Parallelotope<V>> {
        let Self { shape, core, .. } = self;
        if !matches!(core.kind, CoreKind::Polytope) || core.radius > Scalar::ZERO {
            return None;
        }
        let Parallelotope { center, half_edges } = shape.core_parallelotope()?;
        let mut edges = half_edges.map(|edge| array(edge * per_unit));
        if V::DIM == 2 {
            edges[2] = [0.0, 0.0, 1.0];
        }
        let length = |edge: Vec3| Float::sqrt(dot(edge, edge));
        let mut lengths = edges.map(length);
        if let Some(i) = lengths.iter().position(|&length| !(length * length > LEAST)) {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let part = THICKNESS / lengths[j].max(lengths[k]);
            edges[i] = cross(&edges[j], &edges[k]).map(|x| x * part);
            lengths[i] = length(edges[i]);
        }
        // If two edges have no length, all products are zero, and the core does not count as a box.
        let is_orthogonal = |[i, j]: [usize; 2]| dot(edges[i], edges[j]).abs() < NOT_A_BOX * lengths[i] * lengths[j];
        let is_box = [[0, 1], [1, 2], [2, 0]].into_iter().all(is_orthogonal);
        is_box.then(|| Parallelotope { center: center * per_unit, half_edges: edges.map(vector) })
    }
}

impl<V: Vector> Rigid<V> {
    fn new(motion: RigidMotion<V>, core: &Core<V>) -> Self {
        // Each coordinate is rounded once.
        let shift_error = length_bound(motion.velocity) * V::Scalar::EPSILON * V::Scalar::from_f64(0.5);
        let turning = (motion.angular_velocity != Default::default()).then(|| {
            let arm = core.origin - motion.center;
            Turning {
                spin: motion.angular_velocity.spin(),
                arm: Some(arm).filter(|&arm| arm != V::ZERO),
                lever: length_bound(arm) + core.extent,
                reach: motion.reach(BoundingSphere { center: core.origin, radius: core.extent }),
            }
        });
        Self { motion, shift_error, turning }
    }

    #[inline(always)]
    fn place(&self, time: V::Scalar, extent: V::Scalar) -> Place<V> {
        let (shift, error) = (self.motion.velocity * time, self.shift_error * time);
        let Some(Turning { spin, arm, lever, .. }) = &self.turning else {
            return Place { shift, error, ..Place::START };
        };
        let turn = spin.turn(time);
        Place {
            shift,
            swing: arm.map_or(V::ZERO, |arm| turn * arm),
            rotation: Some(V::Matrix::IDENTITY + turn),
            error: turn_error::<V>(&turn) * *lever + error + V::Scalar::EPSILON * extent,
        }
    }
}

impl<V: Vector> Place<V> {
    /// Where a body starts.
    const START: Self = Self { shift: V::ZERO, swing: V::ZERO, rotation: None, error: V::Scalar::ZERO };
}
