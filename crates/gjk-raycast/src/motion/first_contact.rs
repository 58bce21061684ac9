//! The search for the first contact of two moving bodies.
//!
//! What is proved are free intervals, one after the other from time 0 on ([`free_interval`](super::free_interval)); how
//! their ends are chosen decides only how many there are. Far from contact an end is put as far away as can be expected
//! to be proved. Where the bodies close in fast enough for their contact to be within reach, it is put there, by
//! Newton's method on the distance.

use convex_support::numerics::range::is_comfortable;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::free_interval::acceleration_if_free;
use super::from_contact::{Base, Stage};
use super::instant::{Approach, Instant, Limits, NEAR};
use super::motion_cast::{MotionCastOptions, MotionIterate};
use super::trajectory::TurningPlane;
use crate::{Impact, Miss, MotionCast, Outcome, StartInContact, Status};

/// Where to be when a contact is as near as can be told: its distance in units of what that may be wrong by.
pub(super) const AIM: f64 = 1.5;
/// How often in a row the search for a contact may come nearer by less than half before it halves the interval.
pub(super) const PATIENCE: u8 = 2;

/// How much deeper than touching an overlap is looked for, in units of what the distance may be wrong by.
const DEPTH: f64 = 2.0;

/// How far apart again bodies are looked at after a graze, in units of how near to contact they were brought: that they
/// have passed through one another takes some errors to show.
const GRAZE: f64 = 16.0;

/// The square of an angle, in radians, that is too far for a normal to have turned for a step to be like the one
/// before.
const FAR: f64 = 0.25;

/// The search, which has come to [`near`](Self::near).
pub(super) struct Search<'p, V: Vector> {
    pub(super) bodies: &'p dyn Approach<V>,
    pub(super) options: MotionCastOptions<V>,
    observer: &'p mut dyn FnMut(MotionIterate<V>),
    /// From where the distances of all instants are measured.
    pub(super) base: Base<V::Scalar>,
    /// The last time up to which the bodies are proved apart.
    pub(super) near: Instant<V>,
    /// How long the last step was, how much nearer the bodies came in it, and what the normal and the closing speed
    /// have changed.
    pub(super) step: V::Scalar,
    pub(super) came_nearer: V::Scalar,
    pub(super) turned: V,
    pub(super) sped_up: V::Scalar,
    /// The bound `M` to be expected of a step like it; at the start, along a plane that does not turn.
    pub(super) acceleration: V::Scalar,
    /// Whether that predicts the next step: the same points were the closest ones all the way.
    pub(super) is_smooth: bool,
    /// A later time at which they are apart, though they may not be in between.
    pub(super) ahead: Option<Instant<V>>,
    /// The earliest time known at which they are not certainly apart.
    pub(super) beyond: Option<Instant<V>>,
    /// The one that was the earliest before.
    pub(super) farther: Option<Instant<V>>,
    /// The earliest time known at which they overlap.
    pub(super) upper: V::Scalar,
    /// How far apart the two ends of the search for a contact were, and how far the bodies were from touching at the
    /// nearer of them; and how often in a row neither was halved.
    width: V::Scalar,
    way: V::Scalar,
    pub(super) slow: u8,
    pub(super) looks: usize,
}

/// Whether sums and products of a few lengths as large as this neither overflow nor lose digits as they are subnormal.
/// Of others the search proves nothing.
fn is_in_range<S: Scalar>(measure: S) -> bool {
    is_comfortable(measure) && (measure * S::from_f64(65536.0)).is_finite()
}

/// How a search ended.
pub(super) enum MotionEnd<V> {
    Miss(V),
    Contact,
    Undecided(Status),
}

impl<'p, V: Vector> Search<'p, V> {
    /// The first contact of two bodies up to the end of the motion.
    pub(super) fn run(
        bodies: &'p dyn Approach<V>,
        options: MotionCastOptions<V>,
        observer: &'p mut dyn FnMut(MotionIterate<V>),
    ) -> MotionCast<V> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        if let Some(axis) = bodies.stays_far_apart([zero, options.max_time]) {
            let (outcome, lower) = (Outcome::Miss(Miss { axis }), options.max_time);
            return MotionCast { outcome, lower, upper: infinity, status: Status::Converged, iterations: 0 };
        }
        let axis = options.axis.unwrap_or_else(|| bodies.between()).unit().unwrap_or_else(|| Vector::axis(0));
        // Which way out is the shortest matters only to bodies that are to leave one another.
        let leaves = options.start_in_contact == StartInContact::IfDeeper;
        let limits = Limits { distance: infinity, depth: if leaves { infinity } else { zero } };
        let near = bodies.at(zero, axis, limits, false);
        let near = if near.gap > zero || near.is_close { near } else { bodies.at(zero, axis, limits, true) };
        let measure = bodies.size() + near.distance.abs() + bodies.speed_at(&near);
        if !(measure == zero || is_in_range(measure)) {
            let (outcome, status) = (Outcome::Undecided, Status::Stalled);
            return MotionCast { outcome, lower: zero, upper: infinity, status, iterations: bodies.iterations() };
        }
        let plane = TurningPlane { from: near.normal, to: near.normal };
        let mut search = Self {
            bodies,
            options,
            observer,
            base: Base::default(),
            acceleration: bodies.acceleration_along(plane, [zero, Scalar::ONE]),
            near,
            step: Scalar::ONE,
            came_nearer: zero,
            turned: V::ZERO,
            sped_up: zero,
            is_smooth: false,
            ahead: None,
            beyond: None,
            farther: None,
            upper: infinity,
            width: infinity,
            way: infinity,
            slow: 0,
            looks: 1,
        };
        search.show(&near);
        let end = match options.start_in_contact {
            _ if near.gap > zero => search.advance(),
            StartInContact::Report => search.start_in_contact(),
            StartInContact::IfDeeper => match options.extra.get() {
                Some(extra) => (extra.begin_in_contact)(&mut search),
                None => MotionEnd::Undecided(Status::Stalled),
            },
        };
        search.answer(end)
    }

    /// From a time at which the bodies are apart to the end of the motion or to contact.
    pub(super) fn advance(&mut self) -> MotionEnd<V> {
        let zero = V::Scalar::ZERO;
        while self.looks < self.options.max_iterations {
            let rest = [self.near.time, self.options.max_time];
            if !(rest[0] < rest[1]) {
                return MotionEnd::Miss(self.near.normal);
            }
            if self.near.closing <= zero
                && self.upper == V::Scalar::infinity()
                && let Some(axis) = self.bodies.stays_far_apart(rest)
            {
                self.near.time = rest[1];
                return MotionEnd::Miss(axis);
            }
            let time = if self.near.distance <= self.closest() { None } else { self.next_time() };
            let Some(time) = time else {
                match self.close_in() {
                    Some(end) => return end,
                    None => continue,
                }
            };
            let there = match self.base.stage {
                Stage::Apart => self.glance(time),
                _ if self.is_endless() => break,
                _ => self.look(self.within(time), Limits { distance: zero, depth: zero }),
            };
            if there.gap > zero {
                self.advance_to(&there);
            } else {
                self.block(&there);
            }
            self.watch_progress();
        }
        MotionEnd::Undecided(Status::IterationLimit)
    }

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

    /// Goes on to a time at which the bodies are apart, if they are proved to be so until then; if not, that is
    /// remembered.
    pub(super) fn advance_to(&mut self, there: &Instant<V>) -> bool {
        let Some(acceleration) =
            acceleration_if_free(self.bodies, &self.near, there, &self.base).filter(|_| self.stay_in_contact(there))
        else {
            self.ahead = Some(*there);
            return false;
        };
        self.step = there.time - self.near.time;
        self.came_nearer = self.near.distance - there.distance;
        self.turned = there.normal - self.near.normal;
        self.acceleration = acceleration;
        // A normal that has turned far makes the next step less like the last one.
        if self.turned.length_squared() > Scalar::from_f64(FAR) {
            let plane = TurningPlane { from: there.normal, to: there.normal + self.turned };
            self.acceleration = self.bodies.acceleration_along(plane, [there.time, there.time + self.step]);
        }
        self.sped_up = there.closing - self.near.closing;
        self.is_smooth = self.near.goes_smoothly_to(there);
        self.near = *there;
        self.ahead = None;
        if self.base.stage != Stage::Apart {
            self.rise();
        }
        true
    }

    /// Remembers a time at which the bodies are not certainly apart.
    pub(super) fn block(&mut self, there: &Instant<V>) {
        self.farther = self.beyond.replace(*there);
        self.ahead = None;
        if there.overlaps() {
            self.upper = there.time;
        }
    }

    /// How near to contact the bodies are to be brought before it is bracketed.
    pub(super) fn closest(&self) -> V::Scalar {
        let from_f64 = V::Scalar::from_f64;
        let size = self.bodies.size() * self.options.tolerance * from_f64(0.25);
        (self.near.error * from_f64(2.0 * AIM)).max(size)
    }

    /// Counts how often in a row the search for a contact has not come nearer by half.
    fn watch_progress(&mut self) {
        if let Some(beyond) = self.beyond {
            let half = V::Scalar::from_f64(0.5);
            let (width, way) = (beyond.time - self.near.time, self.near.distance.min(beyond.distance.abs()));
            let is_slow = width > self.width * half && way > self.way * half;
            self.slow = if is_slow { self.slow.saturating_add(1) } else { 0 };
            (self.width, self.way) = (width, way);
        }
    }

    /// The bodies at a time; closely where they can be expected to be nearly in contact, since Newton's method squares
    /// their distance, and if the search does not come nearer to a contact, which from afar may only seem to be one.
    fn glance(&mut self, time: V::Scalar) -> Instant<V> {
        let limits = Limits { distance: self.enough_at(time), depth: Scalar::ZERO };
        let Instant { distance, error, .. } = self.near;
        let is_near = distance * distance < error * self.bodies.size() * Scalar::from_f64(NEAR);
        if is_near || self.slow > PATIENCE {
            self.beyond = self.beyond.filter(|beyond| beyond.is_close);
            return self.look(time, limits);
        }
        let there = self.bodies.at(time, self.expected_normal(time), limits, false);
        self.looks += 1;
        self.show(&there);
        there
    }

    /// The unit normal at a time, if it turns on as it did in the last step, but no farther.
    pub(super) fn expected_normal(&self, time: V::Scalar) -> V {
        let part = ((time - self.near.time) / self.step).min(Scalar::ONE);
        (self.near.normal + self.turned * part).unit().unwrap_or(self.near.normal)
    }

    /// The bodies at a time as well as it can be known, which the observer is shown.
    pub(super) fn look(&mut self, time: V::Scalar, mut limits: Limits<V::Scalar>) -> Instant<V> {
        let axis = self.expected_normal(time);
        if self.base.stage != Stage::Apart {
            limits = Limits { distance: V::Scalar::infinity(), depth: V::Scalar::infinity() };
        }
        let there = self.bodies.at(time, axis, limits, true);
        self.looks += 1;
        self.show(&there);
        self.measured(there)
    }

    fn show(&mut self, there: &Instant<V>) {
        let lower = self.lower();
        (self.observer)(MotionIterate {
            iteration: self.looks - 1,
            time: there.time,
            gap: there.gap,
            normal: there.normal,
            lower,
            upper: self.upper,
        });
    }

    fn answer(&self, end: MotionEnd<V>) -> MotionCast<V> {
        let Instant { time: near, point, normal, .. } = self.near;
        let mut lower = self.lower();
        let (outcome, status) = match end {
            MotionEnd::Miss(axis) => {
                lower = near;
                (Outcome::Miss(Miss { axis }), Status::Converged)
            }
            MotionEnd::Undecided(status) => (Outcome::Undecided, status),
            MotionEnd::Contact => {
                let time = self.time_of_contact().min(self.upper).min(self.options.max_time);
                let (point, normal) = if !self.near.overlaps() {
                    (point + self.bodies.velocities(near, point)[1] * (time - near), Some(normal))
                } else if self.options.start_in_contact == StartInContact::Report {
                    (self.bodies.common_point(&self.near), None)
                } else {
                    (point, None)
                };
                (Outcome::Hit(Impact { time, point, normal }), Status::Converged)
            }
        };
        let (upper, iterations) = (self.upper, self.bodies.iterations());
        let status = status.of(&outcome, upper < V::Scalar::infinity());
        MotionCast { outcome, lower, upper, status, iterations }
    }
}

/// The next larger number of a time, or a little more.
fn next_after<S: Scalar>(time: S) -> S {
    (time + time.abs() * S::EPSILON).max(time + S::min_positive_value())
}
