//! The velocities of the closest points and the normal as the bodies move.
//!
//! At the closest points `a` and `b` the bodies support a plane across the normal `n`, and `a − b = s·n`. This stays
//! so as they move. With `v_A` and `v_B` the velocities of the material points there, `H_A` and `H_B` the Hessians of
//! the support values along `∓n`, and `ω_A`, `ω_B` the turns, a support point moves with its body, and along it as
//! the normal turns against the body:
//!
//! > a′ = v_A − H_A·(n′ − ω_A × n),   b′ = v_B + H_B·(n′ − ω_B × n),   a′ − b′ = s′·n + s·n′.
//!
//! Across the normal this is a linear system for `n′`,
//!
//! > (H_A + H_B + s)·n′ = v_A − v_B + H_A·(ω_A × n) + H_B·(ω_B × n).
//!
//! On an edge of a body, along the unit vector `e`, the support point is free, and in exchange the normal stays
//! across the edge:
//!
//! > a′ = … + λ·e,   e·(n′ − ω_A × n) = 0.
//!
//! An edge takes one unknown of `n′` and gives `λ`; a face, or two edges that cross, take both.

use convex_support::{AngularVelocity as _, Scalar, Vector};
use num_traits::Float as _;

use super::ClosestFeatures;
use super::overlap::DifferenceSpan;
use crate::curvature::between;
use crate::symmetric::{Across, Symmetric, cross, dot, scaled, sum, way};
use crate::unit::reciprocal_of_power;
use crate::{RigidMotion, Trajectory};

/// The velocities of the closest points and of the normal between them, as bodies move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClosestVelocities<V: Vector> {
    /// The rate at which the signed distance changes.
    pub signed_distance: V::Scalar,
    /// The rate at which the unit normal changes, a vector across the normal.
    pub normal: V,
    /// The velocity of the closest point of `a`: of the place, not of the point of the body that is there.
    pub point_a: V,
    /// The velocity of the closest point of `b`.
    pub point_b: V,
}

impl<V: Vector> ClosestFeatures<V> {
    /// The velocities of the signed distance, the normal and the closest points as the bodies begin to move.
    ///
    /// `None` if the normal or the closest points are not [the only ones](Self::are_points_unique), or if the curvature
    /// of the shapes is not known: then nearby support points are not where
    /// [`SupportMap::core_support_hessian`](convex_support::SupportMap::core_support_hessian) predicts them.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec3};
    /// use gjk_raycast::{RigidMotion, SignedDistanceOptions, signed_distance};
    ///
    /// // A ball passes another at a distance of 4 between their centres.
    /// let (a, b) = (Posed::translated(Ball::new(1.0)?, DVec3::Y * 4.0)?, Ball::new(2.0)?);
    /// let features =
    ///     signed_distance(&a, &b, SignedDistanceOptions::default()).closest_features(&a, &b);
    /// let passing = RigidMotion::translation(DVec3::X);
    /// let velocities =
    ///     features.velocities(passing, RigidMotion::default()).expect("balls are smooth");
    /// assert_eq!(velocities.signed_distance, 0.0);
    /// assert!((velocities.normal - DVec3::X / 4.0).length() < 1e-15); // an arc of radius 4
    /// assert!((velocities.point_b - DVec3::X / 2.0).length() < 1e-15); // half-way to the centre
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn velocities(&self, motion_a: RigidMotion<V>, motion_b: RigidMotion<V>) -> Option<ClosestVelocities<V>> {
        let solver = self.solver()?;
        let motions = [motion_a, motion_b];
        let turns = motions.map(|motion| self.in_plane(motion.angular_velocity.cross_matrix() * self.normal));
        let [v_a, v_b] = [0, 1].map(|i| motions[i].velocity(V::Scalar::ZERO, self.points[i]));
        let apart = v_a - v_b;
        let Shifted { normal, shifts: [shift_a, shift_b] } = solver.shifted(self.in_plane(apart), turns);
        Some(ClosestVelocities {
            signed_distance: self.normal.dot(apart),
            normal: self.out_of_plane(normal),
            point_a: v_a + self.out_of_plane(shift_a),
            point_b: v_b + self.out_of_plane(shift_b),
        })
    }

    /// The solver for the velocities, if they exist.
    pub(super) fn solver(&self) -> Option<Solver<'_, V>> {
        if !self.is_foretold || !self.is_normal_unique() {
            return None;
        }
        Some(Solver { at: self, stiffness: self.stiffness(), joint: self.joint()? })
    }

    /// A step of Newton's method for the normal and the points: their change if the bodies were moved so that the
    /// closest points, now `r` apart across the normal, become opposite to each other.
    pub(super) fn newton_step(&self, radii: [V::Scalar; 2]) -> Option<NewtonStep<V>> {
        let solver = self.solver()?;
        let [a, b] = [0, 1].map(|i| self.outlines[i].corners[0]);
        let turns = [0, 1].map(|i| self.spans[i].turn(&self.outlines[i]));
        let (change, [slide_a, slide_b]) = solver.solved(way(b.at, a.at), turns);
        let place = |at, height: V::Scalar| self.middle + (self.out_of_plane(at) + self.normal * height) * self.unit;
        let point_a = place(sum(a.at, slide_a), a.height) - self.normal * radii[0];
        let point_b = place(sum(b.at, slide_b), b.height) + self.normal * radii[1];
        let signed_distance = a.height - b.height - (radii[0] + radii[1]) / self.unit;
        Some(NewtonStep { turn: self.out_of_plane(change), points: [point_a, point_b], signed_distance })
    }

    /// How far the closest points are from being opposite to each other, if the features determine them.
    pub(super) fn off(&self) -> V::Scalar {
        // If numbers are not finite there are no corners.
        let [Some(a), Some(b)] = [0, 1].map(|i| self.outlines[i].corners.first()) else { return V::Scalar::ZERO };
        let r = way(b.at, a.at);
        match self.joint() {
            Some(DifferenceSpan::None) => dot(r, r).sqrt(),
            Some(DifferenceSpan::Edge(_, e)) => cross(e, r).abs(),
            _ => V::Scalar::ZERO,
        }
    }

    /// The coordinates of a vector across the normal.
    pub(super) fn in_plane(&self, v: V) -> Across<V::Scalar> {
        let [e, f] = self.across;
        (e.dot(v), f.dot(v))
    }

    pub(super) fn out_of_plane(&self, (x, y): Across<V::Scalar>) -> V {
        let [e, f] = self.across;
        e * x + f * y
    }
}

/// The normal and the closest points, to second order.
#[derive(Clone, Copy, Debug)]
pub(super) struct NewtonStep<V: Vector> {
    pub(super) turn: V,
    /// At the normal before the step.
    pub(super) points: [V; 2],
    /// Along that normal, in the unit.
    pub(super) signed_distance: V::Scalar,
}

/// Closest features, with the system that is solved for every motion.
pub(super) struct Solver<'f, V: Vector> {
    at: &'f ClosestFeatures<V>,
    stiffness: Symmetric<V::Scalar>,
    joint: DifferenceSpan<V::Scalar>,
}

/// The change of the normal, and the slides of the closest points along their bodies, in coordinates across the normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shifted<S> {
    pub(super) normal: Across<S>,
    pub(super) shifts: [Across<S>; 2],
}

impl<V: Vector> Solver<'_, V> {
    /// By the velocity of the material point of `a` relative to that of `b`, and both bodies' turns of the normal.
    pub(super) fn shifted(&self, apart: Across<V::Scalar>, turns: [Across<V::Scalar>; 2]) -> Shifted<V::Scalar> {
        let (at, [turn_a, turn_b]) = (self.at, turns);
        let [hessian_a, hessian_b] = at.hessians;
        let apart = scaled(apart, reciprocal_of_power(at.unit));
        let pulled = sum(hessian_a.times(turn_a), hessian_b.times(turn_b));
        let (normal, [slide_a, slide_b]) = self.solved(sum(apart, pulled), turns);
        let against = |turn: Across<V::Scalar>| sum(normal, negative(turn));
        let shift_a = sum(negative(hessian_a.times(against(turn_a))), slide_a);
        let shift_b = sum(hessian_b.times(against(turn_b)), slide_b);
        Shifted { normal, shifts: [shift_a, shift_b].map(|shift| scaled(shift, at.unit)) }
    }

    /// The change of the normal, and the slides of the points along edges or faces of their bodies: with `K` the
    /// stiffness and `g = K·n′ − r`, the slide of `a` less that of `b` is `g`.
    fn solved(&self, r: Across<V::Scalar>, turns: [Across<V::Scalar>; 2]) -> Solved<V::Scalar> {
        let zero = (V::Scalar::ZERO, V::Scalar::ZERO);
        let rest = |change| way(r, self.stiffness.times(change));
        match self.joint {
            DifferenceSpan::None => (self.soft(r), [zero; 2]),
            DifferenceSpan::Edge(side, e) => {
                let held = dot(e, turns[side]);
                // K·n′ = r across the edge.
                let change = between(self.stiffness, negative(r), e, held);
                let along = dot(e, rest(change));
                (change, slides(side, scaled(e, along)))
            }
            DifferenceSpan::Face(side) => {
                let change = turns[side];
                (change, slides(side, rest(change)))
            }
            DifferenceSpan::Crossed([e, f]) => {
                // e·n′ and f·n′ are known, and g = λe − μf.
                let (along_e, along_f) = (dot(e, turns[0]), dot(f, turns[1]));
                let area = cross(e, f);
                let change = ((along_e * f.1 - along_f * e.1) / area, (along_f * e.0 - along_e * f.0) / area);
                let g = rest(change);
                (change, [scaled(e, cross(g, f) / area), scaled(f, cross(g, e) / area)])
            }
        }
    }

    /// `K⁻¹·r`; in 2D there is one entry.
    fn soft(&self, r: Across<V::Scalar>) -> Across<V::Scalar> {
        if V::DIM == 2 { (r.0 / self.stiffness.a, V::Scalar::ZERO) } else { self.stiffness.solve(r) }
    }
}

/// The change of the normal, and the slides of both points.
type Solved<S> = (Across<S>, [Across<S>; 2]);

/// The slides of both points if only one body's point slides: by `g`, or for `b` by `−g`.
fn slides<S: Scalar>(body: usize, g: Across<S>) -> [Across<S>; 2] {
    let zero = (S::ZERO, S::ZERO);
    if body == 0 { [g, zero] } else { [zero, negative(g)] }
}

fn negative<S: Scalar>(x: Across<S>) -> Across<S> {
    (-x.0, -x.1)
}
