//! Why two moving bodies have a point in common throughout an interval, and not only at its ends.
//!
//! Let `κ` be a point of each body, moving with it, and `w(κ, t)` the vector between them at the time `t`; all these
//! vectors are the difference `C(t)`. Where the bodies overlap by `d`, it contains the ball of radius `d` about zero.
//! Let a convex set `Z` be within `C` at both ends of an interval of length `s`: for every `z` in `Z` there are `κ₀`
//! and `κ₁` with `w(κ₀, 0) = w(κ₁, s) = z`. In between, with `σ = t/s`, look at the points `(1 − σ)·κ₀ + σ·κ₁`, which
//! are of the bodies too. What lies between them is
//!
//! > z + σ·(1 − σ)·[ΔR_A·α − ΔR_B·β] + e,
//!
//! where `ΔR` is how each body turns in the interval, `α` and `β` lead from the one point of its core to the other, and
//! `e` is how far the points leave the chords of their paths, by their acceleration. How the bodies move against one
//! another does not matter. Along a unit vector `m` the last two are at most `E(m)/4`, where `E(m)` is the sum of
//! `|ΔRᵀm|` times the width of the core and `s²/2` times the acceleration, of both bodies. So zero is in `C` throughout
//! if `Z` reaches as far as `E(m)/4` along every `m`.
//!
//! The ball of radius `d` does that if no `E` is more than `4d`. Bodies that turn about their normal of contact hardly
//! move along it, but across. So a flat `Z` will also do: the hull of the ball and points `±L·e` across the normal `n`.
//! If these are in `C`, which is whether the bodies overlap with one of them shifted, it is enough that `E(n) ≤ 2d`,
//! and that `E ≤ √2·L` across, since the larger of `d` and `L·|m·e|` is more than their mean.

use convex_support::{Posed, Scalar, Vector};

use super::instant::Instant;
use super::moving_pair::MovingPair;
use crate::SignedDistanceOptions;
use crate::shape::WithoutLines;
use crate::signed_distance::signed_distance_of_any;
use crate::symmetric::axes_across;

impl<V: Vector> MovingPair<'_, V> {
    /// Whether the bodies, which overlap by `depth` at least at two times, certainly have a point in common at all
    /// times between.
    #[cold]
    #[inline(always)]
    pub(super) fn keep_in_contact(&self, from: &Instant<V>, to: &Instant<V>, depth: V::Scalar) -> bool {
        let times = [from.time, to.time];
        let strays = |m| self.a.strays(m, times) + self.b.strays(m, times);
        let axes = (0..V::DIM).map(V::axis);
        let farthest = axes.fold(V::Scalar::ZERO, |sum, axis| sum + strays(axis));
        let two = V::Scalar::from_f64(2.0);
        if farthest <= depth * (two + two) {
            return true;
        }
        // NaN is no proof.
        if !(strays(from.normal) <= depth * two) {
            return false;
        }
        let aside = axes_across(from.normal);
        let mut shifts =
            aside.into_iter().take(V::DIM - 1).flat_map(|e| [e, -e]).map(|e| e * (farthest * Scalar::from_f64(0.7072)));
        shifts.all(|shift| times.iter().all(|&time| self.overlap_shifted(time, shift)))
    }

    /// Whether the bodies certainly overlap at a time if one of them is shifted.
    fn overlap_shifted(&self, time: V::Scalar, shift: V) -> bool {
        let placed = self.placed(time);
        let Ok(a) = Posed::translated(&placed.a, shift) else { return false };
        let options = SignedDistanceOptions::new().with_depth_limit(Scalar::ZERO);
        let there = signed_distance_of_any(&WithoutLines(&a), &WithoutLines(&placed.b), options);
        self.count(there.iterations);
        there.upper < Scalar::ZERO
    }
}
