//! Bodies where their motions have taken them.

use convex_support::{InvalidShape, Posed, SupportMap, Vector};

use crate::Displacement;

impl<V: Vector> Displacement<V> {
    /// A body where the motion has taken it: the same shape in another pose, for the next step of a simulation or for
    /// another query.
    ///
    /// ```
    /// use convex_support::{Cuboid, Posed, glam::{DQuat, DVec3}};
    /// use gjk_raycast::{RigidMotion, Trajectory};
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // A plank tumbles about its centre as it flies.
    /// let center = DVec3::new(5.0, 1.0, 0.0);
    /// let plank = Posed::new(Cuboid::new(DVec3::new(2.0, 0.1, 0.5))?, DQuat::IDENTITY, center)?;
    /// let motion =
    ///     RigidMotion { velocity: DVec3::X * 3.0, angular_velocity: DVec3::Z * FRAC_PI_2, center };
    /// let later: Posed<Cuboid<DVec3>> = motion.displacement(1.0).moved(&plank)?;
    /// assert!((later.translation() - DVec3::new(8.0, 1.0, 0.0)).length() < 1e-15);
    /// assert!((later.rotation() * DVec3::X - DVec3::Y).length() < 1e-15);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidShape`] if the body would be beyond the largest number.
    pub fn moved<S: SupportMap<Vector = V> + Clone>(&self, body: &Posed<S>) -> Result<Posed<S>, InvalidShape> {
        Posed::from_matrix(body.shape().clone(), self.rotation() * body.rotation(), self.of(body.translation()))
    }
}
