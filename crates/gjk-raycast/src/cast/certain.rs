//! The cast by the certain crossing of a shape: of a ray against it, and of a point or a ball that moves against it.

use convex_support::numerics::bound::roundings;
use convex_support::numerics::range::comfortable_unit_of_length;
use convex_support::{CertainCrossing, LineQuery, Scalar, Vector};
use num_traits::Float as _;

use super::bracket::{Bracket, NARROW};
use super::line::Line;
use super::{CastHit, ObstacleCast, RayContact, Stop};
use crate::body::{CastBody, Measures, ScalarFrom};
use crate::observer::Observer;
use crate::{CastMethod, Iterate, Miss, Outcome, Ray, RayCast, RayCastOptions, RayHit, Status};

/// Whether the cast needs only the crossing of the whole line.
#[inline(always)]
pub(crate) fn is_plain<V: Vector>(options: &RayCastOptions<V>) -> bool {
    options.min_lambda <= V::Scalar::ZERO && options.method == CastMethod::Portal && options.max_iterations > 0
}

/// The cast by the shape's crossing with the line of the ray; `None` if that is not certain.
#[inline(always)]
pub(crate) fn certain<V: Vector>(
    crossing: CertainCrossing<V>,
    ray: Ray<V>,
    options: &RayCastOptions<V>,
) -> Option<RayCast<V>> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let missed = |axis| (Outcome::Miss(Miss { axis }), [infinity; 2]);
    let (outcome, [lower, upper]) = match crossing {
        // To be refused.
        CertainCrossing::Misses(_) if options.max_lambda.is_nan() => return None,
        CertainCrossing::Misses(axis) => {
            // Its part along the ray would count far from here.
            let along = axis.dot(ray.direction) / ray.direction.length_squared();
            let across = axis - ray.direction * along;
            // Not `unit`, whose rare case is a call: without it nothing of this is left where nobody asks for the axis.
            let across = across / comfortable_unit_of_length(across.abs().max_element());
            let length = across.length();
            missed(if length > zero { across / length } else { axis })
        }
        CertainCrossing::Enters { entry, bounds, normal } => {
            let [earliest, latest] = bounds;
            // By rounding alone, the source may be in the target, or the end of the ray where it enters. NaN and
            // infinity decide nothing.
            if (earliest > zero) & (latest <= last_number(options.max_lambda)) {
                (Outcome::Hit(RayHit { lambda: entry, point: ray.at(entry), normal: Some(normal) }), bounds)
            } else if (earliest > options.max_lambda) & (latest < infinity) {
                missed(normal)
            } else {
                return None;
            }
        }
    };
    Some(RayCast { outcome, lower, upper, status: Status::Converged, iterations: 1 })
}

/// The end of a ray, or the largest number if it has none; NaN stays NaN.
#[inline(always)]
pub(crate) fn last_number<S: Scalar>(end: S) -> S {
    if end > S::max_value() { S::max_value() } else { end }
}

/// The same, in plain numbers or in twice the precision, for a body and a ray that may begin in it and whose direction
/// may be wrong by some part of its length; an observer sees the plane of the answer. The entry may be behind the end
/// of the ray, if only rounding decides whether it is.
#[inline(always)]
pub(crate) fn certain_closely<B: CastBody + ?Sized>(
    body: &mut B,
    ray: Ray<B::Vector>,
    direction_error: ScalarFrom<B>,
    options: &RayCastOptions<B::Vector>,
    observer: &mut Observer<'_, B::Vector>,
) -> Option<RayCast<B::Vector>> {
    if !is_plain(options) {
        return None;
    }
    let mut line = LineQuery::new(ray.source, ray.direction);
    if direction_error > Scalar::ZERO {
        let Measures { origin, radius, extent, .. } = body.measures();
        // Near the body the line is no farther from its source than this.
        let reach = (ray.source - origin).norm() + (extent + radius) + (extent + radius);
        line = line.within(direction_error * reach);
    }
    let (zero, infinity) = (Scalar::ZERO, ScalarFrom::<B>::infinity());
    let mut is_behind = false;
    // In a loop, so that the inlined code is there only once.
    let answer = loop {
        match body.certain_crossing(line) {
            None if line.is_close => return None,
            None => line.is_close = true,
            // The line enters before the source; from behind it tells where it leaves.
            Some(CertainCrossing::Enters { bounds: [_, latest], .. }) if latest <= zero && !is_behind => {
                (line.direction, is_behind) = (-line.direction, true);
            }
            Some(crossing) if !is_behind => {
                // Where only rounding decides whether the ray ends before it enters, it enters where a longer one does.
                let longer = || certain(crossing, ray, &RayCastOptions { max_lambda: infinity, ..*options });
                break certain(crossing, ray, options).or_else(longer)?;
            }
            Some(CertainCrossing::Enters { bounds: [earliest, latest], normal, .. }) => {
                let (outcome, bound) = if latest <= zero && options.max_lambda >= zero {
                    (Outcome::Hit(RayHit { lambda: zero, point: ray.source, normal: None }), zero)
                } else if earliest > zero && normal.dot(line.direction) < zero {
                    (Outcome::Miss(Miss { axis: normal }), infinity)
                } else {
                    return None;
                };
                break RayCast { outcome, lower: bound, upper: bound, status: Status::Converged, iterations: 1 };
            }
            Some(CertainCrossing::Misses(_)) => return None,
        }
    };
    show(&answer, body, ray, observer);
    Some(answer)
}

/// Shows an observer the plane of an answer.
#[inline(always)]
pub(crate) fn show<B: CastBody + ?Sized>(
    answer: &RayCast<B::Vector>,
    body: &mut B,
    ray: Ray<B::Vector>,
    observer: &mut Observer<'_, B::Vector>,
) {
    if observer.is_none() {
        return;
    }
    let (at, axis) = match answer.outcome {
        Outcome::Hit(RayHit { point, normal: Some(normal), .. }) => (point, normal),
        Outcome::Miss(Miss { axis }) => (ray.source, axis),
        Outcome::Hit(_) | Outcome::Undecided => return,
    };
    let w = at - body.measures().origin - body.support(axis).0;
    let (lower, upper) = (Scalar::ZERO, ScalarFrom::<B>::infinity());
    observer.show(|| Iterate { iteration: 0, simplex: &[], v: axis, w, scale: Scalar::ONE, lower, upper });
}

/// Closes the bracket between the plane at the entry and the entry, or finds a plane that the whole ray is before.
/// The shape's answer only tells where to look, as in a search, and the plane is that of a support point. If it is
/// not where the entry is, the answer is in doubt.
#[inline(always)]
pub(super) fn at_certain_entry<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    let line = bracket.line();
    let known = crossing(bracket, line).ok_or(Stop::InDoubt)?;
    let axis = match known {
        CertainCrossing::Misses(axis) => axis,
        CertainCrossing::Enters { entry, bounds: [_, latest], normal } => {
            let start = bracket.ray.start;
            if latest < start {
                let reversed = Line { direction: -line.direction, ..line };
                return match crossing(bracket, reversed) {
                    Some(CertainCrossing::Enters { bounds: [_, exit], .. }) if start < -exit => {
                        Ok(bracket.close_inside())
                    }
                    _ => Err(Stop::InDoubt),
                };
            }
            if entry < start {
                return Err(Stop::InDoubt);
            }
            normal
        }
    };
    // The plane across it that supports the body.
    let n = axis.unit().ok_or(Stop::InDoubt)?;
    let (point, _) = bracket.support(n, n, &[])?;
    bracket.advance(n, point)?;
    let CertainCrossing::Enters { entry, bounds: [_, latest], normal } = known else { return Err(Stop::InDoubt) };
    let point = line.at(entry) - normal * bracket.radius;
    let witness = bracket.body.witness(point);
    let found = bracket.close(bracket.radius, point, witness, entry)?;
    bracket.enter_for_certain(latest);
    Ok(found)
}

/// Where a line certainly enters the body, with the error of a point of the line included; the shape includes its own
/// error and that of its computation.
fn crossing<V: Vector>(bracket: &Bracket<'_, V>, Line { foot, direction }: Line<V>) -> Option<CertainCrossing<V>> {
    let scale = bracket.scale;
    let source = bracket.body.measures().origin + foot * scale;
    let error = bracket.error * scale + roundings(1.0, source.norm());
    bracket.body.certain_crossing(LineQuery::new(source, direction * scale).within(error))
}

impl<V: Vector> ObstacleCast<V> {
    /// What is certain of a ray and a body.
    pub(crate) fn of_certain<B: CastBody<Vector = V> + ?Sized>(answer: &RayCast<V>, body: &B, ray: Ray<V>) -> Self {
        let &RayCast { outcome, lower, upper, status, iterations } = answer;
        let Measures { origin, radius, extent, error, .. } = body.measures();
        let outcome = outcome.map(|RayHit { lambda, normal, .. }| {
            let spot = (ray.source - origin) + ray.direction * lambda;
            CastHit { lambda, normal, spot, witness: body.witness(spot - normal.unwrap_or_default() * radius) }
        });
        let narrow = (roundings(24.0, extent + radius) + error) * V::Scalar::from_f64(NARROW);
        Self { outcome, lower, upper, status, iterations, scale: Scalar::ONE, narrow }
    }
}
