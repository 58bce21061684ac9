//! Shapes that move straight and may be in contact at the start: how they touch there, and whether they get deeper.
//!
//! A [`linear_cast`](crate::linear_cast()) asks only where it finds a hit at its start, or may not count one there. The
//! signed distance of the shapes answers, at the start and at places along the motion.

use convex_support::numerics::bound::{raised, roundings};
use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Hint, Posed, Scalar, Vector};
use num_traits::Float as _;

use crate::cast::RareInRayCasts;
use crate::distance::distance_of_any;
use crate::options::MayBeLean as _;
use crate::pair::{Shape, WithoutLines};
use crate::signed_distance::signed_distance_of_any;
use crate::{
    Cast, DistanceOptions, HalfSpace, Impact, Outcome, RayCastOptions, SignedDistance, SignedDistanceOptions, Status,
    SubAlgorithm,
};

/// The number of places along a motion that are looked at, at most.
const MAX_PLACES_ON_WAY: usize = 24;

/// What a lean linear cast leaves out: what a ray cast does, and the measurements of shapes in contact at the start.
pub(crate) struct RareInLinearCasts<V: Vector> {
    pub(crate) in_ray_casts: &'static RareInRayCasts<V>,
    pub(crate) touch: fn(&StartingPair<'_, V>, &mut Cast<Impact<V>, V>),
    pub(crate) of_motion: fn(&StartingPair<'_, V>, &mut usize) -> Option<Later<V>>,
}

impl<V: Vector> RareInLinearCasts<V> {
    pub(crate) const TABLE: Self = Self {
        in_ray_casts: &RayCastOptions::TABLE,
        touch: |start, answer| start.touch(answer),
        of_motion: |start, iterations| start.of_motion(iterations),
    };
}

/// Two shapes at the start of a cast. They are behind pointers, so that rare queries are compiled once.
pub(crate) struct StartingPair<'s, V: Vector> {
    pub(crate) a: Shape<'s, V>,
    pub(crate) b: Shape<'s, V>,
    pub(crate) velocities: [V; 2],
    /// How far apart they count as touching.
    pub(crate) target: V::Scalar,
    /// How much less, or more, may be rounding of their places. Shapes that are deeper by no more only touch.
    pub(crate) slack: V::Scalar,
    /// A first guess of the direction from `b` to `a`.
    pub(crate) axis: Option<V>,
    pub(crate) max_iterations: usize,
    pub(crate) sub_algorithm: SubAlgorithm,
}

/// What is proved of shapes that may be in contact at the start.
pub(crate) enum Later<V: Vector> {
    /// They are apart there.
    Apart,
    /// They get deeper, from the start on, or if they are apart by the slack, from `upper` on at the latest.
    Deeper { upper: V::Scalar, point: V, normal: V },
    /// They never get deeper, but leave, or slide, along this direction from `b` to `a`.
    Never(V),
}

impl<V: Vector> StartingPair<'_, V> {
    /// Returns a hit at the start by a point of both shapes, and the normal if they only touch: the entry that the cast
    /// finds is behind the start or, if they slide, ahead of it.
    #[cold]
    #[inline(never)]
    fn touch(&self, answer: &mut Cast<Impact<V>, V>) {
        let zero = V::Scalar::ZERO;
        let left = |taken: usize| self.max_iterations.saturating_sub(taken);
        let wanted = DistanceOptions::new().with_max_iterations(left(answer.iterations));
        let at_start = distance_of_any(self.a, self.b, wanted.with_sub_algorithm(self.sub_algorithm));
        answer.iterations += at_start.iterations;
        let max_iterations = left(answer.iterations);
        let enough = (self.slack - self.target).max(zero);
        let start = StartingPair { max_iterations, ..*self }.signed_distance(enough);
        answer.iterations += start.iterations;
        if start.upper < self.target {
            // They certainly have points in common, whatever the motion.
            (answer.upper, answer.status) = (zero, Status::Converged);
        }
        let normal = (start.upper >= self.target - self.slack).then_some(start.normal);
        answer.outcome = Outcome::Hit(Impact { time: zero, point: at_start.point_b, normal });
    }

    /// The signed distance at the start; the search stops as soon as the depth is certain to exceed a limit.
    fn signed_distance(&self, depth_limit: V::Scalar) -> SignedDistance<V> {
        let mut wanted = SignedDistanceOptions::new().with_depth_limit(depth_limit);
        wanted.max_iterations = wanted.max_iterations.min(self.max_iterations);
        wanted.axis = self.axis;
        signed_distance_of_any(self.a, self.b, wanted)
    }

    /// Whether shapes that touch or overlap at the start, to a slack that is the rounding of their places, get deeper
    /// by more than that as they move; `None` if that is not proved.
    ///
    /// The signed distance `s` of bodies that move straight is a convex function of time: it is the greatest of the
    /// lines `g − c·t` of all planes, each of which keeps the shapes apart by `g` at the start, and is closed in on at
    /// a speed `c`. So shapes get deeper at once or never, and never do if they were deeper before the start.
    #[cold]
    #[inline(never)]
    fn of_motion(&self, iterations: &mut usize) -> Option<Later<V>> {
        let start = self.signed_distance(V::Scalar::infinity());
        *iterations += start.iterations;
        if !(start.lower <= self.target + self.slack) {
            return Some(Later::Apart);
        }
        let mut later = |velocities| StartingPair { velocities, ..*self }.later(&start, iterations);
        later(self.velocities).or_else(|| match later(self.velocities.map(|velocity| -velocity)) {
            Some(Later::Deeper { .. }) => Some(Later::Never(start.normal)),
            _ => None,
        })
    }

    /// The same, as far as the places after the start tell: two lines, of a plane that is closed in on and of one that
    /// is not, bound `s` from below by the height at which they cross. Perhaps shapes never get deeper than that.
    /// Otherwise they are looked at when the lines cross: either they are deeper then, or the line of the nearest plane
    /// there takes the place of one of both. This ends soon if `s` has kinks. If it is smooth, each second look is
    /// where its slope is zero if that changes evenly.
    fn later(&self, start: &SignedDistance<V>, iterations: &mut usize) -> Option<Later<V>> {
        let (zero, [velocity_a, velocity_b]) = (V::Scalar::ZERO, self.velocities);
        let velocity = velocity_a - velocity_b;
        let Some(along) = velocity.unit() else { return (velocity == V::ZERO).then_some(Later::Never(start.normal)) };
        let lost = lost_in_sum(velocity_a, -velocity_b).norm();
        // Of numbers out of range nothing is known.
        let slack = Some(self.slack).filter(|slack| slack.is_finite())?;
        let [never, deeper] = [start.upper, start.lower].map(|s| s.min(self.target) - slack);
        let mut before = self.line(start.normal, zero)?;
        let mut after = if before.closing > zero { self.line(along, V::Scalar::infinity())? } else { before };
        for look in 0..MAX_PLACES_ON_WAY {
            let closing = before.closing - after.closing;
            // It is zero if the quotient is NaN, since there is only one line.
            let crossing = ((before.gap - after.gap) / closing).max(zero);
            // The first line is higher before that, and the second one after it. That is all the time after the start
            // if they cross before it, and then no look tells more.
            let least = if crossing > zero { before.at(crossing).min(after.at(crossing)) } else { after.gap };
            if least >= never {
                // A plane that is left, and keeps the shapes as far apart as they began, or else the one through the
                // crossing of both lines, which is neither left nor closed in on. Where both normals are nearly
                // opposite, as at a needle, that one is deeper than either by the quotient of the lengths.
                let level = before.normal * -after.closing + after.normal * before.closing;
                let height = (before.gap * -after.closing + after.gap * before.closing) / level.norm();
                let is_kept = !(crossing > zero) || after.gap >= start.lower.min(self.target) || !(height > after.gap);
                let best = if after.gap >= never { after.normal } else { before.normal };
                return Some(Later::Never(if is_kept { best } else { level.unit().unwrap_or(best) }));
            }
            let is_smooth = look % 2 == 1 && after.time < V::Scalar::infinity();
            let level = before.time + (after.time - before.time) * (before.closing / closing);
            let time = if is_smooth { level } else { crossing };
            if !(time > zero) {
                return None;
            }
            let step = velocity * time;
            let moved = Posed::translated(self.a, step).ok()?;
            let moved = StartingPair { a: &WithoutLines(&moved), b: self.b, ..*self };
            // The place is rounded, and so is the velocity.
            let off = roundings(2.0, step.norm()) + raised(lost * time);
            let there = moved.signed_distance((off - deeper).max(zero));
            *iterations += there.iterations + 1;
            let upper = there.upper + off;
            if upper < deeper {
                // They are deeper from the start on. If they may begin apart, by the slack, they touch no later than
                // where the chord of the convex function does.
                let touching = (start.upper - self.target).max(zero) / (start.upper - upper) * time;
                let upper = touching + roundings(8.0, touching);
                return Some(Later::Deeper { upper, point: start.point_b, normal: start.normal });
            }
            // The least is between the bounds that would prove either, however exactly it is known.
            if least >= deeper && upper < never {
                return None;
            }
            let line = self.line(there.normal, time)?;
            *(if line.closing > zero { &mut before } else { &mut after }) = line;
        }
        None
    }

    /// The line of the plane across a direction that keeps the shapes farthest apart, found when they have moved for
    /// some time.
    fn line(&self, direction: V, time: V::Scalar) -> Option<GapAlong<V>> {
        let plane = HalfSpace::new(direction, V::Scalar::ZERO).ok()?.plane();
        let [core_a, core_b] = [self.a.core(), self.b.core()];
        let point_a = self.a.core_support(-direction, &mut Hint::new());
        let point_b = self.b.core_support(direction, &mut Hint::new());
        let error = plane.error_along(&self.a.rounding()) + plane.error_along(&self.b.rounding());
        let terms = [core_a.origin, point_a, -core_b.origin, -point_b];
        let gap = plane.height(terms, error, core_a.radius + core_b.radius).least();
        let [velocity_a, velocity_b] = self.velocities;
        let closing = plane.sinking([velocity_a, -velocity_b]).most();
        Some(GapAlong { gap, closing, normal: direction, time })
    }
}

/// A lower bound of the signed distance of two shapes, by a plane between them: no more than the `gap` at the start,
/// and `closing` less in each unit of time.
#[derive(Clone, Copy)]
struct GapAlong<V: Vector> {
    gap: V::Scalar,
    closing: V::Scalar,
    normal: V,
    /// The time at which the plane is nearest to contact.
    time: V::Scalar,
}

impl<V: Vector> GapAlong<V> {
    /// The bound at a time.
    fn at(&self, time: V::Scalar) -> V::Scalar {
        let way = self.closing * time;
        self.gap - way - roundings(4.0, self.gap.abs() + way.abs())
    }
}
