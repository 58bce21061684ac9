//! What two bodies show each other along a normal, and how they curve there.

use convex_support::{Core, CoreKind, Feature, Hint, Scalar, Vector};
use num_traits::Float as _;

use super::closest_features::{Bodies, ClosestFeatures, ClosestPoints};
use super::span::Span;
use crate::contact::{ContactPlane, Outline};
use crate::shape::Shape;
use crate::symmetric::{Across, Symmetric, axes_across, dot, turned_left};
use crate::unit::reciprocal_of_power;

/// How far a direction is turned to see which curve an edge between two of them belongs to, and where a support point
/// goes, in units of the square root of ε.
const TURN: f64 = 16.0;

/// By how much a support point may differ from where its curvature predicts it, as a part of how far that moves.
const SURPRISE: f64 = 0.25;

/// The curves at the ends of an edge are the same if they bend alike to this part of their sum.
const ALIKE: f64 = 1.0 / 64.0;

impl<V: Vector> Bodies<'_, V> {
    /// Before anything was looked at.
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

    /// Sees the features along the normal, which may be wrong by `tilt`. Outlines are long: features are seen where
    /// they stay, not moved there.
    pub(super) fn look(&self, features: &mut ClosestFeatures<V>, closest: ClosestPoints<V>, tilt: V::Scalar) {
        let ClosestPoints { normal, points, signed_distance, .. } = closest;
        let (unit, half) = (self.unit, V::Scalar::from_f64(0.5));
        // In the unit; zero is the middle of the closest points, which is on both sides of the plane that outlines are
        // seen in.
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

    /// Whether the support points nearby are where the Hessians say.
    pub(super) fn are_foretold(&self, at: &ClosestFeatures<V>) -> bool {
        (0..2).all(|i| is_foretold(self.shapes[i], &self.cores[i], [-at.normal, at.normal][i], at, i))
    }
}

/// How far a direction is turned to look nearby.
fn turn<S: Scalar>(tilt: S) -> S {
    (S::EPSILON.sqrt() * S::from_f64(TURN)).max(tilt * S::from_f64(4.0))
}

/// From where the bodies are seen.
struct Viewpoint<V: Vector> {
    tilt: V::Scalar,
    middle: V,
    unit: V::Scalar,
    plane: ContactPlane<V>,
}

/// Draws the outline of what a body shows along a direction.
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
        // Where numbers are not finite.
        feature.push(body.core_support(direction, &mut Hint::new()), 0);
    }
    feature.map(|point| point * per_unit);
    outline.draw(&feature, (core.origin - from.middle) * per_unit, &from.plane);
}

/// The Hessian of the support value of a body across a direction, along which it shows a feature; that of its radius
/// included. And whether the feature is an edge that turns with the direction, as the side of a cone: the curves at its
/// ends are not the same.
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
            // Of the curves on either side, from two directions each.
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

/// How far along an edge the point of contact is, which is at zero: as a part of its length.
fn share<S: Scalar>(outline: &Outline<S>, e: Across<S>) -> S {
    let [from, to] = [&outline.corners[0], &outline.corners[outline.corners.len() - 1]].map(|corner| dot(corner.at, e));
    (-from / (to - from)).max(S::ZERO).min(S::ONE)
}

/// What of a Hessian is across a unit vector. Along the edge itself a support point is free.
fn across_edge<S: Scalar>(hessian: Symmetric<S>, e: Across<S>) -> Symmetric<S> {
    let (f, bend) = (turned_left(e), bend(hessian, e));
    Symmetric { a: bend * f.0 * f.0, b: bend * f.0 * f.1, d: bend * f.1 * f.1 }
}

/// How much of a Hessian is across a unit vector.
fn bend<S: Scalar>(hessian: Symmetric<S>, e: Across<S>) -> S {
    let f = turned_left(e);
    dot(f, hessian.times(f))
}

/// Whether the support points of a body along directions near that of the other are where its Hessian says. They are
/// not where a shape does not say how it curves, or which face it shows.
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
