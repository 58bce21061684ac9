//! Two cores without the balls that roll within them.

use convex_support::{Scalar, Vector};

use crate::body::{AnyPair, PointPair, TracedSupport};
use crate::symmetric::Symmetric;

/// A pair of shapes whose cores are smaller by the radii of two balls that would sweep them to what they are, in units
/// of the scale.
///
/// The support point of such a core along a unit vector `u` is that of the whole less `r·u`, and the Hessian of its
/// support value less that of a ball. Where no radius is positive it is the pair.
pub(super) struct Peeled<'p, 'a, V: Vector> {
    pub(super) pair: &'p mut AnyPair<'a, V>,
    pub(super) radii: [V::Scalar; 2],
}

/// The Hessian without that of a ball of the given radius, at a direction and along two changes of it.
pub(super) fn without_ball<V: Vector>(
    hessian: Symmetric<V::Scalar>,
    radius: V::Scalar,
    direction: V,
    changes: [V; 2],
) -> Symmetric<V::Scalar> {
    let Some(e) = direction.unit().filter(|_| radius > Scalar::ZERO) else { return hessian };
    let across = |change: V| change - e * change.dot(e);
    let (u, w) = (across(changes[0]), across(changes[1]));
    let bend = radius / direction.norm();
    let Symmetric { a, b, d } = hessian;
    Symmetric { a: a - bend * u.dot(u), b: b - bend * u.dot(w), d: d - bend * w.dot(w) }
}

impl<V: Vector> TracedSupport for Peeled<'_, '_, V> {
    type Vector = V;

    #[inline(always)]
    fn support(&mut self, direction: V) -> (V, PointPair<V>) {
        let (point, pair) = self.pair.support(direction);
        let [a, b] = self.radii;
        if !(a + b > Scalar::ZERO) {
            return (point, pair);
        }
        let u = direction.unit().unwrap_or(direction);
        let pair = PointPair { a: pair.a - u * a, b: pair.b + u * b };
        (pair.a - pair.b, pair)
    }

    #[inline(always)]
    fn hessian(&self, direction: V, changes: [V; 2]) -> Symmetric<V::Scalar> {
        let whole = self.pair.hessian(direction, changes);
        without_ball(whole, self.radii[0] + self.radii[1], direction, changes)
    }

    fn is_curved(&self) -> bool {
        self.pair.is_curved()
    }
}
