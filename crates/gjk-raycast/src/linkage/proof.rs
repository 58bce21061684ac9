//! What proves that a path, or a box of joint values, is free: shown to who wants to see it, and kept by nobody.

use convex_support::{Scalar as _, Vector};

use super::result::Met;
use crate::{MotionCast, MotionIterate, Outcome};

/// A body of a link that is proved to be apart from another, for a part of an edge.
///
/// A plane between them proves it: one across the first normal, or across the second, or one whose normal goes straight,
/// at a constant rate, from the one to the other. At all times of the interval the bodies are apart along one of these by
/// more than the target distance. Two bodies are free along an edge if such intervals cover it. That can be checked with
/// the positions of the joints alone, and a bound on how far points leave the chords of their ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeInterval<V: Vector> {
    /// The edge, counted from 0.
    pub edge: usize,
    /// The times in it from which and to which they are apart.
    pub from: V::Scalar,
    /// The end.
    pub to: V::Scalar,
    /// The link.
    pub link: usize,
    /// Its body.
    pub body: usize,
    /// What it does not meet.
    pub met: Met,
    /// The normals at the ends, towards the link, of length 1 to rounding: in the world, or for a body of another link
    /// in the frame of that one's joint.
    pub normals: [V; 2],
}

/// A part of a box of joint values in which two bodies are proved to be apart: one plane separates them, by more than
/// the target distance, at all values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBox<'b, V: Vector> {
    /// The body of the first link and that of the second.
    pub bodies: [usize; 2],
    /// The interval of each joint value.
    pub joint_box: &'b [[V::Scalar; 2]],
    /// The normal of the plane, in the frame of the second link's joint, towards the first.
    pub normal: V,
}

/// What a cast has proved so far, by the times that it has looked at: each that its lower bound has come to is the end
/// of an interval from the one before. Both are remembered with the normals there: the last end, and the last look.
pub(super) struct ProvedSteps<V: Vector> {
    last: Option<(V::Scalar, V)>,
    seen: Option<(V::Scalar, V)>,
}

impl<V: Vector> ProvedSteps<V> {
    pub(super) const NONE: Self = Self { last: None, seen: None };

    pub(super) fn see(&mut self, there: &MotionIterate<V>, show: impl FnMut([V::Scalar; 2], [V; 2])) {
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

    /// What the answer says beyond that: a miss, along one plane, from the last time on.
    pub(super) fn end(mut self, cast: &MotionCast<V>, mut show: impl FnMut([V::Scalar; 2], [V; 2])) {
        self.come_to(cast.lower, &mut show);
        let from = self.last.map_or(V::Scalar::ZERO, |(time, _)| time);
        if let Outcome::Miss(miss) = &cast.outcome
            && (from < cast.lower || cast.lower == V::Scalar::ZERO)
        {
            show([from, cast.lower], [miss.axis; 2]);
        }
    }
}
