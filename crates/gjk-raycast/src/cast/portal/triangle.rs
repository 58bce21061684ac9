//! The search for a triangle of support points that the line runs through, a *portal*, as near as there is one.
//!
//! Seen along the ray, a portal contains zero, and the ray crosses it at `Σ wᵢ·tᵢ`: a bound from above. With the
//! portal's own plane for `α`, the support point either is on that plane, and `τ(α)` is as high; or it is before it,
//! and of the three triangles that it spans with the edges of the portal one contains zero, and is crossed earlier.
//! That is the simplex method for a linear programme in the two unknowns `α`, whose constraints are the support points.
//!
//! The name, and the search for the first portal, are those of Gary Snethen's *Minkowski portal refinement*
//! (`XenoCollide`: Complex Collision Made Simple, Game Programming Gems 7, 2008), whose ray runs from a point inside of
//! the body.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::sqp::sqp;
use super::{BestPlane, OF_FACE, Portal};
use crate::cast::bracket::{Bracket, EntryProof};
use crate::cast::ray_frame::{Alpha, RayFrame, RayPlane, RayPoint};
use crate::cast::{RayContact, Stop};
use crate::symmetric::{Across, dot};

/// Support points until the portal has to be found; half as many where curvature may tell more.
const MAX_OUTSIDE: usize = 16;

/// The tilt up to which smooth pieces are looked at from near.
const NEAR: f64 = 0.01;

/// Exchanges of a point that bring the portal no nearer.
pub(super) const MAX_EXCHANGES: usize = 12;

/// Closes the bracket, beginning with a plane across `first`, and with planes tilted by `tilt` until a portal is found.
#[inline(always)]
pub(super) fn triangle<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    first: V,
    tilt: V::Scalar,
) -> Result<RayContact<V>, Stop<V>> {
    let mut p = frame.support(bracket, first)?;
    let mut best = BestPlane::none(bracket.end());
    best.begin(bracket, frame, first, &mut p, Scalar::ZERO)?;
    if !(dot(p.across(), p.across()) > bracket.noise * bracket.noise) {
        // The line runs through the first one, which may be a corner.
        bracket.entry = EntryProof::InDoubt;
        p.alpha.ok_or(Stop::InDoubt)?;
        return best.close(bracket, frame, &[p], &[Scalar::ONE], p.t);
    }
    let mut planes = Planes { frame, alpha: best.alpha, best, tilt };
    let mut q = planes.opposite(bracket, &p)?;
    // Pieces known from so near tell where to look next before the line is enclosed.
    if p.alpha.is_some() && tilt <= V::Scalar::from_f64(NEAR) && bracket.body.is_curved() {
        match sqp(bracket, frame, &[p, q], None, planes.best, tilt) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
    }
    let portal = planes.enclose(bracket, &mut p, &mut q)?;
    planes.shrink(bracket, portal)
}

/// The planes of the search: the last, the best, and how far the next one is tilted towards the line.
struct Planes<'f, V: Vector> {
    frame: &'f RayFrame<V>,
    alpha: Alpha<V::Scalar>,
    best: BestPlane<V>,
    tilt: V::Scalar,
}

impl<V: Vector> Planes<'_, V> {
    /// The support point of a plane, which is the last one then.
    #[inline(always)]
    fn support(&mut self, bracket: &mut Bracket<'_, V>, plane: RayPlane<V::Scalar>) -> Result<RayPoint<V>, Stop<V>> {
        let p = self.frame.support_of(bracket, plane)?;
        self.alpha = plane.alpha();
        self.best.improve(bracket, self.frame, self.alpha, &p, Scalar::ZERO)?;
        Ok(p)
    }

    /// The support point of a plane that is tilted towards `toward`; or, if that is not on that side of the line, of one
    /// that is tilted more, and in the end the one along `toward` itself.
    #[inline(always)]
    fn support_toward(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        plane: RayPlane<V::Scalar>,
        toward: (V::Scalar, V::Scalar),
    ) -> Result<RayPoint<V>, Stop<V>> {
        let p = self.support(bracket, plane)?;
        if dot(toward, p.across()) > Scalar::ZERO { Ok(p) } else { self.support_farther(bracket, toward) }
    }

    #[cold]
    #[inline(never)]
    fn support_farther(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        toward: Across<V::Scalar>,
    ) -> Result<RayPoint<V>, Stop<V>> {
        let number = V::Scalar::from_f64;
        while self.tilt < Scalar::ONE {
            self.tilt = (self.tilt * number(8.0)).max(number(OF_FACE));
            let p = self.support(bracket, self.alpha.tilted(toward, self.tilt).plane())?;
            if dot(toward, p.across()) > Scalar::ZERO {
                return Ok(p);
            }
        }
        // In the end the plane along the line does not separate and has its point beyond.
        self.tilt = self.tilt.max(Scalar::ONE);
        let across = self.frame.vector(toward).unit().ok_or(Stop::InDoubt)?;
        let p = self.frame.support(bracket, across)?;
        bracket.advance(across, p.point)?;
        let is_beyond = (p.point - bracket.line().foot).dot(across) + bracket.radius > Scalar::ZERO;
        if is_beyond { Ok(p) } else { Err(Stop::InDoubt) }
    }

    /// A second point on the other side of the line, of a plane that is tilted towards it.
    #[inline(always)]
    fn opposite(&mut self, bracket: &mut Bracket<'_, V>, p: &RayPoint<V>) -> Result<RayPoint<V>, Stop<V>> {
        let squared = p.u * p.u + p.v * p.v;
        let toward = (-p.u, -p.v);
        let rise = self.tilt * (self.alpha.length_squared() * squared).sqrt();
        let Alpha { a, b } = self.alpha;
        let plane = RayPlane { a: a * squared + toward.0 * rise, b: b * squared + toward.1 * rise, c: squared };
        self.support_toward(bracket, plane, toward)
    }

    /// A third point such that the triangle contains zero.
    #[inline(always)]
    fn enclose(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        p: &mut RayPoint<V>,
        q: &mut RayPoint<V>,
    ) -> Result<Portal<V>, Stop<V>> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let most = if bracket.body.is_curved() { MAX_OUTSIDE / 2 } else { MAX_OUTSIDE };
        for _ in 0..most {
            let area = p.cross(q);
            let turn = one.copysign(area);
            let ((du, dv), dt) = p.edge_to(q);
            let squared = du * du + dv * dv;
            // The plane through both points that is tilted from the last one, towards the line: with w = (−dv, du)
            // across the edge e, α = (dt·e + k·w)/|e|², k = α·w + tilt·√(|e|² + (α·w)²).
            let toward = (-dv * turn, du * turn);
            let along = dot(self.alpha.across(), toward);
            let k = along + self.tilt * (squared + along * along).sqrt();
            let plane = RayPlane { a: du * dt + toward.0 * k, b: dv * dt + toward.1 * k, c: squared };
            let s = self.support_toward(bracket, plane, toward)?;
            let weights = [q.cross(&s) * turn, s.cross(p) * turn, area.abs()];
            if weights[0] >= zero && weights[1] >= zero {
                return Ok(Portal { corners: [*p, *q, s], weights, turn });
            }
            *(if weights[0] < weights[1] { &mut *p } else { &mut *q }) = s;
        }
        // The line passes near where the body is seen to end, too near to be enclosed by points.
        Err(Stop::InDoubt)
    }

    /// Brings the portal nearer until the bracket closes between the best plane, at its own cosine, and the portal.
    #[inline(always)]
    fn shrink(&mut self, bracket: &mut Bracket<'_, V>, mut portal: Portal<V>) -> Result<RayContact<V>, Stop<V>> {
        let tolerance = bracket.tolerance();
        bracket.around = Some(portal.corners.map(|p| p.point));
        let mut last = V::Scalar::infinity();
        let mut exchanges = MAX_EXCHANGES;
        loop {
            let sum = portal.sum();
            if !(sum > Scalar::ZERO) {
                return Err(Stop::InDoubt);
            }
            let (plane, inverse) = (portal.plane(sum), sum.recip());
            let high = portal.high(inverse);
            if !(high < last) {
                exchanges -= 1;
                if exchanges == 0 || !(high < V::Scalar::infinity()) {
                    return Err(Stop::InDoubt);
                }
            }
            last = high;
            if high < bracket.earliest() {
                // The ray begins behind the portal, in the body or past it.
                return Err(Stop::InDoubt);
            }
            let closed = |best: &BestPlane<V>, alpha: Alpha<V::Scalar>| alpha.is_within(high - best.tau, tolerance);
            let weights = portal.weights.map(|w| w * inverse);
            if closed(&self.best, self.best.alpha) {
                let found = self.best.close(bracket, self.frame, &portal.corners, &weights, high)?;
                portal.bound_entry(bracket, plane, high);
                return Ok(found);
            }
            if bracket.body.is_curved() && self.frame.is_curved(bracket.body, self.frame.normal(plane)) {
                return sqp(bracket, self.frame, &portal.corners, Some(portal), self.best, self.tilt);
            }
            let before = self.best.tau;
            let r = self.support(bracket, plane)?;
            if self.best.tau > before && closed(&self.best, self.alpha) {
                let found = self.best.close(bracket, self.frame, &portal.corners, &weights, high)?;
                portal.bound_entry(bracket, plane, high);
                return Ok(found);
            }
            portal.exchange(r)?;
        }
    }
}
