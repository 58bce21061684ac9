//! Pairs of bodies that are near each other.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Aabb, BoxDistance, Bvh, PairSearch, Scalar as _, ScalarOf, SupportMap, Vector};

use super::among::Among;
use super::answers::{PairContact, PairDistance, Work, reuse};
use super::bounds::{HeightBound, Question};
use super::instance::{Asked, Id, asked_pair};
use super::{Body, Scene, Slot};
use crate::{DistanceOptions, distance};

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
        self.find_pairs(
            within,
            pairs,
            &|pair, a, b| asked_pair!(a, b => between(pair, a, b, options.with_limit(within))),
        )
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
        self.find_pairs_between(
            other,
            within,
            pairs,
            &|pair, a, b| asked_pair!(a, b => between(pair, a, b, options.with_limit(within))),
        )
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
        self.par_find_pairs(
            within,
            pairs,
            &|pair, a, b| asked_pair!(a, b => between(pair, a, b, options.with_limit(within))),
        )
    }

    /// Collects the results of `tell` for the pairs of these bodies whose boxes are no farther than `within` from each
    /// other.
    pub(super) fn find_pairs<P: OfPair>(
        &self,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &impl Fn([Id; 2], Asked<'_, '_, S>, Asked<'_, '_, S>) -> Option<P>,
    ) -> Work {
        let mut asking =
            Asking { a: *self, b: *self, same: true, within, tell, pairs: reuse(pairs), work: Work::default() };
        asking.search(self.scene.tree.pairs_within(within));
        asking.finish()
    }

    /// Collects them for pairs of one of these bodies and one of another scene.
    pub(super) fn find_pairs_between<T: SupportMap<Vector = S::Vector>, P: OfPair>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &impl Fn([Id; 2], Asked<'_, '_, S>, Asked<'_, '_, T>) -> Option<P>,
    ) -> Work {
        let (b, pairs) = (other.all(), reuse(pairs));
        let mut asking = Asking { a: *self, b, same: false, within, tell, pairs, work: Work::default() };
        asking.search(self.scene.tree.pairs_between(&other.tree, within));
        asking.finish()
    }

    #[cfg(feature = "rayon")]
    pub(super) fn par_find_pairs<P: OfPair + Send>(
        &self,
        within: ScalarOf<S>,
        pairs: &mut Vec<P>,
        tell: &(impl Fn([Id; 2], Asked<'_, '_, S>, Asked<'_, '_, S>) -> Option<P> + Sync),
    ) -> Work
    where
        S: Sync,
    {
        use rayon::prelude::*;
        // Enough that idle threads find another piece, and few enough that they do not wait for each other.
        const PIECES: usize = 256;
        let (a, b, same) = (*self, *self, true);
        let pieces = self.scene.tree.pairs_within(within).split(PIECES);
        let found: Vec<_> = pieces
            .into_par_iter()
            .map(|piece| {
                let mut pairs = Vec::new();
                let mut asking = Asking { a, b, same, within, tell, pairs: &mut pairs, work: Work::default() };
                asking.search(piece);
                (asking.work, pairs)
            })
            .collect();
        let mut asking = Asking { a, b, same, within, tell, pairs: reuse(pairs), work: Work::default() };
        for (work, pairs) in found {
            asking.pairs.extend(pairs);
            asking.work.nodes += work.nodes;
            asking.work.tested += work.tested;
            asking.work.cancelled |= work.cancelled;
        }
        asking.finish()
    }
}

/// An element of a list of pairs.
pub(super) trait OfPair {
    fn ids(&self) -> [Id; 2];
}

impl<V: Vector> OfPair for PairDistance<V> {
    fn ids(&self) -> [Id; 2] {
        [Id { body: self.a, member: self.member_a }, Id { body: self.b, member: self.member_b }]
    }
}

impl<V: Vector> OfPair for PairContact<V> {
    fn ids(&self) -> [Id; 2] {
        [Id { body: self.a, member: self.member_a }, Id { body: self.b, member: self.member_b }]
    }
}

/// A running search for pairs.
struct Asking<'s, 'p, S: SupportMap, T: SupportMap<Vector = S::Vector>, F, P> {
    a: Among<'s, S>,
    b: Among<'s, T>,
    /// Whether both are one scene.
    same: bool,
    within: ScalarOf<S>,
    /// The result for two bodies, if there is any.
    tell: &'p F,
    pairs: &'p mut Vec<P>,
    work: Work,
}

impl<S, T, F, P: OfPair> Asking<'_, '_, S, T, F, P>
where
    S: SupportMap,
    T: SupportMap<Vector = S::Vector>,
    F: Fn([Id; 2], Asked<'_, '_, S>, Asked<'_, '_, T>) -> Option<P>,
{
    /// Tests the pairs of bounded bodies whose boxes are near.
    fn search(&mut self, search: PairSearch<'_, S::Vector>) {
        let nodes =
            search.visit(|i, j| self.ask(i, j, |around| BoxDistance::new(around.unwrap_or_else(Aabb::everything))));
        self.work.nodes += nodes;
    }

    /// Tests two bodies, or the pairs of their members that are near; `beside` is the question of what is near a body
    /// with this box, or near a half-space.
    fn ask<Q: Question<S::Vector>>(
        &mut self,
        i: usize,
        j: usize,
        beside: impl Fn(Option<Aabb<S::Vector>>) -> Q,
    ) -> ControlFlow<()> {
        let (i, j) = if self.same && j < i { (j, i) } else { (i, j) };
        let (Some(a), Some(b)) = (self.a.slot(i), self.b.slot(j)) else { return ControlFlow::Continue(()) };
        if self.a.is_pair_left_out(i, j) {
            return ControlFlow::Continue(());
        }
        let (trees, within) = ([&self.a.scene.tree, &self.b.scene.tree], self.within);
        let mut nodes = 0;
        let mut tell = |pair, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>| {
            if self.a.stops(&mut self.work) {
                return ControlFlow::Break(());
            }
            self.work.tested += 1;
            self.pairs.extend((self.tell)(pair, a, b));
            ControlFlow::Continue(within)
        };
        let next = each_pair([i, j], (a, b), trees, within, &mut nodes, &beside, &mut tell);
        self.work.nodes += nodes;
        next.map_continue(|_| ())
    }

    /// Tests the bodies that are near half-spaces, sorts the pairs, and counts those that were left out.
    fn finish(mut self) -> Work {
        let (a, b, same, within) = (self.a, self.b, self.same, self.within);
        for (index, half_space) in a.half_spaces() {
            let height = HeightBound::new(half_space);
            let nodes = b.scene.tree.within(&height, within, |other| self.ask(index, other, |_| height));
            self.work.nodes += nodes;
        }
        for (index, half_space) in b.half_spaces().filter(|_| !same) {
            let height = HeightBound::new(half_space);
            let nodes = a.scene.tree.within(&height, within, |other| self.ask(other, index, |_| height));
            self.work.nodes += nodes;
        }
        self.pairs.sort_unstable_by_key(OfPair::ids);
        self.work.culled = self.all() - self.work.tested;
        self.work
    }

    /// The number of all pairs, without those of half-spaces alone and those within one body.
    fn all(&self) -> usize {
        let (a, b) = (self.a.scene, self.b.scene);
        let pairs = |n: usize| n.saturating_mul(n.saturating_sub(1)) / 2;
        if self.same {
            let bounded = a.members - a.half_spaces.len();
            let within_one: usize = a.instances().map(|(_, instance)| pairs(instance.group().len())).sum();
            pairs(bounded) - within_one + bounded.saturating_mul(a.half_spaces.len())
        } else {
            a.members.saturating_mul(b.members) - a.half_spaces.len() * b.half_spaces.len()
        }
    }
}

/// Calls `tell` for two bodies, or for each pair of their members whose boxes are no farther apart than the limit. The
/// call returns the limit from then on, or breaks off.
pub(super) fn each_pair<S: SupportMap, T: SupportMap<Vector = S::Vector>, Q: Question<S::Vector>>(
    [i, j]: [usize; 2],
    (a, b): (&Slot<S>, &Slot<T>),
    trees: [&Bvh<S::Vector>; 2],
    limit: ScalarOf<S>,
    nodes: &mut usize,
    beside: &impl Fn(Option<Aabb<S::Vector>>) -> Q,
    tell: &mut impl FnMut([Id; 2], Asked<'_, '_, S>, Asked<'_, '_, T>) -> ControlFlow<(), ScalarOf<S>>,
) -> ControlFlow<(), ScalarOf<S>> {
    if let (Slot::Body(a), Slot::Body(b)) = (a, b) {
        return tell([Id::of(i), Id::of(j)], Asked::Own(a), Asked::Own(b));
    }
    let (mut limit, mut inner) = (limit, 0);
    let near_b = beside(trees[1].get(j));
    let next = a.each_member((i, ScalarOf::<S>::ZERO), &near_b, limit, nodes, &mut |id_a, _, a| {
        let around = if let Asked::Member(_, around) = a { Some(around) } else { trees[0].get(i) };
        let near_a = beside(around);
        limit = b.each_member((j, ScalarOf::<S>::ZERO), &near_a, limit, &mut inner, &mut |id_b, _, b| {
            tell([id_a, id_b], a, b)
        })?;
        ControlFlow::Continue(limit)
    });
    *nodes += inner;
    next
}

/// The distance from one body to another, if it is within the limit; `None` for two half-spaces.
fn between<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    [id_a, id_b]: [Id; 2],
    a: &Body<S>,
    b: &Body<T>,
    options: DistanceOptions<S::Vector>,
) -> Option<PairDistance<S::Vector>> {
    let distance = match (a, b) {
        (Body::Convex(a), Body::Convex(b)) => distance(a, b, options),
        (Body::Convex(a), Body::HalfSpace(b)) => b.distance_from(a),
        (Body::HalfSpace(a), Body::Convex(b)) => a.distance_from(b).reversed(),
        (Body::HalfSpace(_), Body::HalfSpace(_)) => return None,
    };
    let (Id { body: a, member: member_a }, Id { body: b, member: member_b }) = (id_a, id_b);
    (distance.distance <= options.limit).then_some(PairDistance { a, b, member_a, member_b, distance })
}
