//! The nearest pair of bodies, and whether any are within a distance: branch and bound over the boxes, nearest first.
//! [`pairs`](super::pairs) collects all pairs within a distance.

use core::convert::Infallible;
use core::ops::ControlFlow;
#[cfg(feature = "rayon")]
use core::sync::atomic::{AtomicU64, Ordering};

use convex_support::{NearestPairs, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::Scene;
use super::among::Among;
use super::answers::{PairDistance, SceneAnyWithin, ScenePair, Work};
use super::asked::{Asked, asked, asked_pair};
use super::instance::Id;
use super::nearest::distance_of as distance_of_boxes;
use super::pairs::{Limit, Pairing, TestPair, beside_box, distance_of, up_to};
use crate::{Distance, DistanceOptions};

impl<S: SupportMap> Among<'_, S> {
    /// The nearest pair of one of these bodies, `a`, and any of another scene, `b`, if it is within the
    /// [limit](DistanceOptions::limit) of the options: the least [`distance`](crate::distance()) of all pairs.
    /// Half-spaces make no pairs with each other.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{DistanceOptions, Scene};
    ///
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec2::new(x, y));
    /// let ours = Scene::new([ball_at(0.0, 0.0)?, ball_at(0.0, 3.0)?])?;
    /// let theirs = Scene::new([ball_at(9.0, 0.0)?, ball_at(4.0, 3.0)?])?;
    /// let found = ours.all().nearest_between(&theirs, DistanceOptions::new()).nearest.ok_or("all are finite")?;
    /// assert_eq!((found.a, found.b, found.distance.distance), (1, 1, 3.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        options: DistanceOptions<S::Vector>,
    ) -> ScenePair<S::Vector> {
        least(Pairing::between(*self, other), options)
    }

    /// The nearest pair of two of these bodies, the lower index first, if it is within the
    /// [limit](DistanceOptions::limit) of the options: the least [`distance`](crate::distance()) of all pairs.
    /// Neighbours in a mesh touch: leave such pairs out by [`without_pairs`](Self::without_pairs).
    pub fn least_pair(&self, options: DistanceOptions<S::Vector>) -> ScenePair<S::Vector> {
        least(Pairing::within(*self), options)
    }

    /// [`nearest_between`](Self::nearest_between) on all threads of the current [rayon](https://docs.rs/rayon) pool,
    /// with the same answer to the last bit, but for the [`Work`](crate::Work), which depends on the threads.
    #[cfg(feature = "rayon")]
    pub fn par_nearest_between<T: SupportMap<Vector = S::Vector> + Sync>(
        &self,
        other: &Scene<T>,
        options: DistanceOptions<S::Vector>,
    ) -> ScenePair<S::Vector>
    where
        S: Sync,
    {
        par_least(Pairing::between(*self, other), options)
    }

    /// [`least_pair`](Self::least_pair) on all threads of the current [rayon](https://docs.rs/rayon) pool, with the
    /// same answer to the last bit, but for the [`Work`](crate::Work), which depends on the threads.
    #[cfg(feature = "rayon")]
    pub fn par_least_pair(&self, options: DistanceOptions<S::Vector>) -> ScenePair<S::Vector>
    where
        S: Sync,
    {
        par_least(Pairing::within(*self), options)
    }

    /// Whether any body is no farther than `within` from the shape by [`distance`](crate::distance()): whether
    /// [`all_within`](Self::all_within) would find one. The search stops at the first that certainly is.
    pub fn any_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<usize> {
        let mut any = Any::none(within, options);
        let Ok(work) = self.in_order(&distance_of_boxes(shape), within, |id, from, body| {
            let distance = asked!(body, body => body.distance_from(shape, any.options));
            Ok::<_, Infallible>(any.add(id.body, from, &distance).map_continue(|()| (within, Id::LAST)))
        });
        any.answer(work)
    }

    /// Whether any two of these bodies are no farther than `within` from each other: whether
    /// [`pairs_within`](Self::pairs_within) would find a pair. The search stops at the first that certainly is one.
    pub fn any_pair_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<[usize; 2]> {
        any(Pairing::within(*self), within, options)
    }

    /// Whether any of these bodies is no farther than `within` from any of another scene: whether
    /// [`pairs_between`](Self::pairs_between) would find a pair. The search stops at the first that certainly is one.
    pub fn any_pair_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<[usize; 2]> {
        any(Pairing::between(*self, other), within, options)
    }
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> Pairing<'_, S, T> {
    /// Tests the pairs whose bound may be below the limit, those with half-spaces first.
    fn all_in_order(&mut self, mut boxes: NearestPairs<'_, S::Vector>, question: &mut impl TestPair<S, T>) {
        if self.half_spaces_in_order(question).is_continue() {
            // The search is over, so a break no longer matters.
            let _ = self.in_order(&mut boxes, usize::MAX, question);
        }
        self.work.nodes += boxes.nodes();
    }

    /// Tests pairs of bounded bodies whose bound may be below the limit, mostly in the order of their bounds, and not
    /// more than `most`. The nodes are those of `boxes`.
    fn in_order(
        &mut self,
        boxes: &mut NearestPairs<'_, S::Vector>,
        most: usize,
        question: &mut impl TestPair<S, T>,
    ) -> ControlFlow<()> {
        for _ in 0..most {
            let Some((pair, from)) = boxes.next(question.limit().0) else { break };
            self.ask(pair, from, &beside_box, question)?;
        }
        ControlFlow::Continue(())
    }

    /// Tests the pairs with half-spaces in the same way.
    fn half_spaces_in_order(&mut self, question: &mut impl TestPair<S, T>) -> ControlFlow<()> {
        let mut ended = ControlFlow::Continue(());
        for of in self.half_spaces() {
            let nodes = of.others.search(&of.height, question.limit().0, |other, from| {
                ended = self.ask(of.pair(other), from, &|_| of.height, question);
                ended.map_continue(|()| question.limit().0)
            });
            self.work.nodes += nodes;
            ended?;
        }
        ended
    }
}

/// The nearest pair of those that were tested so far. As for [bodies](Among::nearest), a pair counts from its distance
/// or from that of its boxes, whichever is farther.
#[derive(Clone, Copy)]
struct Nearest<V: Vector> {
    pair: Option<PairDistance<V>>,
    limit: Limit<V::Scalar>,
    lower: V::Scalar,
    options: DistanceOptions<V>,
}

impl<V: Vector> Nearest<V> {
    fn none(options: DistanceOptions<V>) -> Self {
        // NaN is no limit.
        let end = Float::min(options.limit, Float::infinity());
        Self { pair: None, limit: up_to(end), lower: end, options }
    }

    fn answer(self, work: Work) -> ScenePair<V> {
        ScenePair { nearest: self.pair, lower: if work.cancelled { Scalar::ZERO } else { self.lower }, work }
    }
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> TestPair<S, T> for Nearest<S::Vector> {
    fn limit(&self) -> Limit<ScalarOf<S>> {
        self.limit
    }

    fn test(&mut self, pair: [Id; 2], from: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()> {
        let options = self.options.with_limit(self.limit.0);
        if let Some(distance) = asked_pair!(a, b => distance_of(a, b, options)) {
            self.lower = Float::min(self.lower, Float::max(distance.lower, from));
            let key = (Float::max(distance.distance, from), pair);
            if key < self.limit {
                (self.pair, self.limit) = (Some(PairDistance::of(pair, distance)), key);
            }
        }
        ControlFlow::Continue(())
    }
}

/// The nearest pair, by one thread.
fn least<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    mut pairing: Pairing<'_, S, T>,
    options: DistanceOptions<S::Vector>,
) -> ScenePair<S::Vector> {
    let mut nearest = Nearest::none(options);
    pairing.all_in_order(pairing.nearest_boxes(), &mut nearest);
    nearest.answer(pairing.finish())
}

/// The nearest pair, by all threads. They share the least distance found so far, which changes what is tested, but
/// neither the nearest pair, nor the least lower bound: what is left out by it is farther than the nearest pair.
#[cfg(feature = "rayon")]
fn par_least<S: SupportMap + Sync, T: SupportMap<Vector = S::Vector> + Sync>(
    mut pairing: Pairing<'_, S, T>,
    options: DistanceOptions<S::Vector>,
) -> ScenePair<S::Vector> {
    use rayon::prelude::*;
    /// Enough that idle threads find another part, and few enough that each begins with pairs that are near.
    const PARTS: usize = 64;
    /// What one thread tests before: then the limit is mostly near the end already.
    const BEFORE: usize = 64;
    let (mut nearest, mut boxes) = (Nearest::none(options), pairing.nearest_boxes());
    let of_half_spaces = pairing.half_spaces_in_order(&mut nearest);
    if of_half_spaces.is_break() || pairing.in_order(&mut boxes, BEFORE, &mut nearest).is_break() {
        pairing.work.nodes += boxes.nodes();
        return nearest.answer(pairing.finish());
    }
    // Numbers that are not negative are in the order of their bits.
    let shared = AtomicU64::new(nearest.limit.0.as_f64().to_bits());
    let before = Pairing { work: Work::default(), ..pairing };
    let parts: alloc::vec::Vec<_> = boxes
        .deal(PARTS)
        .into_par_iter()
        .map(|mut part| {
            let mut pairing = before;
            let mut question = OnThread { nearest: Nearest { pair: None, ..nearest }, shared: &shared };
            let _ = pairing.in_order(&mut part, usize::MAX, &mut question);
            pairing.work.nodes += part.nodes();
            (question.nearest, pairing.work)
        })
        .collect();
    for (part, work) in parts {
        pairing.count(work);
        nearest.lower = Float::min(nearest.lower, part.lower);
        if part.pair.is_some() && part.limit < nearest.limit {
            (nearest.pair, nearest.limit) = (part.pair, part.limit);
        }
    }
    nearest.answer(pairing.finish())
}

/// The nearest pair that one thread finds, and the least distance that any has found.
#[cfg(feature = "rayon")]
struct OnThread<'s, V: Vector> {
    nearest: Nearest<V>,
    /// The bits of the distance.
    shared: &'s AtomicU64,
}

#[cfg(feature = "rayon")]
impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> TestPair<S, T> for OnThread<'_, S::Vector> {
    fn limit(&self) -> Limit<ScalarOf<S>> {
        self.nearest.limit
    }

    fn test(&mut self, pair: [Id; 2], from: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()> {
        let of_all = up_to(ScalarOf::<S>::from_f64(f64::from_bits(self.shared.load(Ordering::Relaxed))));
        if of_all < self.nearest.limit {
            self.nearest = Nearest { pair: None, limit: of_all, ..self.nearest };
        }
        self.nearest.test(pair, from, a, b)?;
        self.shared.fetch_min(self.nearest.limit.0.as_f64().to_bits(), Ordering::Relaxed);
        ControlFlow::Continue(())
    }
}

/// Whether anything was within the limit of the options so far.
struct Any<I, V: Vector> {
    any: bool,
    undecided: Option<I>,
    options: DistanceOptions<V>,
}

impl<I: Ord + Copy, V: Vector> Any<I, V> {
    fn none(within: V::Scalar, options: DistanceOptions<V>) -> Self {
        Self { any: false, undecided: None, options: options.with_limit(within) }
    }

    /// Breaks off at the first that certainly is within.
    fn add(&mut self, index: I, from: V::Scalar, distance: &Distance<V>) -> ControlFlow<()> {
        let within = self.options.limit;
        self.any |= distance.distance <= within;
        if distance.upper <= within {
            self.undecided = None;
            return ControlFlow::Break(());
        }
        if Float::max(distance.lower, from) <= within {
            self.undecided = Some(self.undecided.unwrap_or(index).min(index));
        }
        ControlFlow::Continue(())
    }

    fn answer(self, work: Work) -> SceneAnyWithin<I> {
        SceneAnyWithin { any: self.any, undecided: self.undecided, work }
    }
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> TestPair<S, T> for Any<[usize; 2], S::Vector> {
    fn limit(&self) -> Limit<ScalarOf<S>> {
        up_to(self.options.limit)
    }

    fn test(&mut self, pair: [Id; 2], from: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()> {
        match asked_pair!(a, b => distance_of(a, b, self.options)) {
            Some(distance) => self.add(pair.map(|id| id.body), from, &distance),
            None => ControlFlow::Continue(()),
        }
    }
}

/// Whether any pair is within a distance.
fn any<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    mut pairing: Pairing<'_, S, T>,
    within: ScalarOf<S>,
    options: DistanceOptions<S::Vector>,
) -> SceneAnyWithin<[usize; 2]> {
    let mut any = Any::none(within, options);
    pairing.all_in_order(pairing.nearest_boxes().depth_first(), &mut any);
    any.answer(pairing.finish())
}
