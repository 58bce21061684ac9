//! A plane that bends: the sharper bound on how far two moving bodies sink towards one another in an interval.
//!
//! A [free interval](super::free_interval) is proved with a bound on the acceleration of all points of both bodies,
//! however far they are from contact. About a minimum of the distance such a bound allows only intervals as short as
//! the root of the width of the bracket. Here the bound is that of the points that matter.
//!
//! Let the normal be `n(t) = n₀ + σ·Δ − σ·(1 − σ)·Q`, with `Δ = n₁ − n₀` and `σ = t/s`: two planes at the ends, and in
//! between a curve, whose second derivative `q = 2Q/s²` is that of the normals at three times. For a pair of points of
//! the cores let `x = a − b`, and let `ϱ` be the sum of the radii and the target distance. Since
//! `|n| ≤ (1 + |n|²)/2`, the pair is farther apart than the target where
//!
//! > ψ = n·x − ϱ·(1 + |n|²)/2
//!
//! is positive. At the ends, where `n` is a unit vector, `ψ` is no less than the gaps `g₀` and `g₁` of the planes. Its
//! derivatives are
//!
//! > ψ″ = q·x + 2ṅ·ẋ + n·ẍ − ϱ·(|ṅ|² + n·q),   ψ‴ = 3q·ẋ + 3ṅ·ẍ + n·x⃛ − 3ϱ·ṅ·q.
//!
//! Let `J` bound `ψ‴` in the interval, for all pairs. At one end, say the last one, both `ψ` and `ψ″` are linear in the
//! points. So one support point of each body, along a direction that leans a little, tells for any `μ > 0`
//!
//! > G = min (ψ(s) − μ·ψ″(s)),   and for each pair   ψ″ ≤ (ψ(s) − G)/μ + J·s
//!
//! throughout the interval. With `μ = s²/2` the condition `√ψ(0) + √ψ(s) > s·√(M/2)` for that bound `M` becomes
//!
//! > ψ(0) + 2·√(ψ(0)·ψ(s)) + G > J·s³/2,
//!
//! which is certain for all pairs if it holds with `g₀` and `g₁` for `ψ(0)` and `ψ(s)`. So an interval at a minimum may
//! be as long as the fourth root of the width, and the next ones grow faster than by any factor.

use convex_support::{Hint, Scalar, Vector};

use super::free_interval::square_of_roots;
use super::instant::{Approach, Instant};
use super::moving_body::{Course, MovingBody, Rigid, Turning};
use super::moving_pair::MovingPair;
use super::trajectory::{BentPlane, TurningPlane};
use crate::gjk::rounding;
use crate::pair::{Aligned, Shapes as _};
use crate::unit::is_moderate;

/// A bound on the rounding of the leaning height, in ε times the sum of its magnitudes, and of the condition.
const ROUNDING_OF_LEANING: f64 = 24.0;
/// If the bend of the normal in an interval is longer than this, the normals at three times say nothing about it.
const MOST_BEND: f64 = 0.25;

/// What an attempt at a proof has found out, if it is none: how long an interval at the end of the smaller gap can be.
#[derive(Clone, Copy)]
pub(super) struct Refuted<S> {
    /// A bound on `ψ″` there, for the points that matter.
    pub(super) most: S,
    /// How fast that bound may grow with the length of the interval.
    pub(super) growth: S,
}

/// Whether two bodies certainly stay farther apart than the target distance between two times, at which they do so by
/// the given gaps; `third` is another instant, near those. The bodies have to be [aimed](Approach::aim) at the target.
pub(super) fn stay_apart<V: Vector>(
    bodies: &dyn Approach<V>,
    ends @ [from, to]: [&Instant<V>; 2],
    gaps: [V::Scalar; 2],
    third: Option<&Instant<V>>,
) -> Result<(), Refuted<V::Scalar>> {
    let (number, zero) = (V::Scalar::from_f64, V::Scalar::ZERO);
    let times = [from.time, to.time];
    let (s, difference) = (times[1] - times[0], to.normal - from.normal);
    let half = number(0.5 + ROUNDING_OF_LEANING * V::Scalar::EPSILON.as_f64());
    // (√g₀ + √g₁)² > s²·M/2
    let is_proved = |gaps: [V::Scalar; 2], most: V::Scalar| {
        gaps[0] > zero && gaps[1] > zero && s * s * most * half < square_of_roots(gaps)
    };
    let along = |from, to| bodies.acceleration_along(TurningPlane { from, to }, times);
    // The normal does not bend, and the bound is that of all points.
    let most = along(from.normal, to.normal) - bodies.reach() * (difference.length_squared() / (s * s));
    if is_proved(gaps, most) {
        return Ok(());
    }
    // If the bodies do not turn, the height over a plane that does not turn is linear in time.
    for (k, there) in ends.into_iter().enumerate() {
        let most = along(there.normal, there.normal);
        if most > zero {
            break;
        }
        let (level, error) = bodies.level(times[1 - k], there.normal);
        if is_proved([gaps[k], level - error], most) {
            return Ok(());
        }
    }
    let is_last = gaps[1] < gaps[0];
    let (end, sign) = if is_last { (to, V::Scalar::ONE) } else { (from, -V::Scalar::ONE) };
    let bend = third.map_or(V::ZERO, |third| bend(ends, third));
    let lean = s * s * number(0.5);
    let plane = BentPlane {
        time: end.time,
        normal: end.normal,
        rate: (difference + bend * sign) / s,
        bend: bend / lean,
        longest: V::Scalar::ONE + bend.norm() * number(0.25),
        fastest: (difference.norm() + bend.norm()) / s,
        lean,
    };
    let Some([leaning, growth]) = bodies.leaning_level(&plane) else { return Err(Refuted { most, growth: zero }) };
    let less = gaps[usize::from(is_last)];
    if growth * s * lean * (half + half) < square_of_roots(gaps) - less + leaning {
        return Ok(());
    }
    Err(Refuted { most: (less - leaning) / lean, growth })
}

/// `Q`, by the divided differences of normals at three times; zero if they are no smooth function of time.
fn bend<V: Vector>([from, to]: [&Instant<V>; 2], third: &Instant<V>) -> V {
    let s = to.time - from.time;
    let first = (to.normal - from.normal) / s;
    let second = (third.normal - from.normal) / (third.time - from.time);
    let bend = (first - second) * (s * s / (to.time - third.time));
    // NaN is none.
    if bend.norm() < V::Scalar::from_f64(MOST_BEND) { bend } else { V::ZERO }
}

impl<V: Vector> MovingPair<'_, V> {
    /// `G` and a bound on `J`; `None` if a body has a motion of which only bounds are known.
    pub(super) fn leaning(&self, plane: &BentPlane<V>) -> Option<[V::Scalar; 2]> {
        let bends = [self.a.bend(plane)?, self.b.bend(plane)?];
        let placed = self.placed(plane.time);
        let pair = placed.pair();
        let (size, radius) = (pair.size(placed.offset), pair.radius());
        if !is_moderate(size) {
            return None;
        }
        let &BentPlane { normal: n, rate, bend: q, fastest, lean, .. } = plane;
        let [one, two, three] = [1.0, 2.0, 3.0].map(V::Scalar::from_f64);
        let [along_a, along_b] = [0, 1].map(|i| n - (q + bends[i].leaning) * lean);
        let [Aligned(point_a), Aligned(point_b)] =
            placed.support_points([-along_a, along_b], &mut [Hint::new(), Hint::new()]);
        self.count(1);
        let [a, b] = bends;
        let arms = [point_a + placed.a.turned(a.arm), point_b + placed.b.turned(b.arm)];
        let (x, velocity) = (placed.offset + (point_a - point_b), a.velocity - b.velocity);
        let bending = q.dot(x) + two * rate.dot(velocity) + a.leaning.dot(arms[0]) - b.leaning.dot(arms[1]);
        let turning = radius * (rate.length_squared() + n.dot(q));
        let level = n.dot(x) - radius - lean * (bending - turning);
        // The error of the points counts along the normal and along what is added to it. The direction of the support
        // points need not be exact: its error times the size of a core is a part of the other magnitudes.
        let leans = lean * (q.norm() + a.leaning.norm() + b.leaning.norm());
        let swings = a.leaning.norm() * arms[0].norm() + b.leaning.norm() * arms[1].norm();
        let magnitude = lean * (two * rate.norm() * velocity.norm() + swings + radius * rate.length_squared());
        let lost = (size * (one + leans) + magnitude) * V::Scalar::EPSILON * V::Scalar::from_f64(ROUNDING_OF_LEANING)
            + (rounding(size) + pair.error()) * (two + leans);
        let growth = a.jerk + b.jerk + three * q.norm() * (velocity.norm() + radius * fastest);
        Some([level - lost, growth])
    }
}

impl<V: Vector> MovingBody<'_, V> {
    /// How the body's points bend away from a plane; `None` if the motion is not rigid.
    ///
    /// With `y` the vector to a point from the centre and `W` for `ω×`, the velocity is `v + Wy`, and the further
    /// derivatives are `W²y` and `W³y`. Across the axis `y` is no longer than the reach.
    fn bend(&self, plane: &BentPlane<V>) -> Option<Bend<V>> {
        let rest = Bend { leaning: V::ZERO, velocity: V::ZERO, arm: V::ZERO, jerk: V::Scalar::ZERO };
        let Rigid { motion, turning, .. } = match &self.course {
            Course::Rest => return Some(rest),
            Course::Rigid(rigid) => rigid,
            Course::Other => return None,
        };
        let moving = Bend { velocity: motion.velocity, ..rest };
        let Some(Turning { arm, reach, .. }) = turning else { return Some(moving) };
        let (w, three) = (motion.rate(), V::Scalar::from_f64(3.0));
        // A product that underflows is no bound.
        if !is_moderate(w * w) {
            return None;
        }
        let leaning = motion.turning(motion.turning(plane.normal) - plane.rate - plane.rate);
        let slower = three * (plane.bend.norm() + plane.fastest * w) + plane.longest * (w * w);
        Some(Bend { leaning, arm: arm.unwrap_or(V::ZERO), jerk: *reach * w * slower, ..moving })
    }
}

/// A body's part of the second and third derivative of its points' heights over a bent plane.
struct Bend<V: Vector> {
    /// `ω × (ω × n − 2ṅ)`: its product with the vector to a point from the centre of the rotation is the part of
    /// `2ṅ·ẋ + n·ẍ` that the rotation makes.
    leaning: V,
    velocity: V,
    /// The vector from the centre of the rotation to the body's origin, at time 0.
    arm: V,
    /// A bound on the third derivative, for all points of the core, but for the part of the velocity.
    jerk: V::Scalar,
}
