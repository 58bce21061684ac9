//! Where a cast begins in contact, or within a few errors of it: whether that is a hit.
//!
//! What a cast knows of its start is known to the errors of the largest number in it. Looked at [once
//! more](crate::separation::near_contact_of()), a source may turn out to be apart from the target: then a ray that leaves or
//! slides by misses, and one that approaches hits a little later.

use convex_support::numerics::bound::{raised, roundings};
use convex_support::numerics::twofold::dot_minus;
use convex_support::{Point, Posed, Rounded, Scalar, Vector};
use num_traits::Float;

use super::{Cast, CastHit};
use crate::body::PointPair;
use crate::gjk::Frame;
use crate::separation::{FromContact, NearContact, look_after, near_contact_of};
use crate::shape::{Shape, WithoutLines};
use crate::{Miss, Outcome, RayCastOptions, Status};

/// Who draws a ray as it moves: a shape, or the point at the ray's source.
pub(crate) enum RayOf<'s, V: Vector> {
    Shape(Shape<'s, V>),
    Point(V),
}

/// Decides about a hit that may be at the source, or about a search that stalled before it left it, of the ray that `b`
/// draws as it moves along `direction` towards `a` swept by a ball, its skin.
#[inline(always)]
pub(crate) fn settle_start<V: Vector>(
    cast: &mut Cast<V>,
    a: Shape<'_, V>,
    skin: V::Scalar,
    b: RayOf<'_, V>,
    direction: V,
    options: &RayCastOptions<V>,
) {
    let zero = V::Scalar::ZERO;
    let is_at_start = match &cast.outcome {
        Outcome::Hit(_) => cast.lower == zero,
        Outcome::Undecided => cast.status == Status::Stalled && cast.lower == zero,
        Outcome::Miss(_) => false,
    };
    let is_to_be_settled = is_at_start && cast.upper > zero;
    if (is_to_be_settled || cast.is_open)
        && cast.iterations < options.max_iterations
        && let Some(extra) = options.extra.get()
    {
        (extra.settle)(cast, a, skin, b, direction, options, is_to_be_settled);
    }
}

pub(super) type SettleFn<V> =
    fn(&mut Cast<V>, Shape<'_, V>, <V as Vector>::Scalar, RayOf<'_, V>, V, &RayCastOptions<V>, bool);

/// The second look at a cast whose hit may be at the source, or elsewhere and open.
#[cold]
#[inline(never)]
pub(super) fn settle<V: Vector>(
    cast: &mut Cast<V>,
    a: Shape<'_, V>,
    skin: V::Scalar,
    b: RayOf<'_, V>,
    direction: V,
    options: &RayCastOptions<V>,
    is_to_be_settled: bool,
) {
    let left = options.max_iterations - cast.iterations;
    let Ok(a) = Rounded::new(a, skin) else { return };
    let (point, source);
    let b: Shape<'_, V> = match b {
        RayOf::Shape(b) => b,
        RayOf::Point(at) => {
            let Ok(at) = Point::new(at) else { return };
            point = at;
            source = WithoutLines(&point);
            &source
        }
    };
    let (a, b) = (&WithoutLines(&a), b);
    if !is_to_be_settled {
        if let Outcome::Hit(CastHit { lambda, .. }) = cast.outcome {
            let after = after_hit(a, b, direction, lambda, left);
            cast.iterations += after.iterations;
            cast.upper = cast.upper.min(after.latest);
        }
        return;
    }
    let start = start(a, b, direction, left);
    cast.iterations += start.iterations;
    match start.way {
        Way::Touches { within } => cast.touch(within, start.spot),
        Way::Unknown => {}
        Way::Leaves { axis } => cast.miss(axis),
        // Whether a hit at the very end of the ray counts is decided by λ as it is returned.
        Way::Enters { lambda, axis, lower, .. } if lambda > options.max_lambda => {
            cast.miss(axis);
            if lower <= options.max_lambda {
                cast.lower = lower;
            }
        }
        Way::Enters { lambda, axis, lower, entry } => cast.enter(lambda, axis, lower, entry, start.spot),
    }
}

/// How the bodies are to one another where the cast begins.
struct StartLook<V: Vector> {
    way: Way<V>,
    spot: Spot<V>,
    iterations: usize,
}

/// Where the source is, relative to the target's origin, the points of both closest to one another, and the unit of
/// these lengths.
#[derive(Clone, Copy)]
struct Spot<V: Vector> {
    source: V,
    points: PointPair<V>,
    scale: V::Scalar,
}

/// How a ray goes on from a source near the target. The axis is a unit vector from the target to the source, along
/// which they are apart.
enum Way<V: Vector> {
    /// The source is in the target, to the error it is known to; and the ray is in it for certain at this λ at the
    /// latest.
    Touches { within: V::Scalar },
    /// Neither that nor a plane between them is found.
    Unknown,
    /// It is apart, and the ray comes no nearer along the axis.
    Leaves { axis: V },
    /// It is apart, and the ray crosses the plane between them at λ, and not before `lower`.
    Enters { lambda: V::Scalar, axis: V, lower: V::Scalar, entry: LatestEntry<V::Scalar> },
}

#[cold]
#[inline(never)]
fn start<V: Vector>(a: Shape<'_, V>, b: Shape<'_, V>, direction: V, max_iterations: usize) -> StartLook<V> {
    let zero = V::Scalar::ZERO;
    let Some(near) = near_contact_of(a, b, max_iterations) else {
        let spot = Spot { source: V::ZERO, points: PointPair::default(), scale: V::Scalar::ONE };
        return StartLook { way: Way::Unknown, spot, iterations: 0 };
    };
    // The bodies are apart by `gap − λ·n·d` along the normal: the sign of the product is exact.
    let axis = -near.normal;
    let closing = dot_minus((0..V::DIM).map(|i| (near.normal.get(i), direction.get(i))), zero);
    let mut looks = Looks { iterations: near.iterations, max_iterations };
    let way = if !near.is_separated() {
        if near.overlap().is_some() {
            Way::Touches { within: latest_entry([a, b], direction, closing, &near, &mut looks) }
        } else {
            Way::Unknown
        }
    } else if closing <= zero {
        Way::Leaves { axis }
    } else {
        let at = |gap: V::Scalar| gap * near.frame.scale / closing;
        // What the quotient loses.
        let lower = at(near.lower);
        let lower = lower - roundings(8.0, lower);
        let entry = entry([a, b], direction, closing, (&from_contact(&near, zero), zero), &mut looks);
        Way::Enters { lambda: at(near.gap), axis, lower, entry }
    };
    let spot = Spot { source: -near.frame.offset, points: near.points, scale: near.frame.scale };
    StartLook { way, spot, iterations: looks.iterations }
}

/// A bound on the λ at which the ray is in the target first, where the source is not known to be apart from it;
/// infinite where it may miss.
fn latest_entry<V: Vector>(
    shapes: [Shape<'_, V>; 2],
    direction: V,
    closing: V::Scalar,
    near: &NearContact<V>,
    looks: &mut Looks,
) -> V::Scalar {
    let zero = V::Scalar::ZERO;
    if near.overlaps_certainly || near.upper <= zero {
        return zero;
    }
    // Of a point found deep inside, no plane is one of contact.
    let is_at_plane = near.gap.abs() <= near.upper;
    let speed = direction.norm();
    let slides = speed * V::Scalar::EPSILON * V::Scalar::from_f64(SLIDES);
    let speed = if is_at_plane && closing > slides { closing } else { speed };
    entry(shapes, direction, speed, (&from_contact(near, zero), zero), looks).certain()
}

/// The vector from a point of the target to the source, in the world's unit, where either may be moved by `astray`.
fn from_contact<V: Vector>(near: &NearContact<V>, astray: V::Scalar) -> FromContact<V> {
    let &NearContact { normal: n, lower, upper, frame: Frame { scale, .. }, .. } = near;
    let upper = upper.max(V::Scalar::ZERO);
    // Of a vector no longer than `upper`, this is left across a unit vector along which it is at least `lower`.
    let across = if near.is_separated() { raised(((upper - lower) * (upper + lower)).sqrt()) } else { upper };
    let along = if near.is_separated() { upper } else { V::Scalar::ZERO };
    let in_world = |length: V::Scalar| length * scale + astray;
    FromContact { n, along: in_world(along), across: in_world(across), length: in_world(upper) }
}

/// Closing speeds below this many ε of the speed are of rounding: a normal is known to a few.
const SLIDES: f64 = 16.0;

/// A bound on the λ at which a ray is in the target first, if it ever is.
#[derive(Clone, Copy)]
struct LatestEntry<S> {
    at: S,
    /// Whether it is in the target there, and not outside from there on.
    is_certain: bool,
}

impl<S: Scalar> LatestEntry<S> {
    /// The same bound of a ray that is in the target for certain; infinite of others.
    fn certain(self) -> S {
        if self.is_certain { self.at } else { Float::infinity() }
    }
}

/// How many support points a depth takes after its last look at how many it has taken.
const MORE: usize = 8;

/// The support points that looks take, of those that may be taken.
struct Looks {
    iterations: usize,
    max_iterations: usize,
}

impl Looks {
    /// As many as are left for a depth, which may take a few more than it is to; `None` where none are.
    fn left(&self) -> Option<usize> {
        self.max_iterations.checked_sub(self.iterations + MORE).filter(|&left| left > 0)
    }
}

/// How often a ray is looked at, each time at most half as far from the source as before.
const LOOKS: usize = 12;

/// How often in a row it is looked at where that told nothing. Of a convex function that is zero to an error at the
/// source and at two more places, the middle one halfway, the rest in between is no less than three errors below
/// zero.
const PATIENCE: usize = 2;

/// How deep the ray is to be found at least, as a part of how deep it is going by its speed.
const DEEP: f64 = 0.25;

/// How far aside the points are by which it is found, in units of that: far enough for little of a depth under a plane
/// to be lost; and beside an edge or a rim, where that told nothing, near enough for the corners not to cut the ray
/// off.
const ASIDE: f64 = 4.0;
const AT_EDGE: f64 = 1.0;

/// Where a ray enters whose source is near the target, and which closes in with a `speed`. The source and what is seen
/// from there may be moved by `astray`.
///
/// Let `e` be the vector from a point of the target to the source, and the target contain, about the ray after `λ`,
/// that vector `k` times: a point of the target is opposite to the first one, and the segment between both crosses the
/// ray after `λ/(1 + k)`, since the target is convex. For the same reason, where the source is no farther from it than
/// `g`, and the ray is after `λ`, the distance grows from there on. In the middle between the entry and the exit the
/// ray is at least half as deep as anywhere: each look that finds it outside bounds the exit, and the next one is
/// halfway there.
fn entry<V: Vector>(
    [a, b]: [Shape<'_, V>; 2],
    direction: V,
    speed: V::Scalar,
    (from, astray): (&FromContact<V>, V::Scalar),
    looks: &mut Looks,
) -> LatestEntry<V::Scalar> {
    let (zero, number) = (V::Scalar::ZERO, V::Scalar::from_f64);
    let [core_a, core_b] = [a.core(), b.core()];
    let size = core_a.extent + core_a.radius + core_b.extent + core_b.radius;
    let gap = from.length;
    // Bodies that touch have their origins no farther apart than their sizes.
    let past = (size + size + gap) / direction.norm();
    let mut best = LatestEntry { at: past + roundings(16.0, past), is_certain: false };
    let (mut lambda, mut dull) = (past * number(0.125), 0);
    for _ in 0..LOOKS {
        let step = direction * lambda;
        let Some(left) = looks.left() else { break };
        // NaN ends this too.
        let Ok(moved) = Posed::translated(b, step) else { break };
        let moved = WithoutLines(&moved);
        let fall = lambda * speed;
        let aside = number(if dull > 0 { AT_EDGE } else { ASIDE });
        // The step is rounded, coordinate by coordinate.
        let rounded = roundings(4.0, step.norm()) + astray;
        let there = look_after([a, &moved], from, [aside * fall, rounded], left);
        looks.iterations += there.iterations;
        if there.times > zero {
            let at = lambda / (there.times + V::Scalar::ONE);
            let at = at + roundings(16.0, at);
            // Nearer to the source it is deeper for how far it has gone, but not by much where it already is.
            let is_enough = there.times * gap >= fall * number(DEEP) || at + at > best.at;
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
        if dull >= PATIENCE || !(lambda * speed > gap) {
            break;
        }
    }
    best
}

/// What is known of a hit where it is.
struct AfterHit<S> {
    /// The λ of the hit, at the latest; infinite where that is not known.
    latest: S,
    iterations: usize,
}

/// Bounds a hit away from the source from above by what is known of the bodies there, where that is less than the slope
/// at which the ray meets one plane may tell: they are known to so large an error that the next edge may be within it.
#[cold]
#[inline(never)]
fn after_hit<V: Vector>(
    a: Shape<'_, V>,
    b: Shape<'_, V>,
    direction: V,
    lambda: V::Scalar,
    max_iterations: usize,
) -> AfterHit<V::Scalar> {
    let unknown = AfterHit { latest: Float::infinity(), iterations: 0 };
    let step = direction * lambda;
    let Ok(there) = Posed::translated(b, step) else { return unknown };
    let there = WithoutLines(&there);
    let Some(near) = near_contact_of(a, &there, max_iterations) else {
        return unknown;
    };
    let mut looks = Looks { iterations: near.iterations, max_iterations };
    // The step and the direction are rounded, coordinate by coordinate.
    let astray = roundings(8.0, step.norm());
    let closing = near.normal.dot(direction);
    let speed = if closing > V::Scalar::ZERO { closing } else { direction.norm() };
    let latest =
        lambda + entry([a, &there], direction, speed, (&from_contact(&near, astray), astray), &mut looks).certain();
    AfterHit { latest: latest + roundings(4.0, latest), iterations: looks.iterations }
}

impl<V: Vector> Cast<V> {
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
        (self.lower, self.upper) = (zero, within.max(lambda));
    }

    /// Turns a hit at the source, as far as it was known, into one at `lambda`, where a plane across `axis` leaves
    /// nothing to hit before `lower`.
    fn enter(&mut self, lambda: V::Scalar, axis: V, lower: V::Scalar, entry: LatestEntry<V::Scalar>, spot: Spot<V>) {
        self.lower = self.lower.max(lower);
        let upper = entry.certain().max(self.lower);
        let is_found = entry.is_certain || self.lower <= entry.at;
        match &mut self.outcome {
            Outcome::Hit(hit) if is_found => {
                self.upper = upper;
                (hit.lambda, hit.normal) = (lambda.max(self.lower).min(upper), Some(axis));
            }
            Outcome::Undecided if entry.is_certain => {
                self.upper = upper;
                self.hit(lambda.max(self.lower).min(upper), Some(axis), spot);
            }
            // The ray runs along the target within rounding, and where it enters it, if ever, is not known.
            Outcome::Undecided => {}
            _ => {
                (self.outcome, self.upper, self.status) = (Outcome::Undecided, V::Scalar::infinity(), Status::Stalled);
            }
        }
    }

    /// A hit that the search did not find, where the points closest to one another at the source are.
    fn hit(&mut self, lambda: V::Scalar, normal: Option<V>, Spot { source, points, scale }: Spot<V>) {
        let hit = CastHit { lambda, normal, spot: source, witness: points };
        (self.outcome, self.status, self.scale) = (Outcome::Hit(hit), Status::Converged, scale);
    }
}
