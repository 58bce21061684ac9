//! The search for the first contact of two moving bodies.
//!
//! What is proved are free intervals, one after the other from time 0 on ([`free_interval`](super::free_interval)); how their ends are
//! chosen decides only how many there are. Far from contact an end is put as far away as can be expected to be proved. Where the
//! bodies close in fast enough for their contact to be within reach, it is put there, by Newton's method on the distance.

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::instant::{Instant, Limits, MovingPair, NEAR};
use super::next_time::PATIENCE;
use super::options::MotionCastOptions;
use super::result::{MotionCast, MotionHit, MotionIterate};
use super::trajectory::Trajectory;
use crate::{Miss, Outcome, StartInContact, Status};

/// Where to be when a contact is as near as can be told: its distance in units of what that may be wrong by.
pub(super) const AIM: f64 = 1.5;

/// The search, which has come to [`near`](Self::near).
pub(super) struct Search<'p, A: SupportMap + ?Sized, MA, B: SupportMap + ?Sized, MB, F> {
    pub(super) pair: &'p MovingPair<'p, A, MA, B, MB>,
    pub(super) options: MotionCastOptions<A::Vector>,
    observer: F,
    /// The last time up to which the bodies are proved apart.
    pub(super) near: Instant<A::Vector>,
    /// How long the last step was, and what the normal and the closing speed have changed in it.
    pub(super) step: ScalarOf<A>,
    pub(super) turned: A::Vector,
    pub(super) sped_up: ScalarOf<A>,
    /// Whether that foretells the next step: the same points were the closest ones all the way.
    pub(super) is_smooth: bool,
    /// A later time at which they are apart, though they may not be in between.
    pub(super) ahead: Option<Instant<A::Vector>>,
    /// The earliest time known at which they are not certainly apart.
    pub(super) beyond: Option<Instant<A::Vector>>,
    /// The earliest time known at which they overlap.
    pub(super) upper: ScalarOf<A>,
    /// How far apart the two ends of the search for a contact were, and how often in a row that was not halved.
    width: ScalarOf<A>,
    pub(super) slow: u8,
    pub(super) looks: usize,
}

/// How a search ended.
pub(super) enum End<V> {
    Miss(V),
    Contact,
    Undecided(Status),
}

impl<'p, A, MA, B, MB, F> Search<'p, A, MA, B, MB, F>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
    MA: Trajectory<Vector = A::Vector>,
    MB: Trajectory<Vector = A::Vector>,
    F: FnMut(MotionIterate<A::Vector>),
{
    /// The first contact of the pair up to the end of the motion.
    pub(super) fn run(
        pair: &'p MovingPair<'p, A, MA, B, MB>,
        options: MotionCastOptions<A::Vector>,
        observer: F,
    ) -> MotionCast<A::Vector> {
        let (zero, infinity) = (ScalarOf::<A>::ZERO, ScalarOf::<A>::infinity());
        if let Some(axis) = pair.stays_far_apart([zero, options.max_time]) {
            let (outcome, lower) = (Outcome::Miss(Miss { axis }), options.max_time);
            return MotionCast { outcome, lower, upper: infinity, status: Status::Converged, iterations: 0 };
        }
        let between = pair.a.core.origin - pair.b.core.origin;
        let axis = options.axis.unwrap_or(between).unit().unwrap_or_else(|| Vector::axis(0));
        // Which way out is the shortest matters only to bodies that are to leave one another.
        let leaves = options.start_in_contact == StartInContact::IfDeeper;
        let limits = Limits { distance: infinity, depth: if leaves { infinity } else { zero } };
        let near = pair.at(zero, axis, limits);
        let near = if near.gap > zero || near.is_close { near } else { pair.closely(zero, axis, limits) };
        let mut search = Self {
            pair,
            options,
            observer,
            near,
            step: Scalar::ONE,
            turned: A::Vector::ZERO,
            sped_up: zero,
            is_smooth: false,
            ahead: None,
            beyond: None,
            upper: infinity,
            width: infinity,
            slow: 0,
            looks: 1,
        };
        search.show(&near);
        let end = if near.gap > zero { search.advance() } else { search.start_in_contact() };
        search.answer(end)
    }

    /// From a time at which the bodies are apart to the end of the motion or to contact.
    pub(super) fn advance(&mut self) -> End<A::Vector> {
        let zero = ScalarOf::<A>::ZERO;
        while self.looks < self.options.max_iterations {
            let rest = [self.near.time, self.options.max_time];
            if !(rest[0] < rest[1]) {
                return End::Miss(self.near.normal);
            }
            if self.near.closing <= zero
                && self.upper == ScalarOf::<A>::infinity()
                && let Some(axis) = self.pair.stays_far_apart(rest)
            {
                self.near.time = rest[1];
                return End::Miss(axis);
            }
            let time = if self.near.distance <= self.closest() { None } else { self.next_time() };
            let Some(time) = time else {
                match self.close_in() {
                    Some(end) => return end,
                    None => continue,
                }
            };
            let there = self.glance(time);
            if there.gap > zero {
                self.ahead = Some(there);
            } else {
                self.block(&there);
            }
            self.take_ahead();
            self.watch_width();
        }
        End::Undecided(Status::IterationLimit)
    }

    /// Goes on to the time ahead, if the bodies are proved apart until then.
    pub(super) fn take_ahead(&mut self) -> bool {
        let Some(ahead) = self.ahead.filter(|ahead| self.pair.is_free(&self.near, ahead)) else { return false };
        self.step = ahead.time - self.near.time;
        self.turned = ahead.normal - self.near.normal;
        self.sped_up = ahead.closing - self.near.closing;
        self.is_smooth = self.pair.is_smooth(&self.near, &ahead);
        self.near = ahead;
        self.ahead = None;
        true
    }

    /// Remembers a time at which the bodies are not certainly apart.
    pub(super) fn block(&mut self, there: &Instant<A::Vector>) {
        self.beyond = Some(*there);
        self.ahead = None;
        if there.overlaps() {
            self.upper = there.time;
        }
    }

    /// How near to contact the bodies are to be brought before it is bracketed.
    pub(super) fn closest(&self) -> ScalarOf<A> {
        let from_f64 = ScalarOf::<A>::from_f64;
        let size = self.pair.size() * self.options.tolerance * from_f64(0.25);
        (self.near.error * from_f64(2.0 * AIM)).max(size)
    }

    /// Counts how often in a row the search for a contact has not come nearer by half.
    fn watch_width(&mut self) {
        if let Some(beyond) = self.beyond {
            let width = beyond.time - self.near.time;
            self.slow = if width <= self.width * Scalar::from_f64(0.5) { 0 } else { self.slow.saturating_add(1) };
            self.width = width;
        }
    }

    /// The bodies at a time; closely where they can be expected to be nearly in contact, since Newton's method squares their distance,
    /// and if the search does not come nearer to a contact, which from afar may only seem to be one.
    fn glance(&mut self, time: ScalarOf<A>) -> Instant<A::Vector> {
        let limits = Limits { distance: self.enough_at(time), depth: Scalar::ZERO };
        let Instant { distance, error, .. } = self.near;
        let is_near = distance * distance < error * self.pair.size() * Scalar::from_f64(NEAR);
        if is_near || self.slow > PATIENCE {
            self.beyond = self.beyond.filter(|beyond| beyond.is_close);
            return self.look(time, limits);
        }
        let there = self.pair.at(time, self.expected_normal(time), limits);
        self.looks += 1;
        self.show(&there);
        there
    }

    /// The unit normal at a time, if it turns on as it did in the last step, but no farther.
    pub(super) fn expected_normal(&self, time: ScalarOf<A>) -> A::Vector {
        let part = ((time - self.near.time) / self.step).min(Scalar::ONE);
        (self.near.normal + self.turned * part).unit().unwrap_or(self.near.normal)
    }

    /// The bodies at a time as well as it can be known, which the observer is shown.
    pub(super) fn look(&mut self, time: ScalarOf<A>, limits: Limits<ScalarOf<A>>) -> Instant<A::Vector> {
        let axis = self.expected_normal(time);
        let there = self.pair.closely(time, axis, limits);
        self.looks += 1;
        self.show(&there);
        there
    }

    fn show(&mut self, there: &Instant<A::Vector>) {
        (self.observer)(MotionIterate {
            iteration: self.looks - 1,
            time: there.time,
            gap: there.gap,
            normal: there.normal,
            lower: self.near.time,
            upper: self.upper,
        });
    }

    fn answer(&self, end: End<A::Vector>) -> MotionCast<A::Vector> {
        let Instant { time: lower, point, normal, gap, distance, closing, .. } = self.near;
        let (outcome, status) = match end {
            End::Miss(axis) => (Outcome::Miss(Miss { axis }), Status::Converged),
            End::Undecided(status) => (Outcome::Undecided, status),
            End::Contact => {
                let step = distance / closing;
                // Where they touch at the start, that is when they do.
                let step = if step > Scalar::ZERO && gap > Scalar::ZERO { step } else { Scalar::ZERO };
                let time = (lower + step).min(self.upper).min(self.options.max_time);
                let point = point + self.pair.b.velocity(lower, point) * (time - lower);
                let normal = if self.near.overlaps() { None } else { Some(normal) };
                (Outcome::Hit(MotionHit { time, point, normal }), Status::Converged)
            }
        };
        MotionCast { outcome, lower, upper: self.upper, status, iterations: self.pair.iterations() }
    }
}
