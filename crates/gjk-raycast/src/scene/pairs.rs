//! Pairs of bodies that are near each other.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{PairSearch, ScalarOf, SupportMap, Vector};

use super::among::Among;
use super::answers::{PairContact, PairDistance, Work, reuse};
use super::bounds::HeightBound;
use super::{Body, Scene};
use crate::{Distance, DistanceOptions, distance};

impl<S: SupportMap> Among<'_, S> {
    /// Finds all pairs of bodies that are no farther than `within` from each other by [`distance`](crate::distance()).
    /// Writes them into `pairs`, which is emptied first, in the order of their indices. Half-spaces make no pairs with
    /// each other.
    pub fn pairs_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        self.find_pairs(within, pairs, &|pair, a, b| between(pair, a, b, options.with_limit(within)))
    }

    /// Finds all pairs of one of these bodies, `a`, and any of another scene, `b`, that are no farther than `within`
    /// from each other.
    pub fn pairs_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        self.find_pairs_between(other, within, pairs, &|pair, a, b| between(pair, a, b, options.with_limit(within)))
    }

    /// [`pairs_within`](Self::pairs_within) on all threads of the current [rayon](https://docs.rs/rayon) pool, with the
    /// same pairs to the last bit. The nodes of the [`Work`] are those of the pieces that the search is cut into.
    #[cfg(feature = "rayon")]
    pub fn par_pairs_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work
    where
        S: Sync,
    {
        self.par_find_pairs(within, pairs, &|pair, a, b| between(pair, a, b, options.with_limit(within)))
    }

    /// Collects the results of `tell` for the pairs of these bodies whose boxes are no farther than `within` from each
    /// other.
    pub(super) fn find_pairs<P: OfPair>(
        &self,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &impl Fn([usize; 2], &Body<S>, &Body<S>) -> Option<P>,
    ) -> Work {
        let mut asking = Asking { pairing: Pairing::within(*self), within, tell, pairs: reuse(pairs) };
        asking.search(self.scene.tree.pairs_within(within));
        asking.finish()
    }

    /// Collects them for pairs of one of these bodies and one of another scene.
    pub(super) fn find_pairs_between<T: SupportMap<Vector = S::Vector>, P: OfPair>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &impl Fn([usize; 2], &Body<S>, &Body<T>) -> Option<P>,
    ) -> Work {
        let mut asking = Asking { pairing: Pairing::between(*self, other), within, tell, pairs: reuse(pairs) };
        asking.search(self.scene.tree.pairs_between(&other.tree, within));
        asking.finish()
    }

    #[cfg(feature = "rayon")]
    pub(super) fn par_find_pairs<P: OfPair + Send>(
        &self,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &(impl Fn([usize; 2], &Body<S>, &Body<S>) -> Option<P> + Sync),
    ) -> Work
    where
        S: Sync,
    {
        use rayon::prelude::*;
        // Enough that idle threads find another piece, and few enough that they do not wait for each other.
        const PIECES: usize = 256;
        let pairing = Pairing::within(*self);
        let pieces = self.scene.tree.pairs_within(within).split(PIECES);
        let found: Vec<_> = pieces
            .into_par_iter()
            .map(|piece| {
                let mut pairs = Vec::new();
                let mut asking = Asking { pairing, within, tell, pairs: &mut pairs };
                asking.search(piece);
                (asking.pairing.work, pairs)
            })
            .collect();
        let mut asking = Asking { pairing, within, tell, pairs: reuse(pairs) };
        for (work, pairs) in found {
            asking.pairs.extend(pairs);
            asking.pairing.count(work);
        }
        asking.finish()
    }
}

/// An element of a list of pairs.
pub(super) trait OfPair {
    fn indices(&self) -> [usize; 2];
}

impl<V: Vector> OfPair for PairDistance<V> {
    fn indices(&self) -> [usize; 2] {
        [self.a, self.b]
    }
}

impl<V: Vector> OfPair for PairContact<V> {
    fn indices(&self) -> [usize; 2] {
        [self.a, self.b]
    }
}

/// The pairs of bodies that a question is about, and the work that was done for them.
pub(super) struct Pairing<'s, S: SupportMap, T: SupportMap<Vector = S::Vector>> {
    pub(super) a: Among<'s, S>,
    pub(super) b: Among<'s, T>,
    /// Whether both are one scene.
    pub(super) same: bool,
    pub(super) work: Work,
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> Clone for Pairing<'_, S, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> Copy for Pairing<'_, S, T> {}

impl<'s, S: SupportMap> Pairing<'s, S, S> {
    pub(super) fn within(all: Among<'s, S>) -> Self {
        Self { a: all, b: all, same: true, work: Work::default() }
    }
}

impl<'s, S: SupportMap, T: SupportMap<Vector = S::Vector>> Pairing<'s, S, T> {
    pub(super) fn between(all: Among<'s, S>, other: &'s Scene<T>) -> Self {
        Self { a: all, b: other.all(), same: false, work: Work::default() }
    }

    /// The indices of a pair in their order, and its bodies, if it is to be tested now, which counts as work; a break
    /// if the question ends early. `is_late` tells of the indices in their order whether the pair no longer matters.
    #[inline]
    pub(super) fn asked(
        &mut self,
        [i, j]: [usize; 2],
        is_late: impl FnOnce([usize; 2]) -> bool,
    ) -> ControlFlow<(), Option<BodyPair<'s, S, T>>> {
        let pair = if self.same && j < i { [j, i] } else { [i, j] };
        if is_late(pair) {
            return ControlFlow::Continue(None);
        }
        let Some(found) = self.bodies(pair) else { return ControlFlow::Continue(None) };
        if self.a.stops(&mut self.work) {
            return ControlFlow::Break(());
        }
        self.work.tested += 1;
        ControlFlow::Continue(Some(found))
    }

    /// The bodies of a pair, if the question is about it.
    #[inline]
    pub(super) fn bodies(&self, [i, j]: [usize; 2]) -> Option<BodyPair<'s, S, T>> {
        let (a, b) = (self.a.body(i)?, self.b.body(j)?);
        (!self.a.is_pair_left_out(i, j)).then_some(([i, j], a, b))
    }

    /// Adds the work of a part of the search.
    #[cfg(feature = "rayon")]
    pub(super) fn count(&mut self, part: Work) {
        self.work.nodes += part.nodes;
        self.work.tested += part.tested;
        self.work.cancelled |= part.cancelled;
    }

    /// The work, with the number of pairs that were left out.
    pub(super) fn finish(self) -> Work {
        Work { culled: self.all() - self.work.tested, ..self.work }
    }

    /// The number of all pairs, without those of half-spaces alone.
    fn all(&self) -> usize {
        let (a, b) = (self.a.scene, self.b.scene);
        if self.same {
            let bounded = a.len() - a.half_spaces.len();
            bounded * bounded.saturating_sub(1) / 2 + bounded * a.half_spaces.len()
        } else {
            a.len() * b.len() - a.half_spaces.len() * b.half_spaces.len()
        }
    }
}

/// The indices of two bodies, and the bodies.
pub(super) type BodyPair<'s, S, T> = ([usize; 2], &'s Body<S>, &'s Body<T>);

/// A running search for pairs.
struct Asking<'s, 'p, S: SupportMap, T: SupportMap<Vector = S::Vector>, F, P> {
    pairing: Pairing<'s, S, T>,
    within: ScalarOf<S>,
    /// The result for two bodies, if there is any.
    tell: &'p F,
    pairs: &'p mut Vec<P>,
}

impl<S, T, F, P: OfPair> Asking<'_, '_, S, T, F, P>
where
    S: SupportMap,
    T: SupportMap<Vector = S::Vector>,
    F: Fn([usize; 2], &Body<S>, &Body<T>) -> Option<P>,
{
    /// Tests the pairs of bounded bodies whose boxes are near.
    fn search(&mut self, search: PairSearch<'_, S::Vector>) {
        let nodes = search.visit(|i, j| self.ask(i, j));
        self.pairing.work.nodes += nodes;
    }

    fn ask(&mut self, i: usize, j: usize) -> ControlFlow<()> {
        if let Some((pair, a, b)) = self.pairing.asked([i, j], |_| false)? {
            self.pairs.extend((self.tell)(pair, a, b));
        }
        ControlFlow::Continue(())
    }

    /// Tests the bodies that are near half-spaces, sorts the pairs, and counts those that were left out.
    fn finish(mut self) -> Work {
        let (Pairing { a, b, same, .. }, within) = (self.pairing, self.within);
        for (index, half_space) in a.half_spaces() {
            let nodes = b.scene.tree.within(&HeightBound::new(half_space), within, |other| self.ask(index, other));
            self.pairing.work.nodes += nodes;
        }
        for (index, half_space) in b.half_spaces().filter(|_| !same) {
            let nodes = a.scene.tree.within(&HeightBound::new(half_space), within, |other| self.ask(other, index));
            self.pairing.work.nodes += nodes;
        }
        self.pairs.sort_unstable_by_key(OfPair::indices);
        self.pairing.finish()
    }
}

/// The distance from one body to another, if it is within the limit; `None` for two half-spaces.
fn between<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    [i, j]: [usize; 2],
    a: &Body<S>,
    b: &Body<T>,
    options: DistanceOptions<S::Vector>,
) -> Option<PairDistance<S::Vector>> {
    let distance = distance_of(a, b, options)?;
    (distance.distance <= options.limit).then_some(PairDistance { a: i, b: j, distance })
}

/// The distance from one body to another; `None` for two half-spaces.
pub(super) fn distance_of<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    a: &Body<S>,
    b: &Body<T>,
    options: DistanceOptions<S::Vector>,
) -> Option<Distance<S::Vector>> {
    match (a, b) {
        (Body::Convex(a), Body::Convex(b)) => Some(distance(a, b, options)),
        (Body::Convex(a), Body::HalfSpace(b)) => Some(b.distance_from(a)),
        (Body::HalfSpace(a), Body::Convex(b)) => Some(a.distance_from(b).reversed()),
        (Body::HalfSpace(_), Body::HalfSpace(_)) => None,
    }
}
