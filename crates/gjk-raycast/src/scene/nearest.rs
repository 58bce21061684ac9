//! The nearest body.

use core::ops::ControlFlow;

use convex_support::{BoxDistance, Scalar, ScalarOf, SupportMap};
use num_traits::Float;

use super::cast::outer_box_of_question;
use super::result::{BodyDistance, SceneDistance, Work};
use super::{Among, Body, Scene};
use crate::{Distance, DistanceOptions, distance};

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
        let mut work = Work::default();
        let mut look = |index: usize, from: ScalarOf<S>, body: &Body<S>, work: &mut Work| {
            // Of equals the lowest index counts, and this body is as far as its box at least.
            if !(from < nearest.end || index < nearest.best) {
                return ControlFlow::Continue(nearest.end);
            }
            if self.stops(work) {
                return ControlFlow::Break(());
            }
            work.tested += 1;
            // What is certainly farther than the nearest need not be known closely.
            nearest.take(index, from, body.distance_from(shape, options.with_limit(nearest.end)));
            ControlFlow::Continue(nearest.end)
        };
        let zero = ScalarOf::<S>::ZERO;
        let mut end = ControlFlow::Continue(options.limit);
        for (index, body) in self.half_spaces() {
            end = look(index, zero, body, &mut work);
            if end.is_break() {
                break;
            }
        }
        if let ControlFlow::Continue(end) = end {
            let mut end = end;
            work.nodes = self.scene.tree.search(&BoxDistance::new(outer_box_of_question(shape)), end, |index, from| {
                if let Some(body) = self.body(index) {
                    end = look(index, from, body, &mut work)?;
                }
                ControlFlow::Continue(end)
            });
        }
        self.finish(&mut work);
        let lower = if work.cancelled { zero } else { nearest.lower };
        SceneDistance { nearest: nearest.body, lower, work }
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
