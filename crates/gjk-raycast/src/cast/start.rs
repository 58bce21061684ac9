//! Casts that begin or end in contact, or within a few errors of it: whether the start is a hit, and whether there is
//! one before the end.
//!
//! The cast's own bounds on its start have the errors of the largest number in it. A [second
//! measurement](crate::separation::near_contact_of()) may prove the source apart from the target: then a ray that
//! leaves or slides by misses, and one that approaches hits a little later.

use convex_support::numerics::bound::{raised, roundings};
use convex_support::numerics::twofold::{dot_minus, two_product};
use convex_support::{Posed, Rounded, Scalar, Vector};
use num_traits::Float;

use super::{CastHit, ObstacleCast, RayBodies};
use crate::body::PointPair;
use crate::gjk::Frame;
use crate::pair::{Shape, WithoutLines};
use crate::separation::{FromContact, NearContact, look_after, near_contact_of};
use crate::{Miss, Outcome, RayCastOptions, Status};

/// Decides by the measured gap of the bodies where the cast begins.
#[cold]
#[inline(never)]
pub(super) fn settle_start<V: Vector>(
    cast: &mut ObstacleCast<V>,
    bodies: RayBodies<'_, V>,
    options: &RayCastOptions<V>,
) {
    let RayBodies { a, skin, b, direction, .. } = bodies;
    let Ok(a) = Rounded::new(a, skin) else { return };
    let (zero, a) = (V::Scalar::ZERO, WithoutLines(&a));
    let max_iterations = options.max_iterations - cast.iterations;
    let Some(near) = near_contact_of(&a, b, max_iterations) else { return };
    let looks = &mut Looks { iterations: near.iterations, max_iterations };
    let spot = Spot { source: -near.frame.offset, points: near.points, scale: near.frame.scale };
    // The bodies are apart by `gap − λ·n·d` along the normal: the sign of the product is exact. The axis is the unit
    // vector from the target to the source.
    let axis = -near.normal;
    let closing = dot_minus((0..V::DIM).map(|i| (near.normal.get(i), direction.get(i))), zero);
    // Of a point found deep inside, no plane is one of contact.
    let is_at_plane = near.gap.abs() <= near.upper;
    let speed = direction.norm();
    let sinking = if is_at_plane { closing.max(sliding(speed)) } else { speed };
    if !near.is_separated() {
        // The source is in the target, to its own error, or nothing is known.
        if near.overlap().is_some() {
            let speed = if closing > sliding(speed) { sinking } else { speed };
            cast.touch(latest_entry([&a, b], direction, speed, &near, looks), spot);
        }
    } else if closing <= zero {
        cast.miss(axis);
    } else {
        // The ray crosses the plane between them at λ, and not before `lower`, by what the quotient loses.
        let at = |gap: V::Scalar| gap * near.frame.scale / closing;
        let (lambda, lower) = (at(near.gap), at(near.lower));
        let lower = lower - roundings(8.0, lower);
        let entry = entry([&a, b], direction, closing, &near, looks);
        if lower > options.max_lambda {
            cast.miss(axis);
        } else {
            cast.enter(lambda, axis, lower, entry, spot);
        }
    }
    if cast.outcome.is_hit()
        && cast.status == Status::Converged
        && !((cast.upper - cast.lower) * sinking <= cast.narrow)
    {
        cast.status = Status::Stalled;
    }
    cast.iterations += looks.iterations;
}

/// Decides by the measured gap of the bodies where the cast ends, if only rounding decides whether it ends before a
/// hit: if they are apart there, and still close in, they were apart before.
#[cold]
#[inline(never)]
pub(super) fn settle_end<V: Vector>(cast: &mut ObstacleCast<V>, bodies: RayBodies<'_, V>, options: &RayCastOptions<V>) {
    let RayBodies { a, skin, b, direction, direction_error } = bodies;
    let (zero, end) = (V::Scalar::ZERO, options.max_lambda);
    let step = direction * end;
    // What the products lose is known unless they are too small.
    let least = V::Scalar::min_positive_value() / V::Scalar::EPSILON;
    if (0..V::DIM).any(|i| step.get(i).abs() < least && direction.get(i) != zero && end != zero) {
        return;
    }
    let lost = V::from_fn(|i| two_product(direction.get(i), end)[1]).norm() + direction_error * step.norm();
    let (Ok(a), Ok(b)) = (Rounded::new(a, skin), Posed::translated(b, step)) else { return };
    let max_iterations = options.max_iterations - cast.iterations;
    let Some(near) = near_contact_of(&WithoutLines(&a), &WithoutLines(&b), max_iterations) else { return };
    cast.iterations += near.iterations;
    let closing = dot_minus((0..V::DIM).map(|i| (near.normal.get(i), direction.get(i))), zero);
    // A hit at the end belongs to the ray, and so does one that is later by no more than its own rounding.
    let rounded = lost + lost + roundings(2.0, closing * end);
    if near.is_separated() && closing > zero && near.lower * near.frame.scale > rounded {
        cast.miss(-near.normal);
    } else if lost == zero && (near.overlaps_certainly || near.upper <= zero) {
        cast.upper = end;
        if let Outcome::Hit(hit) = &mut cast.outcome {
            hit.lambda = hit.lambda.min(end);
        }
    }
}

/// The place of the source relative to the target's origin, the closest points of both, and the unit of these
/// lengths.
#[derive(Clone, Copy)]
struct Spot<V: Vector> {
    source: V,
    points: PointPair<V>,
    scale: V::Scalar,
}

/// A bound on the λ at which the ray is in the target first, if the source is not proved apart from it; infinite if
/// it may miss.
fn latest_entry<V: Vector>(
    shapes: [Shape<'_, V>; 2],
    direction: V,
    speed: V::Scalar,
    near: &NearContact<V>,
    looks: &mut Looks,
) -> V::Scalar {
    let zero = V::Scalar::ZERO;
    if near.overlaps_certainly || near.upper <= zero {
        return zero;
    }
    entry(shapes, direction, speed, near, looks).certain()
}

/// The vector from a point of the target to the source, in the world's unit.
fn from_contact<V: Vector>(near: &NearContact<V>) -> FromContact<V> {
    let &NearContact { normal: n, lower, upper, frame: Frame { scale, .. }, .. } = near;
    let upper = upper.max(V::Scalar::ZERO);
    // The vector between the closest points is no longer than `upper`, and its part along the normal is at least
    // `lower`. By Pythagoras its part across the normal is no longer than this.
    let across = if near.is_separated() { raised(((upper - lower) * (upper + lower)).sqrt()) } else { upper };
    let along = if near.is_separated() { upper } else { V::Scalar::ZERO };
    FromContact { n, along: along * scale, across: across * scale, length: upper * scale }
}

/// Closing speeds up to this may be rounding: a normal is known to a few ε.
fn sliding<S: Scalar>(speed: S) -> S {
    speed * S::EPSILON * S::from_f64(16.0)
}

/// A bound on the λ at which a ray is in the target first, if it ever is.
#[derive(Clone, Copy)]
struct LatestEntry<S> {
    at: S,
    /// Whether it is in the target there, and not outside from there on.
    is_certain: bool,
}

impl<S: Scalar> LatestEntry<S> {
    /// The bound if the ray is certainly in the target; infinite otherwise.
    fn certain(self) -> S {
        if self.is_certain { self.at } else { Float::infinity() }
    }
}

/// How many support points a depth takes after its last look at how many it has taken.
const MORE_POINTS: usize = 8;

/// The support points left for further measurements.
struct Looks {
    iterations: usize,
    max_iterations: usize,
}

impl Looks {
    /// The number left for a depth, which may take a few more than its limit; `None` if there are none.
    fn left(&self) -> Option<usize> {
        self.max_iterations.checked_sub(self.iterations + MORE_POINTS).filter(|&left| left > 0)
    }
}

/// The most places of a ray that are tested, each at most half as far from the source as the one before.
const MAX_PLACES: usize = 12;

/// The most places in a row that may give no result. If a convex function is zero to an error at the source and at
/// two more places, the middle one halfway, it is no less than three errors below zero in between.
const IDLE_PLACES: usize = 2;

/// The least depth of the ray at a place, as a part of the depth that its speed predicts.
const LEAST_PART: f64 = 0.25;

/// How far aside the points are by which it is found, in units of that: far enough for little of a depth under a plane
/// to be lost; and beside an edge or a rim, where that told nothing, near enough for the corners not to cut the ray
/// off.
const BESIDE_THE_RAY: f64 = 4.0;
const AT_EDGE: f64 = 1.0;

/// Where a ray enters whose source is near the target, and which closes in with a `speed`.
///
/// Example: a ball rests on a floor, and a ray from the point of contact goes into the floor at a small angle. Whether
/// the source is in the floor is rounding; a bound on the entry needs a place `x(λ)` of the ray that is certainly in
/// it.
///
/// Let `p` be the point of the target closest to the source `s`, and `e = s − p`. A look at `x(λ)` finds a number `k`
/// for which the point `q = x(λ) + k·e` is in the target. The source is at `p + e`, so that the segment from `p` to `q`
/// crosses the ray, after `λ/(1 + k)`. The target is convex, and the crossing is in it.
///
/// If `x(λ)` is farther from the target than `s` is, the distance, a convex function along the ray, grows from there
/// on, and the ray left the target before `λ`. Halfway between the entry and the exit the ray is at least half as deep
/// as anywhere. So each look that finds the ray outside bounds the exit, and the next look is at half that parameter.
fn entry<V: Vector>(
    [a, b]: [Shape<'_, V>; 2],
    direction: V,
    speed: V::Scalar,
    near: &NearContact<V>,
    looks: &mut Looks,
) -> LatestEntry<V::Scalar> {
    let (zero, number) = (V::Scalar::ZERO, V::Scalar::from_f64);
    let from = from_contact(near);
    let size = a.core().size() + b.core().size();
    let gap = from.length;
    // Bodies that touch have their origins no farther apart than their sizes.
    let past = (size + size + gap) / direction.norm();
    let mut best = LatestEntry { at: past + roundings(16.0, past), is_certain: false };
    let (mut lambda, mut dull) = (past * number(0.125), 0);
    for _ in 0..MAX_PLACES {
        let step = direction * lambda;
        let Some(left) = looks.left() else { break };
        // NaN ends this too.
        let Ok(moved) = Posed::translated(b, step) else { break };
        let moved = WithoutLines(&moved);
        let fall = lambda * speed;
        let aside = number(if dull > 0 { AT_EDGE } else { BESIDE_THE_RAY });
        // The step is rounded, coordinate by coordinate.
        let rounded = roundings(4.0, step.norm());
        let there = look_after([a, &moved], &from, [aside * fall, rounded], left);
        looks.iterations += there.iterations;
        if there.times > zero {
            let at = lambda / (there.times + V::Scalar::ONE);
            let at = at + roundings(16.0, at);
            // Nearer to the source it is deeper for how far it has gone, but not by much where it already is.
            let is_enough = there.times * gap >= fall * number(LEAST_PART) || at + at > best.at;
            best = LatestEntry { at: best.at.min(at), is_certain: true };
            if is_enough && there.times >= V::Scalar::ONE {
                break;
            }
        }
        lambda = if there.lower > gap {
            // A plane that tells so was crossed earlier.
            // The product is right to a few roundings.
            let leaving = -there.axis.dot(direction) + roundings(8.0, direction.norm());
            let since = there.lower / leaving;
            let at = if leaving > zero { lambda - (since - roundings(16.0, lambda)) } else { lambda };
            best.at = best.at.min(at.max(zero));
            dull = 0;
            lambda.min(best.at) * number(0.5)
        } else {
            dull += usize::from(!(there.times > zero));
            lambda * number(0.5)
        };
        if dull >= IDLE_PLACES || !(lambda * speed > gap) {
            break;
        }
    }
    best
}

impl<V: Vector> ObstacleCast<V> {
    fn miss(&mut self, axis: V) {
        (self.lower, self.upper) = (Float::infinity(), Float::infinity());
        (self.outcome, self.status) = (Outcome::Miss(Miss { axis }), Status::Converged);
    }

    /// A hit at the source.
    fn touch(&mut self, within: V::Scalar, spot: Spot<V>) {
        let zero = V::Scalar::ZERO;
        if matches!(self.outcome, Outcome::Undecided) {
            self.hit(zero, None, spot);
        }
        let lambda = match &self.outcome {
            Outcome::Hit(hit) => hit.lambda,
            _ => zero,
        };
        (self.lower, self.upper, self.status) = (zero, within.max(lambda), Status::Converged);
    }

    /// Turns a hit at the source, as known so far, into one at `lambda`, if a plane across `axis` excludes any hit
    /// before `lower`.
    fn enter(&mut self, lambda: V::Scalar, axis: V, lower: V::Scalar, entry: LatestEntry<V::Scalar>, spot: Spot<V>) {
        self.lower = self.lower.max(lower);
        let upper = entry.certain().max(self.lower);
        let is_found = entry.is_certain || self.lower <= entry.at;
        match &mut self.outcome {
            Outcome::Hit(hit) if is_found => {
                (self.upper, self.status) = (upper, Status::Converged);
                (hit.lambda, hit.normal) = (lambda.max(self.lower).min(upper), Some(axis));
            }
            Outcome::Undecided if entry.is_certain => {
                self.upper = upper;
                self.hit(lambda.max(self.lower).min(upper), Some(axis), spot);
            }
            // The ray runs along the target within rounding, and where it enters, if ever, is not known.
            Outcome::Undecided => {}
            _ => {
                (self.outcome, self.upper, self.status) = (Outcome::Undecided, V::Scalar::infinity(), Status::Stalled);
            }
        }
    }

    /// A hit that the search did not find, at the closest points at the source.
    fn hit(&mut self, lambda: V::Scalar, normal: Option<V>, Spot { source, points, scale }: Spot<V>) {
        let hit = CastHit { lambda, normal, spot: source, witness: points };
        (self.outcome, self.status, self.scale) = (Outcome::Hit(hit), Status::Converged, scale);
    }
}
