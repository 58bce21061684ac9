//! Pairs of bodies that are near each other.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{PairSearch, ScalarOf, SupportMap};

use super::height_bound::HeightBound;
use super::result::{PairDistance, Work, reuse};
use super::{Among, Body, Scene};
use crate::{Distance, DistanceOptions, distance};

impl<S: SupportMap> Scene<S> {
    /// All pairs of bodies that are no farther than `within` from each other by [`distance`](crate::distance()), in the
    /// order of their indices, into `pairs`, which is emptied first. Half-spaces make no pairs with each other.
    pub fn pairs_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        self.all().pairs_within(within, options, pairs)
    }

    /// All pairs of a body of this scene, `a`, and one of another, `b`, that are no farther than `within` from each other.
    pub fn pairs_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        self.all().pairs_between(other, within, options, pairs)
    }
}

impl<S: SupportMap> Among<'_, S> {
    /// [`Scene::pairs_within`] among these bodies.
    pub fn pairs_within(
        &self,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        let mut asking = Asking::new(*self, self.scene.all(), true, within, options, reuse(pairs));
        asking.search(self.scene.tree.pairs_within(within));
        asking.half_spaces_of_a();
        asking.finish()
    }

    /// [`Scene::pairs_between`] of these bodies and all of another scene.
    pub fn pairs_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &mut Vec<PairDistance<S::Vector>>,
    ) -> Work {
        let mut asking = Asking::new(*self, other.all(), false, within, options, reuse(pairs));
        asking.search(self.scene.tree.pairs_between(&other.tree, within));
        asking.half_spaces_of_a();
        asking.half_spaces_of_b();
        asking.finish()
    }

    /// [`pairs_within`](Self::pairs_within) on all threads of the current [rayon](https://docs.rs/rayon) pool, with the same pairs to the last
    /// bit. The nodes of the [`Work`] are those of the pieces that the search is cut into.
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
        use rayon::prelude::*;
        // Enough that threads which are done find another, and not so many that they wait for each other.
        const PIECES: usize = 256;
        let pieces = self.scene.tree.pairs_within(within).split(PIECES);
        let found: Vec<_> = pieces
            .into_par_iter()
            .map(|piece| {
                let mut pairs = Vec::new();
                let mut asking = Asking::new(*self, self.scene.all(), true, within, options, &mut pairs);
                asking.search(piece);
                (asking.work, pairs)
            })
            .collect();
        let mut asking = Asking::new(*self, self.scene.all(), true, within, options, reuse(pairs));
        for (work, pairs) in found {
            asking.pairs.extend(pairs);
            asking.work.nodes += work.nodes;
            asking.work.tested += work.tested;
            asking.work.cancelled |= work.cancelled;
        }
        asking.half_spaces_of_a();
        asking.finish()
    }
}

/// A search for pairs under way.
struct Asking<'s, 'p, S: SupportMap, T: SupportMap<Vector = S::Vector>> {
    a: Among<'s, S>,
    b: Among<'s, T>,
    /// Whether both are one scene.
    same: bool,
    within: ScalarOf<S>,
    options: DistanceOptions<S::Vector>,
    pairs: &'p mut Vec<PairDistance<S::Vector>>,
    work: Work,
}

impl<'s, 'p, S: SupportMap, T: SupportMap<Vector = S::Vector>> Asking<'s, 'p, S, T> {
    fn new(
        a: Among<'s, S>,
        b: Among<'s, T>,
        same: bool,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        pairs: &'p mut Vec<PairDistance<S::Vector>>,
    ) -> Self {
        Self { a, b, same, within, options: options.with_limit(within), pairs, work: Work::default() }
    }

    /// Asks about the pairs of bounded bodies whose boxes are near.
    fn search(&mut self, search: PairSearch<'_, S::Vector>) {
        let nodes = search.visit(|i, j| {
            let (i, j) = if self.same && j < i { (j, i) } else { (i, j) };
            self.ask(i, j)
        });
        self.work.nodes += nodes;
    }

    /// Asks about the bodies of `b` that are near a half-space of `a`; the other way round too, where both are one scene.
    fn half_spaces_of_a(&mut self) {
        let (a, b, within) = (self.a, self.b.scene, self.within);
        for (index, body) in a.half_spaces() {
            let Body::HalfSpace(half_space) = body else { continue };
            let nodes = b.tree.within(&HeightBound::new(half_space), within, |other| {
                let (i, j) = if self.same && other < index { (other, index) } else { (index, other) };
                self.ask(i, j)
            });
            self.work.nodes += nodes;
        }
    }

    /// Asks about the bodies of `a` that are near a half-space of `b`.
    fn half_spaces_of_b(&mut self) {
        let (a, b, within) = (self.a.scene, self.b, self.within);
        for (index, body) in b.half_spaces() {
            let Body::HalfSpace(half_space) = body else { continue };
            let nodes = a.tree.within(&HeightBound::new(half_space), within, |other| self.ask(other, index));
            self.work.nodes += nodes;
        }
    }

    fn ask(&mut self, i: usize, j: usize) -> ControlFlow<()> {
        // Of one scene, both have to be picked.
        let picked = !self.same || self.a.body(j).is_some();
        let (Some(a), Some(b), true) = (self.a.body(i), self.b.body(j), picked) else {
            return ControlFlow::Continue(());
        };
        if self.a.is_pair_left_out(i, j) {
            return ControlFlow::Continue(());
        }
        if self.a.stops(&mut self.work) {
            return ControlFlow::Break(());
        }
        self.work.tested += 1;
        if let Some(distance) = between(a, b, self.options)
            && distance.distance <= self.within
        {
            self.pairs.push(PairDistance { a: i, b: j, distance });
        }
        ControlFlow::Continue(())
    }

    /// Sorts the pairs and says what was left out of all.
    fn finish(mut self) -> Work {
        self.pairs.sort_unstable_by_key(|pair| (pair.a, pair.b));
        self.work.culled = self.all() - self.work.tested;
        self.work
    }

    /// The number of pairs that there are, without those of half-spaces alone.
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

/// The distance from one body to another; of two half-spaces there is none to speak of.
fn between<S: SupportMap, T: SupportMap<Vector = S::Vector>>(
    a: &Body<S>,
    b: &Body<T>,
    options: DistanceOptions<S::Vector>,
) -> Option<Distance<S::Vector>> {
    match (a, b) {
        (Body::Convex(a), Body::Convex(b)) => Some(distance(a, b, options)),
        (Body::Convex(a), Body::HalfSpace(b)) => Some(b.distance_from(a)),
        (Body::HalfSpace(a), Body::Convex(b)) => Some(a.distance_to(b)),
        (Body::HalfSpace(_), Body::HalfSpace(_)) => None,
    }
}
