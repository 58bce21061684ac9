//! What the search about two bodies at rest answers, and the options of the signed distance.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Status;
use crate::options::options;

/// The answer of [`distance`](crate::distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distance<V: Vector> {
    /// The distance of the two shapes; 0 where they overlap. If they touch, so that the measured distance is smaller
    /// than its own error, it is the measured distance.
    pub distance: V::Scalar,
    /// The distance is certainly not less: a plane separates the shapes by this much.
    pub lower: V::Scalar,
    /// The distance is certainly not more: two points of the shapes are this far apart.
    pub upper: V::Scalar,
    /// Whether the shapes have a point in common. Shapes touch, and count as overlapping, if no plane certainly
    /// separates them and their closest points are no farther apart than the error of these points.
    pub overlap: bool,
    /// The point of `a` closest to `b`, in the world; where the shapes overlap, a point in both, but for rounding.
    pub point_a: V,
    /// The point of `b` closest to `a`, in the world; where the shapes overlap, a point in both, but for rounding.
    pub point_b: V,
    /// The unit vector from `b` to `a`, across which a plane separates the shapes by [`lower`](Self::lower). It is also
    /// given where the shapes touch, if a plane across it separates them but for the width of a converged bracket; and
    /// is `None` otherwise.
    ///
    /// It is the normal of the plane, and not the direction of `point_a − point_b`, which has fewer digits near
    /// contact. `point_a − point_b` is the distance times the normal, to within √(2·`upper`·(`upper` − `lower`))
    /// plus 64ε of the sizes of both shapes and their offset.
    pub normal: Option<V>,
    /// How the iteration ended. The bracket of a converged answer is no wider than 24ε of both extents, both radii and
    /// the offset of the origins, plus three times the [errors](convex_support::Core::error) of both shapes, and the
    /// [tolerance](crate::DistanceOptions::tolerance) times `lower`; unless `lower` is beyond the
    /// [limit](crate::DistanceOptions::limit).
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> Distance<V> {
    /// The answer for the shapes in the other order: from `b` to `a`.
    #[inline(always)]
    pub fn reversed(self) -> Self {
        Self { point_a: self.point_b, point_b: self.point_a, normal: self.normal.map(|n| -n), ..self }
    }
}

/// The answer of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SignedDistance<V: Vector> {
    /// The distance where the shapes are apart. Where they overlap, minus the penetration depth, which is the length of
    /// the shortest translation of `a` after which they have no interior point in common.
    pub signed_distance: V::Scalar,
    /// The signed distance is certainly not less: this is proved by planes across [`normal`](Self::normal). Minus
    /// infinity where a support map returned numbers that are not finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// The signed distance is certainly not more: two points of the shapes are this far apart, or, in overlap, the
    /// difference `A − B` contains the ball of radius `−upper` about zero. Infinity if a support map returned numbers
    /// that are not finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// The unit vector from `b` to `a`. If `a` is moved along it by the depth, the shapes no longer overlap. Where
    /// several ways out are equally short, it is the direction of one of them.
    pub normal: V,
    /// The point of `a` closest to `b`, or deepest in it. It is in `a` but for rounding, 8ε of the sizes of both shapes
    /// and their offset plus the error of its core, however the search ended. Uncertainty of the way out is in the
    /// bounds.
    pub point_a: V,
    /// The point of `b` such that `point_a − point_b` is the signed distance times the normal, with the same accuracy.
    /// The normal is that of a plane, across which points of curved shapes may be off by √(2·s·(`upper` − `lower`)),
    /// with `s` the sum of both sizes and the offset.
    pub point_b: V,
    /// Whether the shapes have a point in common, touching included: whether `signed_distance` is not positive. It is
    /// certain where `lower` and `upper` have the same sign.
    pub overlap: bool,
    /// How the search ended. The bounds hold in every case.
    ///
    /// [`Converged`](Status::Converged) promises that `upper − lower` is at most `6e`, with `e` = 8ε`s` plus the
    /// [errors](convex_support::Core::error) of both cores, and `s` the sum of both sizes and the offset. Where curved
    /// shapes may overlap, so that `lower` is not positive, it is at most `6e` plus the
    /// [tolerance](crate::SignedDistanceOptions::tolerance) times `s`. Or the signed distance is certainly beyond a
    /// limit of the options.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
    /// The number of facets of the last polytope that did not have to be expanded, since no way out through them is
    /// shorter. 0 if no polytope was needed.
    pub unexpanded: usize,
}

impl<V: Vector> SignedDistance<V> {
    /// The answer for the shapes in the other order: from `b` to `a`.
    pub fn reversed(self) -> Self {
        Self { normal: -self.normal, point_a: self.point_b, point_b: self.point_a, ..self }
    }
}

/// Support points after which a signed distance gives up. Polytopes need some dozens, smooth shapes about a hundred.
/// The cap bounds the time for ties, such as an ellipsoid of revolution within another about the same axis.
pub(crate) const MAX_DEPTH_ITERATIONS: usize = 500;

/// Options of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SignedDistanceOptions<V: Vector> {
    /// The width of the bracket at which to stop in overlap, relative to the sizes of the shapes and their distance. It
    /// concerns curved shapes; for polytopes the facet that decides is found exactly. Default: 1e-9 in `f64`, 8ε in
    /// `f32`.
    pub tolerance: V::Scalar,
    /// Stop as soon as the shapes are certain to be farther apart than this. NaN is no limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub limit: V::Scalar,
    /// Stop as soon as the depth is certain to exceed this. NaN is no limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub depth_limit: V::Scalar,
    /// The support points of each shape after which to give up. If the depth is not known exactly by then, the closest
    /// points of both shapes may take a sixteenth more. Default: 500.
    pub max_iterations: usize,
    /// A first guess of the direction from `b` to `a`, such as the normal of the last answer. Default: none.
    pub axis: Option<V>,
}

impl<V: Vector> Default for SignedDistanceOptions<V> {
    fn default() -> Self {
        let least = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        Self {
            tolerance: V::Scalar::from_f64(1e-9).max(least),
            limit: V::Scalar::infinity(),
            depth_limit: V::Scalar::infinity(),
            max_iterations: MAX_DEPTH_ITERATIONS,
            axis: None,
        }
    }
}

options! {
    SignedDistanceOptions: with_tolerance(tolerance: V::Scalar), with_limit(limit: V::Scalar),
    with_depth_limit(depth_limit: V::Scalar), with_max_iterations(max_iterations: usize),
    with_axis(axis: V => axis = Some(axis))
}
