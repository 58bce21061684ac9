//! GJK: the closest points of two bodies' cores, for [`distance`](crate::distance) and
//! [`intersects`](crate::intersects) (the paper's Algorithm 2).

mod newton;
mod next_direction;
mod state;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::{CastBody as _, PointPair, ScalarFrom, TracedSupport};
use crate::observer::Observer;
use crate::pair::{Pair, Shapes};
use crate::unit::{is_moderate, lost_to_underflow, moderate, power_of_two_near, reciprocal_of_power};
use crate::{Status, SubAlgorithm};
use next_direction::NextDirection;
pub(crate) use state::{Gjk, NEAR};

/// The position of the difference of two bodies, and the unit of length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<V: Vector> {
    pub(crate) scale: V::Scalar,
    pub(crate) per_unit: V::Scalar,
    /// The difference of the origins: relative to the origin of `A − B`, zero is at minus this.
    pub(crate) offset: V,
    /// The sum of the radii of both bodies.
    pub(crate) radius: V::Scalar,
    /// How far rounding moves the points that the search compares; it resolves nothing smaller.
    pub(crate) noise: V::Scalar,
    /// The largest error of any bound.
    pub(crate) error: V::Scalar,
}

impl<V: Vector> Frame<V> {
    /// The frame of a pair with these origins and sizes; the pair is set to the frame's unit.
    #[inline]
    pub(crate) fn new<T: Shapes<Vector = V> + ?Sized>(pair: &mut Pair<'_, T>, offset: V, size: V::Scalar) -> Self {
        let scale = power_of_two_near(size);
        let per_unit = reciprocal_of_power(scale);
        pair.set_scale(scale);
        let (radius, noise) = (pair.radius() * per_unit, rounding(size) * per_unit);
        let error = noise + pair.error() * per_unit + lost_to_underflow(scale);
        Self { scale, per_unit, offset: offset * per_unit, radius, noise, error }
    }

    /// How wide the bracket on a distance may be at most that rounding alone has left, in the world's unit: the bounds
    /// that end a search differ by the noise, and each is wrong by no more than the error.
    #[inline(always)]
    pub(crate) fn widest(&self) -> V::Scalar {
        self.error * self.scale * Scalar::from_f64(3.0)
    }

    /// The distance of the cores, in the unit, of bodies that are so far apart.
    #[inline(always)]
    pub(crate) fn between_cores(&self, distance: V::Scalar) -> V::Scalar {
        distance * self.per_unit + self.radius
    }

    /// Cores no farther apart than this touch.
    #[inline(always)]
    fn touching(&self) -> V::Scalar {
        self.radius.max(self.noise)
    }
}

/// What the arithmetic of a query adds to a bound on the distance of two bodies of the given size, beside the error of
/// their support points.
///
/// With `u = ε/2`, a lower bound `n·(a − b + offset)/|n|` loses `u` of the size for the offset, `2u` for the sums, `3u`
/// for the products and `4u` for the quotient; an upper bound `|Σ wᵢ·(aᵢ − bᵢ) + offset|` loses `5u` for the weighted
/// sums, `3u` for their difference and the offset, `3u` for the length, and `4u` because the weights do not sum to
/// exactly one. The result is the larger, with one for the radii.
#[inline]
pub(crate) fn rounding<S: Scalar>(size: S) -> S {
    S::from_f64(8.0) * S::EPSILON * size
}

/// The rounding of a signed distance in the world's unit: unit vectors are so to 2ε, and the sum of the radii and the
/// two sums that the radii and the length go into round to half of that.
#[inline(always)]
pub(crate) fn slack<S: Scalar>(signed_distance: S, radius: S) -> S {
    S::from_f64(3.0) * S::EPSILON * (signed_distance.abs() + radius)
}

/// Where GJK begins and when it may end; lengths in units of the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GjkOptions<V: Vector> {
    /// The first direction from zero to the difference, of any length but zero.
    pub(crate) first: V,
    /// Stop as soon as the cores are certainly farther apart than this.
    pub(crate) limit: V::Scalar,
    /// Stop as soon as the bracket is as narrow as this, relative to the least distance of the bodies.
    pub(crate) tolerance: V::Scalar,
    /// Whether the closest points are asked for, and not only which of two bounds comes first.
    pub(crate) closest_points: bool,
    pub(crate) max_iterations: usize,
    pub(crate) sub_algorithm: SubAlgorithm,
}

impl<V: Vector> GjkOptions<V> {
    /// Asks for the closest points to rounding, from a first direction.
    #[inline(always)]
    pub(crate) fn new(first: V, max_iterations: usize) -> Self {
        Self {
            first,
            limit: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            closest_points: true,
            max_iterations,
            sub_algorithm: SubAlgorithm::Regions,
        }
    }
}

/// The first direction: the axis of an earlier query, or from one origin to the other.
#[inline(always)]
pub(crate) fn first_direction<V: Vector>(axis: Option<V>, offset: V) -> V {
    // An optional vector would go through memory, and the search wait for it.
    let usual = axis.unwrap_or(offset);
    if is_moderate(usual.length_squared()) { usual } else { unusual_direction(axis, offset) }
}

#[cold]
#[inline(never)]
fn unusual_direction<V: Vector>(axis: Option<V>, offset: V) -> V {
    axis.and_then(moderate).or_else(|| moderate(offset)).unwrap_or_else(|| Vector::axis(0))
}

/// How GJK ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Separated,
    Overlap,
    IterationLimit,
    Stalled,
}

impl End {
    pub(crate) fn status(self) -> Status {
        match self {
            Self::Separated | Self::Overlap => Status::Converged,
            Self::IterationLimit => Status::IterationLimit,
            Self::Stalled => Status::Stalled,
        }
    }
}

/// A direction of any length, and that length.
#[derive(Clone, Copy, Debug)]
struct Direction<V: Vector> {
    n: V,
    length: V::Scalar,
}

/// Runs GJK on the cores until their distance is known to rounding, or is known to exceed the limit, or not to exceed
/// the radii.
///
/// A step is first taken the fast way, by the regions of the newest point or as asked. If it brings the simplex no
/// nearer, it is taken again by a search of all faces. The bounds that end the loop do not depend on the steps: the
/// lower one is that of a plane through a support point, and the upper one is measured again before it counts.
///
/// `known` is the support point along the first direction, if there is one. The state has
/// [begun](Gjk::begin_at_closest), or has corners of its own. Not compiled into its callers: it is most of the code of
/// each of them.
#[inline(never)]
pub(crate) fn gjk<B: TracedSupport>(
    state: &mut Gjk<B::Vector>,
    body: &mut B,
    frame: Frame<B::Vector>,
    options: GjkOptions<B::Vector>,
    known: Option<(B::Vector, PointPair<B::Vector>)>,
    observer: &mut Observer<'_, B::Vector>,
) -> End {
    let end = descend(state, body, &frame, &options, known, observer);
    // Numbers out of range determine nothing.
    if !(frame.error < ScalarFrom::<B>::infinity()) {
        return End::Stalled;
    }
    // If no progress is possible any more, the cores may be within rounding of touching.
    if end == End::Stalled && state.length < ScalarFrom::<B>::infinity() {
        state.ensure_measured();
        if state.length - frame.radius <= frame.noise {
            return End::Overlap;
        }
    }
    end
}

#[inline(always)]
fn descend<B: TracedSupport>(
    state: &mut Gjk<B::Vector>,
    body: &mut B,
    frame: &Frame<B::Vector>,
    options: &GjkOptions<B::Vector>,
    mut known: Option<(B::Vector, PointPair<B::Vector>)>,
    observer: &mut Observer<'_, B::Vector>,
) -> End {
    let mut nearing = Progress::new();
    let mut looked = Direction { n: options.first, length: options.first.length() };
    let mut next_direction = NextDirection::new(options.closest_points && body.is_curved(), frame.noise);
    while state.iterations < options.max_iterations {
        let (point, witness) = known.take().unwrap_or_else(|| body.support(-looked.n));
        let w = point + frame.offset;
        let Some(reach) = state.advance(looked, w) else { return End::Stalled };
        observer.show(|| state.iterate(w, frame.scale));
        if state.lower > options.limit + frame.error {
            // The first support points give an upper bound, if there is no better one.
            if options.closest_points && state.simplex.points().is_empty() {
                state.simplex.push(w, -looked.n, witness);
            }
            return End::Separated;
        }
        let seems_closed = state.is_closed(frame, options.tolerance);
        if seems_closed {
            state.ensure_measured();
            if state.is_closed(frame, options.tolerance) {
                return if state.length - frame.radius <= frame.noise { End::Overlap } else { End::Separated };
            }
        }
        state.simplex.push(w, -looked.n, witness);
        // If the bracket only seemed closed, the fast steps were not as good as they seemed.
        let is_nearer = !seems_closed && state.step(w, options.sub_algorithm);
        if !is_nearer && !seems_closed && next_direction.has_turned() {
            // A plane that was turned away from the shortest vector may be the better bound although its support point
            // does not bring the simplex nearer.
            state.simplex.pop();
            looked = next_direction.turn_again(body, state, looked, w, reach);
            continue;
        }
        if !is_nearer && !state.step_by_all_faces(&mut nearing) {
            // The fast steps' normal of a sliver is off by rounding, so that the support point along it may be a corner
            // already. Along the measured normal it is another one.
            state.ensure_measured();
            if looked.n != state.normal && nearing.goes_on(state.length) {
                looked = state.along_normal();
                continue;
            }
            return End::Stalled;
        }
        if state.overlaps(frame.touching()) {
            return End::Overlap;
        }
        // Measured, the vector of a fast step may be no shorter than one before: rounding can go on with that forever.
        if is_nearer && state.measured && !nearing.goes_on(state.length) {
            return End::Stalled;
        }
        looked = next_direction.after(body, state, looked, w, reach);
    }
    End::IterationLimit
}

/// Steps without progress after which none is expected.
const MAX_STEPS_WITHOUT: u8 = 8;

/// Watches a quantity that decreases in every step in exact arithmetic, but only in most steps in rounded arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress<S> {
    least: S,
    steps_left: u8,
}

impl<S: Scalar> Progress<S> {
    pub(crate) fn new() -> Self {
        Self { least: S::infinity(), steps_left: MAX_STEPS_WITHOUT }
    }

    /// Takes the next value. False if it is NaN, or after too many values in a row that are no less than an earlier
    /// one.
    pub(crate) fn goes_on(&mut self, value: S) -> bool {
        if value < self.least {
            *self = Self { least: value, steps_left: MAX_STEPS_WITHOUT };
            true
        } else {
            self.steps_left = self.steps_left.saturating_sub(1);
            self.steps_left > 0 && value >= self.least
        }
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec3, Vec3};

    use super::*;

    /// In single precision, `n·(a − b + o)/|n|` is within [`rounding`] of its value in double precision.
    #[test]
    fn rounding_covers_what_the_arithmetic_of_a_bound_loses() {
        let mut seed = 1_u32;
        let mut number = move || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        let mut vector = move || Vec3::new(number(), number(), number());
        let mut worst = 0.0_f64;
        for _ in 0..20_000 {
            let [n, a, b, o] = [vector(), vector(), vector(), vector()];
            let exact = |v: Vec3| -> DVec3 { v.as_dvec3() };
            let known = exact(n).dot(exact(a) - exact(b) + exact(o)) / exact(n).length();
            let computed = n.dot(a - b + o) / n.length();
            let lost = (f64::from(computed) - known).abs();
            let allowed = f64::from(rounding(a.length() + b.length() + o.length()));
            assert!(lost <= allowed, "{lost:e} of {allowed:e}: {n} {a} {b} {o}");
            worst = worst.max(lost / allowed);
        }
        // The bound is that of the worst case, and not much larger.
        assert!(worst > 0.05, "{worst}");
    }

    #[test]
    fn progress_ends_after_steps_without_a_gain_and_at_what_is_no_number() {
        let mut progress = Progress::new();
        assert!(progress.goes_on(2.0) && progress.goes_on(1.0));
        let steps = (0..100).take_while(|_| progress.goes_on(1.0)).count();
        assert_eq!(steps, usize::from(MAX_STEPS_WITHOUT) - 1);
        assert!(!Progress::new().goes_on(f64::NAN));
    }
}
