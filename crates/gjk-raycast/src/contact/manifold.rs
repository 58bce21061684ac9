//! The points in which two shapes in contact carry each other.

use convex_support::{Feature, Scalar, SupportMap, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::clip::{ClippedCorners, clip};
use super::outline::{ContactPart, ContactPlane, Outline};
use super::result::MAX_POINTS;
use super::{ContactPoint, SignedDistance};
use crate::symmetric::{Across, axes_across, cross, dot};

/// How deep behind its supporting plane a shape is taken for its feature, as a part of the smaller shape's size.
const SLAB: f64 = 1.0 / 64.0;

/// The points of a manifold.
pub(super) type Points<V> = SmallVec<[ContactPoint<V>; MAX_POINTS]>;

/// The points where the features of both shapes that face each other overlap, at most four, and the closest points, if those are not among
/// them; they are alone where one of the features is a vertex, or where edges cross.
pub(super) fn manifold<A, B>(a: &A, b: &B, answer: &SignedDistance<A::Vector>, within: ScalarOf<A>) -> Points<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let normal = answer.normal;
    let half: ScalarOf<A> = Scalar::from_f64(0.5);
    let origin = answer.point_a * half + answer.point_b * half;
    let plane = ContactPlane { normal, across: axes_across(normal), origin };
    let (core_a, core_b) = (a.core(), b.core());
    let smaller = (core_a.extent + core_a.radius).min(core_b.extent + core_b.radius);
    let near = smaller * ScalarOf::<A>::from_f64(SLAB);
    // Of shapes that are apart their faces may lean by as much more, but not farther than they are nearly flat.
    let slab = near + within.max(Scalar::ZERO).min(near);
    let outline = |shape: &dyn Fn(&mut Feature<A::Vector>), origin| {
        let mut feature = Feature::new();
        shape(&mut feature);
        Outline::new(&feature, origin, &plane)
    };
    let of_a =
        outline(&|feature| a.core_support_feature(-normal, slab, feature), core_a.origin - normal * core_a.radius);
    let of_b =
        outline(&|feature| b.core_support_feature(normal, slab, feature), core_b.origin + normal * core_b.radius);
    let facing = Facing { plane, of_a, of_b };
    facing.points(answer, within + near, near)
}

/// The same of a shape over a plane, `b`, without an end: the corners of the feature that faces it.
pub(crate) fn manifold_over_plane<A>(
    a: &A,
    answer: &SignedDistance<A::Vector>,
    within: ScalarOf<A>,
) -> Points<A::Vector>
where
    A: SupportMap + ?Sized,
{
    let normal = answer.normal;
    let plane = ContactPlane { normal, across: axes_across(normal), origin: answer.point_b };
    let core = a.core();
    let near = (core.extent + core.radius) * ScalarOf::<A>::from_f64(SLAB);
    let slab = near + within.max(Scalar::ZERO).min(near);
    let mut feature = Feature::new();
    a.core_support_feature(-normal, slab, &mut feature);
    let of_a = Outline::new(&feature, core.origin - normal * core.radius, &plane);
    let of_b = Outline { corners: SmallVec::new(), rim: None, is_complete: true };
    let facing = Facing { plane, of_a, of_b };
    let corners = facing.of_a.corners.iter().filter(|corner| corner.height <= within + near);
    let mut candidates: Candidates<_> = corners
        .map(|corner| Candidate {
            at: corner.at,
            heights: [corner.height.max(answer.lower), Scalar::ZERO],
            parts: [ContactPart::Vertex(corner.id), ContactPart::Face],
        })
        .collect();
    if candidates.len() < 2 {
        candidates.clear();
    }
    facing.with_closest(&mut candidates, answer, [answer.signed_distance, Scalar::ZERO], near);
    facing.reduced(&candidates)
}

type ScalarOf<A> = <<A as SupportMap>::Vector as Vector>::Scalar;

/// The outlines of both features in the plane of contact.
struct Facing<V: Vector> {
    plane: ContactPlane<V>,
    of_a: Outline<V::Scalar>,
    of_b: Outline<V::Scalar>,
}

/// A point of contact in the plane: where it is, how high the features of both shapes are there, and what it is of each.
#[derive(Clone, Copy)]
struct Candidate<S> {
    at: Across<S>,
    heights: [S; 2],
    parts: [ContactPart; 2],
}

impl<S: Scalar> Candidate<S> {
    fn gap(&self) -> S {
        self.heights[0] - self.heights[1]
    }
}

/// Points that a manifold may have.
type Candidates<S> = SmallVec<[Candidate<S>; 32]>;

impl<V: Vector> Facing<V> {
    /// The corners of the overlap where the features are no farther apart than `within`, and the closest points, reduced to four. Those
    /// `near` the same corner of a feature are one.
    fn points(&self, answer: &SignedDistance<V>, within: V::Scalar, near: V::Scalar) -> Points<V> {
        let mut candidates = self.corners_of_overlap(within, near, answer.lower);
        let half = answer.signed_distance * Scalar::from_f64(0.5);
        self.with_closest(&mut candidates, answer, [half, -half], near);
        self.reduced(&candidates)
    }

    /// The same without the closest points. None is deeper than the `deepest`.
    fn corners_of_overlap(&self, within: V::Scalar, near: V::Scalar, deepest: V::Scalar) -> Candidates<V::Scalar> {
        let (of_a, of_b) = (&self.of_a, &self.of_b);
        let mut candidates = Candidates::new();
        if of_a.corners.len() < 2 || of_b.corners.len() < 2 {
            return candidates;
        }
        // A segment is clipped by a polygon.
        let is_swapped = of_a.corners.len() > of_b.corners.len();
        let overlap: ClippedCorners<V::Scalar> = if is_swapped { clip(of_b, of_a) } else { clip(of_a, of_b) };
        for corner in &overlap {
            let [own, other] = corner.parts;
            let parts = if is_swapped { [other, own] } else { [own, other] };
            // Seen nearly from its end a feature is as steep as one likes, and where the corner is on it is rounding; but no points of
            // the shapes are deeper in one another than the shapes are.
            let heights = [of_a.height(corner.at), of_b.height(corner.at)];
            let lack = (deepest - (heights[0] - heights[1])).max(V::Scalar::ZERO) * Scalar::from_f64(0.5);
            let heights = [heights[0] + lack, heights[1] - lack];
            let candidate = Candidate { at: corner.at, heights, parts: self.settled(corner.at, parts, near) };
            if candidate.gap() <= within && candidates.iter().all(|known| known.parts != candidate.parts) {
                candidates.push(candidate);
            }
        }
        candidates
    }

    /// Adds the closest points, whose heights above the plane are given, if none of the candidates is as deep: features that are not quite
    /// flat are closest in their midst, and those of vertices, or of edges that cross, have no corners in common. A candidate `near` them is
    /// the same point, and moves there: beside it, they would only take the place of another corner.
    fn with_closest(
        &self,
        candidates: &mut Candidates<V::Scalar>,
        answer: &SignedDistance<V>,
        heights: [V::Scalar; 2],
        near: V::Scalar,
    ) {
        let known_to = answer.upper - answer.lower + near * V::Scalar::EPSILON.sqrt();
        let deepest = answer.signed_distance + known_to;
        // NaN is as deep as anything.
        if candidates.iter().any(|candidate| !(candidate.gap() > deepest)) {
            return;
        }
        let is_near = |candidate: &&mut Candidate<V::Scalar>| dot(candidate.at, candidate.at) <= near * near;
        let at = (V::Scalar::ZERO, V::Scalar::ZERO);
        if let Some(candidate) = candidates.iter_mut().find(is_near) {
            (candidate.at, candidate.heights) = (at, heights);
            return;
        }
        let part = |outline: &Outline<V::Scalar>| match outline.corners.as_slice() {
            [corner] => ContactPart::Vertex(corner.id),
            [from, to] => ContactPart::Edge(from.id, to.id),
            _ => ContactPart::Face,
        };
        let parts = [part(&self.of_a), part(&self.of_b)];
        candidates.push(Candidate { at, heights, parts });
    }

    /// At most four of the candidates, in the plane two.
    fn reduced(&self, candidates: &[Candidate<V::Scalar>]) -> Points<V> {
        let most = if V::DIM == 2 { 2 } else { MAX_POINTS };
        reduced(candidates, most).iter().map(|candidate| self.point(candidate)).collect()
    }

    /// What a point is of both shapes: a corner of a feature that it is near to, or else what clipping says. Where corners of both lie
    /// on one another, as of boxes stacked, it would change from frame to frame which of them is within the other's outline.
    fn settled(&self, at: Across<V::Scalar>, parts: [ContactPart; 2], near: V::Scalar) -> [ContactPart; 2] {
        let corner = |outline: &Outline<V::Scalar>| {
            let is_near = |from: Across<V::Scalar>| {
                let e = (at.0 - from.0, at.1 - from.1);
                dot(e, e) <= near * near
            };
            outline.corners.iter().find(|corner| is_near(corner.at)).map(|corner| ContactPart::Vertex(corner.id))
        };
        match (corner(&self.of_a), corner(&self.of_b)) {
            (Some(vertex), _) => [vertex, ContactPart::Face],
            (None, Some(vertex)) => [ContactPart::Face, vertex],
            (None, None) => parts,
        }
    }

    fn point(&self, candidate: &Candidate<V::Scalar>) -> ContactPoint<V> {
        let [feature_a, feature_b] = candidate.parts.map(ContactPart::code);
        ContactPoint {
            point_a: self.plane.point(candidate.at, candidate.heights[0]),
            point_b: self.plane.point(candidate.at, candidate.heights[1]),
            signed_distance: candidate.gap(),
            feature_a,
            feature_b,
        }
    }
}

/// At most so many of the candidates: the deepest, the farthest from it, and those that make most area with the two on either side.
fn reduced<S: Scalar>(candidates: &[Candidate<S>], most: usize) -> SmallVec<[Candidate<S>; MAX_POINTS]> {
    if candidates.len() <= most {
        return SmallVec::from_slice(candidates);
    }
    let best = |value: &dyn Fn(&Candidate<S>) -> S| {
        candidates.iter().fold(&candidates[0], |best, c| if value(c) > value(best) { c } else { best })
    };
    let between = |a: &Candidate<S>, b: &Candidate<S>| (b.at.0 - a.at.0, b.at.1 - a.at.1);
    let first = best(&|c| -c.gap());
    let second = best(&|c| dot(between(first, c), between(first, c)));
    let side = |c: &Candidate<S>| cross(between(first, second), between(first, c));
    let (left, right) = (best(&side), best(&|c| -side(c)));
    let mut chosen = SmallVec::from_slice(&[*first, *second]);
    if side(left) > S::ZERO {
        chosen.push(*left);
    }
    if side(right) < S::ZERO {
        chosen.push(*right);
    }
    chosen
}
