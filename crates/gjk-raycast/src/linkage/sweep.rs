//! Which bodies may come near one another along an edge, and when.
//!
//! The edge is halved again and again. At the middle of each part the joints are placed once, for all links. A ball
//! around a link has moved from there by no more than its velocity `v` and its acceleration `a` there tell, and a bound
//! on how fast that changes: by `v·h + a·h²/2 + j·h³/6` within the time `h`. If nothing is within that reach, the link is
//! free for the whole part; else, once the reach is not much more than the ball itself, its bodies and what is near them
//! are left to be cast.

use alloc::vec::Vec;
use core::ops::{ControlFlow, Range};

use convex_support::{Aabb, BoundingSphere, BoxDistance, Bvh, Matrix as _, Scalar, Vector};
use num_traits::Float as _;

use super::axial;
use super::bounds::Bounds;
use super::frame::epsilons;
use super::link_motion::PathEdge;
use super::linkage::{Around, LinkPair, Skeleton};
use super::moving::Moving;
use super::proof::{Watch, gap_to};
use super::result::Met;
use crate::half_space::Plane;

/// A ball that moves by more than this part of its radius is looked at in a shorter time.
const COARSE: f64 = 0.5;
/// How often an edge is halved at most.
const MAX_DEPTH: u32 = 9;
/// Once it is halved so often, what is near is cast before the next part is looked at, which may be in vain.
const CAST_DEPTH: u32 = 2;

/// Two bodies that may come near one another within a part of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near<S> {
    pub(super) from: S,
    pub(super) to: S,
    /// A link against the scene, or after all links a pair of them.
    pub(super) item: usize,
    /// The body of the link, or of the first one.
    pub(super) body: usize,
    /// The body of the scene, or of the second link.
    pub(super) other: usize,
}

/// What a sweep works with; it is kept from edge to edge.
#[derive(Clone, Debug, Default)]
pub(super) struct SweepSpace<V: Vector> {
    /// How the joints move at the middle of a part.
    moving: Vec<Moving<V>>,
    /// The links and pairs that are not known to be free in the parts that are being looked at.
    items: Vec<usize>,
    /// The bounds of each link and pair.
    bounds: Vec<Bounds<V::Scalar>>,
    /// The bodies of the scene near a link.
    found: Vec<usize>,
    /// What has been found and not yet shown.
    near: Vec<Near<V::Scalar>>,
    pub(super) parts: usize,
}

/// A look for what is near along an edge.
pub(super) struct Sweep<'s, V: Vector> {
    pub(super) skeleton: &'s Skeleton<V>,
    pub(super) tree: &'s Bvh<V>,
    pub(super) half_spaces: &'s [(usize, Plane<V>)],
    pub(super) edge: PathEdge<'s, V::Scalar>,
    /// How near is too near.
    pub(super) target: V::Scalar,
    pub(super) space: &'s mut SweepSpace<V>,
}

/// A part of an edge.
#[derive(Clone, Copy)]
struct EdgePart<S> {
    middle: S,
    half: S,
    /// Whether it is as short as it gets.
    is_last: bool,
}

/// Everything that a ball touches in a part of an edge.
struct SweptBall<V: Vector> {
    /// Where its centre is in the middle of the part.
    center: V,
    /// How far it goes from there, along each axis and in any direction.
    along: V,
    radius: V::Scalar,
    /// By how much the ball itself is smaller.
    drift: V::Scalar,
}

/// What is known of a link or a pair in a part of an edge.
#[derive(PartialEq)]
enum PartState {
    /// It is free.
    Free,
    /// The part is to be halved.
    Coarse,
    /// What is near has been found.
    Found,
}

impl<V: Vector> Sweep<'_, V> {
    /// Shows what may come near in an edge that takes some time: 1, or 0 of a path that is a pose. It is shown in the
    /// order of time but for what is near for long, and beside it the bounds of its link or pair. The answer is a time
    /// from which on nothing matters.
    pub(super) fn run<E>(
        &mut self,
        duration: V::Scalar,
        watch: &mut Watch<'_, V>,
        show: &mut impl FnMut(&Near<V::Scalar>, &Bounds<V::Scalar>, &mut Watch<'_, V>) -> Result<V::Scalar, E>,
    ) -> Result<(), E> {
        let (links, pairs) = (&self.skeleton.links, &self.skeleton.pairs);
        let routes = links.iter().map(|link| &link.route).chain(pairs.iter().map(|pair| &pair.route));
        self.space.bounds.clear();
        self.space.bounds.extend(routes.map(|route| self.edge.bounds(route)));
        self.space.near.clear();
        self.space.items.clear();
        self.space.items.extend(0..links.len() + pairs.len());
        let mut end = duration;
        self.visit([V::Scalar::ZERO, duration], 0, 0..links.len() + pairs.len(), &mut end, watch, show)
    }

    /// Looks at a part of the edge for what is not known to be free in all of it.
    fn visit<E>(
        &mut self,
        [from, to]: [V::Scalar; 2],
        depth: u32,
        items: Range<usize>,
        end: &mut V::Scalar,
        watch: &mut Watch<'_, V>,
        show: &mut impl FnMut(&Near<V::Scalar>, &Bounds<V::Scalar>, &mut Watch<'_, V>) -> Result<V::Scalar, E>,
    ) -> Result<(), E> {
        if from > *end {
            return Ok(());
        }
        let half = (to - from) * V::Scalar::from_f64(0.5);
        let part = EdgePart { middle: from + half, half, is_last: depth == MAX_DEPTH || half == V::Scalar::ZERO };
        self.place(part.middle);
        self.space.parts += 1;
        let rest = self.space.items.len();
        for at in items {
            let item = self.space.items[at];
            let known = match item.checked_sub(self.skeleton.links.len()) {
                None => self.look_at_link(item, part, watch),
                Some(pair) => self.look_at_pair(item, &self.skeleton.pairs[pair], part, watch),
            };
            if known == PartState::Coarse {
                self.space.items.push(item);
            }
        }
        let coarse = rest..self.space.items.len();
        if !coarse.is_empty() {
            for half in [[from, part.middle], [part.middle, to]] {
                self.visit(half, depth + 1, coarse.clone(), end, watch, show)?;
            }
            self.space.items.truncate(rest);
        }
        if depth <= CAST_DEPTH {
            join(&mut self.space.near);
            for near in self.space.near.drain(..) {
                // A contact found before bounds those after it.
                if near.from <= *end {
                    let cut = Near { to: near.to.min(*end), ..near };
                    *end = end.min(show(&cut, &self.space.bounds[near.item], watch)?);
                }
            }
        }
        Ok(())
    }

    /// Places the joints at a time.
    fn place(&mut self, time: V::Scalar) {
        self.space.moving.clear();
        for (before, stage) in &self.skeleton.stages {
            let carrier = self.moving(*before);
            let moving = carrier.beyond(stage, self.edge.at(stage.column, time));
            self.space.moving.push(moving);
        }
    }

    /// How a joint moves, or the world.
    fn moving(&self, stage: Option<usize>) -> Moving<V> {
        stage.map_or(Moving::WORLD, |stage| self.space.moving[stage])
    }

    /// What is near a link in the scene.
    fn look_at_link(&mut self, item: usize, part: EdgePart<V::Scalar>, watch: &mut Watch<'_, V>) -> PartState {
        let link = &self.skeleton.links[item];
        let (moving, bounds) = (self.moving(link.stage), self.space.bounds[item]);
        let seen =
            |around: &Around<V>| SweptBall::of(*around, V::Scalar::ZERO, [&moving, &Moving::WORLD], &bounds, part.half);
        let reach = seen(&link.ball);
        let is_coarse = !part.is_last && reach.drift > link.ball.ball.radius * V::Scalar::from_f64(COARSE);
        let mut found = core::mem::take(&mut self.space.found);
        found.clear();
        let planes = self.half_spaces.iter().enumerate();
        found.extend(planes.filter(|(_, (_, plane))| reach.meets_plane(plane, self.target)).map(|(k, _)| k));
        let planes = found.len();
        if !(is_coarse && planes > 0) {
            self.tree.within(&BoxDistance::new(reach.around()), self.target, |body| {
                found.push(body);
                if is_coarse { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
        }
        let known = match (found.is_empty(), is_coarse) {
            (true, _) => PartState::Free,
            (false, true) => PartState::Coarse,
            (false, false) => PartState::Found,
        };
        let first = self.space.near.len();
        if known == PartState::Found {
            for (body, around) in link.balls.iter().enumerate() {
                let reach = seen(around);
                for (k, &other) in found.iter().enumerate() {
                    let (other, is_near) = if k < planes {
                        let (index, plane) = &self.half_spaces[other];
                        (*index, reach.meets_plane(plane, self.target))
                    } else {
                        (other, self.tree.get(other).is_none_or(|around| reach.meets_box(&around, self.target)))
                    };
                    if is_near {
                        self.space.near.push(part.near(item, body, other));
                    }
                }
            }
        }
        self.space.found = found;
        if watch.is_on() && known != PartState::Coarse {
            for (body, around) in link.balls.iter().enumerate() {
                let within = seen(around);
                self.show_apart([item, body], part, first, [&reach, &within], watch);
            }
        }
        known
    }

    /// Shows the planes that keep a body of a link from those of the scene that are not near: as far as all of the link
    /// is from a box, or the body alone.
    fn show_apart(
        &self,
        [item, body]: [usize; 2],
        part: EdgePart<V::Scalar>,
        first: usize,
        [of_link, of_body]: [&SweptBall<V>; 2],
        watch: &mut Watch<'_, V>,
    ) {
        let mut show = |other: usize, normal: V| {
            if !self.space.near[first..].iter().any(|near| near.body == body && near.other == other) {
                watch.show(part.times(), [item, body], Met::Obstacle(other), [normal; 2]);
            }
        };
        for (index, plane) in self.half_spaces {
            show(*index, plane.unit);
        }
        let (around, center) = (of_link.around(), Aabb { min: of_body.center, max: of_body.center });
        self.tree.within(&BoxDistance::new(around), V::Scalar::infinity(), |other| {
            let Some(at) = self.tree.get(other) else { return ControlFlow::Continue(()) };
            let [gap, from_center] = [gap_to(&around, &at), gap_to(&center, &at)];
            let gap = if gap.norm() > self.target { gap } else { from_center };
            show(other, gap.unit().unwrap_or(V::ZERO));
            ControlFlow::Continue(())
        });
    }

    /// Which bodies of two links are near one another.
    fn look_at_pair(
        &mut self,
        item: usize,
        pair: &LinkPair<V>,
        part: EdgePart<V::Scalar>,
        watch: &mut Watch<'_, V>,
    ) -> PartState {
        let [a, b] = pair.links.map(|link| &self.skeleton.links[link]);
        let [moving, base] = [a, b].map(|link| self.moving(link.stage));
        let bounds = self.space.bounds[item];
        let seen = |around: &Around<V>| SweptBall::of(*around, pair.route.rim, [&moving, &base], &bounds, part.half);
        let between = |reach: &SweptBall<V>, other: &Around<V>| reach.center - base.frame.of(other.ball.center);
        let is_near = |reach: &SweptBall<V>, other: &Around<V>| {
            let error = base.frame.error_of(other.distance);
            !(between(reach, other).norm() > (reach.radius + other.ball.radius + error + self.target) * above::<V>())
        };
        // A plane across that, in the frame of the second link, separates what is not near.
        let mut show = |body: usize, other: usize, between: V| {
            let frame = base.frame.then(&b.route.tail);
            let normal = frame.rotation.transpose_mul(between.unit().unwrap_or(V::ZERO));
            let met = Met::Link { link: pair.links[1], body: other };
            watch.show(part.times(), [pair.links[0], body], met, [normal; 2]);
        };
        let reach = seen(&a.ball);
        if !is_near(&reach, &b.ball) {
            for (body, other) in (0..a.balls.len()).flat_map(|body| (0..b.balls.len()).map(move |other| (body, other)))
            {
                show(body, other, between(&reach, &b.ball));
            }
            return PartState::Free;
        }
        let smaller = a.ball.ball.radius.min(b.ball.ball.radius);
        if !part.is_last && reach.drift > smaller * V::Scalar::from_f64(COARSE) {
            return PartState::Coarse;
        }
        for (body, around) in a.balls.iter().enumerate() {
            let reach = seen(around);
            for (other, around) in b.balls.iter().enumerate() {
                if is_near(&reach, around) {
                    self.space.near.push(part.near(item, body, other));
                } else {
                    show(body, other, between(&reach, around));
                }
            }
        }
        PartState::Found
    }
}

impl<S: Scalar> EdgePart<S> {
    fn times(self) -> [S; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    fn near(self, item: usize, body: usize, other: usize) -> Near<S> {
        let [from, to] = self.times();
        Near { from, to, item, body, other }
    }
}

impl<V: Vector> SweptBall<V> {
    /// Of a ball that a joint carries, as it moves against another frame that moves, or the world; `rim` is how far the
    /// joint is from the last one of the route between them, whose bounds these are.
    ///
    /// Seen from a frame that turns at `ω`, a point that moves at `v` against it has the acceleration `2ω × v` less.
    fn of(
        Around { ball: BoundingSphere { center, radius }, distance }: Around<V>,
        rim: V::Scalar,
        [moving, base]: [&Moving<V>; 2],
        bounds: &Bounds<V::Scalar>,
        half: V::Scalar,
    ) -> Self {
        let (number, squared) = (V::Scalar::from_f64, half * half);
        let center = moving.frame.of(center);
        let carried = base.velocity_at(center);
        let velocity = moving.velocity_at(center) - carried;
        let turning = axial::turning(base.spin, velocity);
        let acceleration = moving.acceleration_at(center) - base.acceleration_at(center) - turning - turning;
        let from_last = distance + rim;
        let bent = bounds.jerk.of(from_last) * half * squared * number(1.0 / 6.0);
        let always = bounds.speed.of(from_last) * half;
        let way = velocity.abs() * half + acceleration.abs() * (squared * number(0.5)) + V::splat(bent);
        let way = way.min(V::splat(always));
        let drift = way.norm().min(always);
        // What rounding does to where the ball is, and to derivatives of which these lengths are made.
        let lengths = always + bent + carried.norm() * half + base.acceleration_at(center).norm() * squared;
        let lost = (moving.frame.turn_error + base.frame.turn_error + epsilons(64.0)) * (lengths + distance);
        let room = radius + moving.frame.error_of(distance) + lost;
        Self { center, along: (way + V::splat(room)) * above::<V>(), radius: (room + drift) * above::<V>(), drift }
    }

    /// The box around it: one that contains everything where a number is not finite, so that nothing is left out, and
    /// every cast says so.
    fn around(&self) -> Aabb<V> {
        let (min, max) = (self.center - self.along, self.center + self.along);
        let all = V::splat(V::Scalar::max_value());
        if min.is_finite() && max.is_finite() { Aabb { min, max } } else { Aabb { min: -all, max: all } }
    }

    /// Whether it may come as near as the target to a box. NaN may.
    fn meets_box(&self, around: &Aabb<V>, target: V::Scalar) -> bool {
        let gaps = (around.min - self.center).max(self.center - around.max).max(V::ZERO);
        !(gaps.norm() > (self.radius + target) * above::<V>())
    }

    /// The same to the half-space below a plane.
    fn meets_plane(&self, plane: &Plane<V>, target: V::Scalar) -> bool {
        !(plane.height([self.center], V::Scalar::ZERO, self.radius * above::<V>()).least() > target)
    }
}

/// A factor that makes up for the rounding of some products and sums.
fn above<V: Vector>() -> V::Scalar {
    V::Scalar::ONE + epsilons(32.0)
}

/// Joins parts that follow one another, and puts what is left in the order of time.
fn join<S: Scalar>(near: &mut Vec<Near<S>>) {
    let key = |near: &Near<S>| (near.item, near.body, near.other);
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
