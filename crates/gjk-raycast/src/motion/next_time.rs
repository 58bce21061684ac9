//! The time that the search for a first contact looks at next. This decides how long the search takes, and nothing
//! about what it proves.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::first_contact::{AIM, IDLE_LOOKS, Search};
use super::instant::Instant;
use super::trajectory::TurningPlane;

/// The next interval is this part of the longest one that can be expected to be proved.
const CAUTION: f64 = 0.9;
/// The part of the third-order change in a step that the step leaves undone.
const LEFT: f64 = 0.05;
/// Steps of Newton's method from the root of a parabola to that of a cubic.
const STEPS: usize = 2;

impl<V: Vector> Search<'_, V> {
    /// The time to look at next; `None` if no time lies between those that are known.
    ///
    /// A gap `g` that closes at the speed `w` is expected to be `g − w·s` after the time `s`. Let `m = M/2`, with the
    /// `M` of the last step. An interval can be expected to be proved if `√g + √(g − w·s) > √m·s`. This holds up to
    /// `s = 2√(g/m) − w/m` if the gap is still open then, which means `w < √(m·g)`. Otherwise the contact itself is
    /// within reach.
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
            // The interval up to there was too long to be proved.
            let nearer = time + (ahead.time - time) * from_f64(0.5);
            return Some(if next < nearer { next } else { nearer }).filter(|&next| next > time && next < ahead.time);
        }
        if let Some(beyond) = self.beyond {
            return self.between(next, &beyond).filter(|&next| next > time && next < beyond.time);
        }
        // If a number is NaN, the search goes to the end, which may be infinite.
        let next = if next < end { next } else { end };
        let next = if next.is_finite() { next } else { time + time.max(self.step()) };
        Some(next).filter(|&next| next > time)
    }

    /// The time to look at between [`near`](Self::near) and a time at which the bodies are not certainly apart, given
    /// the time `next` to which Newton's method leads from `near`. Newton's method from the end of the interval that is
    /// nearer to contact comes first. If its time is outside the interval, the time of the secant comes next; if
    /// neither method makes progress, or a distance is not known, the middle. The answer is `None` if the bodies move
    /// in between by no more than rounding: that may happen at the start, where their places are exact, while later
    /// places are not.
    fn between(&self, next: V::Scalar, beyond: &Instant<V>) -> Option<V::Scalar> {
        let Instant { time, distance, error, .. } = self.near;
        let aim = error * Scalar::from_f64(AIM);
        let (width, way) = (beyond.time - time, distance - aim);
        let is_inside = |next: &V::Scalar| *next > time && *next < beyond.time;
        // If they overlap, the closing speed is that of support points, which need not be the closest points. Two
        // distances tell it better.
        let closing = |farther: Instant<V>| (beyond.distance - farther.distance) / (farther.time - beyond.time);
        let from_beyond = beyond.time + (beyond.distance - aim) / self.farther.map_or(beyond.closing, closing);
        let secant = time + width * (way / (distance - beyond.distance));
        let methods = if beyond.distance.abs() < way { [from_beyond, secant] } else { [next, secant] };
        let quick = methods.into_iter().find(is_inside).filter(|_| self.slow <= IDLE_LOOKS);
        quick.or_else(|| {
            let moved = width * self.bodies.speed_at(&self.near);
            let is_still = moved > Scalar::ZERO && moved < self.bodies.size() * Scalar::EPSILON;
            (!is_still).then(|| time + width * Scalar::from_f64(0.5))
        })
    }

    /// The time that the bodies take to come nearer by `way`, as far as the last two looks predict it.
    ///
    /// With the closing speeds `w₀` and `w` at the beginning and the end of the last step `h`, in which they came
    /// nearer by `m·h`, the only cubic that agrees is `w·s + c·s²/2 + j·s³/6` with
    ///
    /// > j·h² = 12·((w₀ + w)/2 − m),   c·h = w − w₀ + j·h²/2.
    ///
    /// A small part of the change that is due to `j` is left undone, so that the next step starts on this side of the
    /// contact. If the last step does not predict the next one, `c` is the most that it may be.
    fn newton(&self, way: V::Scalar) -> V::Scalar {
        let from_f64 = V::Scalar::from_f64;
        let (two, w) = (from_f64(2.0), self.near.closing);
        let is_smooth = self.before.time >= Scalar::ZERO && self.before.goes_smoothly_to(&self.near);
        if !is_smooth {
            return two * way / (w + (w * w + two * self.acceleration.max(Scalar::ZERO) * way).sqrt());
        }
        let (h, sped_up) = (self.step(), w - self.before.closing);
        let came_nearer = self.before.distance - self.near.distance;
        let bent = from_f64(12.0) * (w - sped_up * from_f64(0.5) - came_nearer / h);
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
        // If `s` is NaN, the root of the parabola is taken.
        if (s - after).abs() < after * from_f64(0.5) { s } else { after }
    }

    /// For the end of the motion, the distance there that would be enough to prove the rest of it along the present
    /// normal. Infinity for other times.
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
