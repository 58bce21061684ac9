//! The certain bounds on the first point of a ray in a body. Only this code decides about a miss, a lower bound, or
//! whether the two bounds have met, unless the shape has a [certain crossing](super::certain()). If the ray starts
//! within rounding of the body, `start.rs` measures again and may change the decision.
//!
//! A body lies behind each of its supporting planes, so that a ray is not in it before it has crossed the plane; and
//! a ray is in it, at the latest, where it meets a point made of support points. The searches choose where to look,
//! and may be wrong: their results count only as they are measured here.

use convex_support::{Scalar, Vector};
use num_traits::Float;

use super::line::{CastRay, Line, LocalRay};
use super::watched::Watched;
use super::{RayContact, Stop};
use crate::body::{CastBody, Measures, PointPair};
use crate::observer::Observer;
use crate::simplex::MAX_POINTS;
use crate::unit::{lost_to_underflow, power_of_two_near, reciprocal_of_power};
use crate::{Iterate, RayCastOptions, Status};

/// The largest tolerance, in sizes of the body.
const LARGEST_TOLERANCE: f64 = 16.0;

/// The cosine below which a plane counts as nearly along the line: its crossing has so many times fewer accurate
/// digits.
const LEANS: f64 = 1.0 / 64.0;

/// The reciprocal of a cosine up to which both bounds of a closed bracket, which are errors of 1, 1.5 and a noise times
/// as far from where they should be, are no farther apart than [`NARROW`].
const STEEP_SPREAD: f64 = 8.0;

/// How far rounding moves the points that a search compares, in units of ε times the size.
pub(super) const NOISE: f64 = 8.0;

/// The greatest depth at the upper bound of a converged answer, in errors.
pub(super) const NARROW: f64 = 40.0;

/// The same, in roundings of the way there. A ray that is cast back comes from sizes away, wherever its source is.
const NARROW_OF_WAY: f64 = 32.0;

/// The least depth, in errors, of a ray in a ball that rolls within the body, for its slope to prove where it is in
/// the body.
pub(super) const DEEP_ENOUGH: f64 = 64.0;

/// A support point of the core, with those of both shapes.
pub(super) type SupportPoint<V> = (V, PointPair<V>);

/// A parameter of the line, and its sensitivity to the plane or point that it is the crossing of.
#[derive(Clone, Copy, Debug)]
struct Bound<S> {
    at: S,
    /// How far it moves for every unit that the plane or point is moved across the surface: the reciprocal of a slope.
    spread: S,
    /// A further bound on its error, besides rounding.
    more: S,
}

impl<S: Scalar> Bound<S> {
    fn exact(at: S) -> Self {
        Self { at, spread: S::ZERO, more: S::ZERO }
    }
}

/// Where the ray crosses a plane that the body is behind.
#[derive(Clone, Copy, Debug)]
struct PlaneCrossing<S> {
    bound: Bound<S>,
    /// The cosine at which it is crossed.
    slope: S,
}

/// The part of a ray where its first point in a body may be.
pub(super) struct Bracket<'a, V: Vector> {
    pub(super) body: &'a mut dyn CastBody<Vector = V>,
    pub(super) ray: LocalRay<V>,
    pub(super) options: &'a RayCastOptions<V>,
    pub(super) radius: V::Scalar,
    /// The radius of a ball that rolls within all of the body.
    pub(super) rolling_radius: V::Scalar,
    /// How far rounding moves the points that the searches compare, or the line; a search ends at this width.
    pub(super) noise: V::Scalar,
    /// A bound on the error of a plane or a point.
    ///
    /// With `u = ε/2`, a point of the line loses `8u` of the size, `n·(x − p) − r` another `8u`, and the quotient by
    /// the slope `6u` of at most twice the size divided by the slope: with the support points' own error, one and a
    /// half times the noise.
    pub(super) error: V::Scalar,
    /// Whether the core is a single point.
    pub(super) is_point: bool,
    /// Whether the [Hessian](crate::body::TracedSupport::hessian) of the core may be anything but zero.
    pub(super) is_curved: bool,
    /// The unit of length.
    pub(super) scale: V::Scalar,
    observer: Observer<'a, V>,
    /// The bracket that the observer sees, if there is one.
    watched: Option<Watched<V>>,
    /// The number of support points taken.
    pub(super) iterations: usize,
    /// The body lies in a ball about its origin: the squared half of the chord that it cuts out of the line, negative
    /// where the line misses it, and the half, which is then zero.
    chord: (V::Scalar, V::Scalar),
    /// The crossing of the last plane.
    low: PlaneCrossing<V::Scalar>,
    /// The unit normal of that plane; `None` as long as no plane was crossed.
    normal: Option<V>,
    /// Where the ray is in the body, at the latest.
    high: Bound<V::Scalar>,
    entry: EntryProof,
    /// How deep the ray is behind a further plane at the upper bound, or before it.
    depth: V::Scalar,
    /// Where the line enters the hull of known points of the body.
    hull: V::Scalar,
    /// Three points of the body that surround the line as seen along it, two in the plane, if a search found them.
    pub(super) around: Option<[V; 3]>,
}

/// How certain the upper bound is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum EntryProof {
    /// The ray is in the body there, whatever the errors.
    Certain,
    /// The ray is in the body there if the surface has the same slope within an error.
    BySlope,
    /// An edge, or a graze, may be within an error.
    InDoubt,
}

impl<'a, V: Vector> Bracket<'a, V> {
    /// The part of a ray within the ball about the body.
    #[inline(always)]
    pub(super) fn new(
        body: &'a mut dyn CastBody<Vector = V>,
        CastRay { ray, direction_error, part }: CastRay<V>,
        options: &'a RayCastOptions<V>,
        observer: &'a mut Observer<'_, V>,
    ) -> Self {
        let number = V::Scalar::from_f64;
        let zero = V::Scalar::ZERO;
        let Measures { origin, radius, extent, rolling_radius, error: body_error } = body.measures();
        let size = extent + radius;
        let measure = if size > zero { size } else { (ray.source - origin).norm() };
        let scale = power_of_two_near(measure);
        body.set_scale(scale);
        let is_curved = body.is_curved();
        let per_unit = reciprocal_of_power(scale);
        let (radius, size) = (radius * per_unit, size * per_unit);
        let body_error = body_error * per_unit + lost_to_underflow(scale);
        let ray = LocalRay::new(ray, origin, scale).part(part);
        let noise = number(NOISE) * V::Scalar::EPSILON * size + ray.lost;
        let noise = if size > zero { noise } else { noise + body_error };
        let turned = if direction_error > zero { direction_error * (ray.start.abs() + size + size) } else { zero };
        let error = number(1.5) * noise + body_error + turned;
        let reach = size + error + error;
        let squared = reach * reach - ray.line.foot.length_squared();
        // NaN, of an invalid body, stays NaN.
        let half_chord = if squared < zero { zero } else { squared.sqrt() };
        Self {
            body,
            ray,
            options,
            radius,
            rolling_radius: rolling_radius * per_unit,
            noise,
            error,
            is_point: extent == zero,
            is_curved,
            scale,
            observer: observer.by_ref(),
            watched: None,
            iterations: 0,
            chord: (squared, half_chord),
            low: PlaneCrossing { bound: Bound::exact(ray.start.max(-half_chord)), slope: zero },
            normal: None,
            high: Bound::exact(V::Scalar::infinity()),
            entry: EntryProof::BySlope,
            depth: V::Scalar::infinity(),
            hull: V::Scalar::infinity(),
            around: None,
        }
    }

    pub(super) fn line(&self) -> Line<V> {
        self.ray.line
    }

    /// The place of the lower bound on the line.
    pub(super) fn low(&self) -> V::Scalar {
        self.low.bound.at
    }

    /// The earliest place of the lower bound that rounding allows.
    pub(super) fn earliest(&self) -> V::Scalar {
        self.low.bound.at - self.noise * self.low.bound.spread
    }

    /// The point of the line there (the paper's x).
    pub(super) fn x(&self) -> V {
        self.ray.line.at(self.low())
    }

    /// The cosine at which the last plane is crossed; or 1 if there was none, as for a ray within the plane of a face:
    /// then the bracket begins where the ray does.
    fn slope_or_one(&self) -> V::Scalar {
        if self.low.slope > Scalar::ZERO { self.low.slope } else { Scalar::ONE }
    }

    /// The reciprocal of that.
    fn spread_or_one(&self) -> V::Scalar {
        if self.low.slope > Scalar::ZERO { self.low.bound.spread } else { Scalar::ONE }
    }

    /// Whether other means must prove that the ray is in the body anywhere, for an upper bound.
    pub(super) fn is_entry_open(&self) -> bool {
        match self.entry {
            EntryProof::Certain => false,
            EntryProof::BySlope => !self.enters_ball(),
            EntryProof::InDoubt => true,
        }
    }

    /// Whether the ray enters so steeply that it is certainly soon in a ball that rolls within the body.
    ///
    /// A point of the body no more than `3e` below a plane that supports it is in such a ball, of radius `ρ`, no more
    /// than `√(6ρe)` beside its top, where the ball falls off at `√(6e/ρ)`: less than a third of a slope `s` with
    /// `s²ρ > 64e`. A ray that comes within `e` of the point at that slope, and may be as far outside of the ball, is
    /// in it after `3e/2s`.
    fn enters_ball(&self) -> bool {
        let Bound { spread, more, .. } = self.high;
        let radius = self.rolling_radius;
        spread == Scalar::ZERO || radius > (self.error + more) * spread * spread * V::Scalar::from_f64(DEEP_ENOUGH)
    }

    /// Records that an edge, or a graze, may be within an error of where the ray enters.
    pub(super) fn doubt_entry(&mut self) {
        self.entry = EntryProof::InDoubt;
    }

    /// Moves the upper bound to where the ray is certainly in the body.
    pub(super) fn enter_for_certain(&mut self, mu: V::Scalar) {
        (self.high, self.entry) = (Bound::exact(mu.max(self.low())), EntryProof::Certain);
    }

    /// Moves the upper bound to where the ray pierces a triangle of points of the body that surrounds it by more than
    /// an error. Its slope gives the length of a normal that is 1 against the ray, and the upper bound is known to an
    /// error across it.
    pub(super) fn pierce(&mut self, mu: V::Scalar, length: V::Scalar) {
        (self.high, self.entry) =
            (Bound { at: mu.max(self.low()), spread: length, more: Scalar::ZERO }, EntryProof::Certain);
    }

    /// The place on the line of the body's point at a contact, and how far the point may be from it.
    pub(super) fn point_near_line(&self) -> (V::Scalar, V::Scalar) {
        (self.high.at, self.error + self.noise + self.high.more)
    }

    /// Whether the ray is certainly before the last plane where it begins.
    pub(super) fn is_past_start(&self) -> bool {
        self.low() - self.certain(self.low.bound) > self.ray.start
    }

    /// How far the bounds may stay apart, across the last plane: at most some sizes of the body, so that an infinite
    /// bound, if nothing is known, is never near enough.
    pub(super) fn tolerance(&self) -> V::Scalar {
        self.noise.max(self.options.tolerance).min(Scalar::from_f64(LARGEST_TOLERANCE))
    }

    /// How deep the body may be entered at the upper bound of a converged answer. It is half of what `docs/evidence.md`
    /// says of both bounds.
    pub(super) fn narrow(&self) -> V::Scalar {
        let number = V::Scalar::from_f64;
        let way = (self.low() - self.ray.start).max(Scalar::ZERO);
        self.error * number(NARROW) + way * V::Scalar::EPSILON * number(NARROW_OF_WAY) + self.tolerance()
    }

    /// Whether a bound is of a surface so nearly along the line that both may be far apart.
    #[inline(always)]
    pub(super) fn leans(&self) -> bool {
        // NaN leans.
        !(self.low.bound.spread.max(self.high.spread) <= V::Scalar::from_f64(STEEP_SPREAD))
    }

    /// Where the bounds are on the line, wider by what rounding moved them.
    pub(super) fn ends(&self) -> [V::Scalar; 2] {
        let earliest = self.low() - self.certain(self.low.bound);
        [earliest.max(self.ray.start), self.high.at + self.delay()]
    }

    /// Remembers how deep the body is entered at the upper bound by the last plane, before another one is.
    pub(super) fn keep_depth(&mut self) {
        let depth = (self.ends()[1] - self.low()) * self.slope_or_one();
        self.depth = if depth < self.depth { depth } else { self.depth };
    }

    /// Whether a converged answer may have this upper bound. The ray is no deeper in the body than behind a plane that
    /// supports it.
    pub(super) fn is_narrow(&self, upper: V::Scalar) -> bool {
        let narrow = self.narrow();
        (upper - self.low()) * self.slope_or_one() <= narrow || self.depth <= narrow
    }

    /// Measures the depth at the upper bound behind the plane across the unit vector `n`, and returns the point where
    /// that supports the body.
    pub(super) fn measure_depth(&mut self, n: V) -> Option<V> {
        let (point, _) = self.support(n, n, &[]).ok()?;
        let point = point + n * self.radius;
        let depth = n.dot(point - self.ray.line.at(self.high.at)).abs();
        self.depth = if depth < self.depth { depth } else { self.depth };
        Some(point)
    }

    /// Where on the line the ray ends, or leaves the ball about the body.
    pub(super) fn end(&self) -> V::Scalar {
        self.chord.1.min(self.ray.mu(self.options.max_lambda))
    }

    /// A ray that misses the ball about the body misses the body: it begins behind the ball, ends before it, or passes
    /// it.
    #[inline(always)]
    pub(super) fn enter_ball(&self) -> Result<(), Stop<V>> {
        let LocalRay { line, start, .. } = self.ray;
        // The plane through the ray's point closest to the ball is before all of it.
        if start > self.chord.1 {
            Err(Stop::Miss(line.at(start).unit().unwrap_or(line.direction)))
        } else if self.is_past_end(self.low.bound) {
            let end = line.at(self.ray.mu(self.options.max_lambda));
            Err(Stop::Miss(end.unit().unwrap_or(-line.direction)))
        } else if self.chord.0 < Scalar::ZERO {
            // Its part along the line, which rounding leaves, would count far from here.
            Err(Stop::Miss(line.across(line.foot).unit().unwrap_or(line.direction)))
        } else {
            Ok(())
        }
    }

    /// The support point of the core along any vector `n`, with those of both shapes.
    ///
    /// An observer sees it beside `v`, the vector that led to `n`, and the points of the simplex that `v` is of.
    #[inline(always)]
    pub(super) fn support(&mut self, n: V, v: V, simplex: &[V]) -> Result<SupportPoint<V>, Stop<V>> {
        if self.iterations >= self.options.max_iterations {
            return Err(Stop::Exhausted(Status::IterationLimit));
        }
        let (point, witness) = self.body.support(n);
        self.iterations += 1;
        if !self.observer.is_none() {
            self.show(n, point, v, simplex);
        }
        if point.is_finite() { Ok((point, witness)) } else { Err(Stop::Exhausted(Status::Stalled)) }
    }

    /// Shows the observer the support point along `n`, beside `v` and the points of its simplex.
    #[cold]
    #[inline(never)]
    fn show(&mut self, n: V, point: V, v: V, simplex: &[V]) {
        let x = self.x();
        let (line, radius) = (self.ray.line, self.radius);
        let watched = self.watched.get_or_insert_with(|| Watched::new(line));
        let [low, high] = watched.narrow([self.low.bound.at, self.high.at], n, point, radius);
        let mut seen = [V::ZERO; MAX_POINTS];
        for (s, p) in seen.iter_mut().zip(simplex) {
            *s = x - *p;
        }
        let (lower, upper) = (self.ray.lambda(low), self.ray.lambda(high));
        let simplex = &seen[..simplex.len().min(MAX_POINTS)];
        let iteration = self.iterations - 1;
        self.observer.show(|| Iterate { iteration, simplex, v, w: x - point, scale: self.scale, lower, upper });
    }

    /// A bound on how far rounding has moved a parameter of the line.
    fn certain(&self, Bound { spread, more, .. }: Bound<V::Scalar>) -> V::Scalar {
        (self.error + more) * spread
    }

    /// Whether the ray ends before a parameter of the line, even with the parameter's error.
    fn is_past_end(&self, bound: Bound<V::Scalar>) -> bool {
        self.ray.lambda(bound.at) - self.ray.error(bound.at, self.certain(bound)) > self.options.max_lambda
    }

    /// Moves the lower bound up to the plane across the unit vector `n` that supports the core at `point`, unless that
    /// ends the search.
    #[inline(never)]
    pub(super) fn advance(&mut self, n: V, point: V) -> Result<(), Stop<V>> {
        if let Some(crossing) = self.crossing(n, point)?
            && crossing.bound.at - self.noise * crossing.bound.spread >= self.earliest()
        {
            (self.low, self.normal) = (crossing, Some(n));
        }
        Ok(())
    }

    /// The search ends if the plane across `n` that supports the core at `point` has the rest of the ray before it;
    /// otherwise nothing changes. By rounding alone, the end of the ray may be where the hit is, and a ray that ends
    /// there finds the hit where a longer one does.
    #[cold]
    #[inline(never)]
    pub(super) fn separate(&self, n: V, point: V) -> Result<(), Stop<V>> {
        match n.unit() {
            Some(n) => self.crossing(n, point).map(drop),
            None => Ok(()),
        }
    }

    /// Where the ray crosses the plane across the unit vector `n` that supports the core at `point`, if that is ahead;
    /// or that the plane has the rest of the ray before it.
    ///
    /// The body is behind the plane `n·y = n·p + r`. A point `x` of the ray is before it by `n·(x − p) − r`, and if
    /// that is positive and the ray approaches, it crosses the plane after `(n·(x − p) − r)/(−n·d)`, and not before.
    #[inline(always)]
    fn crossing(&self, n: V, point: V) -> Result<Option<PlaneCrossing<V::Scalar>>, Stop<V>> {
        let zero = V::Scalar::ZERO;
        let ahead = n.dot(self.x() - point) - self.radius;
        let slope = n.dot(self.ray.line.direction);
        if ahead > zero && slope < zero {
            let per_slope = -slope.recip();
            let bound = Bound { at: self.low() + ahead * per_slope, spread: per_slope, more: zero };
            // By products: for a plane along the ray the quotients overflow.
            let leaves_first = ahead - self.error > (self.chord.1 - self.low()) * -slope;
            if leaves_first || self.is_past_end(bound) {
                return Err(Stop::Miss(n));
            }
            // A plane along the ray, to within its error, may be crossed anywhere. There is no hit beyond the ball, and
            // the rounding of a point of the line there is no longer relative to the size.
            let at = if bound.at < self.chord.1 { bound.at } else { self.chord.1 };
            return Ok(Some(PlaneCrossing { bound: Bound { at, ..bound }, slope: -slope }));
        }
        // The rest of the ray may begin earlier, where it is less far before a plane that it leaves.
        let at_earliest = ahead - slope.max(zero) * self.certain(self.low.bound);
        if at_earliest > self.error { Err(Stop::Miss(n)) } else { Ok(None) }
    }

    /// The contact where the last plane is crossed, of which a point of the body is known otherwise.
    pub(super) fn at_low(&self, witness: PointPair<V>) -> RayContact<V> {
        RayContact { mu: self.low(), normal: self.normal, witness }
    }

    /// The contact where the last plane is crossed, if a point made of `witness`, about which a ball of the radius is
    /// within the body, is no farther than that from the line at `high`, and that is no farther behind the plane than
    /// was asked for.
    #[inline(never)]
    pub(super) fn close(
        &mut self,
        radius: V::Scalar,
        point: V,
        witness: PointPair<V>,
        high: V::Scalar,
    ) -> Result<RayContact<V>, Stop<V>> {
        let aside = point - self.ray.line.at(high);
        let within = radius + self.noise;
        let gap = (high - self.low()) * self.slope_or_one();
        let closed = gap <= self.tolerance() && gap >= -self.noise;
        if !(closed && aside.length_squared() <= within * within) {
            return Err(Stop::InDoubt);
        }
        self.high = Bound { at: high.max(self.low()), spread: self.spread_or_one(), more: Scalar::ZERO };
        Ok(RayContact { mu: self.low_or_at(high), normal: self.normal, witness })
    }

    /// Where the last plane is crossed; of one nearly along the line, at the body's point at `mu` if that is before the
    /// crossing by no more than rounding may have moved it, since such a plane is crossed far from where it touches the
    /// body.
    fn low_or_at(&self, mu: V::Scalar) -> V::Scalar {
        let leans = self.low.slope < V::Scalar::from_f64(LEANS);
        if leans { self.low().min(mu.max(self.earliest()).max(self.ray.start)) } else { self.low() }
    }

    /// The contact at the source of the ray, if points of the body are known on both sides of it, by more than
    /// rounding.
    pub(super) fn close_inside(&mut self) -> RayContact<V> {
        let mu = self.ray.start;
        self.high = Bound::exact(mu);
        RayContact { mu, normal: None, witness: self.body.witness(self.ray.line.at(mu)) }
    }

    /// The contact where the last plane is crossed, if `v`, the shortest vector there from a point of the core made of
    /// `witness`, is no longer than the radius.
    pub(super) fn close_at_low(&mut self, v: V, witness: PointPair<V>) -> Option<RayContact<V>> {
        if !(v.norm() - self.radius <= self.noise) {
            return None;
        }
        self.high = Bound { at: self.low(), spread: self.spread_or_one(), more: Scalar::ZERO };
        let mut normal = self.normal;
        if self.low() > self.ray.start {
            // Where the search began and no plane was crossed, that of the ball about the body is the one.
            normal = normal.or_else(|| self.x().unit()).or(Some(-self.ray.line.direction));
        }
        Some(RayContact { mu: self.low(), normal, witness })
    }

    /// The contact of a line that grazes the body: it passes the core's `point` by the vector `v` across the line, and
    /// `v` is no longer than the radius and `within`. Then the line is no farther than `within` from a point of the
    /// body, whether or not a plane proves a lower bound there. The `normal` is that of a plane along the line, if one
    /// is known.
    pub(super) fn close_beside(
        &mut self,
        v: V,
        within: V::Scalar,
        point: V,
        witness: PointPair<V>,
        normal: Option<V>,
    ) -> Option<RayContact<V>> {
        if !(v.norm() - self.radius <= within) {
            return None;
        }
        let mu = point.dot(self.ray.line.direction);
        let mu = mu.max(self.low_or_at(mu));
        // What the line passes within an error it may as well miss.
        self.high = Bound { more: within, ..Bound::exact(mu.max(self.low())) };
        self.doubt_entry();
        // Where the ray grazes what is round, the shortest vector is the normal, and the last plane is of elsewhere.
        // Without a radius it has no digits.
        let normal = if self.radius > self.noise { v.unit() } else { normal.or(self.normal) };
        Some(RayContact { mu, normal, witness })
    }

    /// Moves the upper bound to where the line enters the hull of known points of the body, at `mu` to within `error`
    /// across a surface that it meets at the cosine `slope`.
    pub(super) fn enter_hull(&mut self, mu: V::Scalar, error: V::Scalar, slope: V::Scalar) {
        // A point of the facet may be outside of the body by rounding, and is in it where the ray is that far behind
        // the plane that is crossed less steeply.
        self.high = Bound { at: mu.max(self.low()), spread: self.spread_at(slope), more: error };
        self.hull = mu;
    }

    /// How far a crossing moves where the surface is met at the cosine `slope` and the last plane perhaps less steeply;
    /// infinitely far, of a surface that the ray does not enter.
    fn spread_at(&self, slope: V::Scalar) -> V::Scalar {
        let least = if self.low.slope > Scalar::ZERO { slope.min(self.low.slope) } else { slope };
        if least > Scalar::ZERO { least.recip() } else { Float::infinity() }
    }

    /// How far the bounds are apart, across the last plane or across the surface that the line meets at the cosine
    /// `slope`.
    pub(super) fn gap_to_hull(&self, slope: V::Scalar) -> V::Scalar {
        (self.high.at - self.low()) * slope.max(self.low.slope)
    }

    /// The contact where the last plane is crossed, if the bounds are no farther apart than `wanted` across it or
    /// across the surface that the line meets at the cosine `slope` behind it.
    pub(super) fn close_to_hull(
        &self,
        slope: V::Scalar,
        wanted: V::Scalar,
        witness: impl FnOnce() -> PointPair<V>,
    ) -> Option<RayContact<V>> {
        let mu = self.low_or_at(self.hull);
        (self.gap_to_hull(slope) <= wanted).then(|| RayContact { mu, normal: self.normal, witness: witness() })
    }

    /// The contact where the last plane is crossed, given that points of the body surround the line there: the surface
    /// between them is met at the cosine `slope`, and is known to within `error` across itself.
    pub(super) fn close_between(&mut self, error: V::Scalar, slope: V::Scalar, witness: PointPair<V>) -> RayContact<V> {
        let Bound { at, spread, .. } = self.low.bound;
        let is_crossed_here = error == Scalar::ZERO && spread > Scalar::ZERO;
        self.high = Bound { at, spread: if is_crossed_here { spread } else { self.spread_at(slope) }, more: error };
        RayContact { mu: at, normal: self.normal, witness }
    }

    /// How much later the upper bound may be. The surface may be met less steeply than the plane, by what noise leaves
    /// open.
    fn delay(&self) -> V::Scalar {
        let certain = self.certain(self.high) + self.noise * self.high.spread;
        if self.entry == EntryProof::BySlope { certain * Scalar::from_f64(1.5) } else { certain }
    }

    /// Bounds on λ, for the λ of a contact if there is one, wider by what rounding moved them. The upper one is
    /// infinite where the ray is not known to be in the body anywhere, as where it grazes it.
    pub(super) fn bounds(&self, contact: Option<V::Scalar>) -> (V::Scalar, V::Scalar) {
        let widened = |bound: Bound<_>| self.ray.error(bound.at, self.certain(bound));
        // A λ that overflows, or is NaN, bounds nothing.
        let lower = self.ray.lambda(self.low()) - widened(self.low.bound);
        let lower = if lower < V::Scalar::infinity() { lower.max(Scalar::ZERO) } else { Scalar::ZERO };
        let upper = self.ray.lambda(self.high.at) + self.ray.error(self.high.at, self.delay());
        match contact {
            // NaN bounds nothing.
            Some(lambda) if self.is_entry_open() || upper.is_nan() => (lower.min(lambda), Float::infinity()),
            Some(lambda) => (lower, upper.max(lambda)),
            None if lower <= upper => (lower, if self.is_entry_open() { Float::infinity() } else { upper }),
            // Bounds that contradict one another, or are NaN, bound nothing.
            None => (Scalar::ZERO, Float::infinity()),
        }
    }

    /// The axis of a plane before the whole ray, given one that is before what the last plane has left of it.
    ///
    /// A plane that comes nearer behind `x`, or crosses the ray ahead of it, leaves that to the last plane, or to the
    /// ball. Both together are before the whole line: with slopes of opposite sign, `n·|m·d| + m·|n·d|` has none.
    pub(super) fn axis_of_miss(&self, n: V) -> V {
        let LocalRay { line, start, .. } = self.ray;
        if self.iterations == 0 {
            return n;
        }
        let zero = V::Scalar::ZERO;
        let slope = n.dot(line.direction);
        let other = if slope > zero && self.low() > start {
            self.normal.or_else(|| self.x().unit())
        } else if slope < zero && self.ray.lambda(self.chord.1) <= self.options.max_lambda {
            line.at(self.chord.1).unit()
        } else {
            None
        };
        let other = other.filter(|m| (m.dot(line.direction) > zero) == (slope < zero));
        other.and_then(|m| (n * m.dot(line.direction).abs() + m * slope.abs()).unit()).unwrap_or(n)
    }
}

#[cfg(test)]
pub(super) use tests::bracketed;

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec3;
    use convex_support::{Cuboid, SupportMap};

    use super::*;
    use crate::body::Single;
    use crate::cast::Part;
    use crate::{Outcome, Ray, ray_cast};

    /// What the bracket of a ray at a shape tells.
    pub(in crate::cast) fn bracketed<R>(
        shape: &impl SupportMap<Vector = DVec3>,
        (source, direction): (DVec3, DVec3),
        options: RayCastOptions<DVec3>,
        ask: impl FnOnce(&mut Bracket<'_, DVec3>) -> R,
    ) -> R {
        let (mut body, mut observer) = (Single::new(shape), Observer::none());
        let ray = CastRay::of(Ray { source, direction }, Part::Whole);
        ask(&mut Bracket::new(&mut body, ray, &options, &mut observer))
    }

    /// The cube of half size 1 about zero, whose unit is 1: places on a line along x are those of x.
    fn at_cube<R>(ray: (DVec3, DVec3), max_lambda: f64, ask: impl FnOnce(&mut Bracket<'_, DVec3>) -> R) -> R {
        let cube = Cuboid::new(DVec3::ONE).expect("a cube");
        let options = RayCastOptions::default().with_max_lambda(max_lambda).with_tolerance(1e-3);
        bracketed(&cube, ray, options, ask)
    }

    /// A ray at the face x = −1 of the cube.
    const AT_FACE: (DVec3, DVec3) = (DVec3::new(-3.0, 0.25, 0.125), DVec3::X);
    const CORNER: DVec3 = DVec3::new(-1.0, 1.0, 1.0);

    #[test]
    fn the_lower_bound_is_the_plane_that_is_crossed_last() {
        at_cube(AT_FACE, f64::INFINITY, |bracket| {
            bracket.advance(DVec3::NEG_X, CORNER)?;
            // The plane across (−1, 1, 0) is crossed at x = −7/4.
            bracket.advance(DVec3::new(-1.0, 1.0, 0.0).normalize(), CORNER)?;
            assert_eq!((bracket.low(), bracket.normal), (-1.0, Some(DVec3::NEG_X)));
            Ok::<_, Stop<_>>(())
        })
        .expect("neither plane is before the ray");
    }

    /// Rays into the face x = −1, less and less squarely. The point that they hit, their direction and λ have few bits,
    /// so that the source has as well, and this λ is that of the first point in the cube exactly.
    #[test]
    fn bounds_widen_with_the_slant_of_a_crossing_and_hold_it() {
        for i in 0..80 {
            let steep = 2.0_f64.powi(i / 4);
            let (direction, known) = (DVec3::new(1.0, steep, 3.0), f64::from(4 + i % 4) / steep);
            let hit = DVec3::new(-1.0, f64::from(i) / 128.0 - 0.25, 0.375);
            at_cube((hit - direction * known, direction), f64::INFINITY, |bracket| {
                bracket.advance(DVec3::NEG_X, CORNER).expect("a plane that is crossed");
                bracket.pierce(bracket.low(), direction.length());
                let (lower, upper) = bracket.bounds(Some(bracket.ray.lambda(bracket.low())));
                assert!(lower <= known && known <= upper, "{known} is not in [{lower}, {upper}]");
                assert!(upper - lower < 1e-13, "[{lower}, {upper}] about {known}");
            });
        }
    }

    /// The ray passes over the top at y = 3/2, and one within rounding of the top may touch it.
    #[test]
    fn a_plane_before_the_rest_of_the_ray_proves_a_miss_and_one_within_rounding_does_not() {
        for (y, misses) in [(1.5, true), (1.0 + 1e-12, true), (1.0_f64.next_up(), false), (1.0, false), (0.5, false)] {
            let found = at_cube((DVec3::new(-3.0, y, 0.0), DVec3::X), f64::INFINITY, |bracket| {
                bracket.advance(DVec3::Y, DVec3::ONE)
            });
            assert_eq!(matches!(found, Err(Stop::Miss(DVec3::Y))), misses, "{y}");
        }
    }

    /// The face is at λ = 2.
    #[test]
    fn a_ray_that_ends_before_a_plane_misses_unless_rounding_decides() {
        for (end, misses) in [(1.75, true), (2.0 - 1e-12, true), (2.0_f64.next_down(), false), (2.0, false)] {
            let found = at_cube(AT_FACE, end, |bracket| bracket.advance(DVec3::NEG_X, CORNER));
            assert_eq!(matches!(found, Err(Stop::Miss(DVec3::NEG_X))), misses, "{end}");
        }
    }

    /// Such a plane would be crossed at x = 2⁹⁰⁸, where the cube has no points, and rounding leaves open where: it is
    /// no bound.
    #[test]
    fn a_plane_along_the_ray_is_crossed_within_the_ball_about_the_body() {
        let n = DVec3::new(-(2.0_f64.powi(-960)), 1.0, 0.0);
        at_cube((DVec3::new(-3.0, 1.0_f64.next_up(), 0.0), DVec3::X), f64::INFINITY, |bracket| {
            let crossing = bracket.crossing(n, CORNER).expect("the plane may touch the ray, to rounding");
            assert_eq!(crossing.map(|crossing| crossing.bound.at), Some(bracket.end()));
            let before = bracket.low();
            bracket.advance(n, CORNER).expect("the same");
            assert_eq!((bracket.low(), bracket.end()), (before, -before));
        });
    }

    #[test]
    fn a_ray_that_misses_the_ball_about_the_body_takes_no_support_point() {
        let start = |x: f64, y: f64| (DVec3::new(x, y, 0.0), DVec3::X);
        for (ray, end, axis) in [
            (start(-3.0, 2.0), f64::INFINITY, DVec3::Y),
            (start(2.0, 0.0), f64::INFINITY, DVec3::X),
            (start(-3.0, 0.0), 1.0, DVec3::NEG_X),
        ] {
            at_cube(ray, end, |bracket| {
                assert!(matches!(bracket.enter_ball(), Err(Stop::Miss(n)) if n == axis), "{ray:?} {end}");
                assert_eq!(bracket.iterations, 0);
            });
        }
        at_cube(AT_FACE, f64::INFINITY, |bracket| assert!(bracket.enter_ball().is_ok()));
    }

    /// The ray at y = 5/4 crosses the plane across (−1, 1, 0) at x = −3/4, and leaves the one across (1/8, 1, 0), which
    /// it is before from there on. Neither plane is before the whole line; y = 1 is.
    #[test]
    fn two_planes_that_are_before_parts_of_a_ray_make_one_before_all_of_it() {
        at_cube((DVec3::new(-3.0, 1.25, 0.0), DVec3::X), f64::INFINITY, |bracket| {
            bracket.support(DVec3::NEG_X, DVec3::NEG_X, &[]).expect("a support point");
            bracket.advance(DVec3::new(-1.0, 1.0, 0.0).normalize(), CORNER).expect("a plane that is crossed");
            let Err(Stop::Miss(n)) = bracket.advance(DVec3::new(0.125, 1.0, 0.0).normalize(), DVec3::ONE) else {
                panic!("the plane is before the rest of the ray");
            };
            assert!(bracket.axis_of_miss(n).distance(DVec3::Y) < 1e-15);
        });
    }

    /// The tolerance is 1/1000, and the plane x = −1.
    #[test]
    fn a_bracket_closes_at_a_point_on_the_line_within_the_tolerance() {
        let closes = |behind: f64, aside: f64| {
            at_cube(AT_FACE, f64::INFINITY, |bracket| {
                bracket.advance(DVec3::NEG_X, CORNER).expect("a plane that is crossed");
                let (mu, noise) = (bracket.low() + behind, bracket.noise);
                let point = bracket.line().at(mu) + DVec3::Y * (aside * noise);
                let found = bracket.close(0.0, point, PointPair::ZERO, mu).ok();
                found.inspect(|contact| assert_eq!((contact.mu, contact.normal), (-1.0, Some(DVec3::NEG_X)))).is_some()
            })
        };
        assert!(closes(0.0, 0.0) && closes(0.9e-3, 0.0) && closes(0.0, 0.5));
        assert!(!closes(1.1e-3, 0.0), "the point is too far behind the plane");
        assert!(!closes(-1e-12, 0.0), "the point is before the plane");
        assert!(!closes(0.0, 2.0), "the point is beside the line");
    }

    #[test]
    fn an_entry_in_doubt_has_no_upper_bound_until_it_is_certain() {
        at_cube(AT_FACE, f64::INFINITY, |bracket| {
            bracket.advance(DVec3::NEG_X, CORNER).expect("a plane that is crossed");
            bracket.enter_hull(-1.0, 0.0, 1.0);
            assert!(bracket.is_entry_open(), "no ball rolls in a cube");
            assert_eq!(bracket.bounds(Some(2.0)).1, f64::INFINITY);
            bracket.enter_for_certain(-0.5);
            bracket.doubt_entry();
            assert_eq!(bracket.bounds(Some(2.0)).1, f64::INFINITY);
            bracket.enter_for_certain(-0.5);
            let (_, upper) = bracket.bounds(Some(2.0));
            assert!((2.5..2.5 + 1e-14).contains(&upper), "{upper}");
        });
    }

    /// A ball about zero that knows its support points alone, so that every bound is a search's.
    struct Bare;

    impl SupportMap for Bare {
        type Vector = DVec3;

        fn support(&self, direction: DVec3) -> DVec3 {
            direction.normalize_or_zero()
        }
    }

    /// A supporting plane bounds the first point of a ray from below, and a point of the body from above, also where
    /// the ray nearly grazes it, and both are far from one another.
    #[test]
    fn bounds_hold_the_first_point_of_a_ray_in_a_ball() {
        for i in 0..200 {
            let aside = 1.0 - 0.5_f64.powi(i / 4) * (1.0 + f64::from(i % 4) / 8.0);
            let ray = Ray { source: DVec3::new(-3.0, aside, 0.0), direction: DVec3::X };
            let cast = ray_cast(&Bare, ray, RayCastOptions::default()).expect("a ray");
            let known = 3.0 - ((1.0 - aside) * (1.0 + aside)).sqrt();
            match cast.outcome {
                Outcome::Hit(_) => assert!(cast.lower <= known && known <= cast.upper, "{aside} {known} {cast:?}"),
                _ => assert!(cast.lower <= known, "{aside} {known} {cast:?}"),
            }
        }
    }
}
