//! A look at two moving boxes, by the facets of their difference.
//!
//! Well apart, or deep in one another, they are seen by the highest facet ([`boxes`](super::boxes)). Nearly in contact,
//! a support point along its normal tells its level as well as that can be known. Where the boxes overlap by more than
//! the level may be wrong by, the line through zero along the normal proves it: on one side of zero it goes through the
//! facet, and on the other side it is within the difference.

use convex_support::{Hint, Scalar, SupportMap as _, Vector};
use num_traits::Float;

use super::boxes::{Block, BoxFacet, Boxes, vector};
use super::instant::{Instant, Limits, NEAR};
use super::moving_pair::MovingPair;
use super::placed::Placed;
use crate::double::array;
use crate::gjk::rounding;
use crate::separation::Uncertainty;
use crate::unit::is_moderate;

/// As a part of the way from zero's foot to the sides of a facet, how deep zero may be behind it without being nearer
/// to another.
const DEEP: f64 = 0.25;

/// What a level is wrong by, in units of what a bound by a support point loses: it is a sum of six edges, each of which
/// was turned, where that is of two points.
const LEVEL: f64 = 2.0;

/// The same of a level from near, roughly.
const FROM_NEAR: f64 = 0.5;

impl<V: Vector> MovingPair<'_, V> {
    /// Two boxes at a time, from near if that is asked or they are nearly in contact; `None` where it is not certain
    /// which facet is the highest, or that proves nothing.
    ///
    /// All is compiled into one function, so that where the bodies are need not be written to memory and read again.
    #[inline(always)]
    pub(super) fn by_boxes(
        &self,
        time: V::Scalar,
        blocks: &[Block<V>; 2],
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
        let boxes = Boxes::new(blocks, (&placed.a, &placed.b), placed.offset, size.as_f64());
        // The facet counts as a support point, which it takes the place of, and as two if it is looked for among all.
        let facet = match self.facet.get().map(|span| boxes.facet(span)) {
            Some(kept) if kept.room > 0.0 && kept.level > -kept.room * DEEP => kept,
            _ => {
                self.count(1);
                boxes.facet(boxes.highest()?)
            }
        };
        self.count(1);
        self.facet.set((facet.room > 0.0).then_some(facet.span));
        let (lost, errors) = (rounding(size), core_a.error + core_b.error);
        let [error, from_near] = [LEVEL, FROM_NEAR].map(|factor| lost * Scalar::from_f64(factor) + errors);
        let distance = V::Scalar::from_f64(facet.level);
        let there = if !is_close && Float::abs(distance) > error * Scalar::from_f64(NEAR) {
            Instant {
                time,
                normal: vector(facet.normal),
                gap: distance - error,
                distance,
                upper: Float::infinity(),
                error: from_near,
                closing: Scalar::ZERO,
                point: vector(facet.point),
                is_close: false,
            }
        } else if limits.depth > Scalar::ZERO {
            return None;
        } else {
            self.near_facet(time, &placed, &boxes, &facet, axis)?
        };
        let point = placed.place + there.point;
        let closing = self.closing(time, there.normal, [point + there.normal * there.distance, point]);
        Some(Instant { point, closing, ..there })
    }

    /// What a facet tells of a time, as well as it can be known, if zero's foot is within it, and it proves that the
    /// boxes are apart or overlap. The point is relative to the origin of the second, and the closing speed left out.
    #[inline(always)]
    fn near_facet(
        &self,
        time: V::Scalar,
        Placed { a, b, offset, .. }: &Placed<'_, V>,
        boxes: &Boxes,
        facet: &BoxFacet,
        axis: V,
    ) -> Option<Instant<V>> {
        let normal = vector::<V>(facet.normal);
        // Not where they have passed through one another.
        if !(facet.room > 0.0 && normal.dot(axis) > Scalar::ZERO) {
            return None;
        }
        let corner = a.core_support(-normal, &mut Hint::new()) - b.core_support(normal, &mut Hint::new());
        self.count(1);
        let distance = normal.dot(corner + *offset);
        let shapes = [a.rounding(), b.rounding()];
        let errors = shapes.map(|shape| shape.error_length.as_f64());
        let uncertainty = Uncertainty::of_exact_offset(shapes, *offset);
        // As in an answer: the unit vector and the sums.
        let slack = V::Scalar::EPSILON * Scalar::from_f64(3.0) * Float::abs(distance);
        let error = uncertainty.along(normal) + slack;
        let mut upper = V::Scalar::infinity();
        // NaN proves nothing.
        if !(distance > error) {
            let epsilon = V::Scalar::EPSILON.as_f64();
            let leaning = boxes.leaning(facet, array(normal), errors, epsilon);
            upper = distance + error + Scalar::from_f64(leaning);
            if !(upper < Scalar::ZERO && boxes.is_pierced(facet, -distance.as_f64(), uncertainty.length().as_f64())) {
                return None;
            }
        }
        let (gap, point) = (distance - error, vector(facet.point));
        let closing = Scalar::ZERO;
        Some(Instant { time, normal, gap, distance, upper, error, closing, point, is_close: true })
    }
}
