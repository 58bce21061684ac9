//! The joints between the world, or another link, and a link, and the motion of that link along an edge of a path.

use alloc::vec::Vec;
use core::cell::Cell;

use convex_support::numerics::bound::raised;
use convex_support::{BoundingSphere, Matrix as _, Scalar, Vector};
use num_traits::Float as _;

use super::frame::{LinkFrame, epsilons};
use super::joint::{JointStage, MovingFrame};
use super::joint_trajectory::{JointBounds, JointState, JointTrajectory};
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

    /// The bounds for points of the link, given those of each joint value by its column.
    pub(super) fn bounds(&self, of: impl Fn(usize) -> JointBounds<V::Scalar>) -> Bounds<V::Scalar> {
        let (mut bounds, mut next) = (Bounds::REST, [V::Scalar::ZERO; 2]);
        for stage in self.stages.iter().rev() {
            if stage.turns() {
                bounds.turn(of(stage.column), next[1]);
            } else {
                bounds.slide(of(stage.column));
            }
            bounds.lengthen(next[0]);
            next = [stage.arm, stage.off_axis];
        }
        bounds
    }

    /// How the frame of the last joint moves at a time, and where the frame of the link is.
    pub(super) fn place(
        &self,
        edge: impl JointTrajectory<Scalar = V::Scalar>,
        time: V::Scalar,
    ) -> (MovingFrame<V>, LinkFrame<V>) {
        let stages = self.stages.iter();
        let moving =
            stages.fold(MovingFrame::WORLD, |moving, stage| moving.beyond(stage, edge.state(stage.column, time)));
        (moving, moving.frame.then(&self.tail))
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

impl<'p, S: Scalar> PathEdge<'p, S> {
    /// The edge from a waypoint to the next one; from the last one it stays there.
    pub(super) fn between<W: AsRef<[S]>>(waypoints: &'p [W], index: usize) -> Self {
        let [from, to] = [index, (index + 1).min(waypoints.len() - 1)].map(|waypoint| waypoints[waypoint].as_ref());
        Self { from, to }
    }
}

impl<S: Scalar> JointTrajectory for PathEdge<'_, S> {
    type Scalar = S;

    /// With `u = ε/2`, the roundings of the time, of the rate and of their product change the value by no more than
    /// `3u` of the rate, and the rounding of the sum changes it by no more than `u` of the larger value.
    #[inline]
    fn state(&self, column: usize, time: S) -> JointState<S> {
        let (from, to) = (self.from[column], self.to[column]);
        let rate = to - from;
        let error = epsilons::<S>(2.0) * (rate.abs() + from.abs().max(to.abs()));
        JointState { value: from + rate * time, rate, acceleration: S::ZERO, error }
    }

    fn bounds(&self, column: usize) -> JointBounds<S> {
        let (from, to) = (self.from[column], self.to[column]);
        JointBounds { value: from.abs().max(to.abs()), ..JointBounds::constant((to - from).abs()) }
    }
}

/// The motion of a link from a time of an edge on. Its displacement takes a body from its place in the link's own frame
/// to where the joints have it.
pub(super) struct LinkMotion<'l, V: Vector, E> {
    route: &'l Route<V>,
    pub(super) edge: E,
    bounds: Bounds<V::Scalar>,
    start: V::Scalar,
    /// The result of the last call of [`at`](Self::at), since most times are asked for more than once.
    last: Cell<(V::Scalar, MovingFrame<V>, LinkFrame<V>)>,
}

impl<'l, V: Vector, E: JointTrajectory<Scalar = V::Scalar> + Copy> LinkMotion<'l, V, E> {
    /// The motion by a route from a time on, with the [bounds](Route::bounds) for it.
    pub(super) fn new(route: &'l Route<V>, edge: E, bounds: Bounds<V::Scalar>, start: V::Scalar) -> Self {
        let last = Cell::new((V::Scalar::nan(), MovingFrame::WORLD, LinkFrame::WORLD));
        Self { route, edge, bounds, start, last }
    }

    /// What [`Route::place`] says of a time after the start.
    pub(super) fn at(&self, time: V::Scalar) -> (MovingFrame<V>, LinkFrame<V>) {
        let (known, moving, frame) = self.last.get();
        if known == time {
            return (moving, frame);
        }
        let (moving, frame) = self.route.place(self.edge, self.start + time);
        self.last.set((time, moving, frame));
        (moving, frame)
    }
}

impl<V: Vector, E: JointTrajectory<Scalar = V::Scalar> + Copy> Trajectory for LinkMotion<'_, V, E> {
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
    /// `b` bounds `|ω′| + |ω|²` in the interval. At its end `ω` and `ω′` are known. In between, with `α` and `β` for
    /// the sums of the bounds on the accelerations and jerks of the joint values, `ω` changes by no more than `w² + α`
    /// per unit of time, and `ω′` by no more than `w³ + 2w·α + β`: `ω` is the sum of `q′·u` for the unit axes `u`, each
    /// of which turns with the joints before it, `u′ = ω₀ × u` and `u″ = ω₀′ × u + ω₀ × u′`, so that `ω′` is a sum of
    /// `q″` and products of the rates of two joints, and `ω″` one of `q‴`, at most two products of the rate of one
    /// joint and the acceleration of another for each such pair, and products of three rates.
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
        let [up, up_rate] = bounds.spin_up;
        let most = w * w + up;
        let turned = most * duration;
        let spin = moving.spin.norm() + turned;
        let bending = (moving.spin_rate.norm() + (w * turned + (w * up + up_rate) * duration) + spin * spin).min(most);
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

#[cfg(test)]
mod tests {
    use alloc::vec;

    use convex_support::glam::DVec3;

    use super::{JointBounds, JointState, JointTrajectory, LinkFrame, Route};
    use crate::linkage::joint::{JointKind, JointStage};

    struct Cubic;

    impl JointTrajectory for Cubic {
        type Scalar = f64;

        fn state(&self, joint: usize, t: f64) -> JointState<f64> {
            let k = 0.5 + joint as f64;
            let value = k * t - t * t + k * t * t * t;
            JointState { value, rate: k - 2.0 * t + 3.0 * k * t * t, acceleration: 6.0 * k * t - 2.0, error: 0.0 }
        }

        fn bounds(&self, joint: usize) -> JointBounds<f64> {
            let k = 0.5 + joint as f64;
            JointBounds { value: 2.0 * k + 1.0, rate: 4.0 * k, acceleration: 6.0 * k + 2.0, jerk: 6.0 * k }
        }
    }

    /// Velocities and accelerations are those of differences of places and velocities, and no more than is bounded, as
    /// are the differences of accelerations.
    #[test]
    fn derivatives_of_joints_whose_rates_change_are_those_of_differences() {
        let frame = |x, y, z| LinkFrame { translation: DVec3::new(x, y, z), ..LinkFrame::WORLD };
        let stage = |x, kind, k| JointStage::new(frame(x, 0.3, -0.2), kind, k).expect("an axis");
        let stages = vec![
            stage(0.1, JointKind::Revolute(DVec3::Z), 0),
            stage(0.7, JointKind::Prismatic(DVec3::new(0.3, 1.0, 0.2)), 1),
            stage(-0.4, JointKind::Revolute(DVec3::new(1.0, 0.5, -0.3)), 2),
            stage(0.5, JointKind::Revolute(DVec3::Y), 3),
        ];
        let (route, point) = (Route::new(stages, frame(0.2, 0.1, 0.4)), DVec3::new(0.3, -0.2, 0.6));
        let (bounds, distance, h) = (route.bounds(|joint| Cubic.bounds(joint)), route.distance(point), 1e-4);
        let at = |time| {
            let (moving, frame) = route.place(Cubic, time);
            let place = frame.of(point);
            let angular = [moving.spin, moving.spin_rate];
            ([place, moving.velocity_at(place), moving.acceleration_at(place)], angular)
        };
        for k in 1..20 {
            let time = f64::from(k) * 0.05;
            let ((before, turned), (now, angular), (after, turns)) = (at(time - h), at(time), at(time + h));
            let difference = |a: DVec3, b: DVec3| (b - a) / (2.0 * h);
            for i in 0..2 {
                let off = (difference(before[i], after[i]) - now[i + 1]).length();
                assert!(off < 1e-4 * (1.0 + now[i + 1].length()), "derivative {i} at {time}: {off}");
            }
            assert!((difference(turned[0], turns[0]) - angular[1]).length() < 1e-4 * (1.0 + angular[1].length()));
            assert!(
                now[1].length() <= bounds.speed.of(distance) && now[2].length() <= bounds.acceleration.of(distance)
            );
            assert!(difference(before[2], after[2]).length() <= bounds.jerk.of(distance), "jerk at {time}");
            let (w, [up, rate]) = (bounds.spin, bounds.spin_up);
            assert!(angular[0].length() <= w && angular[1].length() <= w * w + up, "{angular:?} at {time}");
            let jerk = difference(turned[1], turns[1]).length();
            assert!(jerk <= w * w * w + 2.0 * w * up + rate, "{jerk} at {time}");
        }
    }
}
