//! The search for the first contact of two moving bodies, its options and its answer.
//!
//! The search proves free intervals, one after the other from time 0 on ([`free_interval`](super::free_interval)). How
//! it chooses their ends decides only how many there are. Far from contact the end is put as far away as can be
//! expected to be proved. If the bodies close in so fast that a contact can be expected before that, the end is put
//! there, by Newton's method on the distance.
//!
//! The strategy is [`Search::advance`], from top to bottom. The time of the next look is in
//! [`next_time`](super::next_time), and what is different for bodies that begin in contact in
//! [`from_contact`](super::from_contact).

use convex_support::numerics::range::is_comfortable;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::free_interval::acceleration_if_free;
use super::instant::{Approach, Base, Instant, Limits, NEAR_IN_MOTION, Stage};
use super::trajectory::TurningPlane;
use crate::options::{MayBeLean as _, Rare, options};
use crate::{Cast, Impact, LinearCastOptions, Miss, Outcome, StartInContact, Status, WarmStart};

/// The distance at which the search for a contact aims, in units of the error of the distance. It is on the near side
/// of the contact, and hardly nearer than can be told from it.
pub(super) const AIM: f64 = 1.5;
/// How often in a row neither the interval nor the distance may have been halved before the search halves the interval
/// itself.
pub(super) const IDLE_LOOKS: u8 = 2;

/// How deep the overlap is to be that ends a bracket, in units of the error of the distance.
const DEPTH: f64 = 2.0;

/// After a graze the search goes on until the bodies are apart again by this many times the distance at which it
/// stopped before the graze: only then can it be seen whether they have passed through one another.
const GRAZE: f64 = 16.0;

/// How deep the bodies may be at the upper bound of a converged answer: so many roundings of their size, or so many
/// errors of their distance. It is half of what `docs/evidence.md` says of both bounds.
pub(super) const NARROW_AT_END: f64 = 512.0;
pub(super) const NARROW_OF_ERROR: f64 = 8.0;

/// If the normal has turned in a step by more than the root of this, in radians, the next step is not expected to be
/// like it.
const TURNED_FAR: f64 = 0.25;

/// Times to examine in a motion cast, after which to give up. A contact takes about ten, and each turn near another
/// body about as many; bodies that spin for long very near one another take the most.
const MAX_LOOKS: usize = 10_000;

/// Options of [`motion_cast`](crate::motion_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. A negative value is taken for zero. Default: infinity. Set an
    /// end if a body spins: no finite search can prove that a spinning body never touches another one, and the answer
    /// is undecided after [`max_iterations`](Self::max_iterations).
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the search. Default: 0.
    pub tolerance: V::Scalar,
    /// The distance at which bodies count as touching: the cast stops that far from contact. A negative value is taken
    /// for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer if the bodies touch at the start. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// A first guess of the direction from `b` to `a` at the start, such as the axis of the last miss. Default: none.
    pub axis: Option<V>,
    /// The number of times to examine, after which to give up; each takes a few support points, which
    /// [`MotionCast::iterations`](crate::MotionCast::iterations) counts. Default: 10 000.
    pub max_iterations: usize,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) rare: Rare<Self>,
}

impl<V: Vector> Default for MotionCastOptions<V> {
    fn default() -> Self {
        Self { rare: Self::rare(), ..Self::lean() }
    }
}

impl<V: Vector> MotionCastOptions<V> {
    /// The default options, with no machine code besides GJK, closed forms, and the closest points of the last time: a
    /// program in which all options are lean has under two fifths of the code for motion casts.
    ///
    /// The search then does without the shortest way out of an overlap, the facets of two boxes, the proof that bodies
    /// without an inside have passed through one another, and the linear cast, so that motions that do not turn are
    /// searched like those that do. It takes more support points, the bracket may be wider, and a contact that is not
    /// certain, or a graze, may be undecided where the default options decide. With [`StartInContact::IfDeeper`], a
    /// start that may be in contact may be undecided too.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            axis: None,
            max_iterations: MAX_LOOKS,
            rare: Rare(None),
        }
    }

    /// The options of the linear cast for a motion that does not turn, without the machine code they name.
    pub(crate) fn straight(&self) -> LinearCastOptions<V> {
        let &Self { max_time, tolerance, target_distance, start_in_contact, axis, max_iterations, .. } = self;
        let warm_start = axis.map(WarmStart::new);
        let lean = LinearCastOptions::lean();
        LinearCastOptions { max_time, tolerance, target_distance, start_in_contact, warm_start, max_iterations, ..lean }
    }
}

options! {
    MotionCastOptions: with_max_time(max_time: V::Scalar), with_tolerance(tolerance: V::Scalar),
    with_target_distance(target_distance: V::Scalar), with_start_in_contact(start_in_contact: StartInContact),
    with_axis(axis: V => axis = Some(axis)), with_max_iterations(max_iterations: usize)
}

/// The answer of [`motion_cast`](crate::motion_cast).
pub type MotionCast<V> = Cast<Impact<V>, V>;

/// The state of a motion cast that an observer sees at every time examined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionIterate<V: Vector> {
    /// Counts from 0.
    pub iteration: usize,
    /// The time examined.
    pub time: V::Scalar,
    /// The certain distance of a separating plane between the bodies then; not positive if none is known.
    pub gap: V::Scalar,
    /// The unit normal of that plane, from `b` to `a`.
    pub normal: V,
    /// The bodies have no point in common up to this time.
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time; infinite if none is known.
    pub upper: V::Scalar,
}

/// The state of the search. Up to the time of [`near`](Self::near) the bodies are proved to be apart.
pub(super) struct Search<'p, V: Vector> {
    pub(super) bodies: &'p mut dyn Approach<V>,
    pub(super) options: MotionCastOptions<V>,
    observer: &'p mut dyn FnMut(MotionIterate<V>),
    /// The level from which the distances of all instants are measured.
    pub(super) base: Base<V::Scalar>,
    /// The last time up to which the bodies are proved to be apart.
    pub(super) near: Instant<V>,
    /// The instant before it, from which the last step came. At the start it is the same instant, a unit of time
    /// earlier.
    pub(super) before: Instant<V>,
    /// The bound `M` that is to be expected in the next step: that of the last step. At the start it is the bound along
    /// a plane that does not turn.
    pub(super) acceleration: V::Scalar,
    /// A later time at which they are apart. It is not proved that they are so in between.
    pub(super) ahead: Option<Instant<V>>,
    /// The earliest time known at which they are not certainly apart.
    pub(super) beyond: Option<Instant<V>>,
    /// The instant that was the earliest of these before.
    pub(super) farther: Option<Instant<V>>,
    /// The earliest time known at which they overlap.
    pub(super) upper: V::Scalar,
    /// The length of the interval in which the search expects a contact, the smaller distance from contact at its two
    /// ends, and how often in a row a look has halved neither of them.
    width: V::Scalar,
    way: V::Scalar,
    pub(super) slow: u8,
    pub(super) looks: usize,
}

/// Whether sums and products of a few lengths as large as this neither overflow nor are subnormal. About other lengths
/// the search proves nothing.
pub(super) fn is_in_range<S: Scalar>(measure: S) -> bool {
    is_comfortable(measure) && (measure * S::from_f64(65536.0)).is_finite()
}

/// How a search ended.
pub(super) enum MotionEnd<V> {
    Miss(V),
    Contact,
    Undecided(Status),
}

/// How a search begins in contact if only deeper motions count.
pub(super) type Begin<V> = fn(&mut Search<'_, V>) -> MotionEnd<V>;

impl<'p, V: Vector> Search<'p, V> {
    /// The first contact of two bodies up to the end of the motion.
    pub(super) fn run(
        bodies: &'p mut dyn Approach<V>,
        options: MotionCastOptions<V>,
        begin_in_contact: Option<Begin<V>>,
        observer: &'p mut dyn FnMut(MotionIterate<V>),
    ) -> MotionCast<V> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        if let Some(axis) = bodies.stays_far_apart([zero, options.max_time]) {
            let (outcome, lower) = (Outcome::Miss(Miss { axis }), options.max_time);
            return MotionCast { outcome, lower, upper: infinity, status: Status::Converged, iterations: 0 };
        }
        let mut search = match Self::begin(bodies, options, observer) {
            Ok(search) => search,
            Err(bodies) => {
                let (outcome, status) = (Outcome::Undecided, Status::Stalled);
                let iterations = bodies.iterations();
                return MotionCast { outcome, lower: zero, upper: infinity, status, iterations };
            }
        };
        let end = match options.start_in_contact {
            _ if search.near.gap > zero => search.advance(),
            StartInContact::Report => search.start_in_contact(),
            StartInContact::IfDeeper => {
                begin_in_contact.map_or(MotionEnd::Undecided(Status::Stalled), |begin| begin(&mut search))
            }
        };
        search.answer(end)
    }

    /// The search at the start, or, if the bodies' lengths are out of range, the bodies.
    #[inline(always)]
    pub(super) fn begin(
        bodies: &'p mut dyn Approach<V>,
        options: MotionCastOptions<V>,
        observer: &'p mut dyn FnMut(MotionIterate<V>),
    ) -> Result<Self, &'p mut dyn Approach<V>> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let axis = options.axis.unwrap_or_else(|| bodies.between()).unit().unwrap_or_else(|| Vector::axis(0));
        // The depth matters only if bodies that begin in contact are to leave one another.
        let leaves = options.start_in_contact == StartInContact::IfDeeper;
        let limits = Limits::new(infinity, if leaves { infinity } else { zero });
        let near = bodies.at(zero, axis, limits, false);
        let near = if near.gap > zero || near.is_close { near } else { bodies.at(zero, axis, limits, true) };
        let measure = bodies.size() + near.distance.abs() + bodies.speed_at(&near);
        if !(measure == zero || is_in_range(measure)) {
            return Err(bodies);
        }
        let plane = TurningPlane { from: near.normal, to: near.normal };
        let acceleration = bodies.acceleration_along(plane, [zero, Scalar::ONE]);
        let mut search = Self {
            bodies,
            options,
            observer,
            base: Base::default(),
            acceleration,
            before: Instant { time: -V::Scalar::ONE, ..near },
            near,
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
        Ok(search)
    }

    /// Goes on from a time at which the bodies are apart to the end of the motion, or to a contact: the strategy of the
    /// search. Each turn of the loop proves one more interval, or finds a time at which the bodies are not certainly
    /// apart.
    pub(super) fn advance(&mut self) -> MotionEnd<V> {
        let zero = V::Scalar::ZERO;
        while self.looks < self.options.max_iterations {
            // The whole motion is proved.
            let rest = [self.near.time, self.options.max_time];
            if !(rest[0] < rest[1]) {
                return MotionEnd::Miss(self.near.normal);
            }
            // Bodies that leave one another mostly do so for good, which balls around them prove without a look.
            if self.near.closing <= zero
                && self.upper == V::Scalar::infinity()
                && let Some(axis) = self.bodies.stays_far_apart(rest)
            {
                self.near.time = rest[1];
                return MotionEnd::Miss(axis);
            }
            // So near to contact no plane can be told from contact: what is left is a time at which they overlap. The
            // same holds if no time is left between those that are known.
            let time = if self.near.distance <= self.closest() { None } else { self.next_time() };
            let Some(time) = time else {
                match self.close_in() {
                    Some(end) => return end,
                    None => continue,
                }
            };
            let there = match self.base.stage {
                Stage::Apart => self.glance(time),
                // Bodies that began in contact: their steps may be too short to come to an end.
                _ if self.is_endless() => break,
                _ => self.look(self.within(time), Limits::new(zero, zero)),
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

    /// Once the bodies are as near to contact as can be told, looks for a time just after it at which they overlap.
    /// `None` if they are proved to be apart there, so that the search goes on.
    pub(super) fn close_in(&mut self) -> Option<MotionEnd<V>> {
        let (zero, two) = (V::Scalar::ZERO, V::Scalar::from_f64(2.0));
        let end = self.options.max_time.min(self.upper);
        let Instant { time, distance, upper, error, closing, .. } = self.near;
        // If the bodies seem to overlap, the distance is its own lower bound, and the upper bound tells its error.
        let error = if distance > zero { error } else { (upper - distance).max(self.bodies.size() * Scalar::EPSILON) };
        let error = error.max(self.closest() * Scalar::from_f64(0.25));
        let deep = distance.max(zero) + error * Scalar::from_f64(DEPTH);
        // The time that it takes to come so deep at the present speed, or from rest.
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
            let there = self.look(next, Limits::new(V::Scalar::infinity(), zero));
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
                // They are apart again, after a graze that cannot be told from a contact.
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

    /// Goes on to a time at which the bodies are apart, if it is proved that they are so until then. If it is not, the
    /// time is remembered.
    pub(super) fn advance_to(&mut self, there: &Instant<V>) -> bool {
        let proof = acceleration_if_free(&*self.bodies, &self.near, there, &self.base);
        let Some(acceleration) = proof.filter(|_| !self.base.overlaps() || self.stay_in_contact(there)) else {
            self.ahead = Some(*there);
            return false;
        };
        (self.before, self.near) = (self.near, *there);
        self.acceleration = acceleration;
        // If the normal has turned far, the next step will be less like the last one.
        let turned = self.turned();
        if turned.length_squared() > Scalar::from_f64(TURNED_FAR) {
            let plane = TurningPlane { from: there.normal, to: there.normal + turned };
            self.acceleration = self.bodies.acceleration_along(plane, [there.time, there.time + self.step()]);
        }
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

    /// The distance at which the bodies are near enough to contact for it to be bracketed.
    pub(super) fn closest(&self) -> V::Scalar {
        let from_f64 = V::Scalar::from_f64;
        let size = self.bodies.size() * self.options.tolerance * from_f64(0.25);
        (self.near.error * from_f64(2.0 * AIM)).max(size)
    }

    /// Counts how often in a row the search for a contact has halved neither the interval nor the distance.
    fn watch_progress(&mut self) {
        if let Some(beyond) = self.beyond {
            let half = V::Scalar::from_f64(0.5);
            let (width, way) = (beyond.time - self.near.time, self.near.distance.min(beyond.distance.abs()));
            let is_slow = width > self.width * half && way > self.way * half;
            self.slow = if is_slow { self.slow.saturating_add(1) } else { 0 };
            (self.width, self.way) = (width, way);
        }
    }

    /// The bodies at a time: exactly if they can be expected to be nearly in contact there, since Newton's method
    /// squares their distance, and roughly otherwise. If the search makes no progress towards a contact, they are
    /// looked at exactly too, since a rough distance may only make it seem that there is one.
    pub(super) fn glance(&mut self, time: V::Scalar) -> Instant<V> {
        let limits = Limits::new(self.enough_at(time), Scalar::ZERO);
        let Instant { distance, error, .. } = self.near;
        let is_near = distance * distance < error * self.bodies.size() * Scalar::from_f64(NEAR_IN_MOTION);
        if is_near || self.slow > IDLE_LOOKS {
            self.beyond = self.beyond.filter(|beyond| beyond.is_close);
            return self.look(time, limits);
        }
        let there = self.bodies.at(time, self.expected_normal(time), limits, false);
        self.looks += 1;
        self.show(&there);
        there
    }

    /// The duration of the last step.
    pub(super) fn step(&self) -> V::Scalar {
        self.near.time - self.before.time
    }

    /// The change of the normal in the last step.
    fn turned(&self) -> V {
        self.near.normal - self.before.normal
    }

    /// The unit normal at a time, if it goes on turning as it did in the last step, but no farther than it turned then.
    pub(super) fn expected_normal(&self, time: V::Scalar) -> V {
        let part = ((time - self.near.time) / self.step()).min(Scalar::ONE);
        (self.near.normal + self.turned() * part).unit().unwrap_or(self.near.normal)
    }

    /// The bodies at a time, as exactly as they can be known, which is shown to the observer.
    pub(super) fn look(&mut self, time: V::Scalar, mut limits: Limits<V::Scalar>) -> Instant<V> {
        let axis = self.expected_normal(time);
        if self.base.stage != Stage::Apart {
            limits = Limits::new(V::Scalar::infinity(), V::Scalar::infinity());
        }
        let there = self.bodies.at(time, axis, limits, true);
        self.looks += 1;
        self.show(&there);
        self.measured(there)
    }

    /// An instant with its distances measured from the level.
    pub(super) fn measured(&self, there: Instant<V>) -> Instant<V> {
        if self.base.stage == Stage::Apart { there } else { self.shifted(there, V::Scalar::ONE) }
    }

    /// The time up to which nothing that counts has happened. Bodies that are as deep as they began may have sunk by
    /// less than the slack from the start on.
    fn lower(&self) -> V::Scalar {
        match self.base.stage {
            Stage::Apart | Stage::Risen => self.near.time,
            Stage::Touching | Stage::Deep => V::Scalar::ZERO,
            Stage::Surfaced => self.base.since,
        }
    }

    /// The time when the bodies touch, or get deeper than they began, once they are about to do so.
    fn time_of_contact(&self) -> V::Scalar {
        if matches!(self.base.stage, Stage::Touching | Stage::Deep) {
            return self.time_of_sinking();
        }
        let Instant { time, gap, distance, closing, .. } = self.near;
        let step = distance / closing;
        // If they touch already, this is the time.
        if step > V::Scalar::ZERO && gap > V::Scalar::ZERO { time + step } else { time }
    }

    pub(super) fn show(&mut self, there: &Instant<V>) {
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

    /// Whether the bodies move against one another, within the bracket, by no more than a converged answer may leave
    /// open: by two levels of the last plane before contact, since the speed of the closest points tells nothing of
    /// others. Where that plane does not keep the bodies apart, the error of their distance may be that of a search
    /// that ended early: then the error is that of a level, which the acceleration lowers in between.
    fn is_narrow(&self) -> bool {
        let (number, Instant { time, normal, gap, error, .. }) = (V::Scalar::from_f64, self.near);
        let (zero, from, size) = (V::Scalar::ZERO, self.lower().min(time), self.bodies.size());
        let width = self.upper - from;
        if width <= zero {
            return true;
        }
        let narrow = |error: V::Scalar| {
            (size * V::Scalar::EPSILON * number(NARROW_AT_END)).max(error * number(NARROW_OF_ERROR))
                + size * self.options.tolerance
        };
        if from < time {
            // The last plane is of a later time than the first one of the bracket.
            return width * self.bodies.speed_at(&self.near) <= narrow(error);
        }
        let before = if self.base.stage == Stage::Apart { zero } else { self.bodies.level(time, normal).0 };
        let (level, rounded) = self.bodies.level(self.upper, normal);
        if gap > zero {
            return (before - level).abs() <= narrow(error);
        }
        let most = self.bodies.acceleration_along(TurningPlane { from: normal, to: normal }, [time, self.upper]);
        // NaN is not narrow.
        (before - level).abs() + most * width * width * number(0.125) <= narrow(rounded)
    }

    pub(super) fn answer(&self, end: MotionEnd<V>) -> MotionCast<V> {
        let Instant { time: near, point, normal, .. } = self.near;
        let mut lower = self.lower();
        let (mut outcome, status) = match end {
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
        let upper = outcome.until(self.options.max_time, self.upper, |hit| hit.time);
        let status = status.of(&outcome, upper < V::Scalar::infinity() && self.is_narrow());
        let iterations = self.bodies.iterations();
        MotionCast { outcome, lower, upper, status, iterations }
    }
}

/// The next larger number after a time, or one a little larger.
fn next_after<S: Scalar>(time: S) -> S {
    (time + time.abs() * S::EPSILON).max(time + S::min_positive_value())
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DQuat, DVec3};
    use convex_support::{Cuboid, Cylinder, InvalidShape, Posed};

    use crate::{MotionCastOptions, RigidMotion, SignedDistanceOptions, Status, motion_cast, signed_distance};

    /// A box that touches the end of a long cylinder, to rounding, turns into it: its closest point hardly approaches,
    /// and points far from there do. An upper bound at which the bodies are deep is not called converged.
    #[test]
    fn other_points_than_the_closest_ones_tell_how_deep_the_bodies_are() -> Result<(), InvalidShape> {
        let a = Posed::translated(Cuboid::new(DVec3::new(1.0, 3.0, 1.0))?, DVec3::new(1.0, 0.0, -4.0))?;
        let foot = DVec3::new(-3.1027516341722e-17, -2.001160870279456e-15, -2.2329694452591164);
        let b = Posed::translated(Cylinder::new(29870.989889679193, 0.76703055474088)?, foot)?;
        let angular_velocity = DVec3::new(-0.1386865502427681, -1.0045336016232225, -2.1258279487318488);
        let center = DVec3::new(4.516333359560323e-6, -3.4797474841359846e-6, 1.4865091804082592e-6);
        let velocity = DVec3::new(-1.570542421332175e-5, 4.5191803904694433e-7, -9.369990039898312e-6);
        let (motion, options) = (RigidMotion { velocity, angular_velocity, center }, MotionCastOptions::new());
        let cast = motion_cast(&a, motion, &b, RigidMotion::default(), options.with_max_time(2.0)).expect("a motion");
        assert!(cast.is_certain() && cast.outcome.is_hit(), "{cast:?}");
        let turn = DQuat::from_scaled_axis(angular_velocity * cast.upper);
        let shift = center - turn * center + velocity * cast.upper;
        let then = signed_distance(&Posed::new(a, turn, shift)?, &b, SignedDistanceOptions::new());
        assert!(cast.status != Status::Converged || then.lower > -3e4 * 1024.0 * f64::EPSILON, "{cast:?} {then:?}");
        Ok(())
    }
}
