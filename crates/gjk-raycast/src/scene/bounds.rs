//! What a tree of boxes is searched by: the times when a moving shape meets them, and their heights above a half-space;
//! and how an instance sees that.

use convex_support::glam::Vec4;
use convex_support::{
    Aabb, Bound, BoundingSphere, BoxDistance, Boxes, CoarseBound, CoarseSweptBox, CoarseUnit, Frame, Scalar,
    SupportMap, SweptBox, Vector,
};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::instance_frame::InstanceFrame;
use crate::{HalfSpace, MotionCastOptions, MovingBall, Trajectory};

/// A question to a scene, whose bound can be taken into the frame of an instance. There it is at most the bound of each
/// member's box in the world, with the rounding of the pose counted.
pub(crate) trait Question<V: Vector>: Bound<V> + Sized {
    /// The question as the instance sees it.
    fn seen_from(&self, frame: &InstanceFrame<V>) -> Self;
}

impl<V: Vector> Question<V> for BoxDistance<V> {
    fn seen_from(&self, frame: &InstanceFrame<V>) -> Self {
        let around = self.of();
        let (center, half) = (around.center(), around.half_extents());
        let half = frame.half_extents(half) + V::splat(frame.room(center.abs() + half));
        let center = frame.point(center);
        let (min, max) = (center - half, center + half);
        let is_finite = min.is_finite() && max.is_finite();
        Self::rounded(if is_finite { Aabb { min, max } } else { Aabb::everything() }, self.radius())
    }
}

/// A box that moves straight, such as a point along a ray.
#[derive(Clone, Copy)]
pub(super) struct MovesStraight<V> {
    pub(super) half: V,
    pub(super) source: V,
    pub(super) direction: V,
}

/// A few of them, with a bound of all.
#[derive(Clone, Copy)]
pub(super) struct Moving<V: Vector, const N: usize = 1> {
    each: [MovesStraight<V>; N],
    swept: SweptBox<V>,
}

impl<V: Vector> Moving<V> {
    pub(super) fn new(half: V, source: V, direction: V) -> Self {
        Self { each: [MovesStraight { half, source, direction }], swept: SweptBox::new(half, source, direction) }
    }
}

impl<V: Vector, const N: usize> Moving<V, N> {
    /// `None` if they are too far from one another for one [bound](SweptBox::and).
    pub(super) fn all(each: [Moving<V>; N]) -> Option<Self> {
        let swept = each[1..].iter().try_fold(each[0].swept, |all, one| all.and(&one.swept))?;
        Some(Self { each: each.map(|one| one.each[0]), swept })
    }
}

impl<V: Vector, const N: usize> Bound<V> for Moving<V, N> {
    type Coarse = CoarseSweptBox<V>;

    #[inline(always)]
    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        self.swept.bound(around)
    }

    #[inline]
    fn coarse(&self, frame: &Frame<V>) -> CoarseSweptBox<V> {
        self.swept.coarse(frame)
    }
}

impl<V: Vector, const N: usize> Question<V> for Moving<V, N> {
    /// The rounding of the direction moves the box by a few ε of the way to the instance, which is no longer than the
    /// source and the instance are far away.
    fn seen_from(&self, frame: &InstanceFrame<V>) -> Self {
        let seen = self.each.map(|MovesStraight { half, source, direction }| {
            let room = frame.room(source.abs() + half);
            let half = frame.half_extents(half) + V::splat(room);
            Moving::new(half, frame.point(source), frame.vector(direction))
        });
        // Boxes that are too far from one another here are everywhere from the start, which bounds nothing.
        Self::all(seen).unwrap_or_else(|| {
            let everywhere = SweptBox::new(V::splat(V::Scalar::max_value()), V::ZERO, V::ONE);
            Self { each: seen.map(|one| one.each[0]), swept: everywhere }
        })
    }
}

const MAX_PARTS: usize = 16;

/// How much larger than the ball of the shape that of a part may be before the motion is cut into more parts.
const GROWTH: f64 = 1.5;

/// A lower bound on the time when a shape may meet a box: when the first of the balls does that contain the moving
/// shape, and all points no farther from it than the target distance.
pub(super) struct MovingBalls<V: Vector>(SmallVec<[MovingBox<V>; MAX_PARTS]>);

impl<V: Vector> MovingBalls<V> {
    /// Cuts the motion into as few parts as make their balls, which move at constant velocity, hardly larger than that
    /// of the shape. An endless motion is one part. The options have been checked.
    pub(super) fn new<A: SupportMap<Vector = V> + ?Sized>(
        shape: &A,
        motion: &impl Trajectory<Vector = V>,
        options: &MotionCastOptions<V>,
    ) -> Self {
        let moving = |(start, duration, ball)| MovingBox::new(start, duration, ball);
        Self(Self::parts(shape, motion, options).map(moving).collect())
    }

    /// A box around all of the balls, with room for the rounding of their positions; infinite for an endless motion.
    pub(super) fn around<A: SupportMap<Vector = V> + ?Sized>(
        shape: &A,
        motion: &impl Trajectory<Vector = V>,
        options: &MotionCastOptions<V>,
    ) -> Aabb<V> {
        let around = |(_, duration, ball): (_, V::Scalar, MovingBall<V>)| {
            let reach = V::splat(ball.radius);
            swept(Aabb { min: ball.start - reach, max: ball.start + reach }, ball.velocity, duration)
        };
        Self::parts(shape, motion, options).map(around).reduce(|a, b| a.union(&b)).unwrap_or_else(Aabb::everything)
    }

    /// When each part begins, how long it lasts, and its ball.
    fn parts<A: SupportMap<Vector = V> + ?Sized>(
        shape: &A,
        motion: &impl Trajectory<Vector = V>,
        options: &MotionCastOptions<V>,
    ) -> impl Iterator<Item = (V::Scalar, V::Scalar, MovingBall<V>)> {
        let core = shape.core();
        let radius = core.size() + options.target_distance;
        let (ball, large) = (BoundingSphere { center: core.origin, radius }, radius * Scalar::from_f64(GROWTH));
        let part = move |index: usize, count: usize| {
            let at = |index| match index {
                0 => V::Scalar::ZERO,
                _ => options.max_time * V::Scalar::from_f64(index as f64 / count as f64),
            };
            let (start, end) = (at(index), at(index + 1));
            (start, end - start, motion.moving_ball(ball, [start, end]))
        };
        let mut count = 1;
        while count < MAX_PARTS
            && options.max_time.is_finite()
            && (0..count).any(|index| part(index, count).2.radius > large)
        {
            count *= 2;
        }
        (0..count).map(move |index| part(index, count))
    }
}

/// What a box sweeps as it moves straight for a time, with room for the rounding of its positions: 64 ε of each
/// coordinate. Endless ways are infinite.
pub(super) fn swept<V: Vector>(around: Aabb<V>, velocity: V, duration: V::Scalar) -> Aabb<V> {
    let way = way(velocity, duration);
    let size = around.min.abs().max(around.max.abs()) + way.abs();
    let room = size * (V::Scalar::from_f64(64.0) * V::Scalar::EPSILON);
    Aabb { min: around.min + way.min(V::ZERO) - room, max: around.max + way.max(V::ZERO) + room }
}

/// How far a velocity leads; nowhere along a coordinate in which it is zero, also if the time is infinite.
fn way<V: Vector>(velocity: V, duration: V::Scalar) -> V {
    V::from_fn(|i| if velocity.get(i) == Scalar::ZERO { velocity.get(i) } else { velocity.get(i) * duration })
}

/// The box around a moving ball, the time when it begins to move, and its duration, rounded up.
struct MovingBox<V: Vector> {
    start: V::Scalar,
    duration: V::Scalar,
    ball: MovingBall<V>,
    swept: SweptBox<V>,
}

impl<V: Vector> MovingBox<V> {
    /// The box, with room for the rounding of the ball's position.
    fn new(start: V::Scalar, duration: V::Scalar, ball: MovingBall<V>) -> Self {
        let number = V::Scalar::from_f64;
        let within = ball.start.abs() + V::splat(ball.radius);
        let reach = ball.start.abs() + way(ball.velocity, duration).abs() + V::splat(ball.radius);
        // An endless motion counts with its start alone.
        let reach = if reach.is_finite() { reach } else { within };
        let room = number(64.0) * V::Scalar::EPSILON * reach.max_element();
        let swept = SweptBox::new(V::splat(ball.radius + room), ball.start, ball.velocity);
        Self { start, duration: duration * (V::Scalar::ONE + number(8.0) * V::Scalar::EPSILON), ball, swept }
    }
}

impl<V: Vector> Question<V> for MovingBalls<V> {
    fn seen_from(&self, frame: &InstanceFrame<V>) -> Self {
        let seen = |&MovingBox { start, duration, ball, .. }: &MovingBox<V>| {
            let radius = ball.radius + frame.room(ball.start.abs() + V::splat(ball.radius));
            let (at, velocity) = (frame.point(ball.start), frame.vector(ball.velocity));
            MovingBox::new(start, duration, MovingBall { start: at, velocity, radius })
        };
        Self(self.0.iter().map(seen).collect())
    }
}

impl<V: Vector> Bound<V> for MovingBalls<V> {
    type Coarse = CoarseMovingBalls<V>;

    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        // The rounding of the sum of a part's start and the time in it.
        let deflate = V::Scalar::ONE - V::Scalar::from_f64(4.0) * V::Scalar::EPSILON;
        self.0.iter().fold(V::Scalar::infinity(), |first, part| {
            let after = part.swept.bound(around);
            if after <= part.duration { first.min((part.start + after) * deflate) } else { first }
        })
    }

    fn coarse(&self, frame: &Frame<V>) -> CoarseMovingBalls<V> {
        let coarse = |part: &MovingBox<V>| {
            let swept = part.swept.coarse(frame);
            // An endless part ends at the largest number.
            let duration = swept.limit(part.duration.as_f64());
            CoarseMovingBox { start: 0.0, duration, per_part: 1.0, swept }
        };
        let mut balls: SmallVec<[_; MAX_PARTS]> = self.0.iter().map(coarse).collect();
        // All parts use the finest unit of time.
        let per_unit = balls.iter().map(|ball| ball.swept.unit().per_unit()).fold(0.0, f64::max).min(f64::MAX);
        for (ball, part) in balls.iter_mut().zip(&self.0) {
            ball.start = CoarseUnit::down(part.start.as_f64() * per_unit).max(0.0);
            ball.per_part = CoarseUnit::down(per_unit / ball.swept.unit().per_unit());
        }
        CoarseMovingBalls { balls, unit: CoarseUnit::new::<V::Scalar>(per_unit) }
    }
}

/// [`MovingBalls`] in the frame of a tree.
pub(super) struct CoarseMovingBalls<V> {
    balls: SmallVec<[CoarseMovingBox<V>; MAX_PARTS]>,
    unit: CoarseUnit,
}

struct CoarseMovingBox<V> {
    start: f32,
    /// In the unit of the part.
    duration: f32,
    per_part: f32,
    swept: CoarseSweptBox<V>,
}

impl<V: Vector> CoarseBound for CoarseMovingBalls<V> {
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        self.balls.iter().fold(Vec4::INFINITY, |first, part| {
            let after = part.swept.bounds(boxes);
            let time = (after * part.per_part + part.start).min(Vec4::MAX);
            first.min(Vec4::select(after.cmple(Vec4::splat(part.duration)), time, Vec4::INFINITY))
        })
    }

    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit(limit)
    }
}

/// A lower bound on the distance of a box from a half-space: that of its lowest corner.
#[derive(Clone, Copy)]
pub(super) struct HeightBound<V: Vector> {
    normal: V,
    /// The offset with room for its rounding.
    offset: V::Scalar,
}

impl<V: Vector> HeightBound<V> {
    pub(super) fn new(half_space: &HalfSpace<V>) -> Self {
        let offset = half_space.offset() / half_space.length;
        Self {
            normal: half_space.normal() / half_space.length,
            offset: offset + V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * offset.abs(),
        }
    }
}

impl<V: Vector> Bound<V> for HeightBound<V> {
    type Coarse = CoarseHeight;

    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        let mut height = -self.offset;
        for i in 0..V::DIM {
            let n = self.normal.get(i);
            height += n * if n < V::Scalar::ZERO { around.max } else { around.min }.get(i);
        }
        let deflate = V::Scalar::ONE - V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        // A sum that overflows proves nothing.
        (height.max(V::Scalar::ZERO) * deflate).min(V::Scalar::max_value())
    }

    /// In the frame of a tree, `x = o + ξ/k`, a height is `(n·ξ + k(n·o − c))/k`, whose second part is one number. Both
    /// bounds are sums, which rounding moves by a few ε of their terms.
    fn coarse(&self, frame: &Frame<V>) -> CoarseHeight {
        let (unit, epsilon) = (frame.unit(), V::Scalar::EPSILON.as_f64());
        let (mut rest, mut terms) = (-self.offset.as_f64(), self.offset.as_f64().abs());
        let mut coarse = CoarseHeight { normal: [Vec4::ZERO; 3], nearest: [0; 3], rest: 0.0, unit };
        for i in 0..V::DIM {
            let n = self.normal.get(i).as_f64();
            let term = n * frame.origin().get(i).as_f64();
            (rest, terms) = (rest + term, terms + term.abs());
            coarse.normal[i] = Vec4::splat(n as f32);
            coarse.nearest[i] = usize::from(n < 0.0);
        }
        coarse.rest = CoarseUnit::down((rest - 16.0 * epsilon * terms) * unit.per_unit());
        coarse
    }
}

impl<V: Vector> Question<V> for HeightBound<V> {
    fn seen_from(&self, frame: &InstanceFrame<V>) -> Self {
        let offset = frame.offset(self.normal, self.offset);
        let room = frame.room(V::axis(0) * self.offset.abs());
        Self { normal: frame.vector(self.normal), offset: offset + room }
    }
}

/// A [`HeightBound`] in the frame of a tree.
pub(super) struct CoarseHeight {
    /// Unused coordinates are zero.
    normal: [Vec4; 3],
    /// The nearest side of a box.
    nearest: [usize; 3],
    /// The part that is the same for all boxes, rounded down.
    rest: f32,
    unit: CoarseUnit,
}

impl CoarseBound for CoarseHeight {
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        let (mut height, mut terms) = (Vec4::splat(self.rest), Vec4::splat(self.rest.abs()));
        for i in 0..3 {
            let term = self.normal[i] * if self.nearest[i] == 0 { boxes.min(i) } else { boxes.max(i) };
            (height, terms) = (height + term, terms + term.abs());
        }
        height -= terms * (16.0 * f32::EPSILON);
        // NaN proves nothing.
        Vec4::select(height.cmpgt(Vec4::ZERO), height.min(Vec4::MAX), Vec4::ZERO)
    }

    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit(limit)
    }
}
