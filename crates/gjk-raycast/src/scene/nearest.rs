//! Which body is nearest to a shape, and which are near? Those whose boxes are near enough are asked one by one,
//! nearest boxes first. For pairs of bodies see [`nearest_pair`](super::nearest_pair) and [`pairs`](super::pairs).

use alloc::vec::Vec;
use core::convert::Infallible;
use core::ops::ControlFlow;

use convex_support::{Aabb, BoxDistance, Scalar, ScalarOf, SupportMap};
use num_traits::Float;

use super::among::Among;
use super::answers::{BodyDistance, BodySignedDistance, SceneDistance, SceneSignedDistance, Work, reuse};
use super::asked::{Asked, asked};
use super::instance::Id;
use crate::{DistanceOptions, SignedDistanceOptions};

impl<S: SupportMap> Among<'_, S> {
    /// The body nearest to the shape, if it is within the [limit](DistanceOptions::limit) of the options: the least
    /// [`distance`](crate::distance()) from the shape, `a`, to each body, `b`.
    pub fn nearest<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> SceneDistance<S::Vector> {
        // A body that is certainly farther than the nearest needs no close bounds. A body is at least as far as its
        // box, so that, as for casts, it counts from its distance or from where its box begins, whichever is farther.
        let (mut nearest, mut limit, mut lower) = (None, (options.limit, Id::LAST), options.limit);
        let Ok(work) = self.in_order(&distance_of(shape), options.limit, |id, from, body| {
            let distance = asked!(body, body => body.distance_from(shape, options.with_limit(limit.0)));
            lower = Float::min(lower, Float::max(distance.lower, from));
            let key = (Float::max(distance.distance, from), id);
            if key < limit {
                (nearest, limit) = (Some(BodyDistance { body: id.body, member: id.member, distance }), key);
            }
            Ok::<_, Infallible>(ControlFlow::Continue(limit))
        });
        let lower = if work.cancelled { Scalar::ZERO } else { lower };
        SceneDistance { nearest, lower, work }
    }

    /// Finds the `count` bodies nearest to the shape, or as many as are within the [limit](DistanceOptions::limit).
    /// Writes them into `bodies`, which is emptied first, in the order of their distances and then of their indices.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{DistanceOptions, Scene};
    ///
    /// let ball_at = |x| Posed::translated(Ball::new(0.5)?, DVec2::new(x, 0.0));
    /// let scene = Scene::new([ball_at(9.0)?, ball_at(3.0)?, ball_at(-5.0)?])?;
    /// let mut bodies = Vec::new();
    /// scene.all().nearest_k(&Ball::new(0.5)?, 2, DistanceOptions::new(), &mut bodies);
    /// let found: Vec<_> = bodies.iter().map(|near| (near.body, near.distance.distance)).collect();
    /// assert_eq!(found, [(1, 2.0), (2, 4.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest_k<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        count: usize,
        options: DistanceOptions<S::Vector>,
        bodies: &mut Vec<BodyDistance<S::Vector>>,
    ) -> Work {
        let bodies = reuse(bodies);
        // The keys of the bodies found.
        let (mut keys, mut limit) = (Vec::new(), (options.limit, Id::LAST));
        let Ok(work) = self.in_order(&distance_of(shape), options.limit, |id, from, body| {
            let distance = asked!(body, body => body.distance_from(shape, options.with_limit(limit.0)));
            let key = (Float::max(distance.distance, from), id);
            if key < limit {
                let place = keys.partition_point(|other| *other < key);
                keys.insert(place, key);
                bodies.insert(place, BodyDistance { body: id.body, member: id.member, distance });
                keys.truncate(count);
                bodies.truncate(count);
                limit = if keys.len() < count { limit } else { keys.last().copied().unwrap_or(limit) };
            }
            Ok::<_, Infallible>(ControlFlow::Continue(limit))
        });
        work
    }

    /// The body with the least [`signed_distance`](crate::signed_distance()) from the shape, `a`: the one that the
    /// shape is deepest in, or the nearest if it is in none; and the lowest index of equals.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{Scene, SignedDistanceOptions};
    ///
    /// // A planner whose start is in contact: how deep is it, and which way out?
    /// let ball_at = |x| Posed::translated(Ball::new(1.0)?, DVec2::new(x, 0.0));
    /// let scene = Scene::new([ball_at(1.75)?, ball_at(-1.5)?, ball_at(9.0)?])?;
    /// let found = scene.all().least_signed_distance(&Ball::new(1.0)?, SignedDistanceOptions::new());
    /// let least = found.least.ok_or("there are bodies")?;
    /// assert_eq!((least.body, least.distance.normal), (1, DVec2::X));
    /// assert!((least.distance.signed_distance + 0.5).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn least_signed_distance<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: SignedDistanceOptions<S::Vector>,
    ) -> SceneSignedDistance<S::Vector> {
        let zero = ScalarOf::<S>::ZERO;
        // NaN is no limit.
        let end = Float::min(options.limit, Float::infinity());
        let (mut least, mut key, mut lower) = (None, (end, Id::LAST), end);
        let Ok(work) = self.in_order(&distance_of(shape), end, |id, from, body| {
            let options = options.with_limit(Float::max(key.0, zero));
            let distance = asked!(body, body => body.signed_distance(shape, options));
            // Bodies are at least as far apart as their boxes; boxes that meet give no bound.
            let at_least = |value| if from > zero { Float::max(value, from) } else { value };
            lower = Float::min(lower, at_least(distance.lower));
            let next = (at_least(distance.signed_distance), id);
            if next < key {
                (least, key) = (Some(BodySignedDistance { body: id.body, member: id.member, distance }), next);
            }
            Ok::<_, Infallible>(ControlFlow::Continue(if key.0 > zero { key } else { (zero, Id::LAST) }))
        });
        let lower = if work.cancelled { Float::min_value() } else { lower };
        SceneSignedDistance { least, lower, work }
    }

    /// Finds all bodies that are no farther than `within` from the shape by [`distance`](crate::distance()). Writes
    /// them into `bodies`, which is emptied first, in the order of their indices.
    pub fn all_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        bodies: &mut Vec<BodyDistance<S::Vector>>,
    ) -> Work {
        let options = options.with_limit(within);
        let work = self.near(shape, within, reuse(bodies), |id, body| {
            let distance = asked!(body, body => body.distance_from(shape, options));
            (distance.distance <= within).then_some(BodyDistance { body: id.body, member: id.member, distance })
        });
        bodies.sort_unstable_by_key(|found| (found.body, found.member));
        work
    }

    /// Collects the results of `tell`, in no order, for the bodies whose boxes are no farther than `within` from that
    /// of the shape.
    pub(super) fn near<A: SupportMap<Vector = S::Vector> + ?Sized, R>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        found: &mut Vec<R>,
        tell: impl Fn(Id, Asked<'_, '_, S>) -> Option<R>,
    ) -> Work {
        let (mut work, mut nodes, question) = (Work::default(), 0, distance_of(shape));
        let mut look = |index: usize| {
            let mut ask = |id: Id, _, body: Asked<'_, '_, S>| {
                if self.stops(&mut work) {
                    return ControlFlow::Break(());
                }
                work.tested += 1;
                found.extend(tell(id, body));
                ControlFlow::Continue(within)
            };
            let Some(slot) = self.slot(index) else { return ControlFlow::Continue(()) };
            let next = slot.each_member((index, Scalar::ZERO), &question, within, &mut nodes, &mut ask);
            next.map_continue(|_| ())
        };
        if self.scene.half_spaces.iter().try_for_each(|&index| look(index)).is_continue() {
            work.nodes = self.scene.tree.within(&question, within, look);
        }
        work.nodes += nodes;
        self.finish(&mut work);
        work
    }
}

/// How far boxes are from that of a shape's core, swept by its ball; nowhere, of a shape of which a number is not
/// finite.
pub(super) fn distance_of<A: SupportMap + ?Sized>(shape: &A) -> BoxDistance<A::Vector> {
    BoxDistance::of_shape(shape).unwrap_or_else(|| BoxDistance::new(Aabb::everything()))
}
