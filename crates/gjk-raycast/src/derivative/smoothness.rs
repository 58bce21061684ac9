//! Whether an answer changes smoothly, and its one-sided derivatives if it does not.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::ClosestFeatures;
use super::gradient::start_of;
use super::overlap::{DifferenceSpan, Span, least_over_overlap, separating};
use crate::symmetric::{Across, dot, turned_left};
use crate::{RigidMotion, Trajectory};

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
    /// Whether the answer that gave the features changes smoothly with the poses of both bodies: its first derivatives
    /// are continuous, and its second ones exist unless [they jump](Self::is_hessian_unique). If features are parallel
    /// to within the error of the normal, or the answer is zero to within its own error, this is
    /// [`Edge`](Smoothness::Edge), since rounding leaves it undecided.
    ///
    /// A [`Distance`](crate::Distance) of bodies that touch, and the time of a hit at the very start, are at their
    /// floor and not smooth. The [`SignedDistance`](crate::SignedDistance) of the same bodies has no floor.
    #[must_use]
    pub fn smoothness(&self) -> Smoothness {
        let is_smooth = self.is_normal_unique() && self.are_points_unique() && !self.is_at_floor;
        if is_smooth { Smoothness::Smooth } else { Smoothness::Edge }
    }

    /// Whether the second derivatives of the signed distance do not jump here. They jump where the closest point leaves
    /// an edge or a face, as for a ball exactly above the border of a face: over the face the distance has no
    /// curvature, and beyond its border it has that of the distance from an edge. If a point is within the error of a
    /// border, rounding leaves this undecided, and the answer is `false`.
    ///
    /// The gradient is continuous all the same. The [Hessian](Self::hessian) is one of those on either side.
    #[must_use]
    pub fn is_hessian_unique(&self) -> bool {
        self.are_points_unique() && separating(&self.outlines, self.slack()).is_empty()
    }

    /// Whether there is only one pair of closest points. There are more if a face is parallel to a face or an edge, or
    /// an edge to an edge.
    #[must_use]
    pub fn are_points_unique(&self) -> bool {
        self.joint().is_some()
    }

    /// Whether there is only one normal. Then the answer is differentiable at least by translations. This is so
    /// wherever the bodies are apart. It is not so if a vertex touches a vertex or an edge, or several ways out are
    /// equally short.
    #[must_use]
    pub fn is_normal_unique(&self) -> bool {
        let stiffness = self.stiffness();
        let least = V::Scalar::EPSILON * V::Scalar::from_f64(64.0);
        let is_stiff = |e| dot(e, stiffness.times(e)) > least;
        // The directions in which the normal could turn without leaving an edge or a face of either body.
        let is_held = match (self.joint(), self.spans) {
            (Some(DifferenceSpan::None), _) if V::DIM == 2 => stiffness.a > least,
            (Some(DifferenceSpan::None), _) => stiffness.least_eigenvalue() > least,
            // Across an edge, or parallel edges.
            (Some(DifferenceSpan::Edge(_, e)), _) | (None, [Span::Edge(e), Span::Edge(_)]) => {
                V::DIM == 2 || is_stiff(turned_left(e))
            }
            _ => true,
        };
        let corners = self.outlines.iter().flat_map(|outline| &outline.corners);
        let is_finite = self.points.iter().all(|p| p.is_finite()) && corners.into_iter().all(|c| c.height.is_finite());
        is_held && is_finite && !self.is_at_a_corner(least) && !self.is_tied
    }

    /// Whether cores that touch do so at the boundary of their features, as a box that stands beside another, so that
    /// the normal may turn away from them. Bodies apart have the normal of their closest points, and bodies that
    /// overlap that of the direction out.
    fn is_at_a_corner(&self, least: V::Scalar) -> bool {
        let gap = self.signed_distance + self.radii[0] + self.radii[1];
        let stiffness = self.stiffness();
        let is_soft = |&e: &Across<V::Scalar>| !(dot(e, stiffness.times(e)) > least);
        gap.abs() <= least && separating(&self.outlines, self.slack()).iter().any(is_soft)
    }

    /// The speed at which the signed distance changes as the bodies begin to move: its one-sided derivative. It is
    /// exact also if faces or edges are parallel. `None` if the normal is [not the only one](Self::is_normal_unique).
    ///
    /// The signed distance falls as fast as the closest points that come nearer fastest. With `M` the overlap of both
    /// features in the plane across the normal `n` (Danskin, *The theory of max-min, with applications*, 1966),
    ///
    /// > ds/dt = min { n·(v_A(p) − v_B(p)) : p ∈ M },
    ///
    /// and since velocities are linear in `p`, the least is at a corner of `M`. In overlap the signed distance is the
    /// maximum over all normals of a minimum over points; by the duality of linear programs its derivative is the same
    /// minimum. Discs are exact, not polygons. If a face is known only [in part](Self::are_complete), corners that are
    /// left out may come nearer faster: the answer is then an upper bound.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::DVec2};
    /// use gjk_raycast::{RigidMotion, SignedDistanceOptions, Smoothness, signed_distance};
    ///
    /// // A box of width 2 lies 1 above a longer one, parallel to it.
    /// let a = Posed::translated(Cuboid::new(DVec2::ONE)?, DVec2::new(0.0, 3.0))?;
    /// let b = Cuboid::new(DVec2::new(5.0, 1.0))?;
    /// let answer = signed_distance(&a, &b, SignedDistanceOptions::default());
    /// let features = answer.closest_features(&a, &b);
    /// assert_eq!(features.smoothness(), Smoothness::Edge);
    /// // However it begins to turn, one of its corners comes nearer.
    /// for turn in [1.0, -1.0] {
    ///     let turning = RigidMotion::rotation(turn, DVec2::new(0.0, 3.0));
    ///     assert_eq!(features.rate(turning, RigidMotion::default()), Some(-1.0));
    /// }
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn rate(&self, motion_a: RigidMotion<V>, motion_b: RigidMotion<V>) -> Option<V::Scalar> {
        if !self.is_normal_unique() {
            return None;
        }
        let zero = V::Scalar::ZERO;
        Some(self.least(|p| self.normal.dot(motion_a.velocity(zero, p) - motion_b.velocity(zero, p))))
    }

    /// The one-sided derivative of the time of contact by a motion of the start poses, for bodies that touch at a time
    /// while they move: `min −n·(δa − δb)/(n·w)` over the overlap of both features.
    pub(super) fn delay(
        &self,
        time: V::Scalar,
        motions: [&dyn Trajectory<Vector = V>; 2],
        changes: [RigidMotion<V>; 2],
    ) -> Option<V::Scalar> {
        if !self.is_normal_unique() {
            return None;
        }
        let displacements = motions.map(|motion| motion.displacement(time));
        let change = |i: usize, p| {
            displacements[i].rotation() * changes[i].velocity(V::Scalar::ZERO, start_of(&displacements[i], p))
        };
        let closing = |p| -self.normal.dot(motions[0].velocity(time, p) - motions[1].velocity(time, p));
        let is_closing = self.least(closing) > V::Scalar::ZERO;
        is_closing.then(|| self.least(|p| self.normal.dot(change(0, p) - change(1, p)) / closing(p)))
    }

    /// The least value over the overlap of both features, in the plane half-way between them, in the world. The value
    /// is linear in the point, or a quotient of such.
    fn least(&self, value: impl Fn(V) -> V::Scalar) -> V::Scalar {
        if self.are_points_unique() {
            let half = V::Scalar::from_f64(0.5);
            return value(self.points[0] * half + self.points[1] * half);
        }
        let place = |at| self.middle + self.out_of_plane(at) * self.unit;
        let least = least_over_overlap(&self.outlines, self.slack(), |at| value(place(at)));
        least.unwrap_or_else(|| value(self.middle))
    }
}
