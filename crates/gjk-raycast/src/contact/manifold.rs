//! The points at which two shapes in contact support each other: the corners of the overlap of their features, each
//! measured against both shapes. Where a vertex touches, or edges cross, the closest points alone.

use convex_support::{CoreKind, Scalar, ScalarOf, SupportMap, Vector, compiled_once};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::clip::{Clipped, ClippedCorners, clip};
use super::outline::{ContactPart, ContactPlane, Outline, ROOM};
use super::reduction::{Candidate, Rank, WORTHWHILE, reduced};
use super::surface::{MAX_SUPPORT_POINTS, Side};
use super::{Contact, ContactPoint, MANIFOLD_POINTS};
use crate::SignedDistance;
use crate::pair::Shape;
use crate::symmetric::{Across, axes_across, cross, dot, way};

/// How near a point is to a corner of a shape's feature if it counts as the corner, as a part of the smaller shape's
/// size.
const AT_CORNER: f64 = 1.0 / 64.0;

/// As a part of the smaller shape's size: how much farther apart than asked for the shapes may be at a point, and how
/// much less deep than the deepest all points may be. While shapes move by less than half of it, the manifold keeps its
/// corners.
const KEPT: f64 = 1.0 / 1024.0;

/// The sine of the angle from which on segments cross in one point.
const CROSSES: f64 = 0.25;

/// The points where the features of both shapes that face each other overlap, at most four, and the closest points, if
/// deeper. If one of the features is a vertex, or edges cross, only the closest points. Points of the `last` manifold
/// that still hold are preferred.
pub(super) fn manifold<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    answer: &SignedDistance<A::Vector>,
    within: ScalarOf<A>,
    last: &[ContactPoint<A::Vector>],
) -> Contact<A::Vector> {
    let is_single = match (a.core().kind, b.core().kind) {
        (CoreKind::Point(_), _) | (_, CoreKind::Point(_)) => true,
        (CoreKind::Segment { half: u, .. }, CoreKind::Segment { half: w, .. }) => {
            let (uu, uw, ww) = (u.dot(u), u.dot(w), w.dot(w));
            uw * uw < uu * ww * Scalar::from_f64(1.0 - CROSSES * CROSSES)
        }
        _ => false,
    };
    if is_single { single(answer) } else { by_clipping([&a, &b], answer, within, last) }
}

/// The manifold of a shape over an unbounded plane `b`: the corners of the feature that faces it.
pub(crate) fn manifold_over_plane<A>(
    a: &A,
    answer: &SignedDistance<A::Vector>,
    within: ScalarOf<A>,
    last: &[ContactPoint<A::Vector>],
) -> Contact<A::Vector>
where
    A: SupportMap + ?Sized,
{
    if let CoreKind::Point(_) = a.core().kind { single(answer) } else { by_plane(&a, answer, within, last) }
}

/// The closest points alone, for round features or segments that cross.
fn single<V: Vector>(answer: &SignedDistance<V>) -> Contact<V> {
    let &SignedDistance { point_a, point_b, signed_distance, lower, upper, .. } = answer;
    let (error, face) = (upper - lower, ContactPart::Face.code());
    let point = ContactPoint { point_a, point_b, signed_distance, error, feature_a: face, feature_b: face };
    Contact::new(answer.normal, *answer, [point])
}

compiled_once! {
    /// [`manifold`] behind pointers. It is computed for the shapes in the order in which the normal points to one side
    /// of space, so that it is the same, to the last bit, in either order of the call.
    fn by_clipping<V>(
        shapes: [Shape<'_, V>; 2],
        answer: &SignedDistance<V>,
        within: V::Scalar,
        last: &[ContactPoint<V>],
    ) -> Contact<V> {
        let [a, b] = shapes;
        // Along no axis and no diagonal.
        let aside = V::from_fn(|i| V::Scalar::from_f64([1.0, 0.7549, 0.5698][i]));
        if answer.normal.dot(aside) < V::Scalar::ZERO {
            let last: SmallVec<[_; MANIFOLD_POINTS]> = last.iter().map(|point| point.reversed()).collect();
            return by_clipping([b, a], &answer.reversed(), within, &last).reversed();
        }
        let normal = answer.normal;
        let half: V::Scalar = Scalar::from_f64(0.5);
        let origin = answer.point_a * half + answer.point_b * half;
        let across = axes_across(normal);
        let (core_a, core_b) = (a.core(), b.core());
        let size = core_a.size().min(core_b.size());
        let reach = Reach::new(answer, within, size);
        let level = answer.signed_distance * -half;
        // The closest points may be shifted against each other by the uncertainty of the normal.
        let levels = [level, level + (answer.upper - answer.lower)];
        let side = |shape, core, normal| Side::new(shape, core, ContactPlane { normal, across, origin }, levels);
        let sides = [&mut side(a, &core_a, -normal), &mut side(b, &core_b, normal)];
        Facing { sides, reach, last }.contact(answer, [level, level])
    }
}

compiled_once! {
    fn by_plane<V>(
        shape: Shape<'_, V>,
        answer: &SignedDistance<V>,
        within: V::Scalar,
        last: &[ContactPoint<V>],
    ) -> Contact<V> {
        let (normal, origin) = (answer.normal, answer.point_b);
        let across = axes_across(normal);
        let plane = |normal| ContactPlane { normal, across, origin };
        let core = shape.core();
        let reach = Reach::new(answer, within, core.size());
        let heights = [-answer.signed_distance, -answer.lower];
        let sides = [&mut Side::new(shape, &core, plane(-normal), heights), &mut Side::flat(plane(normal))];
        let levels = [-answer.signed_distance, V::Scalar::ZERO];
        Facing { sides, reach, last }.contact(answer, levels)
    }
}

/// The distances within which a point counts as a corner.
struct Reach<S> {
    within: S,
    /// How far behind its supporting plane a shape may be met by the other one.
    slab: S,
    near: S,
    slack: S,
}

impl<S: Scalar> Reach<S> {
    /// A point of a shape that is in the other one, or no farther from it than asked for, is no farther behind the
    /// supporting plane than the depth plus that distance.
    fn new<V: Vector<Scalar = S>>(answer: &SignedDistance<V>, within: S, size: S) -> Self {
        let slack = size * S::from_f64(KEPT);
        let slab = (within - answer.lower).max(S::ZERO) + slack + slack;
        Self { within, slab, near: size * S::from_f64(AT_CORNER), slack }
    }
}

/// Points that a manifold may have.
type Candidates<S> = SmallVec<[Candidate<S>; ROOM]>;

/// The points that it has.
type Chosen<S> = SmallVec<[Candidate<S>; MANIFOLD_POINTS]>;

/// The number of points that span an overlap.
fn most<V: Vector>() -> usize {
    if V::DIM == 2 { 2 } else { MANIFOLD_POINTS }
}

/// Both shapes, each in the frame of the other's contact plane.
struct Facing<'s, V: Vector> {
    sides: [&'s mut Side<'s, V>; 2],
    reach: Reach<V::Scalar>,
    last: &'s [ContactPoint<V>],
}

impl<V: Vector> Facing<'_, V> {
    /// The corners of the overlap where the shapes are no farther apart than asked for, reduced to four, in the plane
    /// to two; and the closest points, at these levels.
    fn contact(&mut self, answer: &SignedDistance<V>, levels: [V::Scalar; 2]) -> Contact<V> {
        self.sides.iter_mut().for_each(|side| side.see(self.reach.slab));
        let mut candidates = Candidates::new();
        self.add_corners(&mut candidates, answer.lower);
        let rank = |i: usize| -> Rank { (!self.is_known(candidates[i].codes), candidates[i].codes) };
        let chosen = reduced(&candidates, !self.last.is_empty(), rank);
        let limit = V::Scalar::infinity();
        let mut measured = |&i: &usize| self.measured(candidates[i], answer.lower, limit);
        let mut chosen: Chosen<_> = chosen.iter().filter_map(&mut measured).collect();
        self.add_closest(&mut chosen, &candidates, answer, levels);
        Contact::new(answer.normal, *answer, chosen.iter().map(|candidate| self.point(candidate, answer)))
    }

    /// Whether the last manifold had this point.
    fn is_known(&self, codes: [u32; 2]) -> bool {
        self.last.iter().any(|point| [point.feature_a, point.feature_b] == codes)
    }

    /// Adds the corners of the overlap. None is deeper than the `deepest`.
    fn add_corners(&mut self, candidates: &mut Candidates<V::Scalar>, deepest: V::Scalar) {
        let [a, b] = [0, 1].map(|i| self.sides[i].outline.corners.len());
        // An unbounded plane has no corners.
        if a < 2 || b == 1 {
            return;
        }
        self.sides.iter_mut().for_each(|side| side.flatten());
        let [of_a, of_b] = [&self.sides[0], &self.sides[1]];
        // A segment is clipped by a polygon.
        let is_swapped = a > b && b > 0;
        let [own, other] = if is_swapped { [of_b, of_a] } else { [of_a, of_b] };
        let mut lists = [&mut ClippedCorners::new(), &mut ClippedCorners::new()];
        clip(&own.outline, &other.outline, Scalar::ZERO, &mut lists);
        let overlap = lists[0].as_slice();
        for (i, corner) in overlap.iter().enumerate() {
            let [own, other] = corner.parts;
            let parts = self.settled(corner.at, if is_swapped { [other, own] } else { [own, other] });
            let is_crossing = matches!(parts, [ContactPart::Edge(..), ContactPart::Edge(..)]);
            let codes = parts.map(ContactPart::code);
            if is_crossing && self.is_on_a_line(overlap, i) || candidates.iter().any(|known| known.codes == codes) {
                continue;
            }
            let levels = [0, 1].map(|i| self.sides[i].chord(corner.at));
            let error = V::Scalar::infinity();
            let candidate = Candidate { at: corner.at, levels, error, codes, is_closest: false };
            let slack = self.reach.slack * Scalar::from_f64(if self.is_known(codes) { 2.0 } else { 1.0 });
            let limit = self.reach.within + slack;
            if candidate.gap() <= limit {
                candidates.push(candidate);
            } else {
                // Between points of shapes that are apart, the shapes may overlap.
                let measured = self.measured(candidate, deepest, limit);
                candidates.extend(measured.filter(|measured| measured.gap() <= limit));
            }
        }
    }

    /// The candidate with the levels of the surfaces. `None` if these are farther apart than the `limit`, or unknown,
    /// as at a vertex behind the visible part of a shape: a side is along the normal there.
    fn measured(
        &mut self,
        candidate: Candidate<V::Scalar>,
        deepest: V::Scalar,
        limit: V::Scalar,
    ) -> Option<Candidate<V::Scalar>> {
        if candidate.error.is_finite() {
            return Some(candidate);
        }
        let [of_a, of_b] = &mut self.sides;
        let at = candidate.at;
        // Mostly one support point of each proves that they are farther apart.
        let most = if limit.is_finite() { of_b.level(at, -limit - of_a.top, 1)?.most() } else { limit };
        let of_a = of_a.level(at, -limit - most, MAX_SUPPORT_POINTS)?;
        let of_b = of_b.level(at, -limit - of_a.most(), MAX_SUPPORT_POINTS)?;
        // An edge whose projection is short may be arbitrarily steep, and rounding decides where a corner is on it; but
        // no points of the shapes are deeper in one another than the shapes are.
        let lack = (deepest + of_a.value + of_b.value).max(V::Scalar::ZERO) * Scalar::from_f64(0.5);
        let error = of_a.error + of_b.error + lack;
        (error <= self.reach.slack).then_some(Candidate {
            levels: [of_a.value - lack, of_b.value - lack],
            error,
            ..candidate
        })
    }

    /// Whether a corner of the overlap lies on the line through its two neighbours, within the slack. It is asked of
    /// corners at which an edge of one outline crosses an edge of the other: if the two edges lie on one another,
    /// rounding alone decides where they cross, and the corner means nothing.
    fn is_on_a_line(&self, overlap: &[Clipped<V::Scalar>], i: usize) -> bool {
        let n = overlap.len();
        let at = |i: usize| overlap[i % n].at;
        let base = way(at(i + n - 1), at(i + 1));
        let turn = cross(way(at(i + n - 1), at(i)), base);
        n > 2 && turn * turn <= dot(base, base) * (self.reach.slack * self.reach.slack)
    }

    /// Adds the closest points if none of the chosen is as deep: features that are not quite flat are closest in their
    /// midst, and those of vertices, or of edges that cross, have no common corners. A chosen point near them is the
    /// same point, and moves there; if there is no room, they replace the nearest.
    fn add_closest(
        &self,
        chosen: &mut Chosen<V::Scalar>,
        candidates: &[Candidate<V::Scalar>],
        answer: &SignedDistance<V>,
        levels: [V::Scalar; 2],
    ) {
        let deepest = answer.upper + self.reach.slack;
        // NaN counts as deep.
        if chosen.iter().any(|candidate| !(candidate.gap() > deepest)) {
            return;
        }
        let squared = |candidate: &Candidate<V::Scalar>| dot(candidate.at, candidate.at);
        let near = self.reach.near * self.reach.near;
        let part = |side: &Side<'_, V>| match side.outline.corners.as_slice() {
            [corner] => ContactPart::Vertex(corner.id),
            [from, to] => ContactPart::Edge(from.id, to.id),
            _ => ContactPart::Face,
        };
        let [a, b] = &self.sides;
        let whole = [part(a), part(b)].map(ContactPart::code);
        let codes = candidates.iter().find(|c| squared(c) <= near).map_or(whole, |c| c.codes);
        let zero = V::Scalar::ZERO;
        let (at, error) = ((zero, zero), answer.upper - answer.lower);
        let closest = Candidate { at, levels, error, codes, is_closest: true };
        let nearest = chosen.iter().map(squared).fold(V::Scalar::infinity(), V::Scalar::min);
        let limit = near.max(nearest * Scalar::from_f64(1.0 + WORTHWHILE));
        let is_full = chosen.len() >= most::<V>();
        let is_nearest =
            |c: &&mut Candidate<V::Scalar>| c.codes == codes || squared(c) <= if is_full { limit } else { near };
        match chosen.iter_mut().filter(is_nearest).min_by_key(|c| (c.codes != codes, c.codes)) {
            Some(same) => *same = closest,
            None => chosen.push(closest),
        }
    }

    /// The parts of both shapes that a point is on: a corner of a feature if it is near one, or else the part that
    /// clipping found. If corners of both coincide, as in stacked boxes, clipping would change from frame to frame
    /// which of them is within the other's outline.
    fn settled(&self, at: Across<V::Scalar>, parts: [ContactPart; 2]) -> [ContactPart; 2] {
        let near = self.reach.near;
        let corner = |outline: &Outline<V::Scalar>| {
            let mut nearest = (near * near, None);
            for corner in &outline.corners {
                let e = (at.0 - corner.at.0, at.1 - corner.at.1);
                if dot(e, e) <= nearest.0 {
                    nearest = (dot(e, e), Some(ContactPart::Vertex(corner.id)));
                }
            }
            nearest.1
        };
        let [a, b] = [0, 1].map(|i| corner(&self.sides[i].outline));
        if a.is_none() && b.is_none() {
            parts
        } else {
            [a.unwrap_or(ContactPart::Face), b.unwrap_or(ContactPart::Face)]
        }
    }

    fn point(&self, candidate: &Candidate<V::Scalar>, answer: &SignedDistance<V>) -> ContactPoint<V> {
        let [feature_a, feature_b] = candidate.codes;
        let [point_a, point_b] = if candidate.is_closest {
            [answer.point_a, answer.point_b]
        } else {
            [0, 1].map(|i| self.sides[i].plane.point(candidate.at, candidate.levels[i]))
        };
        ContactPoint {
            point_a,
            point_b,
            signed_distance: candidate.gap(),
            error: candidate.error,
            feature_a,
            feature_b,
        }
    }
}
