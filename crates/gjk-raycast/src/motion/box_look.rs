//! Two moving boxes at one time, by the facets of their [difference](crate::boxes).
//!
//! The highest facet mostly stays the highest. As long as it does, its level is as smooth as the motion, even where the
//! boxes begin to overlap.
//!
//! If the boxes are well apart, or deep in one another, the level as computed is enough. If they are nearly in contact,
//! a support point along the facet's normal tells the level as exactly as it can be known. If they overlap by more than
//! the error of the level, the line through zero along the normal proves it: on one side of zero the line goes through
//! the facet, and on the other side there is another point of the line in the difference.

use convex_support::numerics::coordinates::{Vec3, array, dot, vector};
use convex_support::{Hint, Parallelotope, Scalar, SupportMap as _, Vector};
use num_traits::Float;

use super::instant::{Instant, Limits, NEAR_IN_MOTION};
use super::moving_pair::MovingPair;
use super::placed::Placed;
use crate::boxes::{EDGES, Zonotope, ZonotopeFacet};
use crate::gjk::{rounding, slack};
use crate::separation::Uncertainty;
use crate::unit::{is_moderate, reciprocal_of_power};

/// A bound on the error of the unit vector along an edge, in ε: three for each of two rotations, and one for its
/// length.
const TURNED: f64 = 8.0;

/// How far zero's foot has to be within a facet, in units of the error of points.
const WITHIN: f64 = 64.0;

/// A bound on the error of a product with a unit vector, in ε times the magnitudes of its terms.
const PRODUCT: f64 = 3.0;

/// How deep zero may be behind a facet that was the highest at the last look, for it to be taken again: this part of
/// the distance from zero's foot to the sides of the facet. Deeper than that, zero may be nearer to another facet.
const BEHIND_FACET: f64 = 0.25;

/// The error of a level, in units of the error of a bound by a support point. The level is a sum over six edges, each
/// of which was turned, and the bound is a sum of two points.
const LEVEL: f64 = 2.0;

/// The same, roughly, for a level as it is told by a support point.
const FROM_NEAR: f64 = 0.5;

/// The highest facet and zero's foot on it, in a unit near the size of both boxes.
struct BoxFacet {
    facet: ZonotopeFacet,
    /// The distance of zero's foot from the nearest side of the facet; negative if it is outside.
    room: f64,
    /// The point of the second box, relative to its centre, that zero's foot is the difference of; if the foot is
    /// outside the facet, a point near that.
    point: Vec3,
}

impl<V: Vector> MovingPair<'_, V> {
    /// Two boxes at a time, exactly if that is asked or if they are nearly in contact. `None` if it is not certain
    /// which facet is the highest, or if that facet proves nothing.
    ///
    /// All of it is compiled into one function, so that the places of the bodies need not be written to memory and read
    /// again.
    #[inline(always)]
    pub(super) fn by_boxes(
        &self,
        time: V::Scalar,
        [first, second]: &[Parallelotope<V>; 2],
        axis: V,
        limits: Limits<V::Scalar>,
        is_close: bool,
    ) -> Option<Instant<V>> {
        let placed = self.placed_here(time);
        let [core_a, core_b] = [placed.a.core(), placed.b.core()];
        let size = core_a.extent + core_b.extent + placed.offset.norm();
        if !is_moderate(size) {
            return None;
        }
        let parts = [placed.a.turned_box(first), placed.b.turned_box(second)];
        let per_unit = reciprocal_of_power(self.unit);
        let boxes = Zonotope::new(&parts, placed.offset * per_unit, Scalar::ONE);
        // A facet counts as one support point, since it takes the place of one, and the search among all facets as
        // another.
        let there = match self.facet.get().and_then(|span| Some(BoxFacet::new(&boxes, boxes.facet(span)?))) {
            Some(kept) if kept.room > 0.0 && kept.facet.level > -kept.room * BEHIND_FACET => kept,
            _ => {
                self.count(1);
                BoxFacet::new(&boxes, boxes.highest()?)
            }
        };
        self.count(1);
        let facet = &there.facet;
        self.facet.set((there.room > 0.0).then_some(facet.span));
        let normal = vector::<V>(facet.normal);
        let (lost, errors) = (rounding(size), core_a.error + core_b.error);
        let [level_error, from_near] = [LEVEL, FROM_NEAR].map(|factor| lost * Scalar::from_f64(factor) + errors);
        let level = V::Scalar::from_f64(facet.level) * self.unit;
        let is_rough = !is_close && Float::abs(level) > level_error * Scalar::from_f64(NEAR_IN_MOTION);
        let (distance, gap, error, upper) = if is_rough {
            (level, level - level_error, from_near, Float::infinity())
        } else if limits.depth > Scalar::ZERO {
            return None;
        } else {
            let [distance, error, upper] = self.near_facet(&placed, &boxes, &there, axis)?;
            (distance, distance - error, error, upper)
        };
        let point = placed.place + (parts[1].center + vector(there.point)) * self.unit;
        let closing = self.closing(time, normal, [point + normal * distance, point]);
        Some(Instant { time, normal, gap, distance, upper, error, closing, point, is_close: !is_rough })
    }

    /// The distance of boxes that are nearly in contact, as exactly as it can be known from a facet; the error of it;
    /// and an upper bound. `None` unless zero's foot is within the facet, and the facet proves that the boxes are apart
    /// or that they overlap.
    #[inline(always)]
    fn near_facet(
        &self,
        Placed { a, b, offset, .. }: &Placed<'_, V>,
        boxes: &Zonotope,
        there: &BoxFacet,
        axis: V,
    ) -> Option<[V::Scalar; 3]> {
        let normal = vector::<V>(there.facet.normal);
        // If the boxes have passed through one another, the normal is on the other side.
        if !(there.room > 0.0 && normal.dot(axis) > Scalar::ZERO) {
            return None;
        }
        let corner = a.core_support(-normal, &mut Hint::new()) - b.core_support(normal, &mut Hint::new());
        self.count(1);
        let distance = normal.dot(corner + *offset);
        let per_unit = reciprocal_of_power(self.unit);
        let shapes = [a.rounding(), b.rounding()];
        let errors = shapes.map(|shape| (shape.error_length * per_unit).as_f64());
        let uncertainty = Uncertainty::of_exact_offset(shapes, *offset);
        let error = uncertainty.along(normal) + slack(distance, Scalar::ZERO);
        let mut upper = V::Scalar::infinity();
        // NaN proves nothing.
        if !(distance > error) {
            let epsilon = V::Scalar::EPSILON.as_f64();
            let leaning = there.leaning(boxes, array(normal), errors, epsilon);
            upper = distance + error + V::Scalar::from_f64(leaning) * self.unit;
            let [depth, error] = [-distance, uncertainty.length()].map(|length| (length * per_unit).as_f64());
            if !(upper < Scalar::ZERO && there.is_pierced(boxes, depth, error)) {
                return None;
            }
        }
        Some([distance, error, upper])
    }
}

impl BoxFacet {
    #[inline(always)]
    fn new(boxes: &Zonotope, facet: ZonotopeFacet) -> Self {
        let (weights, [i, j]) = (boxes.foot(&facet), facet.span);
        let room = |i: usize, j: usize| (1.0 - weights[i].abs()) / boxes.length(j);
        let room = room(i, j).min(room(j, i)) * facet.area.abs();
        let ends = [3, 4, 5].map(|k| (boxes.edge(k), weights[k].clamp(-1.0, 1.0)));
        let point = core::array::from_fn(|x| ends.iter().fold(0.0, |point, (edge, weight)| point - edge[x] * weight));
        Self { facet, room, point }
    }

    /// Whether the line through zero along the normal certainly goes through the facet, and on within the difference to
    /// the other side of zero.
    ///
    /// Zero is `depth` behind the facet, which is more than the `error` of the points of the difference. The other four
    /// edges lead from the facet to the opposite one, which is `2H` behind it and shifted to the side by no more than
    /// `2R`. So at the distance `s` behind the facet the difference contains the same parallelogram, shifted by no more
    /// than `s·R/H`. Here `s` is eight times the depth.
    fn is_pierced(&self, boxes: &Zonotope, depth: f64, error: f64) -> bool {
        let (mut behind, mut aside) = (0.0, 0.0);
        for k in (0..EDGES).filter(|k| !self.facet.span.contains(k)) {
            behind += self.facet.heights[k].abs();
            aside += boxes.length(k);
        }
        // The smaller the angle between two edges, the larger the error of coordinates along them.
        let [first, second] = self.facet.span.map(|k| boxes.length(k));
        let error = WITHIN * error * (first * second / self.facet.area.abs());
        let s = 8.0 * depth;
        s < behind && (self.room - error) * behind > s * aside
    }

    /// The most by which another point of a facet may be higher than its lowest corner, along a unit vector near its
    /// normal. The two edges may lean against the plane, and each edge has the error of its rotation, which is no more
    /// than that of the points of its box.
    fn leaning(&self, boxes: &Zonotope, n: Vec3, errors: [f64; 2], epsilon: f64) -> f64 {
        let turned = TURNED * epsilon;
        let mut leaning = 0.0;
        for k in 0..EDGES {
            let (edge, half) = (boxes.edge(k), boxes.length(k));
            let height = dot(n, edge).abs();
            // For another edge that is nearly parallel to the plane it is not certain which of its ends is the lower
            // one.
            if self.facet.span.contains(&k) || height < turned * 4.0 * half {
                let magnitude = dot(n.map(f64::abs), edge.map(f64::abs));
                let wrong = (turned * half).min(2.0 * errors[k / 3]);
                leaning += 2.0 * (height + PRODUCT * epsilon * magnitude + wrong);
            }
        }
        leaning
    }
}
