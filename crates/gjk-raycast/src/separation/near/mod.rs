//! The second measurement of bodies no farther apart than a few errors, as exact as their numbers allow.
//!
//! The errors in a query are those of its largest number, though the gap of a box over a floor does not depend on the
//! width of the floor. Here the plane between the bodies is evaluated once more without rounding, and the errors that
//! the shapes state count coordinate by coordinate, along the normal alone.
//!
//! The search begins at the offset of the origins, whatever axis the query began at, and the [larger body comes
//! first](super::order). So all queries about one pair decide alike.

mod after_contact;
mod answer;
mod aside;
pub(super) mod faces;
mod in_double;
mod octahedron;
mod room;
pub(super) mod uncertainty;

use convex_support::numerics::bound::{raised, roundings, roundings_of};
use convex_support::numerics::twofold::{dot_minus, lost_in_sum};
use convex_support::{Core, CoreKind, Scalar, Vector};
use num_traits::Float;

use crate::body::{CastBody as _, PointPair, TracedSupport as _};
use crate::gjk::{End, Frame, Gjk, GjkOptions, first_direction, gjk};
use crate::observer::Observer;
use crate::pair::{AnyPair, Both, Pair, Shape};
use crate::simplex::is_around_zero;
pub(crate) use after_contact::{FromContact, look_after};
pub(crate) use faces::ProjectedFace;
use faces::{about_edge, across_faces};
pub(crate) use in_double::in_double;
pub(crate) use room::{across_corners, room_within};
pub(crate) use uncertainty::{SUM, Uncertainty};

/// The result about bodies near contact; lengths in units of the frame, from body to body.
#[derive(Clone, Copy)]
pub(crate) struct NearContact<V: Vector> {
    pub(crate) frame: Frame<V>,
    /// The closest points of the cores, and their measured distance.
    pub(crate) points: PointPair<V>,
    pub(crate) length: V::Scalar,
    pub(crate) end: End,
    pub(crate) iterations: usize,
    /// The unit normal of the plane between the bodies, and their measured distance along it.
    pub(crate) normal: V,
    pub(crate) gap: V::Scalar,
    /// The bodies are certainly apart by this much; negative if that is not known.
    pub(crate) lower: V::Scalar,
    /// Points of the bodies are no farther apart than this.
    pub(crate) upper: V::Scalar,
    /// Whether the bodies certainly have points in common: a simplex of points of their difference has zero inside.
    /// Then no plane is between them, and `gap` and `lower` are infinitely deep.
    pub(crate) overlaps_certainly: bool,
}

impl<V: Vector> NearContact<V> {
    pub(crate) fn is_separated(&self) -> bool {
        self.lower > V::Scalar::ZERO
    }

    /// Whether they have a point in common, to its own error; `None` if neither is certain.
    pub(crate) fn overlap(&self) -> Option<bool> {
        if self.is_separated() {
            return Some(false);
        }
        let is_near = self.length - self.frame.radius <= self.frame.error;
        let is_found = is_near || matches!(self.end, End::Overlap | End::Separated);
        is_found.then_some(true)
    }

    /// Whether a further search is in vain: the bounds are closed, or the bodies certainly have points in common.
    pub(crate) fn is_settled(&self) -> bool {
        self.is_closed() || self.overlaps_certainly
    }

    /// Whether the points are as near as the plane, to the error of the points in any direction. If it is not known
    /// that the bodies are apart, to their error along the normal: points may be far less accurate across it, and
    /// another plane may be beyond zero.
    pub(crate) fn is_closed(&self) -> bool {
        let Self { frame: Frame { error, radius, .. }, gap, lower, upper, .. } = *self;
        let error = if self.is_separated() { error } else { gap - lower + roundings(4.0, radius) };
        upper - gap <= error + error
    }

    fn reversed(self) -> Self {
        let frame = Frame { offset: -self.frame.offset, ..self.frame };
        Self { frame, points: self.points.reversed(), normal: -self.normal, ..self }
    }
}

/// Measures two shapes near contact once more, in either order.
#[cold]
#[inline(never)]
pub(crate) fn near_contact_of<V: Vector>(
    a: Shape<'_, V>,
    b: Shape<'_, V>,
    max_iterations: usize,
) -> Option<NearContact<V>> {
    let cores = [a.core(), b.core()];
    let (shapes, cores) = Both::<_, _>::new(a, b).in_order(cores.each_ref());
    let pair: &mut AnyPair<'_, V> = &mut Pair::new(&shapes, cores);
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset);
    let frame = Frame::new(pair, offset, size);
    let near = near_contact(pair, &frame, size, None, max_iterations, false)?;
    Some(if shapes.is_swapped { near.reversed() } else { near })
}

/// Measures bodies near contact once more, of the given size and [in order](Both::in_order); `None` if no plane can
/// be found, or numbers are out of range.
///
/// An earlier search may have begun where all do: without an axis of its own, and with no tolerance but the noise.
/// Then it is continued; otherwise it is repeated. Where it is to decide whether they have a point in common, it looks
/// at them [from aside](aside) too.
#[cold]
#[inline(never)]
pub(crate) fn near_contact<V: Vector>(
    pair: &mut AnyPair<'_, V>,
    frame: &Frame<V>,
    size: V::Scalar,
    begun: Option<&Gjk<V>>,
    max_iterations: usize,
    is_to_decide: bool,
) -> Option<NearContact<V>> {
    if !frame.error.is_finite() {
        return None;
    }
    // Like a query that begins here.
    pair.forget_hints();
    let seen = Known::new(pair, frame);
    if begun.is_none()
        && max_iterations > 0
        && let Some(points) = pair.closest_points_for_search(frame.offset * frame.scale, size)
        && let Some(known) = seen.between_closest(pair, points)
    {
        return Some(known);
    }
    let mut state = begun.copied().unwrap_or_else(|| begin(pair, frame, size, max_iterations));
    let near = seen.search(pair, &mut state, max_iterations)?;
    Some(if is_to_decide && !near.is_settled() { seen.decided(pair, near, &state, max_iterations) } else { near })
}

/// GJK from the closest points, where they are known in closed form, or from the offset of the origins to the noise.
pub(super) fn begin<V: Vector>(
    pair: &AnyPair<'_, V>,
    frame: &Frame<V>,
    size: V::Scalar,
    max_iterations: usize,
) -> Gjk<V> {
    let first = first_direction(None, frame.offset);
    let mut state = Gjk::new(first);
    if state.begin_at_closest(pair, frame, size) != Some(false) {
        // If they coincide, the vector between them is no direction.
        state = Gjk::new(first);
        // Searches of its own, like a query that begins here.
        let mut pair = Pair::new(pair.shapes, [pair.core_a, pair.core_b]);
        pair.set_scale(frame.scale);
        run(&mut state, &mut pair, *frame, first, max_iterations);
    }
    state
}

/// Goes on with GJK to a sixteenth of the noise.
pub(super) fn go_on<V: Vector>(
    state: &mut Gjk<V>,
    pair: &mut AnyPair<'_, V>,
    frame: &Frame<V>,
    max_iterations: usize,
) -> End {
    let frame = Frame { noise: frame.noise * Scalar::from_f64(0.0625), ..*frame };
    let end = run(state, pair, frame, state.normal, max_iterations);
    state.ensure_measured();
    end
}

/// GJK from a direction, compiled once.
#[inline(never)]
fn run<V: Vector>(
    state: &mut Gjk<V>,
    pair: &mut AnyPair<'_, V>,
    frame: Frame<V>,
    first: V,
    max_iterations: usize,
) -> End {
    gjk(state, pair, frame, GjkOptions::new(first, max_iterations), None, &mut Observer::none())
}

/// A plane with the difference of the cores beyond it, across a unit vector.
#[derive(Clone, Copy)]
struct SupportPlane<V: Vector> {
    n: V,
    /// Its distance from zero, and a bound on the error of this.
    level: V::Scalar,
    error: V::Scalar,
}

impl<V: Vector> SupportPlane<V> {
    fn certain(&self) -> V::Scalar {
        self.level - self.error
    }

    /// Whether the plane is certainly farther from zero than this.
    fn is_beyond(&self, radius: V::Scalar) -> bool {
        self.certain() > radius
    }

    /// Whether the plane is as far as points of the difference are, to both errors: that of a length, about the radius,
    /// is a few roundings more.
    fn meets(&self, upper: V::Scalar, radius: V::Scalar) -> bool {
        upper <= self.level + (self.error + roundings(4.0, radius)) * V::Scalar::from_f64(2.0)
    }
}

/// The answer from a plane, a bound on the distance of the cores' closest points, and what a search has found.
fn near_contact_at<V: Vector>(
    frame: &Frame<V>,
    (SupportPlane { n: normal, level, error }, upper): (SupportPlane<V>, V::Scalar),
    (end, iterations): (End, usize),
    (points, length): (PointPair<V>, V::Scalar),
) -> NearContact<V> {
    let gap = level - frame.radius;
    let lower = gap - error;
    let upper = (upper - frame.radius + roundings(2.0, frame.radius)).max(lower);
    let overlaps_certainly = false;
    NearContact { frame: *frame, points, length, end, iterations, normal, gap, lower, upper, overlaps_certainly }
}

/// The answer of a search that ended at a simplex that certainly has zero inside: no plane is between the bodies.
fn overlapping<V: Vector>(state: &Gjk<V>, frame: &Frame<V>) -> NearContact<V> {
    let (zero, below) = (V::Scalar::ZERO, -V::Scalar::infinity());
    NearContact {
        frame: *frame,
        points: state.simplex.weighted_witness(),
        length: zero,
        end: End::Overlap,
        iterations: state.iterations,
        normal: state.axis.unit().unwrap_or_else(|| Vector::axis(0)),
        gap: below,
        lower: below,
        upper: zero,
        overlaps_certainly: true,
    }
}

/// What is known of the points of the difference of the cores, in units of the frame.
struct Known<V: Vector> {
    frame: Frame<V>,
    /// The rounding of the offset, which is added.
    lost: V,
    /// The error of points that are added up in twice the precision, except for one rounding of the sum.
    points: Uncertainty<V>,
    /// A bound on twice the error of the corners of a simplex, and a few roundings.
    error_of_corners: V::Scalar,
}

impl<V: Vector> Known<V> {
    fn new(pair: &AnyPair<'_, V>, frame: &Frame<V>) -> Self {
        let lost = lost_in_sum(pair.core_a.origin, -pair.core_b.origin) * frame.per_unit;
        let points = Uncertainty::new(pair, frame.per_unit);
        let extent = points.extent + frame.offset.abs();
        // A sum of up to 16 products is right to 17² quarters of ε² of its summands.
        let twice = V::Scalar::EPSILON * V::Scalar::EPSILON * V::Scalar::from_f64(1024.0);
        let points = points.with(extent * twice);
        let error_of_corners = points.length() * V::Scalar::from_f64(2.0) + roundings(16.0, extent.norm());
        Self { frame: *frame, lost, points, error_of_corners }
    }

    /// `n·(a − b + offset)`, rounded once: the products are added up in twice the precision.
    fn level(&self, n: V, PointPair { a, b }: PointPair<V>) -> V::Scalar {
        let parts = (0..V::DIM).flat_map(|i| [a, -b, self.frame.offset, self.lost].map(|part| (n.get(i), part.get(i))));
        dot_minus(parts, V::Scalar::ZERO)
    }

    /// The answer from the closest points of both cores, if the plane across the vector between them meets them to both
    /// errors and is certainly beyond the radii: then there is nothing to search.
    fn between_closest(&self, pair: &mut AnyPair<'_, V>, points: PointPair<V>) -> Option<NearContact<V>> {
        let v = pair.vector_between(points, self.frame.offset);
        let Frame { scale, per_unit, .. } = self.frame;
        let in_world = PointPair { a: points.a * scale, b: points.b * scale };
        if let Some(known) = in_double(pair.shapes, [pair.core_a, pair.core_b], &in_world) {
            let [gap, lower, upper] = [known.signed_distance, known.lower, known.upper].map(|bound| bound * per_unit);
            return Some(NearContact {
                frame: self.frame,
                points,
                length: v.norm(),
                end: End::Separated,
                iterations: 1,
                normal: known.normal,
                gap,
                lower,
                upper,
                overlaps_certainly: false,
            });
        }
        let plane = self.plane(pair, v)?;
        let upper = self.length_between(points);
        if !(plane.meets(upper, self.frame.radius) && plane.level > self.frame.radius) {
            return None;
        }
        let mut best = plane;
        if self.points.is_uneven() && !best.is_beyond(self.frame.radius) {
            // A point is a segment without length.
            let half = |core: &Core<V>| if let CoreKind::Segment { half, .. } = core.kind { half } else { V::ZERO };
            let halves = [half(pair.core_a), half(pair.core_b)];
            let edge = if halves[1].norm() > halves[0].norm() { halves[1] } else { halves[0] };
            for n in about_edge(edge, best.n) {
                best = self.plane(pair, n).filter(|plane| plane.certain() > best.certain()).unwrap_or(best);
            }
        }
        let found = near_contact_at(&self.frame, (best, upper), (End::Separated, 1), (points, v.norm()));
        // A vector as short as its rounding hardly tells the plane's direction.
        found.is_separated().then_some(found)
    }

    /// The result of GJK, as it was begun or from where all queries begin.
    fn search(&self, pair: &mut AnyPair<'_, V>, state: &mut Gjk<V>, max_iterations: usize) -> Option<NearContact<V>> {
        let frame = &self.frame;
        state.ensure_measured();
        if is_around_zero(state.simplex.points(), self.error_of_corners) {
            return Some(overlapping(state, frame));
        }
        let seen = |state: &Gjk<V>, end, found| {
            near_contact_at(frame, found, (end, state.iterations), (state.simplex.weighted_witness(), state.length))
        };
        let before = self.best_plane(pair, state);
        let is_settled = |(plane, upper): &(SupportPlane<V>, V::Scalar)| {
            plane.meets(*upper, self.frame.radius) && plane.is_beyond(self.frame.radius)
        };
        if before.as_ref().is_some_and(is_settled) {
            return before.map(|found| seen(state, End::Separated, found));
        }
        // A simplex of full dimension is never left, nor is zero itself.
        if state.simplex.points().len() > V::DIM || state.length <= Scalar::ZERO {
            return before.map(|found| seen(state, End::Overlap, found));
        }
        let begun = *state;
        let end = go_on(state, pair, frame, max_iterations);
        if is_around_zero(state.simplex.points(), self.error_of_corners) {
            return Some(overlapping(state, frame));
        }
        let mut best = self.best_plane(pair, state);
        // Within rounding a search may go astray, and end around zero, or where no plane is as far as its points.
        let is_doubtful = |(best, _): &(SupportPlane<V>, _)| !best.is_beyond(frame.radius);
        if best.as_ref().is_none_or(is_doubtful) {
            let certain = |(best, _): &(SupportPlane<V>, _)| best.certain();
            if before.as_ref().map(certain) > best.as_ref().map(certain) {
                let (iterations, nearest) = (state.iterations, best.map_or(Float::infinity(), |(_, upper)| upper));
                (*state, best) = (begun, before.map(|(plane, upper)| (plane, upper.min(nearest))));
                state.iterations = iterations;
            }
        }
        best.map(|found| seen(state, end, found))
    }

    /// The plane that is certainly farthest from zero, of those across the faces that a search has ended at, and across
    /// its last two directions; and a bound on the length of the shortest vector found. If the line across a plane
    /// pierces the face that is as far, no other plane is tested.
    fn best_plane(&self, pair: &mut AnyPair<'_, V>, state: &Gjk<V>) -> Option<(SupportPlane<V>, V::Scalar)> {
        let points = state.simplex.points();
        let faces = across_faces(state.simplex.witnesses(), state.axis);
        let normal = Some(state.normal).filter(|&n| n != state.axis);
        let (mut best, mut length): (Option<SupportPlane<V>>, Option<V::Scalar>) = (None, None);
        let mut upper = V::Scalar::infinity();
        let about = match *points {
            [p, q] if V::DIM == 3 && self.points.is_uneven() => Some(about_edge(p - q, state.axis)),
            _ => None,
        };
        let about = about.into_iter().flatten();
        let beside = if let [p] = *points { Some(self.points.most_certain(p)) } else { None };
        for n in faces.chain(normal).chain([state.axis]).chain(about).chain(beside) {
            let certain = best.as_ref().map_or(-V::Scalar::infinity(), SupportPlane::certain);
            if self.may_be_beyond(n, points, certain)
                && let Some(plane) = self.plane(pair, n)
                && (best.is_none() || plane.certain() > certain)
            {
                upper = upper.min(self.length_at_pierced(state, plane.n));
                // The face's corners are as far along `n` as the support point: what is left between the bounds is
                // their error.
                let is_of_face = upper <= plane.level + plane.error * V::Scalar::from_f64(1.0625);
                if !is_of_face {
                    upper = upper.min(*length.get_or_insert_with(|| self.length(state)));
                }
                let is_closed =
                    is_of_face || plane.meets(upper, self.frame.radius) && plane.is_beyond(self.frame.radius);
                best = Some(plane);
                if is_closed {
                    break;
                }
            }
        }
        best.map(|plane| (plane, upper))
    }

    /// Whether a plane across `n` that supports the difference may be certain to be farther than `level` from zero: it
    /// is no farther than any of the points.
    fn may_be_beyond(&self, n: V, points: &[V], level: V::Scalar) -> bool {
        let nearest = points.iter().map(|p| n.dot(*p)).fold(V::Scalar::infinity(), V::Scalar::min);
        // NaN may be.
        n != V::ZERO && !(nearest < (level - self.error_of_corners) * n.length())
    }

    /// The plane across `n` that supports the difference.
    fn plane(&self, pair: &mut AnyPair<'_, V>, n: V) -> Option<SupportPlane<V>> {
        let n = n.unit()?;
        let mut level = self.level(n, pair.support(-n).1);
        // The unit vector's length is right to 6 roundings, and the sum of the products is rounded once.
        let mut rounded = roundings(8.0, level.abs());
        if self.frame.radius > Scalar::ZERO {
            // The level is that of the radius, and not only the gap's: it is divided by the length, which is one and
            // half of what its square is beyond one. That is exact to a rounding, and so is the difference.
            let beyond_one = dot_minus((0..V::DIM).map(|i| (n.get(i), n.get(i))), V::Scalar::ONE);
            level -= level * (beyond_one * V::Scalar::from_f64(0.5));
            rounded = roundings(4.0, level.abs()) + roundings(2.0, self.frame.radius);
        }
        level.is_finite().then(|| SupportPlane { n, level, error: raised(self.points.along(n) + rounded) })
    }

    /// The point that a search has ended at, `Σ wᵢ·(aᵢ − bᵢ + offset) / Σ wᵢ`: whatever the weights, that is a point of
    /// the difference. Its coordinates are added up in twice the precision.
    #[inline]
    fn nearest_point(&self, state: &Gjk<V>) -> V {
        let sums = V::from_fn(|i| {
            let parts = state.simplex.weighted().flat_map(|(weight, PointPair { a, b })| {
                [a, -b, self.frame.offset, self.lost].map(|part| (weight, part.get(i)))
            });
            dot_minus(parts, V::Scalar::ZERO)
        });
        sums / state.simplex.weight()
    }

    /// A bound on its length.
    fn length(&self, state: &Gjk<V>) -> V::Scalar {
        let x = self.nearest_point(state);
        // The sum of the weights is right to three roundings, and to one each the sum of the products and the quotient.
        self.length_of(x, roundings_of(5.0, x.abs()))
    }

    /// The same for the vector between two points, given the rounding of the two sums.
    fn length_between(&self, PointPair { a, b }: PointPair<V>) -> V::Scalar {
        let apart = a - b;
        let lost = lost_in_sum(a, -b).abs() + lost_in_sum(apart, self.frame.offset).abs();
        self.length_of(apart + self.frame.offset, lost + self.lost.abs())
    }

    /// A bound on the length of a vector `x` of the difference, which rounding has moved by no more than `rounded`,
    /// coordinate by coordinate, besides the errors of its points.
    fn length_of(&self, x: V, rounded: V) -> V::Scalar {
        // The length itself is right to 3 roundings, and the sum to one: what is beside it is raised alone.
        let (norm, beyond) = (x.norm(), self.points.with(rounded).beyond(x));
        let length = norm + (raised(beyond) + roundings(8.0, norm));
        if length.is_finite() { length } else { Float::infinity() }
    }

    /// A bound on the distance of the bodies from a face of the difference that the line along the unit vector `n`
    /// through zero certainly pierces: then no corner of the face is nearer along `n`.
    fn length_at_pierced(&self, state: &Gjk<V>, n: V) -> V::Scalar {
        let is_face = state.simplex.points().len() == V::DIM;
        if !(is_face && ProjectedFace::along(n, state.simplex.padded().0).surrounds_zero(self.error_of_corners)) {
            return Float::infinity();
        }
        // The face may be behind zero, which is outside all the same if the part beyond the face does not belong to the
        // difference.
        let levels = state.simplex.weighted().map(|(_, pair)| self.level(n, pair).abs());
        let farthest = levels.fold(V::Scalar::ZERO, V::Scalar::max);
        raised(farthest + self.points.along(n) + roundings(8.0, farthest))
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DQuat, DVec2, DVec3};
    use convex_support::{Ball, Capsule, Cuboid, InvalidShape, Point, Polytope, Posed};

    use super::*;

    /// How wide a floor is has nothing to do with the gap above it: coordinates are counted along the normal alone.
    #[test]
    fn a_gap_of_one_ulp_over_a_wide_floor_is_seen() -> Built<()> {
        let floor = Cuboid::new(DVec3::new(1e6, 0.5, 1e6))?;
        let over = |height: f64| Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(3.0, height, 0.0));
        for (height, overlap) in [(1.0_f64.next_up(), false), (1.0, true), (1.0_f64.next_down(), true)] {
            let (above, gap) = (over(height)?, height - 1.0);
            for near in [near_contact_of(&above, &floor, 200), near_contact_of(&floor, &above, 200)] {
                let near = near.expect("bodies near contact");
                assert_eq!(near.overlap(), Some(overlap), "{height}");
                let [lower, upper] = [near.lower, near.upper].map(|bound| bound * near.frame.scale);
                assert!(lower <= gap && gap.max(0.0) <= upper, "{gap} is not in [{lower}, {upper}]");
            }
        }
        Ok(())
    }

    type Built<S> = Result<S, InvalidShape>;

    /// What two bodies are found to be in either order: the same but for the sign of the normal, and the gap within its
    /// bounds.
    fn agree<V: Vector<Scalar = f64>>(a: Shape<'_, V>, b: Shape<'_, V>, gap: f64) -> NearContact<V> {
        let [near, reversed] = [near_contact_of(a, b, 200), near_contact_of(b, a, 200)].map(|near| near.expect("near"));
        let bounds =
            |near: &NearContact<V>| [near.gap, near.lower, near.upper, near.length].map(|x| x * near.frame.scale);
        assert_eq!(bounds(&near), bounds(&reversed));
        assert_eq!((near.normal, near.points.a), (-reversed.normal, reversed.points.b));
        let [_, lower, upper, _] = bounds(&near);
        assert!(lower <= gap && gap <= upper, "{gap} is not in [{lower}, {upper}]");
        near
    }

    /// A few roundings of numbers about 1, more than the errors that the shapes below state.
    const FEW: f64 = 32.0 * f64::EPSILON;

    /// The gap of two balls of radius 1 is their distance less 2, which is exact.
    #[test]
    fn balls_a_few_roundings_apart_are_apart() -> Built<()> {
        let ball = Ball::<DVec3>::new(1.0)?;
        for (distance, overlap) in [(2.0 + FEW, false), (2.0, true), (2.0 - FEW, true)] {
            let near = agree(&Posed::translated(ball, DVec3::Y * distance)?, &ball, distance - 2.0);
            assert_eq!((near.overlap(), near.normal), (Some(overlap), DVec3::Y), "{distance}");
        }
        Ok(())
    }

    /// Numbers from 1/2 to 1 with all their digits.
    fn numbers() -> impl Iterator<Item = f64> {
        let mut state = 1_u64;
        core::iter::repeat_with(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            0.5 + (state >> 12) as f64 * 2.0_f64.powi(-53)
        })
    }

    /// Balls and boxes one over the other, whose origins have a difference of more digits than a number: the gap is an
    /// integer in units of 2⁻⁶⁰.
    #[test]
    fn bounds_hold_the_gap_of_bodies_whose_offset_rounds() -> Built<()> {
        let mut numbers = numbers();
        let mut number = |scale: f64| numbers.next().map_or(scale, |x| x * scale);
        for i in 0..500 {
            let (y, below, half) = (number(1.0), -number(0.125), number(0.25));
            let other = (y - below - half) + f64::from(i % 9 - 4) * f64::EPSILON;
            let whole = |x: f64| (x * 2.0_f64.powi(60)) as i128;
            let gap = (whole(y) - whole(below) - whole(half) - whole(other)) as f64 * 2.0_f64.powi(-60);
            let at = |y: f64| DVec3::new(0.25, y, 0.25);
            agree(&Posed::translated(Ball::new(half)?, at(y))?, &Posed::translated(Ball::new(other)?, at(below))?, gap);
            let cube = |half: f64| Cuboid::new(DVec3::splat(half));
            agree(&Posed::translated(cube(half)?, at(y))?, &Posed::translated(cube(other)?, at(below))?, gap);
        }
        Ok(())
    }

    /// Along (1, 2, 2), which is 3 long, the distance of whole multiples is exact.
    #[test]
    fn bounds_hold_the_gap_of_balls_in_any_direction() -> Built<()> {
        for (i, x) in (0_i32..500).zip(numbers()) {
            let step = f64::from(1000 + 7 * i) / 1024.0;
            let distance = 3.0 * step;
            let (radius, other) = (distance * 0.5 * (1.0 + x / 4.0), f64::from(i % 9 - 4) * f64::EPSILON);
            // Both differences are exact, of numbers within twice one another.
            let rest = distance - radius + other;
            let gap = (distance - radius) - rest;
            agree(&Posed::translated(Ball::new(radius)?, DVec3::new(1.0, 2.0, 2.0) * step)?, &Ball::new(rest)?, gap);
        }
        Ok(())
    }

    /// An edge along x below one along z: no corner is nearest, and the gap is the difference of two heights.
    #[test]
    fn edges_that_cross_a_few_roundings_apart_are_apart() -> Built<()> {
        let ridge = |along: DVec3, across: DVec3, top: f64, down: f64| {
            let foot = DVec3::Y * (top + down);
            Polytope::new([DVec3::Y * top + along, DVec3::Y * top - along, foot + across, foot - across])
        };
        let below = ridge(DVec3::X, DVec3::Z, 0.75, -1.0)?;
        for (height, overlap) in [(0.75 + FEW, false), (0.75, true), (0.75 - FEW, true)] {
            let above = ridge(DVec3::Z * 2.0, DVec3::X, height, 1.5)?;
            let near = agree(&above, &below, height - 0.75);
            assert_eq!(near.overlap(), Some(overlap), "{height}");
            assert!(near.normal.distance(DVec3::Y) < 1e-15, "{}", near.normal);
        }
        Ok(())
    }

    fn octahedron() -> Built<Polytope<DVec3>> {
        Polytope::new([DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]))
    }

    /// Points about the face x + y + z = 1, whose unit normal has no exact coordinates: they are in the
    /// octahedron where the sum of theirs is at most 1.
    #[test]
    fn a_point_a_few_roundings_off_a_slanted_face_is_off_it() -> Built<()> {
        let octahedron = octahedron()?;
        for (i, j) in (1..4).flat_map(|i| (1..4).map(move |j| (i, j))) {
            let (x, y) = (f64::from(i) / 16.0, f64::from(j) / 16.0);
            let z = 1.0 - x - y;
            for (z, is_in) in [(z + FEW, false), (z, true), (z - FEW, true)] {
                let gap = (z - (1.0 - x - y)) / 3.0_f64.sqrt();
                let near = agree(&Point::new(DVec3::new(x, y, z))?, &octahedron, gap);
                assert_eq!(near.overlap(), Some(is_in), "{x} {y} {z}");
                assert!(near.normal.distance(DVec3::ONE.normalize()) < 1e-15, "{}", near.normal);
            }
        }
        Ok(())
    }

    /// Segments within a capsule's radius: the closest points are known in closed form, and nothing is searched.
    #[test]
    fn capsules_that_cross_are_measured_without_a_search() -> Built<()> {
        let rod = Capsule::<DVec3>::new(4.0, 0.5)?;
        let quarter = DQuat::from_xyzw(0.5_f64.sqrt(), 0.0, 0.0, 0.5_f64.sqrt());
        let distance = 1.0 + 64.0 * f64::EPSILON;
        let near = agree(&Posed::new(rod, quarter, DVec3::X * distance)?, &rod, distance - 1.0);
        assert_eq!((near.overlap(), near.iterations), (Some(false), 1));
        assert!(near.is_closed() && near.normal.distance(DVec3::X) < 1e-15, "{}", near.normal);
        Ok(())
    }

    /// In the plane: a corner on the slanted side x + y = 1 of a square that stands on its corner.
    #[test]
    fn a_corner_a_few_roundings_off_a_slanted_side_is_off_it() -> Built<()> {
        let standing = Polytope::new([DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y])?;
        for (x, overlap) in [(0.625 + FEW, false), (0.625, true), (0.625 - FEW, true)] {
            let square = Polytope::new(
                [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| DVec2::new(x + u, 0.375 + v)),
            )?;
            let near = agree(&square, &standing, (x - 0.625) / 2.0_f64.sqrt());
            assert_eq!(near.overlap(), Some(overlap), "{x}");
        }
        Ok(())
    }

    /// No plane is between a body and a point well inside, and a simplex around zero proves it.
    #[test]
    fn bodies_that_overlap_by_more_than_rounding_certainly_do() -> Built<()> {
        let octahedron = octahedron()?;
        let near = agree(&Point::new(DVec3::new(0.25, 0.125, -0.0625))?, &octahedron, -0.5625 / 3.0_f64.sqrt());
        assert!(near.overlaps_certainly && near.is_settled() && near.overlap() == Some(true));
        assert_eq!((near.lower, near.upper), (f64::NEG_INFINITY, 0.0));
        Ok(())
    }

    /// A gap of few ulps, by any unit of length, and of numbers whose errors are out of range none.
    #[test]
    fn a_power_of_two_changes_no_mantissa_and_numbers_out_of_range_have_no_answer() -> Built<()> {
        let measured = |scale: f64| -> Built<_> {
            let cube = Cuboid::new(DVec3::splat(0.7 * scale))?;
            let near =
                near_contact_of(&Posed::translated(cube, DVec3::new(0.3, -0.2, 1.4).map(|x| x * scale))?, &cube, 200);
            Ok(near.map(|near| [near.gap, near.lower, near.upper].map(|x| x * (near.frame.scale / scale))))
        };
        let known = measured(1.0)?;
        assert!(known.is_some());
        for power in [-400, 400] {
            assert_eq!(measured(2.0_f64.powi(power))?, known);
        }
        assert_eq!(measured(2.0_f64.powi(1023))?, None);
        Ok(())
    }
}
