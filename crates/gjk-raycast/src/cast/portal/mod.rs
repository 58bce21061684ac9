//! The ray cast as it is seen along the ray, where it is the search for a plane by two unknowns, and for a point of the
//! line in a triangle of support points.
//!
//! What is decided here, by signs and by planes in the coordinates of the [frame](super::ray_frame), is where to look
//! next. Where the [bracket](super::bracket) finds that in doubt, so is the answer, and Algorithm 3 takes over.

mod rounded;
mod sqp;
mod triangle;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::bracket::{Bracket, EntryProof};
use super::pieces::OnLine;
use super::ray_frame::{Alpha, RayFrame, RayPlane, RayPoint, weights_of_zero};
use super::{RayContact, Stop};
use crate::body::PointPair;
use crate::symmetric::dot;
use rounded::rounded;
use triangle::triangle;

/// The tilt that shows another corner of the face that the last plane was across.
const OF_FACE: f64 = 0.03;

/// By how much the second plane is tilted from a first one that is off by an angle.
///
/// If it is tilted by less than the first one is off, both may show the same point. A smooth piece that is looked at
/// from aside is known to the third order of that angle; where a polytope is looked at along, it is the same.
fn tilt<V: Vector>(bracket: &Bracket<'_, V>, error: V::Scalar) -> V::Scalar {
    let of_face = V::Scalar::from_f64(OF_FACE);
    if bracket.body.is_curved() { (error + error).max(V::Scalar::EPSILON.sqrt()).min(of_face) } else { of_face }
}

/// Closes the bracket, or finds a plane that the whole ray is before.
#[inline(always)]
pub(super) fn portal<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    // The first plane: the one given, or the tangent plane of the ball about the body where the ray enters it; and how
    // far the next one is tilted.
    let told = bracket.options.warm_start.and_then(|warm| Some((warm.axis.unit()?, tilt(bracket, warm.error()))));
    let (first, tilt) = told.unwrap_or_else(|| (bracket.x(), Scalar::ONE));
    let core = RayFrame::new(bracket.line(), Scalar::ZERO);
    if bracket.radius > Scalar::ZERO && !core.is_curved(bracket.body, first) {
        return rounded(bracket, &core, first, tilt);
    }
    triangle(bracket, &RayFrame::new(bracket.line(), bracket.radius), first, tilt)
}

/// The plane that is crossed last, of those known.
#[derive(Clone, Copy)]
struct BestPlane<V: Vector> {
    tau: V::Scalar,
    alpha: Alpha<V::Scalar>,
    /// The core's support point on it.
    point: V,
    /// Behind this nothing of the ray is left.
    end: V::Scalar,
}

impl<V: Vector> BestPlane<V> {
    /// None so far, of a ray that ends at `end`.
    #[inline(always)]
    fn none(end: V::Scalar) -> Self {
        Self { tau: -V::Scalar::infinity(), alpha: Alpha::ZERO, point: V::ZERO, end }
    }

    #[inline(always)]
    fn set(&mut self, tau: V::Scalar, alpha: Alpha<V::Scalar>, p: &RayPoint<V>) {
        (self.tau, self.alpha, self.point) = (tau, alpha, p.point);
    }

    /// Begins with the plane across `n`, if the ray does not run too nearly along it: at a cosine of an eighth.
    #[inline(always)]
    fn begin(
        &mut self,
        bracket: &Bracket<'_, V>,
        frame: &RayFrame<V>,
        n: V,
        p: &mut RayPoint<V>,
        radius: V::Scalar,
    ) -> Result<(), Stop<V>> {
        p.alpha = frame.alpha(n).filter(|alpha| alpha.length_squared() < Scalar::from_f64(64.0));
        if let Some(alpha) = p.alpha {
            self.set(alpha.tau(p) - swept(radius, alpha), alpha, p);
        }
        if p.alpha.is_none() || self.tau > self.end { bracket.separate(n, p.point) } else { Ok(()) }
    }

    /// Takes the plane of a support point, if it is crossed later, and ends the search if nothing of the ray is left
    /// behind it. Whether it is crossed later.
    #[inline(always)]
    fn improve(
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
    #[inline(always)]
    fn close(
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
        let (mut point, mut witness) = (V::ZERO, PointPair::default());
        for (p, &weight) in corners.iter().zip(weights) {
            point += p.point * weight;
            witness = witness.plus(p.witness, weight);
        }
        let n = frame.normal(self.alpha.plane()).unit().ok_or(Stop::InDoubt)?;
        bracket.advance(n, self.point)?;
        bracket.close(point, witness, high)
    }
}

/// How much earlier the ray crosses a plane that is moved by the radius: `ρ·|n|`.
#[inline(always)]
fn swept<S: Scalar>(radius: S, alpha: Alpha<S>) -> S {
    if radius > S::ZERO { radius * alpha.length() } else { S::ZERO }
}

/// A portal: three points of the body whose triangle contains zero as seen along the ray.
#[derive(Clone, Copy)]
struct Portal<V: Vector> {
    corners: [RayPoint<V>; 3],
    /// Zero's weights, up to their sum.
    weights: [V::Scalar; 3],
    /// Whether the corners go round anticlockwise, 1, or clockwise, −1: cheaper to keep than to put them in order.
    turn: V::Scalar,
}

impl<V: Vector> Portal<V> {
    /// The triangle of three points, if it contains zero.
    fn around(corners: [RayPoint<V>; 3]) -> Option<Self> {
        let areas = weights_of_zero(corners.map(|p| p.across()));
        let turn = V::Scalar::ONE.copysign(areas[2]);
        let weights = areas.map(|area| area * turn);
        weights.iter().all(|&w| w >= Scalar::ZERO).then_some(Self { corners, weights, turn })
    }

    fn sum(&self) -> V::Scalar {
        let [w0, w1, w2] = self.weights;
        w0 + w1 + w2
    }

    /// Its plane, where the sum of the weights is known.
    #[inline(always)]
    fn plane(&self, sum: V::Scalar) -> RayPlane<V::Scalar> {
        let [p, q, s] = &self.corners;
        let RayPlane { a, b, .. } = RayPlane::through([p, q, s]);
        RayPlane { a: a * self.turn, b: b * self.turn, c: sum }
    }

    fn alpha(&self) -> Alpha<V::Scalar> {
        self.plane(self.sum()).alpha()
    }

    /// Where the line runs through, by the reciprocal of that sum.
    #[inline(always)]
    fn high(&self, inverse: V::Scalar) -> V::Scalar {
        let ([w0, w1, w2], [p, q, s]) = (self.weights, &self.corners);
        (w0 * p.t + w1 * q.t + w2 * s.t) * inverse
    }

    /// The combination of its corners that is on the line.
    fn on_line(&self) -> OnLine<V> {
        let inverse = self.sum().recip();
        OnLine { corners: self.corners, weights: self.weights.map(|w| w * inverse), high: self.high(inverse) }
    }

    /// Puts a point in the place of the corner that leaves zero inside.
    #[inline(always)]
    fn exchange(&mut self, r: RayPoint<V>) -> Result<(), Stop<V>> {
        let zero = V::Scalar::ZERO;
        let [p, q, s] = &mut self.corners;
        let [wp, wq, ws] = self.weights;
        let turn = self.turn;
        let (kp, kq, ks) = (p.cross(&r) * turn, q.cross(&r) * turn, s.cross(&r) * turn);
        if kq >= zero && kp <= zero {
            (*s, self.weights) = (r, [kq, -kp, ws]);
        } else if ks >= zero && kq <= zero {
            (*p, self.weights) = (r, [wp, ks, -kq]);
        } else if kp >= zero && ks <= zero {
            (*q, self.weights) = (r, [-ks, wq, kp]);
        } else {
            return Err(Stop::InDoubt);
        }
        Ok(())
    }

    /// Bounds the entry by its plane, where the line runs through it by more than an error.
    #[inline(always)]
    fn bound_entry(&self, bracket: &mut Bracket<'_, V>, RayPlane { a, b, c }: RayPlane<V::Scalar>, high: V::Scalar) {
        if is_surrounded(self.corners.each_ref(), bracket.error + bracket.noise) {
            bracket.pierce(high, (a * a + b * b + c * c).sqrt() / c);
        } else {
            bracket.entry = EntryProof::InDoubt;
        }
    }
}

/// Whether zero is within a triangle, farther than `by` from its sides: twice the area that it spans with one is the
/// length of that times its distance.
#[inline(always)]
fn is_surrounded<V: Vector>([p, q, s]: [&RayPoint<V>; 3], by: V::Scalar) -> bool {
    let weights = weights_of_zero([p.across(), q.across(), s.across()]);
    let sides = [q.edge_to(s).0, s.edge_to(p).0, p.edge_to(q).0];
    let is_beyond = |i: usize| weights[i] * weights[i] > by * by * dot(sides[i], sides[i]);
    is_beyond(0) & is_beyond(1) & is_beyond(2)
}
