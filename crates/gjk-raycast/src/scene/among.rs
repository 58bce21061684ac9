//! The bodies and pairs of a question, and when it stops.

use core::ops::ControlFlow;

use convex_support::{Scalar, ScalarOf, SupportMap};

use super::asked::Asked;
use super::bounds::Question;
use super::instance::Id;
use super::{Body, Occupant, PairContact, Scene, SceneDistance, SceneRayCast, Work};
use crate::{DistanceOptions, HalfSpace, Ray, RayCastError, RayCastOptions};

/// The bodies of a scene that a question is about: all of them, or those that a closure picks, made by [`Scene::all`]
/// and [`Scene::among`]. Its methods are the questions that a scene answers.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec2};
/// use gjk_raycast::{DistanceOptions, Scene};
///
/// let ball = |x: f64| Posed::translated(Ball::new(1.0)?, DVec2::new(x, 0.0));
/// let scene = Scene::new([ball(0.0)?, ball(3.0)?, ball(7.0)?])?;
/// // The nearest to body 1, apart from itself.
/// let other = scene.among(&|body| body != 1).nearest(&ball(3.0)?, DistanceOptions::default());
/// assert_eq!(other.nearest.map(|n| n.body), Some(0));
/// // Bodies 0 and 1 are pieces of one link, and may touch.
/// let mut pairs = Vec::new();
/// scene.all().without_pairs(&|i, j| (i, j) == (0, 1)).pairs_within(
///     2.0,
///     DistanceOptions::default(),
///     &mut pairs,
/// );
/// assert_eq!(pairs.iter().map(|p| (p.a, p.b)).collect::<Vec<_>>(), [(1, 2)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Among<'s, S: SupportMap> {
    pub(super) scene: &'s Scene<S>,
    bodies: Option<&'s Picks<'s>>,
    without_pairs: Option<&'s Pairs<'s>>,
    until: Option<&'s StopFlag<'s>>,
    /// The contacts of the last step.
    pub(super) last: &'s [PairContact<S::Vector>],
}

/// Whether a question is about the body with this index.
type Picks<'f> = dyn Fn(usize) -> bool + Sync + 'f;
/// Whether the pair of these indices is left out.
type Pairs<'f> = dyn Fn(usize, usize) -> bool + Sync + 'f;
type StopFlag<'f> = dyn Fn() -> bool + Sync + 'f;

impl<S: SupportMap> Clone for Among<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: SupportMap> Copy for Among<'_, S> {}

impl<S: SupportMap> core::fmt::Debug for Among<'_, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Among")
            .field("bodies", &self.scene.len())
            .field("picked", &self.bodies.is_some())
            .field("without_pairs", &self.without_pairs.is_some())
            .field("until", &self.until.is_some())
            .finish()
    }
}

impl<S: SupportMap> Scene<S> {
    /// Questions about all bodies, unless [`Among::without_pairs`] or [`Among::until`] narrows them down.
    #[must_use]
    pub fn all(&self) -> Among<'_, S> {
        Among { scene: self, bodies: None, without_pairs: None, until: None, last: &[] }
    }

    /// Questions about the bodies for whose index `picked` returns true, such as those of a layer or a group: this is
    /// the filter, the query mask and the collision group of other libraries. If the layers of each body are the bits
    /// of a number in a list of yours, `|body| layers[body] & mask != 0` picks those of a mask.
    #[must_use]
    #[doc(alias("filter", "layer", "mask", "group", "predicate", "query_filter"))]
    pub fn among<'s>(&'s self, picked: &'s (dyn Fn(usize) -> bool + Sync + 's)) -> Among<'s, S> {
        Among { bodies: Some(picked), ..self.all() }
    }

    /// [`Among::ray_cast`] for all bodies: with [`nearest`](Self::nearest) the most common question.
    ///
    /// # Errors
    /// Those of [`Among::ray_cast`].
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        self.all().ray_cast(ray, options)
    }

    /// [`Among::nearest`] for all bodies.
    pub fn nearest<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> SceneDistance<S::Vector> {
        self.all().nearest(shape, options)
    }
}

impl<'s, S: SupportMap> Among<'s, S> {
    /// Leaves out the pairs for whose indices `left_out` returns true, such as those of one group, or those that
    /// are allowed to collide; the collision filter of other libraries. It is called once for each pair whose boxes are
    /// near: with the lower index first, or for two scenes with the index in the first one.
    #[doc(alias("collision_filter", "allowed_collision_matrix", "collision_groups", "ignore_pair"))]
    #[must_use]
    pub fn without_pairs(self, left_out: &'s (dyn Fn(usize, usize) -> bool + Sync + 's)) -> Self {
        Self { without_pairs: Some(left_out), ..self }
    }

    /// Ends a question early, as soon as `stop` returns true; it is called before each single query. The answer is then
    /// about the bodies tested so far, and [`Work::cancelled`](crate::Work::cancelled) is set.
    #[must_use]
    pub fn until(self, stop: &'s (dyn Fn() -> bool + Sync + 's)) -> Self {
        Self { until: Some(stop), ..self }
    }

    /// Passes the contacts of pairs in the last step, in the order of the last answer. Their points are kept while they
    /// are valid, as by [`contact_after`](crate::contact_after). If you keep two lists, and swap them after each step,
    /// nothing is allocated.
    #[must_use]
    pub fn after(self, last: &'s [PairContact<S::Vector>]) -> Self {
        Self { last, ..self }
    }

    /// What is at this index, if the question is about it.
    #[inline]
    pub(super) fn slot(&self, index: usize) -> Option<&'s Occupant<S>> {
        if self.bodies.is_some_and(|picks| !picks(index)) {
            return None;
        }
        self.scene.slot(index)
    }

    /// The half-spaces that the question is about, with their indices.
    pub(crate) fn half_spaces(&self) -> impl Iterator<Item = (usize, &'s HalfSpace<S::Vector>)> + use<'s, S> {
        let among = *self;
        among.scene.half_spaces.iter().filter_map(move |&index| match among.slot(index)?.body()? {
            Body::HalfSpace(half_space) => Some((index, half_space)),
            Body::Convex(_) => None,
        })
    }

    /// Tests the half-spaces, and then the bodies whose bound may be below the limit, mostly in the order of their
    /// bounds. `ask` takes the bound and returns the next limit, with the name of a body: a body at the limit counts if
    /// it comes before that one, because the lowest index counts among equals. A break or an error ends the search.
    pub(super) fn in_order<Q: Question<S::Vector>, E>(
        &self,
        question: &Q,
        end: ScalarOf<S>,
        ask: impl FnMut(Id, ScalarOf<S>, Asked<'_, '_, S>) -> Result<ControlFlow<(), (ScalarOf<S>, Id)>, E>,
    ) -> Result<Work, E> {
        let mut order = InOrder { among: self, work: Work::default(), limit: (end, Id::LAST), ask, refused: None };
        let mut nodes = 0;
        let mut look = |index: usize, from: ScalarOf<S>| {
            if !order.may_count(Id::of(index), from) {
                return ControlFlow::Continue(order.limit.0);
            }
            let (limit, Some(slot)) = (order.limit.0, self.slot(index)) else {
                return ControlFlow::Continue(order.limit.0);
            };
            slot.each_member((index, from), question, limit, &mut nodes, &mut |id, from, asked| {
                if order.may_count(id, from) {
                    order.test(id, from, asked)
                } else {
                    ControlFlow::Continue(order.limit.0)
                }
            })
        };
        let ended = self.scene.half_spaces.iter().try_fold(end, |_, &index| look(index, Scalar::ZERO));
        let of_tree =
            if let ControlFlow::Continue(end) = ended { self.scene.tree.search(question, end, look) } else { 0 };
        order.work.nodes = of_tree + nodes;
        self.finish(&mut order.work);
        order.refused.map_or(Ok(order.work), Err)
    }

    #[inline]
    pub(super) fn is_pair_left_out(&self, a: usize, b: usize) -> bool {
        self.without_pairs.is_some_and(|left_out| left_out(a, b))
    }

    /// Whether to stop, which the work records.
    #[inline]
    pub(super) fn stops(&self, work: &mut Work) -> bool {
        work.cancelled |= self.until.is_some_and(|stop| stop());
        work.cancelled
    }

    /// The work, with the number of bodies that were left out.
    pub(super) fn finish(&self, work: &mut Work) {
        work.culled = self.scene.members - work.tested;
    }
}

/// A running search for bodies in the order of their bounds.
struct InOrder<'a, 's, S: SupportMap, F, E> {
    among: &'a Among<'s, S>,
    work: Work,
    limit: (ScalarOf<S>, Id),
    ask: F,
    refused: Option<E>,
}

impl<S: SupportMap, F, E> InOrder<'_, '_, S, F, E>
where
    F: FnMut(Id, ScalarOf<S>, Asked<'_, '_, S>) -> Result<ControlFlow<(), (ScalarOf<S>, Id)>, E>,
{
    /// Whether a body with this bound may come before the limit.
    #[inline(always)]
    fn may_count(&self, id: Id, from: ScalarOf<S>) -> bool {
        from < self.limit.0 || id < self.limit.1
    }

    #[inline(always)]
    fn test(&mut self, id: Id, from: ScalarOf<S>, asked: Asked<'_, '_, S>) -> ControlFlow<(), ScalarOf<S>> {
        if self.among.stops(&mut self.work) {
            return ControlFlow::Break(());
        }
        self.work.tested += 1;
        match (self.ask)(id, from, asked) {
            Ok(next) => self.limit = next?,
            Err(why) => {
                self.refused = Some(why);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(self.limit.0)
    }
}
