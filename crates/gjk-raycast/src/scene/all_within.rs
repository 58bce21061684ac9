//! All bodies within a distance.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{BoxDistance, ScalarOf, SupportMap};

use super::cast::outer_box_of_question;
use super::result::{BodyDistance, Work, reuse};
use super::{Among, Body, Scene};
use crate::DistanceOptions;

impl<S: SupportMap> Scene<S> {
    /// All bodies that are no farther than `within` from the shape by [`distance`](crate::distance()), in the order of
    /// their indices, into `bodies`, which is emptied first.
    pub fn all_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        bodies: &mut Vec<BodyDistance<S::Vector>>,
    ) -> Work {
        self.all().all_within(shape, within, options, bodies)
    }
}

impl<S: SupportMap> Among<'_, S> {
    /// [`Scene::all_within`] among these bodies.
    pub fn all_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: DistanceOptions<S::Vector>,
        bodies: &mut Vec<BodyDistance<S::Vector>>,
    ) -> Work {
        let options = options.with_limit(within);
        let work = self.near(shape, within, reuse(bodies), |index, body| {
            let distance = body.distance_from(shape, options);
            (distance.distance <= within).then_some(BodyDistance { body: index, distance })
        });
        bodies.sort_unstable_by_key(|found| found.body);
        work
    }

    /// What there is to `tell` of the bodies whose boxes are no farther than `within` from that of the shape, in no
    /// order.
    pub(super) fn near<A: SupportMap<Vector = S::Vector> + ?Sized, R>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        found: &mut Vec<R>,
        tell: impl Fn(usize, &Body<S>) -> Option<R>,
    ) -> Work {
        let mut work = Work::default();
        let mut look = |index: usize, body: &Body<S>, work: &mut Work| {
            if self.stops(work) {
                return ControlFlow::Break(());
            }
            work.tested += 1;
            found.extend(tell(index, body));
            ControlFlow::Continue(())
        };
        let ended = self.half_spaces().try_for_each(|(index, body)| look(index, body, &mut work));
        if ended.is_continue() {
            let around = BoxDistance::new(outer_box_of_question(shape));
            work.nodes = self.scene.tree.within(&around, within, |index| match self.body(index) {
                Some(body) => look(index, body, &mut work),
                None => ControlFlow::Continue(()),
            });
        }
        self.finish(&mut work);
        work
    }
}
