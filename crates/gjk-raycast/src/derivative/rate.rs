//! One-sided derivatives, along a motion.

use convex_support::{Scalar, Vector};

use super::ClosestFeatures;
use super::overlap::Overlap;
use crate::symmetric::Across;
use crate::{RigidMotion, Trajectory};

impl<V: Vector> ClosestFeatures<V> {
    /// How fast the signed distance changes as the bodies begin to move: its one-sided derivative. It is exact also
    /// where faces or edges are parallel. `None` where the normal is [not the only one](Self::is_normal_unique).
    ///
    /// The signed distance falls as fast as the fastest of all closest points come nearer. With `M` the overlap of both
    /// features in the plane across the normal `n` (Danskin, *The theory of max-min, with applications*, 1966),
    ///
    /// > ds/dt = min { n·(v_A(p) − v_B(p)) : p ∈ M },
    ///
    /// and since velocities are linear in `p`, the least is at a corner of `M`. In overlap the signed distance is the
    /// maximum over all normals of a minimum over points; by the duality of linear programs its derivative is the same
    /// minimum. Discs are not replaced by polygons. If a face is known only [in part](Self::are_complete), corners that
    /// are left out may come nearer faster: the answer is then an upper bound.
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
        Some(self.least(|p| self.normal.dot(velocity(motion_a, p) - velocity(motion_b, p))))
    }

    /// How much later the bodies touch as their poses begin to change, where they touch while they move: the one-sided
    /// derivative of the time, `min −n·(δa − δb)/(n·w)` over the overlap of both features. Displacements and motions
    /// are those at contact.
    pub(super) fn delay(&self, change: impl Fn(V) -> V, velocity: impl Fn(V) -> V) -> Option<V::Scalar> {
        if !self.is_normal_unique() {
            return None;
        }
        let closing = |p| -self.normal.dot(velocity(p));
        let is_closing = self.least(closing) > V::Scalar::ZERO;
        is_closing.then(|| self.least(|p| self.normal.dot(change(p)) / closing(p)))
    }

    /// The least value over the overlap of both features, in the plane half-way between them, in the world. The value
    /// is linear in the point, or a quotient of such.
    fn least(&self, value: impl Fn(V) -> V::Scalar) -> V::Scalar {
        if self.are_points_unique() {
            let half = V::Scalar::from_f64(0.5);
            return value(self.points[0] * half + self.points[1] * half);
        }
        let [e, f] = self.across;
        let place = |(x, y): Across<V::Scalar>| self.middle + (e * x + f * y) * self.unit;
        let overlap = Overlap::of(&self.outlines, self.slack());
        overlap.least(|at| value(place(at))).unwrap_or_else(|| value(self.middle))
    }
}

fn velocity<V: Vector>(motion: RigidMotion<V>, point: V) -> V {
    motion.velocity(V::Scalar::ZERO, point)
}
