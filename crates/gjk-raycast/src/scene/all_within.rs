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
        let (found, options) = (reuse(bodies), options.with_limit(within));
        let mut work = Work::default();
        let mut look = |index: usize, body: &Body<S>, work: &mut Work| {
            if self.stops(work) {
                return ControlFlow::Break(());
            }
            work.tested += 1;
            let distance = body.distance_from(shape, options);
            if distance.distance <= within {
                found.push(BodyDistance { body: index, distance });
            }
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
        found.sort_unstable_by_key(|found| found.body);
        self.finish(&mut work);
        work
    }
}
