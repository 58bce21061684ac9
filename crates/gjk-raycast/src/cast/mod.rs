//! The ray cast against a body, shared by [`ray_cast`](crate::ray_cast) and [`linear_cast`](crate::linear_cast).
//!
//! A [`Bracket`] holds what is certain; the searches only choose where to look. `docs/ray-cast.md` derives them.

mod algorithm_3;
mod bracket;
mod certain;
mod line;
mod outline;
mod portal;
mod ray_frame;
mod start;
#[cfg(feature = "alloc")]
mod watched;
#[cfg(not(feature = "alloc"))]
#[path = "unwatched.rs"]
mod watched;

use convex_support::{Scalar, Vector, compiled_table};
use num_traits::Float as _;

use crate::body::{CastBody, PointPair};
use crate::observer::Observer;
use crate::options::{MayBeLean, Rare};
use crate::pair::Shape;
use crate::simplex::Simplex;
use crate::{CastMethod, Miss, Outcome, RayCastOptions, Status};
use algorithm_3::{algorithm_3, draw_near, touch_beside};
use bracket::Bracket;
use certain::at_certain_entry;
pub(crate) use certain::{certain, certain_closely, is_plain, last_number, show};
pub(crate) use line::{CastRay, LocalRay, Part};
use outline::bound_entry;
use portal::portal;

/// What a lean ray cast leaves out: the searches that are quicker than Algorithm 3 alone, and the second measurement
/// where they leave a doubt.
#[allow(clippy::type_complexity, reason = "the type is written once")]
pub(crate) struct RareInRayCasts<V: Vector> {
    cast_by: CastFn<V>,
    settle_start: SettleFn<V>,
    settle_end: SettleFn<V>,
    touch_beside: fn(&mut Bracket<'_, V>, &Simplex<V>, V, V::Scalar, Option<V>) -> Option<RayContact<V>>,
}

type CastFn<V> =
    fn(&mut dyn CastBody<Vector = V>, CastRay<V>, &RayCastOptions<V>, &mut Observer<'_, V>) -> ObstacleCast<V>;

type SettleFn<V> = fn(&mut ObstacleCast<V>, RayBodies<'_, V>, &RayCastOptions<V>);

impl<V: Vector> MayBeLean for RayCastOptions<V> {
    type Table = RareInRayCasts<V>;
    const TABLE: Self::Table = RareInRayCasts {
        cast_by: cast_by::<V, true>,
        settle_start: start::settle_start,
        settle_end: start::settle_end,
        touch_beside,
    };

    fn rare() -> Rare<Self> {
        Rare(Some(compiled_table!(RareInRayCasts<V> of RayCastOptions)))
    }
}

/// Support points after which a search with a warm start counts as in doubt.
const MAX_WARM: usize = 32;

/// Casts a part of a ray against a body.
#[inline(always)]
pub(crate) fn cast<V: Vector>(
    body: &mut dyn CastBody<Vector = V>,
    ray: CastRay<V>,
    options: &RayCastOptions<V>,
    observer: &mut Observer<'_, V>,
) -> ObstacleCast<V> {
    let cast = options.rare.0.map_or(cast_by::<V, false> as CastFn<V>, |rare| rare.cast_by);
    if options.warm_start.is_some() {
        warm_cast(cast, body, ray, options, observer)
    } else {
        cast(body, ray, options, observer)
    }
}

/// Casts with the warm start first. If that leaves a doubt, casts again without it.
#[inline(never)]
fn warm_cast<V: Vector>(
    cast: CastFn<V>,
    body: &mut dyn CastBody<Vector = V>,
    ray: CastRay<V>,
    options: &RayCastOptions<V>,
    observer: &mut Observer<'_, V>,
) -> ObstacleCast<V> {
    let told = RayCastOptions { max_iterations: options.max_iterations.min(MAX_WARM), ..*options };
    let warm = cast(body, ray, &told, observer);
    let max_iterations = options.max_iterations - warm.iterations;
    if warm.outcome.is_certain(warm.upper < V::Scalar::infinity()) || max_iterations == 0 {
        return warm;
    }
    let cold = cast(body, ray, &RayCastOptions { warm_start: None, max_iterations, ..*options }, observer);
    ObstacleCast { iterations: warm.iterations + cold.iterations, ..cold }
}

/// The cast by all searches, or by Algorithm 3 alone.
#[inline(never)]
fn cast_by<V: Vector, const ALL: bool>(
    body: &mut dyn CastBody<Vector = V>,
    ray: CastRay<V>,
    options: &RayCastOptions<V>,
    observer: &mut Observer<'_, V>,
) -> ObstacleCast<V> {
    let mut bracket = Bracket::new(body, ray, options, observer);
    let mut found = match bracket.enter_ball() {
        Ok(()) if bracket.error < V::Scalar::infinity() => search::<V, ALL>(&mut bracket),
        // Nothing is known about numbers out of range.
        Ok(()) => Err(Stop::Exhausted(Status::Stalled)),
        Err(stop) => Err(stop),
    };
    let mut is_near = true;
    if let Ok(contact) = &mut found {
        let (on, _) = bracket.point_near_line();
        let is_bounded = bracket.is_entry_open() && bracket.is_past_start();
        if is_bounded {
            bound_entry(&mut bracket);
        }
        if is_bounded || bracket.leans() {
            is_near = draw_near(&mut bracket, contact, on);
        }
    }
    conclude(&bracket, found, is_near)
}

/// First the certain crossing of the shape, then the quicker search, and Algorithm 3 if both are in doubt.
#[inline(always)]
fn search<V: Vector, const ALL: bool>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    if ALL && bracket.options.method == CastMethod::Portal {
        match at_certain_entry(bracket) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
        match if V::DIM == 3 { portal(bracket) } else { Err(Stop::InDoubt) } {
            Err(Stop::InDoubt | Stop::Touches(_)) => {}
            found => return found,
        }
        if V::DIM == 3 && bracket.options.warm_start.is_some() {
            return Err(Stop::InDoubt);
        }
    }
    // In the plane this is the search. In space it decides where rounding left a doubt.
    bracket.doubt_entry();
    algorithm_3(bracket)
}

/// Where the ray first meets the body, as a search finds it.
pub(crate) struct RayContact<V: Vector> {
    mu: V::Scalar,
    /// The unit normal of a plane through that point, to rounding, that has the body behind it.
    normal: Option<V>,
    /// The support points of both shapes for the core's point below it.
    witness: PointPair<V>,
}

/// Why a search ends without a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stop<V> {
    /// A plane across this unit vector has the body behind it, and the rest of the ray before it.
    Miss(V),
    /// There are no more support points: the iterations are used up, or the support map returned numbers that are not
    /// finite.
    Exhausted(Status),
    /// This search cannot decide; another may.
    InDoubt,
    /// The line touches the body here, to rounding, and this search cannot decide; moved by this vector, the line runs
    /// inside.
    Touches(V),
}

/// The result of [`cast`]; λ in units of the ray's direction. If only rounding decides whether the ray ends before a
/// hit, the hit may be behind its end: see [`Outcome::until`].
pub(crate) struct ObstacleCast<V: Vector> {
    pub(crate) outcome: Outcome<CastHit<V>, V>,
    pub(crate) lower: V::Scalar,
    pub(crate) upper: V::Scalar,
    pub(crate) status: Status,
    pub(crate) iterations: usize,
    /// The unit of the hit spot and of the witness.
    pub(crate) scale: V::Scalar,
    /// How deep the body may be entered at the upper bound of a converged answer.
    narrow: V::Scalar,
}

/// Where the ray enters the body.
pub(crate) struct CastHit<V: Vector> {
    pub(crate) lambda: V::Scalar,
    pub(crate) normal: Option<V>,
    /// The hit spot, relative to the body's origin and in units of the scale.
    pub(crate) spot: V,
    /// The support points of both shapes for the core's point below it.
    pub(crate) witness: PointPair<V>,
}

#[inline(always)]
fn conclude<V: Vector>(
    bracket: &Bracket<'_, V>,
    found: Result<RayContact<V>, Stop<V>>,
    is_near: bool,
) -> ObstacleCast<V> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let (ray, max_lambda) = (bracket.ray, bracket.options.max_lambda);
    let (outcome, (lower, upper), status) = match found {
        Ok(RayContact { mu, normal, witness }) => {
            let starts_inside = mu <= ray.start;
            let lambda = if starts_inside { zero } else { ray.lambda(mu).max(zero) };
            let (lower, upper) = bracket.bounds(Some(lambda));
            if lower > max_lambda {
                let axis = normal.unwrap_or(-ray.line.direction);
                (Outcome::Miss(Miss { axis }), (infinity, infinity), Status::Converged)
            } else {
                let hit = CastHit { lambda, normal, spot: ray.line.at(mu), witness };
                let is_narrow = is_near && bracket.is_narrow(ray.mu(upper));
                let status = if is_narrow { Status::Converged } else { Status::Stalled };
                (Outcome::Hit(hit), (lower, upper), status)
            }
        }
        Err(Stop::Miss(n)) => {
            (Outcome::Miss(Miss { axis: bracket.axis_of_miss(n) }), (infinity, infinity), Status::Converged)
        }
        Err(stop) => {
            let status = if let Stop::Exhausted(status) = stop { status } else { Status::Stalled };
            (Outcome::Undecided, bracket.bounds(None), status)
        }
    };
    let (iterations, scale, narrow) = (bracket.iterations, bracket.scale, bracket.narrow() * bracket.scale);
    ObstacleCast { outcome, lower, upper, status, iterations, scale, narrow }
}

/// The bodies of a ray, for a second measurement.
#[derive(Clone, Copy)]
pub(crate) struct RayBodies<'s, V: Vector> {
    /// The target, which is swept by a ball, its skin.
    pub(crate) a: Shape<'s, V>,
    pub(crate) skin: V::Scalar,
    /// The shape, or the point at the source, whose motion is the ray.
    pub(crate) b: Shape<'s, V>,
    pub(crate) direction: V,
    /// A bound on the error of the direction, as a part of its length.
    pub(crate) direction_error: V::Scalar,
}

/// Decides about a hit that may be at the source, or about a search that stalled before it left the source; and about
/// one that may be behind the end of the ray.
#[inline(always)]
pub(crate) fn settle_ends<V: Vector>(
    cast: &mut ObstacleCast<V>,
    bodies: RayBodies<'_, V>,
    options: &RayCastOptions<V>,
) {
    let rare = |cast: &ObstacleCast<V>| options.rare.0.filter(|_| cast.iterations < options.max_iterations);
    if cast.is_to_be_settled()
        && let Some(rare) = rare(cast)
    {
        (rare.settle_start)(cast, bodies, options);
    }
    let end = options.max_lambda;
    if cast.lower <= end
        && end < cast.upper
        && cast.upper < V::Scalar::infinity()
        && let Some(rare) = rare(cast)
    {
        (rare.settle_end)(cast, bodies, options);
    }
    cast.upper = cast.outcome.until(end, cast.upper, |hit| hit.lambda);
}

impl<V: Vector> ObstacleCast<V> {
    /// Whether it hits at the source, or stalled there, and is not known to begin inside.
    #[inline(always)]
    fn is_to_be_settled(&self) -> bool {
        let zero = V::Scalar::ZERO;
        let may_be_at_start = match &self.outcome {
            Outcome::Hit(_) => true,
            Outcome::Undecided => self.status == Status::Stalled,
            Outcome::Miss(_) => false,
        };
        may_be_at_start && self.lower == zero && self.upper > zero
    }
}
