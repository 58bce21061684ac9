//! Two moving boxes at one time, by the facets of their difference.
//!
//! The difference of two boxes is the set of all `c + Σ tₖ·hₖ·eₖ` with `|tₖ| ≤ 1`, where `eₖ` are the unit vectors
//! along the six edges of both boxes, and `hₖ` half the lengths of the edges. Each of its facets is spanned by two
//! edges: those of a face of one box, or one edge of each box. The other four lead from the centre to the facet. So
//! along the unit vector `n` across the facet, zero is beyond the facet by
//!
//! > level(n) = n·c − Σ hₖ·|n·eₖ|,
//!
//! which is how far apart the plane of the facet keeps the boxes. If the boxes overlap, the highest level of all facets
//! is minus the depth. If they are apart, and the foot of the perpendicular from zero to the highest facet is within
//! the facet, the highest level is their distance. Otherwise an edge or a corner of the difference is closest to zero,
//! and the highest level is less than the distance, but no less than `1/√3` of it. This is because the vector to the
//! closest point is a sum of the normals of facets that meet there, and all of these are in one octant of the first
//! box's coordinates.
//!
//! The highest facet mostly stays the highest. As long as it does, its level is as smooth as the motion, even where the
//! boxes begin to overlap.
//!
//! If the boxes are well apart, or deep in one another, the level as computed is enough. If they are nearly in contact,
//! a support point along the facet's normal tells the level as exactly as it can be known. If they overlap by more than
//! the error of the level, the line through zero along the normal proves it: on one side of zero the line goes through
//! the facet, and on the other side there is another point of the line in the difference.

use convex_support::{Hint, Scalar, SupportMap as _, Vector};
use num_traits::Float;

use super::instant::{Instant, Limits, NEAR};
use super::moving_body::Block;
use super::moving_pair::MovingPair;
use super::placed::{Moved, Placed};
use crate::double::{Vec3, array, cross, dot, vector};
use crate::gjk::rounding;
use crate::separation::{Uncertainty, slack};
use crate::unit::is_moderate;

/// The number of edges of two boxes that count, three of each.
const EDGES: usize = 6;

/// The squared sine of the angle between two edges below which their facet is not computed. It is a sliver, and its
/// level is higher than those of other facets by no more than the sine times the shorter edge.
const PARALLEL: f64 = 1e-6;

/// The part of the highest level that slivers may add to it without being computed.
const OVERLOOKED: f64 = 0.1;

/// A bound on the error of the unit vector along an edge, in ε: three for each of two rotations, and one for its
/// length.
const TURNED: f64 = 8.0;

/// How far zero's foot has to be within a facet, in units of the error of points.
const WITHIN: f64 = 64.0;

/// A bound on the error of a product with a unit vector, in ε times the magnitudes of its terms.
const PRODUCT: f64 = 3.0;

/// How deep zero may be behind a facet that was the highest at the last look, for it to be taken again: this part of
/// the distance from zero's foot to the sides of the facet. Deeper than that, zero may be nearer to another facet.
const DEEP: f64 = 0.25;

/// The error of a level, in units of the error of a bound by a support point. The level is a sum over six edges, each
/// of which was turned, and the bound is a sum of two points.
const LEVEL: f64 = 2.0;

/// The same, roughly, for a level as it is told by a support point.
const FROM_NEAR: f64 = 0.5;

/// The difference of two boxes at one time.
struct Boxes {
    /// The centre of the second box, relative to the origin of its body, and the centre of the difference.
    from: Vec3,
    center: Vec3,
    /// Unit vectors along the edges of the first box and then of the second: first the x coordinates of all, then the y
    /// coordinates, then the z coordinates. In 2D the third edge of each box is perpendicular to the plane, and so long
    /// that the facets at its ends are never the highest.
    units: [[f64; EDGES]; 3],
    halves: [f64; EDGES],
}

/// A facet of the difference of two boxes.
struct BoxFacet {
    span: [usize; 2],
    /// The unit vector across it, from the second box to the first.
    normal: Vec3,
    /// How far zero is beyond it.
    level: f64,
    /// The distance of zero's foot from the nearest side of the facet; negative if it is outside.
    room: f64,
    /// The point of the second box, relative to its body's origin, that zero's foot is the difference of; if the foot
    /// is outside the facet, a point near that.
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
        // A facet counts as one support point, since it takes the place of one, and the search among all facets as
        // another.
        let facet = match self.facet.get().map(|span| boxes.facet(span)) {
            Some(kept) if kept.room > 0.0 && kept.level > -kept.room * DEEP => kept,
            _ => {
                self.count(1);
                boxes.facet(boxes.highest()?)
            }
        };
        self.count(1);
        self.facet.set((facet.room > 0.0).then_some(facet.span));
        let normal = vector::<V>(facet.normal);
        let (lost, errors) = (rounding(size), core_a.error + core_b.error);
        let [level_error, from_near] = [LEVEL, FROM_NEAR].map(|factor| lost * Scalar::from_f64(factor) + errors);
        let level = V::Scalar::from_f64(facet.level);
        let is_rough = !is_close && Float::abs(level) > level_error * Scalar::from_f64(NEAR);
        let (distance, gap, error, upper) = if is_rough {
            (level, level - level_error, from_near, Float::infinity())
        } else if limits.depth > Scalar::ZERO {
            return None;
        } else {
            let [distance, error, upper] = self.near_facet(&placed, &boxes, &facet, axis)?;
            (distance, distance - error, error, upper)
        };
        let point = placed.place + vector(facet.point);
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
        boxes: &Boxes,
        facet: &BoxFacet,
        axis: V,
    ) -> Option<[V::Scalar; 3]> {
        let normal = vector::<V>(facet.normal);
        // If the boxes have passed through one another, the normal is on the other side.
        if !(facet.room > 0.0 && normal.dot(axis) > Scalar::ZERO) {
            return None;
        }
        let corner = a.core_support(-normal, &mut Hint::new()) - b.core_support(normal, &mut Hint::new());
        self.count(1);
        let distance = normal.dot(corner + *offset);
        let shapes = [a.rounding(), b.rounding()];
        let errors = shapes.map(|shape| shape.error_length.as_f64());
        let uncertainty = Uncertainty::of_exact_offset(shapes, *offset);
        let error = uncertainty.along(normal) + slack(distance, Scalar::ZERO);
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
        Some([distance, error, upper])
    }
}

impl Boxes {
    /// The difference of the boxes of two bodies whose origins differ by `offset`, and which together are of this size.
    #[inline(always)]
    fn new<V: Vector>(
        [first, second]: &[Block<V>; 2],
        (a, b): (&Moved<'_, V>, &Moved<'_, V>),
        offset: V,
        size: f64,
    ) -> Self {
        let is_across = |k: usize| V::DIM == 2 && k % 3 == 2;
        let units: [Vec3; EDGES] = core::array::from_fn(|k| match k {
            _ if is_across(k) => [0.0, 0.0, 1.0],
            0..3 => array(a.turned(first.units[k])),
            _ => array(b.turned(second.units[k - 3])),
        });
        let halves = core::array::from_fn(|k| match k {
            _ if is_across(k) => size,
            0..3 => first.halves[k],
            _ => second.halves[k - 3],
        });
        // In most cases both centres are zero.
        let (from, center) = if [first.center, second.center] == [V::ZERO; 2] {
            (V::ZERO, offset)
        } else {
            let from = b.turned(second.center);
            (from, offset + (a.turned(first.center) - from))
        };
        let units = core::array::from_fn(|x| core::array::from_fn(|k| units[k][x]));
        Self { from: array(from), center: array(center), units, halves }
    }

    /// The unit vector along an edge.
    #[inline(always)]
    fn unit(&self, k: usize) -> Vec3 {
        let [x, y, z] = &self.units;
        [x[k], y[k], z[k]]
    }

    /// The two edges that span the highest facet. `None` if some edges are so nearly parallel that their facet, which
    /// is not computed, may be the highest.
    #[inline(always)]
    fn highest(&self) -> Option<[usize; 2]> {
        let (u, w) = ([self.unit(0), self.unit(1), self.unit(2)], [self.unit(3), self.unit(4), self.unit(5)]);
        let (h, k) = (&self.halves[..3], &self.halves[3..]);
        // Coordinates along the edges of the first box.
        let r: [Vec3; 3] = core::array::from_fn(|i| core::array::from_fn(|j| dot(u[i], w[j])));
        let m = r.map(|row| row.map(f64::abs));
        let c: Vec3 = core::array::from_fn(|i| dot(u[i], self.center));
        let (mut highest, mut span) = (f64::NEG_INFINITY, [1, 2]);
        for i in 0..3 {
            let level = c[i].abs() - (h[i] + k[0] * m[i][0] + k[1] * m[i][1] + k[2] * m[i][2]);
            if level > highest {
                (highest, span) = (level, [(i + 1) % 3, (i + 2) % 3]);
            }
        }
        for j in 0..3 {
            let along = dot(w[j], self.center).abs();
            let level = along - (k[j] + h[0] * m[0][j] + h[1] * m[1][j] + h[2] * m[2][j]);
            if level > highest {
                (highest, span) = (level, [3 + (j + 1) % 3, 3 + (j + 2) % 3]);
            }
        }
        // Facets spanned by an edge of each box. The vector product of two edges is as long as the sine of the angle
        // between them. Squares with the signs of the levels are compared, so that no root is needed.
        let (mut highest, mut overlooked) = (highest * highest.abs(), 0.0);
        for i in 0..3 {
            let [p, q] = [(i + 1) % 3, (i + 2) % 3];
            for j in 0..3 {
                let [o, l] = [(j + 1) % 3, (j + 2) % 3];
                let squared_sine = 1.0 - r[i][j] * r[i][j];
                if squared_sine < PARALLEL {
                    let shorter = h[i].min(k[j]);
                    overlooked += squared_sine.abs() * shorter * shorter;
                    continue;
                }
                let along = (c[p] * r[q][j] - c[q] * r[p][j]).abs();
                let level = along - (h[p] * m[q][j] + h[q] * m[p][j] + k[o] * m[i][l] + k[l] * m[i][o]);
                let squared = level * level.abs();
                if squared > highest * squared_sine {
                    (highest, span) = (squared / squared_sine, [i, 3 + j]);
                }
            }
        }
        // If a number is NaN, the comparison fails.
        (overlooked <= highest.abs() * (OVERLOOKED * OVERLOOKED)).then_some(span)
    }

    /// Of the two facets that two edges span, the one on the side of zero.
    #[inline(always)]
    fn facet(&self, span: [usize; 2]) -> BoxFacet {
        let [i, j] = span;
        let Self { from, center, units: [x, y, z], halves } = self;
        let (first, second) = (self.unit(i), self.unit(j));
        let across = cross(&first, &second);
        let squared_sine = dot(across, across);
        let sine = Float::sqrt(squared_sine);
        let per = Float::copysign(sine.recip(), dot(across, *center));
        let n = across.map(|x| x * per);
        let heights: [f64; EDGES] = core::array::from_fn(|k| n[0] * x[k] + n[1] * y[k] + n[2] * z[k]);
        let sides: [f64; EDGES] = core::array::from_fn(|k| Float::copysign(halves[k], heights[k]));
        let reach: [f64; EDGES] = core::array::from_fn(|k| heights[k] * sides[k]);
        let level = dot(n, *center) - ((reach[0] + reach[2] + reach[4]) + (reach[1] + reach[3] + reach[5]));
        // A corner of the facet is the difference of a corner of each box. From there zero's foot is reached by a way
        // along each of the two edges.
        let sum = |c: &[f64; EDGES], k: usize| c[k] * sides[k] + c[k + 1] * sides[k + 1] + c[k + 2] * sides[k + 2];
        let (of_first, of_second) = ([sum(x, 0), sum(y, 0), sum(z, 0)], [sum(x, 3), sum(y, 3), sum(z, 3)]);
        let corner: Vec3 = core::array::from_fn(|x| center[x] - (of_first[x] + of_second[x]));
        let (cosine, on_first, on_second) = (dot(first, second), dot(first, corner), dot(second, corner));
        let way = [(cosine * on_second - on_first) / squared_sine, (cosine * on_first - on_second) / squared_sine];
        let room = (halves[i] - (way[0] - sides[i]).abs()).min(halves[j] - (way[1] - sides[j]).abs()) * sine;
        let within = |k: usize, way: f64| way.max(sides[k] - halves[k]).min(sides[k] + halves[k]);
        let [p, q] = [(i, way[0]), (j, way[1])].map(|(k, way)| if k < 3 { 0.0 } else { within(k, way) });
        let point = core::array::from_fn(|x| from[x] + (of_second[x] - first[x] * p - second[x] * q));
        BoxFacet { span, normal: n, level, room, point }
    }

    /// Whether the line through zero along the normal certainly goes through the facet, and on within the difference to
    /// the other side of zero.
    ///
    /// Zero is `depth` behind the facet, which is more than the `error` of the points of the difference. The other four
    /// edges lead from the facet to the opposite one, which is `2H` behind it and shifted to the side by no more than
    /// `2R`. So at the distance `s` behind the facet the difference contains the same parallelogram, shifted by no more
    /// than `s·R/H`. Here `s` is eight times the depth.
    fn is_pierced(&self, facet: &BoxFacet, depth: f64, error: f64) -> bool {
        let [i, j] = facet.span;
        let (mut behind, mut aside) = (0.0, 0.0);
        for k in (0..EDGES).filter(|&k| k != i && k != j) {
            behind += self.halves[k] * dot(facet.normal, self.unit(k)).abs();
            aside += self.halves[k];
        }
        // The smaller the angle between two edges, the larger the error of coordinates along them.
        let across = cross(&self.unit(i), &self.unit(j));
        let error = WITHIN * error / Float::sqrt(dot(across, across));
        let s = 8.0 * depth;
        s < behind && (facet.room - error) * behind > s * aside
    }

    /// The most by which another point of a facet may be higher than its lowest corner, along a unit vector near its
    /// normal. The two edges may lean against the plane, and each edge has the error of its rotation, which is no more
    /// than that of the points of its box.
    fn leaning(&self, facet: &BoxFacet, n: Vec3, errors: [f64; 2], epsilon: f64) -> f64 {
        let turned = TURNED * epsilon;
        let mut leaning = 0.0;
        for k in 0..EDGES {
            let (half, unit) = (self.halves[k], self.unit(k));
            let height = dot(n, unit).abs();
            // For another edge that is nearly parallel to the plane it is not certain which of its ends is the lower
            // one.
            if facet.span.contains(&k) || height < turned * 4.0 {
                let magnitude = dot(n.map(f64::abs), unit.map(f64::abs));
                let wrong = (turned * half).min(2.0 * errors[k / 3]);
                leaning += 2.0 * (half * (height + PRODUCT * epsilon * magnitude) + wrong);
            }
        }
        leaning
    }
}
