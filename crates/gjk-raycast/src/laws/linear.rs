//! The claims of `linear_cast` about one motion of two bodies.

use alloc::format;
use alloc::vec::Vec;

use convex_support::{Posed, Scalar, Vector};

use super::cast::{Casts, Told, beyond_without_end};
use super::planes::{dot, length, numbers, stated};
use super::ray::ends;
use super::{AnyShape, Law, Numbers, PairPlanes, Report, Scale};
use crate::{
    CastMethod, LinearCast, LinearCastOptions, Motion, SignedDistance, SignedDistanceOptions, StartInContact,
    WarmStart, linear_cast as ask, signed_distance,
};

/// Casts two bodies with several options, methods and starts, in both orders, and with ends at the hit and beside it.
pub fn linear_cast<V: Vector>(
    a: AnyShape<'_, V>,
    b: AnyShape<'_, V>,
    motion: Motion<V>,
    options: LinearCastOptions<V>,
    starts: &[V],
) -> Report {
    stated(a, b, |planes| linear_cast_judged(a, b, motion, options, starts, planes))
}

/// [`linear_cast`], judged by planes from elsewhere.
pub fn linear_cast_judged<V: Vector>(
    a: AnyShape<'_, V>,
    b: AnyShape<'_, V>,
    motion: Motion<V>,
    options: LinearCastOptions<V>,
    starts: &[V],
    planes: PairPlanes<'_>,
) -> Report {
    let mut report = Report::default();
    let Some((plain, told)) = asked([a, b], motion, options, starts) else { return report };
    let velocity = motion.velocity_a - motion.velocity_b;
    let velocities = [numbers(motion.velocity_a), numbers(motion.velocity_b)];
    let (relative, speeds) = (numbers(velocity), length(velocities[0]) + length(velocities[1]));
    let target = options.target_distance.as_f64().max(0.0);
    let mut scale = Scale::of(a, b);
    scale.size += length(relative) * plain.outcome.hit().map_or(0.0, |hit| hit.time.as_f64().abs());
    scale.size += target;
    let beyond = |n: Numbers, at: f64| {
        if at.is_finite() {
            return planes.apart.beyond(n, &[(at, velocities[0]), (-at, velocities[1])]);
        }
        beyond_without_end(n, relative, 4.0 * V::Scalar::EPSILON.as_f64() * speeds)
    };
    let distance_at = |time: V::Scalar, options: SignedDistanceOptions<V>| {
        let moved = Posed::translated(a, velocity * time).ok()?;
        Some(signed_distance(&moved as AnyShape<'_, V>, b, options))
    };
    let start = signed_distance(a, b, SignedDistanceOptions::new());
    let begins_apart = start.lower.as_f64() > target;
    let is_reported = options.start_in_contact == StartInContact::Report || begins_apart;
    let gap = |time: f64| {
        let apart = distance_at(V::Scalar::from_f64(time), SignedDistanceOptions::new())?;
        let lost = 4.0 * scale.epsilon * (scale.place + time.abs() * speeds);
        Some([apart.lower.as_f64() - lost, apart.upper.as_f64() + lost])
    };
    let casts = Casts {
        query: "linear_cast",
        unit: scale.unit(),
        size: scale.size,
        target,
        gap: is_reported.then_some(&gap),
        beyond: is_reported.then_some(&beyond),
        normals: starts.iter().map(|&n| numbers(n)).chain([numbers(start.normal)]).collect(),
    };
    casts.judge(&told, &mut report);
    if !is_reported && target == 0.0 {
        let at = |time: V::Scalar| distance_at(time, SignedDistanceOptions::new().with_axis(start.normal));
        deeper(&told, &start, &scale, (&at, relative), &beyond, &mut report);
    }
    report
}

/// The answer by default, and what was told by all ways of asking; `None` if the question is refused.
fn asked<V: Vector>(
    [a, b]: [AnyShape<'_, V>; 2],
    motion: Motion<V>,
    options: LinearCastOptions<V>,
    starts: &[V],
) -> Option<(LinearCast<V>, Vec<Told>)> {
    let mut told = Vec::new();
    let mut cast = |how, options: LinearCastOptions<V>, is_reversed: bool| {
        let reversed = Motion { velocity_a: motion.velocity_b, velocity_b: motion.velocity_a };
        let cast = if is_reversed { ask(b, a, reversed, options) } else { ask(a, b, motion, options) }.ok()?;
        told.push(Told::of_motion(how, [options.max_time, options.tolerance], &cast, is_reversed));
        Some(cast)
    };
    let lean = LinearCastOptions {
        max_time: options.max_time,
        target_distance: options.target_distance,
        start_in_contact: options.start_in_contact,
        tolerance: options.tolerance,
        ..LinearCastOptions::lean()
    };
    let plain = cast("by default", options, false)?;
    cast("in the other order", options, true);
    cast("lean", lean, false);
    cast("by GJK", options.with_method(CastMethod::Gjk), false);
    let next = plain.warm_start(None);
    for start in starts.iter().map(|&axis| Some(WarmStart::new(axis))).chain([next]) {
        cast("warm", options.with_warm_start(start), false);
        cast("warm, by GJK", options.with_method(CastMethod::Gjk).with_warm_start(start), false);
    }
    let hit = plain.outcome.hit();
    for end in ends([hit.map(|hit| hit.time), Some(plain.lower), Some(plain.upper)]) {
        let options = options.with_max_time(end);
        cast("to an end", options, false);
        cast("to an end, warm", options.with_warm_start(next), false);
        cast("to an end, by GJK", options.with_method(CastMethod::Gjk), false);
        cast("to an end, lean", lean.with_max_time(end), false);
    }
    Some((plain, told))
}

/// The signed distance of the bodies at a time.
type AtTime<'f, V> = &'f dyn Fn(<V as Vector>::Scalar) -> Option<SignedDistance<V>>;

/// Bodies that may begin in contact get deeper, or do not.
///
/// The signed distance of bodies that move straight is a convex function of time, since that of planes is linear, and
/// it is the greatest of them where bodies overlap. A plane that loses nothing proves that it never falls.
fn deeper<V: Vector>(
    told: &[Told],
    start: &SignedDistance<V>,
    scale: &Scale,
    (at, relative): (AtTime<'_, V>, Numbers),
    beyond: super::cast::Beyond<'_>,
    report: &mut Report,
) {
    let query = "linear_cast";
    let speed = length(relative);
    if !(speed > 0.0) {
        return;
    }
    // The slack that is documented, with all that it may be, and the least of it.
    let [lower, upper] = [start.lower, start.upper].map(Scalar::as_f64);
    let greatest = 64.0 * (scale.unit() + scale.epsilon * scale.place) + (upper - lower);
    let least = 8.0 * scale.epsilon * scale.size;
    for one in told.iter().filter(|one| one.is_miss() && one.earliest() > 0.0) {
        for part in [1e-3, 1e-2, 0.1, 0.3, 1.0] {
            let time = (part * scale.size / speed).min(one.earliest());
            let Some(then) = at(V::Scalar::from_f64(time)) else { continue };
            let deepest = then.upper.as_f64();
            report.claim((Law::Certain, query), deepest >= lower - greatest, || {
                format!("a miss of bodies that get deeper, from {lower:e} to {deepest:e} at {time:e}: {}", one.answer())
            });
        }
    }
    let normal = numbers(start.normal);
    let never_falls = dot(normal, relative) > 4.0 * scale.epsilon * speed;
    let lost = upper - beyond(normal, 0.0)[0];
    if never_falls && lost < least {
        for one in told {
            report.claim((Law::Certain, query), !one.is_certain_hit(), || {
                format!("a hit of bodies that get no deeper, by the plane across {normal:?}: {}", one.answer())
            });
        }
    }
}
