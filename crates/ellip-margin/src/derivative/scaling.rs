//! How the common scale changes as a body moves.

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Vector};

use super::contact::{Contact, Mover, Quantity, Units};
use super::value_of_contact::{ValueOfContact, gradient, hessian};
use crate::numerics::{Vec, combine, load};
use crate::pair::Pair;
use crate::{Answer, Scaling};

impl<V: Vector> Answer<'_, V, Scaling<V>> {
    /// The gradient of the scale α with respect to the motion of the first ellipsoid, at any depth: it tells the way
    /// out where the margin has reached its floor. Zero where the bodies are concentric, which is the least α can be.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// // Balls of radius 2 and 1, their centres 0.6 apart: α = distance of the centres/3.
    /// let e1 = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
    /// let e2 = Ellipsoid::new(DVec3::new(0.6, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&e1, &e2, MarginOptions::default());
    /// assert_eq!(pair.margin().gradient().translation, DVec3::ZERO);
    /// assert!(
    ///     pair.scaling().gradient().translation.abs_diff_eq(DVec3::new(-1.0 / 3.0, 0.0, 0.0), 1e-15)
    /// );
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn gradient(&self) -> MotionGradient<V> {
        gradient(self, Mover::First)
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        gradient(self, Mover::Second)
    }

    /// The second derivatives of the scale α with respect to the motion of the first ellipsoid. α is homogeneous in the
    /// line of centres: its second derivatives grow as its inverse towards concentric bodies, where there are none and
    /// zero is the answer.
    pub fn hessian(&self) -> MotionHessian<V> {
        hessian(self, Mover::First)
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        hessian(self, Mover::Second)
    }
}

impl<V: Vector> ValueOfContact<V> for Scaling<V> {
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Units)> {
        let (pair, length) = Pair::<N>::new(first, second).in_own_unit();
        let [e1, e2]: [Vec<N>; 2] = self.ball_points.map(load);
        // Qv, against E₂'s own normal there.
        let normal = combine(pair.axes2, core::array::from_fn(|j| e2[j] / pair.a2[j]));
        let contact = Contact::at_points(&pair, Quantity::SCALE, normal, [e1, e2], None)?;
        Some((contact, Units { value: 1.0, length }))
    }
}
