//! Which time the search for a first contact looks at next. That decides how long it takes, and nothing of what is
//! proved.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{AIM, PATIENCE, Search};
use super::instant::Instant;
use super::trajectory::TurningPlane;

/// How much of the farthest end that can be expected to be proved is asked for.
const CAUTION: f64 = 0.9;
/// The part of the third-order change of a step that is left to go.
const LEFT: f64 = 0.05;
/// Steps of Newton's method from the root of a parabola to that of a cubic.
const STEPS: usize = 2;

impl<V: Vector> Search<'_, V> {
    /// Where to look next; `None` where no time lies between those known.
    ///
    /// With the gap `g` and the speed `w` at which it closes, it is expected to be `g − w·s` after the time `s`. So
    /// with `m = M/2`, of the `M` of the last step, an interval can be expected to be proved if `√g + √(g − w·s) >
    /// √m·s`, which ends at `s = 2√(g/m) − w/m` if the gap is still open then, that is if `w < √(m·g)`. Otherwise the
    /// contact itself is within reach.
    pub(super) fn next_time(&self) -> Option<V::Scalar> {
        let from_f64 = V::Scalar::from_f64;
        let Instant { time, gap, distance, error, closing, .. } = self.near;
        let end = self.options.max_time.min(self.upper);
        let m = self.acceleration.max(Scalar::ZERO) * from_f64(0.5);
        let is_within_reach = closing > (m * gap).sqrt();
        let step = if is_within_reach {
            self.newton(distance - error * from_f64(AIM))
        } else {
            (from_f64(2.0) * (gap / m).sqrt() - closing / m) * from_f64(CAUTION)
        };
        let next = time + step;
        if let Some(ahead) = self.ahead {
            // It was too far to be proved.
            let nearer = time + (ahead.time - time) * from_f64(0.5);
            return Some(if next < nearer { next } else { nearer }).filter(|&next| next > time && next < ahead.time);
        }
        if let Some(beyond) = self.beyond {
            return self.between(next, &beyond).filter(|&next| next > time && next < beyond.time);
        }
        // NaN goes to the end, which may be infinitely far.
        let next = if next < end { next } else { end };
        let next = if next.is_finite() { next } else { time + time.max(self.step) };
        Some(next).filter(|&next| next > time)
    }

    /// Where to look between [`near`](Self::near) and a time at which the bodies are not certainly apart, if from here
    /// it seemed to be `next`: Newton's method from the end that is nearer to contact; where that leaves the interval,
    /// the secant; and where neither comes nearer, or a distance is not known, the middle. `None` where nothing moves
    /// in between by more than rounding: as at the start, which is known better than all that comes after it.
    fn between(&self, next: V::Scalar, beyond: &Instant<V>) -> Option<V::Scalar> {
        let Instant { time, distance, error, .. } = self.near;
        let aim = error * Scalar::from_f64(AIM);
        let (width, way) = (beyond.time - time, distance - aim);
        let is_inside = |next: &V::Scalar| *next > time && *next < beyond.time;
        // Where they overlap, the speed is that of support points, which need not be the closest ones: two distances
        // tell it better.
        let closing = |farther: Instant<V>| (beyond.distance - farther.distance) / (farther.time - beyond.time);
        let from_beyond = beyond.time + (beyond.distance - aim) / self.farther.map_or(beyond.closing, closing);
        let secant = time + width * (way / (distance - beyond.distance));
        let methods = if beyond.distance.abs() < way { [from_beyond, secant] } else { [next, secant] };
        let quick = methods.into_iter().find(is_inside).filter(|_| self.slow <= PATIENCE);
        quick.or_else(|| {
            let moved = width * self.bodies.speed_at(&self.near);
            let is_still = moved > Scalar::ZERO && moved < self.bodies.size() * Scalar::EPSILON;
            (!is_still).then(|| time + width * Scalar::from_f64(0.5))
        })
    }

    /// The time after which the bodies have come nearer by `way`, as far as the last two looks predict it.
    ///
    /// With the closing speeds `w₀` and `w` at the beginning and the end of the last step `h`, in which they came
    /// nearer by `m·h`, the only cubic that agrees is `w·s + c·s²/2 + j·s³/6` with
    ///
    /// > j·h² = 12·((w₀ + w)/2 − m),   c·h = w − w₀ + j·h²/2.
    ///
    /// A small part of what is due to `j` is left to go, so that the next step starts on this side of the contact.
    /// Where the last step does not tell what comes, the growth `c` is the most that it may be.
    fn newton(&self, way: V::Scalar) -> V::Scalar {
        let from_f64 = V::Scalar::from_f64;
        let (two, w) = (from_f64(2.0), self.near.closing);
        if !self.is_smooth {
            return two * way / (w + (w * w + two * self.acceleration.max(Scalar::ZERO) * way).sqrt());
        }
        let (h, sped_up) = (self.step, self.sped_up);
        let bent = from_f64(12.0) * (w - sped_up * from_f64(0.5) - self.came_nearer / h);
        let (c, j) = ((sped_up + bent * from_f64(0.5)) / h, bent / (h * h));
        let squared = w * w + two * c * way;
        let after = if squared > Scalar::ZERO { two * way / (w + squared.sqrt()) } else { way / w };
        let left = j.abs() * after * after * (h * from_f64(0.25) + after * from_f64(1.0 / 6.0)) * from_f64(LEFT);
        let way = (way - left).max(way * from_f64(0.5));
        // Newton's method on the cubic.
        let mut s = after;
        for _ in 0..STEPS {
            let (growth, bend) = (c * s, j * s * s);
            let come = (w + growth * from_f64(0.5) + bend * from_f64(1.0 / 6.0)) * s;
            s += (way - come) / (w + growth + bend * from_f64(0.5));
        }
        // NaN is not near.
        if (s - after).abs() < after * from_f64(0.5) { s } else { after }
    }

    /// The distance at a time that would be enough to prove the rest of the motion along the present normal; infinity
    /// elsewhere.
    pub(super) fn enough_at(&self, time: V::Scalar) -> V::Scalar {
        if time < self.options.max_time {
            return V::Scalar::infinity();
        }
        let plane = TurningPlane { from: self.near.normal, to: self.near.normal };
        let m = self.bodies.acceleration_along(plane, [self.near.time, time]);
        let (duration, gap) = (time - self.near.time, self.near.gap);
        // In units of the gap.
        let root = duration * (m / gap * Scalar::from_f64(0.5)).sqrt() - Scalar::ONE;
        let root = root.max(Scalar::ZERO);
        root * root * gap * Scalar::from_f64(1.01)
    }
}
