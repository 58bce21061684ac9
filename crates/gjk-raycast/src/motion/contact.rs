//! Bodies in contact: bracketing the one that the search has come to, and what to answer where it starts in one.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{MotionEnd, Search};
use super::instant::{Instant, Limits, Stage};
use crate::Status;

/// How much deeper than touching an overlap is looked for, in units of what the distance may be wrong by.
const DEPTH: f64 = 2.0;

/// How far apart again bodies are looked at after a graze, in units of how near to contact they were brought: that they
/// have passed through one another takes some errors to show.
const GRAZE: f64 = 16.0;

impl<V: Vector> Search<'_, V> {
    /// Where the contact is as near as can be told: looks for a time just after it at which the bodies overlap. `None`
    /// where they are proved apart there, and the search goes on.
    pub(super) fn close_in(&mut self) -> Option<MotionEnd<V>> {
        let (zero, two) = (V::Scalar::ZERO, V::Scalar::from_f64(2.0));
        let end = self.options.max_time.min(self.upper);
        let Instant { time, distance, upper, error, closing, .. } = self.near;
        // Of what seems to overlap the distance is its own lower bound, and the other one tells how well it is known.
        let error = if distance > zero { error } else { (upper - distance).max(self.bodies.size() * Scalar::EPSILON) };
        let error = error.max(self.closest() * Scalar::from_f64(0.25));
        let deep = distance.max(zero) + error * Scalar::from_f64(DEPTH);
        // As fast as it closes, or after the time that it would take to come so deep from rest.
        let (at_speed, from_rest) = (deep / closing, (two * deep / self.acceleration.max(zero)).sqrt());
        let mut step = if closing > zero && at_speed < from_rest { at_speed } else { from_rest };
        while self.looks < self.options.max_iterations {
            let next = (time + step).max(next_after(time)).min(end);
            if !(next > time) {
                return Some(MotionEnd::Undecided(Status::Stalled));
            }
            if next >= self.upper {
                return Some(MotionEnd::Contact);
            }
            let there = self.look(next, Limits { distance: V::Scalar::infinity(), depth: zero });
            if there.overlaps() {
                self.upper = there.time;
                return Some(MotionEnd::Contact);
            }
            if there.gap > zero {
                if self.advance_to(&there) {
                    self.beyond = None;
                    return None;
                }
                if self.base.stage == Stage::Apart && self.bodies.pass_through(&self.near, there.time) {
                    self.upper = there.time;
                    return Some(MotionEnd::Contact);
                }
                // They are apart again after a graze that nobody can tell from a contact.
                if there.gap > self.closest() * V::Scalar::from_f64(GRAZE) && there.closing <= zero {
                    return Some(MotionEnd::Undecided(Status::Stalled));
                }
            }
            if next >= end {
                // The end belongs to the motion.
                let touches = there.distance <= zero && end == self.options.max_time;
                return Some(if touches { MotionEnd::Contact } else { MotionEnd::Undecided(Status::Stalled) });
            }
            step *= two;
        }
        Some(MotionEnd::Undecided(Status::IterationLimit))
    }

    /// What to answer where the bodies are not certainly apart at the start.
    pub(super) fn start_in_contact(&mut self) -> MotionEnd<V> {
        let zero = V::Scalar::ZERO;
        if self.near.overlaps() {
            self.upper = zero;
        }
        if !self.near.overlaps() && !(self.near.distance <= self.near.error) {
            // Neither is known, such as of a support map that returns NaN.
            return MotionEnd::Undecided(Status::Stalled);
        }
        if !self.near.overlaps() && self.near.closing > zero {
            // They touch to rounding: when do they overlap?
            let touching = self.near;
            let _ = self.close_in();
            self.near = touching;
        }
        MotionEnd::Contact
    }
}

/// The next larger number of a time, or a little more.
fn next_after<S: Scalar>(time: S) -> S {
    (time + time.abs() * S::EPSILON).max(time + S::min_positive_value())
}
