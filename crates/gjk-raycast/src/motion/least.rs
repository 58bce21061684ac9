//! The search for the least distance of two moving bodies.
//!
//! If the bodies never come as near as `u − w`, and are apart by `u` at some time, then their least distance is in
//! `[u − w, u]`. So the search first looks for a minimum: at a few times over the whole motion, and then beside the
//! time at which the bodies are nearest. The distance at the minimum, less a small width, is the target.
//! Then it proves from the start to the end, one interval after the other, that the bodies stay farther apart than the
//! target. The times that were looked at are the first ends of intervals; if an interval is not proved, another time in
//! it is looked at, and both parts are proved. Where the bodies come as near as the target, they descend to a further
//! minimum, and the target falls: what was proved before holds for the lower target too.
//!
//! # How long an interval can be
//! At the end where the gap is smaller, let it be `g`, and let the points that matter there bend by no more than
//! `κ + J·h` within the time `h` ([`bent_plane`](super::bent_plane)). With the gap `g'` that is expected after `h`,
//! the interval can be expected to be proved if `g' + 2·√(g·g') + g > h²·(κ + J·h)/2`.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::bent_plane::{Refuted, stay_apart};
use super::first_contact::is_in_range;
use super::free_interval::square_of_roots;
use super::instant::{Approach, Instant, Limits};
use super::trajectory::TurningPlane;
use crate::{MotionCastOptions, MotionIterate};

/// The width of the bracket to come, in errors of the distance, if rounding decides.
const WIDTH: f64 = 4.0;
/// The part of the tolerance that is used. The rest is for the error of the distance.
const PART: f64 = 0.875;
/// The number of instants, beside that of the start, among which the first minimum is looked for.
const SURVEY: usize = 4;
/// The number of looks on the way to one minimum, at most.
const DESCENT: usize = 60;
/// How often in a row neither the interval of a minimum nor the speed may be halved by a secant.
const IDLE_STEPS_DOWN: u8 = 2;
/// If the search has used half of its looks, the tolerance is no less than this.
const LOOSE: f64 = 1.0 / 1024.0;
/// The number of instants on the way to the first minimum that are kept as ends of intervals.
const MOST_KEPT: usize = 24;
/// How often an interval is shortened by its gaps. After that it is halved.
const DIVISIONS: usize = 64;
/// A bound on the rounding of the difference of a gap and the target, in ε.
const ROUNDING_OF_TARGET: f64 = 8.0;
/// Nearer to an end of an interval than this part of it, no minimum is expected.
const BESIDE_END: f64 = 1.0 / 64.0;
/// If the speeds of two instants differ by less than this many errors of their distances in the time between, rounding
/// decides what the distances say of a minimum.
const NOISE_OF_SPEED: f64 = 32.0;
/// The next interval is expected to be proved with this part of its gaps.
const CAUTION: f64 = 0.9;
/// Each interval that is tried is this part of the one before.
const SHORTER: f64 = 0.7;
/// The number of these.
const TRIES: usize = 32;

/// How the search ended.
pub(super) enum LeastEnd {
    /// The bodies are proved to be farther apart than the target, at all times.
    Proved,
    /// The bodies may touch.
    Touching,
    /// Their lengths are out of range, so that nothing is proved.
    OutOfRange,
    IterationLimit,
}

/// The state of the search. Distances are measured from contact.
pub(super) struct LeastSearch<'p, V: Vector> {
    bodies: &'p mut dyn Approach<V>,
    /// The tolerance is relative to the distance.
    options: MotionCastOptions<V>,
    observer: &'p mut dyn FnMut(MotionIterate<V>),
    /// Up to the time `proved` the bodies are farther apart than the target.
    pub(super) target: V::Scalar,
    pub(super) proved: V::Scalar,
    /// By how much the target falls where the bodies are not known to be any nearer than before.
    slack: V::Scalar,
    /// The instant at which they are nearest, as far as is known.
    pub(super) least: Instant<V>,
    /// The instants on the way to the first minimum, in the order of time.
    kept: [Instant<V>; MOST_KEPT],
    len: usize,
    pub(super) looks: usize,
}

impl<'p, V: Vector> LeastSearch<'p, V> {
    /// The search for the least distance, or for the proof that it is no less than a limit, which may be infinite.
    pub(super) fn run(
        bodies: &'p mut dyn Approach<V>,
        options: MotionCastOptions<V>,
        limit: V::Scalar,
        observer: &'p mut dyn FnMut(MotionIterate<V>),
    ) -> (LeastEnd, Self) {
        let zero = V::Scalar::ZERO;
        let axis = options.axis.unwrap_or_else(|| bodies.between()).unit().unwrap_or_else(|| Vector::axis(0));
        let start = bodies.at(zero, axis, exactly(), false);
        let mut search = Self {
            bodies,
            options,
            observer,
            target: zero,
            proved: zero,
            slack: zero,
            least: start,
            kept: [start; MOST_KEPT],
            len: 1,
            looks: 1,
        };
        search.show(&start);
        let measure = search.bodies.size() + start.distance.abs() + search.bodies.speed_at(&start);
        let end = if !(measure == zero || is_in_range(measure)) {
            LeastEnd::OutOfRange
        } else if !(start.gap > zero) {
            LeastEnd::Touching
        } else {
            search.search(limit).err().unwrap_or(LeastEnd::Proved)
        };
        (end, search)
    }

    fn search(&mut self, limit: V::Scalar) -> Result<(), LeastEnd> {
        let end = self.options.max_time;
        let start = self.kept[0];
        if start.gap > limit {
            self.target = limit;
            if end > V::Scalar::ZERO {
                let last = self.look(end, start.normal)?;
                self.keep(last);
            }
        } else {
            let local = self.survey()?;
            self.fall(&local, limit)?;
        }
        let mut k = 0;
        while k + 1 < self.len {
            let (from, to) = (self.kept[k], self.kept[k + 1]);
            let third = if k + 2 < self.len { Some(self.kept[k + 2]) } else { k.checked_sub(1).map(|k| self.kept[k]) };
            self.prove(from, to, third)?;
            k += 1;
        }
        Ok(())
    }

    /// Proves that the bodies stay farther apart than the target between two times. Of the parts of an interval the
    /// shorter one is proved first, so that intervals are nested no deeper than the number of bits of a time.
    fn prove(
        &mut self,
        mut from: Instant<V>,
        mut to: Instant<V>,
        mut third: Option<Instant<V>>,
    ) -> Result<(), LeastEnd> {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let (first, last, before) = (from.time, to.time, self.proved);
        let mut divisions = 0;
        loop {
            if self.looks >= self.options.max_iterations {
                return Err(LeastEnd::IterationLimit);
            }
            self.loosen();
            let gaps = [self.above_target(&from), self.above_target(&to)];
            let nearer = if gaps[0] < gaps[1] { from } else { to };
            if !(gaps[0] > zero && gaps[1] > zero) {
                self.fall(&nearer, infinity)?;
                continue;
            }
            self.bodies.aim(self.target);
            let proof = stay_apart(&*self.bodies, [&from, &to], gaps, third.as_ref());
            self.bodies.aim(zero);
            let Err(refuted) = proof else {
                self.proved = if before < first { before } else { last };
                return Ok(());
            };
            divisions += 1;
            let half = from.time + (to.time - from.time) * V::Scalar::from_f64(0.5);
            let time = if divisions > DIVISIONS { half } else { divide([&from, &to], gaps, refuted) };
            // Rounding decides which time is the earlier one.
            let is_short = !(to.time - from.time > self.options.max_time * V::Scalar::EPSILON);
            if is_short || !(time > from.time && time < to.time) {
                self.looks += 1;
                self.fall(&nearer, infinity)?;
                continue;
            }
            let part = (time - from.time) / (to.time - from.time);
            let mut middle = self.look(time, from.normal + (to.normal - from.normal) * part)?;
            if !(self.above_target(&middle) > zero) {
                let local = match middle.closing > zero {
                    true => self.descend(middle, to)?,
                    false if from.closing > zero => self.descend(from, middle)?,
                    false => middle,
                };
                self.fall(&local, infinity)?;
                if local.time > from.time && local.time < to.time {
                    middle = local;
                }
            }
            if middle.time < half {
                self.prove(from, middle, Some(to))?;
                (from, third) = (middle, Some(from));
            } else {
                self.prove(middle, to, Some(from))?;
                (to, third) = (middle, Some(to));
            }
        }
    }

    /// By how much the bodies are certainly farther apart than the target.
    fn above_target(&self, there: &Instant<V>) -> V::Scalar {
        let measure = there.gap + self.target + self.bodies.reach();
        there.gap - self.target - measure * V::Scalar::from_f64(ROUNDING_OF_TARGET * V::Scalar::EPSILON.as_f64())
    }

    /// Lets the target fall to just below the distance at a local minimum, if that is less than before, or by a
    /// slack, which is doubled each time. The target is no more than the limit.
    #[cold]
    fn fall(&mut self, local: &Instant<V>, limit: V::Scalar) -> Result<(), LeastEnd> {
        if local.distance < self.least.distance {
            self.least = *local;
        }
        let mut target = self.just_below().min(local.distance - local.error * V::Scalar::from_f64(WIDTH));
        if limit < target {
            target = limit;
        }
        if self.target > V::Scalar::ZERO && !(target < self.target) {
            self.slack = (self.slack + self.slack).max(self.least.distance - self.just_below());
            target = self.target - self.slack;
        }
        // NaN is no target.
        if !(target > V::Scalar::ZERO) {
            return Err(LeastEnd::Touching);
        }
        self.target = target;
        Ok(())
    }

    /// The least distance known, less the width of the bracket to come.
    fn just_below(&self) -> V::Scalar {
        let (number, Instant { distance, error, .. }) = (V::Scalar::from_f64, self.least);
        let width = (distance * self.options.tolerance * number(PART)).max(error * number(WIDTH));
        distance - width
    }

    /// Allows a wider bracket, once half of the looks are used.
    fn loosen(&mut self) {
        let loose = V::Scalar::from_f64(LOOSE);
        if self.looks > self.options.max_iterations / 2 && self.options.tolerance < loose {
            self.options.tolerance = loose;
            let target = self.just_below();
            if target < self.target && target > V::Scalar::ZERO {
                self.target = target;
            }
        }
    }

    /// Keeps an instant for the proof.
    fn keep(&mut self, there: Instant<V>) {
        let at = self.kept[..self.len].partition_point(|kept| kept.time < there.time);
        if self.len < MOST_KEPT && !(at < self.len && self.kept[at].time == there.time) {
            self.kept.copy_within(at..self.len, at + 1);
            self.kept[at] = there;
            self.len += 1;
        }
    }

    /// The nearest of a few instants over the whole motion, or the local minimum beside it, if bodies turn. If they do
    /// not, the distance has one minimum, which is found from the start.
    fn survey(&mut self) -> Result<Instant<V>, LeastEnd> {
        let (start, end) = (self.kept[0], self.options.max_time);
        if !(end > V::Scalar::ZERO) {
            return Ok(start);
        }
        let along = TurningPlane { from: start.normal, to: start.normal };
        let turns = self.bodies.acceleration_along(along, [start.time, end]) > V::Scalar::ZERO;
        let last = if turns { SURVEY } else { 1 };
        let (mut seen, mut nearest) = ([start; SURVEY + 1], 0);
        for k in 1..=last {
            let time = end * V::Scalar::from_f64(k as f64 / last as f64);
            seen[k] = self.look(time, seen[k - 1].normal)?;
            self.keep(seen[k]);
            nearest = if seen[k].distance < seen[nearest].distance { k } else { nearest };
        }
        match seen[nearest].closing > V::Scalar::ZERO {
            true if nearest == last => Ok(seen[last]),
            false if nearest == 0 => Ok(start),
            true => self.descend(seen[nearest], seen[nearest + 1]),
            false => self.descend(seen[nearest - 1], seen[nearest]),
        }
    }

    /// An instant between two at which the distance is locally least, to rounding. At the first one the bodies close
    /// in; at the second one they do not, or they are farther apart.
    fn descend(&mut self, mut low: Instant<V>, mut high: Instant<V>) -> Result<Instant<V>, LeastEnd> {
        let (zero, half) = (V::Scalar::ZERO, V::Scalar::from_f64(0.5));
        let mut least = if high.distance < low.distance { high } else { low };
        // The last two instants, and how often in a row neither the interval nor the speed was halved.
        let (mut last, mut slow) = ([low, high], 0);
        for _ in 0..DESCENT {
            let next = between(&low, &high, &last, slow);
            let left = least.closing.abs() * (next - least.time).abs();
            if !(next > low.time && next < high.time) || left <= least.error * half {
                break;
            }
            let there = self.look(next, low.normal)?;
            if self.target == zero {
                self.keep(there);
            }
            let (width, speed) = (high.time - low.time, last[1].closing.abs());
            last = [last[1], there];
            if there.distance < least.distance {
                least = there;
            }
            if there.closing > zero && there.distance <= low.distance {
                low = there;
            } else {
                high = there;
            }
            let is_slow = high.time - low.time > width * half && there.closing.abs() > speed * half;
            slow = if is_slow { slow + 1 } else { 0 };
        }
        Ok(least)
    }

    /// The bodies at a time, with their distance from contact to rounding; an error if they may touch there.
    fn look(&mut self, time: V::Scalar, axis: V) -> Result<Instant<V>, LeastEnd> {
        let there = self.bodies.at(time, axis, exactly(), false);
        self.looks += 1;
        self.show(&there);
        if there.gap > Scalar::ZERO { Ok(there) } else { Err(LeastEnd::Touching) }
    }

    fn show(&mut self, there: &Instant<V>) {
        (self.observer)(MotionIterate {
            iteration: self.looks - 1,
            time: there.time,
            gap: there.gap,
            normal: there.normal,
            lower: self.proved,
            upper: V::Scalar::infinity(),
        });
    }
}

/// The distance is asked for to rounding.
fn exactly<S: Scalar>() -> Limits<S> {
    Limits { distance: S::infinity(), depth: S::ZERO, rough: S::ZERO }
}

/// The time at which an interval that was not proved is divided: where the distance is expected to be least, if it
/// falls from both ends; in the middle, if the smaller gap is expected to close; otherwise so that the part at its end
/// can be expected to be proved.
fn divide<V: Vector>([from, to]: [&Instant<V>; 2], gaps: [V::Scalar; 2], refuted: Refuted<V::Scalar>) -> V::Scalar {
    let (number, zero) = (V::Scalar::from_f64, V::Scalar::ZERO);
    let (s, half) = (to.time - from.time, number(0.5));
    let middle = from.time + s * half;
    let is_last = gaps[1] < gaps[0];
    let (near, [less, more]) = if is_last { (to, [gaps[1], gaps[0]]) } else { (from, gaps) };
    let opening = if is_last { near.closing } else { -near.closing };
    if from.closing > zero && to.closing < zero {
        let part = from.closing / (from.closing - to.closing);
        if part > number(BESIDE_END) && part < number(1.0 - BESIDE_END) {
            return from.time + s * part;
        }
    }
    // The parabola through both gaps that opens as fast.
    let bend = (more - less - opening * s) / (s * s);
    if opening < zero && opening * opening > number(4.0) * bend * less {
        return middle;
    }
    let mut h = s * half;
    for _ in 0..TRIES {
        let there = less + (opening + bend * h) * h;
        if square_of_roots([less, there]) * number(CAUTION) > h * h * (refuted.most + refuted.growth * h) * half {
            return if is_last { to.time - h } else { from.time + h };
        }
        h *= number(SHORTER);
    }
    middle
}

/// A time between two at which the distance falls and rises: the minimum of the cubic by the last two instants, or
/// where the secant of the speeds at both ends is zero; or if these make no progress, where the tangents cross, as for
/// a kink, or the middle.
fn between<V: Vector>(low: &Instant<V>, high: &Instant<V>, last: &[Instant<V>; 2], slow: u8) -> V::Scalar {
    let is_inside = |time: &V::Scalar| *time > low.time && *time < high.time;
    let width = high.time - low.time;
    let middle = low.time + width * V::Scalar::from_f64(0.5);
    let crossing = (low.distance - high.distance - high.closing * width) / (low.closing - high.closing);
    let methods = match slow {
        _ if slow <= IDLE_STEPS_DOWN => [least_of_cubic(&last[0], &last[1]), secant(low, high)],
        _ if slow % 2 == 1 => [low.time + crossing, middle],
        _ => [middle; 2],
    };
    methods.into_iter().find(is_inside).unwrap_or(middle)
}

/// The time at which the secant of the speeds at two instants is zero.
fn secant<V: Vector>(from: &Instant<V>, to: &Instant<V>) -> V::Scalar {
    to.time + to.closing * ((to.time - from.time) / (from.closing - to.closing))
}

/// The time at which the cubic is least that agrees with the distances and speeds at two instants. If rounding decides
/// the difference of the distances, it is that of the secant.
fn least_of_cubic<V: Vector>(from: &Instant<V>, to: &Instant<V>) -> V::Scalar {
    let (h, number) = (to.time - from.time, V::Scalar::from_f64);
    let slower = from.closing - to.closing;
    if !(slower.abs() > (from.error + to.error) / h.abs() * number(NOISE_OF_SPEED)) {
        return secant(from, to);
    }
    let bent = number(3.0) * (from.distance - to.distance) / h - from.closing - to.closing;
    let root = (bent * bent - from.closing * to.closing).sqrt();
    let root = if h > V::Scalar::ZERO { root } else { -root };
    to.time + h * ((to.closing - root + bent) / (slower + root + root))
}
