//! Why two moving bodies have a point in common throughout an interval, and not only at its ends.
//!
//! Let `κ` stand for a point of each body, both of which move with their bodies, and let `w(κ, t)` be the vector
//! between them at the time `t`. All these vectors form the difference `C(t)`. If the bodies overlap by `d`, it
//! contains the ball of radius `d` about zero. Let a convex set `Z` be within `C` at both ends of an interval of length
//! `s`: for every `z` in `Z` there are `κ₀` and `κ₁` with `w(κ₀, 0) = w(κ₁, s) = z`. In between, with `σ = t/s`, the
//! points `(1 − σ)·κ₀ + σ·κ₁` are points of the bodies too. The vector between them is
//!
//! > z + σ·(1 − σ)·[ΔR_A·α − ΔR_B·β] + e,
//!
//! where `ΔR` is the change of each body's rotation in the interval, `α` and `β` lead from the one point of each core
//! to the other, and `e` is how far the points leave the chords of their paths, by their acceleration. The translation
//! of the bodies against one another does not occur. Along a unit vector `m` the last two terms are no more than
//! `E(m)/4`, where `E(m)` is a sum over both bodies: `|ΔRᵀm|` times the width of the core, plus `s²/2` times the
//! acceleration. So zero is in `C` throughout if `Z` reaches as far as `E(m)/4` along every `m`.
//!
//! The ball of radius `d` does so if no `E` is more than `4d`. Bodies that turn about their normal of contact hardly
//! move along it, but they move across it. For these `Z` is a flat set: the hull of the ball and of points `±L·e`
//! across the normal `n`. These points are in `C` if the bodies overlap with one of them shifted by `±L·e`. Then it is
//! enough that `E(n) ≤ 2d`, and that `E ≤ √2·L` across the normal, since the larger of `d` and `L·|m·e|` is more than
//! their mean.
//!
//! # Bodies without an inside
//! Such bodies may pass through one another, as a point through a plate or a rod across a rod. Their difference has no
//! inside either. So they never overlap by more than rounding, and touch at one time only, which cannot be known to the
//! last bit. Yet it can be certain that they have touched. Take as many corners of the difference as there are
//! dimensions, each between two points that stay with their bodies, and project them along a fixed unit vector `n`. As
//! long as zero is within the projected triangle (in 2D between the two projected corners), the line through zero along
//! `n` pierces the triangle at one height, which is continuous in time. If this height is positive at the beginning and
//! negative at the end, it has been zero in between. At that time zero was a point of the triangle, and so of the
//! difference.
//!
//! Between the two times the projected corners are known by how far they can have moved. A coordinate of a path whose
//! second derivative is no more than `m` in amount is no farther from its chord than `m·τ²/8`, with `τ` the duration.

use convex_support::{Posed, Scalar, Vector};
use num_traits::Float as _;

use super::instant::{Approach as _, Instant};
use super::moving_pair::{MovingPair, times};
use super::placed::{BodyFrameCorners, Placed};
use super::trajectory::TurningPlane;
use crate::SignedDistanceOptions;
use crate::gjk::{Frame, Gjk, GjkOptions, gjk, rounding};
use crate::observer::Observer;
use crate::pair::WithoutLines;
use crate::separation::ProjectedFace;
use crate::signed_distance::signed_distance_of_any;
use crate::symmetric::axes_across;
use crate::unit::{is_moderate, length_bound};

/// The error of corners, in units of the error of the pair's support points: corners were also turned back and forth.
const ERRORS: f64 = 4.0;

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

    /// Whether the bodies certainly overlap at a time with one of them shifted.
    fn overlap_shifted(&self, time: V::Scalar, shift: V) -> bool {
        let placed = self.placed(time);
        let Ok(a) = Posed::translated(&placed.a, shift) else { return false };
        let options = SignedDistanceOptions::new().with_depth_limit(Scalar::ZERO);
        let there = signed_distance_of_any(&WithoutLines(&a), &WithoutLines(&placed.b), options);
        self.count(there.iterations);
        there.upper < Scalar::ZERO
    }

    /// Whether the bodies, which a plane separates at the time of `near`, certainly have a point in common at some time
    /// until the given one, because they have passed through one another.
    #[cold]
    #[inline(always)]
    pub(super) fn have_met(&self, near: &Instant<V>, time: V::Scalar) -> bool {
        let (from, to) = (self.placed(near.time), self.placed(time));
        let Some(corners) = self.closest_corners(&from, near.normal) else { return false };
        let (before, after) = (corners.at(&from).points, corners.at(&to).points);
        let dimension = V::DIM;
        if !before[..dimension].iter().chain(&after[..dimension]).all(|corner| corner.is_finite()) {
            return false;
        }
        let error = (error_of(&from) + error_of(&to)) * Scalar::from_f64(ERRORS);
        let mut moved = error + self.off_chord([near.time, time]);
        for (&before, &after) in before.iter().zip(&after).take(dimension) {
            moved += length_bound(after - before);
        }
        let seen_before = ProjectedFace::along(near.normal, &before);
        let seen_after = ProjectedFace::along(near.normal, &after);
        // Between the two times no projected corner is farther than `moved` from where it was at the first.
        let is_seen_within = seen_before.surrounds_zero(moved);
        let (height, lost) = seen_after.height_at_zero();
        // NaN is no proof.
        is_seen_within && near.gap > Scalar::ZERO && height < -(error + lost)
    }

    /// The corners of the face of the difference that is nearest to zero, if they are as many as there are dimensions.
    fn closest_corners(&self, placed: &Placed<'_, V>, axis: V) -> Option<BodyFrameCorners<V>> {
        let mut pair = placed.pair();
        let size = pair.size(placed.offset);
        // A body with a radius has an inside.
        if pair.radius() > Scalar::ZERO || !is_moderate(size) {
            return None;
        }
        let frame = Frame::new(&mut pair, placed.offset, size);
        let mut state = Gjk::new(axis);
        let options = GjkOptions::new(axis, SignedDistanceOptions::<V>::new().max_iterations);
        let _ = gjk(&mut state, &mut pair, frame, options, None, &mut Observer::none());
        self.count(state.iterations);
        state.ensure_measured();
        let mut corners = BodyFrameCorners::none();
        corners.keep(state.simplex.weighted().map(|(_, corner)| times(corner, frame.scale)), placed);
        (state.simplex.points().len() == V::DIM).then_some(corners)
    }

    /// How far a point of the difference may be from the chord of its path. The amount of the second derivative of each
    /// coordinate is bounded by the bounds along both directions of its axis.
    fn off_chord(&self, [from, to]: [V::Scalar; 2]) -> V::Scalar {
        let most = |n: V| self.acceleration_along(TurningPlane { from: n, to: n }, [from, to]);
        let mut m = V::Scalar::ZERO;
        for axis in (0..V::DIM).map(V::axis) {
            // One of the two bounds may be negative.
            m += most(axis).abs() + most(-axis).abs();
        }
        // A quarter in place of an eighth leaves room for rounding.
        m * (to - from) * (to - from) * Scalar::from_f64(0.25)
    }
}

/// A bound on the error of a point of the difference.
fn error_of<V: Vector>(placed: &Placed<'_, V>) -> V::Scalar {
    let pair = placed.pair();
    rounding(pair.size(placed.offset)) + pair.error()
}
