//! Derivatives of the quantities that are the value of a contact itself: the distance and the common scale.

use convex_support::{Ellipsoid, MotionGradient, MotionHessian, Vector};

use super::contact::{Contact, Form, Mover, Quantity, Units};
use super::motion;
use crate::numerics::{Vec, combine, load};
use crate::pair::Pair;
use crate::{Answer, Distance, Scaling};

/// An answer about two ellipsoids that is the value of their contact.
trait ValueOfContact<V: Vector> {
    /// The contact, and the units it is in; `None` where the quantity is at its floor.
    fn contact<const N: usize>(&self, first: &Ellipsoid<V>, second: &Ellipsoid<V>) -> Option<(Contact<N>, Units)>;
}

/// The gradient of an answer with respect to the motion of one of the two.
fn gradient<V: Vector, const N: usize>(
    answer: &Answer<'_, V, impl ValueOfContact<V>>,
    mover: Mover,
) -> MotionGradient<V> {
    let (first, second) = (answer.first(), answer.second());
    let body = match mover {
        Mover::First => first,
        Mover::Second => second,
    };
    match answer.contact::<N>(first, second) {
        Some((contact, units)) => motion::gradient(&contact, mover, body, units),
        None => motion::no_gradient(body),
    }
}

/// The second derivatives.
fn hessian<V: Vector, const N: usize>(
    answer: &Answer<'_, V, impl ValueOfContact<V>>,
    mover: Mover,
) -> MotionHessian<V> {
    match answer.contact::<N>(answer.first(), answer.second()) {
        Some((contact, units)) => motion::hessian(&contact, mover, Form { slope: 1.0, curvature: 0.0, units }),
        None => motion::no_hessian(),
    }
}

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
        in_dimension!(gradient::<V>(self, Mover::First))
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, Mover::Second))
    }

    /// The second derivatives with respect to the motion of the first ellipsoid. The block of translations is positive
    /// semidefinite, with the normal in its kernel. Zero where the bodies overlap; it grows without bound for bodies of
    /// no extent.
    pub fn hessian(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::First))
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::Second))
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
        in_dimension!(gradient::<V>(self, Mover::First))
    }

    /// The gradient with respect to the motion of the second ellipsoid.
    pub fn gradient_of_second(&self) -> MotionGradient<V> {
        in_dimension!(gradient::<V>(self, Mover::Second))
    }

    /// The second derivatives of the scale α with respect to the motion of the first ellipsoid. α is homogeneous in the
    /// line of centres: its second derivatives grow as its inverse towards concentric bodies, where there are none and
    /// zero is the answer.
    pub fn hessian(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::First))
    }

    /// The second derivatives with respect to the motion of the second ellipsoid.
    pub fn hessian_of_second(&self) -> MotionHessian<V> {
        in_dimension!(hessian::<V>(self, Mover::Second))
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
