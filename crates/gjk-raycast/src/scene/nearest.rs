//! The nearest body.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{BoxDistance, Scalar, ScalarOf, SupportMap};
use num_traits::Float;

use super::cast::outer_box_of_question;
use super::result::{BodyDistance, BodySignedDistance, SceneDistance, SceneSignedDistance, Work, reuse};
use super::{Among, Body, Scene};
use crate::{Distance, DistanceOptions, SignedDistanceOptions, distance};

impl<S: SupportMap> Scene<S> {
    /// The body nearest to the shape, if it is within the [limit](DistanceOptions::limit) of the options: the least of
    /// [`distance`](crate::distance()) from the shape, `a`, to each body, `b`.
    pub fn nearest<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> SceneDistance<S::Vector> {
        self.all().nearest(shape, options)
    }

    /// The `count` bodies nearest to the shape, or as many as are within the [limit](DistanceOptions::limit), in the
    /// order of their distances and then of their indices, into `bodies`, which is emptied first.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{DistanceOptions, Scene};
    ///
    /// let ball_at = |x| Posed::translated(Ball::new(0.5)?, DVec2::new(x, 0.0));
    /// let scene = Scene::new([ball_at(9.0)?, ball_at(3.0)?, ball_at(-5.0)?])?;
    /// let mut bodies = Vec::new();
    /// scene.nearest_k(&Ball::new(0.5)?, 2, DistanceOptions::new(), &mut bodies);
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
        self.all().nearest_k(shape, count, options, bodies)
    }

    /// The body whose [`signed_distance`](crate::signed_distance()) from the shape, `a`, is least: the one that the
    /// shape is deepest in, or the nearest if it is in none; and the lowest index of equals.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{Scene, SignedDistanceOptions};
    ///
    /// // A planner whose start is in contact: how deep is it, and which way out?
    /// let ball_at = |x| Posed::translated(Ball::new(1.0)?, DVec2::new(x, 0.0));
    /// let scene = Scene::new([ball_at(1.75)?, ball_at(-1.5)?, ball_at(9.0)?])?;
    /// let found = scene.least_signed_distance(&Ball::new(1.0)?, SignedDistanceOptions::new());
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
        self.all().least_signed_distance(shape, options)
    }
}

impl<S: SupportMap> Body<S> {
    /// The distance from a shape to this body.
    #[inline]
    pub(super) fn distance_from<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> Distance<S::Vector> {
        match self {
            Self::Convex(body) => distance(shape, body, options),
            Self::HalfSpace(half_space) => half_space.distance_from(shape),
        }
    }
}

impl<S: SupportMap> Among<'_, S> {
    /// [`Scene::nearest`] among these bodies.
    pub fn nearest<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> SceneDistance<S::Vector> {
        let mut nearest = NearestBody { body: None, end: options.limit, best: usize::MAX, lower: options.limit };
        // What is certainly farther than the nearest need not be known closely; and a body is as far as its box at least.
        let around = BoxDistance::new(outer_box_of_question(shape));
        let work = self.in_order(&around, options.limit, |index, from, body| {
            nearest.take(index, from, body.distance_from(shape, options.with_limit(nearest.end)));
            ControlFlow::Continue((nearest.end, nearest.best))
        });
        let lower = if work.cancelled { Scalar::ZERO } else { nearest.lower };
        SceneDistance { nearest: nearest.body, lower, work }
    }

    /// [`Scene::nearest_k`] among these bodies.
    pub fn nearest_k<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        count: usize,
        options: DistanceOptions<S::Vector>,
        bodies: &mut Vec<BodyDistance<S::Vector>>,
    ) -> Work {
        let bodies = reuse(bodies);
        // What each of them counts from, as in `NearestBody`.
        let (mut keys, mut limit) = (Vec::new(), (options.limit, usize::MAX));
        self.in_order(&BoxDistance::new(outer_box_of_question(shape)), options.limit, |index, from, body| {
            let distance = body.distance_from(shape, options.with_limit(limit.0));
            let key = (Float::max(distance.distance, from), index);
            if key < limit {
                let place = keys.partition_point(|other| *other < key);
                keys.insert(place, key);
                bodies.insert(place, BodyDistance { body: index, distance });
                keys.truncate(count);
                bodies.truncate(count);
                limit = if keys.len() < count { limit } else { keys.last().copied().unwrap_or(limit) };
            }
            ControlFlow::Continue(limit)
        })
    }

    /// [`Scene::least_signed_distance`] among these bodies.
    pub fn least_signed_distance<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: SignedDistanceOptions<S::Vector>,
    ) -> SceneSignedDistance<S::Vector> {
        let zero = ScalarOf::<S>::ZERO;
        // NaN is no limit.
        let end = Float::min(options.limit, Float::infinity());
        let (mut least, mut key, mut lower) = (None, (end, usize::MAX), end);
        let work = self.in_order(&BoxDistance::new(outer_box_of_question(shape)), end, |index, from, body| {
            let distance = body.signed_distance(shape, options.with_limit(Float::max(key.0, zero)));
            // Bodies are as far apart as their boxes at least; of those whose boxes meet, nothing is known before.
            let at_least = |value| if from > zero { Float::max(value, from) } else { value };
            lower = Float::min(lower, at_least(distance.lower));
            let next = (at_least(distance.signed_distance), index);
            if next < key {
                (least, key) = (Some(BodySignedDistance { body: index, distance }), next);
            }
            ControlFlow::Continue(if key.0 > zero { key } else { (zero, usize::MAX) })
        });
        let lower = if work.cancelled { Float::min_value() } else { lower };
        SceneSignedDistance { least, lower, work }
    }
}

/// The nearest body so far. As for casts, a body counts from its distance or from where its box begins, whichever is
/// farther.
struct NearestBody<V: convex_support::Vector> {
    body: Option<BodyDistance<V>>,
    /// What it counts from, or the limit.
    end: V::Scalar,
    /// Its index.
    best: usize,
    lower: V::Scalar,
}

impl<V: convex_support::Vector> NearestBody<V> {
    fn take(&mut self, body: usize, from: V::Scalar, distance: Distance<V>) {
        self.lower = Float::min(self.lower, Float::max(distance.lower, from));
        let key = Float::max(distance.distance, from);
        // The limit itself is within it.
        if key < self.end || (key == self.end && body < self.best) {
            (self.body, self.end, self.best) = (Some(BodyDistance { body, distance }), key, body);
        }
    }
}
