//! Whether an answer changes smoothly.

use convex_support::numerics::elementary::hypot;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::ClosestFeatures;
use super::overlap::separating;
use super::span::{DifferenceSpan, Span};
use crate::symmetric::{Across, Symmetric, dot};

/// Whether an answer is differentiable by the poses of both bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Smoothness {
    /// The normal and the closest points are the only ones. They change continuously, and the gradient is the
    /// derivative.
    Smooth,
    /// There are several normals or pairs of closest points: between parallel faces or edges, where a vertex touches a
    /// vertex, or where two ways out are equally short. Or the answer is at its floor: a distance, a time or a λ of
    /// zero falls no further as the bodies come nearer. The gradient is one of several one-sided derivatives.
    Edge,
}

impl<V: Vector> ClosestFeatures<V> {
    /// Whether the answer that the features were found from changes smoothly with the poses of both bodies: its first
    /// derivatives are continuous, and its second ones exist where [they do not jump](Self::is_hessian_unique). If
    /// features are parallel to within the error of the normal, or the answer is zero to within its own error, this is
    /// [`Edge`](Smoothness::Edge), since rounding leaves it open.
    ///
    /// A [`Distance`](crate::Distance) of bodies that touch, and the time of a hit at the very start, are at their
    /// floor and not smooth. The [`SignedDistance`](crate::SignedDistance) of the same bodies has no floor.
    #[must_use]
    pub fn smoothness(&self) -> Smoothness {
        let is_smooth = self.is_normal_unique() && self.are_points_unique() && !self.is_at_floor;
        if is_smooth { Smoothness::Smooth } else { Smoothness::Edge }
    }

    /// Whether the second derivatives of the signed distance do not jump here. They do where the closest point leaves
    /// an edge or a face, as of a ball that is exactly above the border of a face: over the face the distance has no
    /// curvature, and beyond its border it is that from an edge. If a point is within the error of a border, rounding
    /// leaves it open, and the answer is no.
    ///
    /// The gradient changes continuously all the same. The [Hessian](Self::hessian) is one of those on either side.
    #[must_use]
    pub fn is_hessian_unique(&self) -> bool {
        self.are_points_unique() && separating(&self.outlines, self.slack()).is_empty()
    }

    /// Whether there is only one pair of closest points. There are more where a face is parallel to a face or an edge,
    /// or an edge to an edge.
    #[must_use]
    pub fn are_points_unique(&self) -> bool {
        self.joint().is_some()
    }

    /// Whether there is only one normal. Then the answer is differentiable at least by translations. This is so
    /// wherever the bodies are apart; it is not where a vertex touches a vertex or an edge, or where several ways out
    /// are equally short.
    #[must_use]
    pub fn is_normal_unique(&self) -> bool {
        let stiffness = self.stiffness();
        let least = V::Scalar::EPSILON * V::Scalar::from_f64(64.0);
        let is_stiff = |e| dot(e, stiffness.times(e)) > least;
        let is_held = match self.free() {
            Free::Nothing => true,
            Free::Along(e) => is_stiff(e),
            Free::All if V::DIM == 2 => stiffness.a > least,
            Free::All => least_eigenvalue(stiffness) > least,
        };
        let corners = self.outlines.iter().flat_map(|outline| &outline.corners);
        let is_finite = self.points.iter().all(|p| p.is_finite()) && corners.into_iter().all(|c| c.height.is_finite());
        is_held && is_finite && !self.is_at_a_corner(least) && !self.is_tied
    }

    /// Whether cores that touch do so at the boundary of their features, as a box that stands beside another: so that
    /// the normal may turn away from them. Bodies apart have the normal of their closest points, and those that overlap
    /// that of the way out.
    fn is_at_a_corner(&self, least: V::Scalar) -> bool {
        let gap = self.signed_distance + self.radii[0] + self.radii[1];
        let stiffness = self.stiffness();
        let is_soft = |&e: &Across<V::Scalar>| !(dot(e, stiffness.times(e)) > least);
        gap.abs() <= least && separating(&self.outlines, self.slack()).iter().any(is_soft)
    }

    /// In which directions the normal could turn without leaving an edge or a face of either body.
    fn free(&self) -> Free<V::Scalar> {
        let across = |(x, y): (V::Scalar, V::Scalar)| if V::DIM == 2 { Free::Nothing } else { Free::Along((-y, x)) };
        match (self.joint(), self.spans) {
            (Some(DifferenceSpan::None), _) => Free::All,
            (Some(DifferenceSpan::Edge(_, e)), _) => across(e),
            (Some(DifferenceSpan::Face(_) | DifferenceSpan::Crossed(_)), _) => Free::Nothing,
            // Parallel edges.
            (None, [Span::Edge(e), Span::Edge(_)]) => across(e),
            (None, _) => Free::Nothing,
        }
    }
}

/// Directions across the normal.
enum Free<S> {
    Nothing,
    Along((S, S)),
    All,
}

/// The least eigenvalue, without a sum of squares.
fn least_eigenvalue<S: Scalar>(matrix: Symmetric<S>) -> S {
    let half = S::from_f64(0.5);
    let (mean, difference) = ((matrix.a + matrix.d) * half, (matrix.a - matrix.d) * half);
    let greatest = mean + hypot(difference, matrix.b);
    // The product of both is the determinant.
    if greatest > S::ZERO { matrix.determinant() / greatest } else { mean - hypot(difference, matrix.b) }
}
