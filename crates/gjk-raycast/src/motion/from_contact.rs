//! Searches for bodies that begin in contact: when do they get deeper than they began, or touch again?
//!
//! This is the same search, with distances measured from another [level](Base::level), since a [free
//! interval](super::free_interval) proves that the signed distance stays above a level just as it proves that the
//! bodies stay apart. At first the level is a slack below the signed distance at the start, so that the bodies begin
//! above it. When they are proved to be less deep than that, the level rises to the signed distance at the start. The
//! time when they come back there is then known as well as any contact. When they are apart, the level rises to 0.
//!
//! Bodies that overlap at two times may have been apart in between, and have met again. So while they overlap by more
//! than the slack, the search goes on over an interval only if they are proved to [stay in contact](super::in_contact)
//! in it. The ends of such intervals come as near to the time when the bodies part as rounding allows. From there on,
//! and if the bodies only touch at the start, the level is just below contact: bodies that part and meet again come
//! below it, unless they overlap by no more than the slack.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{MotionEnd, Search};
use super::instant::{Base, Instant, ROUNDED, Stage};
use crate::Status;

/// By how much the bodies have to be deeper than they began, in ε of their sizes. The rounding of their places at the
/// time is added, [`ROUNDED`] times.
const DEEPER: f64 = 16.0;

/// If the bodies have sunk by a power of time that is no higher than this, they are taken to have sunk from the start
/// on.
const POWER: f64 = 4.0;

/// If bodies are still as deep as they began after this many looks, the number of looks to come is estimated.
const MANY_LOOKS: usize = 500;

/// Bodies that are deeper than this at the start, in units of the slack, are known to overlap a moment later too, when
/// their places are rounded by more.
const DEEP_AT_START: f64 = 4.0;

/// The part of the time until the bodies part that the next interval may take.
const OUT: f64 = 0.9;

impl<V: Vector> Search<'_, V> {
    /// The answer if the bodies are not certainly apart at the start, and a contact at the start counts.
    pub(super) fn start_in_contact(&mut self) -> MotionEnd<V> {
        let zero = V::Scalar::ZERO;
        if self.near.overlaps() {
            self.upper = zero;
        }
        if !self.near.overlaps() && !(self.near.distance <= self.near.error) {
            // Neither contact nor distance is known, as with a support map that returns NaN.
            return MotionEnd::Undecided(Status::Stalled);
        }
        if !self.near.overlaps() && self.near.closing > zero {
            // They touch to rounding. The bracket ends when they overlap.
            let touching = self.near;
            let _ = self.close_in();
            self.near = touching;
        }
        MotionEnd::Contact
    }

    /// The answer if the bodies are not certainly apart at the start, and only a contact after the start counts.
    pub(super) fn begin_in_contact(&mut self) -> MotionEnd<V> {
        let number = V::Scalar::from_f64;
        let Instant { gap, distance, upper, error, .. } = self.near;
        let slack = self.bodies.size() * V::Scalar::EPSILON * number(DEEPER) + error * number(2.0);
        if !(slack.is_finite() && distance <= error) {
            // Neither contact nor distance is known, as with a support map that returns NaN.
            return MotionEnd::Undecided(Status::Stalled);
        }
        let stage = if upper < slack * number(-DEEP_AT_START) { Stage::Deep } else { Stage::Touching };
        let (width, tolerance) = (upper - gap, self.options.tolerance);
        self.base = Base { start: distance, highest: upper, width, slack, tolerance, ..Base::default() };
        self.options.tolerance = V::Scalar::ZERO;
        self.raise(stage, gap - slack);
        match self.advance() {
            // They may have parted before this contact, or may not have parted.
            MotionEnd::Contact if self.base.stage == Stage::Surfaced => {
                self.upper = V::Scalar::infinity();
                MotionEnd::Undecided(Status::Stalled)
            }
            end => end,
        }
    }

    /// Raises the level, if the bodies are certainly above a higher one.
    pub(super) fn rise(&mut self) {
        let Base { stage, highest, slack, .. } = self.base;
        let Instant { gap, upper, error, .. } = self.truly(self.near);
        if gap > V::Scalar::ZERO {
            self.raise(Stage::Apart, V::Scalar::ZERO);
            self.options.tolerance = self.base.tolerance;
        } else if self.base.overlaps() && !(upper < -slack) {
            self.base.since = self.near.time;
            // What comes after may have as large an error.
            self.raise(Stage::Surfaced, gap - slack - error * V::Scalar::from_f64(ROUNDED));
        } else if stage == Stage::Deep && gap > highest + slack + error * V::Scalar::from_f64(ROUNDED) {
            self.raise(Stage::Risen, highest);
        }
    }

    fn raise(&mut self, stage: Stage, level: V::Scalar) {
        let known = [Some(self.near), self.beyond, self.farther];
        let known = known.map(|there| there.map(|there| self.truly(there)));
        (self.base.stage, self.base.level) = (stage, level);
        let [near, beyond, farther] = known.map(|there| there.map(|there| self.measured(there)));
        let near = near.unwrap_or(self.near);
        self.before = self.before.above(self.near.distance - near.distance);
        (self.near, self.beyond, self.farther) = (near, beyond, farther);
    }

    /// An instant that is measured from the level, with its distances measured from contact.
    fn truly(&self, there: Instant<V>) -> Instant<V> {
        self.shifted(there, -V::Scalar::ONE)
    }

    pub(super) fn shifted(&self, there: Instant<V>, by: V::Scalar) -> Instant<V> {
        let Base { level, stage, width, .. } = self.base;
        let loose = self.base.loose();
        let rounded = if loose > V::Scalar::ZERO { self.bodies.level(there.time, there.normal).1 } else { loose };
        let there = there.above((level - loose * rounded) * by);
        // The depth at the start is known only to its error. To be certainly deeper, the bodies have to be deeper than
        // the greatest depth that they may have begun with.
        let width = if stage == Stage::Risen { width } else { V::Scalar::ZERO };
        Instant { upper: there.upper + width * by, ..there }
    }

    /// Whether bodies that overlap certainly do so until a later time, so that they do not meet again before it.
    pub(super) fn stay_in_contact(&self, there: &Instant<V>) -> bool {
        let upper = self.truly(self.near).upper.max(self.truly(*there).upper);
        upper < V::Scalar::ZERO && self.bodies.stay_in_contact(&self.near, there, -upper)
    }

    /// The latest time to look at while the bodies overlap: no more than two steps like the last one ahead, and not
    /// after they are expected to part.
    pub(super) fn within(&self, next: V::Scalar) -> V::Scalar {
        if !self.base.overlaps() {
            return next;
        }
        let Instant { time, upper, closing, .. } = self.truly(self.near);
        let out = upper / closing * V::Scalar::from_f64(OUT);
        let step = self.step() + self.step();
        let step = if closing < V::Scalar::ZERO && out < step { out } else { step };
        // After a step of no length at all, this is the next number.
        if next > time + step && time + step > time { time + step } else { next }
    }

    /// Whether bodies that are still as deep as they began would take more looks until the end than are left. A body
    /// that rolls may roll over an edge at any time, so that the search comes on only by steps that shrink with the
    /// slack.
    pub(super) fn is_endless(&self) -> bool {
        let rest = self.options.max_time - self.near.time;
        let left = self.options.max_iterations.saturating_sub(self.looks);
        self.looks > MANY_LOOKS
            && matches!(self.base.stage, Stage::Touching | Stage::Deep)
            && self.step() * V::Scalar::from_f64(left as f64) < rest
    }

    /// The time when bodies that are about to get deeper than they began do so.
    pub(super) fn time_of_sinking(&self) -> V::Scalar {
        let Instant { time, error, closing, .. } = self.near;
        // The depth that they have gained since the start.
        let sunk = self.base.start - self.truly(self.near).distance + error * V::Scalar::from_f64(2.0);
        let since = sunk / closing;
        match time > since * V::Scalar::from_f64(POWER) {
            _ if !(closing > V::Scalar::ZERO) => time,
            true => time - since,
            false => V::Scalar::ZERO,
        }
    }
}
