//! The ends of the bracket: the plane that is crossed last, from below, and a point of the body on the line, from
//! above.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::PointPair;
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::{Alpha, RayFrame, RayPoint};
use crate::cast::{RayContact, Stop};

/// The plane that is crossed last, of those known.
#[derive(Clone, Copy)]
pub(super) struct BestPlane<V: Vector> {
    pub(super) tau: V::Scalar,
    pub(super) alpha: Alpha<V::Scalar>,
    /// The core's support point on it.
    point: V,
    /// The end of the ray: behind it the search ends.
    end: V::Scalar,
}

impl<V: Vector> BestPlane<V> {
    /// None so far, of a ray that ends at `end`.
    #[inline(always)]
    pub(super) fn none(end: V::Scalar) -> Self {
        Self { tau: -V::Scalar::infinity(), alpha: Alpha::ZERO, point: V::ZERO, end }
    }

    pub(super) fn is_known(&self) -> bool {
        self.tau > -V::Scalar::infinity()
    }

    #[inline(always)]
    pub(super) fn set(&mut self, tau: V::Scalar, alpha: Alpha<V::Scalar>, p: &RayPoint<V>) {
        (self.tau, self.alpha, self.point) = (tau, alpha, p.point);
    }

    /// Begins with the plane across `n`, if the ray does not run too nearly along it.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        bracket: &Bracket<'_, V>,
        frame: &RayFrame<V>,
        n: V,
        p: &mut RayPoint<V>,
        radius: V::Scalar,
    ) -> Result<(), Stop<V>> {
        let (across, facing) = frame.split(n);
        let is_faced = facing > n.length() * V::Scalar::from_f64(0.125);
        if is_faced {
            let per_facing = facing.recip();
            (self.alpha, self.point) = (Alpha { a: across.0 * per_facing, b: across.1 * per_facing }, p.point);
            self.tau = self.alpha.tau(p) - swept(radius, self.alpha);
            p.alpha = Some(self.alpha);
        }
        if !is_faced || self.tau > self.end { bracket.separate(n, p.point) } else { Ok(()) }
    }

    /// Takes the plane of a support point, if it is crossed later, and ends the search if it has the rest of the ray
    /// before it. Returns whether it is crossed later.
    #[inline(always)]
    pub(super) fn improve(
        &mut self,
        bracket: &Bracket<'_, V>,
        frame: &RayFrame<V>,
        alpha: Alpha<V::Scalar>,
        p: &RayPoint<V>,
        radius: V::Scalar,
    ) -> Result<bool, Stop<V>> {
        let tau = alpha.tau(p) - swept(radius, alpha);
        if !(tau > self.tau) {
            return Ok(false);
        }
        self.set(tau, alpha, p);
        if tau > self.end {
            bracket.separate(frame.normal(alpha.plane()), p.point)?;
        }
        Ok(true)
    }

    /// Closes the bracket between this plane and the weighted sum of the corners, which is on the line at `high`.
    #[inline(never)]
    pub(super) fn close(
        &self,
        bracket: &mut Bracket<'_, V>,
        frame: &RayFrame<V>,
        corners: &[RayPoint<V>],
        weights: &[V::Scalar],
        high: V::Scalar,
    ) -> Result<RayContact<V>, Stop<V>> {
        // A combination is a point of the body only if no weight is negative by more than rounding.
        if weights.iter().any(|&weight| weight < -bracket.noise) {
            return Err(Stop::InDoubt);
        }
        let [mut point, mut a, mut b] = [V::ZERO; 3];
        for (p, &weight) in corners.iter().zip(weights) {
            (point, a, b) = (point + p.point * weight, a + p.witness.a * weight, b + p.witness.b * weight);
        }
        let n = frame.normal(self.alpha.plane()).unit().ok_or(Stop::InDoubt)?;
        bracket.advance(n, self.point)?;
        bracket.close(bracket.radius, point, PointPair { a, b }, high)
    }
}

/// How much earlier the ray crosses a plane that is moved by the radius: `ρ·|n|`.
#[inline(always)]
fn swept<S: Scalar>(radius: S, alpha: Alpha<S>) -> S {
    if radius > S::ZERO { radius * alpha.length() } else { S::ZERO }
}

/// Three points of the body, and a combination of them that is on the ray: those of a portal in anticlockwise order;
/// or if none is known, any points, with an infinite `high`.
#[derive(Clone, Copy)]
pub(super) struct OnLine<V: Vector> {
    pub(super) corners: [RayPoint<V>; 3],
    /// The weights of the combination, with sum 1.
    pub(super) weights: [V::Scalar; 3],
    /// Where on the ray it is.
    pub(super) high: V::Scalar,
}
