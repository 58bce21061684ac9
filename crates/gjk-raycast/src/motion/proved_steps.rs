//! The proof that a cast in time leaves behind: the intervals in which one plane after the other keeps the bodies
//! apart. Only the observers of a proof keep them; a cast by itself has no use for them.

use convex_support::numerics::bound::roundings;
use convex_support::{Scalar as _, Vector};

use crate::{Impact, MotionCast, MotionIterate, Outcome};

/// The intervals that a cast has proved so far. Whenever the lower bound of the cast reaches the time that was examined
/// last, an interval ends there, which began where the one before ended. The last end and the time examined last are
/// kept, each with its normal.
pub(crate) struct ProvedSteps<V: Vector> {
    last: Option<(V::Scalar, V)>,
    seen: Option<(V::Scalar, V)>,
}

impl<V: Vector> ProvedSteps<V> {
    pub(crate) const NONE: Self = Self { last: None, seen: None };

    pub(crate) fn see(&mut self, there: &MotionIterate<V>, show: impl FnMut([V::Scalar; 2], [V; 2])) {
        self.come_to(there.lower, show);
        self.seen = Some((there.time, there.normal));
    }

    fn come_to(&mut self, lower: V::Scalar, mut show: impl FnMut([V::Scalar; 2], [V; 2])) {
        let Some(there) = self.seen.take().filter(|(time, _)| *time <= lower) else { return };
        if let Some(last) = self.last.filter(|last| last.0 < there.0) {
            show([last.0, there.0], [last.1, there.1]);
        }
        self.last = Some(there);
    }

    /// Shows the interval that the answer adds: one plane proves the rest of the time before a miss, and, if nothing
    /// turns, all of the time before a contact, but for rounding.
    pub(crate) fn end(mut self, cast: &MotionCast<V>, mut show: impl FnMut([V::Scalar; 2], [V; 2])) {
        self.come_to(cast.lower, &mut show);
        let from = self.last.map_or(V::Scalar::ZERO, |(time, _)| time);
        match &cast.outcome {
            Outcome::Miss(miss) if from < cast.lower || cast.lower == V::Scalar::ZERO => {
                show([from, cast.lower], [miss.axis; 2]);
            }
            Outcome::Hit(Impact { normal: Some(normal), .. }) if self.last.is_none() && cast.lower > from => {
                let before = cast.lower - roundings(4.0, cast.lower);
                show([from, before], [*normal; 2]);
            }
            _ => {}
        }
    }
}
