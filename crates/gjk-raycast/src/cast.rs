//! Algorithm 3 on a core: the ray cast that [`ray_cast`](crate::ray_cast) and [`linear_cast`](crate::linear_cast) share.
//!
//! The paper's loop moves a point `x` along the ray up to one supporting plane of the body after another, and finds the
//! planes by GJK steps towards `x` (`approach.rs`). Four things are added to it here; `docs/ray-cast.md` derives them.
//!
//! - In 3D, a quicker search is tried first (`portal.rs`, `swept.rs`); the one described here is what remains where that is
//!   in doubt.
//! - As soon as the simplex of support points is pierced by the ray, the hit is bracketed: behind the last plane, and
//!   before the point where the ray enters the simplex. From then on, the simplex is refined where it is pierced
//!   (`refine.rs`), and no vector has to tend to zero.
//! - Where the ray runs nearly along the planes, a step along it gains nothing, and the steps of GJK are taken across
//!   the ray, with the whole line for `x`.
//! - A radius is never made of support points: the simplex is swept by it.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::{Body, Witness, power_of_two_near, reciprocal_of_power};
use crate::line::LocalRay;
use crate::ray_cast::Ray;
use crate::simplex::{MAX_POINTS, Simplex};
use crate::{CastMethod, Iterate, Miss, Outcome, RayCastOptions, Status};

/// A hit, as the search knows it.
pub(crate) struct Contact<V: Vector, W> {
    pub(crate) lambda: V::Scalar,
    pub(crate) normal: Option<V>,
    /// The hit spot, relative to the body's origin and in units of the scale.
    pub(crate) spot: V,
    /// What the core's point below it is made of.
    pub(crate) witness: W,
}

/// What [`cast`] found; λ in units of the ray's direction.
pub(crate) struct Cast<V: Vector, W> {
    pub(crate) outcome: Outcome<Contact<V, W>, V>,
    pub(crate) lower: V::Scalar,
    pub(crate) upper: V::Scalar,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    /// The unit of the hit spot and of the witness.
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
    let per_unit = reciprocal_of_power(scale);
    let (radius, size) = (body.radius() * per_unit, size * per_unit);
    let noise = number(8.0) * ScalarOf::<B>::EPSILON * size;
    let local = LocalRay::new(ray, origin, scale);

    // The body lies in a ball about its origin. A line that misses the ball misses the body, and on one that does not,
    // only the chord matters.
    let reach = size * (ScalarOf::<B>::ONE + number(16.0) * ScalarOf::<B>::EPSILON);
    let across_squared = local.line.foot.length_squared();
    let inside = reach * reach - across_squared;
    // NaN, of a body that is none, stays NaN.
    let half_chord = if inside < zero { zero } else { inside.sqrt() };
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
        inward: None,
        normal: None,
        witness: Default::default(),
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
    } else if across_squared > reach * reach {
        End::Miss(local.line.foot.unit().unwrap_or(local.line.direction))
    } else {
        search.run()
    };

    let Search { low, low_error, high, high_error, touched, normal, witness, iterations, .. } = search;
    let hit_at = touched.unwrap_or(low);
    let started_in = hit_at <= local.start;
    let lambda = if started_in { zero } else { local.lambda(hit_at).max(zero) };
    // What rounding moved a crossing by, and as much again: the support points were rounded before they came here.
    let lower = (local.lambda(low) - local.error(low, low_error + low_error)).max(zero);
    let upper = match end {
        End::Contact if started_in => zero,
        _ => (local.lambda(high) + local.error(high, high_error + high_error)).max(lambda),
    };
    let spot = local.line.at(hit_at);
    let hit = || Outcome::Hit(Contact { lambda, normal, spot, witness });
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
pub(crate) type Probe<B> = Result<(<B as Body>::Vector, <B as Body>::Witness), End<<B as Body>::Vector>>;

/// Where the ray crosses a plane that the body is behind.
pub(crate) struct Crossing<S> {
    at: S,
    error: S,
    /// The cosine at which it is crossed.
    slope: S,
}

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
    /// The foot of a line nearer the body by less than rounding, where the line itself was found to touch it.
    pub(crate) inward: Option<B::Vector>,
    /// The unit normal of a plane through the point at `low`, to rounding, that has the body behind it.
    pub(crate) normal: Option<B::Vector>,
    /// What the core's point below the entry is made of.
    pub(crate) witness: B::Witness,
    pub(crate) simplex: Simplex<B::Vector, B::Witness>,
    /// The paper's v.
    pub(crate) v: B::Vector,
    pub(crate) observer: O,
    pub(crate) iterations: usize,
}

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// Compiled into its caller, as is all that most casts need: what was just computed of the ray stays in registers.
    #[inline(always)]
    fn run(&mut self) -> End<B::Vector> {
        if B::Vector::DIM == 3
            && self.options.method == CastMethod::Portal
            && let Some(found) = self.look_through()
        {
            return found.map_or_else(|end| end, |()| End::Contact);
        }
        self.run_gjk()
    }

    #[cold]
    #[inline(never)]
    fn run_gjk(&mut self) -> End<B::Vector> {
        let first = self.options.axis.and_then(Vector::unit).or_else(|| self.v.unit());
        let found = self.approach(first.unwrap_or(-self.local.line.direction)).and_then(|entry| self.refine(entry));
        self.witness = self.simplex.weighted().fold(Default::default(), |sum: B::Witness, (w, p)| sum.plus(p, w));
        match found {
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
    pub(crate) fn probe(&mut self, n: B::Vector) -> Probe<B> {
        let (point, witness) = self.sight(n)?;
        self.advance(n, point)?;
        Ok((point, witness))
    }

    /// The next support point along any vector.
    #[inline(always)]
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
    #[inline(always)]
    pub(crate) fn advance(&mut self, n: B::Vector, point: B::Vector) -> Result<(), End<B::Vector>> {
        if let Some(Crossing { at, error, slope }) = self.crossing(n, point)?
            && at - error >= self.low - self.low_error
        {
            (self.low, self.low_error, self.low_slope, self.normal) = (at, error, slope, Some(n));
        }
        Ok(())
    }

    /// Where the ray crosses the plane across the unit vector `n` that supports the body at `point` of the core, if that is
    /// ahead; or that the plane leaves nothing of the ray.
    #[inline(always)]
    pub(crate) fn crossing(
        &self,
        n: B::Vector,
        point: B::Vector,
    ) -> Result<Option<Crossing<ScalarOf<B>>>, End<B::Vector>> {
        let zero = ScalarOf::<B>::ZERO;
        let x = self.local.line.at(self.low);
        let ahead = n.dot(x - point) - self.radius;
        let slope = n.dot(self.local.line.direction);
        if ahead > zero && slope < zero {
            let per_slope = -slope.recip();
            let (at, error) = (self.low + ahead * per_slope, self.noise * per_slope);
            // By products: for a plane along the ray the quotients overflow.
            let leaves_first = ahead - self.noise > (self.half_chord - self.low) * -slope;
            if leaves_first || self.is_beyond(at, error) {
                return Err(End::Miss(n));
            }
            return Ok(Some(Crossing { at, error, slope: -slope }));
        }
        if ahead > self.noise { Err(End::Miss(n)) } else { Ok(None) }
    }

    #[inline(always)]
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
}
