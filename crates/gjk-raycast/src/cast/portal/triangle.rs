//! The search for a triangle of support points that the line runs through, a *portal*, as near as there is one.
//!
//! In the projection along the ray, a portal contains zero, and the ray crosses it at `Σ wᵢ·tᵢ`: a bound from above.
//! With the portal's own plane for `α`, the support point either is on that plane, and `τ(α)` is as high; or it is
//! before it, and one of the three triangles that it spans with the edges of the portal contains zero, and is crossed
//! earlier. This is the simplex method for a linear programme in the two unknowns `α`, whose constraints are the
//! support points.
//!
//! The name, and the search for the first portal, are those of Gary Snethen's *Minkowski portal refinement*
//! (`XenoCollide`: Complex Collision Made Simple, Game Programming Gems 7, 2008), whose ray runs from a point inside of
//! the body.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::OF_FACE;
use super::closing::{BestPlane, OnLine};
use super::pieces::is_surrounded;
use super::sqp::sqp;
use crate::body::PointPair;
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::{Alpha, RayFrame, RayPlane, RayPoint};
use crate::cast::{RayContact, Stop};
use crate::symmetric::dot;

/// Support points until the portal has to be found; half as many if curvature may help.
const MAX_OUTSIDE: usize = 16;

/// The tilt up to which planes show the same smooth piece.
const SAME_TILT: f64 = 0.01;

/// Exchanges of a point that bring the portal no nearer.
pub(super) const MAX_EXCHANGES: usize = 12;

/// Closes the bracket, beginning with a plane across `first`, which may be known to support the body at `seen`, and
/// with planes tilted by `tilt` until a portal is found.
#[inline(always)]
pub(super) fn triangle<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    first: V,
    seen: Option<RayPoint<V>>,
    tilt: V::Scalar,
) -> Result<RayContact<V>, Stop<V>> {
    let mut p = match seen {
        Some(p) => p,
        None => frame.support(bracket, first)?,
    };
    let mut best = BestPlane::none(bracket.end());
    best.begin(bracket, frame, first, &mut p, Scalar::ZERO)?;
    if !(dot(p.across(), p.across()) > bracket.noise * bracket.noise) {
        // The line runs through the first one, which may be a corner.
        bracket.doubt_entry();
        return if best.is_known() {
            best.close(bracket, frame, &[p], &[Scalar::ONE], p.t)
        } else {
            Err(Stop::InDoubt)
        };
    }
    let mut planes = NewestPlanes { frame, alpha: best.alpha, best, tilt };
    let q = planes.opposite(bracket, &p)?;
    // In one place from here on: copies of it would wait until all of it is in the cache.
    let mut portal = Triangle { corners: [p, q, q], weights: [Scalar::ZERO; 3], turn: Scalar::ONE };
    if tilt < Scalar::ONE
        && let Some(mut found) = mixed(frame, &p, &q)
    {
        return planes.shrink(bracket, &mut found);
    }
    // Pieces found by planes so near one another determine the next plane before the line is enclosed.
    if p.alpha.is_some() && tilt <= V::Scalar::from_f64(SAME_TILT) && bracket.is_curved {
        match sqp(bracket, frame, OnLine::unknown([p, p, q]), planes.best, tilt) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
    }
    if planes.enclose(bracket, &mut portal)? {
        return planes.shrink(bracket, &mut portal);
    }
    // The line passes near the outline of the body, too near to be enclosed by points; but it may run through an edge
    // or a smooth piece.
    if planes.best.is_known() && frame.is_curved(bracket, frame.normal(planes.best.alpha.plane())) {
        let [p, q, _] = portal.corners;
        return sqp(bracket, frame, OnLine::unknown([p, q, q]), planes.best, tilt);
    }
    Err(Stop::InDoubt)
}

/// The planes of the search: the last, the best, and how far the next one is tilted towards the line.
struct NewestPlanes<'f, V: Vector> {
    frame: &'f RayFrame<V>,
    alpha: Alpha<V::Scalar>,
    best: BestPlane<V>,
    tilt: V::Scalar,
}

/// Three points of the body whose triangle contains zero in the projection along the ray.
struct Triangle<V: Vector> {
    corners: [RayPoint<V>; 3],
    /// Zero's weights, up to their sum.
    weights: [V::Scalar; 3],
    /// Whether the corners go round anticlockwise, 1, or clockwise, −1: cheaper to keep than to put them in order.
    turn: V::Scalar,
}

impl<V: Vector> NewestPlanes<'_, V> {
    /// The support point of a plane, which becomes the last one.
    #[inline(always)]
    fn support(&mut self, bracket: &mut Bracket<'_, V>, plane: RayPlane<V::Scalar>) -> Result<RayPoint<V>, Stop<V>> {
        let p = self.frame.support_of(bracket, plane)?;
        self.alpha = plane.alpha();
        self.best.improve(bracket, self.frame, self.alpha, &p, Scalar::ZERO)?;
        Ok(p)
    }

    /// The support point of a plane tilted towards `toward`; or, if that is not on that side of the line, of one tilted
    /// more, and in the end the one along `toward` itself.
    #[inline(always)]
    fn support_toward(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        plane: RayPlane<V::Scalar>,
        toward: (V::Scalar, V::Scalar),
    ) -> Result<RayPoint<V>, Stop<V>> {
        let p = self.support(bracket, plane)?;
        if is_beyond(toward, &p) {
            return Ok(p);
        }
        // Not returned as it is: the point above would be written to memory for the call, too.
        let p = self.support_farther(bracket, toward)?;
        Ok(p)
    }

    /// [`support_toward`](Self::support_toward) of planes that are tilted more than the last one.
    #[cold]
    #[inline(never)]
    fn support_farther(
        &mut self,
        bracket: &mut Bracket<'_, V>,
        toward: (V::Scalar, V::Scalar),
    ) -> Result<RayPoint<V>, Stop<V>> {
        while self.tilt < Scalar::ONE {
            let number = V::Scalar::from_f64;
            self.tilt = (self.tilt * number(8.0)).max(number(OF_FACE));
            let p = self.support(bracket, self.alpha.tilted(toward, self.tilt).plane())?;
            if is_beyond(toward, &p) {
                return Ok(p);
            }
        }
        self.tilt = self.tilt.max(Scalar::ONE);
        support_across(bracket, self.frame, toward)
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

    /// Finds a third corner such that the triangle contains zero. `false` after too many others.
    #[inline(always)]
    fn enclose(&mut self, bracket: &mut Bracket<'_, V>, portal: &mut Triangle<V>) -> Result<bool, Stop<V>> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let most = if bracket.is_curved { MAX_OUTSIDE / 2 } else { MAX_OUTSIDE };
        for _ in 0..most {
            let [p, q, _] = &portal.corners;
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
                (portal.corners[2], portal.weights, portal.turn) = (s, weights, turn);
                return Ok(true);
            }
            portal.corners[if weights[0] < weights[1] { 0 } else { 1 }] = s;
        }
        Ok(false)
    }

    /// Brings the portal nearer until the bracket closes between the best plane, at its own cosine, and the portal. A
    /// function of its own, since together with the search for a portal it runs out of registers.
    #[inline(never)]
    fn shrink(&mut self, bracket: &mut Bracket<'_, V>, portal: &mut Triangle<V>) -> Result<RayContact<V>, Stop<V>> {
        let tolerance = bracket.tolerance();
        bracket.around = Some(portal.corners.map(|p| p.point));
        let mut last = V::Scalar::infinity();
        let mut exchanges = MAX_EXCHANGES;
        loop {
            let [w0, w1, w2] = portal.weights;
            let sum = w0 + w1 + w2;
            if !(sum > Scalar::ZERO) {
                return Err(Stop::InDoubt);
            }
            let plane = portal.plane(sum);
            let inverse = sum.recip();
            let [p, q, s] = &portal.corners;
            let high = (w0 * p.t + w1 * q.t + w2 * s.t) * inverse;
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
            if !closed(&self.best, self.best.alpha) {
                if self.frame.is_curved(bracket, self.frame.normal(plane)) {
                    return sqp(bracket, self.frame, portal.anticlockwise(weights, high), self.best, self.tilt);
                }
                let before = self.best.tau;
                let r = self.support(bracket, plane)?;
                if !(self.best.tau > before && closed(&self.best, self.alpha)) {
                    portal.exchange(r)?;
                    continue;
                }
            }
            let found = self.best.close(bracket, self.frame, &portal.corners, &weights, high)?;
            portal.bound_entry(bracket, plane, high);
            return Ok(found);
        }
    }
}

/// Whether a point is on that side of the line.
#[inline(always)]
fn is_beyond<V: Vector>(toward: (V::Scalar, V::Scalar), p: &RayPoint<V>) -> bool {
    dot(toward, p.across()) > Scalar::ZERO
}

impl<V: Vector> Triangle<V> {
    /// Its plane, given the sum of the weights.
    #[inline(always)]
    fn plane(&self, sum: V::Scalar) -> RayPlane<V::Scalar> {
        let [p, q, s] = &self.corners;
        let RayPlane { a, b, .. } = RayPlane::through([p, q, s]);
        RayPlane { a: a * self.turn, b: b * self.turn, c: sum }
    }

    /// Puts a point before its plane in the place of the corner that leaves zero inside.
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

    /// Bounds the entry by its plane, if the line runs through it by more than an error.
    #[inline(always)]
    fn bound_entry(&self, bracket: &mut Bracket<'_, V>, RayPlane { a, b, c }: RayPlane<V::Scalar>, high: V::Scalar) {
        if is_surrounded(self.corners.each_ref(), bracket.error + bracket.noise) {
            bracket.pierce(high, (a * a + b * b + c * c).sqrt() / c);
        } else {
            bracket.doubt_entry();
        }
    }

    fn anticlockwise(&self, [wp, wq, ws]: [V::Scalar; 3], high: V::Scalar) -> OnLine<V> {
        let [p, q, s] = self.corners;
        let (corners, weights) =
            if self.turn > Scalar::ZERO { ([p, q, s], [wp, wq, ws]) } else { ([q, p, s], [wq, wp, ws]) };
        OnLine { corners, weights, high }
    }
}

/// The triangle of two points and one that is of the first of one shape and of the second of the other, if it contains
/// zero: where two edges cross, the line runs through the parallelogram of their ends.
fn mixed<V: Vector>(frame: &RayFrame<V>, p: &RayPoint<V>, q: &RayPoint<V>) -> Option<Triangle<V>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    if frame.radius > zero {
        return None;
    }
    let area = p.cross(q);
    let turn = one.copysign(area);
    [[p, q], [q, p]].into_iter().find_map(|[a, b]| {
        let witness = PointPair { a: a.witness.a, b: b.witness.b };
        let point = witness.a - witness.b;
        let s = frame.see(point, point, witness);
        let weights = [area.abs(), q.cross(&s) * turn, s.cross(p) * turn];
        (weights[1] > zero && weights[2] > zero).then_some(Triangle { corners: [s, *p, *q], weights, turn })
    })
}

/// The support point along a vector across the ray, if the plane there does not separate and the point is beyond the
/// line. If the line touches the body there, to rounding, it is moved a little farther inside.
#[cold]
#[inline(never)]
fn support_across<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    toward: (V::Scalar, V::Scalar),
) -> Result<RayPoint<V>, Stop<V>> {
    let across = frame.vector(toward).unit().ok_or(Stop::InDoubt)?;
    let p: RayPoint<_> = frame.support(bracket, across)?;
    bracket.advance(across, p.point)?;
    let beyond = (p.point - frame.line.foot).dot(across) + frame.radius;
    if beyond > Scalar::ZERO {
        return Ok(p);
    }
    let inward = bracket.noise * V::Scalar::from_f64(0.5);
    if bracket.radius == Scalar::ZERO && frame.line.foot == bracket.line().foot && beyond > -inward {
        return Err(Stop::Touches(-across * inward));
    }
    Err(Stop::InDoubt)
}

#[cfg(test)]
mod tests {
    use convex_support::Polytope;
    use convex_support::glam::DVec3;

    use super::*;
    use crate::RayCastOptions;
    use crate::cast::bracket::bracketed;
    use crate::cast::line::Line;

    /// The frame of a ray along −z: a point's coordinates are `u = x`, `v = −y`, `t = −z`.
    fn frame() -> RayFrame<DVec3> {
        RayFrame::new(Line { foot: DVec3::ZERO, direction: DVec3::NEG_Z })
    }

    fn seen(point: DVec3) -> RayPoint<DVec3> {
        frame().see(point, point, PointPair { a: point, b: DVec3::ZERO })
    }

    fn triangle_of(corners: [RayPoint<DVec3>; 3]) -> Triangle<DVec3> {
        let [p, q, s] = &corners;
        let turn = 1.0_f64.copysign(p.edge_to(q).0.0 * p.edge_to(s).0.1 - p.edge_to(q).0.1 * p.edge_to(s).0.0);
        let weights = [q.cross(s) * turn, s.cross(p) * turn, p.cross(q) * turn];
        Triangle { corners, weights, turn }
    }

    /// Triangles around zero of either orientation, and points on a grid, also on lines through zero and the corners:
    /// all products are whole numbers.
    #[test]
    fn an_exchange_leaves_zero_inside() {
        let corners = [DVec3::new(4.0, -3.0, 0.0), DVec3::new(-5.0, -2.0, 1.0), DVec3::new(1.0, 6.0, 2.0)].map(seen);
        let [p, q, s] = corners;
        for corners in [[p, q, s], [q, p, s]] {
            for (x, y) in (-8..=8).flat_map(|x| (-8..=8).map(move |y| (f64::from(x), f64::from(y)))) {
                let mut portal = triangle_of(corners);
                assert!(portal.weights.iter().all(|&weight| weight > 0.0));
                let r = seen(DVec3::new(x, y, 3.0));
                portal.exchange(r).expect("one of the three triangles");
                assert!(portal.weights.iter().all(|&weight| weight >= 0.0), "{x} {y}: {:?}", portal.weights);
                assert!(portal.corners.iter().any(|corner| corner.point == r.point), "{x} {y}");
                let known = triangle_of(portal.corners);
                if known.weights != [0.0; 3] {
                    assert_eq!((portal.weights, portal.turn), (known.weights, known.turn), "{x} {y}");
                }
            }
        }
    }

    /// The plane z = 3 + x/2 − y/4, which the ray crosses at t = −3.
    #[test]
    fn the_plane_of_a_portal_runs_through_its_corners() {
        let [p, q, s] =
            [(4.0, -3.0), (-5.0, -2.0), (1.0, 6.0)].map(|(x, y)| seen(DVec3::new(x, y, 3.0 + x / 2.0 - y / 4.0)));
        for corners in [[p, q, s], [q, p, s]] {
            let portal = triangle_of(corners);
            let plane = portal.plane(portal.weights.iter().sum());
            assert!(plane.c > 0.0, "its normal is against the ray");
            let alpha = plane.alpha();
            assert_eq!(corners.map(|corner| alpha.tau(&corner)), [-3.0; 3]);
            let OnLine { corners: [p, q, s], .. } = portal.anticlockwise(portal.weights, 0.0);
            assert!(triangle_of([p, q, s]).turn > 0.0);
        }
    }

    /// An edge of one shape along x and one of the other along y: the line runs through the parallelogram of the
    /// differences of their ends, here in the triangle with the corner (−1, −1).
    #[test]
    fn where_two_edges_cross_the_mixed_point_makes_a_portal() {
        let pair = |a: f64, b: f64| {
            let witness = PointPair { a: DVec3::new(a, 0.0, 1.0), b: DVec3::new(0.0, b, 0.0) };
            let point = witness.a - witness.b;
            frame().see(point, point, witness)
        };
        let (p, q) = (pair(-1.0, -1.0), pair(3.0, 1.0));
        let found = mixed(&frame(), &p, &q).expect("zero is in the triangle");
        assert_eq!(
            found.corners.map(|corner| corner.point),
            [(-1.0, -1.0), (-1.0, 1.0), (3.0, -1.0)].map(|(x, y)| DVec3::new(x, y, 1.0))
        );
        assert_eq!((found.weights, found.turn), (triangle_of(found.corners).weights, triangle_of(found.corners).turn));
        assert!(found.weights.iter().all(|&weight| weight > 0.0));
        assert!(mixed(&frame(), &p, &pair(3.0, -0.5)).is_none(), "the line is beside the parallelogram");
        assert!(mixed(&RayFrame { radius: 0.25, ..frame() }, &p, &q).is_none(), "a radius is not in the witness");
    }

    fn octahedron() -> Polytope<DVec3> {
        Polytope::new([DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis])).expect("an octahedron")
    }

    /// A search from the tangent plane of the ball, as [`super::super::portal`] begins it.
    fn search<R>(
        ray: (DVec3, DVec3),
        ask: impl FnOnce(&Bracket<'_, DVec3>, Result<RayContact<DVec3>, Stop<DVec3>>) -> R,
    ) -> R {
        bracketed(&octahedron(), ray, RayCastOptions::default(), |bracket| {
            let (frame, first) = (RayFrame::new(bracket.line()), bracket.x());
            let found = triangle(bracket, &frame, first, None, 1.0);
            ask(bracket, found)
        })
    }

    /// Points of the face −x + y − z = 1 of the octahedron, of few bits, and rays at them from there back by four times
    /// their direction: each enters at λ = 4 exactly.
    #[test]
    fn a_ray_into_a_face_has_both_bounds_at_its_plane() {
        let directions =
            [DVec3::X, DVec3::new(3.0, 1.0, 1.0), DVec3::new(16.0, 31.0, 16.0), DVec3::new(-7.0, -3.0, 5.0)];
        for (i, j) in (1..16).flat_map(|i| (1..16 - i).map(move |j| (i, j))) {
            let (y, z) = (f64::from(i) / 16.0, -f64::from(j) / 16.0);
            let (hit, direction) = (DVec3::new(y - z - 1.0, y, z), directions[(i + j) as usize % 4]);
            search((hit - direction * 4.0, direction), |bracket, found| {
                let contact = found.expect("a contact");
                let (lower, upper) = bracket.bounds(Some(bracket.ray.lambda(contact.mu)));
                assert!(lower <= 4.0 && 4.0 <= upper && upper - lower < 1e-13, "4 is not in [{lower}, {upper}]");
                let normal = contact.normal.expect("a normal");
                let depth = (upper - 4.0) * -normal.dot(direction);
                assert!(depth >= bracket.error, "there it is {depth} deep, and the face known to {}", bracket.error);
                assert!(normal.distance(DVec3::new(-1.0, 1.0, -1.0).normalize()) < 1e-15, "{normal}");
                assert!(contact.witness.a.distance(hit) < 1e-13, "{} is not {hit}", contact.witness.a);
                assert!(!bracket.is_entry_open() && bracket.around.is_some(), "three corners surround the line");
            });
        }
    }

    /// An edge and a corner are met by no more than two of the corners.
    #[test]
    fn a_ray_at_an_edge_or_a_corner_leaves_its_upper_bound_to_others() {
        for (y, z) in [(0.0, 0.0), (0.5, 0.0), (0.0, -0.25)] {
            search((DVec3::new(-4.0, y, z), DVec3::X), |bracket, found| {
                let contact = found.expect("a contact");
                let (known, (lower, _)) = (3.0 + y - z, bracket.bounds(Some(bracket.ray.lambda(contact.mu))));
                assert!(lower <= known && known - lower < 1e-13, "{known} {lower}");
                assert!(bracket.is_entry_open(), "{y} {z}");
            });
        }
    }

    /// Rays beside the octahedron, but within the ball about it: the plane has all corners behind it, and the ray
    /// before it.
    #[test]
    fn a_ray_beside_the_body_ends_at_a_plane_that_separates() {
        for (y, z) in [(0.5, 0.75), (-0.625, 0.5), (0.5, 0.53125), (0.75, -0.625)] {
            search((DVec3::new(-4.0, y, z), DVec3::X), |bracket, found| {
                let Err(Stop::Miss(n)) = found else { panic!("{y} {z} is not seen to miss") };
                let axis = bracket.axis_of_miss(n);
                assert!(axis.x.abs() < 1e-15 && axis.dot(DVec3::new(0.0, y, z)) > axis.abs().max_element(), "{axis}");
            });
        }
    }

    /// Along the edge between the corners on y and z, and one ulp beside it.
    #[test]
    fn a_line_that_touches_an_edge_to_rounding_is_to_be_moved_inward() {
        for z in [0.5, 0.5_f64.next_up()] {
            search((DVec3::new(-4.0, 0.5, z), DVec3::X), |bracket, found| {
                let Err(Stop::Touches(inward)) = found else { panic!("{z} is not seen to touch") };
                assert!(
                    inward.x == 0.0 && inward.dot(DVec3::ONE) < 0.0 && inward.length() <= bracket.noise,
                    "{inward}"
                );
            });
        }
    }
}
