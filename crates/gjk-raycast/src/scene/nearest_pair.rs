//! The nearest pair of bodies, and whether any are within a distance: branch and bound over the boxes, nearest first.
//! [`pairs`](super::pairs) collects all pairs within a distance.

use core::convert::Infallible;
use core::ops::ControlFlow;

use convex_support::{NearestPairs, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::Scene;
use super::among::Among;
#[cfg(feature = "rayon")]
use super::answers::Work;
use super::answers::{PairDistance, SceneAnyWithin, ScenePair};
use super::asked::{Asked, asked, asked_pair};
use super::bounds::HeightBound;
use super::instance::Id;
use super::nearest::distance_of as distance_of_boxes;
use super::pairs::{Pairing, TestPair, beside_box, distance_of};
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
        least(Pairing::between(*self, other), self.scene.tree.nearest_pairs(&other.tree), options)
    }

    /// The nearest pair of two of these bodies, the lower index first, if it is within the
    /// [limit](DistanceOptions::limit) of the options: the least [`distance`](crate::distance()) of all pairs. Neighbours
    /// in a mesh touch: leave such pairs out by [`without_pairs`](Self::without_pairs).
    pub fn least_pair(&self, options: DistanceOptions<S::Vector>) -> ScenePair<S::Vector> {
        least(Pairing::within(*self), self.scene.tree.nearest_pairs_within(), options)
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
        par_least(Pairing::between(*self, other), self.scene.tree.nearest_pairs(&other.tree), options)
    }

    /// [`least_pair`](Self::least_pair) on all threads of the current [rayon](https://docs.rs/rayon) pool, with the
    /// same answer to the last bit, but for the [`Work`](crate::Work), which depends on the threads.
    #[cfg(feature = "rayon")]
    pub fn par_least_pair(&self, options: DistanceOptions<S::Vector>) -> ScenePair<S::Vector>
    where
        S: Sync,
    {
        par_least(Pairing::within(*self), self.scene.tree.nearest_pairs_within(), options)
    }

    /// Whether any body is no farther than `within` from the shape by [`distance`](crate::distance()): whether
    /// [`all_within`](Self::all_within) would find one. The search stops at the first that certainly is.
    pub fn any_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<usize> {
        let mut any = Any { within, any: false, undecided: None };
        let Ok(work) = self.in_order(&distance_of_boxes(shape), within, |id, from, body| {
            let distance = asked!(body, body => body.distance_from(shape, options.with_limit(within)));
            Ok::<_, Infallible>(any.add(id.body, from, &distance).map_continue(|()| (within, Id::LAST)))
        });
        SceneAnyWithin { any: any.any, undecided: any.undecided, work }
    }

    /// Whether any two of these bodies are no farther than `within` from each other: whether
    /// [`pairs_within`](Self::pairs_within) would find a pair. The search stops at the first that certainly is one.
    pub fn any_pair_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<[usize; 2]> {
        any(Pairing::within(*self), self.scene.tree.nearest_pairs_within(), within, options)
    }

    /// Whether any of these bodies is no farther than `within` from any of another scene: whether
    /// [`pairs_between`](Self::pairs_between) would find a pair. The search stops at the first that certainly is one.
    pub fn any_pair_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
    ) -> SceneAnyWithin<[usize; 2]> {
        any(Pairing::between(*self, other), self.scene.tree.nearest_pairs(&other.tree), within, options)
    }
}

/// A value from which on no pair counts: that of a pair, whose indices decide among equals.
type Limit<N> = (N, [Id; 2]);

/// The limit `end` itself is within it.
fn up_to<N>(end: N) -> Limit<N> {
    (end, [Id::LAST; 2])
}

/// A question about the pairs whose bound may be below a limit. `ask` takes the bound and the pair, and returns the next
/// limit, or a break, which ends the search.
struct Limited<N, F> {
    limit: Limit<N>,
    ask: F,
}

impl<S, T, F> TestPair<S, T> for Limited<ScalarOf<S>, F>
where
    S: SupportMap,
    T: SupportMap<Vector = S::Vector>,
    F: FnMut(ScalarOf<S>, AskedPair<'_, '_, '_, '_, S, T>) -> ControlFlow<(), Limit<ScalarOf<S>>>,
{
    fn limit(&self) -> ScalarOf<S> {
        self.limit.0
    }

    fn is_late(&self, pair: [Id; 2], from: ScalarOf<S>) -> bool {
        from >= self.limit.0 && pair >= self.limit.1
    }

    fn test(&mut self, pair: [Id; 2], from: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()> {
        self.limit = (self.ask)(from, (pair, a, b))?;
        ControlFlow::Continue(())
    }
}

/// The bodies of a pair, or their members.
type AskedPair<'a, 'm, 'b, 'n, S, T> = ([Id; 2], Asked<'a, 'm, S>, Asked<'b, 'n, T>);

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> Pairing<'_, S, T> {
    /// Tests the pairs of bounded bodies whose bound may be below the limit, mostly in the order of their bounds.
    fn in_order(
        &mut self,
        mut boxes: NearestPairs<'_, S::Vector>,
        question: &mut impl TestPair<S, T>,
    ) -> ControlFlow<()> {
        let mut ended = ControlFlow::Continue(());
        while ended.is_continue()
            && let Some((pair, from)) = boxes.next(question.limit())
        {
            ended = self.ask(pair, from, &beside_box, question);
        }
        self.work.nodes += boxes.nodes();
        ended
    }

    /// Tests the pairs with half-spaces in the same way.
    fn half_spaces_in_order(&mut self, question: &mut impl TestPair<S, T>) -> ControlFlow<()> {
        let (Self { a, b, same, .. }, mut ended) = (*self, ControlFlow::Continue(()));
        for (index, half_space) in a.half_spaces() {
            let height = HeightBound::new(half_space);
            let nodes = b.scene.tree.search(&height, question.limit(), |other, from| {
                ended = self.ask([index, other], from, &|_| height, question);
                ended.map_continue(|()| question.limit())
            });
            self.work.nodes += nodes;
            ended?;
        }
        for (index, half_space) in b.half_spaces().filter(|_| !same) {
            let height = HeightBound::new(half_space);
            let nodes = a.scene.tree.search(&height, question.limit(), |other, from| {
                ended = self.ask([other, index], from, &|_| height, question);
                ended.map_continue(|()| question.limit())
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
struct Least<V: Vector> {
    nearest: Option<PairDistance<V>>,
    limit: Limit<V::Scalar>,
    lower: V::Scalar,
}

impl<V: Vector> Least<V> {
    fn add<S: SupportMap<Vector = V>, T: SupportMap<Vector = V>>(
        &mut self,
        from: V::Scalar,
        (pair, a, b): AskedPair<'_, '_, '_, '_, S, T>,
        options: DistanceOptions<V>,
    ) -> Limit<V::Scalar> {
        let options = options.with_limit(self.limit.0);
        if let Some(distance) = asked_pair!(a, b => distance_of(a, b, options)) {
            self.lower = Float::min(self.lower, Float::max(distance.lower, from));
            let key = (Float::max(distance.distance, from), pair);
            if key < self.limit {
                (self.nearest, self.limit) = (Some(PairDistance::of(pair, distance)), key);
            }
        }
        self.limit
    }
}

/// The nearest pair, by one thread.
fn least<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    mut pairing: Pairing<'_, S, T>,
    boxes: NearestPairs<'_, S::Vector>,
    options: DistanceOptions<S::Vector>,
) -> ScenePair<S::Vector> {
    let mut found = nothing(options);
    let ask = |from, pair: AskedPair<'_, '_, '_, '_, S, T>| ControlFlow::Continue(found.add(from, pair, options));
    let mut question = Limited { limit: up_to(no_limit_if_nan(options.limit)), ask };
    if pairing.half_spaces_in_order(&mut question).is_continue() {
        // The search is over, so a break no longer matters.
        let _ = pairing.in_order(boxes, &mut question);
    }
    answer(found, pairing)
}

/// NaN is no limit.
fn no_limit_if_nan<N: Scalar>(limit: N) -> N {
    Float::min(limit, N::infinity())
}

fn nothing<V: Vector>(options: DistanceOptions<V>) -> Least<V> {
    let end = no_limit_if_nan(options.limit);
    Least { nearest: None, limit: up_to(end), lower: end }
}

fn answer<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    Least { nearest, lower, .. }: Least<S::Vector>,
    pairing: Pairing<'_, S, T>,
) -> ScenePair<S::Vector> {
    let work = pairing.finish();
    ScenePair { nearest, lower: if work.cancelled { Scalar::ZERO } else { lower }, work }
}

/// The nearest pair, by all threads. They share the least distance found so far, which changes what is tested, but
/// neither the nearest pair, nor the least lower bound: what is left out by it is farther than the nearest pair.
#[cfg(feature = "rayon")]
fn par_least<S: SupportMap + Sync, T: SupportMap<Vector = S::Vector> + Sync>(
    mut pairing: Pairing<'_, S, T>,
    mut boxes: NearestPairs<'_, S::Vector>,
    options: DistanceOptions<S::Vector>,
) -> ScenePair<S::Vector> {
    use core::sync::atomic::{AtomicU64, Ordering};
    use rayon::prelude::*;
    /// Enough that idle threads find another part, and few enough that each begins with pairs that are near.
    const PARTS: usize = 64;
    /// What one thread tests before: then the limit is mostly near the end already.
    const BEFORE: usize = 64;
    let mut found = nothing(options);
    let limit = found.limit;
    let ask = |from, pair: AskedPair<'_, '_, '_, '_, S, T>| ControlFlow::Continue(found.add(from, pair, options));
    let mut question = Limited { limit, ask };
    let mut ended = pairing.half_spaces_in_order(&mut question);
    let mut left = BEFORE;
    while ended.is_continue()
        && left > 0
        && let Some((pair, from)) = boxes.next(question.limit.0)
    {
        (left, ended) = (left - 1, pairing.ask(pair, from, &beside_box, &mut question));
    }
    let limit = question.limit;
    if ended.is_break() {
        pairing.work.nodes += boxes.nodes();
        return answer(found, pairing);
    }
    // Numbers that are not negative are in the order of their bits.
    let shared = AtomicU64::new(limit.0.as_f64().to_bits());
    let before = Pairing { work: Work::default(), ..pairing };
    let parts: alloc::vec::Vec<_> = boxes
        .deal(PARTS)
        .into_par_iter()
        .map(|part| {
            let (mut pairing, mut found) = (before, Least { nearest: None, ..found });
            let ask = |from, pair: AskedPair<'_, '_, '_, '_, S, T>| {
                let of_all = up_to(ScalarOf::<S>::from_f64(f64::from_bits(shared.load(Ordering::Relaxed))));
                if of_all < found.limit {
                    found = Least { nearest: None, limit: of_all, ..found };
                }
                let limit = found.add(from, pair, options);
                shared.fetch_min(limit.0.as_f64().to_bits(), Ordering::Relaxed);
                ControlFlow::Continue(limit)
            };
            let _ = pairing.in_order(part, &mut Limited { limit, ask });
            (found, pairing.work)
        })
        .collect();
    for (part, work) in parts {
        pairing.count(work);
        found.lower = Float::min(found.lower, part.lower);
        if part.nearest.is_some() && part.limit < found.limit {
            (found.nearest, found.limit) = (part.nearest, part.limit);
        }
    }
    answer(found, pairing)
}

/// Whether anything was within a distance so far.
struct Any<I, N> {
    within: N,
    any: bool,
    undecided: Option<I>,
}

impl<I: Ord + Copy, N: Scalar> Any<I, N> {
    /// Breaks off at the first that certainly is within.
    fn add<V: Vector<Scalar = N>>(&mut self, index: I, from: N, distance: &Distance<V>) -> ControlFlow<()> {
        self.any |= distance.distance <= self.within;
        if distance.upper <= self.within {
            self.undecided = None;
            return ControlFlow::Break(());
        }
        if Float::max(distance.lower, from) <= self.within {
            self.undecided = Some(self.undecided.unwrap_or(index).min(index));
        }
        ControlFlow::Continue(())
    }
}

/// Whether any pair is within a distance.
fn any<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    mut pairing: Pairing<'_, S, T>,
    boxes: NearestPairs<'_, S::Vector>,
    within: ScalarOf<S>,
    options: DistanceOptions<S::Vector>,
) -> SceneAnyWithin<[usize; 2]> {
    let (mut any, options) = (Any { within, any: false, undecided: None }, options.with_limit(within));
    let ask = |from, (pair, a, b): AskedPair<'_, '_, '_, '_, S, T>| match asked_pair!(a, b => distance_of(a, b, options))
    {
        Some(distance) => any.add(pair.map(|id| id.body), from, &distance).map_continue(|()| up_to(within)),
        None => ControlFlow::Continue(up_to(within)),
    };
    let mut question = Limited { limit: up_to(within), ask };
    if pairing.half_spaces_in_order(&mut question).is_continue() {
        let _ = pairing.in_order(boxes, &mut question);
    }
    SceneAnyWithin { any: any.any, undecided: any.undecided, work: pairing.finish() }
}
