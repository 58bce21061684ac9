//! Two bodies and their motions: what is known of them at one time, and the table of functions that a lean search for
//! their contact leaves out.
//!
//! A look at one time begins in [`at`](Approach::at), with the closed forms for [closest points](super::near_look) and
//! for [boxes](super::box_look). If neither tells enough, it goes on with GJK, which well apart is all, and near
//! contact with the closest points of the last look, or at last with the signed distance.

use core::cell::{Cell, RefCell};

use convex_support::numerics::range::is_comfortable;
use convex_support::{Core, Hint, Parallelotope, Scalar, Vector, compiled_table};
use num_traits::Float;

use super::first_contact::Begin;
use super::instant::{Approach, Instant, Limits, NEAR_IN_MOTION};
use super::moving_body::MovingBody;
use super::placed::{BodyFrameCorners, Placed};
use super::trajectory::{BentPlane, Trajectory, TurningPlane};
use crate::body::{CastBody, PointPair, TracedSupport as _};
use crate::distance::distance_of_any;
use crate::gjk::{self, Frame, Gjk, GjkOptions, gjk, rounding};
use crate::linear_cast::by_search;
use crate::observer::Observer;
use crate::options::{MayBeLean, Rare};
use crate::pair::{Pair, Shape, Shapes};
use crate::separation::{MAX_DEPTH_ITERATIONS, RareInDistances};
use crate::signed_distance::rough_signed_distance;
use crate::unit::{is_moderate, length_bound, lost_to_underflow, power_of_two_near, reciprocal_of_power};
use crate::{
    Distance, DistanceOptions, LinearCast, LinearCastOptions, Motion, MotionCastOptions, SignedDistanceOptions,
};

/// Points in another unit.
pub(super) fn times<V: Vector>(points: PointPair<V>, factor: V::Scalar) -> PointPair<V> {
    PointPair { a: points.a * factor, b: points.b * factor }
}

/// Two bodies and their motions.
pub(super) struct MovingPair<'s, V: Vector> {
    pub(super) shapes: &'s dyn Shapes<Vector = V>,
    rare: Option<&'static RareInMotionCasts<V>>,
    /// The hints of the last time, which mostly fit again.
    pub(super) hints: Cell<[Hint; 2]>,
    pub(super) a: MovingBody<'s, V>,
    pub(super) b: MovingBody<'s, V>,
    /// Whether the closest points of the cores were known in closed form at the start.
    knows_points: bool,
    /// A power of two near the sizes of the cores.
    pub(super) unit: V::Scalar,
    /// Both cores at time 0 in this unit, if they are boxes.
    boxes: Option<[Parallelotope<V>; 2]>,
    /// The edges that span the facet of the last look, if zero's foot was within it.
    pub(super) facet: Cell<Option<[usize; 2]>>,
    /// The corners of the faces that were closest at the last look.
    pub(super) closest: RefCell<BodyFrameCorners<V>>,
    /// The support points computed of each shape.
    iterations: Cell<usize>,
}

/// What a lean motion cast leaves out: all but GJK and the points that were closest at the last look.
#[allow(clippy::type_complexity, reason = "the type is written once")]
pub(crate) struct RareInMotionCasts<V: Vector> {
    in_distances: &'static RareInDistances<V>,
    /// The cast of bodies that do not turn.
    pub(super) straight: fn(
        &mut dyn CastBody<Vector = V>,
        [Shape<'_, V>; 2],
        &[Core<V>; 2],
        Motion<V>,
        &LinearCastOptions<V>,
    ) -> LinearCast<V>,
    by_boxes:
        fn(&MovingPair<'_, V>, V::Scalar, &[Parallelotope<V>; 2], V, Limits<V::Scalar>, bool) -> Option<Instant<V>>,
    pub(super) begin_in_contact: Begin<V>,
    keep_in_contact: fn(&MovingPair<'_, V>, &Instant<V>, &Instant<V>, V::Scalar) -> bool,
    have_met: fn(&MovingPair<'_, V>, &Instant<V>, V::Scalar) -> bool,
}

impl<V: Vector> MayBeLean for MotionCastOptions<V> {
    type Table = RareInMotionCasts<V>;
    const TABLE: Self::Table = RareInMotionCasts {
        in_distances: &RareInDistances::WITH_DEPTH,
        straight: |body, shapes, cores, motion, options| {
            let options = LinearCastOptions { rare: LinearCastOptions::rare(), ..*options };
            by_search(body, shapes, cores, motion, &options, &mut Observer::none())
        },
        by_boxes: |pair, time, blocks, axis, limits, is_close| pair.by_boxes(time, blocks, axis, limits, is_close),
        begin_in_contact: |search| search.begin_in_contact(),
        keep_in_contact: |pair, from, to, depth| pair.keep_in_contact(from, to, depth),
        have_met: |pair, near, time| pair.have_met(near, time),
    };

    fn rare() -> Rare<Self> {
        Rare(Some(compiled_table!(RareInMotionCasts<V> of MotionCastOptions)))
    }
}

impl<'s, V: Vector> MovingPair<'s, V> {
    #[inline(always)]
    pub(super) fn new(
        shapes: &'s dyn Shapes<Vector = V>,
        motions: [&'s dyn Trajectory<Vector = V>; 2],
        options: &MotionCastOptions<V>,
    ) -> Self {
        let rare = options.rare.0;
        let [a, b] = shapes.each();
        let a = MovingBody::new(a, motions[0], options.target_distance);
        let b = MovingBody::new(b, motions[1], Scalar::ZERO);
        let offset = a.core.origin - b.core.origin;
        let pair = Pair::new(shapes, [&a.core, &b.core]);
        let knows_points = pair.closest_points(offset, pair.size(offset)).is_some();
        let unit = power_of_two_near(a.core.extent + b.core.extent);
        let per_unit = reciprocal_of_power(unit);
        let blocks = || Some([a.as_box(per_unit)?, b.as_box(per_unit)?]);
        let boxes = if knows_points || rare.is_none() { None } else { blocks() };
        let facet = Cell::new(None);
        let (closest, iterations) = (RefCell::new(BodyFrameCorners::none()), Cell::new(0));
        let hints = Cell::new([Hint::new(), Hint::new()]);
        Self { shapes, rare, hints, a, b, knows_points, unit, boxes, facet, closest, iterations }
    }

    /// Adds to the number of support points.
    pub(super) fn count(&self, iterations: usize) {
        self.iterations.set(self.iterations.get() + iterations);
    }

    /// The bodies where they are at a time.
    #[inline(never)]
    pub(super) fn placed(&self, time: V::Scalar) -> Placed<'_, V> {
        self.placed_here(time)
    }

    /// The same as [`placed`](Self::placed), compiled into its caller.
    #[inline(always)]
    pub(super) fn placed_here(&self, time: V::Scalar) -> Placed<'_, V> {
        let (a, b) = (self.a.place(time), self.b.place(time));
        // The vector between the bodies is about as long as the bodies are large, however far from the world's origin
        // they are.
        let between = self.a.core.origin - self.b.core.origin;
        let (shifts, swings) = (a.shift - b.shift, a.swing - b.swing);
        let offset = between + shifts + swings;

        // A rounding for each difference and sum.
        let magnitude = length_bound(between.abs() + shifts.abs() + swings.abs());
        let rounding = V::Scalar::from_f64(1.5) * V::Scalar::EPSILON * magnitude;
        Placed {
            time,
            shapes: self.shapes,
            hints: &self.hints,
            a: self.a.moved(&a, offset, rounding + (a.error + b.error)),
            b: self.b.moved(&b, V::ZERO, Scalar::ZERO),
            offset,
            place: self.b.core.origin + b.shift + b.swing,
        }
    }

    /// The bodies at a time, if both are boxes.
    #[inline(always)]
    fn by_facets(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>, is_close: bool) -> Option<Instant<V>> {
        (self.rare?.by_boxes)(self, time, self.boxes.as_ref()?, axis, limits, is_close)
    }

    /// The bodies at a time, if no closed form tells enough.
    #[inline(never)]
    fn by_search(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>, is_rough: bool) -> Instant<V> {
        let placed = self.placed(time);
        // Far from contact the plane of GJK is enough.
        if is_rough && let Some(there) = self.roughly(&placed, axis, limits) {
            return there;
        }
        // Near contact the corners that were closest a moment ago mostly are so still. They do not tell a depth.
        let is_depth_asked = limits.depth > Scalar::ZERO;
        let known = if is_depth_asked { None } else { self.near_look(&placed, axis) };
        known.unwrap_or_else(|| self.by_signed_distance(&placed, axis, limits))
    }

    /// The bodies at a time, by GJK; `None` if they are nearly in contact, or overlap by an unknown depth.
    ///
    /// The search begins with the face that was closest at the last time. Mostly it still is, and one support point
    /// ends the search. If the bodies overlap by more than rounding, the best plane known tells roughly how deep, which
    /// is enough for the search of the motion.
    fn roughly(&self, placed: &Placed<'_, V>, axis: V, limits: Limits<V::Scalar>) -> Option<Instant<V>> {
        let pair = &mut placed.pair();
        let size = pair.size(placed.offset);
        let kept = if is_moderate(size) { self.closest.borrow().closest_face(placed) } else { None };
        // If the cores have passed through one another, the vector to the face points the other way.
        let face = kept.filter(|face| face.v.dot(axis) > Scalar::ZERO && face.v.length() > pair.radius());
        let frame = Frame::new(pair, placed.offset, size);
        let Frame { scale, per_unit, radius, error, .. } = frame;
        let in_unit = |(point, points): (V, PointPair<V>)| (point * per_unit, times(points, per_unit));
        let mut state = match &face {
            None => Gjk::new(axis),
            Some(face) => Gjk::at_face(face.corners().map(in_unit), face.weights, face.v * per_unit),
        };
        let options = GjkOptions {
            limit: frame.between_cores(limits.distance),
            tolerance: limits.rough,
            ..GjkOptions::new(state.normal, MAX_DEPTH_ITERATIONS)
        };
        let end = gjk(&mut state, pair, frame, options, None, &mut Observer::none());
        self.count(state.iterations);
        let (distance, near) = (state.lower - radius, error * Scalar::from_f64(NEAR_IN_MOTION));
        let unit = state.axis.unit()?;
        let known = [state.lower * scale - pair.radius(), error * scale];
        // If the distance is NaN, neither holds.
        if end == gjk::End::Separated && distance > near {
            state.ensure_measured();
            // On a curved body other points will be the closest ones.
            if !pair.is_curved() {
                let corners = state.simplex.weighted().map(|(_, corner)| times(corner, scale));
                self.closest.borrow_mut().keep(corners, placed);
            }
            return Some(self.across(placed, unit, times(state.simplex.weighted_witness(), scale), known));
        }
        if end == gjk::End::Overlap && distance < -near {
            self.count(1);
            let (_, points) = pair.support(-unit);
            return Some(self.across(placed, unit, times(points, scale), known));
        }
        None
    }

    /// The bodies at a time, by their signed distance.
    #[inline(never)]
    fn by_signed_distance(&self, placed: &Placed<'_, V>, axis: V, limits: Limits<V::Scalar>) -> Instant<V> {
        let Limits { distance: limit, depth: depth_limit, .. } = limits;
        let wanted = SignedDistanceOptions { axis: Some(axis), limit, depth_limit, ..Default::default() };
        let answer = rough_signed_distance(placed, wanted, self.rare.map(|rare| rare.in_distances));
        self.count(answer.iterations);
        let (point_a, point) = (answer.point_a + placed.place, answer.point_b + placed.place);
        let (time, normal, distance) = (placed.time, answer.normal, answer.signed_distance);
        Instant {
            time,
            normal,
            gap: answer.lower,
            distance,
            upper: answer.upper,
            error: distance - answer.lower,
            closing: self.closing(time, normal, [point_a, point]),
            point,
            is_close: true,
        }
    }

    /// A rough instant. A plane across the unit vector keeps the bodies apart by the given distance, which has the
    /// given error. The points of the cores are relative to the bodies' origins.
    #[inline(always)]
    pub(super) fn across(
        &self,
        &Placed { time, offset, place, .. }: &Placed<'_, V>,
        normal: V,
        points: PointPair<V>,
        [distance, error]: [V::Scalar; 2],
    ) -> Instant<V> {
        let point_a = place + offset + points.a - normal * self.a.core.radius;
        let point = place + points.b + normal * self.b.core.radius;
        let closing = self.closing(time, normal, [point_a, point]);
        let (gap, upper) = (distance - error, Float::infinity());
        Instant { time, normal, gap, distance, upper, error, closing, point, is_close: false }
    }

    /// How fast two points, one of each body, come nearer to one another along a normal.
    #[inline(always)]
    pub(super) fn closing(&self, time: V::Scalar, normal: V, [point_a, point_b]: [V; 2]) -> V::Scalar {
        normal.dot(self.b.velocity(time, point_b) - self.a.velocity(time, point_a))
    }
}

impl<V: Vector> Approach<V> for MovingPair<'_, V> {
    fn aim(&mut self, target: V::Scalar) {
        self.a.core.radius = self.a.shape.core().radius + target;
    }

    #[cold]
    #[inline(never)]
    fn distance(&self, time: V::Scalar, axis: Option<V>) -> Distance<V> {
        let placed = self.placed(time);
        let rare = Rare(self.rare.map(|rare| rare.in_distances));
        let answer = distance_of_any(&placed.a, &placed.b, DistanceOptions { rare, axis, ..DistanceOptions::lean() });
        self.count(answer.iterations);
        let [point_a, point_b] = [answer.point_a, answer.point_b].map(|point| point + placed.place);
        Distance { point_a, point_b, ..answer }
    }

    fn size(&self) -> V::Scalar {
        self.a.core.extent + self.a.core.radius + self.b.core.extent + self.b.core.radius
    }

    fn iterations(&self) -> usize {
        self.iterations.get()
    }

    fn between(&self) -> V {
        self.a.core.origin - self.b.core.origin
    }

    #[inline(always)]
    fn at(&self, time: V::Scalar, axis: V, limits: Limits<V::Scalar>, is_close: bool) -> Instant<V> {
        let known = match self.knows_points {
            // Closest points tell no depth.
            _ if is_close && limits.depth > Scalar::ZERO => None,
            // Balls and capsules: a closed form, and one support point as its proof.
            true => self.by_closest_points(time, axis, limits, is_close),
            // The level of a facet of two boxes is no more than a lower bound of the distance; with a radius their
            // difference has no facets.
            _ if self.a.core.radius > Scalar::ZERO || limits.rough == Scalar::ZERO => None,
            false => self.by_facets(time, axis, limits, is_close),
        };
        known.unwrap_or_else(|| self.by_search(time, axis, limits, !(is_close || self.knows_points)))
    }

    fn level(&self, time: V::Scalar, normal: V) -> (V::Scalar, V::Scalar) {
        let placed = &self.placed(time);
        let mut pair = placed.pair();
        let size = pair.size(placed.offset);
        // If the size is out of range, nothing is known.
        if !is_moderate(size) {
            return (V::Scalar::nan(), Float::infinity());
        }
        let (point, _) = pair.support(-normal);
        self.count(1);
        (normal.dot(point + placed.offset) - pair.radius(), rounding(size) + pair.error())
    }

    fn acceleration_along(&self, plane: TurningPlane<V>, interval: [V::Scalar; 2]) -> V::Scalar {
        let opposite = TurningPlane { from: -plane.from, to: -plane.to };
        self.a.acceleration_along(plane, interval) + self.b.acceleration_along(opposite, interval)
    }

    fn leaning_level(&self, plane: &BentPlane<V>) -> Option<[V::Scalar; 2]> {
        self.leaning(plane)
    }

    fn reach(&self) -> V::Scalar {
        self.a.core.radius + self.b.core.radius
    }

    fn stays_far_apart(&self, interval: [V::Scalar; 2]) -> Option<V> {
        let a = self.a.moving_ball(interval);
        let b = self.b.moving_ball(interval);
        let (start, velocity) = (a.start - b.start, a.velocity - b.velocity);
        let duration = interval[1] - interval[0];
        // The time at which start + t·velocity is shortest.
        let (slope, squared) = (start.dot(velocity), velocity.length_squared());
        // If the square of the velocity is out of range, that time is not known.
        if !(is_comfortable(squared) && slope.is_finite() || velocity == V::ZERO) {
            return None;
        }
        let nearest = if slope < Scalar::ZERO { (-slope / squared).min(duration) } else { Scalar::ZERO };
        let between = start + velocity * nearest;
        let reach = a.radius + b.radius + self.a.core.radius + self.b.core.radius;
        let moved = (length_bound(a.velocity) + length_bound(b.velocity)) * nearest;
        let measure = reach + length_bound(a.start) + length_bound(b.start) + moved;
        let margin = measure * Scalar::from_f64(32.0) * Scalar::EPSILON + lost_to_underflow(measure);
        // If a number is NaN, the balls are not known to be apart.
        if between.norm() > reach + margin { between.unit() } else { None }
    }

    fn stay_in_contact(&self, from: &Instant<V>, to: &Instant<V>, depth: V::Scalar) -> bool {
        self.rare.is_some_and(|rare| (rare.keep_in_contact)(self, from, to, depth))
    }

    fn velocities(&self, time: V::Scalar, point: V) -> [V; 2] {
        [self.a.velocity(time, point), self.b.velocity(time, point)]
    }

    fn pass_through(&self, near: &Instant<V>, time: V::Scalar) -> bool {
        self.rare.is_some_and(|rare| (rare.have_met)(self, near, time))
    }

    /// This is not the point of `b` that is deepest in `a`: if a small body has to leave through a large one, that
    /// point is far behind the small body.
    fn common_point(&self, there: &Instant<V>) -> V {
        self.distance(there.time, None).point_b
    }
}
