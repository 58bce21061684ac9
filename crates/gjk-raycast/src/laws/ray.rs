//! The claims of `ray_cast` and `ray_exit` about one ray and target.

use alloc::format;
use alloc::vec::Vec;

use convex_support::{Point, Scalar, Vector};

use super::cast::{Casts, Told, beyond_without_end};
use super::planes::{Stated, length, numbers};
use super::{AnyShape, Law, Numbers, Planes, Report, Scale};
use crate::{
    CastMethod, Ray, RayCast, RayCastOptions, RayExit, RayHit, SignedDistanceOptions, Status, WarmStart, ray_cast,
    ray_exit, signed_distance,
};

/// Casts a ray with several options, methods and starts, and with ends at its own hit and beside it; and asks where it
/// leaves.
pub fn ray<V: Vector>(target: AnyShape<'_, V>, ray: Ray<V>, options: RayCastOptions<V>, starts: &[V]) -> Report {
    ray_judged(target, ray, options, starts, &Stated(target))
}

/// [`ray`](fn@ray), judged by planes from elsewhere.
pub fn ray_judged<V: Vector>(
    target: AnyShape<'_, V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    starts: &[V],
    planes: &dyn Planes,
) -> Report {
    let mut report = Report::default();
    let (source, direction) = (numbers(ray.source), numbers(ray.direction));
    let Ok(source_point) = Point::new(ray.source) else { return report };
    let Some((plain, told)) = asked(target, ray, options, starts) else { return report };
    let mut scale = Scale::of(target, &source_point);
    // The plane of a cast is through a point of the line.
    scale.size += length(direction) * plain.outcome.hit().map_or(0.0, |hit| hit.lambda.as_f64().abs());
    let beyond =
        |n: Numbers, at: f64| planes.beyond(n, &[(1.0, source), (if at.is_finite() { at } else { 0.0 }, direction)]);
    let to_the_end = |n: Numbers, at: f64| {
        if at.is_finite() {
            return beyond(n, at);
        }
        beyond_without_end(n, direction, 4.0 * f64::EPSILON * length(direction))
    };
    let gap = |time: f64| {
        let point = Point::new(ray.at(V::Scalar::from_f64(time))).ok()?;
        let apart = signed_distance(&point as AnyShape<'_, V>, target, SignedDistanceOptions::new());
        let lost = 4.0 * scale.epsilon * (length(source) + time.abs() * length(direction));
        Some([apart.lower.as_f64() - lost, apart.upper.as_f64() + lost])
    };
    // With a beginning, points before it do not count, and planes there say nothing.
    let is_whole = options.min_lambda <= V::Scalar::ZERO;
    let casts = Casts {
        query: "ray_cast",
        unit: scale.unit() + scale.epsilon * length(source).min(scale.size),
        size: target.core().size().as_f64(),
        target: 0.0,
        gap: Some(&gap),
        beyond: is_whole.then_some(&to_the_end),
        normals: starts.iter().map(|&n| numbers(n)).collect(),
    };
    casts.judge(&told, &mut report);

    let exits = [("by default", options), ("lean", lean(options)), ("by GJK", options.with_method(CastMethod::Gjk))];
    let exits: Vec<_> =
        exits.into_iter().filter_map(|(how, options)| Some((how, ray_exit(target, ray, options).ok()?))).collect();
    leaves(&casts, &told, &exits, &beyond, &mut report);
    report
}

/// The same options without the rare parts.
fn lean<V: Vector>(options: RayCastOptions<V>) -> RayCastOptions<V> {
    let RayCastOptions { min_lambda, max_lambda, tolerance, .. } = options;
    RayCastOptions { min_lambda, max_lambda, tolerance, ..RayCastOptions::lean() }
}

/// The answer by default, and what was told by all ways of asking; `None` if the question is refused.
fn asked<V: Vector>(
    target: AnyShape<'_, V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    starts: &[V],
) -> Option<(RayCast<V>, Vec<Told>)> {
    let mut told = Vec::new();
    let mut ask = |how, options: RayCastOptions<V>| {
        let cast = ray_cast(target, ray, options).ok()?;
        let mut one = Told::new(how, options.max_lambda, &cast, |hit: &RayHit<V>| (hit.lambda, hit.normal));
        one.tolerance = options.tolerance.as_f64();
        told.push(one);
        Some(cast)
    };
    let lean = lean(options);
    let plain = ask("by default", options)?;
    ask("lean", lean);
    ask("by GJK", options.with_method(CastMethod::Gjk));
    ask("lean, by GJK", lean.with_method(CastMethod::Gjk));
    let next = plain.warm_start(None);
    for start in starts.iter().map(|&axis| Some(WarmStart::new(axis))).chain([next]) {
        ask("warm", options.with_warm_start(start));
        ask("warm, by GJK", options.with_method(CastMethod::Gjk).with_warm_start(start));
    }
    let hit = plain.outcome.hit();
    for end in ends([hit.map(|hit| hit.lambda), Some(plain.lower), Some(plain.upper)]) {
        let options = options.with_max_lambda(end);
        ask("to an end", options);
        ask("to an end, warm", options.with_warm_start(next));
        ask("to an end, by GJK", options.with_method(CastMethod::Gjk));
        ask("to an end, lean", lean.with_max_lambda(end));
    }
    Some((plain, told))
}

/// Numbers at which a cast may end: these, and their neighbours.
pub(super) fn ends<S: Scalar>(numbers: [Option<S>; 3]) -> Vec<S> {
    let mut ends: Vec<S> = Vec::new();
    for number in numbers.into_iter().flatten().filter(|x| x.is_finite() && *x > S::ZERO) {
        for factor in [S::ONE, S::ONE - S::EPSILON, S::ONE + S::EPSILON] {
            let end = number * factor;
            if !ends.contains(&end) {
                ends.push(end);
            }
        }
    }
    ends
}

/// Where a ray leaves, by several ways, beside where it enters.
fn leaves<V: Vector>(
    casts: &Casts<'_>,
    entries: &[Told],
    exits: &[(&'static str, RayExit<V>)],
    beyond: super::cast::Beyond<'_>,
    report: &mut Report,
) {
    let query = "ray_exit";
    let mut within = (f64::NEG_INFINITY, f64::INFINITY);
    for (how, exit) in exits {
        let [lower, upper] = [exit.lower, exit.upper].map(Scalar::as_f64);
        report.claim((Law::Bound, query), !(lower.is_nan() || upper.is_nan()), || format!("{how}: {exit:?}"));
        let is_converged = exit.status == Status::Converged;
        if let Some(hit) = exit.outcome.hit() {
            let at = hit.lambda.as_f64();
            report.claim((Law::Bound, query), lower <= at && at <= upper, || format!("{how}, not within: {exit:?}"));
            if is_converged && lower.is_finite() {
                casts.width(query, [lower, upper], 0.0, report, || format!("{how}: {exit:?}"));
            }
            if lower.is_finite() {
                for &n in casts.normals.iter().chain(&hit.normal.map(numbers)) {
                    // Before a plane at both ends is before it at all places between.
                    let apart = beyond(n, lower)[0].min(beyond(n, upper)[0]);
                    report.claim((Law::Bound, query), apart <= 0.0, || {
                        format!("{how}, within the bounds a plane across {n:?} separates by {apart:e}: {exit:?}")
                    });
                }
            }
        }
        let is_hit = exit.outcome.is_hit() && exit.is_certain();
        within = (
            if is_hit { within.0.max(lower) } else { within.0 },
            within.1.min(if exit.outcome.is_miss() { f64::NEG_INFINITY } else { upper }),
        );
        for one in entries.iter().take(4) {
            let contradicts = one.is_miss() && is_hit || one.is_certain_hit() && exit.outcome.is_miss();
            report.claim((Law::Certain, query), !contradicts, || {
                format!("{how} it leaves, or does not, otherwise than it enters: {exit:?} {:?}", one.bounds())
            });
            if one.is_certain_hit() && is_hit {
                report.claim((Law::Overlap, query), one.bounds()[0] <= upper, || {
                    format!("{how} it leaves before it enters: {exit:?} {:?}", one.bounds())
                });
            }
        }
    }
    report.claim((Law::Overlap, query), within.0 <= within.1, || format!("{within:?}: {exits:?}"));
}
