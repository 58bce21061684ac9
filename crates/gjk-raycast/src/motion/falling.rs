//! The least distance of two moving bodies, by the search for their first contact, with a target distance that falls.
//!
//! If the bodies never come as near as `u − w`, and are apart by `u` at some time, then their least distance is in
//! `[u − w, u]`. So the least distance found so far, less a small width, is the target of a search for a first
//! [contact](super::first_contact). Where this search comes to a time at which the bodies are as near as the target, it
//! descends from there to a time at which they are nearest, and the target falls. What was proved before holds for the
//! lower target too. At the end of the motion the last target is proved for all of it. If the bodies touch, the target
//! is 0, and the rest is the search for the first contact itself.
//!
//! # How long a step can be
//! On the way down to a minimum, let `g` be the distance above the target, `c` the speed at which it closes, and `M`
//! the bound of the [free interval](super::free_interval). The distance hardly goes below the target, so that it bends
//! by no less than `κ = c²/(2g)`: after the time `s` it is expected to be `g − c·s + κ·s²/2`. This can be proved if
//! `√g + √(g − c·s + κ·s²/2) ≥ s·√(M/2)`, that is, with `m = M/2`, up to
//!
//! > s = (2·√(g·m) − c)/(m − κ/2) = 4g/(2·√(g·m) + c).
//!
//! So each step leaves a certain part of the way to the minimum, and their number grows with the logarithm of the
//! width.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{Falling, Search};
use super::instant::{Instant, Limits};
use super::trajectory::TurningPlane;

/// The width of the bracket to come, in errors of the distance, if rounding decides.
const WIDTH: f64 = 4.0;
/// The part of the tolerance that is used. The rest is for the error of the distance.
const PART: f64 = 0.875;
/// The next interval is this part of the longest one that can be expected to be proved.
const CAUTION: f64 = 0.9;
/// The number of instants, beside that of the start, among which the first minimum is looked for.
const SURVEY: usize = 4;
/// The number of looks on the way to one minimum, at most.
const DESCENT: usize = 60;
/// How often in a row neither the interval of a minimum nor the speed may be halved by a secant.
const IDLE_STEPS_DOWN: u8 = 2;
/// If the search has used half of its looks, the tolerance is no less than this.
const LOOSE: f64 = 1.0 / 1024.0;

impl<V: Vector> Search<'_, V> {
    /// Begins with a target that falls from the distance at the start, where the bodies are apart, or from a limit if
    /// that is less.
    pub(super) fn let_fall(&mut self, tolerance: V::Scalar, limit: V::Scalar) {
        let zero = V::Scalar::ZERO;
        if !(limit > zero) {
            return;
        }
        let go_on = |search: &mut Search<'_, V>| search.fall_on();
        let farthest = |search: &Search<'_, V>, m: V::Scalar| search.farthest(m);
        let falling = Falling { target: zero, slack: zero, go_on, farthest };
        if !(self.near.gap > limit) {
            // If the bodies may touch at the start, there is nothing to fall.
            let Ok(near) = self.look_closely(zero, self.near.normal) else { return };
            (self.near, self.least) = (near, near);
            self.before = Instant { time: -V::Scalar::ONE, ..near };
        }
        self.options.tolerance = tolerance;
        if self.near.gap > limit {
            self.falling = Some(Falling { target: limit, ..falling });
            self.bodies.aim(limit);
            self.measure_from(zero, limit);
        } else {
            self.falling = Some(falling);
            self.fall(zero);
        }
    }

    /// The next step, or the fall of the target.
    fn fall_on(&mut self) {
        let there = self.next_time().map(|time| self.glance(time));
        match there {
            Some(there) if there.gap > V::Scalar::ZERO => {
                let _ = self.advance_to(&there);
            }
            Some(there) => self.fall(there.time),
            // No time is left between this and the next one.
            None => self.fall(self.ahead.map_or(self.near.time, |ahead| ahead.time)),
        }
    }

    /// The longest step that can be expected to be proved, with half the bound `M` of the last one, or along the normal
    /// as it is.
    fn farthest(&self, m: V::Scalar) -> V::Scalar {
        let (number, zero) = (V::Scalar::from_f64, V::Scalar::ZERO);
        let Instant { time, gap, closing, normal, .. } = self.near;
        // If an interval was not proved, its gaps and its bound tell how long one can be.
        if let (Some(ahead), Some(most)) = (self.ahead, self.refuted) {
            let m = most * number(0.5);
            let provable = (gap / m).sqrt() + (ahead.gap / m).sqrt();
            let falling = number(4.0) * gap / (number(2.0) * (gap * m).sqrt() + closing);
            return (if closing > zero && falling < provable { falling } else { provable }) * number(CAUTION);
        }
        let along = TurningPlane { from: normal, to: normal };
        let still = self.bodies.acceleration_along(along, [time, self.options.max_time]).max(zero) * number(0.5);
        let (two, root) = (number(2.0), |m: V::Scalar| (gap * m).sqrt());
        // Along the normal as it is, the distance closes at the same speed.
        let straight = if closing > root(still) { gap / closing } else { (two * root(still) - closing) / still };
        let turning =
            if closing > zero { two * two * gap / (two * root(m) + closing) } else { (two * root(m) - closing) / m };
        // A NaN is neither.
        (if straight > turning { straight } else { turning }) * number(CAUTION)
    }

    /// Lets the target fall to just below the least distance near a time.
    #[cold]
    fn fall(&mut self, time: V::Scalar) {
        let (number, zero) = (V::Scalar::from_f64, V::Scalar::ZERO);
        let Some(mut falling) = self.falling else { return };
        let before = falling.target;
        self.bodies.aim(zero);
        self.measure_from(before, zero);
        let local = match if before > zero { self.descend_at(time) } else { self.survey() } {
            Ok(local) => local,
            Err(touching) => {
                self.end_fall();
                self.block(&touching);
                return;
            }
        };
        if local.distance < self.least.distance {
            self.least = local;
        }
        if self.looks > self.options.max_iterations / 2 {
            self.options.tolerance = self.options.tolerance.max(number(LOOSE));
        }
        let Instant { distance, error, .. } = self.least;
        let width = (distance * self.options.tolerance * number(PART)).max(error * number(WIDTH));
        let mut target = (self.least.distance - width).min(local.distance - local.error * number(WIDTH));
        if before > zero && !(target < before) {
            falling.slack = (falling.slack + falling.slack).max(width);
            target = before - falling.slack;
        }
        if !(target > zero) {
            self.end_fall();
            return;
        }
        falling.target = target;
        self.falling = Some(falling);
        self.bodies.aim(target);
        self.measure_from(zero, target);
        let least = self.least.above(target);
        if least.time > self.near.time {
            self.show(&least);
            if !self.advance_to(&least) {
                self.ahead = None;
            }
        }
    }

    /// From now on any contact counts.
    fn end_fall(&mut self) {
        self.falling = None;
        self.options.tolerance = V::Scalar::ZERO;
    }

    /// Changes the target that known distances are measured from.
    fn measure_from(&mut self, before: V::Scalar, target: V::Scalar) {
        let rounding = (before + target) * V::Scalar::EPSILON;
        let anew = |there: Instant<V>| {
            let there = there.above(target - before);
            Instant { gap: there.gap - rounding, ..there }
        };
        (self.near, self.before) = (anew(self.near), anew(self.before));
        self.ahead = None;
    }

    /// The nearest of a few instants over the whole motion, or the local minimum beside it, if bodies turn. If they do
    /// not, the distance has one minimum, which is found from the start.
    fn survey(&mut self) -> Result<Instant<V>, Instant<V>> {
        let (start, end) = (self.near, self.options.max_time);
        let along = TurningPlane { from: start.normal, to: start.normal };
        if !(self.bodies.acceleration_along(along, [start.time, end]) > V::Scalar::ZERO) {
            return self.descend_at(start.time);
        }
        let (mut seen, mut nearest) = ([start; SURVEY + 1], 0);
        for k in 1..=SURVEY {
            let time = end * V::Scalar::from_f64(k as f64 / SURVEY as f64);
            seen[k] = self.look_closely(time, seen[k - 1].normal)?;
            nearest = if seen[k].distance < seen[nearest].distance { k } else { nearest };
        }
        let closes = seen[nearest].closing > V::Scalar::ZERO;
        match nearest {
            SURVEY if closes => Ok(seen[nearest]),
            0 if !closes => Ok(start),
            _ if closes => self.descend(seen[nearest], Some(seen[nearest + 1])),
            _ => self.descend(seen[nearest - 1], Some(seen[nearest])),
        }
    }

    /// A local minimum after a time, if the bodies close in there, and otherwise between the last proved time and that
    /// one.
    fn descend_at(&mut self, time: V::Scalar) -> Result<Instant<V>, Instant<V>> {
        let (zero, start) = (V::Scalar::ZERO, self.near);
        let first = if time == start.time { start } else { self.look_closely(time, start.normal)? };
        match first.closing > zero {
            true => self.descend(first, None),
            false if start.closing > zero && start.time < time => self.descend(start, Some(first)),
            false => Ok(first),
        }
    }

    /// An instant at which the distance is locally least, to rounding, after one at which the bodies close in, and
    /// before one at which they do not, if that is known. If the bodies may touch on the way, it is the instant when they
    /// do.
    fn descend(&mut self, mut low: Instant<V>, mut high: Option<Instant<V>>) -> Result<Instant<V>, Instant<V>> {
        let (zero, number, end) = (V::Scalar::ZERO, V::Scalar::from_f64, self.options.max_time);
        // The bodies are as near as they get when a point at their distance is, if it moves straight.
        let [velocity_a, velocity_b] = self.bodies.velocities(low.time, low.point);
        let speed = (velocity_a - velocity_b).norm();
        let mut stride = (low.distance + self.bodies.size() * number(0.5)) / speed * (low.closing / speed);
        let (mut least, mut slow) = (low, 0);
        // The last two instants.
        let mut last = [low, low];
        if let Some(high) = high {
            last[1] = high;
            least = if high.distance < low.distance { high } else { low };
        }
        for _ in 0..DESCENT {
            let next = match &high {
                None => (low.time + stride).min(end),
                Some(high) => between(&low, high, last, slow),
            };
            if !(next > low.time && high.is_none_or(|high| next < high.time)) {
                break;
            }
            let left = least.closing.abs() * (next - least.time).abs();
            if high.is_some() && left <= least.error * number(0.5) {
                break;
            }
            let there = self.look_closely(next, low.normal)?;
            last = [last[1], there];
            if there.distance < least.distance {
                least = there;
            }
            let width = high.map(|high| high.time - low.time);
            if there.closing > zero && (high.is_none() || there.distance <= low.distance) {
                let further = there.closing * ((there.time - low.time) / (low.closing - there.closing));
                let most = stride * number(4.0);
                stride = if further > zero && further < most { further * number(1.125) } else { most };
                low = there;
                if next >= end {
                    break;
                }
            } else {
                high = Some(there);
            }
            if let (Some(width), Some(high)) = (width, high) {
                let is_slow = high.time - low.time > width * number(0.5)
                    && there.closing.abs() > last[0].closing.abs() * number(0.5);
                slow = if is_slow { slow + 1 } else { 0 };
            }
        }
        Ok(least)
    }

    /// The bodies at a time, with their distance from contact to rounding; an error if they may touch there.
    fn look_closely(&mut self, time: V::Scalar, axis: V) -> Result<Instant<V>, Instant<V>> {
        let limits = Limits { distance: V::Scalar::infinity(), depth: Scalar::ZERO, rough: Scalar::ZERO };
        let there = self.bodies.at(time, axis, limits, false);
        self.looks += 1;
        self.show(&there);
        if there.gap > Scalar::ZERO { Ok(there) } else { Err(there) }
    }
}

/// A time between two at which the distance falls and rises: where the secant of the speeds at the last two instants is
/// zero, or that of the speeds at both ends; or if these make no progress, where the tangents cross, as for a kink, or
/// the middle.
fn between<V: Vector>(low: &Instant<V>, high: &Instant<V>, last: [Instant<V>; 2], slow: u8) -> V::Scalar {
    let is_inside = |time: &V::Scalar| *time > low.time && *time < high.time;
    let secant = |from: &Instant<V>, to: &Instant<V>| {
        to.time + to.closing * ((to.time - from.time) / (from.closing - to.closing))
    };
    let width = high.time - low.time;
    let middle = low.time + width * V::Scalar::from_f64(0.5);
    let crossing = (low.distance - high.distance - high.closing * width) / (low.closing - high.closing);
    let methods = match slow {
        _ if slow <= IDLE_STEPS_DOWN => [secant(&last[0], &last[1]), secant(low, high)],
        _ if slow % 2 == 1 => [low.time + crossing, middle],
        _ => [middle; 2],
    };
    methods.into_iter().find(is_inside).unwrap_or(middle)
}
