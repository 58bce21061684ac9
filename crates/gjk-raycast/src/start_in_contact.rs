//! Casts that begin in contact: the contact, and whether the motion goes deeper into it.

use convex_support::{Posed, Scalar, Vector};
use num_traits::Float as _;

use crate::cast::sliding;
use crate::distance::distance_of_any;
use crate::shape::{Shape, WithoutLines};
use crate::signed_distance::signed_distance_of_any;
use crate::{
    DistanceOptions, Impact, LinearCast, LinearCastOptions, Motion, Outcome, SignedDistance, SignedDistanceOptions,
};

/// How far on shapes are tested first, in units of their uncertainty; how much farther each time; and how often at
/// most, which is beyond their sizes in any precision.
const FIRST: f64 = 64.0;
const FARTHER: f64 = 8.0;
const LOOKS: usize = 18;

/// Two shapes at the start of a cast. They are behind pointers, so that rare queries are compiled once.
pub(crate) struct StartingPair<'s, V: Vector> {
    pub(crate) a: Shape<'s, V>,
    pub(crate) b: Shape<'s, V>,
    /// How far apart they count as touching.
    pub(crate) target: V::Scalar,
}

impl<V: Vector> StartingPair<'_, V> {
    /// Returns a hit at the start by a point of both shapes, and the normal if they only touch: the entry that the cast
    /// finds is behind the start or, if they slide, ahead of it.
    #[cold]
    #[inline(never)]
    pub(crate) fn touch(&self, answer: &mut LinearCast<V>, options: &LinearCastOptions<V>) {
        let zero = V::Scalar::ZERO;
        let left = |taken: usize| options.max_iterations.saturating_sub(taken);
        let wanted = DistanceOptions::new().with_max_iterations(left(answer.iterations));
        let at_start = distance_of_any(self.a, self.b, wanted.with_sub_algorithm(options.sub_algorithm));
        answer.iterations += at_start.iterations;
        let max_iterations = left(answer.iterations);
        let start = self.signed_distance(&LinearCastOptions { max_iterations, ..*options }, zero);
        answer.iterations += start.iterations;
        let only_touches = start.upper >= self.target;
        if !only_touches {
            // They are certainly deeper than touching, whatever the motion.
            answer.upper = zero;
        }
        let normal = only_touches.then_some(start.normal);
        answer.outcome = Outcome::Hit(Impact { time: zero, point: at_start.point_b, normal });
    }

    /// The signed distance at the start; the search stops as soon as the depth is certain to exceed a limit.
    fn signed_distance(&self, options: &LinearCastOptions<V>, depth_limit: V::Scalar) -> SignedDistance<V> {
        let mut wanted = SignedDistanceOptions::new().with_depth_limit(depth_limit);
        wanted.max_iterations = wanted.max_iterations.min(options.max_iterations);
        wanted.axis = options.warm_start.map(|warm| warm.axis);
        signed_distance_of_any(self.a, self.b, wanted)
    }

    /// The contact of shapes that touch or overlap at the start, to a slack that is the rounding of their places;
    /// `None` if they are certainly apart by more.
    ///
    /// The depth of a point in a convex set is a concave function of the point: it is the least of the distances from
    /// the supporting planes. So if it falls at first along a line, it falls along all of it; and if it is more
    /// anywhere along the line than at the start, it grows from the start on. Where the depth is `−s`, along the normal
    /// `n`, it changes by `−n·w` with the relative velocity `w` of `a`; if several ways out are equally short, or the
    /// shapes touch at corners, by the least of these. Then `n` is one of many normals, and the shapes may part along
    /// another one although they close in along `n`. So it counts whether they are certainly deeper later.
    #[cold]
    #[inline(never)]
    pub(crate) fn of_motion(
        &self,
        motion: Motion<V>,
        options: &LinearCastOptions<V>,
        slack: V::Scalar,
    ) -> Option<InContact<V>> {
        let start = self.signed_distance(options, V::Scalar::infinity());
        if !(start.lower <= self.target + slack) {
            return None;
        }
        let velocity = motion.velocity_a - motion.velocity_b;
        let (speed, closing) = (velocity.norm(), -start.normal.dot(velocity));
        if !(closing > sliding(speed)) {
            return Some(InContact { start, leaves_along: Some(start.normal) });
        }
        // If the depth is known to rounding, a motion that never shows a change slides.
        let slides = start.upper >= self.target - slack || start.upper - start.lower <= slack;
        let leaves_along = match self.later(velocity, speed / closing, &start, slack) {
            Later::Deeper => None,
            Later::Less(normal) => Some(normal),
            Later::Unknown(normal) => slides.then_some(normal),
        };
        Some(InContact { start, leaves_along })
    }

    /// Whether the shapes get deeper than they start as they move along a velocity, so many times as far as they come
    /// nearer along the normal. They are tested so far on that it shows, if the normal is the only one, to as far as
    /// their sizes.
    fn later(&self, velocity: V, per_depth: V::Scalar, start: &SignedDistance<V>, slack: V::Scalar) -> Later<V> {
        let SignedDistance { upper, lower, normal, .. } = *start;
        let size = self.a.core().size() + self.b.core().size() + self.target;
        let unit = velocity.unit().unwrap_or(V::ZERO);
        let mut step = (slack + (upper - lower)) * per_depth * V::Scalar::from_f64(FIRST);
        let mut last = normal;
        for _ in 0..LOOKS {
            if !(step < size) {
                break;
            }
            let Ok(moved) = Posed::translated(self.a, unit * step) else { break };
            let there = signed_distance_of_any(&WithoutLines(&moved), self.b, SignedDistanceOptions::new());
            if there.upper < lower.min(self.target - slack) {
                return Later::Deeper;
            }
            if there.lower > upper {
                return Later::Less(there.normal);
            }
            last = there.normal;
            step *= V::Scalar::from_f64(FARTHER);
        }
        Later::Unknown(last)
    }
}

/// Whether shapes in contact are deeper later than at the start; if not, with the normal.
enum Later<V> {
    Deeper,
    Less(V),
    Unknown(V),
}

/// Two shapes in contact.
pub(crate) struct InContact<V: Vector> {
    pub(crate) start: SignedDistance<V>,
    /// If the motion does not go deeper: the direction from `b` to `a` along which it leaves, or slides.
    pub(crate) leaves_along: Option<V>,
}
