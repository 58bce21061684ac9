//! Algorithm 3 on a core: the ray cast that [`ray_cast`](crate::ray_cast) and [`linear_cast`](crate::linear_cast) share.
//!
//! The paper's loop moves a point `x` along the ray up to one supporting plane of the body after another, and finds the
//! planes by GJK steps towards `x`. Four things are added to it here; `docs/ray-cast.md` derives them.
//!
//! - In 3D, a quicker search is tried first (`portal.rs`, `swept.rs`); the one described here is what remains where that is
//!   in doubt.
//! - As soon as the simplex of support points is pierced by the ray, the hit is bracketed: behind the last plane, and
//!   before the point where the ray enters the simplex. From then on, the simplex is refined where it is pierced
//!   ([`Search::refine`]), and no vector has to tend to zero.
//! - Where the ray runs nearly along the planes, a step along it gains nothing, and the steps of GJK are taken across
//!   the ray, with the whole line for `x`.
//! - A radius is never made of support points: the simplex is swept by it.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::{Body, power_of_two_near};
use crate::closest::{Closest, nearest_face};
use crate::decrease::Decrease;
use crate::entry::{Entry, entry};
use crate::line::LocalRay;
use crate::ray_cast::Ray;
use crate::simplex::{MAX_POINTS, Simplex};
use crate::turn::{Condition, Found, Recent, Turn, turn};
use crate::{CastMethod, Iterate, Miss, Outcome, RayCastOptions, Status};

/// A hit, as the search knows it.
pub(crate) struct Contact<V: Vector, W> {
    pub(crate) lambda: V::Scalar,
    pub(crate) normal: Option<V>,
    /// The points of the core whose weighted sum lies below the hit spot.
    pub(crate) simplex: Simplex<V, W>,
}

/// What [`cast`] found; λ in units of the ray's direction.
pub(crate) struct Cast<V: Vector, W> {
    pub(crate) outcome: Outcome<Contact<V, W>, V>,
    pub(crate) lower: V::Scalar,
    pub(crate) upper: V::Scalar,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    /// The unit of the simplex.
    pub(crate) scale: V::Scalar,
}

pub(crate) type ScalarOf<B> = <<B as Body>::Vector as Vector>::Scalar;

/// Casts a ray, given in the world, against a body.
pub(crate) fn cast<B: Body>(
    body: &mut B,
    ray: Ray<B::Vector>,
    options: RayCastOptions<B::Vector>,
    observer: impl FnMut(Iterate<'_, B::Vector>),
) -> Cast<B::Vector, B::Witness> {
    let number = ScalarOf::<B>::from_f64;
    let (zero, infinity) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::infinity());
    let origin = body.origin();
    let extent = body.extent();
    let size = extent + body.radius();
    let scale = power_of_two_near(if size > zero { size } else { (ray.source - origin).norm() });
    body.set_scale(scale);
    let radius = body.radius() / scale;
    let noise = number(8.0) * ScalarOf::<B>::EPSILON * (size / scale);
    let local = LocalRay::new(ray, origin, scale);

    // The body lies in a ball about its origin. A line that misses the ball misses the body, and on one that does not,
    // only the chord matters.
    let reach = size / scale * (ScalarOf::<B>::ONE + number(16.0) * ScalarOf::<B>::EPSILON);
    let across = local.line.foot.norm();
    let half_chord = ((reach - across).max(zero) * (reach + across)).sqrt();
    let low = local.start.max(-half_chord);

    let mut search = Search {
        body,
        local,
        radius,
        noise,
        options,
        half_chord,
        is_point: extent == zero,
        scale,
        low,
        low_error: zero,
        low_slope: zero,
        high: infinity,
        high_error: zero,
        touched: None,
        normal: None,
        simplex: Simplex::new(),
        v: local.line.at(low),
        observer,
        iterations: 0,
    };
    // Of a ray that misses the ball, the plane through its point closest to the ball is before all of it.
    let end = if local.start > half_chord {
        End::Miss(local.line.at(local.start).unit().unwrap_or(local.line.direction))
    } else if search.is_beyond(low, zero) {
        End::Miss((ray.at(options.max_lambda) - origin).unit().unwrap_or(-local.line.direction))
    } else if across > reach {
        End::Miss(local.line.foot / across)
    } else {
        search.run()
    };

    let Search { low, low_error, high, high_error, touched, normal, simplex, iterations, .. } = search;
    let hit_at = touched.unwrap_or(low);
    let started_in = hit_at <= local.start;
    let lambda = if started_in { zero } else { local.lambda(hit_at).max(zero) };
    // What rounding moved a crossing by, and as much again: the support points were rounded before they came here.
    let lower = (local.lambda(low) - local.error(low, low_error + low_error)).max(zero);
    let upper = match end {
        End::Contact if started_in => zero,
        _ => (local.lambda(high) + local.error(high, high_error + high_error)).max(lambda),
    };
    let hit = || Outcome::Hit(Contact { lambda, normal, simplex });
    let miss = |axis| Outcome::Miss(Miss { axis });
    let (outcome, status) = match end {
        End::Miss(n) => {
            // A plane that comes nearer behind x, or crosses the ray ahead of it, leaves that to the last plane, or to the
            // ball. Both together are before the whole line: with slopes of opposite sign, n·|m·d| + m·|n·d| has none.
            let (d, slope) = (local.line.direction, n.dot(local.line.direction));
            let other = if slope > zero && low > local.start {
                normal.or_else(|| local.line.at(low).unit())
            } else if slope < zero && local.lambda(half_chord) <= options.max_lambda {
                local.line.at(half_chord).unit()
            } else {
                None
            };
            let other = other.filter(|m| (m.dot(d) > zero) == (slope < zero));
            let axis = other.and_then(|m| (n * m.dot(d).abs() + m * slope.abs()).unit());
            (miss(if iterations > 0 { axis.unwrap_or(n) } else { n }), Status::Converged)
        }
        // Whether a hit at the very end of the ray counts is decided by λ as it is returned.
        End::Contact if lambda > options.max_lambda => {
            (miss(normal.unwrap_or(-local.line.direction)), Status::Converged)
        }
        End::Contact => (hit(), Status::Converged),
        End::Open(status) if high < infinity && upper <= options.max_lambda => (hit(), status),
        End::Open(status) => (Outcome::Undecided, status),
    };
    let (lower, upper) = match end {
        End::Miss(_) => (infinity, infinity),
        _ => (lower, upper),
    };
    Cast { outcome, lower, upper, status, iterations, scale }
}

/// How a search ended.
#[derive(Clone, Copy, Debug)]
pub(crate) enum End<V> {
    /// A plane across this axis has the body behind it and the ray before it.
    Miss(V),
    /// The bracket has closed.
    Contact,
    /// It has not.
    Open(Status),
}

/// A support point and what it is made of, or how the search ends instead.
type Probe<B> = Result<(<B as Body>::Vector, <B as Body>::Witness), End<<B as Body>::Vector>>;

pub(crate) struct Search<'a, B: Body, O> {
    pub(crate) body: &'a mut B,
    pub(crate) local: LocalRay<B::Vector>,
    pub(crate) radius: ScalarOf<B>,
    /// What rounding may have moved a plane or a point by.
    pub(crate) noise: ScalarOf<B>,
    pub(crate) options: RayCastOptions<B::Vector>,
    pub(crate) half_chord: ScalarOf<B>,
    /// Whether the core is a single point.
    pub(crate) is_point: bool,
    pub(crate) scale: ScalarOf<B>,
    /// Where on the line the last plane is crossed, and how far rounding may have moved the crossing.
    pub(crate) low: ScalarOf<B>,
    pub(crate) low_error: ScalarOf<B>,
    /// The cosine of the angle at which it is crossed.
    pub(crate) low_slope: ScalarOf<B>,
    /// Where the ray enters the simplex, and how far rounding may have moved that.
    pub(crate) high: ScalarOf<B>,
    pub(crate) high_error: ScalarOf<B>,
    /// Where the line passes the body within rounding without entering it, which no plane tells.
    pub(crate) touched: Option<ScalarOf<B>>,
    /// The unit normal of a plane through the point at `low`, to rounding, that has the body behind it.
    pub(crate) normal: Option<B::Vector>,
    pub(crate) simplex: Simplex<B::Vector, B::Witness>,
    /// The paper's v.
    pub(crate) v: B::Vector,
    pub(crate) observer: O,
    pub(crate) iterations: usize,
}

/// Slopes of planes, as cosines of the angle between normal and ray, below which steps along the ray gain little.
const GRAZING: f64 = 0.1;

/// Exchanges of a point that gain nothing before the line is nudged.
const PATIENCE: usize = 3;

/// How often it is nudged at a time, each time twice as far, until it pierces the simplex.
const MAX_NUDGES: usize = 6;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    fn run(&mut self) -> End<B::Vector> {
        if B::Vector::DIM == 3
            && self.options.method == CastMethod::Portal
            && let Some(found) = self.look_through()
        {
            return found.map_or_else(|end| end, |()| End::Contact);
        }
        let first = self.options.axis.and_then(Vector::unit).or_else(|| self.v.unit());
        let found = self.approach(first.unwrap_or(-self.local.line.direction));
        match found.and_then(|entry| self.refine(entry)) {
            Ok(()) => End::Contact,
            Err(end) => end,
        }
    }

    /// Whether the ray ends before `mu`, even if that is wrong by `error`.
    fn is_beyond(&self, mu: ScalarOf<B>, error: ScalarOf<B>) -> bool {
        self.local.lambda(mu) - self.local.error(mu, error) > self.options.max_lambda
    }

    /// The next support point, along the unit vector `n`, if the plane through it leaves anything of the ray.
    ///
    /// The body is behind the plane `n·y = n·p + r`. A point `x` of the ray is before it by `n·(x − p) − r`, and if that
    /// is positive and the ray approaches, it crosses the plane after `(n·(x − p) − r)/(−n·d)`, and not before.
    fn probe(&mut self, n: B::Vector) -> Probe<B> {
        let (point, witness) = self.sight(n)?;
        self.advance(n, point)?;
        Ok((point, witness))
    }

    /// The next support point along any vector.
    #[inline]
    pub(crate) fn sight(&mut self, n: B::Vector) -> Probe<B> {
        if self.iterations >= self.options.max_iterations {
            return Err(End::Open(Status::IterationLimit));
        }
        let (point, witness) = self.body.support(n);
        let x = self.local.line.at(self.low);
        self.iterations += 1;
        self.show(x, x - point);
        if point.is_finite() { Ok((point, witness)) } else { Err(End::Open(Status::Stalled)) }
    }

    /// Moves the lower bound up to the plane across the unit vector `n` that supports the core at `point`, if it leaves
    /// anything of the ray.
    pub(crate) fn advance(&mut self, n: B::Vector, point: B::Vector) -> Result<(), End<B::Vector>> {
        let zero = ScalarOf::<B>::ZERO;
        let x = self.local.line.at(self.low);
        let ahead = n.dot(x - point) - self.radius;
        let slope = n.dot(self.local.line.direction);
        if ahead > zero && slope < zero {
            let (next, error) = (self.low - ahead / slope, -self.noise / slope);
            // By products: for a plane along the ray the quotients overflow.
            let leaves_first = ahead - self.noise > (self.half_chord - self.low) * -slope;
            if leaves_first || self.is_beyond(next, error) {
                return Err(End::Miss(n));
            }
            if next - error >= self.low - self.low_error {
                (self.low, self.low_error, self.low_slope, self.normal) = (next, error, -slope, Some(n));
            }
        } else if ahead > self.noise {
            return Err(End::Miss(n));
        }
        Ok(())
    }

    fn show(&mut self, x: B::Vector, w: B::Vector) {
        let mut seen = [B::Vector::ZERO; MAX_POINTS];
        for (s, p) in seen.iter_mut().zip(self.simplex.points()) {
            *s = x - *p;
        }
        (self.observer)(Iterate {
            iteration: self.iterations - 1,
            simplex: &seen[..self.simplex.points().len()],
            v: self.v,
            w,
            scale: self.scale,
            lower: self.local.lambda(self.low),
            upper: self.local.lambda(self.high),
        });
    }

    /// GJK steps, beginning along `n`, until the ray enters the simplex of support points, or touches the body.
    fn approach(&mut self, mut n: B::Vector) -> Result<Option<Entry<B::Vector>>, End<B::Vector>> {
        let zero = ScalarOf::<B>::ZERO;
        let line = self.local.line;
        let mut across = false;
        // The distances of the simplex from x and from the line decrease while x stays; near contact by less than
        // rounding for a few steps, while v turns.
        let (mut nearing, mut nearing_across) = (Decrease::new(), Decrease::new());
        loop {
            let before = self.low;
            let (point, witness) = self.probe(n)?;
            if self.low > before {
                nearing = Decrease::new();
            }
            if !self.simplex.points().contains(&point) {
                self.simplex.push(point, n, witness);
                let found = entry(self.simplex.points(), line, self.radius, self.noise);
                if let Some(found) = found.filter(|e| e.mu >= self.low - self.low_error - self.noise) {
                    return Ok(Some(found));
                }
            }
            // The paper's step: the point of {x} − P closest to zero.
            let x = line.at(self.low);
            let Closest { v, face, weights } = self.toward(|p| x - p, B::Vector::DIM)?;
            let length = v.norm();
            if length - self.radius <= self.noise {
                // x is in the body, or no farther from it than rounding.
                self.simplex.retain(face, weights);
                (self.high, self.high_error) = (self.low, self.low_error);
                return Ok(None);
            }
            let slope = v.dot(line.direction) / length;
            let progress = nearing.goes_on(length);
            across |= slope < zero && (!progress || slope > -ScalarOf::<B>::from_f64(GRAZING));
            if progress && (!across || slope >= zero) {
                self.simplex.retain(face, weights);
                (self.v, n) = (v, v / length);
                continue;
            }
            // The same across the ray, with the whole line for x.
            let Closest { v, face, weights } = self.toward(|p| line.across(line.foot - p), B::Vector::DIM - 1)?;
            // A short vector that long ones cancelled to leans along the ray by their rounding, and a plane that leans
            // does not stay before the whole ray.
            let v = line.across(v);
            let length = v.norm();
            self.simplex.retain(face, weights);
            if length - self.radius <= self.noise {
                if slope >= zero {
                    // Where it does, the ray may be past the simplex.
                    return Err(End::Open(Status::Stalled));
                }
                // The line comes within rounding of the simplex without entering it ahead of x.
                let mu = self.simplex.weighted_point().dot(line.direction).max(self.low);
                let error = if self.low_slope > zero { self.noise / self.low_slope } else { self.noise };
                (self.high, self.high_error, self.touched) = (mu, error, Some(mu));
                self.normal = self.normal.or(v.unit());
                return Ok(None);
            }
            if !nearing_across.goes_on(length) {
                return Err(End::Open(Status::Stalled));
            }
            nearing = Decrease::new();
            (self.v, n) = (v, v / length);
        }
    }

    /// The point closest to zero of the simplex seen through `map`, in a space of `dimension` dimensions.
    fn toward(
        &self,
        map: impl Fn(B::Vector) -> B::Vector,
        dimension: usize,
    ) -> Result<Closest<B::Vector>, End<B::Vector>> {
        let mut seen = [B::Vector::ZERO; MAX_POINTS];
        for (s, p) in seen.iter_mut().zip(self.simplex.points()) {
            *s = map(*p);
        }
        let points = &seen[..self.simplex.points().len()];
        self.options.sub_algorithm.closest(points, dimension).ok_or(End::Open(Status::Stalled))
    }

    /// Closes the bracket between the last plane and the entry into the simplex: the next plane is taken along the
    /// normal at the entry, and the support point found there replaces one of the simplex such that the ray still
    /// enters it, and earlier.
    ///
    /// A ray that runs through an edge or a vertex enters more than one facet there, and like the simplex method of
    /// linear programming, the exchange of points can go round in circles. Then the line that the simplex is kept pierced
    /// by is nudged into the facet; planes are still crossed by the ray itself.
    fn refine(&mut self, entered: Option<Entry<B::Vector>>) -> Result<(), End<B::Vector>> {
        let Some(mut at) = entered else { return Ok(()) };
        let direction = self.local.line.direction;
        let mut wanted = self.noise.max(self.options.tolerance);
        let mut line = self.local.line;
        let zero = ScalarOf::<B>::ZERO;
        let (mut nudge, mut patience) = (zero, PATIENCE);
        // Newton's steps are taken while they shrink, and the facet's normal after one that did not; between two pieces,
        // every other step only goes back and forth.
        let (mut last_gap, mut stuck) = (ScalarOf::<B>::infinity(), 0);
        let unbounded = [ScalarOf::<B>::infinity(); 2];
        let mut angles = unbounded;
        let (mut recent, mut lead) = (Recent::new(), self.noise);
        self.simplex.retain(at.face, at.weights);
        loop {
            let slope = -at.n.dot(direction);
            // A point of the facet may be outside of the body by rounding, and is in it where the ray is that far behind the
            // plane that is crossed less steeply.
            let least = if self.low_slope > zero { slope.min(self.low_slope) } else { slope };
            (self.high, self.high_error) = (at.mu.max(self.low), (self.noise + nudge) / least);
            let shrunk = angles[0].max(angles[1]) * ScalarOf::<B>::from_f64(0.5);
            let newton = if stuck > PATIENCE { None } else { self.newton(&recent, lead) };
            let newton = newton.filter(|step| step.angle <= shrunk || stuck > 0);
            angles = newton.map_or(unbounded, |step| [step.angle, angles[0]]);
            let n = newton.map_or(at.n, |step| step.to);
            self.v = n;
            let (point, witness) = self.probe(n)?;
            let gap = (self.high - self.low) * slope.max(self.low_slope);
            if gap <= wanted {
                return Ok(());
            }
            let touch = point + n * self.radius;
            let progress = gap <= last_gap * ScalarOf::<B>::from_f64(0.5);
            (last_gap, stuck) = (gap, if progress || newton.is_none() { 0 } else { stuck + 1 });
            lead = if stuck == 0 { self.noise } else { lead * ScalarOf::<B>::from_f64(16.0) };
            recent.push(Found { point: touch, along: n }, witness);
            if self.touches(&recent, n) {
                return Ok(());
            }
            let known = self.simplex.points().contains(&point);
            if known && newton.is_none() {
                return Err(End::Open(Status::Stalled));
            }
            if known {
                continue;
            }
            let facet = self.simplex.middle();
            let before = self.simplex;
            self.simplex.push(point, n, witness);
            let mut next = entry(self.simplex.points(), line, self.radius, self.noise);
            if newton.is_some() && next.is_none_or(|next| next.mu >= at.mu) {
                // Away from the facet's normal, there may be nothing before the facet.
                self.simplex = before;
                continue;
            }
            patience -= usize::from(next.is_none_or(|next| next.mu >= at.mu));
            let mut step = ScalarOf::<B>::from_f64(8.0) * self.noise;
            for _ in 0..MAX_NUDGES {
                if next.is_some() && patience > 0 {
                    break;
                }
                patience = PATIENCE;
                let inward = line.across(facet - line.foot);
                line.foot += inward.unit().unwrap_or(B::Vector::ZERO) * step.min(inward.norm());
                nudge += step;
                wanted += step;
                step += step;
                next = entry(self.simplex.points(), line, self.radius, self.noise);
            }
            match next {
                Some(next) if next.mu > self.low => {
                    at = next;
                    self.simplex.retain(at.face, at.weights);
                }
                // The body has points of the line on both sides of the lower bound, which so is in the body.
                Some(next) => {
                    self.simplex.retain(next.face, next.weights);
                    (self.high, self.high_error) = (
                        self.low,
                        self.low_error + if nudge > zero { nudge / slope.min(self.low_slope) } else { zero },
                    );
                    return Ok(());
                }
                None => return Err(End::Open(Status::Stalled)),
            }
        }
    }

    /// Whether the ray runs through the last support points, or through a segment or triangle of them, where that also
    /// is where it crosses the plane; then the bracket is closed.
    fn touches(&mut self, recent: &Recent<B::Vector, B::Witness>, n: B::Vector) -> bool {
        let line = self.local.line;
        let mut seen = [B::Vector::ZERO; MAX_POINTS];
        for (s, f) in seen.iter_mut().zip(recent.found()) {
            *s = line.across(f.point - line.foot);
        }
        let Some(nearest) = nearest_face(&seen[..recent.found().len()], B::Vector::DIM - 1) else { return false };
        let mut touching = Simplex::new();
        for (f, &witness) in recent.found().iter().zip(recent.witnesses()) {
            touching.push(f.point, f.along, witness);
        }
        touching.retain(nearest.face, nearest.weights);
        // Measured again, since the coordinates in a flat triangle may be nothing but rounding.
        let passed = touching.weighted_point();
        let aside = line.across(passed - line.foot).length();
        let mu = passed.dot(line.direction);
        let slope = -n.dot(line.direction);
        let closed =
            aside <= self.noise * ScalarOf::<B>::from_f64(0.5) && (mu - self.low) * slope <= self.noise + self.noise;
        if closed {
            self.simplex = touching;
            (self.high, self.high_error) = (mu.max(self.low), self.noise / slope);
        }
        closed
    }

    /// The direction in which the plane crossed last should be crossed by the ray where it supports a curved body.
    fn newton(&self, recent: &Recent<B::Vector, B::Witness>, lead: ScalarOf<B>) -> Option<Turn<B::Vector>> {
        let line = self.local.line;
        // The corners of the simplex first, since what was found last was found nearest the answer.
        let mut found = [Found::default(); 2 * MAX_POINTS];
        let mut len = 0;
        for (&point, &along) in self.simplex.points().iter().zip(self.simplex.along()) {
            found[len] = Found { point: point + along * self.radius, along };
            len += 1;
        }
        for &last in recent.found() {
            found[len] = last;
            len += 1;
        }
        let condition = Condition {
            axis: line.direction,
            target: line.foot,
            distance: ScalarOf::<B>::ZERO,
            noise: self.noise,
            lead,
        };
        let step = turn(&found[..len], condition, |n, change| self.derivative(n, change))?;
        (step.to.dot(line.direction) < ScalarOf::<B>::ZERO).then_some(step)
    }

    /// The derivative of the swept body's support point; zero where the core is not curved, since a radius alone needs
    /// no iteration.
    fn derivative(&self, n: B::Vector, change: B::Vector) -> B::Vector {
        let core = self.body.derivative(n, change);
        if core == B::Vector::ZERO || self.radius == ScalarOf::<B>::ZERO {
            return core;
        }
        let across = change - n * (change.dot(n) / n.length_squared());
        core + across * (self.radius / n.norm())
    }
}
