//! How the Euclidean distance changes as a body moves.

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Vector};

use super::contact::{Contact, Mover, Quantity, Units};
use super::value_of_contact::{ValueOfContact, gradient, hessian};
use crate::numerics::load;
use crate::pair::Pair;
use crate::{Answer, Distance};

impl<V: Vector> Answer<'_, V, Distance<V>> {
    /// The gradient of the distance with respect to the motion of the first ellipsoid: minus the unit normal, as a
    /// force at its closest point. Zero where the bodies overlap.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let distance = EllipsoidPair::new(&link, &obstacle, MarginOptions::default()).distance();
    /// assert_eq!(distance.gradient().translation, DVec3::new(-1.0, 0.0, 0.0));
    /// // The tip at (2, 0, 0) swings away from the obstacle to second order only, by (r + r²/ρ)/2·ω².
    /// assert_eq!(distance.gradient().rotation, DVec3::ZERO);
    /// assert!(distance.hessian().along(DVec3::ZERO, DVec3::Z) > 0.0);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn gradient(&self) -> MotionGradient<V> {
        gradient(self, Mover::First)
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        gradient(self, Mover::Second)
    }

    /// The second derivatives with respect to the motion of the first ellipsoid. The block of translations is positive
    /// semidefinite, with the normal in its kernel. Zero where the bodies overlap; it grows without bound for bodies of
    /// no extent.
    pub fn hessian(&self) -> MotionHessian<V> {
        hessian(self, Mover::First)
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        hessian(self, Mover::Second)
    }
}

impl<V: Vector> ValueOfContact<V> for Distance<V> {
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Units)> {
        let (pair, length) = Pair::<N>::new(first, second).in_own_unit();
        let normal = load(self.bracket.normal);
        let contact = Contact::new(&pair, Quantity::DISTANCE, normal)?.refined(&pair);
        Some((contact, Units { value: length, length }))
    }
}
