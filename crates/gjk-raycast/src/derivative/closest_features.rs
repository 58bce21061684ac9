//! The features of two bodies that face each other where they are closest.

use convex_support::{Core, CoreKind, Scalar, Vector};
use num_traits::Float as _;

use super::overlap::{DifferenceSpan, Span};
use crate::contact::Outline;
use crate::pair::Shape;
use crate::symmetric::Symmetric;
use crate::unit::power_of_two_near;

/// The error of the normal, in units of the rounding of the points that it is computed from.
const NORMAL_ERROR: f64 = 64.0;

/// The largest error of a normal, as an angle, that is allowed for; with a larger one, features that visibly lean would
/// count as parallel. It is also the largest angle within which features that may hold the normal are tried.
const LARGEST_TILT: f64 = 1e-3;
const LARGEST_REACH: f64 = 0.03;

/// The features of two bodies at their closest or deepest points: a vertex, an edge or a face of each, with its
/// curvature.
///
/// They tell whether an answer changes [smoothly](Self::smoothness) with the poses of the bodies. If it does, they
/// have the [velocities of the normal and the points](Self::velocities) and the [second derivatives](Self::hessian);
/// if not, they still have [one-sided derivatives](Self::rate).
/// [`SignedDistance::closest_features`](crate::SignedDistance::closest_features) and the same methods of other
/// answers find them, given the shapes of the query.
///
/// Faces and edges are found by
/// [`SupportMap::core_support_feature`](convex_support::SupportMap::core_support_feature). A shape that does not
/// implement it, such as a sum or a hull, counts as smooth. If a face has more than 16 corners, only every second,
/// third, … is [known](Self::are_complete).
#[derive(Clone, Debug)]
#[must_use]
pub struct ClosestFeatures<V: Vector> {
    /// The unit vector from `b` to `a`, and two across it; in 2D one, and zero.
    pub(super) normal: V,
    pub(super) across: [V; 2],
    pub(super) points: [V; 2],
    /// A point between them.
    pub(super) middle: V,
    /// Lengths below are in this unit, a power of two near the size of both bodies and their distance.
    pub(super) unit: V::Scalar,
    pub(super) signed_distance: V::Scalar,
    pub(super) radii: [V::Scalar; 2],
    /// The Hessians of both support values, radii included, across the normal. Zero along an edge, and on a face.
    pub(super) hessians: [Symmetric<V::Scalar>; 2],
    /// Whether the feature of a body is an edge that turns with the normal, like the side of a cone.
    pub(super) are_turning: [bool; 2],
    /// Whether the Hessians predict the support points nearby.
    pub(super) is_foretold: bool,
    /// The features, relative to that point.
    pub(super) outlines: [Outline<V::Scalar>; 2],
    pub(super) spans: [Span<V::Scalar>; 2],
    /// A bound on the error of the normal.
    pub(super) tilt: V::Scalar,
    /// Whether another direction out of the overlap is as short.
    pub(super) is_tied: bool,
    /// Whether the answer is zero, to its error, and cannot fall.
    pub(super) is_at_floor: bool,
}

/// Two bodies, and the unit of length.
pub(super) struct Bodies<'s, V: Vector> {
    pub(super) shapes: [Shape<'s, V>; 2],
    pub(super) cores: [Core<V>; 2],
    pub(super) unit: V::Scalar,
}

/// The closest points of two bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosestPoints<V: Vector> {
    pub(super) normal: V,
    pub(super) points: [V; 2],
    pub(super) signed_distance: V::Scalar,
    /// A bound on the error of the signed distance.
    pub(super) error: V::Scalar,
    /// Whether the normal belongs to slightly different poses, as that of a hit to a time near it.
    pub(super) is_near: bool,
}

impl<V: Vector> ClosestFeatures<V> {
    /// The features at the normal and the points of an answer. For curved shapes these are known only to about half
    /// their digits, since the distance is stationary in them; Newton's method finds the rest.
    pub(super) fn new(shapes: [Shape<'_, V>; 2], closest: ClosestPoints<V>) -> Self {
        let cores = shapes.map(|shape| shape.core());
        let size = cores.iter().fold(V::Scalar::ZERO, |sum, core| sum + core.size());
        let gap = closest.signed_distance + cores[0].radius + cores[1].radius;
        let bodies = Bodies { shapes, cores, unit: power_of_two_near(size + closest.signed_distance.abs()) };
        let tilt = tilt(size, gap, closest.error);
        // The normal of polytopes that are apart is that of their closest points, and if they overlap it is that of a
        // face: both are right to rounding. If they touch, or the search ended early, it is only as accurate as the
        // search left it.
        let is_curved = cores.iter().any(|core| matches!(core.kind, CoreKind::Curved));
        // NaN is not near.
        let least = size * rounding();
        let is_searched = closest.is_near || gap.abs() <= least || closest.error > least;
        let mut features = bodies.unseen();
        let seen = &mut features;
        let refine = |seen: &mut Self| {
            bodies.look(seen, closest, tilt);
            bodies.refine(seen, closest)
        };
        let settle = |seen: &mut Self| bodies.settle(seen, closest, tilt, reach(size, gap, closest.error));
        let is_found = if is_curved {
            settle(seen) || refine(seen)
        } else {
            // The features along a normal that is right to rounding meet the condition of the closest points; those
            // along another normal do not.
            is_searched && (refine(seen) || settle(seen))
        };
        if !is_found {
            bodies.look(seen, closest, tilt);
        }
        features.is_foretold = bodies.are_foretold(&features);
        features
    }

    /// The directions in which the features extend together, if the closest points are the only ones.
    pub(super) fn joint(&self) -> Option<DifferenceSpan<V::Scalar>> {
        let least = self.tilt * V::Scalar::from_f64(4.0);
        // The side of a cone turns with the normal. If it is parallel to an edge, both put the same condition on the
        // normal, which any normal meets that is off by the root of their error.
        let parallel = if self.are_turning == [false; 2] { least } else { least.sqrt() };
        let joint = DifferenceSpan::of(self.spans, parallel);
        // In the plane an edge is the whole line across the normal.
        joint.filter(|joint| V::DIM == 3 || !matches!(joint, DifferenceSpan::Crossed(_)))
    }

    /// The stiffness of the normal: the sum of the Hessians and the signed distance.
    pub(super) fn stiffness(&self) -> Symmetric<V::Scalar> {
        let [a, b] = self.hessians;
        Symmetric { a: a.a + b.a, b: a.b + b.b, d: a.d + b.d }.plus(self.signed_distance)
    }

    /// A bound on the error of the corners of features, in the unit: the rounding of coordinates in the world and of
    /// the sizes of both bodies, and how far the features of curved bodies move as the normal turns by its error.
    pub(super) fn slack(&self) -> V::Scalar {
        let world = self.middle.abs().max_element() / self.unit;
        let rounding = rounding::<V::Scalar>() * (world + V::Scalar::from_f64(2.0));
        let [a, b] = self.hessians.map(|hessian| hessian.a + hessian.d);
        rounding + self.tilt * (a + b)
    }

    /// Whether the features are known as a whole. They are not if a shape shows only a part of a face, as for a face
    /// with more than 16 corners; then one-sided [rates](Self::rate) take only the points of this part into account.
    #[must_use]
    pub fn are_complete(&self) -> bool {
        self.outlines.iter().all(|outline| outline.is_complete)
    }

    /// The unit normal from `b` to `a`, to rounding.
    #[must_use]
    pub fn normal(&self) -> V {
        self.normal
    }

    /// The closest point of `a`, to rounding; if there are several, the one of the answer.
    #[must_use]
    pub fn point_a(&self) -> V {
        self.points[0]
    }

    /// The closest point of `b`.
    #[must_use]
    pub fn point_b(&self) -> V {
        self.points[1]
    }
}

/// The error of a normal that is known to rounding.
pub(super) fn rounding<S: Scalar>() -> S {
    S::EPSILON * S::from_f64(NORMAL_ERROR)
}

/// The error of the normal, as an angle: the rounding of its points divided by the gap between the cores, and the error
/// of the distance divided by the size of the bodies.
fn tilt<S: Scalar>(size: S, gap: S, error: S) -> S {
    let magnified = if gap > S::ZERO { rounding::<S>() * (size / gap) } else { S::ZERO };
    let open = if error.is_finite() { error / size * S::from_f64(4.0) } else { S::ZERO };
    (rounding::<S>() + magnified + open).min(S::from_f64(LARGEST_TILT))
}

/// The error of the normal between curved bodies, as an angle. Let `v` be the shortest vector between two cores that
/// are `g` apart, and `w` any other one that a bracket `u ≥ g ≥ l` allows. Since `w·v ≥ g²`, the two differ by at most
/// `√(u² − l²)`, so that the angle between them is up to `√(2(u − l)/g)`. If the cores overlap, the signed distance
/// along a normal also falls with the square of its angle, times a stiffness, for which a part of the size is taken.
fn reach<S: Scalar>(size: S, gap: S, error: S) -> S {
    let error = error.max(S::EPSILON * size * S::from_f64(4.0));
    let over = if gap > S::ZERO { gap } else { size * S::from_f64(1.0 / 16.0) };
    (error / over * S::from_f64(2.0)).sqrt().min(S::from_f64(LARGEST_REACH))
}
