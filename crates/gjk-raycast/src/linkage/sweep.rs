//! Which bodies may come near one another along an edge, and when.
//!
//! The edge is halved again and again. In the middle of each part the joints are placed once, for all links as the
//! world sees them. Let a ball around a link have the velocity `v` and the acceleration `a` there, and let `j` bound
//! its jerk. Then the ball goes no farther within the time `h` than `v·h + a·h²/2 + j·h³/6`. If nothing is within that
//! distance of the ball, the link is free for the whole part. If something is, the part is halved, as long as the
//! distance is large beside the ball. After that, each body of the link is listed with what is near it, to be cast.
//! One link is looked at from another only if their regions are near one another as the world sees them: most pairs of
//! links are far apart, and the route from one to the other is long.

use alloc::vec::Vec;
use core::ops::{ControlFlow, Range};

use convex_support::{Aabb, BoundingSphere, BoxDistance, Bvh, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use super::frame::{LinkFrame, epsilons};
use super::joint::MovingFrame;
use super::joint_trajectory::JointTrajectory;
use super::link_motion::LinkMotion;
use super::robot::{LinkBalls, LinkView, Skeleton};
use crate::Scene;
use crate::half_space::Plane;
use crate::motion::Bounds;

/// If a ball moves by more than this part of its radius, the part of the edge is halved.
const COARSE: f64 = 0.5;
/// How often an edge is halved at most.
const MAX_DEPTH: u32 = 9;
/// Once the edge is halved this often, what is near is cast before the next part is looked at, since the cast may find
/// a contact that ends the search.
const CAST_DEPTH: u32 = 2;

/// Two bodies that may come near one another in a part of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near<S> {
    pub(super) from: S,
    pub(super) to: S,
    /// The index of the view of a link.
    pub(super) view: usize,
    /// The body of the link.
    pub(super) body: usize,
    /// The body of the scene, or of the link that it is seen from.
    pub(super) other: usize,
}

/// What [`Linkage::path`](crate::Linkage::path) works with. Once it has served a path of a linkage, the next allocates
/// nothing.
#[derive(Clone, Debug, Default)]
pub struct PathWorkspace<V: Vector> {
    pub(super) half_spaces: Vec<(usize, Plane<V>)>,
    /// Bounds on the speed, acceleration and jerk of each link along the edge, as the world sees it.
    bounds: Vec<Bounds<V::Scalar>>,
    /// The region of each link in a part, as the world sees it, if pairs of links are looked at.
    regions: Vec<SweptBall<V>>,
    /// How each joint moves in the middle of a part, as the world sees it.
    moving: Vec<MovingFrame<V>>,
    /// The views that are not known to be free, for each of the nested parts that are being looked at.
    views: Vec<usize>,
    /// The indices of the bodies that are near a link.
    found: Vec<usize>,
    /// What has been found to be near, and not yet been shown.
    near: Vec<Near<V::Scalar>>,
}

impl<V: Vector> PathWorkspace<V> {
    /// Keeps the half-spaces of a scene.
    pub(super) fn put_half_spaces<O: SupportMap<Vector = V>>(&mut self, scene: &Scene<O>) {
        self.half_spaces.clear();
        self.half_spaces.extend(scene.all().half_spaces().map(|(index, half_space)| (index, half_space.plane())));
    }

    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

/// What is shown: two bodies, the motion of the first from the time on when they begin to be near, and the target.
pub(super) trait Shows<'s, V: Vector, E, R>:
    FnMut(&Near<V::Scalar>, LinkMotion<'s, V, E>, &mut V::Scalar) -> Result<V::Scalar, R>
{
}

impl<'s, V: Vector, E, R, F> Shows<'s, V, E, R> for F where
    F: FnMut(&Near<V::Scalar>, LinkMotion<'s, V, E>, &mut V::Scalar) -> Result<V::Scalar, R>
{
}

/// The search for what comes near along an edge.
pub(super) struct Sweep<'s, V: Vector, E> {
    pub(super) skeleton: &'s Skeleton<V>,
    pub(super) tree: &'s Bvh<V>,
    pub(super) edge: E,
    /// The distance within which bodies count as near; infinite if all of them are to be shown.
    pub(super) target: V::Scalar,
    pub(super) space: &'s mut PathWorkspace<V>,
    /// The time after which no contact can be the first.
    pub(super) end: V::Scalar,
    /// The number of parts that were looked at.
    pub(super) parts: usize,
}

/// The region that a ball of a link stays in during a part of an edge: the intersection of a ball and a box.
#[derive(Clone, Copy, Debug)]
struct SweptBall<V: Vector> {
    /// The centre of both: where the centre of the link's ball is in the middle of the part.
    center: V,
    /// Half the size of the box along each axis, and the radius of the ball.
    along: V,
    radius: V::Scalar,
    /// How far the centre of the link's ball may move.
    drift: V::Scalar,
}

impl<'s, V: Vector, E: JointTrajectory<Scalar = V::Scalar> + Copy> Sweep<'s, V, E> {
    /// Calls `show` for each two bodies that may come near one another until the end. They come in the order of the
    /// times when they begin to be near, within each quarter of the edge. The call may lower the target, and returns a
    /// time after which no contact can be the first, with which the search ends.
    pub(super) fn run<R>(&mut self, show: &mut impl Shows<'s, V, E, R>) -> Result<(), R> {
        let (space, views) = (&mut *self.space, self.skeleton.views.len());
        space.near.clear();
        space.views.clear();
        space.views.extend(0..views);
        space.bounds.clear();
        let of_links = &self.skeleton.views[..self.skeleton.links.len()];
        space.bounds.extend(of_links.iter().map(|view| view.route.bounds(|column| self.edge.bounds(column))));
        self.visit([V::Scalar::ZERO, self.end], 0, 0..views, show)
    }

    /// Looks at a part of the edge, with the views that are not known to be free throughout it.
    fn visit<R>(
        &mut self,
        times @ [from, to]: [V::Scalar; 2],
        depth: u32,
        views: Range<usize>,
        show: &mut impl Shows<'s, V, E, R>,
    ) -> Result<(), R> {
        if from > self.end {
            return Ok(());
        }
        let half = (to - from) * V::Scalar::from_f64(0.5);
        let is_last = depth == MAX_DEPTH || half == V::Scalar::ZERO || self.target == V::Scalar::infinity();
        self.place(from + half);
        self.parts += 1;
        self.space.regions.clear();
        // Pairs come after the links.
        let links = self.skeleton.links.len();
        if self.space.views[views.clone()].last().is_some_and(|&last| last >= links) {
            for (link, LinkBalls { all, .. }) in self.skeleton.links.iter().enumerate() {
                let (view, placed) = (&self.skeleton.views[link], self.placed(link));
                let distance = view.route.distance(all.center);
                self.space.regions.push(SweptBall::of(all, distance, &placed, &self.space.bounds[link], half));
            }
        }
        let rest = self.space.views.len();
        for at in views {
            let view = self.space.views[at];
            if self.is_coarse(view, times, half, is_last) {
                self.space.views.push(view);
            }
        }
        let coarse = rest..self.space.views.len();
        if !coarse.is_empty() {
            for part in [[from, from + half], [from + half, to]] {
                self.visit(part, depth + 1, coarse.clone(), show)?;
            }
            self.space.views.truncate(rest);
        }
        if depth <= CAST_DEPTH {
            join(&mut self.space.near);
            for near in self.space.near.drain(..) {
                // A contact that was found earlier may have moved the end before it.
                if near.from <= self.end {
                    let cut = Near { to: near.to.min(self.end), ..near };
                    let route = &self.skeleton.views[near.view].route;
                    let known = self.space.bounds.get(near.view).copied();
                    let bounds = known.unwrap_or_else(|| route.bounds(|column| self.edge.bounds(column)));
                    let motion = LinkMotion::new(route, self.edge, bounds, near.from);
                    self.end = self.end.min(show(&cut, motion, &mut self.target)?);
                }
            }
        }
        Ok(())
    }

    /// Places the joints at a time.
    fn place(&mut self, time: V::Scalar) {
        self.space.moving.clear();
        for (before, stage) in &self.skeleton.stages {
            let carrier = before.map_or(MovingFrame::WORLD, |before| self.space.moving[before]);
            self.space.moving.push(carrier.beyond(stage, self.edge.state(stage.column, time)));
        }
    }

    /// How a link moves as the world sees it, in the middle of the part.
    fn placed(&self, link: usize) -> (MovingFrame<V>, LinkFrame<V>) {
        let route = &self.skeleton.views[link].route;
        let moving = route.stages.last().map_or(MovingFrame::WORLD, |stage| self.space.moving[stage.column]);
        (moving, moving.frame.then(&route.tail))
    }

    /// Lists what is near a link in a part of the edge, body by body. If something is near, but the link moves so far
    /// that the part is to be halved, it lists nothing and returns `true`.
    fn is_coarse(&mut self, index: usize, [from, to]: [V::Scalar; 2], half: V::Scalar, is_last: bool) -> bool {
        let LinkView { link, base, ref route } = self.skeleton.views[index];
        let is_near = |reach: &SweptBall<V>, &BoundingSphere { center, radius }: &BoundingSphere<V>| {
            reach.meets_box(&Aabb { min: center, max: center }, radius + self.target)
        };
        let (placed, bounds) = match base {
            Some(base) => {
                let [reach, SweptBall { center, radius, .. }] = [link, base].map(|link| self.space.regions[link]);
                if !is_near(&reach, &BoundingSphere { center, radius }) {
                    return false;
                }
                (route.place(self.edge, from + half), route.bounds(|column| self.edge.bounds(column)))
            }
            None => (self.placed(link), self.space.bounds[index]),
        };
        let (link, base) = (&self.skeleton.links[link], base.map(|base| &self.skeleton.links[base]));
        let swept = |ball| SweptBall::of(ball, route.distance(ball.center), &placed, &bounds, half);
        let reach = swept(&link.all);
        let smaller = base.map_or(link.all.radius, |base| link.all.radius.min(base.all.radius));
        let is_coarse = !is_last && reach.drift > smaller * V::Scalar::from_f64(COARSE);
        let mut found = core::mem::take(&mut self.space.found);
        found.clear();
        if let Some(base) = base {
            found.extend(0..if is_near(&reach, &base.all) { base.each.len() } else { 0 });
        } else {
            let planes = self.space.half_spaces.iter();
            found.extend(planes.filter(|(_, plane)| reach.meets_plane(plane, self.target)).map(|(index, _)| *index));
            self.tree.within(&BoxDistance::new(reach.around()), self.target, |body| {
                found.push(body);
                if is_coarse { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
        }
        let is_coarse = is_coarse && !found.is_empty();
        for (body, ball) in link.each.iter().enumerate().filter(|_| !is_coarse && !found.is_empty()) {
            let reach = swept(ball);
            let meets = |other: usize| match (base, self.tree.get(other)) {
                (Some(base), _) => is_near(&reach, &base.each[other]),
                (None, Some(around)) => reach.meets_box(&around, self.target),
                (None, None) => {
                    self.space.half_spaces.iter().any(|(k, plane)| *k == other && reach.meets_plane(plane, self.target))
                }
            };
            let near = found.iter().filter(|&&other| meets(other));
            self.space.near.extend(near.map(|&other| Near { from, to, view: index, body, other }));
        }
        self.space.found = found;
        is_coarse
    }
}

impl<V: Vector> SweptBall<V> {
    /// The region of a ball in the frame of a link, given how the link moves in the middle of the part, half the
    /// duration of the part, and the distance of the ball's centre from the origin of the last joint.
    fn of(
        ball: &BoundingSphere<V>,
        distance: V::Scalar,
        (moving, frame): &(MovingFrame<V>, LinkFrame<V>),
        bounds: &Bounds<V::Scalar>,
        half: V::Scalar,
    ) -> Self {
        let (number, squared) = (V::Scalar::from_f64, half * half);
        let center = frame.of(ball.center);
        let bent = bounds.jerk.of(distance) * half * squared * number(1.0 / 6.0);
        let always = bounds.speed.of(distance) * half;
        let (velocity, acceleration) = (moving.velocity_at(center), moving.acceleration_at(center));
        let way = velocity.abs() * half + acceleration.abs() * (squared * number(0.5)) + V::splat(bent);
        let way = way.min(V::splat(always));
        let drift = way.norm().min(always);
        // The error of the ball's place, and of the derivatives that these lengths are made of.
        let uneven = bounds.acceleration.of(distance) * squared;
        let lost = (frame.turn_error + epsilons(64.0)) * (always + uneven + bent + distance);
        let room = ball.radius + frame.error_of(ball.center.norm()) + lost;
        Self { center, along: (way + V::splat(room)) * above::<V>(), radius: (room + drift) * above::<V>(), drift }
    }

    /// The box. If a number is not finite, it is the largest box, so that nothing is left out and the casts find out.
    fn around(&self) -> Aabb<V> {
        let (min, max) = (self.center - self.along, self.center + self.along);
        let all = V::splat(V::Scalar::max_value());
        if min.is_finite() && max.is_finite() { Aabb { min, max } } else { Aabb { min: -all, max: all } }
    }

    /// Whether it may come as near to a box as the target distance. If a number is NaN, it may.
    fn meets_box(&self, around: &Aabb<V>, target: V::Scalar) -> bool {
        let gaps = (around.min - self.center).max(self.center - around.max).max(V::ZERO);
        !(gaps.norm() > (self.radius + target) * above::<V>())
    }

    /// Whether it may come as near to the half-space below a plane as the target distance.
    fn meets_plane(&self, plane: &Plane<V>, target: V::Scalar) -> bool {
        !(plane.height([self.center], V::Scalar::ZERO, self.radius * above::<V>()).least() > target)
    }
}

/// A factor by which lengths are increased to make up for the rounding of a few products and sums.
fn above<V: Vector>() -> V::Scalar {
    V::Scalar::ONE + epsilons(32.0)
}

/// Joins parts that follow one another for the same two bodies, and sorts what is left by time.
fn join<S: Scalar>(near: &mut Vec<Near<S>>) {
    let key = |near: &Near<S>| (near.view, near.body, near.other);
    let by_time = |a: &Near<S>, b: &Near<S>| a.from.partial_cmp(&b.from).unwrap_or(core::cmp::Ordering::Equal);
    near.sort_unstable_by(|a, b| key(a).cmp(&key(b)).then(by_time(a, b)));
    near.dedup_by(|next, last| {
        let follows = key(next) == key(last) && next.from <= last.to;
        if follows {
            last.to = next.to;
        }
        follows
    });
    near.sort_unstable_by(|a, b| by_time(a, b).then(key(a).cmp(&key(b))));
}
