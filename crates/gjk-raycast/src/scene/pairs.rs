//! Which pairs of bodies are near each other? Those whose boxes are, as the trees tell, are asked a single query, one
//! by one and in no order. A [`Pairing`] also serves the searches for the [nearest](super::nearest_pair) pair and for
//! pairs that [move](super::moving_pairs).

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Aabb, BoxDistance, Bvh, NearestPairs, PairSearch, Scalar, ScalarOf, SupportMap, Vector};

use super::among::Among;
use super::answers::{OfPair, PairDistance, Work, reuse};
use super::asked::{Asked, asked_pair};
use super::bounds::{HeightBound, Question};
use super::instance::Id;
use super::{Body, Occupant, Scene};
use crate::{Distance, DistanceOptions};

impl<S: SupportMap> Among<'_, S> {
    /// Finds all pairs of bodies that are no farther than `within` from each other by [`distance`](crate::distance()).
    /// Writes them into `pairs`, which is emptied first, in the order of their indices. Half-spaces make no pairs with
    /// each other.
    #[doc(alias("clash_detection", "interference", "broad_phase"))]
    pub fn pairs_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        Pairing::within(*self).find(&options.with_limit(within), pairs)
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
        Pairing::between(*self, other).find(&options.with_limit(within), pairs)
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
        Pairing::within(*self).par_find(&options.with_limit(within), pairs)
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

/// A value from which on no pair counts: that of a pair, whose indices decide among equals.
pub(super) type Limit<N> = (N, [Id; 2]);

/// The limit `end` itself is within it.
pub(super) fn up_to<N>(end: N) -> Limit<N> {
    (end, [Id::LAST; 2])
}

/// What a question does with the pairs that it comes to.
pub(super) trait TestPair<S: SupportMap, T: SupportMap<Vector = S::Vector>> {
    /// The bound from which on pairs no longer count.
    fn limit(&self) -> Limit<ScalarOf<S>>;

    /// Whether a pair with this bound no longer counts.
    #[inline]
    fn is_late(&self, pair: [Id; 2], from: ScalarOf<S>) -> bool {
        let (end, last) = self.limit();
        from >= end && pair >= last
    }

    /// Tests a pair with this bound, or breaks the question off.
    fn test(&mut self, pair: [Id; 2], from: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()>;
}

impl<'s, S: SupportMap> Pairing<'s, S, S> {
    pub(super) fn within(all: Among<'s, S>) -> Self {
        Self { a: all, b: all, same: true, work: Work::default() }
    }
}

impl<'s, S: SupportMap, T: SupportMap<Vector = S::Vector>> Pairing<'s, S, T> {
    pub(super) fn between(all: Among<'s, S>, other: &'s Scene<T>) -> Self {
        Self { a: all, b: other.all(), same: false, work: Work::default() }
    }

    /// Collects the answers of a single query for the pairs whose boxes are near enough.
    pub(super) fn find<Q: AskPair<S::Vector>>(mut self, query: &Q, pairs: &mut Vec<Q::Answer>) -> Work {
        let mut found = Found { query, pairs: reuse(pairs) };
        self.search(self.boxes_within(query.within()), &mut found);
        self.end(found)
    }

    /// The same by all threads.
    #[cfg(feature = "rayon")]
    pub(super) fn par_find<Q: AskPair<S::Vector, Answer: Send> + Sync>(
        mut self,
        query: &Q,
        pairs: &mut Vec<Q::Answer>,
    ) -> Work
    where
        S: Sync,
        T: Sync,
    {
        use rayon::prelude::*;
        // Enough that idle threads find another piece, and few enough that they do not wait for each other.
        const PIECES: usize = 256;
        let search = |piece| {
            let (mut part, mut pairs) = (self, Vec::new());
            part.search(piece, &mut Found { query, pairs: &mut pairs });
            (part.work, pairs)
        };
        let parts: Vec<_> = self.boxes_within(query.within()).split(PIECES).into_par_iter().map(search).collect();
        let found = Found { query, pairs: reuse(pairs) };
        for (work, pairs) in parts {
            found.pairs.extend(pairs);
            self.count(work);
        }
        self.end(found)
    }

    /// Tests the pairs of bounded bodies whose boxes are near.
    fn search(&mut self, boxes: PairSearch<'_, S::Vector>, found: &mut impl TestPair<S, T>) {
        let nodes = boxes.visit(|i, j| self.ask([i, j], Scalar::ZERO, &beside_box, found));
        self.work.nodes += nodes;
    }

    /// Tests the bodies that are near half-spaces, sorts the pairs, and counts those that were left out.
    fn end<Q: AskPair<S::Vector>>(mut self, mut found: Found<'_, S::Vector, Q>) -> Work {
        let within = found.query.within();
        for of in self.half_spaces() {
            let ask = |other| self.ask(of.pair(other), Scalar::ZERO, &|_| of.height, &mut found);
            let nodes = of.others.within(&of.height, within, ask);
            self.work.nodes += nodes;
        }
        found.pairs.sort_unstable_by_key(OfPair::ids);
        self.finish()
    }

    /// The pairs of bounded bodies whose boxes are no farther than `within` from each other.
    fn boxes_within(&self, within: ScalarOf<S>) -> PairSearch<'s, S::Vector> {
        let (a, b) = (&self.a.scene.tree, &self.b.scene.tree);
        if self.same { a.pairs_within(within) } else { a.pairs_between(b, within) }
    }

    /// The same pairs, the nearest boxes first.
    pub(super) fn nearest_boxes(&self) -> NearestPairs<'s, S::Vector> {
        let (a, b) = (&self.a.scene.tree, &self.b.scene.tree);
        if self.same { a.nearest_pairs_within() } else { a.nearest_pairs(b) }
    }

    /// Tests two bodies with this bound, or the pairs of their members that are near; `beside` is the question of what
    /// is near a body with this box, or near a half-space. A break ends the question.
    #[inline]
    pub(super) fn ask<Q: Question<S::Vector>>(
        &mut self,
        [i, j]: [usize; 2],
        from: ScalarOf<S>,
        beside: &impl Fn(Option<Aabb<S::Vector>>) -> Q,
        question: &mut impl TestPair<S, T>,
    ) -> ControlFlow<()> {
        let (i, j) = if self.same && j < i { (j, i) } else { (i, j) };
        let pair = [Id::of(i), Id::of(j)];
        if question.is_late(pair, from) {
            return ControlFlow::Continue(());
        }
        let (Some(a), Some(b)) = (self.a.slot(i), self.b.slot(j)) else { return ControlFlow::Continue(()) };
        if self.a.is_pair_left_out(i, j) {
            return ControlFlow::Continue(());
        }
        if let (Occupant::Body(a), Occupant::Body(b)) = (a, b) {
            return self.test(pair, from, (Asked::Own(a), Asked::Own(b)), question);
        }
        let trees = [&self.a.scene.tree, &self.b.scene.tree];
        let (mut nodes, (limit, _)) = (0, question.limit());
        let mut tell = |pair, from, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>| {
            if !question.is_late(pair, from) {
                self.test(pair, from, (a, b), question)?;
            }
            ControlFlow::Continue(question.limit().0)
        };
        let next = each_pair([i, j], (a, b), trees, (from, limit), &mut nodes, beside, &mut tell);
        self.work.nodes += nodes;
        next.map_continue(|_| ())
    }

    /// The half-spaces of either scene, which make pairs with the bounded bodies of the other one.
    pub(super) fn half_spaces(&self) -> impl Iterator<Item = OfHalfSpace<'s, S::Vector>> + use<'s, S, T> {
        let Self { a, b, same, .. } = *self;
        let of = |others, is_second| {
            move |(index, half_space)| OfHalfSpace { index, is_second, height: HeightBound::new(half_space), others }
        };
        let firsts = a.half_spaces().map(of(&b.scene.tree, false));
        firsts.chain(b.half_spaces().filter(move |_| !same).map(of(&a.scene.tree, true)))
    }

    #[inline]
    fn test(
        &mut self,
        pair: [Id; 2],
        from: ScalarOf<S>,
        (a, b): (Asked<'_, '_, S>, Asked<'_, '_, T>),
        question: &mut impl TestPair<S, T>,
    ) -> ControlFlow<()> {
        if self.a.stops(&mut self.work) {
            return ControlFlow::Break(());
        }
        self.work.tested += 1;
        question.test(pair, from, a, b)
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

/// A half-space, and the boxes of the bodies that it makes pairs with.
pub(super) struct OfHalfSpace<'s, V: Vector> {
    pub(super) index: usize,
    /// Whether it is the second of its pairs.
    pub(super) is_second: bool,
    pub(super) height: HeightBound<V>,
    pub(super) others: &'s Bvh<V>,
}

impl<V: Vector> OfHalfSpace<'_, V> {
    /// Its pair with another body.
    pub(super) fn pair(&self, other: usize) -> [usize; 2] {
        if self.is_second { [other, self.index] } else { [self.index, other] }
    }
}

/// What is near a body with this box.
pub(super) fn beside_box<V: Vector>(around: Option<Aabb<V>>) -> BoxDistance<V> {
    BoxDistance::new(around.unwrap_or_else(Aabb::everything))
}

/// A single query of two bodies.
pub(super) trait AskPair<V: Vector> {
    type Answer: OfPair;

    /// How far apart boxes may be, which is not negative if bodies can be near enough at all.
    fn within(&self) -> V::Scalar;

    /// The answer for two bodies, if they are near enough; `None` for two half-spaces.
    fn ask<S: SupportMap<Vector = V>, T: SupportMap<Vector = V>>(
        &self,
        pair: [Id; 2],
        a: &Body<S>,
        b: &Body<T>,
    ) -> Option<Self::Answer>;
}

/// The pairs found so far.
struct Found<'p, V: Vector, Q: AskPair<V>> {
    query: &'p Q,
    pairs: &'p mut Vec<Q::Answer>,
}

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>, Q: AskPair<S::Vector>> TestPair<S, T>
    for Found<'_, S::Vector, Q>
{
    fn limit(&self) -> Limit<ScalarOf<S>> {
        up_to(self.query.within())
    }

    #[inline]
    fn test(&mut self, pair: [Id; 2], _: ScalarOf<S>, a: Asked<'_, '_, S>, b: Asked<'_, '_, T>) -> ControlFlow<()> {
        self.pairs.extend(asked_pair!(a, b => self.query.ask(pair, a, b)));
        ControlFlow::Continue(())
    }
}

/// Calls `tell` for each pair of members of two bodies whose boxes are no farther apart than the limit, with its bound,
/// at least that of the bodies. The call returns the limit from then on, or breaks off.
fn each_pair<S: SupportMap, T: SupportMap<Vector = S::Vector>, Q: Question<S::Vector>>(
    [i, j]: [usize; 2],
    (a, b): (&Occupant<S>, &Occupant<T>),
    trees: [&Bvh<S::Vector>; 2],
    (from, mut limit): (ScalarOf<S>, ScalarOf<S>),
    nodes: &mut usize,
    beside: &impl Fn(Option<Aabb<S::Vector>>) -> Q,
    tell: &mut impl FnMut([Id; 2], ScalarOf<S>, Asked<'_, '_, S>, Asked<'_, '_, T>) -> ControlFlow<(), ScalarOf<S>>,
) -> ControlFlow<(), ScalarOf<S>> {
    let mut inner = 0;
    let near_b = beside(trees[1].get(j));
    let next = a.each_member((i, from), &near_b, limit, nodes, &mut |id_a, from, a| {
        let around = if let Asked::Member(_, around) = a { Some(around) } else { trees[0].get(i) };
        let near_a = beside(around);
        limit =
            b.each_member((j, from), &near_a, limit, &mut inner, &mut |id_b, from, b| tell([id_a, id_b], from, a, b))?;
        ControlFlow::Continue(limit)
    });
    *nodes += inner;
    next
}

/// The distance, if it is within the limit.
impl<V: Vector> AskPair<V> for DistanceOptions<V> {
    type Answer = PairDistance<V>;

    fn within(&self) -> V::Scalar {
        self.limit
    }

    fn ask<S: SupportMap<Vector = V>, T: SupportMap<Vector = V>>(
        &self,
        pair: [Id; 2],
        a: &Body<S>,
        b: &Body<T>,
    ) -> Option<PairDistance<V>> {
        let distance = distance_of(a, b, *self)?;
        (distance.distance <= self.limit).then(|| PairDistance::of(pair, distance))
    }
}

/// The distance from one body to another; `None` for two half-spaces.
pub(super) fn distance_of<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    a: &Body<S>,
    b: &Body<T>,
    options: DistanceOptions<S::Vector>,
) -> Option<Distance<S::Vector>> {
    match (a, b) {
        (Body::Convex(a), b) => Some(b.distance_from(a, options)),
        (a, Body::Convex(b)) => Some(a.distance_from(b, options).reversed()),
        (Body::HalfSpace(_), Body::HalfSpace(_)) => None,
    }
}
