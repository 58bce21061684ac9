//! What a single query is about, when a scene asks it: a body, or a member of an instance where it is in the world.

use core::ops::ControlFlow;

use convex_support::{Aabb, ScalarOf, SupportMap};

use super::bounds::Question;
use super::instance::{Id, Placed};
use super::{Body, Occupant};

/// What a single query is about: a body of the scene, or a member of an instance with its box.
pub(super) enum Asked<'a, 'm, S: SupportMap> {
    Own(&'a Body<S>),
    Member(&'a Placed<'m, S::Vector>, Aabb<S::Vector>),
}

impl<S: SupportMap> Clone for Asked<'_, '_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: SupportMap> Copy for Asked<'_, '_, S> {}

/// The same expression for either kind of body.
macro_rules! asked {
    ($asked:expr, $body:ident => $answer:expr) => {
        match $asked {
            $crate::scene::asked::Asked::Own($body) => $answer,
            $crate::scene::asked::Asked::Member($body, _) => $answer,
        }
    };
}

/// The same for two of them.
macro_rules! asked_pair {
    ($a:ident, $b:ident => $answer:expr) => {
        $crate::scene::asked::asked!($a, $a => $crate::scene::asked::asked!($b, $b => $answer))
    };
}
pub(super) use {asked, asked_pair};

impl<S: SupportMap> Occupant<S> {
    /// Calls `tell` for the body, which has this index and bound, or for each member of the instance whose box has a
    /// bound of at most `limit`. The call returns the limit from then on, or breaks off.
    pub(super) fn each_member<Q: Question<S::Vector>>(
        &self,
        (index, from): (usize, ScalarOf<S>),
        question: &Q,
        limit: ScalarOf<S>,
        nodes: &mut usize,
        tell: &mut impl FnMut(Id, ScalarOf<S>, Asked<'_, '_, S>) -> ControlFlow<(), ScalarOf<S>>,
    ) -> ControlFlow<(), ScalarOf<S>> {
        match self {
            Self::Body(body) => tell(Id::of(index), from, Asked::Own(body)),
            Self::Instance(instance) => {
                instance.search(question, (from, limit), nodes, &mut |number, from, placed, around| {
                    tell(Id { body: index, member: Some(number) }, from, Asked::Member(placed, around))
                })
            }
        }
    }
}
