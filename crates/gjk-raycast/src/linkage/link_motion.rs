//! The joints between the world, or another link, and a link, and the motion of that link along an edge of a path.

use alloc::vec::Vec;
use core::cell::Cell;

use convex_support::numerics::bound::raised;
use convex_support::{BoundingSphere, Matrix as _, Scalar, Vector};
use num_traits::Float as _;

use super::frame::{LinkFrame, epsilons};
use super::joint::{JointStage, Moving, Value};
use crate::motion::Bounds;
use crate::{Displacement, Trajectory, TurningPlane};

/// The moving joints on the way from one frame to a link, and the link's frame beyond the last of them.
#[derive(Clone, Debug)]
pub(super) struct Route<V: Vector> {
    pub(super) stages: Vec<JointStage<V>>,
    pub(super) tail: LinkFrame<V>,
}

impl<V: Vector> Route<V> {
    pub(super) fn new(mut stages: Vec<JointStage<V>>, tail: LinkFrame<V>) -> Self {
        for k in 1..stages.len() {
            let (axis, arm) = (stages[k - 1].axis, stages[k].fixed.translation);
            stages[k].off_axis = if V::DIM == 3 { arm - axis * axis.dot(arm) } else { arm }.norm();
        }
        Self { stages, tail }
    }

    /// The bounds for points of the link, if the joint values change at these rates, and no joint slides farther than
    /// `slides` says. Both are asked for by the column of the joint value.
    pub(super) fn bounds(
        &self,
        rates: impl Fn(usize) -> V::Scalar,
        slides: impl Fn(usize) -> V::Scalar,
    ) -> Bounds<V::Scalar> {
        let (mut bounds, mut next) = (Bounds::REST, [V::Scalar::ZERO; 2]);
        for stage in self.stages.iter().rev() {
            if stage.turns() {
                bounds.turn(rates(stage.column), next[1]);
            } else {
                bounds.slide(rates(stage.column), slides(stage.column));
            }
            bounds.lengthen(next[0]);
            next = [stage.arm, stage.off_axis];
        }
        bounds
    }

    /// How far a point of the link is from the origin of its last joint.
    pub(super) fn distance(&self, point: V) -> V::Scalar {
        self.tail.of(point).norm()
    }

    /// The route from one frame to another, each of which is given by its route from the world. It goes back along the
    /// first route to the last joint that both share, and from there along the second.
    ///
    /// With the fixed frames `F`, the motions `M` and the tail `T`, the inverse of `F₁M₁…FₙMₙT` is
    /// `T⁻¹·Mₙ⁻¹·Fₙ⁻¹·…·M₁⁻¹·F₁⁻¹`. So on the way back the motion of each stage comes after the inverse of the fixed
    /// frame that used to follow it.
    pub(super) fn between(from: &Self, to: &Self) -> Self {
        let shared = from.stages.iter().zip(&to.stages).take_while(|(a, b)| a.column == b.column).count();
        let mut fixed = from.tail.inverse();
        let mut stages = Vec::with_capacity(from.stages.len() + to.stages.len() - 2 * shared);
        for stage in from.stages[shared..].iter().rev() {
            stages.push(stage.from(fixed, -V::Scalar::ONE));
            fixed = stage.fixed.inverse();
        }
        for (i, stage) in to.stages[shared..].iter().enumerate() {
            let before = if i == 0 { fixed.then(&stage.fixed) } else { stage.fixed };
            stages.push(stage.from(before, V::Scalar::ONE));
        }
        let leads_on = to.stages.len() > shared;
        Self::new(stages, if leads_on { to.tail } else { fixed.then(&to.tail) })
    }
}

/// A straight edge in joint space, which takes one unit of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathEdge<'p, S> {
    pub(super) from: &'p [S],
    pub(super) to: &'p [S],
}

impl<S: Scalar> PathEdge<'_, S> {
    /// A joint value at a time.
    ///
    /// With `u = ε/2`, the roundings of the time, of the rate and of their product change the value by no more than
    /// `3u` of the rate, and the rounding of the sum changes it by no more than `u` of the larger value.
    #[inline]
    pub(super) fn at(&self, column: usize, time: S) -> Value<S> {
        let (from, to) = (self.from[column], self.to[column]);
        let rate = to - from;
        let error = epsilons::<S>(2.0) * (rate.abs() + from.abs().max(to.abs()));
        Value { value: from + rate * time, rate, error }
    }

    /// The bounds for a route along this edge.
    pub(super) fn bounds<V: Vector<Scalar = S>>(&self, route: &Route<V>) -> Bounds<S> {
        let rate = |column: usize| (self.to[column] - self.from[column]).abs();
        route.bounds(rate, |column| self.from[column].abs().max(self.to[column].abs()))
    }

    /// How the frame of the last joint of a route moves at a time, and where the frame of the link is.
    pub(super) fn place<V: Vector<Scalar = S>>(&self, route: &Route<V>, time: S) -> (Moving<V>, LinkFrame<V>) {
        let stages = route.stages.iter();
        let moving = stages.fold(Moving::WORLD, |moving, stage| moving.beyond(stage, self.at(stage.column, time)));
        (moving, moving.frame.then(&route.tail))
    }
}

/// The motion of a link from a time of an edge on. Its displacement takes a body from its place in the link's own frame
/// to where the joints have it.
pub(super) struct LinkMotion<'l, V: Vector> {
    route: &'l Route<V>,
    pub(super) edge: PathEdge<'l, V::Scalar>,
    bounds: Bounds<V::Scalar>,
    start: V::Scalar,
    /// The result of the last call of [`at`](Self::at), since most times are asked for more than once.
    last: Cell<(V::Scalar, Moving<V>, LinkFrame<V>)>,
}

impl<'l, V: Vector> LinkMotion<'l, V> {
    /// The motion by a route from a time on, with the [bounds](PathEdge::bounds) for it.
    pub(super) fn new(
        route: &'l Route<V>,
        edge: PathEdge<'l, V::Scalar>,
        bounds: Bounds<V::Scalar>,
        start: V::Scalar,
    ) -> Self {
        let last = Cell::new((V::Scalar::nan(), Moving::WORLD, LinkFrame::WORLD));
        Self { route, edge, bounds, start, last }
    }

    /// What [`PathEdge::place`] says of a time after the start.
    pub(super) fn at(&self, time: V::Scalar) -> (Moving<V>, LinkFrame<V>) {
        let (known, moving, frame) = self.last.get();
        if known == time {
            return (moving, frame);
        }
        let (moving, frame) = self.edge.place(self.route, self.start + time);
        self.last.set((time, moving, frame));
        (moving, frame)
    }
}

impl<V: Vector> Trajectory for LinkMotion<'_, V> {
    type Vector = V;

    fn displacement(&self, time: V::Scalar) -> Displacement<V> {
        let (_, frame) = self.at(time);
        Displacement {
            pivot: V::ZERO,
            shift: frame.translation,
            turn: frame.rotation - V::Matrix::IDENTITY,
            // The last term is for the difference, and for a product with it.
            turn_error: if frame.is_world() { frame.turn_error } else { raised(frame.turn_error + epsilons(8.0)) },
            shift_error: raised(frame.shift_error),
        }
    }

    fn velocity(&self, time: V::Scalar, point: V) -> V {
        self.at(time).0.velocity_at(point)
    }

    /// The bound that holds at all times ([`Bounds`]), or the bound near the end of the interval, if that is less. Let
    /// `c` be the centre of the ball, `ρ` its radius, `e` the end of the interval and `t` a time before it. Then
    ///
    /// > n·ẍ ≤ n·c̈(e) + |n|·(j·(e − t) + ρ·b),   r·ẋ ≤ r·ċ(e) + |r|·(a·(e − t) + ρ·w),
    ///
    /// where `a` and `j` bound the acceleration and the jerk of the centre, `w` bounds the angular velocity `ω`, and
    /// `b` bounds `|ω′| + |ω|²` in the interval. At its end `ω` and `ω′` are known. In between `ω` changes by no more
    /// than `w²` per unit of time, as `ω′` is a sum of products of two rates, and `ω′` by no more than `w³`.
    fn acceleration_along(
        &self,
        ball: BoundingSphere<V>,
        plane @ TurningPlane { from, to }: TurningPlane<V>,
        interval @ [start, end]: [V::Scalar; 2],
    ) -> V::Scalar {
        let (bounds, distance, duration) = (&self.bounds, self.route.distance(ball.center), end - start);
        let always = bounds.along(plane, interval, distance + ball.radius);
        // In so long an interval the second bound is not less. It may also have no end.
        if !(bounds.spin * duration < V::Scalar::ONE) {
            return always;
        }
        let (moving, frame) = self.at(end);
        let (center, w, longest) = (frame.of(ball.center), bounds.spin, from.norm().max(to.norm()));
        let rate = if from == to { V::ZERO } else { (to - from) / duration };
        let turned = w * w * duration;
        let spin = moving.spin.norm() + turned;
        let bending = (moving.spin_rate.norm() + w * turned + spin * spin).min(w * w);
        let acceleration = moving.acceleration_at(center);
        let along = from.dot(acceleration).max(to.dot(acceleration))
            + longest * (bounds.jerk.of(distance) * duration + ball.radius * bending);
        let turning = rate.dot(moving.velocity_at(center))
            + rate.norm() * (bounds.acceleration.of(distance) * duration + ball.radius * w);
        // The errors of the frame and of the derivatives are a small part of the bound that always holds.
        let near = along + V::Scalar::from_f64(2.0) * turning + always * (frame.turn_error + epsilons(64.0));
        // A NaN is not taken for a bound.
        if near < always { near } else { always }
    }
}
