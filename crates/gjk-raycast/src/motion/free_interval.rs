//! Why two moving bodies are apart throughout an interval, and not only at its ends.
//!
//! Let planes with unit normals `n₀` and `n₁` separate the bodies by `g₀` at time 0 and by `g₁` at time `s`. In between
//! let the normal go straight from one to the other, `n(t) = n₀ + t·r` with `r = (n₁ − n₀)/s`, and look at any two
//! points `a(t)` and `b(t)` of the bodies' cores. Along the normal they are apart by
//!
//! > φ(t) = n(t)·(a(t) − b(t)),   φ″ = 2·r·(ȧ − ḃ) + n·(ä − b̈) ≤ M.
//!
//! At the ends `φ` is at least `g₀` and `g₁` more than the radii `ρ` of the bodies, and a function whose second
//! derivative is at most `M` lies above its chord less `M·t·(s − t)/2`. So with `σ = t/s`, and since `|n(t)| ≤ 1`,
//!
//! > φ(t) − ρ·|n(t)| ≥ (1 − σ)·g₀ + σ·g₁ − σ·(1 − σ)·s²·M/2,
//!
//! for all pairs of points at once. The right-hand side is positive for all `σ` from 0 to 1 just where
//!
//! > √g₀ + √g₁ > s·√(M/2),
//!
//! since its least value over `σ` is zero if both sides are equal. That is the whole certificate: two planes, and a
//! bound on how unevenly the bodies move. Nothing is lost at the ends, so that an interval that ends within rounding of
//! a contact is proved as easily as any other. (Steps that rely on a bound on speed come to a contact only by ever
//! smaller steps.) For bodies that do not turn, along a plane that does not turn, `M` is zero, which proves any
//! interval.
//!
//! In the same way it is proved that the signed distance of the bodies stays above a level `ℓ < 0`, with gaps that are
//! measured from that level: at the ends `φ ≥ ρ + ℓ + g`, and in between `φ` has to be at least `(ρ + ℓ)·|n(t)|`. If
//! `ρ + ℓ` is negative, that is harder to reach as the normal is shorter than one. Since
//! `|n(t)|² = 1 − σ·(1 − σ)·|n₁ − n₀|²`, it is shorter by no more than `σ·(1 − σ)·|n₁ − n₀|²`, as if `M` were larger by
//! `2·|ℓ|·|r|²`.
//!
//! Any two planes that separate the bodies at the two times may be used. If the normals of the closest points turn far,
//! so that `M` is large, one of them may serve at both times.

use convex_support::{Scalar, Vector};

use super::instant::{Approach, Base, Instant};
use super::trajectory::TurningPlane;

/// A bound on what rounding changes of both sides of the condition, in ε.
const ROUNDING: f64 = 64.0;

/// Whether the signed distance of the bodies certainly stays above a level between two times at which it does so by the
/// given gaps. At level 0 this means that they are apart. The answer is the bound `M` along the plane that turns from
/// the one normal to the other, whichever plane is the proof; `None` if there is none.
pub(super) fn acceleration_if_free<V: Vector>(
    bodies: &dyn Approach<V>,
    from: &Instant<V>,
    to: &Instant<V>,
    base: &Base<V::Scalar>,
) -> Option<V::Scalar> {
    let times = [from.time, to.time];
    let most = |normals: [V; 2]| bodies.acceleration_along(TurningPlane { from: normals[0], to: normals[1] }, times);
    let turning = most([from.normal, to.normal]);
    let mut bent = turning;
    if base.level < V::Scalar::ZERO {
        let rate = (to.normal - from.normal) / (times[1] - times[0]);
        bent += V::Scalar::from_f64(-2.0) * base.level * rate.length_squared();
    }
    if keeps_apart([from.gap, to.gap], bent, times) {
        return Some(turning);
    }
    // If the two planes are one, there is no other to try.
    if from.normal == to.normal {
        return None;
    }
    let gap_along = |time, normal| {
        let (level, error) = bodies.level(time, normal);
        level - base.level - error * (V::Scalar::ONE - base.loose())
    };
    let is_free = keeps_apart([gap_along(from.time, to.normal), to.gap], most([to.normal; 2]), times)
        || keeps_apart([from.gap, gap_along(to.time, from.normal)], most([from.normal; 2]), times);
    is_free.then_some(turning)
}

/// Whether planes that separate the bodies by these gaps at the ends of an interval separate them in between too, given
/// the bound `M`.
fn keeps_apart<S: Scalar>(gaps: [S; 2], most: S, times: [S; 2]) -> bool {
    if !gaps.iter().all(|&gap| gap > S::ZERO) {
        return false;
    }
    let duration = times[1] - times[0];
    let half = S::from_f64(0.5 + 0.5 * ROUNDING * S::EPSILON.as_f64());
    // If a number is NaN, there is no proof.
    duration * duration * most * half < square_of_roots(gaps)
}

/// The square of the sum of the roots of two lengths. Roots are taken only of ratios: the root of a length would have
/// other digits in another unit, since the root of an odd power of two is no power of two.
pub(super) fn square_of_roots<S: Scalar>(lengths: [S; 2]) -> S {
    let [less, more] = if lengths[0] < lengths[1] { lengths } else { [lengths[1], lengths[0]] };
    less + more + S::from_f64(2.0) * more * (less / more).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{keeps_apart, square_of_roots};

    #[test]
    fn the_square_of_the_sum_of_roots_has_the_same_digits_in_every_unit() {
        assert_eq!(square_of_roots([4.0, 9.0]), 25.0);
        assert_eq!(square_of_roots([9.0, 4.0]), 25.0);
        for (a, b) in [(0.3, 0.7), (2.0, 1e-9), (5.0, 5.0)] {
            assert_eq!(square_of_roots([a * 2.0, b * 2.0]), 2.0 * square_of_roots([a, b]));
        }
        assert!(square_of_roots([f64::NAN, 1.0]).is_nan());
    }

    /// With a bound `M` on the second derivative, gaps of `M/8` at the ends of an interval of length one may close in
    /// its middle: no less is a proof.
    #[test]
    fn gaps_are_a_proof_where_a_parabola_between_them_stays_positive() {
        let is_proved = |gaps: [f64; 2], most| keeps_apart(gaps, most, [2.0, 3.0]);
        assert!(is_proved([1.0 + 1e-9; 2], 8.0) && !is_proved([1.0; 2], 8.0));
        // √g₀ + √g₁ > √(M/2)
        assert!(is_proved([4.0, 1.0 + 1e-9], 18.0) && !is_proved([4.0, 1.0], 18.0));
        assert!(is_proved([1e-300, 1e-300], 0.0) && is_proved([1.0, 1.0], -1.0));
        assert!(!is_proved([0.0, 1.0], 0.0) && !is_proved([1.0, -1.0], 0.0));
        assert!(!is_proved([f64::NAN, 1.0], 0.0) && !is_proved([1.0; 2], f64::NAN));
    }
}
