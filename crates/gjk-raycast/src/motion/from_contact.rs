//! Searches that begin in contact, and ask when the bodies get deeper than they began, or touch again.
//!
//! They are the same search with distances measured from another [level](Base::level), since a [free
//! interval](super::free_interval) proves as well that the bodies come no deeper than to a level as that they stay
//! apart. At first the level is a slack below where they began, as they are then above it by that. It rises when they
//! are proved to be higher: to where they began, so that when they are there again is known as well as any contact, and
//! to 0 when they are apart.
//!
//! Bodies that overlap at two times may have been apart in between, and have met again. So while they overlap by more
//! than the slack, an interval is taken only if they are proved to [stay in contact](super::in_contact) in it. The ends
//! of such intervals come to where the bodies part as near as rounding lets them. There, and where they only touch at
//! the start, a level just below contact does as well: bodies that part and meet again come below it, unless they meet
//! by no more than the slack.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{MotionEnd, Search};
use super::instant::{Base, Instant, ROUNDED, Stage};
use crate::Status;

/// How much deeper than they began counts as deeper: so many ε of the bodies' sizes, and [so many times](ROUNDED)
/// what their places are rounded by at the time.
const SLACK: f64 = 16.0;

/// Bodies that sink by a power of time no higher than this have sunk from the start on, as far as can be told.
const POWER: f64 = 4.0;

/// After how many looks at bodies as deep as they began it is foreseen how many are to come.
const LONG: usize = 500;

/// How deep bodies are, in units of the slack, that are known to overlap a moment later too, where their places are
/// rounded by more.
const DEEP: f64 = 4.0;

/// How much of the way out of an overlap is asked for at once.
const OUT: f64 = 0.9;

impl<V: Vector> Search<'_, V> {
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

    /// What to answer where the bodies are not certainly apart at the start, and only what comes after it counts.
    pub(super) fn begin_in_contact(&mut self) -> MotionEnd<V> {
        let number = V::Scalar::from_f64;
        let Instant { gap, distance, upper, error, .. } = self.near;
        let slack = self.bodies.size() * V::Scalar::EPSILON * number(SLACK) + error * number(2.0);
        if !(slack.is_finite() && distance <= error) {
            // Neither is known, such as of a support map that returns NaN.
            return MotionEnd::Undecided(Status::Stalled);
        }
        let stage = if upper < slack * number(-DEEP) { Stage::Deep } else { Stage::Touching };
        let (width, tolerance) = (upper - gap, self.options.tolerance);
        self.base = Base { start: distance, highest: upper, width, slack, tolerance, ..Base::default() };
        self.options.tolerance = V::Scalar::ZERO;
        self.raise(stage, gap - slack);
        match self.advance() {
            // They may have parted before, and touched again.
            MotionEnd::Contact if self.base.stage == Stage::Surfaced => {
                self.upper = V::Scalar::infinity();
                MotionEnd::Undecided(Status::Stalled)
            }
            end => end,
        }
    }

    /// Measures from the highest level that the bodies are certainly above.
    pub(super) fn rise(&mut self) {
        let Base { stage, highest, slack, .. } = self.base;
        let Instant { gap, upper, error, .. } = self.truly(self.near);
        if gap > V::Scalar::ZERO {
            self.raise(Stage::Apart, V::Scalar::ZERO);
            self.options.tolerance = self.base.tolerance;
        } else if self.base.overlaps() && !(upper < -slack) {
            self.base.since = self.near.time;
            // What comes after may be known no better.
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

    /// What is seen at a time, measured from the level.
    pub(super) fn measured(&self, there: Instant<V>) -> Instant<V> {
        if self.base.stage == Stage::Apart { there } else { self.shifted(there, V::Scalar::ONE) }
    }

    /// What is measured from the level, as it was seen.
    fn truly(&self, there: Instant<V>) -> Instant<V> {
        self.shifted(there, -V::Scalar::ONE)
    }

    fn shifted(&self, there: Instant<V>, by: V::Scalar) -> Instant<V> {
        let Base { level, stage, width, .. } = self.base;
        let loose = self.base.loose();
        let rounded = if loose > V::Scalar::ZERO { self.bodies.level(there.time, there.normal).1 } else { loose };
        let there = there.above((level - loose * rounded) * by);
        // To be certainly deeper than they began takes more than to be not certainly less deep.
        let width = if stage == Stage::Risen { width } else { V::Scalar::ZERO };
        Instant { upper: there.upper + width * by, ..there }
    }

    /// Whether bodies that overlap do so until a later time, so that they cannot have met again before.
    pub(super) fn stay_in_contact(&self, there: &Instant<V>) -> bool {
        if !self.base.overlaps() {
            return true;
        }
        let upper = self.truly(self.near).upper.max(self.truly(*there).upper);
        upper < V::Scalar::ZERO && self.bodies.stay_in_contact(&self.near, there, -upper)
    }

    /// Where to look at most, of bodies that overlap: not much farther than the last step went, nor beyond where they
    /// part.
    pub(super) fn within(&self, next: V::Scalar) -> V::Scalar {
        if !self.base.overlaps() {
            return next;
        }
        let Instant { time, upper, closing, .. } = self.truly(self.near);
        let out = upper / closing * V::Scalar::from_f64(OUT);
        let step = self.step() + self.step();
        let step = if closing < V::Scalar::ZERO && out < step { out } else { step };
        // Of no step at all, the next number.
        if next > time + step && time + step > time { time + step } else { next }
    }

    /// Whether bodies that are still as deep as they began would take more looks until the end than there are left.
    /// Every moment of what rolls may be an edge, so that it comes on by steps that shrink with the slack.
    pub(super) fn is_endless(&self) -> bool {
        let rest = self.options.max_time - self.near.time;
        let left = self.options.max_iterations.saturating_sub(self.looks);
        self.looks > LONG
            && matches!(self.base.stage, Stage::Touching | Stage::Deep)
            && self.step() * V::Scalar::from_f64(left as f64) < rest
    }

    /// Up to when nothing that counts has happened: the bodies may have sunk by less than the slack from the start on.
    pub(super) fn lower(&self) -> V::Scalar {
        match self.base.stage {
            Stage::Apart | Stage::Risen => self.near.time,
            Stage::Touching | Stage::Deep => V::Scalar::ZERO,
            Stage::Surfaced => self.base.since,
        }
    }

    /// When the bodies touch, or get deeper than they began, which they are about to do.
    pub(super) fn time_of_contact(&self) -> V::Scalar {
        let Instant { time, gap, distance, error, closing, .. } = self.near;
        let zero = V::Scalar::ZERO;
        if matches!(self.base.stage, Stage::Touching | Stage::Deep) {
            // Since they were as deep as at the start.
            let sunk = self.base.start - self.truly(self.near).distance + error * V::Scalar::from_f64(2.0);
            let since = sunk / closing;
            return match time > since * V::Scalar::from_f64(POWER) {
                _ if !(closing > zero) => time,
                true => time - since,
                false => zero,
            };
        }
        let step = distance / closing;
        // Where they touch at the start, that is when they do.
        let step = if step > zero && gap > zero { step } else { zero };
        time + step
    }
}
