//! The features of two bodies along a normal, and their curvatures there; and the normal right to rounding, by Newton's
//! method along the features near those of an answer.

use convex_support::{Core, CoreKind, Feature, Hint, Scalar, Vector};
use num_traits::Float as _;

use super::closest_features::{Bodies, ClosestFeatures, ClosestPoints, rounding};
use super::overlap::{Span, are_apart};
use crate::contact::{ContactPlane, Outline};
use crate::pair::Shape;
use crate::symmetric::{Across, Symmetric, axes_across, dot, turned_left};
use crate::unit::reciprocal_of_power;

/// The angle by which a direction is turned to find the curves between which an edge lies, and how a support point
/// moves, in units of the square root of ε.
const PROBE: f64 = 16.0;

/// How much a support point may differ from the prediction by its curvature, as a part of its predicted motion.
const SURPRISE: f64 = 0.25;

/// The curves at the ends of an edge are the same if their bends agree to this part of their sum.
const ALIKE: f64 = 1.0 / 64.0;

impl<V: Vector> Bodies<'_, V> {
    /// The features before the first are found.
    pub(super) fn unseen(&self) -> ClosestFeatures<V> {
        let zero = V::ZERO;
        ClosestFeatures {
            normal: zero,
            across: [zero; 2],
            points: [zero; 2],
            middle: zero,
            unit: self.unit,
            signed_distance: Scalar::ZERO,
            radii: self.cores.map(|core| core.radius / self.unit),
            hessians: [Symmetric::ZERO; 2],
            are_turning: [false; 2],
            is_foretold: true,
            outlines: [Outline::empty(), Outline::empty()],
            spans: [Span::Vertex; 2],
            tilt: Scalar::ZERO,
            is_tied: false,
            is_at_floor: false,
        }
    }

    /// Finds the features along the normal, which may be wrong by `tilt`. Outlines are large, and so filled in place
    /// rather than moved.
    pub(super) fn look(&self, features: &mut ClosestFeatures<V>, closest: ClosestPoints<V>, tilt: V::Scalar) {
        let ClosestPoints { normal, points, signed_distance, .. } = closest;
        let (unit, half) = (self.unit, V::Scalar::from_f64(0.5));
        // In the unit; zero is the middle of the closest points, which is on both sides of the plane of the outlines.
        let plane = ContactPlane { normal, across: axes_across(normal), origin: V::ZERO };
        let middle = points[0] * half + points[1] * half;
        (features.normal, features.across, features.points, features.middle) = (normal, plane.across, points, middle);
        (features.signed_distance, features.tilt) = (signed_distance / unit, tilt);
        let from = Viewpoint { tilt, middle, unit, plane };
        for (i, direction) in [-normal, normal].into_iter().enumerate() {
            let (shape, core, outline) = (self.shapes[i], &self.cores[i], &mut features.outlines[i]);
            draw(outline, shape, core, direction, &from);
            features.spans[i] = Span::of(outline);
            (features.hessians[i], features.are_turning[i]) = hessian(shape, core, direction, outline, &from);
        }
    }

    /// Whether the Hessians predict the support points nearby.
    pub(super) fn are_foretold(&self, at: &ClosestFeatures<V>) -> bool {
        (0..2).all(|i| is_foretold(self.shapes[i], &self.cores[i], [-at.normal, at.normal][i], at, i))
    }
}

/// The angle by which a direction is turned to test directions nearby.
fn turn<S: Scalar>(tilt: S) -> S {
    (S::EPSILON.sqrt() * S::from_f64(PROBE)).max(tilt * S::from_f64(4.0))
}

/// The frame in which outlines are drawn.
struct Viewpoint<V: Vector> {
    tilt: V::Scalar,
    middle: V,
    unit: V::Scalar,
    plane: ContactPlane<V>,
}

/// Draws the outline of a body's feature along a direction.
fn draw<V: Vector>(
    outline: &mut Outline<V::Scalar>,
    body: Shape<'_, V>,
    core: &Core<V>,
    direction: V,
    from: &Viewpoint<V>,
) {
    let per_unit = reciprocal_of_power(from.unit);
    let mut feature = Feature::new();
    body.core_support_feature(direction, from.tilt * core.extent * Scalar::from_f64(2.0), &mut feature);
    if feature.points().is_empty() {
        // If numbers are not finite.
        feature.push(body.core_support(direction, &mut Hint::new()), 0);
    }
    feature.map(|point| point * per_unit);
    outline.draw(&feature, (core.origin - from.middle) * per_unit, &from.plane);
}

/// The Hessian of the support value of a body across a direction, along which it has a feature; that of its radius
/// included. Also whether the feature is an edge that turns with the direction, as the side of a cone: the curves at
/// its ends differ.
fn hessian<V: Vector>(
    body: Shape<'_, V>,
    core: &Core<V>,
    direction: V,
    outline: &Outline<V::Scalar>,
    from: &Viewpoint<V>,
) -> (Symmetric<V::Scalar>, bool) {
    let per_unit = reciprocal_of_power(from.unit);
    let along = |direction| {
        let entries = body.core_support_hessian(direction, from.plane.across);
        Symmetric::of(entries.map(|entry| entry * per_unit)).plus(core.radius * per_unit)
    };
    let hessian = match Span::of(outline) {
        Span::Vertex => along(direction),
        Span::Edge(_) if V::DIM == 2 => Symmetric::ZERO,
        Span::Edge(e) if matches!(core.kind, CoreKind::Curved) => {
            let edge = from.plane.across[0] * e.0 + from.plane.across[1] * e.1;
            let turn = turn(from.tilt);
            // From the curves on either side, by two directions each.
            let [first, second] = [-turn, turn].map(|turn| {
                let [near, far] = [turn, turn + turn].map(|turn| along(direction + edge * turn));
                near.blend(far, -V::Scalar::ONE)
            });
            let [p, q] = [first, second].map(|curve| bend(curve, e));
            let is_turning = (p - q).abs() > (p + q) * Scalar::from_f64(ALIKE);
            return (across_edge(first.blend(second, share(outline, e)), e), is_turning);
        }
        Span::Edge(e) => across_edge(along(direction), e),
        Span::Face => Symmetric::ZERO,
    };
    (hessian, false)
}

/// How far along an edge the point of contact is, which is at zero, as a part of its length.
fn share<S: Scalar>(outline: &Outline<S>, e: Across<S>) -> S {
    let [from, to] = [&outline.corners[0], &outline.corners[outline.corners.len() - 1]].map(|corner| dot(corner.at, e));
    (-from / (to - from)).max(S::ZERO).min(S::ONE)
}

/// The part of a Hessian across a unit vector. Along the edge itself a support point is free.
fn across_edge<S: Scalar>(hessian: Symmetric<S>, e: Across<S>) -> Symmetric<S> {
    let (f, bend) = (turned_left(e), bend(hessian, e));
    Symmetric { a: bend * f.0 * f.0, b: bend * f.0 * f.1, d: bend * f.1 * f.1 }
}

/// The size of the part of a Hessian across a unit vector.
fn bend<S: Scalar>(hessian: Symmetric<S>, e: Across<S>) -> S {
    let f = turned_left(e);
    dot(f, hessian.times(f))
}

/// Whether the Hessian of a body predicts its support points along directions near that of the other one. It does not
/// if the shape does not return its curvature, or its faces.
fn is_foretold<V: Vector>(
    body: Shape<'_, V>,
    core: &Core<V>,
    direction: V,
    at: &ClosestFeatures<V>,
    index: usize,
) -> bool {
    if at.spans[index] != Span::Vertex {
        return true;
    }
    let (per_unit, turn) = (reciprocal_of_power(at.unit), turn(at.tilt));
    let hessian = at.hessians[index].plus(-core.radius * per_unit);
    let (mut hint, origin, from) =
        (Hint::new(), at.in_plane((core.origin - at.middle) * per_unit), at.outlines[index].corners[0].at);
    let rounding = V::Scalar::from_f64(64.0) * V::Scalar::EPSILON;
    let rows = [(hessian.a, hessian.b), (hessian.b, hessian.d)];
    at.across.into_iter().zip(rows).take(V::DIM - 1).all(|(change, row)| {
        [turn, -turn].into_iter().all(|turn| {
            let point = at.in_plane(body.core_support(direction + change * turn, &mut hint) * per_unit);
            let foretold = (row.0 * turn, row.1 * turn);
            let off = (point.0 + origin.0 - from.0 - foretold.0, point.1 + origin.1 - from.1 - foretold.1);
            let slack = dot(foretold, foretold).sqrt() * V::Scalar::from_f64(SURPRISE) + rounding;
            dot(off, off) <= slack * slack
        })
    })
}

/// The longest step of the unit normal that counts as refinement, and the most steps that are taken.
const LONGEST_STEP: f64 = 0.1;
const MAX_REFINEMENTS: usize = 5;

/// The number of rounds in which features that may hold the normal are tried, and the angle of each round as a part of
/// the last one's.
const ROUNDS: usize = 4;
const NEARER: f64 = 1.0 / 16.0;

impl<V: Vector> Bodies<'_, V> {
    /// Searches for a normal, within the angle `reach` of an answer's, along which the features overlap, as the closest
    /// points require. Returns whether there is one; features within the angle `tilt` count as held by rounding.
    ///
    /// Every feature found within `reach` is tried by making the normal exactly across it. If none fits, as when the
    /// answer is at an edge of a face within that angle, features within a smaller angle are tried.
    pub(super) fn settle(
        &self,
        features: &mut ClosestFeatures<V>,
        closest: ClosestPoints<V>,
        tilt: V::Scalar,
        reach: V::Scalar,
    ) -> bool {
        let mut within = reach;
        for _ in 0..ROUNDS {
            // NaN ends this too.
            if !(within > tilt) {
                break;
            }
            self.look(features, closest, within);
            if features.spans == [Span::Vertex; 2] {
                // They are vertices within `tilt` too.
                features.tilt = tilt;
                return self.refine(features, closest);
            }
            if self.hold(features, closest, reach) && self.refine(features, closest) {
                return true;
            }
            within *= Scalar::from_f64(NEARER);
        }
        false
    }

    /// Turns the normal to be exactly across the features found. Returns whether there is such a normal along which the
    /// features overlap.
    fn hold(&self, seen: &mut ClosestFeatures<V>, closest: ClosestPoints<V>, reach: V::Scalar) -> bool {
        let radii = self.cores.map(|core| core.radius);
        // Whether the features along another normal overlap, and are of these kinds if given.
        let is_kept = |seen: &mut ClosestFeatures<V>, normal: V, tilt, kinds: [Option<usize>; 2]| {
            let Some(normal) = normal.unit() else { return false };
            if !((normal - closest.normal).length() <= reach + reach) {
                return false;
            }
            self.look(seen, ClosestPoints { normal, ..closest }, tilt);
            seen.spans.iter().zip(kinds).all(|(span, kind)| kind.is_none_or(|kind| span.kind() == kind))
                && !are_apart(&seen.outlines, seen.slack() + tilt)
        };
        for _ in 0..MAX_REFINEMENTS {
            let kinds = seen.spans.map(Span::kind);
            let Some(step) = seen.newton_step(radii) else {
                // A face determines the normal, and each of two parallel edges a part of it.
                let normals = [0, 1].map(|i| {
                    let turn = seen.spans[i].turn(&seen.outlines[i]);
                    seen.normal + seen.out_of_plane(turn)
                });
                let most = kinds[0].max(kinds[1]);
                return (kinds[0] == most && is_kept(seen, normals[0], rounding(), [Some(most), None]))
                    || (kinds[1] == most && is_kept(seen, normals[1], rounding(), [None, Some(most)]));
            };
            // A step of Newton's method leaves the square of the error that it removes.
            let left = step.turn.length() * step.turn.length();
            if !is_kept(seen, seen.normal + step.turn, rounding::<V::Scalar>() + left, kinds.map(Some)) {
                return false;
            }
            if left <= rounding() {
                return true;
            }
        }
        false
    }

    /// Takes steps of Newton's method for the normal and the points, as long as they become shorter. Returns whether
    /// they lead to points that are opposite to each other, along the same features.
    pub(super) fn refine(&self, best: &mut ClosestFeatures<V>, closest: ClosestPoints<V>) -> bool {
        let mut length = V::Scalar::from_f64(LONGEST_STEP);
        let radii = self.cores.map(|core| core.radius);
        for _ in 0..MAX_REFINEMENTS {
            let Some(step) = best.newton_step(radii) else { break };
            let size = step.turn.length();
            // NaN ends this too.
            if !(size < length) {
                break;
            }
            let shifts = [0, 1].map(|i| (step.points[i] - best.points[i]).length());
            best.points = step.points;
            // The distance of the search is right to its tolerance only. If the step changes it by no more than
            // rounding, it is right already.
            let error = (step.signed_distance - best.signed_distance).abs();
            if error > rounding() {
                best.signed_distance = step.signed_distance;
            }
            if size > length * Scalar::from_f64(0.5) {
                break;
            }
            let Some(normal) = (best.normal + step.turn).unit() else { return false };
            if size <= rounding() && shifts[0].max(shifts[1]) <= self.unit * rounding() {
                // The features along this normal are those found before, to rounding, and in the same coordinates:
                // another basis may be a quarter turn away if two coordinates of the normal are equal.
                best.normal = normal;
                break;
            }
            let signed_distance = best.signed_distance * self.unit;
            let kinds = best.spans.map(Span::kind);
            self.look(best, ClosestPoints { normal, points: step.points, signed_distance, ..closest }, rounding());
            if best.spans.map(Span::kind) != kinds {
                return false;
            }
            length = size;
        }
        let slack = best.slack();
        best.off() <= slack && !are_apart(&best.outlines, slack)
    }
}
